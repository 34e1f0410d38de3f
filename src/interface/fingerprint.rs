//! The guid: a fingerprint of the whole interface and model, so that an importer's XML and the library it
//! loads cannot disagree silently.

use core::fmt::Write;

use sha2::{Digest, Sha256};

use super::Interface;
use crate::config::Config;

/// SHA-256 over the version of this library, every row of the table and the model, shortened to the
/// customary form `{xxxxxxxx-xxxx-xxxx-xxxx-xxxxxxxxxxxx}`.
pub(super) fn fingerprint(interface: &Interface, config: &Config) -> String {
    let mut hasher = Sha256::new();
    hasher.update(concat!("geartrain ", env!("CARGO_PKG_VERSION"), "\n"));
    for variable in &interface.variables {
        let (name, unit, causality) = (&variable.name, variable.unit.name(), variable.causality());
        let start = variable.start.map(f64::to_bits);
        hasher.update(format!(
            "{name}|{unit}|{causality:?}|{start:?}|{}\n",
            variable.description
        ));
    }
    hasher.update(config.to_bytes());
    let digest = hasher.finalize();
    let mut guid = String::from("{");
    for (index, byte) in digest.iter().take(16).enumerate() {
        if [4, 6, 8, 10].contains(&index) {
            guid.push('-');
        }
        let _ = write!(guid, "{byte:02x}"); // writing to a String cannot fail
    }
    guid.push('}');
    guid
}
