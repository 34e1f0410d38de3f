//! The functions of a small matrix that solve linear differential equations exactly.
//!
//! ```text
//!   phi_0(z) = e^z      phi_k(z) = sum over n of z^n / (n + k)!      z phi_k = phi_(k-1) - 1 / (k-1)!
//!   integral from 0 to T of e^(B (T-s)) s^k ds = k! T^(k+1) phi_(k+1)(B T)
//! ```
//!
//! Small arguments: Taylor's series of the highest order, then downwards (no cancellation). Matrices of one or two rows are
//! like numbers (`small`, `numbers`). Everything else: the argument is halved until the series serves, then
//! doubled again:
//!
//! ```text
//!   phi_k(2 z) = 2^-k [ e^z phi_k(z) + sum over j = 1 .. k of phi_j(z) / (k-j)! ]
//! ```
//!
//! Sources: Hochbruck, Ostermann, Acta Numerica 19 (2010), 2.1; doubling: Skaflestad, Wright, Appl. Numer. Math. 59 (2009).

mod numbers;
mod small;
#[cfg(test)]
mod tests;

use nalgebra::{Complex, DMatrix};

use super::add_scaled;
use numbers::{INVERSE_FACTORIAL, RECIPROCAL, SERIES_RADIUS, terms};

pub use numbers::{Numbers, PHI_ORDERS};
pub use small::{SmallPhi, exponentials};

/// Arguments beyond 2^60 have lost all digits of their phase.
const MOST_HALVINGS: u32 = 60;

/// phi_0 to phi_6 of matrices up to a fixed size, computed without allocation.
#[derive(Debug, Clone)]
pub struct PhiFunctions {
    /// Number of rows of the latest argument.
    size: usize,
    /// phi_k column by column from `k size^2` on.
    values: Vec<f64>,
    argument: Vec<f64>,
    product: Vec<f64>,
    doubled: Vec<f64>,
    /// The oscillator beside the largest matrix; `None` in the functions that serve it.
    augmented: Option<Box<PhiFunctions>>,
}

impl PhiFunctions {
    /// For matrices of up to `largest` rows.
    pub fn new(largest: usize) -> PhiFunctions {
        PhiFunctions {
            augmented: Some(Box::new(PhiFunctions::without_oscillator(largest + 2))),
            ..PhiFunctions::without_oscillator(largest)
        }
    }

    fn without_oscillator(largest: usize) -> PhiFunctions {
        let square = vec![0.0; largest * largest];
        PhiFunctions {
            size: 0,
            values: vec![0.0; PHI_ORDERS * square.len()],
            argument: square.clone(),
            product: square.clone(),
            doubled: vec![0.0; PHI_ORDERS * square.len()],
            augmented: None,
        }
    }

    /// phi_k of the latest argument, m x m column by column.
    pub fn get(&self, k: usize) -> &[f64] {
        let square = self.size * self.size;
        &self.values[k * square..(k + 1) * square]
    }

    /// Evaluates all functions of `matrix * time`.
    pub fn evaluate(&mut self, matrix: &DMatrix<f64>, time: f64) {
        let m = matrix.nrows();
        self.size = m;
        for (target, value) in self.argument.iter_mut().zip(matrix.iter()) {
            *target = value * time;
        }
        self.double_up(m);
    }

    /// The argument is halved until the series serves, then doubled again.
    fn double_up(&mut self, m: usize) {
        let square = m * m;
        let row = |i: usize| (0..m).map(|j| self.argument[i + j * m].abs()).sum::<f64>();
        let mut size = (0..m).map(row).fold(0.0, f64::max);
        let mut halvings = 0;
        while size > SERIES_RADIUS && halvings < MOST_HALVINGS {
            size *= 0.5;
            halvings += 1;
            self.argument[..square]
                .iter_mut()
                .for_each(|value| *value *= 0.5);
        }
        self.sum_series(m, size);
        for _ in 0..halvings {
            self.double(m);
        }
    }

    fn sum_series(&mut self, m: usize, size: f64) {
        let (square, top) = (m * m, PHI_ORDERS - 1);
        let argument = &self.argument[..square];
        let (lower, highest) = self.values.split_at_mut(top * square);
        let highest = &mut highest[..square];
        let term = &mut self.doubled[..square];
        set_diagonal(term, m, INVERSE_FACTORIAL[top]);
        highest.copy_from_slice(term);
        for n in 1..=terms(size) {
            let product = &mut self.product[..square];
            multiply(m, argument, term, product);
            let factor = RECIPROCAL[n + top];
            for ((term, sum), value) in term.iter_mut().zip(&mut *highest).zip(product) {
                *term = *value * factor;
                *sum += *term;
            }
        }
        let mut above: &[f64] = highest;
        for (k, phi) in lower.chunks_exact_mut(square).enumerate().rev() {
            multiply(m, argument, above, phi);
            for i in 0..m {
                phi[i * (m + 1)] += INVERSE_FACTORIAL[k];
            }
            above = phi;
        }
    }

    fn double(&mut self, m: usize) {
        let square = m * m;
        let phi = |k: usize| &self.values[k * square..(k + 1) * square];
        let mut power = 1.0;
        for (k, target) in self
            .doubled
            .chunks_exact_mut(square)
            .take(PHI_ORDERS)
            .enumerate()
        {
            multiply(m, phi(0), phi(k), target);
            for j in 1..=k {
                add_scaled(INVERSE_FACTORIAL[k - j], phi(j), target);
            }
            target.iter_mut().for_each(|value| *value *= power);
            power *= 0.5;
        }
        let used = PHI_ORDERS * square;
        self.values[..used].copy_from_slice(&self.doubled[..used]);
    }

    /// The response of x' = B x + Re(load e^(i w t)) from rest over a time T: x(T) = Re(result).
    pub fn oscillator_response(
        &mut self,
        (matrix, time): (&DMatrix<f64>, f64),
        frequency: f64,
        load: &[Complex<f64>],
        result: &mut [Complex<f64>],
    ) {
        if let Some(augmented) = &mut self.augmented {
            augmented.respond(matrix, time, frequency, load, result);
        }
    }

    /// The oscillator as two further states: e^([B, Re load, -Im load; 0, rotation] T).
    fn respond(
        &mut self,
        matrix: &DMatrix<f64>,
        time: f64,
        frequency: f64,
        load: &[Complex<f64>],
        result: &mut [Complex<f64>],
    ) {
        let m = matrix.nrows();
        let n = m + 2;
        self.size = n;
        self.argument[..n * n].fill(0.0);
        for (j, column) in matrix.column_iter().enumerate() {
            for (i, value) in column.iter().enumerate() {
                self.argument[i + j * n] = value * time;
            }
        }
        for (i, load) in load.iter().enumerate() {
            self.argument[i + m * n] = load.re * time;
            self.argument[i + (m + 1) * n] = -load.im * time;
        }
        self.argument[m + (m + 1) * n] = -frequency * time;
        self.argument[m + 1 + m * n] = frequency * time;
        self.double_up(n);
        for (i, target) in result.iter_mut().enumerate() {
            let response = |column: usize| self.get(0)[i + column * n];
            *target = Complex::new(response(m), -response(m + 1));
        }
    }
}

/// product = left right, m x m.
fn multiply(m: usize, left: &[f64], right: &[f64], product: &mut [f64]) {
    for (column, target) in right.chunks_exact(m).zip(product.chunks_exact_mut(m)) {
        target.fill(0.0);
        for (left, factor) in left.chunks_exact(m).zip(column) {
            add_scaled(*factor, left, target);
        }
    }
}

fn set_diagonal(matrix: &mut [f64], m: usize, value: f64) {
    matrix.fill(0.0);
    matrix
        .iter_mut()
        .step_by(m + 1)
        .for_each(|entry| *entry = value);
}
