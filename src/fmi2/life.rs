//! Birth and death of an instance.

use core::ptr;

use super::abi::{CO_SIMULATION, CString, CallbackFunctions, Component, Status, Type};
use super::arguments::text;
use super::guard::{Instance, catching};
use super::logger::{Category, Messages};
use super::payload;
use crate::slave::{Error, Slave};

/// fmi2Instantiate; the resource location is not needed, the model is in the library.
///
/// # Safety
/// Strings are NUL-terminated or NULL; `functions` points to the callbacks or is NULL.
pub(super) unsafe fn instantiate(
    instance_name: CString,
    fmu_type: Type,
    guid: CString,
    functions: *const CallbackFunctions,
    logging_on: bool,
) -> Component {
    // SAFETY: the caller's promise.
    let (Some(functions), name, guid) =
        (unsafe { (functions.as_ref(), text(instance_name), text(guid)) })
    else {
        return ptr::null_mut(); // nobody to tell
    };
    let messages = Messages::new(functions, name.unwrap_or_default(), logging_on);
    let made = catching(|| {
        if name.is_none_or(|name| name.to_bytes().trim_ascii().is_empty()) {
            return Err(Error::new("the instance name must not be empty"));
        }
        if fmu_type != CO_SIMULATION {
            return Err(Error::new(
                "this FMU is for co-simulation, not for model exchange",
            ));
        }
        new_slave(guid.map(|guid| guid.to_string_lossy()).as_deref())
    });
    let internal = || {
        Err(Error::new(
            "an internal error occurred; please report it with the model",
        ))
    };
    match made.unwrap_or_else(internal) {
        Ok(slave) => {
            messages.tell(Status::Ok, Category::Events, "instantiated");
            Box::into_raw(Box::new(Instance::new(slave, messages))).cast()
        }
        Err(error) => {
            messages.tell(
                Status::Error,
                Category::Error,
                &format!("fmi2Instantiate: {error}"),
            );
            ptr::null_mut()
        }
    }
}

fn new_slave(guid: Option<&str>) -> Result<Slave, Error> {
    let model = payload::model().ok_or_else(|| {
        Error::new("this library carries no model: it was built, but not packed into an FMU")
    })?;
    let slave = Slave::new(&model)?;
    if guid != Some(slave.guid()) {
        return Err(Error::new(format!(
            "the guid {} of modelDescription.xml is not that of this library, {}: the two files do not \
             belong together",
            guid.unwrap_or("(NULL)"),
            slave.guid()
        )));
    }
    Ok(slave)
}

/// fmi2FreeInstance.
///
/// # Safety
/// `component` is NULL or was made by [`instantiate`] and not freed yet.
pub(super) unsafe fn free(component: Component) {
    if component.is_null() {
        return;
    }
    // SAFETY: not NULL, and the caller's promise: the box that `instantiate` leaked.
    let instance = unsafe { Box::from_raw(component.cast::<Instance>()) };
    catching(|| drop(instance));
}
