//! Saving and restoring everything (FMI 2.0.4, 2.1.8).
//!
//! An fmi2FMUstate that the master holds is a `Box<SavedState>`, made by get or de-serialize, consumed by free; it belongs to
//! the model, not to an instance, and may outlive the instance it was taken from.

use crate::fmi2::abi::{Byte, Component, FmuState, Status};
use crate::fmi2::arguments::{slice, slice_mut, store};
use crate::fmi2::guard::call;
use crate::slave::{Call, Error, SavedState};

/// The saved state behind a pointer of the master.
///
/// # Safety
/// `state` is NULL or was made by [`hand_over`] and not freed since.
unsafe fn saved<'a>(state: FmuState) -> Result<&'a SavedState, Error> {
    // SAFETY: the caller's promise.
    unsafe { state.cast::<SavedState>().as_ref() }.ok_or_else(|| Error::new("the state is NULL"))
}

/// Puts a state where the master wants it: into the one that is there, or a new one.
///
/// # Safety
/// `target` is NULL or points to NULL or to a state made here and not freed since.
unsafe fn hand_over(target: *mut FmuState, state: SavedState) -> Result<(), Error> {
    // SAFETY: the caller's promise.
    let place = unsafe { target.as_mut() }
        .ok_or_else(|| Error::new("the pointer for the state is NULL"))?;
    // SAFETY: the caller's promise.
    match unsafe { place.cast::<SavedState>().as_mut() } {
        Some(present) => *present = state,
        None => *place = Box::into_raw(Box::new(state)).cast(),
    }
    Ok(())
}

/// Saves everything that influences a later call; overwrites the state that is there.
///
/// # Safety
/// `state` is NULL or points to NULL or to a state of this FMU.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(component: Component, state: *mut FmuState) -> Status {
    call(component, "fmi2GetFMUstate", Call::GetState, |instance| {
        let saved = instance.slave.save();
        // SAFETY: the caller's promise.
        unsafe { hand_over(state, saved) }
    })
}

/// Everything as it was when the state was saved; also out of the error state.
///
/// # Safety
/// `state` is NULL or a state of this FMU.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(component: Component, state: FmuState) -> Status {
    call(component, "fmi2SetFMUstate", Call::UseState, |instance| {
        // SAFETY: the caller's promise.
        instance.slave.restore(unsafe { saved(state) }?)
    })
}

/// Frees a state and sets its pointer to NULL; ignores NULL.
///
/// # Safety
/// `state` is NULL or points to NULL or to a state of this FMU.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Component, state: *mut FmuState) -> Status {
    call(component, "fmi2FreeFMUstate", Call::UseState, |_| {
        // SAFETY: the caller's promise.
        if let Some(place) = unsafe { state.as_mut() }.filter(|place| !place.is_null()) {
            // SAFETY: not NULL, and the caller's promise: the box that `hand_over` leaked.
            drop(unsafe { Box::from_raw(place.cast::<SavedState>()) });
            *place = core::ptr::null_mut();
        }
        Ok(())
    })
}

/// Number of bytes that fmi2SerializeFMUstate writes.
///
/// # Safety
/// `state` is NULL or a state of this FMU; `size` is NULL or points to a writable number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    component: Component,
    state: FmuState,
    size: *mut usize,
) -> Status {
    call(
        component,
        "fmi2SerializedFMUstateSize",
        Call::UseState,
        |_| {
            // SAFETY: the caller's promise.
            let bytes = unsafe { saved(state) }?.to_bytes();
            // SAFETY: the caller's promise.
            unsafe { store(size, bytes.len()) }
        },
    )
}

/// Writes a state as bytes, which any instance of the same build can read.
///
/// # Safety
/// `state` is NULL or a state of this FMU; `bytes` points to `size` writable bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    component: Component,
    state: FmuState,
    bytes: *mut Byte,
    size: usize,
) -> Status {
    call(component, "fmi2SerializeFMUstate", Call::UseState, |_| {
        // SAFETY: the caller's promise.
        let written = unsafe { saved(state) }?.to_bytes();
        // SAFETY: the caller's promise; a byte has no alignment and no invalid value.
        let target = unsafe { slice_mut(bytes.cast::<u8>(), size) }?;
        let needed = written.len();
        let place = target.get_mut(..needed).ok_or_else(|| {
            Error::new(format!(
                "the state needs {needed} bytes, found room for {size}"
            ))
        })?;
        place.copy_from_slice(&written);
        Ok(())
    })
}

/// Makes a state from bytes; overwrites the state that is there.
///
/// # Safety
/// `bytes` points to `size` readable bytes; `state` is NULL or points to NULL or to a state of this FMU.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: Component,
    bytes: *const Byte,
    size: usize,
    state: *mut FmuState,
) -> Status {
    call(
        component,
        "fmi2DeSerializeFMUstate",
        Call::UseState,
        |instance| {
            // SAFETY: the caller's promise; a byte has no alignment and no invalid value.
            let read = SavedState::from_bytes(unsafe { slice(bytes.cast::<u8>(), size) }?)?;
            instance.slave.check_fits(&read)?;
            // SAFETY: the caller's promise.
            unsafe { hand_over(state, read) }
        },
    )
}
