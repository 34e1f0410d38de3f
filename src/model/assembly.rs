//! From a valid gear train to its modal model: rotors reduced, couplings added in their order.
//!
//! Couplings stand in the order meshes, radial bearings, free rotations; the laws of [`super::Excitation`] find theirs by
//! the number of the first one.

use super::bearing_force::BearingForce;
use super::inputs::{self, SupportVibration};
use super::known_bearings::KnownBearings;
use super::layout::{Coordinates, Layout};
use super::radial::RadialBearing;
use super::spin::{SpeedBearing, Spin};
use super::{Bearing, Housing, Mesh, ModalModel, Point, Rotor, Station, excitation, monitors};
use crate::config::{Planar, SpeedMode, TorqueCoupling};
use crate::mesh::{GearMotion, LineOfAction};
use crate::rotor::{ModalRotor, ModeCounts, ReductionError};
use crate::solver::{Coupling, Row, System};
use crate::train::{self, GearAddress, GearTrain};

impl ModalModel {
    /// Reduces every rotor and couples them. `counts` fixes the number of modes of each rotor; otherwise
    /// the train's basis decides.
    pub fn assemble(
        train: &GearTrain,
        counts: Option<&[ModeCounts]>,
    ) -> Result<ModalModel, ReductionError> {
        let free = train.simulation.speed == SpeedMode::Free;
        let mut reduced = Vec::new();
        for (index, rotor) in train.rotors.iter().enumerate() {
            let fixed = counts.map(|counts| counts[index]);
            reduced.push(ModalRotor::reduce(rotor, &train.basis, fixed)?);
        }
        let counts: Vec<ModeCounts> = reduced.iter().map(ModalRotor::counts).collect();
        let layout = layout_of(train, &counts);
        let housing = train.housing.as_ref();
        let housing = housing.map(|housing| Housing::of(housing, &layout.housing));
        let mut system = System {
            size: layout.size(),
            blocks: layout.empty_blocks(),
            ..System::default()
        };
        let mut rotors = Vec::new();
        let places = layout.lateral.into_iter().zip(layout.torsional);
        let mut input = 0;
        for ((rotor, modal), places) in train.rotors.iter().zip(reduced).zip(places) {
            let under = |bearing: usize| housing.as_ref()?.under(input + bearing);
            rotors.push(add_rotor(&mut system, rotor, modal, places, (free, &under)));
            input += rotor.bearings.len();
        }
        if let Some(housing) = &housing {
            let bearings = || rotors.iter().flat_map(|rotor| &rotor.bearings);
            let constant: Vec<(Planar, Planar)> = bearings()
                .map(|bearing| (bearing.stiffness, bearing.damping))
                .collect();
            housing.put(bearings(), |input| constant[input], &mut system.blocks);
        }
        let mut meshes = Vec::new();
        for mesh in &train.meshes {
            meshes.push(join(&mut system, &rotors, mesh, free));
        }
        let slack = meshes.iter().map(|mesh| mesh.slack(1.0)).reduce(f64::min);
        let radial = add_radial_bearings(&mut system, &rotors);
        system.springs = system.couplings.len();
        let mut spins = Vec::new();
        let vibration = SupportVibration::new(&train.gearbox_vibration);
        let mut harmonics = Vec::new();
        for (index, rotor) in train.rotors.iter().enumerate() {
            if free {
                spins.push(add_spin(
                    &mut system,
                    (&rotors, housing.as_ref()),
                    index,
                    rotor,
                ));
            } else {
                let bows = &rotors[index].modal.bows;
                harmonics.extend(excitation::rotating_load(rotor, &rotors[index], bows));
            }
        }
        system.loads = inputs::columns(&rotors, housing.as_ref());
        system.slow = spins.iter().map(|spin| rotors[spin.rotor].speed).collect();
        harmonics.extend(vibration.harmonic(&rotors, system.size));
        let bearing_forces = BearingForce::of_all(&mut system, &rotors);
        system.monitors = monitors::monitors(&system, &rotors, &meshes, &radial, &spins);
        let is_straight = radial.is_empty() && spins.is_empty();
        Ok(ModalModel {
            system,
            slack: slack.filter(|slack| slack.is_finite()).unwrap_or(0.0),
            is_straight,
            is_timed: is_straight && meshes.iter().all(Mesh::is_timed),
            meshes,
            radial,
            spins,
            harmonics,
            bearing_forces,
            vibration,
            known_bearings: known_bearings(train, housing.as_ref()),
            housing,
            rotors,
        })
    }
}

fn known_bearings(train: &GearTrain, housing: Option<&Housing>) -> Option<KnownBearings> {
    let points = &train.housing.as_ref()?.points;
    KnownBearings::of(housing?, points)
}

/// Where everything is; rotors with a bearing that the housing holds stand together with it.
fn layout_of(train: &GearTrain, counts: &[ModeCounts]) -> Layout {
    let Some(housing) = &train.housing else {
        return Layout::of(counts, &vec![false; counts.len()], 0);
    };
    let mut holds = housing.holds.iter();
    let held = train.rotors.iter().map(|rotor| {
        let own = holds.by_ref().take(rotor.bearings.len());
        own.filter(|point| point.is_some()).count() > 0
    });
    Layout::of(counts, &held.collect::<Vec<bool>>(), housing.modes.len())
}

/// Puts the rotor's stiffness and damping in their places: lateral and torsional.
fn add_rotor<'a>(
    system: &mut System,
    rotor: &train::Rotor,
    modal: ModalRotor,
    (lateral, torsional): (Coordinates, Coordinates),
    (free, under): (bool, &dyn Fn(usize) -> Option<&'a Point>),
) -> Rotor {
    lateral.put(
        &mut system.blocks,
        &modal.lateral_stiffness,
        &modal.lateral_damping,
    );
    torsional.put(
        &mut system.blocks,
        &modal.torsional_stiffness,
        &modal.torsional_damping,
    );
    let builder = StationBuilder {
        modal: &modal,
        lateral: &lateral,
        torsional: &torsional,
    };
    let station = |position: f64| builder.station(position);
    let bearing = |(index, bearing): (usize, &train::Bearing)| {
        let coefficients = bearing.coefficients(rotor.speed);
        let station = station(bearing.position);
        let mut relative = [station.x.clone(), station.y.clone()];
        for (row, point) in relative
            .iter_mut()
            .zip(under(index).iter().flat_map(|point| &point.rows))
        {
            row.add(-1.0, point);
        }
        Bearing {
            station,
            relative,
            stiffness: coefficients.stiffness,
            damping: coefficients.damping,
            follows_speed: free && bearing.depends_on_speed(),
            bearing: bearing.clone(),
        }
    };
    let bearings = rotor.bearings.iter().enumerate().map(bearing);
    let bearings: Vec<Bearing> = bearings.collect();
    Rotor {
        counts: modal.counts(),
        has_rigid_rotation: modal.has_rigid_rotation(),
        speed: rotor.speed,
        angle: rotor.angle,
        gears: rotor
            .gears
            .iter()
            .map(|gear| station(gear.body.position))
            .collect(),
        bearings,
        torques: rotor
            .torques
            .iter()
            .map(|torque| station(torque.position).theta)
            .collect(),
        unbalances: rotor
            .unbalances
            .iter()
            .map(|one| modal.lateral_row(one.position))
            .collect(),
        probes: rotor
            .probes
            .iter()
            .map(|probe| station(probe.position))
            .collect(),
        mean_rotation: torsional.row(&modal.mean_rotation),
        lateral_frequencies: modal.lateral_frequencies.clone(),
        torsional_frequencies: modal.torsional_frequencies.clone(),
        lateral,
        torsional,
        modal,
    }
}

/// Makes rows over the coordinates of one rotor.
struct StationBuilder<'a> {
    modal: &'a ModalRotor,
    lateral: &'a Coordinates,
    torsional: &'a Coordinates,
}

impl StationBuilder<'_> {
    fn station(&self, position: f64) -> Station {
        let phi = self.modal.lateral_row(position);
        let none = vec![0.0; phi.len()];
        Station {
            x: self.lateral.row(&[phi.as_slice(), &none].concat()),
            y: self.lateral.row(&[none.as_slice(), &phi].concat()),
            theta: self.torsional.row(&self.modal.torsional_row(position)),
        }
    }
}

/// A mesh and its couplings on the modal coordinates of its two rotors.
fn join(system: &mut System, rotors: &[Rotor], mesh: &train::Mesh, free: bool) -> Mesh {
    let first_coupling = system.couplings.len();
    let (row, rotation_row) = mesh_rows(rotors, mesh.gears, &mesh.line);
    let both = |row: &Row| Coupling {
        row: row.clone(),
        column: row.clone(),
    };
    match (mesh.torque_coupling, mesh.backlash) {
        (TorqueCoupling::AsPrinted, _) => {
            let mut lateral = row.clone();
            lateral.add(-1.0, &rotation_row);
            system.couplings.push(Coupling {
                row: row.clone(),
                column: lateral,
            });
            system.couplings.push(both(&rotation_row));
        }
        (TorqueCoupling::Consistent, None) => system.couplings.push(both(&row)),
        (TorqueCoupling::Consistent, Some(_)) => {
            let (back, _) = mesh_rows(rotors, mesh.gears, &mesh.line.opposite_flank());
            system.couplings.push(both(&row));
            system.couplings.push(both(&back));
        }
    }
    let couplings = first_coupling..system.couplings.len();
    let turning = free.then(|| {
        let gear = mesh.gears[0];
        system.couplings.push(Coupling {
            row: rotors[gear.rotor].gears[gear.gear].theta.clone(),
            column: Row::default(),
        });
        system.couplings.len() - 1
    });
    let joined = Mesh {
        gears: mesh.gears,
        row,
        rotation_row,
        line: mesh.line,
        torque_coupling: mesh.torque_coupling,
        damping: mesh.damping,
        law: mesh.stiffness.clone(),
        factor: mesh.stiffness_factor,
        error: mesh.transmission_error.clone(),
        backlash: mesh.backlash,
        start_phase: mesh.start_phase,
        pitches: mesh.pitches,
        phase_rate: mesh.phase_rate,
        turning,
        couplings,
        first_law: system.laws,
    };
    system.laws += joined.law_count();
    joined
}

/// delta as a row over the modal coordinates, and the part of it that comes from rotations.
fn mesh_rows(rotors: &[Rotor], gears: [GearAddress; 2], line: &LineOfAction) -> (Row, Row) {
    let (mut row, mut rotation_row) = (Row::default(), Row::default());
    for (gear, gradient) in gears.iter().zip(line.gradient()) {
        let station = &rotors[gear.rotor].gears[gear.gear];
        let GearMotion { x, y, theta } = gradient;
        row.add(x, &station.x);
        row.add(y, &station.y);
        row.add(theta, &station.theta);
        rotation_row.add(theta, &station.theta);
    }
    (row, rotation_row)
}

/// Two couplings for every bearing with a radial force.
fn add_radial_bearings(system: &mut System, rotors: &[Rotor]) -> Vec<RadialBearing> {
    let mut radial = Vec::new();
    let bearings = rotors
        .iter()
        .flat_map(|rotor| rotor.bearings.iter().map(move |bearing| (rotor, bearing)));
    for (input, (rotor, bearing)) in bearings.enumerate() {
        if let Some(force) = bearing.bearing.nonlinear {
            radial.push(RadialBearing {
                input,
                block: rotor.lateral.block(),
                force,
                first_coupling: system.couplings.len(),
                law: system.laws,
            });
            for row in &bearing.relative {
                system.couplings.push(Coupling {
                    row: row.clone(),
                    column: row.clone(),
                });
            }
            system.laws += 1;
        }
    }
    radial
}

/// The couplings of a rotor that turns freely: two that observe, one on every lateral coordinate, and two at every point of the
/// housing that holds a bearing which depends on the speed.
fn add_spin(
    system: &mut System,
    (rotors, housing): (&[Rotor], Option<&Housing>),
    index: usize,
    rotor: &train::Rotor,
) -> Spin {
    let modal = &rotors[index];
    let n = modal.counts.lateral;
    let rigid = modal.torsional.range().start;
    let rotation = modal.mean_rotation.entry(rigid);
    let entries = |columns: &mut dyn Iterator<Item = &Row>| -> Vec<(usize, f64)> {
        let numbered = columns.map(|column| column.entry(rigid)).enumerate();
        numbered.filter(|&(_, entry)| entry != 0.0).collect()
    };
    let torques = entries(&mut system.couplings.iter().map(|coupling| &coupling.column));
    let loads = entries(&mut inputs::columns(rotors, housing).iter());
    let drag = &system.blocks[modal.torsional.block()].damping;
    let drag: Vec<f64> = drag.row(0).iter().copied().collect();
    let drag = modal.torsional.row(&drag);
    let turn = system.couplings.len();
    for row in [modal.mean_rotation.clone(), drag] {
        system.couplings.push(Coupling {
            row,
            column: Row::default(),
        });
    }
    for i in 0..2 * n {
        let mut unit = vec![0.0; 2 * n];
        unit[i] = 1.0;
        let unit = modal.lateral.row(&unit);
        system.couplings.push(Coupling {
            row: unit.clone(),
            column: unit,
        });
    }
    let unbalances = rotor.unbalances.iter().zip(&modal.unbalances);
    let inputs_before: usize = rotors[..index]
        .iter()
        .map(|rotor| rotor.bearings.len())
        .sum();
    let bearings = rotor.bearings.iter().enumerate();
    let bearings = bearings.filter(|(_, bearing)| bearing.depends_on_speed());
    let bearings = bearings.map(|(number, bearing)| {
        let input = inputs_before + number;
        let point = housing.and_then(|housing| housing.under(input));
        let held = point.map(|point| {
            let first = system.couplings.len();
            let pushed = |row: &Row| Coupling {
                row: row.clone(),
                column: row.clone(),
            };
            system.couplings.extend(point.rows.iter().map(pushed));
            first
        });
        SpeedBearing {
            shape: modal.modal.lateral_row(bearing.position),
            input,
            held,
            law: bearing.clone(),
        }
    });
    let bearings = bearings.collect();
    Spin {
        rotor: index,
        turn,
        drag: turn + 1,
        first: turn + 2,
        n,
        rigid,
        rotation,
        torques,
        loads,
        angle: rotor.angle,
        gyroscopic: modal.modal.gyroscopic().clone(),
        unbalances: unbalances
            .map(|(one, shape)| (shape.clone(), one.moment, one.phase))
            .collect(),
        bows: modal.modal.bows.clone(),
        bearings,
    }
}
