//! Arrays and strings that come from C.

use core::ffi::CStr;

use super::abi::CString;
use crate::slave::Error;

/// # Safety
/// `first` points to `count` readable elements that nobody writes during the call, unless `count` is 0.
pub(super) unsafe fn slice<'a, T>(first: *const T, count: usize) -> Result<&'a [T], Error> {
    if count == 0 {
        return Ok(&[]); // the pointer means nothing then
    }
    if first.is_null() {
        return Err(null_array(count));
    }
    // SAFETY: not NULL, and the caller's promise.
    Ok(unsafe { core::slice::from_raw_parts(first, count) })
}

/// # Safety
/// `first` points to `count` writable elements that nobody else uses during the call, unless `count` is 0.
pub(super) unsafe fn slice_mut<'a, T>(first: *mut T, count: usize) -> Result<&'a mut [T], Error> {
    if count == 0 {
        return Ok(&mut []);
    }
    if first.is_null() {
        return Err(null_array(count));
    }
    // SAFETY: not NULL, and the caller's promise.
    Ok(unsafe { core::slice::from_raw_parts_mut(first, count) })
}

/// The strings of an array; those that are NULL or not UTF-8 are left out.
///
/// # Safety
/// `first` points to `count` NUL-terminated strings or NULLs, unless `count` is 0.
pub(super) unsafe fn strings<'a>(
    first: *const CString,
    count: usize,
) -> Result<Vec<&'a str>, Error> {
    // SAFETY: the caller's promise.
    let pointers = unsafe { slice(first, count) }?;
    // SAFETY: the caller's promise.
    Ok(pointers
        .iter()
        .filter_map(|&pointer| unsafe { text(pointer) }?.to_str().ok())
        .collect())
}

/// A string; `None` for NULL.
///
/// # Safety
/// `pointer` is NULL or points to a NUL-terminated string.
pub(super) unsafe fn text<'a>(pointer: CString) -> Option<&'a CStr> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: not NULL, and the caller's promise.
    Some(unsafe { CStr::from_ptr(pointer) })
}

/// Writes a result where the master wants it.
///
/// # Safety
/// `target` is NULL or points to a writable element.
pub(super) unsafe fn store<T>(target: *mut T, value: T) -> Result<(), Error> {
    // SAFETY: the caller's promise; NULL gives None.
    match unsafe { target.as_mut() } {
        Some(target) => {
            *target = value;
            Ok(())
        }
        None => Err(Error::new("the pointer for the result is NULL")),
    }
}

fn null_array(count: usize) -> Error {
    Error::new(format!(
        "an array of {count} elements was announced, but its pointer is NULL"
    ))
}
