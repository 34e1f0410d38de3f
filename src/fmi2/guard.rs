//! The one way from C into Rust: null check, legality, panics, messages.
//!
//! A [`Component`] that the master holds is a `Box<Instance>` made by fmi2Instantiate and consumed by
//! fmi2FreeInstance. Every other call borrows it through [`call`].

use core::cell::Cell;
use core::panic::AssertUnwindSafe;
use std::panic::{self, PanicHookInfo, catch_unwind};
use std::sync::OnceLock;

use super::abi::{Component, Status};
use super::logger::{Category, Messages};
use crate::slave::{Call, Error, Kind, Slave};

/// What a component points to.
pub(super) struct Instance {
    pub(super) slave: Slave,
    pub(super) messages: Messages,
    /// After a panic nothing but free is trusted.
    broken: bool,
}

impl Instance {
    pub(super) fn new(slave: Slave, messages: Messages) -> Instance {
        Instance {
            slave,
            messages,
            broken: false,
        }
    }

    /// Tells the master about an error and gives the status to return.
    fn report(&self, function: &str, error: &Error) -> Status {
        let (status, category) = match error.kind() {
            Kind::Error => (Status::Error, Category::Error),
            Kind::Discard => (Status::Discard, Category::Discard),
        };
        self.messages
            .tell(status, category, &format!("{function}: {error}"));
        status
    }
}

/// Runs `body` on the instance behind `component`, if `needs` is legal in its state.
///
/// Never unwinds. NULL gives `fmi2Error`.
pub(super) fn call(
    component: Component,
    function: &'static str,
    needs: Call,
    body: impl FnOnce(&mut Instance) -> Result<(), Error>,
) -> Status {
    // SAFETY: the master passes NULL or a component that fmi2Instantiate returned and fmi2FreeInstance
    // has not seen, and calls one function at a time per component (FMI 2.0.4, 2.1.1 and 4.2.4).
    let Some(instance) = (unsafe { component.cast::<Instance>().as_mut() }) else {
        return Status::Error;
    };
    if instance.broken {
        let error = Error::new("an earlier call failed inside the FMU; only free is possible");
        return instance.report(function, &error);
    }
    let outcome = catching(|| {
        instance.slave.permit(needs)?;
        body(instance)
    });
    match outcome {
        Some(Ok(())) => Status::Ok,
        Some(Err(error)) => instance.report(function, &error),
        None => {
            instance.broken = true;
            let error = Error::new("an internal error occurred; please report it with the model");
            instance.report(function, &error)
        }
    }
}

/// What a panic hook is.
type Hook = dyn Fn(&PanicHookInfo<'_>) + Sync + Send;

/// The hook before ours. In a static and not in our closure: that would be a box, which nobody could free when the
/// library is unloaded.
static BEFORE: OnceLock<Box<Hook>> = OnceLock::new();

/// Runs `body`; `None` when it panicked. Prints nothing.
pub(super) fn catching<T>(body: impl FnOnce() -> T) -> Option<T> {
    thread_local! {
        static QUIET: Cell<bool> = const { Cell::new(false) };
    }
    BEFORE.get_or_init(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(|info| {
            if let (false, Some(before)) = (QUIET.get(), BEFORE.get()) {
                before(info);
            }
        }));
        before
    });
    let outer = QUIET.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(body));
    QUIET.set(outer);
    outcome.ok()
}

#[cfg(test)]
mod tests {
    use core::ptr;

    use super::super::abi::CallbackFunctions;
    use super::*;
    use crate::train::load;

    fn instance() -> Box<Instance> {
        let model = load(include_str!("../../examples/three_stage.toml"))
            .unwrap()
            .config
            .to_bytes();
        let callbacks = CallbackFunctions {
            logger: None,
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: ptr::null_mut(),
        };
        Box::new(Instance::new(
            Slave::new(&model).unwrap(),
            Messages::new(&callbacks, c"test", false),
        ))
    }

    #[test]
    fn a_panic_becomes_an_error_and_nothing_but_free_is_trusted_afterwards() {
        let mut instance = instance();
        let component: Component = ptr::from_mut(&mut *instance).cast();
        let status = call(component, "test", Call::Get, |_| panic!("caught"));
        assert_eq!(status, Status::Error);
        let mut reached = false;
        let status = call(component, "test", Call::Reset, |_| {
            reached = true;
            Ok(())
        });
        assert_eq!((status, reached), (Status::Error, false));
    }

    #[test]
    fn illegal_calls_do_not_reach_the_slave() {
        let mut instance = instance();
        let component: Component = ptr::from_mut(&mut *instance).cast();
        let status = call(component, "fmi2DoStep", Call::DoStep, |_| {
            panic!("not reached")
        });
        assert_eq!(status, Status::Error);
        assert_eq!(
            call(component, "fmi2Reset", Call::Reset, |_| Ok(())),
            Status::Ok
        );
        assert_eq!(
            call(ptr::null_mut(), "fmi2Reset", Call::Reset, |_| Ok(())),
            Status::Error
        );
    }
}
