//! FMUs packed one platform at a time become the FMU that is packed at once.

use fmu_build::{Archive, Platform, merge};
use platforms::named;

#[test]
fn merging_one_platform_after_the_other_gives_what_is_packed_at_once_byte_for_byte() {
    let folder = named("GEARTRAIN_PLATFORMS");
    let read = |path: &str| std::fs::read(folder.join(path)).expect(path);
    let parts = Platform::ALL.map(|platform| {
        let bytes = read(&format!("{}/three_stage.fmu", platform.folder()));
        Archive::from_bytes(&bytes).expect("an FMU")
    });
    // In another order than the one in which they are packed at once.
    let merged = parts
        .into_iter()
        .rev()
        .reduce(|one, other| merge(one, other).expect("the same model"));
    let merged = merged.expect("platforms").to_bytes().expect("a zip file");
    assert!(merged == read("three_stage.fmu"), "other bytes");
}
