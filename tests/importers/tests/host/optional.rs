//! Bad arguments of the functions behind capability flags.
//!
//! What holds whether a capability is declared or not: the answer is fmi2Error and a sentence, and no step ever
//! comes to know.

use geartrain::fmi2::abi::Status;
use importers::optional::{Derivatives, Direction};
use importers::{Host, Instance, bits};

const UNKNOWN: u32 = u32::MAX;

/// Some variable of each kind.
struct Variables {
    input: [u32; 1],
    output: [u32; 1],
    parameter: [u32; 1],
}

impl Variables {
    fn of(host: &Host) -> Variables {
        let reference = |name| [host.fmu().reference(name)];
        Variables {
            input: reference("stage1.b1.housing.x"),
            output: reference("stage1.b1.force_x"),
            parameter: reference("stage1.b1.stiffness.xx"),
        }
    }
}

/// Makes calls between steps; each has to be refused by `function`, and the steps must not notice.
fn all_refused(function: &str, calls: impl Fn(&Instance<'_>, &Variables) -> Vec<Status>) {
    let host = Host::of("three_stage");
    let (undisturbed, instance) = (host.running(), host.running());
    undisturbed.steps(0, 6);
    instance.steps(0, 3);
    let count = calls(&instance, &Variables::of(&host))
        .into_iter()
        .inspect(|&status| assert_eq!(status, Status::Error))
        .count();
    let messages = instance.messages();
    assert_eq!(messages.len(), count, "one sentence each: {messages:?}");
    for message in messages {
        let text = message.text.expect("a text");
        assert!(text.starts_with(function), "{text}");
    }
    instance.steps(3, 3);
    let forces = |instance: &Instance<'_>| bits(&[instance.value("mesh12.force")]);
    assert_eq!(forces(&instance), forces(&undisturbed));
}

#[test]
fn bad_input_derivatives_are_refused() {
    all_refused("fmi2SetRealInputDerivatives: ", |instance, variables| {
        let good = Derivatives {
            count: 1,
            references: Some(&variables.input),
            orders: Some(&[1]),
            values: Some(&[1e-3]),
        };
        let unknown = Some(&[UNKNOWN; 1][..]);
        [
            Derivatives {
                references: None,
                ..good
            },
            Derivatives {
                orders: None,
                ..good
            },
            Derivatives {
                values: None,
                ..good
            },
            Derivatives {
                references: unknown,
                ..good
            },
            Derivatives {
                references: Some(&variables.output),
                ..good
            },
            Derivatives {
                references: Some(&variables.parameter),
                ..good
            },
            Derivatives {
                orders: Some(&[0]),
                ..good
            }, // FMI 2.0.4, 4.2.1: order 1 or more
            Derivatives {
                orders: Some(&[-1]),
                ..good
            },
            Derivatives {
                values: Some(&[f64::NAN]),
                ..good
            },
            Derivatives {
                values: Some(&[f64::INFINITY]),
                ..good
            },
        ]
        .map(|arrays| instance.set_input_derivatives(arrays))
        .to_vec()
    });
}

#[test]
fn bad_output_derivatives_are_refused() {
    all_refused("fmi2GetRealOutputDerivatives: ", |instance, variables| {
        let good = Derivatives {
            count: 1,
            references: Some(&variables.output),
            orders: Some(&[1]),
            values: Some(&[0.0]),
        };
        let unknown = Some(&[UNKNOWN; 1][..]);
        [
            Derivatives {
                references: None,
                ..good
            },
            Derivatives {
                orders: None,
                ..good
            },
            Derivatives {
                values: None,
                ..good
            },
            Derivatives {
                references: unknown,
                ..good
            },
            Derivatives {
                references: Some(&variables.input),
                ..good
            },
            Derivatives {
                references: Some(&variables.parameter),
                ..good
            },
            Derivatives {
                orders: Some(&[0]),
                ..good
            },
            Derivatives {
                orders: Some(&[-1]),
                ..good
            },
            Derivatives {
                orders: Some(&[1000]),
                ..good
            },
        ]
        .map(|arrays| instance.get_output_derivatives(arrays))
        .to_vec()
    });
}

#[test]
fn bad_directions_are_refused() {
    all_refused("fmi2GetDirectionalDerivative: ", |instance, variables| {
        let good = Direction {
            counts: [1, 1],
            unknowns: Some(&variables.output),
            knowns: Some(&variables.input),
            seed: Some(&[1.0]),
            result: true,
        };
        let unknown = Some(&[UNKNOWN; 1][..]);
        [
            Direction {
                unknowns: None,
                ..good
            },
            Direction {
                knowns: None,
                ..good
            },
            Direction { seed: None, ..good },
            Direction {
                result: false,
                ..good
            },
            Direction {
                unknowns: unknown,
                ..good
            },
            Direction {
                knowns: unknown,
                ..good
            },
            Direction {
                unknowns: Some(&variables.input),
                ..good
            },
            Direction {
                knowns: Some(&variables.output),
                ..good
            },
        ]
        .map(|arrays| instance.get_directional_derivative(arrays))
        .to_vec()
    });
}

#[test]
fn states_that_do_not_exist_are_refused() {
    all_refused("fmi2GetFMUstate: ", |instance, _| {
        vec![instance.save_into_nothing()]
    });
    all_refused("fmi2SetFMUstate: ", |instance, _| {
        vec![instance.restore_nothing()]
    });
    all_refused("fmi2Serialize", |instance, _| {
        instance.serialize_nothing().to_vec()
    });
}

#[test]
fn bytes_that_are_no_state_are_refused() {
    all_refused("fmi2DeSerializeFMUstate: ", |instance, _| {
        let noise: Vec<u8> = (0..100_000_u32)
            .map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8)
            .collect();
        let mut statuses = Vec::new();
        for count in [0, 1, 7, 8, 64, 1000, noise.len()] {
            for bytes in [&vec![0; count], &vec![0xff; count], &noise] {
                let (status, made) = instance.deserialize(Some(bytes), count);
                assert!(!made, "{count} bytes");
                statuses.push(status);
            }
        }
        statuses.push(instance.deserialize(None, 0).0);
        statuses.push(instance.deserialize(None, 100).0);
        statuses
    });
}
