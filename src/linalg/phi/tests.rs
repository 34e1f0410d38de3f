//! Phi functions against series, identities and each other.

use super::*;

/// phi_k of a diagonalizable matrix by its eigenvalues: V f(L) V^-1.
fn rotated(values: [f64; 2]) -> (DMatrix<f64>, impl Fn([f64; 2]) -> DMatrix<f64>) {
    let shapes = DMatrix::from_row_slice(2, 2, &[1.0, 0.3, -0.2, 1.0]);
    let inverse = shapes.clone().try_inverse().unwrap();
    let build = move |values: [f64; 2]| {
        &shapes * DMatrix::from_diagonal(&nalgebra::DVector::from_row_slice(&values)) * &inverse
    };
    (build(values), build)
}

fn functions(matrix: &DMatrix<f64>) -> [DMatrix<f64>; PHI_ORDERS] {
    let m = matrix.nrows();
    let mut functions = PhiFunctions::new(m);
    if let Some(small) = SmallPhi::of(matrix, [1.0, 0.3, 0.7, 1.0], &mut functions) {
        let shift = DMatrix::identity(m, m) * (matrix.trace() / m as f64);
        let shifted = matrix - shift;
        let identity = DMatrix::identity(m, m);
        return small
            .phi
            .map(|line| &identity * line.re[0] + &shifted * line.im[0]);
    }
    functions.evaluate(matrix, 1.0);
    core::array::from_fn(|k| DMatrix::from_column_slice(m, m, functions.get(k)))
}

/// The matrix as the upper part of a larger one, which takes the way of doubling.
fn by_doubling(matrix: &DMatrix<f64>) -> [DMatrix<f64>; PHI_ORDERS] {
    let m = matrix.nrows();
    let mut larger = DMatrix::zeros(m + 1, m + 1);
    larger.view_mut((0, 0), (m, m)).copy_from(matrix);
    functions(&larger).map(|phi| phi.view((0, 0), (m, m)).into_owned())
}

fn scalar(z: f64) -> [f64; PHI_ORDERS] {
    let matrix = DMatrix::from_element(1, 1, z);
    functions(&matrix).map(|value| value[(0, 0)])
}

#[test]
fn matrices_with_real_eigenvalues_are_functions_of_these() {
    for values in [[-0.3, 0.2], [-4.0, -0.01], [-60.0, 0.0], [3.0, 2.0]] {
        let (matrix, build) = rotated(values);
        for (k, function) in functions(&matrix).iter().enumerate() {
            let expected = build(values.map(|value| scalar(value)[k]));
            // 1e-12: rounding grows with the number of doublings.
            let error = (function - &expected).amax() / expected.amax();
            assert!(error < 1e-12, "phi_{k} of {values:?}: {error}");
        }
    }
}

#[test]
fn formula_series_and_doubling_agree_on_oscillating_pairs() {
    for (a, w) in [(-0.1, 0.4), (-0.05, 3.0), (0.2, 40.0), (-3.0, 0.9)] {
        // Similar to [a, -w; w, a], but not of that form.
        let matrix = DMatrix::from_row_slice(2, 2, &[a + 0.3 * w, -w * 1.09, w, a - 0.3 * w]);
        for (k, (formula, doubling)) in functions(&matrix)
            .iter()
            .zip(&by_doubling(&matrix))
            .enumerate()
        {
            // 1e-12: rounding grows with the number of doublings.
            let error = (formula - doubling).amax() / doubling.amax();
            assert!(error < 1e-12, "phi_{k} of {a} +- {w} i: {error}");
        }
    }
}

#[test]
fn a_defective_matrix_has_the_functions_of_a_double_integrator() {
    let matrix = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]);
    for (k, function) in functions(&matrix).iter().enumerate() {
        let next = if k + 1 < PHI_ORDERS {
            INVERSE_FACTORIAL[k + 1]
        } else {
            1.0 / 5040.0
        };
        assert!((function[(0, 0)] - INVERSE_FACTORIAL[k]).abs() < 1e-15);
        assert!((function[(0, 1)] - next).abs() < 1e-15);
    }
}

#[test]
fn oscillator_response_is_the_same_through_formula_and_augmentation_and_at_resonance() {
    let (w, time) = (7.0, 0.9);
    let load = [Complex::new(0.4, -1.0), Complex::new(2.0, 0.5)];
    for (a, frequency) in [(-0.2, 3.0), (0.0, 7.0), (0.0, 7.0 + 1e-9), (-1.0, -20.0)] {
        let matrix = DMatrix::from_row_slice(2, 2, &[a, -w, w, a]);
        let mut response = PhiFunctions::new(3);
        let times = [time, 0.2, time - 0.2, time];
        let turned = exponentials(Complex::new(0.0, frequency), times);
        let small = SmallPhi::of(&matrix, times, &mut response).unwrap();
        let formula = small.oscillator_response(&matrix, (frequency, &turned), &load);
        let formula = formula.unwrap().map(|response| response.get(0));
        // The same pair beside an unrelated state takes the general way.
        let mut larger = DMatrix::zeros(3, 3);
        larger.view_mut((0, 0), (2, 2)).copy_from(&matrix);
        let padded = [load[0], load[1], Complex::new(0.0, 0.0)];
        let mut general = [Complex::new(0.0, 0.0); 3];
        response.oscillator_response((&larger, time), frequency, &padded, &mut general);
        for (one, two) in formula.iter().zip(&general) {
            assert!(
                (one - two).l1_norm() < 1e-12,
                "{a} {frequency}: {one} {two}"
            );
        }
    }
}

#[test]
fn times_do_not_meddle_with_each_other() {
    // Some by series, some by the exponential, near the border between both.
    let matrix = DMatrix::from_row_slice(2, 2, &[-0.2, -3.0, 3.0, -0.2]);
    let mut general = PhiFunctions::new(2);
    for [one, other] in [[0.05, 0.3], [0.3, 0.32], [0.32, 1.7]] {
        let times = [one + other, one, other, one + other];
        let all = SmallPhi::of(&matrix, times, &mut general).unwrap();
        for (i, time) in times.into_iter().enumerate() {
            let alone = SmallPhi::of(&matrix, [time, 0.0, time, time], &mut general).unwrap();
            for (k, (all, alone)) in all.phi.iter().zip(&alone.phi).enumerate() {
                let both = [(all.re, alone.re), (all.im, alone.im)];
                for (all, alone) in both {
                    // 1e-15: series of different length, products.
                    assert!((all[i] - alone[0]).abs() <= 1e-15, "phi_{k} at {time}");
                }
            }
        }
    }
}
