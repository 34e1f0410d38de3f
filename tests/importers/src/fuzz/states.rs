//! Hostile bytes for fmi2DeSerializeFMUstate: the answer is an error or a state, and either way the slave goes on.

use std::sync::Arc;

use geartrain::fmi2::abi::Status;
use sha2::{Digest, Sha256};

use crate::random::Random;
use crate::{Fmu, Host, Instance, STEP, bits};

/// Where a serialized state has its content and, before it, length and checksum (`slave/saved.rs`).
const CONTENT: usize = 60;
const LENGTH: core::ops::Range<usize> = 20..28;
const CHECKSUM: core::ops::Range<usize> = 28..60;

/// A slave gets changed states in between, and must then go on from a good one as its twin does without.
pub(super) fn case(fmu: &Arc<Fmu>, seed: u64) {
    let random = &mut Random::new(seed);
    let host = Host::load(fmu);
    let (instance, twin) = (host.running(), host.running());
    let steps = u32::try_from(random.below(20)).expect("few");
    instance.steps(0, steps);
    twin.steps(0, steps);
    let good = instance.save();
    let bytes = instance.bytes(&good);
    for _ in 0..20 {
        let mut changed = bytes.clone();
        for _ in 0..=random.below(3) {
            change(&mut changed, random);
        }
        if !random.once_in(4) {
            forge(&mut changed);
        }
        try_state(&instance, &changed, random);
    }
    instance.messages();
    instance.accepted(instance.restore(&good));
    assert_eq!(instance.bytes(&instance.save()), bytes, "saved again");
    instance.steps(steps, 5);
    twin.steps(steps, 5);
    assert_eq!(
        bits(&instance.everything()),
        bits(&twin.everything()),
        "a restored state goes on"
    );
}

/// Reads the bytes and lives with what they say.
fn try_state(instance: &Instance<'_>, bytes: &[u8], random: &mut Random) {
    let (status, made) = instance.read(bytes);
    let Some(state) = made else {
        let text = instance.refused(status);
        assert!(text.starts_with("fmi2DeSerializeFMUstate: "), "{text}");
        return;
    };
    instance.accepted(status);
    if instance.restore(&state) == Status::Ok {
        let (_, time) = instance.real_status(geartrain::fmi2::abi::LAST_SUCCESSFUL_TIME);
        let from = if random.once_in(4) { 0.0 } else { time };
        instance.step(from, STEP);
        instance.step(from + STEP, STEP);
        instance.exit();
        instance.everything_readable();
        let again = instance.save_quietly();
        no_panic(instance);
        instance.bytes(&again);
    }
    no_panic(instance);
}

/// Whatever the slave told, it was no panic.
fn no_panic(instance: &Instance<'_>) {
    for message in instance.messages() {
        let text = message.text.expect("a text");
        assert!(!text.contains("internal error"), "{text}");
    }
}

/// One change of the bytes.
fn change(bytes: &mut Vec<u8>, random: &mut Random) {
    let at = random.below(bytes.len().max(1));
    match random.below(7) {
        0 => bytes.truncate(at),
        1 => bytes.extend((0..random.below(40)).map(|_| random.byte())),
        2 if at + 8 <= bytes.len() => {
            let number = random.odd_number();
            bytes[at..at + 8].copy_from_slice(&number.to_le_bytes());
        }
        3 => drop(bytes.drain(at..(at + random.below(20)).min(bytes.len()))),
        4 => bytes.splice(at..at, [0xff; 9]).for_each(drop), // a length that never ends
        _ if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
        _ => {}
    }
}

/// Makes length and checksum fit the content again.
fn forge(bytes: &mut [u8]) {
    let Some(content) = bytes.get(CONTENT..) else {
        return;
    };
    let (length, checksum) = (content.len() as u64, Sha256::digest(content));
    bytes[LENGTH].copy_from_slice(&length.to_le_bytes());
    bytes[CHECKSUM].copy_from_slice(&checksum);
}
