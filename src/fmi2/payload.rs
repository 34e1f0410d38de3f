//! The model inside the library.
//!
//! The library is compiled once, with an empty slot; packing an FMU copies it and writes the model into the
//! slot. An FMU therefore needs no resources folder, and packing takes no compiler.
//!
//! ```text
//!   16 bytes mark | 8 bytes length, little endian | CAPACITY bytes, the first `length` of them the model
//! ```

use core::fmt;

/// Largest model [bytes].
pub const CAPACITY: usize = 128 * 1024;

/// Marks the slot in the library's file. Written inverted in [`mark`], so that the library contains it once.
const MARK: [u8; 16] = *b"\x7fgeartrain slot\x00";

#[repr(C)]
struct Slot {
    mark: [u8; 16],
    length: [u8; 8],
    model: [u8; CAPACITY],
}

static SLOT: Slot = Slot {
    mark: MARK,
    length: [0; 8],
    model: [0; CAPACITY],
};

/// Why a model cannot be written into a library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImplantError {
    /// The file has no slot: it is not a geartrain library.
    NoSlot,
    /// The model needs more than [`CAPACITY`].
    TooLarge {
        /// Size of the model [bytes].
        size: usize,
    },
}

/// The model in this library; `None` in a library that was not packed.
pub(super) fn model() -> Option<Vec<u8>> {
    // SAFETY: a valid reference to an immutable static; volatile, because the compiler knows only the
    // empty slot and must read what packing wrote into the file.
    let slot = unsafe { core::ptr::read_volatile(&raw const SLOT.length) };
    let length = usize::try_from(u64::from_le_bytes(slot)).ok()?;
    if length == 0 || length > CAPACITY {
        return None;
    }
    let byte = |index: usize| {
        // SAFETY: `index < length <= CAPACITY`; volatile for the reason above.
        unsafe { core::ptr::read_volatile(&raw const SLOT.model[index]) }
    };
    Some((0..length).map(byte).collect())
}

/// Writes a model (see [`crate::config::Config::to_bytes`]) into the file of a library.
pub fn implant(library: &mut [u8], model: &[u8]) -> Result<(), ImplantError> {
    if model.len() > CAPACITY {
        return Err(ImplantError::TooLarge { size: model.len() });
    }
    let mark = mark();
    let found = library
        .windows(mark.len())
        .position(|window| window == mark);
    let start = found.ok_or(ImplantError::NoSlot)? + mark.len();
    let slot = library
        .get_mut(start..start + 8 + CAPACITY)
        .ok_or(ImplantError::NoSlot)?;
    let (length, space) = slot.split_at_mut(8);
    length.copy_from_slice(&(model.len() as u64).to_le_bytes());
    space.fill(0);
    space[..model.len()].copy_from_slice(model);
    Ok(())
}

fn mark() -> [u8; 16] {
    const INVERTED: [u8; 16] = {
        let mut inverted = MARK;
        let mut index = 0;
        while index < inverted.len() {
            inverted[index] = !inverted[index];
            index += 1;
        }
        inverted
    };
    core::hint::black_box(INVERTED).map(|byte| !byte)
}

impl fmt::Display for ImplantError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ImplantError::NoSlot => f.write_str("the library has no place for a model"),
            ImplantError::TooLarge { size } => {
                write!(
                    f,
                    "the model takes {size} bytes, the library has room for {CAPACITY}"
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_is_written_behind_the_mark_and_an_older_one_vanishes() {
        let mut library = vec![1; 100];
        library.extend(MARK);
        library.extend(vec![9; 8 + CAPACITY + 5]);
        implant(&mut library, b"abcdef").unwrap();
        implant(&mut library, b"xyz").unwrap();
        assert_eq!(&library[116..124], &3u64.to_le_bytes());
        assert_eq!(&library[124..131], b"xyz\0\0\0\0");
        assert_eq!(library[library.len() - 5..], [9; 5]);
    }

    #[test]
    fn files_without_a_slot_and_models_without_end_are_refused() {
        assert_eq!(implant(&mut [0; 64], b"a"), Err(ImplantError::NoSlot));
        let size = CAPACITY + 1;
        assert_eq!(
            implant(&mut [0; 64], &vec![0; size]),
            Err(ImplantError::TooLarge { size })
        );
    }

    #[test]
    fn an_unpacked_library_carries_no_model() {
        assert_eq!(model(), None);
    }
}
