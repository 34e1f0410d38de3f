//! Saved states, freed when dropped.
#![allow(unsafe_code)] // calls the library

use core::ptr;

use geartrain::fmi2::abi::{FmuState, Status};

use crate::instance::Instance;

/// A state that the slave made.
#[derive(Debug)]
pub struct Saved<'i, 'h> {
    instance: &'i Instance<'h>,
    state: FmuState,
}

impl<'h> Instance<'h> {
    /// fmi2GetFMUstate; must succeed and tell nothing.
    pub fn save(&self) -> Saved<'_, 'h> {
        assert_eq!(self.messages(), []);
        self.save_quietly()
    }

    /// fmi2GetFMUstate; must succeed.
    pub fn save_quietly(&self) -> Saved<'_, 'h> {
        let mut state: FmuState = ptr::null_mut();
        // SAFETY: the component is alive; the state is a writable NULL.
        let status = unsafe { (self.functions().get_state)(self.component(), &raw mut state) };
        assert!(status == Status::Ok && !state.is_null());
        let instance = self;
        Saved { instance, state }
    }

    /// fmi2SetFMUstate
    pub fn restore(&self, saved: &Saved<'_, '_>) -> Status {
        // SAFETY: the component is alive, the state was made by this library and is freed only when dropped.
        unsafe { (self.functions().set_state)(self.component(), saved.state) }
    }

    /// fmi2SerializedFMUstateSize and fmi2SerializeFMUstate; must succeed.
    pub fn bytes(&self, saved: &Saved<'_, '_>) -> Vec<u8> {
        let (functions, component) = (self.functions(), self.component());
        let mut size = 0;
        // SAFETY: the component and the state are alive; the size is writable.
        let status = unsafe { (functions.serialized_size)(component, saved.state, &raw mut size) };
        self.accepted(status);
        let mut bytes = vec![0; size];
        let first = bytes.as_mut_ptr().cast();
        // SAFETY: the component and the state are alive; there are `size` writable bytes.
        let status = unsafe { (functions.serialize)(component, saved.state, first, size) };
        self.accepted(status);
        bytes
    }

    /// fmi2DeSerializeFMUstate, and the state that it made.
    pub fn read(&self, bytes: &[u8]) -> (Status, Option<Saved<'_, 'h>>) {
        let mut state: FmuState = ptr::null_mut();
        let (function, component) = (self.functions().deserialize, self.component());
        let first = bytes.as_ptr().cast();
        // SAFETY: the component is alive; the bytes are readable, the state is a writable NULL.
        let status = unsafe { function(component, first, bytes.len(), &raw mut state) };
        let instance = self;
        let made = (!state.is_null()).then_some(Saved { instance, state });
        (status, made)
    }
}

impl Drop for Saved<'_, '_> {
    fn drop(&mut self) {
        let (function, component) = (
            self.instance.functions().free_state,
            self.instance.component(),
        );
        // SAFETY: the instance outlives the state; nobody else frees it.
        unsafe { function(component, &raw mut self.state) };
    }
}
