//! The functions behind capability flags, with arguments as they are: `None` is NULL.
#![allow(unsafe_code)] // calls the library

use core::ptr;

use geartrain::fmi2::abi::{FmuState, Integer, Real, Status, ValueReference};

use crate::instance::Instance;

/// Arrays of fmi2SetRealInputDerivatives and fmi2GetRealOutputDerivatives.
#[derive(Debug, Clone, Copy)]
pub struct Derivatives<'a> {
    /// nvr; no array is shorter.
    pub count: usize,
    /// vr
    pub references: Option<&'a [ValueReference]>,
    /// order
    pub orders: Option<&'a [Integer]>,
    /// value
    pub values: Option<&'a [Real]>,
}

/// Arrays of fmi2GetDirectionalDerivative.
#[derive(Debug, Clone, Copy)]
pub struct Direction<'a> {
    /// nUnknown and nKnown; no array is shorter.
    pub counts: [usize; 2],
    /// vUnknown_ref
    pub unknowns: Option<&'a [ValueReference]>,
    /// vKnown_ref
    pub knowns: Option<&'a [ValueReference]>,
    /// dvKnown
    pub seed: Option<&'a [Real]>,
    /// Whether there is an array for dvUnknown.
    pub result: bool,
}

impl Instance<'_> {
    /// fmi2SetRealInputDerivatives
    pub fn set_input_derivatives(&self, arrays: Derivatives<'_>) -> Status {
        let Derivatives {
            count,
            references,
            orders,
            values,
        } = arrays;
        let references = pointer(references, count);
        let (orders, values) = (pointer(orders, count), pointer(values, count));
        let function = self.functions().set_real_input_derivatives;
        // SAFETY: the component is alive; the arrays are NULL or have `count` elements.
        unsafe { function(self.component(), references, count, orders, values) }
    }

    /// fmi2GetRealOutputDerivatives; of the values only their presence counts.
    pub fn get_output_derivatives(&self, arrays: Derivatives<'_>) -> Status {
        let Derivatives {
            count,
            references,
            orders,
            values,
        } = arrays;
        let mut results = vec![0.0; count];
        let results = values.map_or(ptr::null_mut(), |_| results.as_mut_ptr());
        let (references, orders) = (pointer(references, count), pointer(orders, count));
        let function = self.functions().get_real_output_derivatives;
        // SAFETY: the component is alive; the arrays are NULL or have `count` elements.
        unsafe { function(self.component(), references, count, orders, results) }
    }

    /// fmi2GetDirectionalDerivative
    pub fn get_directional_derivative(&self, arrays: Direction<'_>) -> Status {
        let [unknown_count, known_count] = arrays.counts;
        let mut results = vec![0.0; unknown_count];
        let results = if arrays.result {
            results.as_mut_ptr()
        } else {
            ptr::null_mut()
        };
        let unknowns = pointer(arrays.unknowns, unknown_count);
        let knowns = pointer(arrays.knowns, known_count);
        let seed = pointer(arrays.seed, known_count);
        let function = self.functions().get_directional_derivative;
        let component = self.component();
        // SAFETY: the component is alive; the arrays are NULL or as long as announced.
        unsafe {
            function(
                component,
                unknowns,
                unknown_count,
                knowns,
                known_count,
                seed,
                results,
            )
        }
    }

    /// fmi2GetFMUstate into NULL
    pub fn save_into_nothing(&self) -> Status {
        // SAFETY: the component is alive; NULL is what the slave has to notice.
        unsafe { (self.functions().get_state)(self.component(), ptr::null_mut()) }
    }

    /// fmi2SetFMUstate of NULL
    pub fn restore_nothing(&self) -> Status {
        // SAFETY: the component is alive; NULL is what the slave has to notice.
        unsafe { (self.functions().set_state)(self.component(), ptr::null_mut()) }
    }

    /// fmi2SerializedFMUstateSize and fmi2SerializeFMUstate of NULL
    pub fn serialize_nothing(&self) -> [Status; 2] {
        let (mut size, mut bytes) = (0, [0; 64]);
        let (functions, component) = (self.functions(), self.component());
        // SAFETY: the component is alive; size and bytes are writable, NULL is what the slave has to notice.
        [
            unsafe { (functions.serialized_size)(component, ptr::null_mut(), &raw mut size) },
            // SAFETY: as above.
            unsafe {
                (functions.serialize)(component, ptr::null_mut(), bytes.as_mut_ptr(), bytes.len())
            },
        ]
    }

    /// fmi2DeSerializeFMUstate, and whether it made a state.
    pub fn deserialize(&self, bytes: Option<&[u8]>, count: usize) -> (Status, bool) {
        let mut state: FmuState = ptr::null_mut();
        let (functions, component) = (self.functions(), self.component());
        let bytes = pointer(bytes, count).cast();
        // SAFETY: the component is alive; the bytes are NULL or as many as announced.
        let status = unsafe { (functions.deserialize)(component, bytes, count, &raw mut state) };
        let made = !state.is_null();
        if made {
            // SAFETY: the component is alive, and the state is its own.
            unsafe { (functions.free_state)(component, &raw mut state) };
        }
        (status, made)
    }
}

/// The array's pointer; the array has `count` elements at least.
fn pointer<T>(array: Option<&[T]>, count: usize) -> *const T {
    assert!(array.is_none_or(|array| array.len() >= count));
    array.map_or(ptr::null(), <[_]>::as_ptr)
}
