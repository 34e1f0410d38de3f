//! The law of a mesh in its pieces.

use super::*;
use crate::config::TorqueCoupling;
use crate::mesh::{LineOfAction, TransmissionError};
use crate::solver::Row;
use crate::train::GearAddress;

fn mesh(phase_rate: f64) -> Mesh {
    Mesh {
        gears: [GearAddress { rotor: 0, gear: 0 }; 2],
        row: Row::default(),
        rotation_row: Row::default(),
        line: LineOfAction::external(0.0, 0.3, 1.0, 1.0, 1.0),
        torque_coupling: TorqueCoupling::Consistent,
        damping: 0.0,
        law: StiffnessLaw::rectangular(1.0, 2.0, 1.6),
        factor: 1.0,
        error: TransmissionError::new(&[]),
        backlash: None,
        start_phase: 0.25,
        pitches: 1.0,
        phase_rate,
        turning: None,
        couplings: 0..1,
        first_law: 0,
    }
}

fn breakpoint_after(mesh: &Mesh, time: f64) -> f64 {
    mesh.follow_time(time, &mut [Piece::default()])
}

#[test]
fn breakpoints_follow_each_other_in_either_direction() {
    // Phase 0.25 + rate t reaches 0.6, 1.0, 1.6 upwards and 0.0, -0.4, -1.0 downwards.
    for (rate, phases) in [(10.0, [0.6, 1.0, 1.6]), (-10.0, [0.0, -0.4, -1.0])] {
        let (mesh, mut time) = (mesh(rate), 0.0);
        for phase in phases {
            time = breakpoint_after(&mesh, time);
            assert!(
                (mesh.phase_at(time).value - phase).abs() < 1e-12,
                "rounding only"
            );
        }
    }
}

#[test]
fn breakpoints_never_repeat_however_long_the_run() {
    for start in [0.0, 1e3, 1e6, 1e9, -1e6] {
        let (mesh, mut time) = (mesh(1800.0), start);
        for _ in 0..20 {
            let next = breakpoint_after(&mesh, time);
            assert!(next > time, "{next} after {time}");
            time = next;
        }
    }
}

#[test]
fn a_piece_is_continued_to_both_of_its_ends() {
    for rate in [10.0, -10.0] {
        let mesh = mesh(rate);
        let first = breakpoint_after(&mesh, 0.0);
        let second = breakpoint_after(&mesh, first);
        let piece = |time: f64| piece_of(&mesh.law, mesh.phase_at(time).value);
        let value = |piece: Piece| mesh.stiffness_in(piece, mesh.phase_at(first));
        let (before, after) = (piece(0.5 * first), piece(0.5 * (first + second)));
        assert_ne!(value(before), value(after));
    }
}

#[test]
fn pieces_that_the_motion_ends_follow_each_other_in_either_direction() {
    let mesh = Mesh {
        turning: Some(0),
        ..mesh(0.0)
    };
    // The phase 0.25 + angle leaves the piece [0, 0.6) upwards at 0.6 and downwards at 0.
    let look = |angle: f64, from: Piece| {
        let at = Instant {
            time: 0.0,
            deflection: &[angle],
            rate: &[1.0],
            slow: &[],
        };
        (mesh.margin(0, from, at), mesh.next_piece(0, from, at))
    };
    let first = Piece {
        origin: 0.0,
        index: 0,
    };
    let (margin, next) = look(0.351, first);
    assert!(
        margin < 0.0
            && next
                == Piece {
                    origin: 0.0,
                    index: 1
                }
    );
    let (margin, next) = look(-0.251, first);
    assert!(
        margin < 0.0
            && next
                == Piece {
                    origin: -1.0,
                    index: 1
                }
    );
    let (margin, next) = look(
        0.76,
        Piece {
            origin: 0.0,
            index: 1,
        },
    );
    assert!(
        margin < 0.0
            && next
                == Piece {
                    origin: 1.0,
                    index: 0
                }
    );
}
