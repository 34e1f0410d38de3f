//! What slaves told the logger, kept by component environment.
//!
//! An environment is a number dressed as a pointer: it is only compared, so that a slave that passes a wrong
//! one is caught instead of crashing the test.
#![allow(unsafe_code)] // the logger is called from C

use core::ffi::{CStr, c_int, c_void};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use geartrain::fmi2::abi::{CString, ComponentEnvironment, Logger};

/// One call of the logger.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// The instance's name as it arrived; `None` for NULL.
    pub instance: Option<String>,
    /// fmi2Status.
    pub status: c_int,
    /// `None` for NULL.
    pub category: Option<String>,
    /// The printf format; `None` for NULL.
    pub text: Option<String>,
}

static RECORDED: Mutex<BTreeMap<usize, Vec<Message>>> = Mutex::new(BTreeMap::new());

/// A component environment that nobody else has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Environment(usize);

impl Environment {
    /// A new one.
    pub fn new() -> Environment {
        static NEXT: AtomicUsize = AtomicUsize::new(1);
        Environment(NEXT.fetch_add(1, Ordering::Relaxed))
    }

    /// As the slave sees it.
    pub fn pointer(self) -> ComponentEnvironment {
        core::ptr::without_provenance_mut::<c_void>(self.0)
    }

    /// The messages that came with this environment since they were last taken.
    pub fn take(self) -> Vec<Message> {
        recorded().remove(&self.0).unwrap_or_default()
    }
}

impl Default for Environment {
    fn default() -> Self {
        Environment::new()
    }
}

fn recorded() -> MutexGuard<'static, BTreeMap<usize, Vec<Message>>> {
    // A test that failed while it held the lock has not left half a message.
    RECORDED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A logger that records.
pub fn logger() -> Logger {
    type Fixed = unsafe extern "C" fn(ComponentEnvironment, CString, c_int, CString, CString);
    // SAFETY: stable Rust cannot define a variadic function. On every platform of FMI 2.0 (x86, x86-64,
    // arm64) the named arguments of a variadic call lie where those of a plain one do, the caller removes
    // them from the stack, and the status is passed as the int that it is in C.
    unsafe { core::mem::transmute::<Fixed, Logger>(record) }
}

unsafe extern "C" fn record(
    environment: ComponentEnvironment,
    instance: CString,
    status: c_int,
    category: CString,
    message: CString,
) {
    // SAFETY: the slave passes NULL or NUL-terminated strings that live during this call.
    let message = unsafe {
        Message {
            instance: text(instance),
            status,
            category: text(category),
            text: text(message),
        }
    };
    recorded()
        .entry(environment.addr())
        .or_default()
        .push(message);
}

/// # Safety
/// The pointer is NULL or points to a NUL-terminated string.
unsafe fn text(pointer: CString) -> Option<String> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: not NULL, and the caller's promise.
    let text = unsafe { CStr::from_ptr(pointer) };
    Some(text.to_string_lossy().into_owned())
}
