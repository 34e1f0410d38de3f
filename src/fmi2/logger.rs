//! Messages to the master.

use core::ffi::CStr;
use std::ffi::CString;

use super::abi::{CallbackFunctions, ComponentEnvironment, Logger, Status};
use crate::description::LOG_CATEGORIES;

/// The master's logger with what it wants to hear.
pub(super) struct Messages {
    logger: Option<Logger>,
    environment: ComponentEnvironment,
    instance_name: CString,
    /// One flag per entry of [`LOG_CATEGORIES`].
    enabled: [bool; LOG_CATEGORIES.len()],
}

/// An entry of [`LOG_CATEGORIES`].
#[derive(Debug, Clone, Copy)]
pub(super) enum Category {
    Error = 0,
    Discard = 1,
    Events = 2,
}

impl Messages {
    /// Copies what outlives the call of fmi2Instantiate: the function pointer, the environment, the name.
    /// Errors are told from the start; `debug` turns on everything.
    pub(super) fn new(
        callbacks: &CallbackFunctions,
        instance_name: &CStr,
        debug: bool,
    ) -> Messages {
        Messages {
            logger: callbacks.logger,
            environment: callbacks.component_environment,
            instance_name: instance_name.to_owned(),
            enabled: [true, debug, debug],
        }
    }

    /// fmi2SetDebugLogging: on with names means these categories only, without names all of them; unknown
    /// names are ignored.
    pub(super) fn enable(&mut self, on: bool, names: &[&str]) {
        let all = names.is_empty() || names.contains(&"logAll");
        for ((name, _), enabled) in LOG_CATEGORIES.iter().zip(&mut self.enabled) {
            *enabled = on && (all || names.contains(name));
        }
    }

    pub(super) fn tell(&self, status: Status, category: Category, message: &str) {
        let index = category as usize;
        let Some(logger) = self.logger.filter(|_| self.enabled[index]) else {
            return;
        };
        let (Ok(message), Ok(category)) = (
            CString::new(escaped(message)),
            CString::new(LOG_CATEGORIES[index].0),
        ) else {
            return;
        };
        // SAFETY: the master guarantees that the function it passed to fmi2Instantiate stays callable
        // (FMI 2.0.4, 2.1.5); all strings are NUL-terminated and live until it returns; the message
        // contains no conversion, so that no further argument is read.
        unsafe {
            logger(
                self.environment,
                self.instance_name.as_ptr(),
                status,
                category.as_ptr(),
                message.as_ptr(),
            );
        }
    }
}

/// The finished text as a printf format and with FMI's `#` escaped: importers that cannot handle
/// variable arguments show the message itself.
fn escaped(message: &str) -> String {
    message
        .replace('%', "%%")
        .replace('#', "##")
        .replace('\0', " ")
}
