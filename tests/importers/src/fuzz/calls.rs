//! Random sequences of calls, with a twin that gets only what the slave accepted.
//!
//! Whatever was refused must have changed nothing: in the end both have the same bits, and until then both give the same
//! answers. A call that the table of states does not allow must have been refused.

use std::sync::Arc;

use geartrain::fmi2::abi::{LAST_SUCCESSFUL_TIME, Status};

use crate::calls::{CALLS, State};
use crate::optional::{Derivatives, Direction};
use crate::random::Random;
use crate::state::Saved;
use crate::{Fmu, Host, Instance, Reals, STEP, bits};

/// Calls of a sequence.
const LENGTH: usize = 80;

/// A call with its arguments.
#[derive(Debug, Clone)]
enum Op {
    /// An entry of the table, with harmless arguments.
    Table(usize),
    Setup(Option<f64>, f64, Option<f64>),
    Set(Vec<u32>, Vec<f64>),
    Get(Vec<u32>),
    Step {
        time: f64,
        step: f64,
    },
    Save,
    Restore(usize),
    SetInputDerivatives(Vec<u32>, Vec<i32>, Vec<f64>),
    GetOutputDerivatives(Vec<u32>, Vec<i32>),
    Directional(Vec<u32>, Vec<u32>, Vec<f64>),
}

/// What a call gave.
#[derive(Debug, PartialEq, Eq)]
struct Answer {
    status: Status,
    /// Bits of the values that were read.
    values: Vec<u64>,
    /// A step that was begun and failed: the only refusal that changes something.
    failed: bool,
}

/// A slave, where it should be in its life, and its saved states with where they were saved.
struct Player<'i, 'h> {
    instance: &'i Instance<'h>,
    state: State,
    saved: Vec<(Saved<'i, 'h>, State)>,
}

/// A sequence of calls from a seed.
pub(super) fn case(fmu: &Arc<Fmu>, seed: u64) {
    let random = &mut Random::new(seed);
    let host = Host::load(fmu);
    let (one, other) = (host.instance(), host.instance());
    let (mut player, mut twin) = (Player::new(&one), Player::new(&other));
    let on_the_way = [
        Op::Setup(None, 0.0, None),
        Op::Table(entry("fmi2EnterInitializationMode")),
        Op::Table(entry("fmi2ExitInitializationMode")),
    ];
    let mut prepared = on_the_way.into_iter().take(random.below(4));
    for _ in 0..LENGTH {
        let op = prepared.next().unwrap_or_else(|| any(random, &player));
        let answer = player.play(&op);
        if answer.status == Status::Ok || answer.failed {
            assert_eq!(twin.play(&op), answer, "{op:?}");
        }
    }
    let (found, expected) = (one.everything_readable(), other.everything_readable());
    assert_eq!(bits(&found), bits(&expected), "refused calls left a trace");
}

fn entry(name: &str) -> usize {
    let found = CALLS.iter().position(|call| call.name == name);
    found.unwrap_or_else(|| panic!("{name} is not in the table"))
}

impl<'i, 'h> Player<'i, 'h> {
    fn new(instance: &'i Instance<'h>) -> Self {
        Player {
            instance,
            state: State::Instantiated,
            saved: Vec::new(),
        }
    }

    fn play(&mut self, op: &Op) -> Answer {
        let name = op.function();
        let (status, values) = self.call(op);
        let messages = self.instance.messages();
        let text = match &messages[..] {
            [] => "",
            [message] => message.text.as_deref().expect("a text"),
            several => panic!("{op:?}: {several:?}"),
        };
        assert!(!text.contains("internal error"), "{op:?}: {text}");
        let legal = CALLS[entry(name)].legal.contains(&self.state);
        match status {
            Status::Ok => assert!(
                legal && text.is_empty(),
                "{op:?} in {:?}: {text}",
                self.state
            ),
            Status::Discard => assert!(legal && name.contains("Status"), "{op:?}"),
            Status::Error => assert!(text.starts_with(&format!("{name}: ")), "{op:?}: {text}"),
            other => panic!("{op:?}: {other:?}"),
        }
        let failed = legal && status == Status::Error && text.contains(" failed: ");
        self.follow(op, status, failed);
        Answer {
            status,
            values: bits(&values),
            failed,
        }
    }

    /// Where the slave should be after a call.
    fn follow(&mut self, op: &Op, status: Status, failed: bool) {
        if failed {
            self.state = State::Failed;
        } else if status == Status::Ok {
            self.state = match (op.function(), op) {
                ("fmi2EnterInitializationMode", _) => State::Initialization,
                ("fmi2ExitInitializationMode", _) => State::Stepping,
                ("fmi2Terminate", _) => State::Terminated,
                ("fmi2Reset", _) => State::Instantiated,
                (_, &Op::Restore(index)) if !self.saved.is_empty() => {
                    self.saved[index % self.saved.len()].1
                }
                _ => self.state,
            };
        }
    }

    /// The status, and the values that were read.
    fn call(&mut self, op: &Op) -> (Status, Vec<f64>) {
        let instance = self.instance;
        let status = match op {
            Op::Table(index) => instance.call(&CALLS[*index], self.time()),
            Op::Setup(tolerance, start, stop) => instance.setup(*tolerance, *start, *stop),
            Op::Set(references, values) => {
                instance.set_array::<Reals>(Some(references), references.len(), Some(values))
            }
            Op::Get(references) => {
                let mut values = vec![0.0; references.len()];
                let (count, into) = (references.len(), Some(&mut values[..]));
                let status = instance.get_array::<Reals>(Some(references), count, into);
                let values = if status == Status::Ok { values } else { vec![] };
                return (status, values);
            }
            Op::Step { time, step } => instance.step(*time, *step),
            Op::Save => {
                self.saved.push((instance.save_quietly(), self.state));
                Status::Ok
            }
            Op::Restore(index) if !self.saved.is_empty() => {
                instance.restore(&self.saved[*index % self.saved.len()].0)
            }
            Op::Restore(_) => instance.restore_nothing(),
            Op::SetInputDerivatives(references, orders, values) => {
                instance.set_input_derivatives(Derivatives {
                    count: references.len(),
                    references: Some(references),
                    orders: Some(orders),
                    values: Some(values),
                })
            }
            Op::GetOutputDerivatives(references, orders) => {
                instance.get_output_derivatives(Derivatives {
                    count: references.len(),
                    references: Some(references),
                    orders: Some(orders),
                    values: Some(&vec![0.0; references.len()]),
                })
            }
            Op::Directional(unknowns, knowns, seed) => {
                instance.get_directional_derivative(Direction {
                    counts: [unknowns.len(), knowns.len()],
                    unknowns: Some(unknowns),
                    knowns: Some(knowns),
                    seed: Some(seed),
                    result: true,
                })
            }
        };
        (status, vec![])
    }

    /// The slave's time [s]; 0 before it has one.
    fn time(&self) -> f64 {
        let (status, time) = self.instance.real_status(LAST_SUCCESSFUL_TIME);
        self.instance.messages();
        if status == Status::Ok { time } else { 0.0 }
    }
}

impl Op {
    fn function(&self) -> &'static str {
        match self {
            Op::Table(index) => CALLS[*index].name,
            Op::Setup(..) => "fmi2SetupExperiment",
            Op::Set(..) => "fmi2SetReal",
            Op::Get(_) => "fmi2GetReal",
            Op::Step { .. } => "fmi2DoStep",
            Op::Save => "fmi2GetFMUstate",
            Op::Restore(_) => "fmi2SetFMUstate",
            Op::SetInputDerivatives(..) => "fmi2SetRealInputDerivatives",
            Op::GetOutputDerivatives(..) => "fmi2GetRealOutputDerivatives",
            Op::Directional(..) => "fmi2GetDirectionalDerivative",
        }
    }
}

/// Any call; mostly one that could succeed.
fn any(random: &mut Random, player: &Player<'_, '_>) -> Op {
    let fmu = player.instance.host().fmu();
    let count = random.below(4);
    match random.below(16) {
        0..=2 => Op::Table(random.below(CALLS.len())),
        3 => Op::Setup(
            random.once_in(3).then(|| random.odd_number()),
            if random.once_in(3) {
                random.odd_number()
            } else {
                0.0
            },
            random.once_in(3).then(|| random.odd_number()),
        ),
        4..=6 => {
            let references = references(random, fmu, count);
            let values = references.iter().map(|&one| value(random, fmu, one));
            Op::Set(references.clone(), values.collect())
        }
        7 => Op::Get(references(random, fmu, count)),
        8 => Op::Save,
        9 => Op::Restore(random.below(100)),
        10 => {
            let values = (0..count).map(|_| random.odd_number()).collect();
            Op::SetInputDerivatives(
                references(random, fmu, count),
                orders(random, count),
                values,
            )
        }
        11 => Op::GetOutputDerivatives(references(random, fmu, count), orders(random, count)),
        12 => {
            let (unknowns, knowns) = (references(random, fmu, 3), references(random, fmu, count));
            let seed = (0..count).map(|_| random.odd_number()).collect();
            Op::Directional(unknowns, knowns, seed)
        }
        _ => step(random, player.time()),
    }
}

fn step(random: &mut Random, now: f64) -> Op {
    let time = if random.once_in(10) {
        random.odd_number()
    } else {
        now
    };
    // Not between 1e-4 s and what is refused as too long: those would be carried out, for hours.
    let odd = [
        0.0,
        -STEP,
        1e-16,
        5e-324,
        1e10,
        1e300,
        f64::NAN,
        f64::INFINITY,
    ];
    let step = match random.below(4) {
        0 => random.pick(&odd),
        1 => 5.0 * STEP * random.fraction(),
        _ => STEP,
    };
    Op::Step { time, step }
}

/// References to variables, preferably inputs, and now and then to nothing.
fn references(random: &mut Random, fmu: &Fmu, count: usize) -> Vec<u32> {
    let all = u32::try_from(fmu.variable_count()).expect("few");
    let one = |random: &mut Random| match random.below(8) {
        0 => u32::try_from(random.bits() >> 32).expect("32 bits"),
        1..=3 => u32::try_from(random.below(20)).expect("few"), // inputs come first
        _ => random.pick(&(0..all).collect::<Vec<_>>()),
    };
    (0..count).map(|_| one(random)).collect()
}

fn orders(random: &mut Random, count: usize) -> Vec<i32> {
    let order = |random: &mut Random| random.pick(&[1, 1, 1, 1, 1, 0, -1, 2, i32::MAX]);
    (0..count).map(|_| order(random)).collect()
}

/// A value near the start value, or an odd one.
fn value(random: &mut Random, fmu: &Fmu, reference: u32) -> f64 {
    match fmu.start_of(reference) {
        Some(start) if !random.once_in(5) => {
            start * (0.5 + random.fraction()) + 1e-6 * random.fraction()
        }
        _ => random.odd_number(),
    }
}
