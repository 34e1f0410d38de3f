//! Static shapes: few coordinates, exact statics.
//!
//! Authority: the full finite-element model. Conventions of `src/rotor/static_shapes.rs`.

mod support;

use geartrain::config::BasisModes;
use geartrain::linalg::natural_modes;
use geartrain::rotor::{FiniteElements, ModalRotor, ModeCounts};
use geartrain::train::{Basis, Rotor};
use nalgebra::{DMatrix, DVector};
use support::{head, valid};

/// A shaft with two gears, two uneven bearings, a torque off the gears, and `extra` on it.
fn shaft(bearings: &str, extra: &str) -> Rotor {
    let text = format!(
        "{}[[rotor]]\nname = \"r\"\nspeed = 200.0\nmax_element_length = 0.04\n\
         lateral_damping_ratio = 0.02\ntorsional_damping_ratio = 0.03\n\
         [[rotor.segment]]\nlength = 0.3\nouter_diameter = 0.05\n\
         [[rotor.segment]]\nlength = 0.5\nouter_diameter = 0.07\ninner_diameter = 0.02\n\
         [[rotor.gear]]\nname = \"g1\"\nposition = 0.22\nteeth = 24\nbase_radius = 0.07\n\
         mass = 5.0\npolar_inertia = 0.015\ndiametral_inertia = 0.008\n\
         [[rotor.gear]]\nname = \"g2\"\nposition = 0.61\nteeth = 50\nbase_radius = 0.15\n\
         mass = 15.0\npolar_inertia = 0.15\ndiametral_inertia = 0.08\n\
         [[rotor.torque]]\nname = \"port\"\nposition = 0.0\nvalue = 10.0\nslope = 0.2\n{bearings}{extra}",
        head(1, 1)
    );
    valid(&text).train.rotors[0].clone()
}

const CROSSED: &str = "[[rotor.bearing]]\nname = \"b1\"\nposition = 0.05\n\
     stiffness = { xx = 8e7, yy = 5e7, xy = 2e7, yx = -3e7 }\ndamping = { xx = 900.0 }\n\
     [[rotor.bearing]]\nname = \"b2\"\nposition = 0.78\nstiffness = { xx = 3e8 }\n";
const SUPPORT: &str = "[[rotor.basis_support]]\nposition = 0.5\nlateral = 4e6\ntorsional = 2e4\n";

fn basis(lateral_modes: usize, torsional_modes: usize) -> Basis {
    Basis {
        modes: BasisModes::Counts {
            lateral_modes,
            torsional_modes,
        },
        static_shapes: true,
    }
}

fn reduced(rotor: &Rotor, basis: &Basis, counts: Option<ModeCounts>) -> ModalRotor {
    ModalRotor::reduce(rotor, basis, counts).unwrap_or_else(|error| panic!("{error}"))
}

/// Where unit loads act, in both planes together (x first), as degrees of freedom and as modal rows.
fn lateral_places(rotor: &Rotor, modal: &ModalRotor) -> Vec<(usize, DVector<f64>)> {
    let gears = rotor.gears.iter().map(|gear| gear.body.position);
    let bearings = rotor.bearings.iter().map(|bearing| bearing.position);
    let positions: Vec<f64> = gears.chain(bearings).collect();
    let (n, size) = (modal.counts().lateral, 2 * modal.stations.count());
    let mut places = Vec::new();
    for plane in [0, 1] {
        for &position in &positions {
            let mut row = DVector::zeros(2 * n);
            row.rows_mut(plane * n, n)
                .copy_from_slice(&modal.lateral_row(position));
            places.push((plane * size + 2 * modal.stations.at(position), row));
        }
    }
    places
}

/// Largest error of any static compliance between loaded places, relative to the largest compliance of its row.
fn compliance_error(
    full: &DMatrix<f64>,
    reduced: &DMatrix<f64>,
    places: &[(usize, DVector<f64>)],
) -> f64 {
    let (full, reduced) = (full.clone().lu(), reduced.clone().lu());
    let mut worst: f64 = 0.0;
    for (index, row) in places {
        let mut force = DVector::zeros(full.l().nrows());
        force[*index] = 1.0;
        let exact = full.solve(&force).unwrap();
        let mut load = DVector::zeros(reduced.l().nrows());
        load.rows_mut(0, row.len()).copy_from(row);
        let found = reduced.solve(&load).unwrap();
        let size = places
            .iter()
            .map(|(to, _)| exact[*to].abs())
            .fold(0.0, f64::max);
        for (to, row) in places {
            let found = row.dot(&found.rows(0, row.len()));
            worst = worst.max((found - exact[*to]).abs() / size);
        }
    }
    worst
}

/// K of both planes of the finite-element model with all bearings, 4N x 4N.
fn full_lateral(rotor: &Rotor, elements: &FiniteElements) -> DMatrix<f64> {
    let n = elements.mass.nrows();
    let mut stiffness = DMatrix::zeros(2 * n, 2 * n);
    for plane in [0, n] {
        stiffness
            .view_mut((plane, plane), (n, n))
            .copy_from(&elements.shaft_stiffness);
    }
    for bearing in &rotor.bearings {
        let index = 2 * elements.stations.at(bearing.position);
        let rows = bearing.coefficients(rotor.speed).stiffness.rows();
        for (i, row) in rows.iter().enumerate() {
            for (j, k) in row.iter().enumerate() {
                stiffness[(i * n + index, j * n + index)] += k;
            }
        }
    }
    stiffness
}

/// A singular stiffness bordered with the momentum of its strainless motions: loads are then balanced by the
/// inertia forces of a rigid acceleration, and the mean motion is zero.
fn bordered(stiffness: &DMatrix<f64>, momenta: &DMatrix<f64>) -> DMatrix<f64> {
    let (n, m) = momenta.shape();
    let mut matrix = DMatrix::zeros(n + m, n + m);
    matrix.view_mut((0, 0), (n, n)).copy_from(stiffness);
    matrix.view_mut((0, n), (n, m)).copy_from(momenta);
    matrix
        .view_mut((n, 0), (m, n))
        .copy_from(&momenta.transpose());
    matrix
}

#[test]
fn lateral_compliances_are_those_of_the_full_model_with_few_modes() {
    for extra in ["", SUPPORT] {
        for modes in [1, 2, 5, 12] {
            let rotor = shaft(CROSSED, extra);
            let modal = reduced(&rotor, &basis(modes, 1), None);
            let full = full_lateral(&rotor, &FiniteElements::assemble(&rotor));
            let places = lateral_places(&rotor, &modal);
            let error = compliance_error(&full, &modal.lateral_stiffness, &places);
            // Measured 7e-13; a shape with less than 1e-12 of the energy is left out.
            assert!(error < 1e-9, "{modes} modes, {extra}: {error:e}");
            assert_eq!(
                modal.lateral_frequencies.len(),
                modes,
                "shapes are not listed"
            );
            assert_eq!(modal.counts().lateral, modes + 4, "two gears, two bearings");
        }
    }
}

#[test]
fn torsional_compliances_are_those_of_the_free_shaft_with_few_modes() {
    for extra in ["", SUPPORT] {
        for modes in [1, 3, 8] {
            let rotor = shaft(CROSSED, extra);
            let modal = reduced(&rotor, &basis(1, modes), None);
            let elements = FiniteElements::assemble(&rotor);
            let positions = [0.0, 0.22, 0.61];
            let place = |position: f64| {
                let row = DVector::from_vec(modal.torsional_row(position));
                (modal.stations.at(position), row)
            };
            let momentum = DMatrix::from_columns(&[elements.inertia.column_sum()]);
            let modal_momentum =
                DMatrix::from_columns(&[
                    DVector::from_row_slice(&modal.mean_rotation) * modal.inertia
                ]);
            let error = compliance_error(
                &bordered(&elements.torsional_stiffness, &momentum),
                &bordered(&modal.torsional_stiffness, &modal_momentum),
                &positions.map(place),
            );
            assert!(error < 1e-9, "{modes} modes, {extra}: {error:e}");
            assert_eq!(modal.torsional_frequencies.len(), modes);
        }
    }
}

#[test]
fn a_shaft_that_no_bearing_holds_keeps_its_rigid_motions_and_its_bending_under_load() {
    // Without bearings, with a nominal support in the basis or without one.
    let support = "[[rotor.basis_support]]\nposition = 0.5\nlateral = 4e6\n";
    for (extra, modes) in [("", 2), ("", 4), (support, 2), (support, 6)] {
        let rotor = shaft("", extra);
        let modal = reduced(&rotor, &basis(modes, 1), None);
        let elements = FiniteElements::assemble(&rotor);
        let size = elements.mass.nrows();
        let motions = DMatrix::from_fn(size, 2, |i, motion| match (i % 2, motion) {
            (0, 0) | (1, 1) => 1.0,
            (0, 1) => elements.stations.positions()[i / 2],
            _ => 0.0,
        });
        let momenta = &elements.mass * &motions;
        let n = modal.counts().lateral;
        let one_plane = modal.lateral_stiffness.view((0, 0), (n, n)).into_owned();
        let modal_momenta = modal.lateral_shapes.transpose() * &momenta;
        let places: Vec<_> = [0.22, 0.61]
            .map(|position| {
                let row = DVector::from_vec(modal.lateral_row(position));
                (2 * modal.stations.at(position), row)
            })
            .into();
        let error = compliance_error(
            &bordered(&elements.shaft_stiffness, &momenta),
            &bordered(&one_plane, &modal_momenta),
            &places,
        );
        assert!(error < 1e-9, "{modes} modes, {extra}: {error:e}");
        // The rigid motions themselves: momentum of a mass-normalised basis is complete.
        let kinetic = modal_momenta.transpose() * &modal_momenta;
        let exact = motions.transpose() * &momenta;
        assert!(
            (kinetic - &exact).amax() < 1e-9 * exact.amax(),
            "{modes} modes, {extra}"
        );
    }
}

#[test]
fn the_basis_is_orthonormal_and_diagonal_with_its_supports() {
    let rotor = shaft(CROSSED, SUPPORT);
    let modal = reduced(&rotor, &basis(3, 2), None);
    let elements = FiniteElements::assemble(&rotor);
    let at = 2 * elements.stations.at(0.5);
    let mut supported = elements.shaft_stiffness.clone();
    supported[(at, at)] += 4e6;
    for bearing in &rotor.bearings {
        let at = 2 * elements.stations.at(bearing.position);
        supported[(at, at)] += bearing.coefficients(rotor.speed).stiffness.xx;
    }
    let phi = &modal.lateral_shapes;
    let mass = phi.transpose() * &elements.mass * phi;
    // 1e-10: the stiffest static shape is made of differences of 1e-4 between deflections.
    assert!((mass - DMatrix::identity(phi.ncols(), phi.ncols())).amax() < 1e-10);
    let mut stiffness = phi.transpose() * supported * phi;
    let largest = stiffness.diagonal().amax();
    stiffness.fill_diagonal(0.0);
    assert!(stiffness.amax() < 1e-10 * largest);
}

#[test]
fn modal_damping_reaches_the_static_shapes_as_it_does_in_the_full_model() {
    let rotor = shaft(CROSSED, "");
    let modal = reduced(&rotor, &basis(2, 2), None);
    let elements = FiniteElements::assemble(&rotor);
    let mut held = elements.shaft_stiffness.clone();
    for bearing in &rotor.bearings {
        let at = 2 * elements.stations.at(bearing.position);
        held[(at, at)] += bearing.coefficients(rotor.speed).stiffness.xx;
    }
    // C = M V diag(2 zeta w) V'M over all modes of the finite-element model.
    let damping = |stiffness: &DMatrix<f64>, mass: &DMatrix<f64>, ratio: f64| {
        let modes = natural_modes(stiffness, mass).unwrap();
        let rates = modes
            .squared_frequencies
            .iter()
            .map(|w2| 2.0 * ratio * w2.sqrt());
        let weighted = mass * &modes.shapes;
        let rates = DVector::from_iterator(modes.shapes.ncols(), rates);
        &weighted * DMatrix::from_diagonal(&rates) * weighted.transpose()
    };
    let (phi, n) = (&modal.lateral_shapes, modal.counts().lateral);
    let mut exact = phi.transpose() * damping(&held, &elements.mass, 0.02) * phi;
    let row = DVector::from_vec(modal.lateral_row(0.05));
    exact += 900.0 * &row * row.transpose();
    let found = modal.lateral_damping.view((0, 0), (n, n));
    // 1e-9: orthogonality of the highest modes in double precision.
    assert!((found - &exact).amax() < 1e-9 * exact.amax());

    let phi = &modal.torsional_shapes;
    let mut exact =
        phi.transpose() * damping(&elements.torsional_stiffness, &elements.inertia, 0.03) * phi;
    let row = DVector::from_vec(modal.torsional_row(0.0));
    exact += 0.2 * &row * row.transpose();
    assert!((&modal.torsional_damping - &exact).amax() < 1e-9 * exact.amax());
}

#[test]
fn shapes_that_add_nothing_are_left_out() {
    // With every mode there is nothing to add; a bearing on the spot of a gear adds one shape for both.
    let rotor = shaft(CROSSED, "");
    let stations = FiniteElements::assemble(&rotor).stations.count();
    let modal = reduced(&rotor, &basis(2 * stations, stations), None);
    let counts = modal.counts();
    assert_eq!((counts.lateral, counts.torsional), (2 * stations, stations));
    let shared = shaft(&CROSSED.replace("position = 0.78", "position = 0.61"), "");
    assert_eq!(reduced(&shared, &basis(2, 1), None).counts().lateral, 2 + 3);
}

#[test]
fn neighbours_give_independent_shapes_and_exact_statics() {
    // A bearing a hundredth of a millimetre from a gear.
    let rotor = shaft(
        &CROSSED.replace("position = 0.78", "position = 0.61001"),
        "",
    );
    let modal = reduced(&rotor, &basis(3, 1), None);
    let full = full_lateral(&rotor, &FiniteElements::assemble(&rotor));
    let places = lateral_places(&rotor, &modal);
    let error = compliance_error(&full, &modal.lateral_stiffness, &places);
    // 1e-7: elements of a hundredth of a millimetre beside others of 40 mm leave no more of the full model.
    assert!(error < 1e-7, "{error:e}");
}

#[test]
fn softly_held_shafts_bend_as_stiffly_held_ones_do() {
    // On two bearings the bending under a load at a gear, seen from the line through the bearings, does not depend on
    // how stiff they are; the shaft as a whole moves 1e-9 / k of it.
    let bending = |stiffness: &str| {
        let bearings = CROSSED.replace("xx = 8e7, yy = 5e7, xy = 2e7, yx = -3e7", "xx = 3e8");
        let rotor = shaft(
            &bearings.replace("xx = 3e8", &format!("xx = {stiffness}")),
            "",
        );
        let modal = reduced(&rotor, &basis(2, 1), None);
        assert_eq!(modal.counts().lateral, 2 + 4, "{stiffness} N/m");
        let row = |position| DVector::from_vec(modal.lateral_row(position));
        let relative = row(0.61) - row(0.05) * (0.17 / 0.73) - row(0.78) * (0.56 / 0.73);
        let plane = modal.lateral_stiffness.view((0, 0), (6, 6)).into_owned();
        relative.dot(&plane.lu().solve(&row(0.61)).unwrap())
    };
    let exact = bending("1e9");
    for (stiffness, tolerance) in [("1e6", 1e-9), ("1e3", 1e-8), ("1.0", 1e-6), ("1e-3", 1e-2)] {
        // 1e-16 of a motion of 1 / k beside a bending of 1e-9 m; 1e-3 N/m is 1e-13 of the shaft's own stiffness.
        let found = bending(stiffness);
        assert!(
            (found / exact - 1.0).abs() < tolerance,
            "{stiffness}: {:e}",
            found / exact - 1.0
        );
    }
}

#[test]
fn changed_parameters_keep_the_numbers_of_modes_and_shapes() {
    let rotor = shaft(CROSSED, "");
    let counts = reduced(&rotor, &basis(4, 2), None).counts();
    // Bearings from nothing to rigid: the same coordinates, and exact statics where there are any.
    for stiffness in ["1e-3", "1e3", "1e12", "1e15"] {
        let changed = CROSSED.replace("xx = 8e7", &format!("xx = {stiffness}"));
        let modal = reduced(&shaft(&changed, ""), &basis(4, 2), Some(counts));
        assert_eq!(modal.counts(), counts, "{stiffness} N/m");
        assert!(modal.lateral_shapes.iter().all(|value| value.is_finite()));
    }
    // As many coordinates as the shaft has: shapes become modes.
    let stations = FiniteElements::assemble(&rotor).stations.count();
    let most = ModeCounts {
        lateral: 2 * stations,
        torsional: stations,
        ..counts
    };
    let modal = reduced(&rotor, &basis(4, 2), Some(most));
    assert_eq!(modal.counts(), most);
    let full = full_lateral(&rotor, &FiniteElements::assemble(&rotor));
    let places = lateral_places(&rotor, &modal);
    let error = compliance_error(&full, &modal.lateral_stiffness, &places);
    assert!(error < 1e-9, "{error:e}");
    let more = ModeCounts {
        lateral: 2 * stations + 1,
        ..most
    };
    assert!(ModalRotor::reduce(&rotor, &basis(4, 2), Some(more)).is_err());
}
