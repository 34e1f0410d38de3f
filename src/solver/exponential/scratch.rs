//! Room for computing coefficients: what one part does by itself where it is looked at (`polynomials::SEEN_AT`).

use nalgebra::Complex;

use super::lanes::Quad;
use super::panel::Place;
use super::part::Part;
use super::polynomials::{POWERS, SEEN_AT};
use crate::linalg::{Group, Numbers, PhiFunctions, SmallPhi, exponentials};

/// Room for computing coefficients.
#[derive(Debug, Clone)]
pub(super) struct Scratch {
    pub(super) phi: PhiFunctions,
    /// m_k of every actuator, len each.
    pub(super) moments: Vec<[Quad; POWERS]>,
    /// Real and imaginary part of the response to every harmonic of a part, len each.
    pub(super) responses: Vec<[Quad; 2]>,
    /// The same of one group at one place.
    response: Vec<Complex<f64>>,
    /// e^(i w x h) of all harmonics.
    pub(super) turned: Vec<Numbers<4>>,
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
            turned: vec![Numbers::ZERO; harmonics],
        }
    }

    /// Turns the harmonics to the nodes.
    pub(super) fn turn(&mut self, frequencies: &[f64], h: f64) {
        for (turned, &frequency) in self.turned.iter_mut().zip(frequencies) {
            *turned = exponentials(Complex::new(0.0, frequency), SEEN_AT.map(|x| x * h));
        }
    }

    /// Zeros for the states that stay zero.
    pub(super) fn clear(&mut self, part: &Part) {
        self.moments[..part.len() * part.actuators.len()].fill([[0.0; 4]; POWERS]);
        self.responses[..part.len() * part.harmonics.len()].fill([[0.0; 4]; 2]);
    }

    /// The responses of a small group to the harmonics.
    #[inline(always)]
    pub(super) fn respond_small(
        &mut self,
        share: Share<'_>,
        frequencies: &[f64],
        small: &SmallPhi,
    ) {
        let Share { part, group, .. } = share;
        let m = group.matrix.nrows();
        for (number, (harmonic, load)) in part.harmonics.iter().enumerate() {
            let driven = (frequencies[*harmonic], &self.turned[*harmonic]);
            let load = &load[group.first..][..m];
            let Some(responses) = small.oscillator_response(&group.matrix, driven, load) else {
                self.respond(share, frequencies, number);
                continue;
            };
            let targets = &mut self.responses[number * part.len() + group.first..];
            for (target, Numbers { re, im }) in targets.iter_mut().zip(responses) {
                *target = [re, im];
            }
        }
    }

    /// The response of any group to harmonic number `number` of the part.
    pub(super) fn respond(&mut self, share: Share<'_>, frequencies: &[f64], number: usize) {
        let Share { part, group, h, .. } = share;
        let m = group.matrix.nrows();
        let (harmonic, load) = &part.harmonics[number];
        let load = &load[group.first..][..m];
        for (at, x) in SEEN_AT.into_iter().enumerate() {
            let block = (&group.matrix, x * h);
            let response = &mut self.response[..m];
            self.phi
                .oscillator_response(block, frequencies[*harmonic], load, response);
            let targets = &mut self.responses[number * part.len() + group.first..][..m];
            for ([re, im], response) in targets.iter_mut().zip(response) {
                (re[at], im[at]) = (response.re, response.im);
            }
        }
    }
}
