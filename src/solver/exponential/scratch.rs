//! Room for computing coefficients: what one part does by itself where it is looked at (`polynomials::SEEN_AT`).

use nalgebra::Complex;

use super::lanes::Quad;
use super::panel::Place;
use super::part::Part;
use super::polynomials::{MOMENTS, POWERS, SEEN_AT};
use crate::linalg::{Group, Numbers, PHI_ORDERS, PhiFunctions, SmallPhi, exponentials};

/// Room for computing coefficients.
#[derive(Debug, Clone)]
pub(super) struct Scratch {
    pub(super) phi: PhiFunctions,
    /// Of the small groups of a part, for each of their states.
    pub(super) functions: Vec<Functions>,
    /// m_k of every actuator, len each.
    pub(super) moments: Vec<[Quad; POWERS]>,
    /// Real and imaginary part of the response to every harmonic of a part, len each.
    pub(super) responses: Vec<[Quad; 2]>,
    /// The same of one group at one place.
    response: Vec<Complex<f64>>,
    /// e^(i w x h) of all harmonics.
    pub(super) turned: Vec<Numbers<4>>,
}

/// Functions of a group of one or two states that are level + slope S.
#[derive(Debug, Clone, Copy)]
pub(super) struct Functions {
    /// x h phi_1 and (x h)^2 phi_2.
    pub(super) responses: [[Quad; 2]; 2],
    /// k! x^(k+1) h phi_(k+1).
    pub(super) moments: [[Quad; 2]; POWERS],
}

impl Functions {
    const ZERO: Functions = Functions {
        responses: [[[0.0; 4]; 2]; 2],
        moments: [[[0.0; 4]; 2]; POWERS],
    };

    /// From the functions phi_k for steps of length h.
    #[inline(always)]
    pub(super) fn of(phi: &[Numbers<4>; PHI_ORDERS], h: f64) -> Functions {
        let mut functions = Functions::ZERO;
        let times = SEEN_AT.map(|x| x * h);
        let squares = times.map(|time| time * time);
        let responses = [(&phi[1], times), (&phi[2], squares)];
        for (line, (phi, factors)) in functions.responses.iter_mut().zip(responses) {
            *line = scaled(phi, &factors);
        }
        for ((line, phi), factors) in functions.moments.iter_mut().zip(&phi[1..]).zip(&MOMENTS) {
            *line = scaled(phi, &factors.map(|factor| factor * h));
        }
        functions
    }
}

/// Level and slope of a function, times factors.
#[inline(always)]
fn scaled(phi: &Numbers<4>, factors: &Quad) -> [Quad; 2] {
    [&phi.re, &phi.im].map(|part| core::array::from_fn(|i| part[i] * factors[i]))
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
            functions: vec![Functions::ZERO; largest(&Part::in_small_groups)],
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
