//! Libraries for macOS: signed pages, and several processors in one file.
//!
//! macOS on ARM runs only code that carries a sum of each of its pages; the linker writes these sums ("ad hoc", which
//! is no more than a checksum and needs no identity). What is written into a library afterwards makes them wrong, and
//! the host would be killed when it touches the page.
//!
//! ```text
//!   header | commands ... LC_CODE_SIGNATURE -> | ... code and data ... | super blob: code directory: sums of pages
//! ```
//!
//! The layout is that of `mach-o/loader.h`, `mach-o/fat.h` and `cs_blobs.h`, published by Apple. Only what the linkers of
//! Apple, LLVM and zig write is handled: 64 bits, little endian, SHA-256.

use std::fmt;

use sha2::{Digest, Sha256};

/// Why a file is not such a library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Malformed {
    /// It does not begin as a 64-bit Mach-O file, or ends too early.
    NotMachO,
    /// It is for ARM and has no signature.
    Unsigned,
    /// Its signature is of a kind that is not handled.
    UnknownSignature,
}

const MAGIC_64: u32 = 0xfeed_facf;
const HEADER_SIZE: usize = 32;
const CPU_ARM64: u32 = 0x0100_000c;
const LC_CODE_SIGNATURE: u32 = 0x1d;
const SUPER_BLOB: u32 = 0xfade_0cc0;
const CODE_DIRECTORY: u32 = 0xfade_0c02;
const SHA_256: u8 = 2;
const UNIVERSAL: u32 = 0xcafe_babe;
/// Pages of macOS on ARM have 16 KiB; slices begin on one.
const SLICE_ALIGNMENT_LOG2: u32 = 14;

/// Writes the sums of the pages anew. A library without signature stays without where none is needed.
pub fn sign(library: &mut [u8]) -> Result<(), Malformed> {
    if little(library, 0)? != MAGIC_64 {
        return Err(Malformed::NotMachO);
    }
    let Some(signature) = signature(library)? else {
        let needed = little(library, 4)? == CPU_ARM64;
        return if needed {
            Err(Malformed::Unsigned)
        } else {
            Ok(())
        };
    };
    if big(library, signature)? != SUPER_BLOB {
        return Err(Malformed::UnknownSignature);
    }
    for index in 0..size(big(library, signature + 8)?) {
        let blob = signature + size(big(library, signature + 12 + 8 * index + 4)?);
        if big(library, blob)? == CODE_DIRECTORY {
            sum_pages(library, blob)?;
        }
    }
    Ok(())
}

/// Where the signature begins.
fn signature(library: &[u8]) -> Result<Option<usize>, Malformed> {
    let mut command = HEADER_SIZE;
    for _ in 0..little(library, 16)? {
        if little(library, command)? == LC_CODE_SIGNATURE {
            return Ok(Some(size(little(library, command + 8)?)));
        }
        command += size(little(library, command + 4)?);
    }
    Ok(None)
}

/// Writes the sums of one code directory.
fn sum_pages(library: &mut [u8], directory: usize) -> Result<(), Malformed> {
    let [sums, count, end] = [16, 28, 32].map(|field| big(library, directory + field).map(size));
    let (sums, count, end) = (directory + sums?, count?, end?);
    let kinds = library.get(directory + 36..directory + 40);
    let &[sum_size, kind, _, page_log2] = kinds.ok_or(Malformed::NotMachO)? else {
        return Err(Malformed::NotMachO);
    };
    let page = 1_usize.checked_shl(page_log2.into()).unwrap_or(0);
    if kind != SHA_256 || usize::from(sum_size) != Sha256::output_size() || page < 2 {
        return Err(Malformed::UnknownSignature);
    }
    for index in 0..count {
        let bytes = library.get(index * page..end.min((index + 1) * page));
        let sum = Sha256::digest(bytes.ok_or(Malformed::NotMachO)?);
        let place = sums + index * sum.len();
        let place = library.get_mut(place..place + sum.len());
        place.ok_or(Malformed::NotMachO)?.copy_from_slice(&sum);
    }
    Ok(())
}

/// One file with the libraries of several processors.
pub fn universal(slices: &[Vec<u8>]) -> Result<Vec<u8>, Malformed> {
    let alignment = 1 << SLICE_ALIGNMENT_LOG2;
    let mut file = Vec::new();
    file.extend(UNIVERSAL.to_be_bytes());
    file.extend(word(slices.len())?.to_be_bytes());
    let mut start = alignment;
    for slice in slices {
        let processor = [little(slice, 4)?, little(slice, 8)?];
        let place = [word(start)?, word(slice.len())?, SLICE_ALIGNMENT_LOG2];
        for field in processor.into_iter().chain(place) {
            file.extend(field.to_be_bytes());
        }
        start = (start + slice.len()).next_multiple_of(alignment);
    }
    for slice in slices {
        file.resize(file.len().next_multiple_of(alignment), 0);
        file.extend(slice);
    }
    Ok(file)
}

fn four(bytes: &[u8], at: usize) -> Result<[u8; 4], Malformed> {
    let found = at.checked_add(4).and_then(|end| bytes.get(at..end));
    let found = found.and_then(|found| found.try_into().ok());
    found.ok_or(Malformed::NotMachO)
}

fn little(bytes: &[u8], at: usize) -> Result<u32, Malformed> {
    Ok(u32::from_le_bytes(four(bytes, at)?))
}

fn big(bytes: &[u8], at: usize) -> Result<u32, Malformed> {
    Ok(u32::from_be_bytes(four(bytes, at)?))
}

fn size(word: u32) -> usize {
    word as usize
}

fn word(size: usize) -> Result<u32, Malformed> {
    u32::try_from(size).map_err(|_| Malformed::NotMachO)
}

impl fmt::Display for Malformed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Malformed::NotMachO => "the library for macOS is not a 64-bit Mach-O file",
            Malformed::Unsigned => "the library for macOS on ARM is not signed by its linker",
            Malformed::UnknownSignature => {
                "the library for macOS has a signature that cannot be renewed"
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pages of 4096 bytes, the second one short, and their signature.
    fn library(processor: u32) -> Vec<u8> {
        let (end, page_log2) = (5000_u32, 12);
        let mut file = Vec::new();
        for field in [MAGIC_64, processor, 3, 6, 1, 16, 0, 0] {
            file.extend(field.to_le_bytes());
        }
        for field in [LC_CODE_SIGNATURE, 16, end, 200] {
            file.extend(field.to_le_bytes());
        }
        file.resize(end as usize, 7);
        for field in [SUPER_BLOB, 200, 1, 0, 20, CODE_DIRECTORY] {
            file.extend(field.to_be_bytes());
        }
        // length, version, flags, sums, identity, special sums, sums, end of what is summed
        for field in [180, 0x20400, 2, 44, 0, 0, 2, end] {
            file.extend(field.to_be_bytes());
        }
        file.extend([32, SHA_256, 0, page_log2]);
        file.resize(end as usize + 20 + 44 + 64, 0);
        file
    }

    #[test]
    fn the_sum_of_each_page_follows_what_is_written_into_it() {
        let mut file = library(CPU_ARM64);
        file[4500] = 1;
        sign(&mut file).unwrap();
        let sums = 5000 + 20 + 44;
        assert_eq!(file[sums..sums + 32], Sha256::digest(&file[..4096])[..]);
        let second = Sha256::digest(&file[4096..5000]);
        assert_eq!(file[sums + 32..sums + 64], second[..]);
    }

    #[test]
    fn only_arm_needs_a_signature() {
        let unsigned = |processor| {
            let mut file = library(processor);
            file[HEADER_SIZE] = 0x1b;
            sign(&mut file)
        };
        assert_eq!(unsigned(CPU_ARM64), Err(Malformed::Unsigned));
        assert_eq!(unsigned(0x0100_0007), Ok(()));
    }

    #[test]
    fn other_files_and_cut_ones_are_refused() {
        assert_eq!(sign(&mut [0; 64]), Err(Malformed::NotMachO));
        let mut cut = library(CPU_ARM64);
        cut.truncate(5070);
        assert_eq!(sign(&mut cut), Err(Malformed::NotMachO));
        let mut other = library(CPU_ARM64);
        other[5000 + 20 + 37] = 1;
        assert_eq!(sign(&mut other), Err(Malformed::UnknownSignature));
    }

    #[test]
    fn processors_stand_behind_each_other_on_pages() {
        let slices = [library(0x0100_0007), library(CPU_ARM64)];
        let file = universal(&slices).unwrap();
        assert_eq!(big(&file, 4), Ok(2));
        for (index, slice) in slices.iter().enumerate() {
            let entry = 8 + 20 * index;
            assert_eq!(big(&file, entry), little(slice, 4));
            let (start, length) = (big(&file, entry + 8), big(&file, entry + 12));
            let (start, length) = (start.unwrap() as usize, length.unwrap() as usize);
            assert_eq!(start % 16384, 0);
            assert_eq!(file[start..start + length], slice[..]);
        }
    }
}
