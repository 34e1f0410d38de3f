//! One slave, called through C.
#![allow(unsafe_code)] // calls the library

use core::ptr;

use geartrain::fmi2::abi::{
    Boolean, CString, Component, Integer, LAST_SUCCESSFUL_TIME, Real, Status, StatusKind,
    ValueReference,
};

use crate::STEP;
use crate::calls::Call;
use crate::functions::{Functions, Get, Set};
use crate::host::{Host, text};
use crate::log::{Environment, Message};

/// An instance; freed when dropped.
#[derive(Debug)]
pub struct Instance<'h> {
    host: &'h Host,
    component: Component,
    environment: Environment,
}

// SAFETY: an FMI slave may be called from any thread, one at a time (FMI 2.0.4, 2.1.1), and `Instance` is not
// Sync.
unsafe impl Send for Instance<'_> {}

/// A base type of FMI with its functions.
pub trait BaseType {
    /// A value in C.
    type Value: Copy;
    /// Any value.
    const SOME: Self::Value;
    /// fmi2GetReal or its sibling for this type.
    fn getter(functions: &Functions) -> Get<Self::Value>;
    /// fmi2SetReal or its sibling for this type.
    fn setter(functions: &Functions) -> Set<Self::Value>;
}

/// fmi2Real
#[derive(Debug)]
pub struct Reals;
/// fmi2Integer
#[derive(Debug)]
pub struct Integers;
/// fmi2Boolean
#[derive(Debug)]
pub struct Booleans;
/// fmi2String
#[derive(Debug)]
pub struct Strings;

impl<'h> Instance<'h> {
    /// # Safety
    /// The component was made by the host's library and belongs to nobody else.
    pub(crate) unsafe fn new(
        host: &'h Host,
        component: Component,
        environment: Environment,
    ) -> Self {
        Instance {
            host,
            component,
            environment,
        }
    }

    /// The host.
    pub fn host(&self) -> &'h Host {
        self.host
    }

    pub(crate) fn functions(&self) -> &'h Functions {
        self.host.functions()
    }

    pub(crate) fn component(&self) -> Component {
        self.component
    }

    /// What the logger was told since the last look.
    pub fn messages(&self) -> Vec<Message> {
        self.environment.take()
    }

    /// The text with which a call was refused: exactly one message, in the right category.
    pub fn refused(&self, status: Status) -> String {
        let messages = self.messages();
        assert_eq!(status, Status::Error, "{messages:?}");
        let [message] = &messages[..] else {
            panic!("one message is enough, but not less: {messages:?}");
        };
        assert_eq!(message.status, Status::Error as i32, "{message:?}");
        assert_eq!(
            message.category.as_deref(),
            Some("logStatusError"),
            "{message:?}"
        );
        message.text.clone().expect("a text")
    }

    /// The call succeeded and told nothing.
    pub fn accepted(&self, status: Status) {
        let messages = self.messages();
        assert_eq!((status, messages), (Status::Ok, vec![]));
    }

    /// fmi2SetupExperiment.
    pub fn setup(&self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Status {
        let defined = |value: Option<f64>| (Boolean::from(value.is_some()), value.unwrap_or(0.0));
        let ((has_tolerance, tolerance), (has_stop, stop)) = (defined(tolerance), defined(stop));
        let function = self.functions().setup_experiment;
        // SAFETY: the component is alive; nothing else is a pointer.
        unsafe {
            function(
                self.component,
                has_tolerance,
                tolerance,
                start,
                has_stop,
                stop,
            )
        }
    }

    /// fmi2EnterInitializationMode
    pub fn enter(&self) -> Status {
        // SAFETY: the component is alive.
        unsafe { (self.functions().enter_initialization_mode)(self.component) }
    }

    /// fmi2ExitInitializationMode
    pub fn exit(&self) -> Status {
        // SAFETY: the component is alive.
        unsafe { (self.functions().exit_initialization_mode)(self.component) }
    }

    /// fmi2Terminate
    pub fn terminate(&self) -> Status {
        // SAFETY: the component is alive.
        unsafe { (self.functions().terminate)(self.component) }
    }

    /// fmi2Reset
    pub fn reset(&self) -> Status {
        // SAFETY: the component is alive.
        unsafe { (self.functions().reset)(self.component) }
    }

    /// fmi2DoStep
    pub fn step(&self, time: f64, step: f64) -> Status {
        // SAFETY: the component is alive; nothing else is a pointer.
        unsafe { (self.functions().do_step)(self.component, time, step, 1) }
    }

    /// From instantiated to step mode at time 0.
    pub fn initialize(&self) {
        self.accepted(self.setup(None, 0.0, None));
        self.accepted(self.enter());
        self.accepted(self.exit());
    }

    /// Steps `first .. first + count` of length [`STEP`].
    pub fn steps(&self, first: u32, count: u32) {
        for index in first..first + count {
            self.accepted(self.step(f64::from(index) * STEP, STEP));
        }
    }

    /// fmi2SetReal by names.
    pub fn set(&self, values: &[(&str, f64)]) -> Status {
        let references: Vec<u32> = values
            .iter()
            .map(|(name, _)| self.host.fmu().reference(name))
            .collect();
        let values: Vec<f64> = values.iter().map(|&(_, value)| value).collect();
        self.set_array::<Reals>(Some(&references), references.len(), Some(&values))
    }

    /// fmi2GetReal by value references; must succeed.
    pub fn values(&self, references: &[u32]) -> Vec<f64> {
        let mut values = vec![0.0; references.len()];
        let count = references.len();
        self.accepted(self.get_array::<Reals>(Some(references), count, Some(&mut values)));
        values
    }

    /// fmi2GetReal by name; must succeed.
    pub fn value(&self, name: &str) -> f64 {
        self.values(&[self.host.fmu().reference(name)])[0]
    }

    /// fmi2GetReal of all variables; must succeed.
    pub fn everything(&self) -> Vec<f64> {
        let count = u32::try_from(self.host.fmu().variable_count()).expect("few");
        self.values(&(0..count).collect::<Vec<_>>())
    }

    /// fmi2GetReal of all variables that can be read now; NaN for the others.
    pub fn everything_readable(&self) -> Vec<f64> {
        let count = u32::try_from(self.host.fmu().variable_count()).expect("few");
        let read = |reference: u32| {
            let mut value = [0.0];
            let status = self.get_array::<Reals>(Some(&[reference]), 1, Some(&mut value));
            if status == Status::Ok {
                value[0]
            } else {
                f64::NAN
            }
        };
        (0..count).map(read).collect()
    }

    /// The getter with arrays as they are; `None` is NULL.
    pub fn get_array<T: BaseType>(
        &self,
        references: Option<&[ValueReference]>,
        count: usize,
        values: Option<&mut [T::Value]>,
    ) -> Status {
        assert!(references.is_none_or(|references| references.len() >= count));
        assert!(values.as_ref().is_none_or(|values| values.len() >= count));
        let references = references.map_or(ptr::null(), <[_]>::as_ptr);
        let values = values.map_or(ptr::null_mut(), <[_]>::as_mut_ptr);
        // SAFETY: the component is alive; the arrays are NULL or have `count` elements.
        unsafe { T::getter(self.functions())(self.component, references, count, values) }
    }

    /// The setter with arrays as they are; `None` is NULL.
    pub fn set_array<T: BaseType>(
        &self,
        references: Option<&[ValueReference]>,
        count: usize,
        values: Option<&[T::Value]>,
    ) -> Status {
        assert!(references.is_none_or(|references| references.len() >= count));
        assert!(values.is_none_or(|values| values.len() >= count));
        let references = references.map_or(ptr::null(), <[_]>::as_ptr);
        let values = values.map_or(ptr::null(), <[_]>::as_ptr);
        // SAFETY: the component is alive; the arrays are NULL or have `count` elements.
        unsafe { T::setter(self.functions())(self.component, references, count, values) }
    }

    /// fmi2SetDebugLogging; a category `None` is NULL.
    pub fn log(&self, on: bool, categories: &[Option<&str>]) -> Status {
        let owned: Vec<_> = categories.iter().map(|name| name.and_then(text)).collect();
        let pointer = |name: &Option<std::ffi::CString>| {
            name.as_deref().map_or(ptr::null(), core::ffi::CStr::as_ptr)
        };
        let pointers: Vec<CString> = owned.iter().map(pointer).collect();
        let function = self.functions().set_debug_logging;
        // SAFETY: the component is alive; the strings live until the end of this function.
        unsafe {
            function(
                self.component,
                Boolean::from(on),
                pointers.len(),
                pointers.as_ptr(),
            )
        }
    }

    /// fmi2SetDebugLogging with so many categories in no array.
    pub fn log_nothing(&self, count: usize) -> Status {
        // SAFETY: the component is alive; NULL is what the slave has to notice.
        unsafe { (self.functions().set_debug_logging)(self.component, 1, count, ptr::null()) }
    }

    /// fmi2GetRealStatus
    pub fn real_status(&self, kind: StatusKind) -> (Status, Real) {
        let mut value = f64::NAN;
        // SAFETY: the component is alive; the value is writable.
        let status =
            unsafe { (self.functions().get_real_status)(self.component, kind, &raw mut value) };
        (status, value)
    }

    /// End of the last step [s]; must be answered.
    pub fn time(&self) -> f64 {
        let (status, time) = self.real_status(LAST_SUCCESSFUL_TIME);
        self.accepted(status);
        time
    }

    /// fmi2GetBooleanStatus
    pub fn boolean_status(&self, kind: StatusKind) -> (Status, Boolean) {
        let mut value = -1;
        // SAFETY: the component is alive; the value is writable.
        let status =
            unsafe { (self.functions().get_boolean_status)(self.component, kind, &raw mut value) };
        (status, value)
    }

    /// The status functions that only asynchronous slaves answer: fmi2GetStatus, -Integer-, -String-.
    pub fn other_statuses(&self, kind: StatusKind) -> [Status; 3] {
        let (mut status, mut integer, mut string) = (Status::Ok, 0, ptr::null());
        let (functions, component) = (self.functions(), self.component);
        // SAFETY: the component is alive; the values are writable.
        unsafe {
            [
                (functions.get_status)(component, kind, &raw mut status),
                (functions.get_integer_status)(component, kind, &raw mut integer),
                (functions.get_string_status)(component, kind, &raw mut string),
            ]
        }
    }

    /// The answer of fmi2GetRealStatus and fmi2GetBooleanStatus to a result pointer that is NULL.
    pub fn status_into_nothing(&self, real: StatusKind, boolean: StatusKind) -> [Status; 2] {
        let (functions, component) = (self.functions(), self.component);
        // SAFETY: the component is alive; NULL is what the slave has to notice.
        unsafe {
            [
                (functions.get_real_status)(component, real, ptr::null_mut()),
                (functions.get_boolean_status)(component, boolean, ptr::null_mut()),
            ]
        }
    }

    /// fmi2FreeFMUstate of no state: NULL, and a pointer to NULL.
    pub fn free_no_state(&self) -> [Status; 2] {
        let mut state = ptr::null_mut();
        let (function, component) = (self.functions().free_state, self.component);
        // SAFETY: the component is alive; the state is NULL or a writable NULL.
        unsafe {
            [
                function(component, ptr::null_mut()),
                function(component, &raw mut state),
            ]
        }
    }

    /// A call with harmless arguments; fmi2DoStep starts at `time`.
    pub fn call(&self, call: &Call, time: f64) -> Status {
        let arguments = call.arguments(self.host.fmu(), time);
        // SAFETY: the component is alive and of this FMU.
        unsafe { call.run(self.functions(), self.component, &arguments) }
    }
}

impl Drop for Instance<'_> {
    fn drop(&mut self) {
        // SAFETY: the component is alive, and this is the last call with it.
        unsafe { (self.functions().free_instance)(self.component) }
        self.environment.take();
    }
}

impl BaseType for Reals {
    type Value = Real;
    const SOME: Real = 0.0;
    fn getter(functions: &Functions) -> Get<Real> {
        functions.get_real
    }
    fn setter(functions: &Functions) -> Set<Real> {
        functions.set_real
    }
}

impl BaseType for Integers {
    type Value = Integer;
    const SOME: Integer = 0;
    fn getter(functions: &Functions) -> Get<Integer> {
        functions.get_integer
    }
    fn setter(functions: &Functions) -> Set<Integer> {
        functions.set_integer
    }
}

impl BaseType for Booleans {
    type Value = Boolean;
    const SOME: Boolean = 0;
    fn getter(functions: &Functions) -> Get<Boolean> {
        functions.get_boolean
    }
    fn setter(functions: &Functions) -> Set<Boolean> {
        functions.set_boolean
    }
}

impl BaseType for Strings {
    type Value = CString;
    const SOME: CString = c"".as_ptr();
    fn getter(functions: &Functions) -> Get<CString> {
        functions.get_string
    }
    fn setter(functions: &Functions) -> Set<CString> {
        functions.set_string
    }
}
