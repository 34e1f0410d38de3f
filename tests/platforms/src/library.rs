//! What a shared library exports and needs, read from its bytes: ELF, PE and Mach-O.

use std::collections::BTreeSet;

use object::elf::DT_NEEDED;
use object::read::elf::ElfFile64;
use object::read::macho::{FatArch, MachOFatFile32};
use object::{Architecture, File, ImportFlags, NameOrOrdinal, Object};

/// Names of the exported functions and data, as C writes them.
pub fn exports(library: &[u8]) -> Vec<String> {
    let file = parse(library);
    let exports = file.exports().expect("exports");
    let names = exports.map(|export| match export.expect("an export").name() {
        NameOrOrdinal::Name(name) => text(name),
        NameOrOrdinal::Ordinal(number) => format!("number {number}"),
    });
    // Mach-O writes an underscore before every name of C.
    let prefix = if matches!(file, File::MachO64(_)) {
        "_"
    } else {
        ""
    };
    let mut names: Vec<String> = names
        .map(|name| name.strip_prefix(prefix).unwrap_or(&name).to_string())
        .collect();
    names.sort();
    names
}

/// The shared libraries it needs.
pub fn needed(library: &[u8]) -> BTreeSet<String> {
    if let Ok(elf) = ElfFile64::<object::Endianness>::parse(library) {
        let (sections, endian) = (elf.elf_section_table(), elf.endian());
        let table = sections.dynamic_table(endian, library).expect("a table");
        let needed = table.iter().filter(|entry| entry.tag == DT_NEEDED);
        return needed
            .map(|entry| text(table.string(entry).expect("a name")))
            .collect();
    }
    let file = parse(library);
    let imports = file.imports().expect("imports");
    imports
        .map(|import| text(import.expect("an import").library()))
        .collect()
}

/// The versions of glibc's functions that a library for Linux asks for, such as `[2, 14]`.
pub fn glibc_versions(library: &[u8]) -> BTreeSet<Vec<u32>> {
    let file = parse(library);
    let imports = file.imports().expect("imports");
    let versions = imports.filter_map(|import| match import.expect("an import").flags() {
        ImportFlags::Elf { version, .. } => version.map(text),
        _ => None,
    });
    versions
        .filter_map(|version| version.strip_prefix("GLIBC_").map(numbers))
        .collect()
}

/// The numbers of a version.
pub fn numbers(version: &str) -> Vec<u32> {
    let parts = version.split('.');
    parts.map(|part| part.parse().expect("a number")).collect()
}

/// The libraries in a file for macOS, with the processor that each is for.
pub fn slices(library: &[u8]) -> Vec<(Architecture, &[u8])> {
    let file = MachOFatFile32::parse(library).expect("a file for several processors");
    let slices = file.arches().iter();
    slices
        .map(|slice| (slice.architecture(), slice.data(library).expect("a slice")))
        .collect()
}

fn parse(library: &[u8]) -> File<'_> {
    File::parse(library).expect("a shared library")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
