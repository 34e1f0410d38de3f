//! A host that has loaded the library of an FMU.
#![allow(unsafe_code)] // loads a library and calls into it

use core::ffi::{CStr, c_void};
use core::ptr;
use std::ffi::CString as OwnedCString;
use std::sync::Arc;

use geartrain::fmi2::abi::{CO_SIMULATION, CallbackFunctions, Status, Type};
use libloading::Library;

use crate::calls::Call;
use crate::fmu::Fmu;
use crate::functions::Functions;
use crate::instance::Instance;
use crate::log::{Environment, Message, logger};

/// A loaded library; unloaded when dropped.
#[derive(Debug)]
pub struct Host {
    functions: Functions,
    fmu: Arc<Fmu>,
    /// Keeps the functions callable.
    _library: Library,
}

/// The arguments of fmi2Instantiate; `None` is NULL.
#[derive(Debug, Clone)]
pub struct Birth {
    /// instanceName
    pub name: Option<OwnedCString>,
    /// fmuType
    pub fmu_type: Type,
    /// fmuGUID
    pub guid: Option<OwnedCString>,
    /// fmuResourceLocation
    pub resources: Option<OwnedCString>,
    /// functions
    pub callbacks: Callbacks,
    /// loggingOn
    pub logging_on: bool,
}

/// Which callbacks a slave gets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Callbacks {
    /// All but stepFinished.
    Usual,
    /// Only the logger.
    LoggerOnly,
    /// A struct of NULLs.
    Nulls,
    /// No struct.
    Absent,
}

impl Host {
    /// Unpacks an FMU and loads its library.
    pub fn of(name: &str) -> Host {
        Host::load(&Arc::new(Fmu::unpack(name)))
    }

    /// Loads the library of an unpacked FMU.
    pub fn load(fmu: &Arc<Fmu>) -> Host {
        let path = fmu.library();
        // SAFETY: the library is ours; loading it runs the initializers of Rust's standard library only.
        let library = unsafe { Library::new(&path) };
        let library = library.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        // SAFETY: it is an FMI 2.0 co-simulation slave, and lives as long as the functions in this host.
        let functions = unsafe { Functions::of(&library) };
        Host {
            functions,
            fmu: Arc::clone(fmu),
            _library: library,
        }
    }

    /// The FMU that the library belongs to.
    pub fn fmu(&self) -> &Fmu {
        &self.fmu
    }

    /// The library's functions.
    pub fn functions(&self) -> &Functions {
        &self.functions
    }

    /// fmi2GetTypesPlatform and fmi2GetVersion.
    pub fn platform_and_version(&self) -> [&str; 2] {
        let functions = [
            self.functions.get_types_platform,
            self.functions.get_version,
        ];
        functions.map(|function| {
            // SAFETY: the function has no arguments and returns a static string.
            let text = unsafe { CStr::from_ptr(function()) };
            text.to_str().expect("ASCII")
        })
    }

    /// Arguments with which fmi2Instantiate succeeds.
    pub fn birth(&self) -> Birth {
        let resources = format!("file://{}/resources", self.fmu.folder().display());
        Birth {
            name: text("slave"),
            fmu_type: CO_SIMULATION,
            guid: text(&self.fmu.description().guid),
            resources: text(&resources),
            callbacks: Callbacks::Usual,
            logging_on: false,
        }
    }

    /// fmi2Instantiate: the instance, if there is one, and what the logger was told meanwhile.
    pub fn instantiate(&self, birth: &Birth) -> (Option<Instance<'_>>, Vec<Message>) {
        let environment = Environment::new();
        // Ends with this call, as the standard allows: the slave has to copy it.
        let callbacks = birth.callbacks.structure(environment);
        let pointer = callbacks.as_ref().map_or(ptr::null(), ptr::from_ref);
        let [name, guid, resources] = [&birth.name, &birth.guid, &birth.resources]
            .map(|text| text.as_deref().map_or(ptr::null(), CStr::as_ptr));
        // SAFETY: strings and struct are NULL or valid during the call.
        let component = unsafe {
            (self.functions.instantiate)(
                name,
                birth.fmu_type,
                guid,
                resources,
                pointer,
                0,
                i32::from(birth.logging_on),
            )
        };
        let messages = environment.take();
        if component.is_null() {
            return (None, messages);
        }
        // SAFETY: the component is alive and nobody else has it.
        let instance = unsafe { Instance::new(self, component, environment) };
        (Some(instance), messages)
    }

    /// An instance of the usual kind.
    pub fn instance(&self) -> Instance<'_> {
        let (instance, messages) = self.instantiate(&self.birth());
        instance.unwrap_or_else(|| panic!("fmi2Instantiate returned NULL: {messages:?}"))
    }

    /// An instance in step mode at time 0.
    pub fn running(&self) -> Instance<'_> {
        let instance = self.instance();
        instance.initialize();
        instance
    }

    /// A call with NULL as component.
    pub fn call_nobody(&self, call: &Call) -> Status {
        // SAFETY: NULL is a component that every function has to refuse.
        unsafe {
            call.run(
                &self.functions,
                ptr::null_mut(),
                &call.arguments(self.fmu(), 0.0),
            )
        }
    }

    /// fmi2FreeInstance(NULL).
    pub fn free_nobody(&self) {
        // SAFETY: NULL is ignored (FMI 2.0.4, 2.1.5).
        unsafe { (self.functions.free_instance)(ptr::null_mut()) }
    }
}

impl Callbacks {
    fn structure(self, environment: Environment) -> Option<CallbackFunctions> {
        let usual = self == Callbacks::Usual;
        let callbacks = CallbackFunctions {
            logger: (self != Callbacks::Nulls).then(logger),
            allocate_memory: usual.then_some(allocate as _),
            free_memory: usual.then_some(free as _),
            step_finished: None,
            component_environment: environment.pointer(),
        };
        (self != Callbacks::Absent).then_some(callbacks)
    }
}

/// The slave declares canNotUseMemoryManagementFunctions: it must not call this.
unsafe extern "C" fn allocate(_count: usize, _size: usize) -> *mut c_void {
    ptr::null_mut()
}

/// As [`allocate`].
unsafe extern "C" fn free(_memory: *mut c_void) {}

/// A C string; the text contains no NUL.
pub fn text(text: &str) -> Option<OwnedCString> {
    Some(OwnedCString::new(text).expect("no NUL in the text"))
}
