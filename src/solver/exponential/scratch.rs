//! Room for computing coefficients: what one part does by itself at the nodes of a step.

use nalgebra::Complex;

use super::lanes::Quad;
use super::panel::Place;
use super::part::Part;
use super::polynomials::{NODES, PLACES, POWERS};
use crate::linalg::{Group, PhiFunctions};

/// Room for computing coefficients.
#[derive(Debug, Clone)]
pub(super) struct Scratch {
    pub(super) phi: PhiFunctions,
    /// m_k of every actuator at the nodes, len each.
    pub(super) moments: Vec<[Quad; POWERS]>,
    /// Real and imaginary part of the response to every harmonic of a part at the nodes, len each.
    pub(super) responses: Vec<[Quad; 2]>,
    /// The same of one group at one node.
    response: Vec<Complex<f64>>,
    /// e^(i w x h) of all harmonics at the nodes.
    pub(super) turned: [Vec<Complex<f64>>; NODES],
}

/// One group of a part in a step.
#[derive(Clone, Copy)]
pub(super) struct Share<'a> {
    pub(super) part: &'a Part,
    pub(super) group: &'a Group,
    pub(super) place: &'a Place,
    /// The length of the step [s].
    pub(super) h: f64,
}

impl Scratch {
    pub(super) fn new(parts: &[Part], harmonics: usize) -> Scratch {
        let largest = |size: &dyn Fn(&Part) -> usize| parts.iter().map(size).max().unwrap_or(0);
        let group = largest(&|part| {
            let sizes = part.groups.iter().map(|group| group.matrix.nrows());
            sizes.max().unwrap_or(0)
        });
        let still = Complex::new(0.0, 0.0);
        let (actuated, driven) = (
            largest(&|part| part.len() * part.actuators.len()),
            largest(&|part| part.len() * part.harmonics.len()),
        );
        Scratch {
            phi: PhiFunctions::new(group),
            moments: vec![[[0.0; 4]; POWERS]; actuated],
            responses: vec![[[0.0; 4]; 2]; driven],
            response: vec![still; group],
            turned: core::array::from_fn(|_| vec![still; harmonics]),
        }
    }

    /// Turns the harmonics to the nodes.
    pub(super) fn turn(&mut self, frequencies: &[f64], h: f64) {
        for (turned, x) in self.turned.iter_mut().zip(PLACES) {
            for (turned, frequency) in turned.iter_mut().zip(frequencies) {
                let (sine, cosine) = libm::sincos(frequency * x * h);
                *turned = Complex::new(cosine, sine);
            }
        }
    }

    /// Zeros for the states that stay zero.
    pub(super) fn clear(&mut self, part: &Part) {
        self.moments[..part.len() * part.actuators.len()].fill([[0.0; 4]; POWERS]);
        self.responses[..part.len() * part.harmonics.len()].fill([[0.0; 4]; 2]);
    }

    /// The responses of a group to the harmonics at a node, whose functions were evaluated last.
    pub(super) fn respond(&mut self, share: Share<'_>, frequencies: &[f64], node: usize) {
        let Share { part, group, h, .. } = share;
        let matrix = &group.matrix;
        let m = matrix.nrows();
        for (number, (harmonic, load)) in part.harmonics.iter().enumerate() {
            let driven = (frequencies[*harmonic], self.turned[node][*harmonic]);
            let block = (matrix, PLACES[node] * h);
            let load = &load[group.first..][..m];
            let response = &mut self.response[..m];
            self.phi.oscillator_response(block, driven, load, response);
            let targets = &mut self.responses[number * part.len() + group.first..][..m];
            for ([re, im], response) in targets.iter_mut().zip(response) {
                (re[node], im[node]) = (response.re, response.im);
            }
        }
    }
}
