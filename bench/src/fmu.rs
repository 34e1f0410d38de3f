//! The library inside an FMU, called through the C interface as a master does.
#![allow(unsafe_code)] // calls a library

use core::ptr;
use std::ffi::CString;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

use fmi2_functions::Functions;
use geartrain::fmi2::abi::{CO_SIMULATION, CallbackFunctions, Component, Status};
use geartrain::interface::{Interface, Quantity};
use geartrain::model::ModalModel;
use geartrain::package::Package;
use geartrain::train::no_files;
use geartrain::train::{Loaded, load};
use libloading::Library;

use crate::models::workspace;

/// A model's library in memory.
pub struct Fmu {
    functions: Functions,
    guid: CString,
    interface: Interface,
    bytes: u64,
    /// Keeps the functions callable.
    _library: Library,
}

/// A slave; freed when dropped.
pub struct Slave<'f> {
    fmu: &'f Fmu,
    component: Component,
}

impl Fmu {
    /// Builds the library, puts the model into it and loads it.
    pub fn of(text: &str) -> Result<Fmu, String> {
        let words = |error: &dyn core::fmt::Display| error.to_string();
        let workspace = workspace();
        let builder = fmu_build::Builder {
            workspace: &workspace,
            package: "geartrain",
            zig: None,
        };
        let library = builder.native().map_err(|error| words(&error))?;
        let [library] = &library.files[..] else {
            return Err("a library of one file is expected".to_string());
        };
        let empty = std::fs::read(library).map_err(|error| words(&error))?;
        let package = Package::of(text, &no_files).map_err(|error| words(&error))?;
        let full = package.implant(empty).map_err(|error| words(&error))?;
        let path = own_path(library.extension().unwrap_or_default());
        let folder = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        folder
            .and_then(|()| std::fs::write(&path, &full))
            .map_err(|error| words(&error))?;
        // SAFETY: the library is ours; loading it runs the initializers of Rust's standard library only.
        let library = unsafe { Library::new(&path) }.map_err(|error| words(&error))?;
        // SAFETY: it is an FMI 2.0 co-simulation slave, and lives as long as the functions.
        let functions = unsafe { Functions::of(&library) };
        let Loaded { config, train, .. } =
            load(text).map_err(|problems| format!("{problems:?}"))?;
        let model = ModalModel::assemble(&train, None).map_err(|error| words(&error))?;
        let interface = Interface::of(&config, &train, &model);
        let guid = CString::new(interface.fingerprint(&config)).map_err(|error| words(&error))?;
        let bytes = full.len() as u64;
        Ok(Fmu {
            functions,
            guid,
            interface,
            bytes,
            _library: library,
        })
    }

    /// Size of the library's file [bytes].
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Value references of the variables that stand for such a quantity.
    pub fn references(&self, is_wanted: impl Fn(Quantity) -> bool) -> Vec<u32> {
        let variables = self.interface.variables.iter().zip(0..);
        variables
            .filter(|(variable, _)| is_wanted(variable.quantity))
            .map(|(_, reference)| reference)
            .collect()
    }

    /// What a variable stands for.
    pub fn quantity(&self, reference: u32) -> Quantity {
        self.interface.variables[reference as usize].quantity
    }

    /// fmi2Instantiate.
    pub fn instantiate(&self) -> Slave<'_> {
        let callbacks = CallbackFunctions {
            logger: None,
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: ptr::null_mut(),
        };
        let (name, guid) = (c"slave".as_ptr(), self.guid.as_ptr());
        // SAFETY: strings and struct are valid during the call.
        let component = unsafe {
            (self.functions.instantiate)(
                name,
                CO_SIMULATION,
                guid,
                ptr::null(),
                &raw const callbacks,
                0,
                0,
            )
        };
        assert!(!component.is_null(), "fmi2Instantiate refuses");
        Slave {
            fmu: self,
            component,
        }
    }
}

/// A path for a library that no other one loaded has: loading the same path twice gives the same library.
fn own_path(extension: &std::ffi::OsStr) -> PathBuf {
    static NEXT: AtomicU32 = AtomicU32::new(1);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let path = workspace().join(format!("target/bench/model{number}"));
    path.with_extension(extension)
}

impl Slave<'_> {
    /// fmi2SetupExperiment, fmi2EnterInitializationMode, fmi2ExitInitializationMode.
    pub fn initialize(&self) {
        let functions = &self.fmu.functions;
        // SAFETY: the component is alive; nothing else is a pointer.
        let statuses = unsafe {
            [
                (functions.setup_experiment)(self.component, 0, 0.0, 0.0, 0, 0.0),
                (functions.enter_initialization_mode)(self.component),
                (functions.exit_initialization_mode)(self.component),
            ]
        };
        assert_eq!(statuses, [Status::Ok; 3]);
    }

    /// fmi2SetReal
    pub fn set(&self, references: &[u32], values: &[f64]) {
        assert_eq!(references.len(), values.len());
        let (set, count) = (self.fmu.functions.set_real, references.len());
        // SAFETY: the component is alive; both arrays have `count` elements.
        let status = unsafe { set(self.component, references.as_ptr(), count, values.as_ptr()) };
        assert_eq!(status, Status::Ok);
    }

    /// fmi2GetReal
    pub fn get(&self, references: &[u32], values: &mut [f64]) {
        assert_eq!(references.len(), values.len());
        let (get, count) = (self.fmu.functions.get_real, references.len());
        // SAFETY: the component is alive; both arrays have `count` elements.
        let status = unsafe {
            get(
                self.component,
                references.as_ptr(),
                count,
                values.as_mut_ptr(),
            )
        };
        assert_eq!(status, Status::Ok);
    }

    /// fmi2DoStep
    pub fn step(&self, time: f64, step: f64) {
        // SAFETY: the component is alive; nothing else is a pointer.
        let status = unsafe { (self.fmu.functions.do_step)(self.component, time, step, 1) };
        assert_eq!(status, Status::Ok);
    }
}

impl Drop for Slave<'_> {
    fn drop(&mut self) {
        // SAFETY: the component is alive, and this is the last call with it.
        unsafe { (self.fmu.functions.free_instance)(self.component) }
    }
}
