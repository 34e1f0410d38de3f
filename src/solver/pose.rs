//! Displacements and velocities, put together from decoupled states when somebody asks for them.
//!
//! A step needs neither, and a master that looks at forces alone does not either. Asking changes nothing that counts: two
//! poses are equal, and are saved as the same bytes, whether or not one of them has been looked at.

use core::cell::{OnceCell, RefCell};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::exponential::Shapes;
use super::state::Track;

/// How everything is displaced and how fast it moves.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "Saved", into = "Saved")]
pub(super) struct Pose {
    /// The decoupled states of the exponential method; none for the other one.
    states: Vec<[f64; 4]>,
    /// Whether these say how it moves: not before the first step.
    is_decoupled: bool,
    /// How displacements and velocities follow from them.
    shapes: Option<Arc<Shapes>>,
    /// q and q', once known.
    known: OnceCell<Track>,
    /// Room for them until then.
    room: RefCell<Track>,
}

/// What is saved of it.
#[derive(Serialize, Deserialize)]
struct Saved {
    whole: Track,
    states: Vec<[f64; 4]>,
    is_decoupled: bool,
}

impl Pose {
    /// With this displacement and velocity; `states` of the decoupled ones, which say nothing yet.
    pub(super) fn new(whole: Track, states: usize) -> Pose {
        Pose {
            states: vec![[0.0; 4]; states],
            is_decoupled: false,
            shapes: None,
            known: OnceCell::from(whole),
            room: RefCell::default(),
        }
    }

    /// q and q'.
    pub(super) fn whole(&self) -> &Track {
        self.known.get_or_init(|| {
            let mut whole = self.room.take();
            if let Some(shapes) = &self.shapes {
                shapes.put_together(&self.states, &mut whole);
            }
            whole
        })
    }

    /// The same, to be changed by a method without decoupled states.
    pub(super) fn whole_mut(&mut self) -> Option<&mut Track> {
        self.known.get_mut()
    }

    /// The decoupled states where they say how it moves.
    pub(super) fn decoupled(&self) -> Option<&[[f64; 4]]> {
        self.is_decoupled.then_some(self.states.as_slice())
    }

    /// From now on as these decoupled states say. Allocates nothing.
    pub(super) fn decouple(&mut self, states: &[[f64; 4]], shapes: &Arc<Shapes>) {
        if let Some(whole) = self.known.take() {
            self.room.replace(whole);
        }
        self.states.copy_from_slice(states);
        self.is_decoupled = true;
        if !self
            .shapes
            .as_ref()
            .is_some_and(|own| Arc::ptr_eq(own, shapes))
        {
            self.shapes = Some(Arc::clone(shapes));
        }
    }

    /// Becomes the same as another one of the same system, without allocation.
    pub(super) fn copy_from(&mut self, other: &Pose) {
        let mut whole = self.known.take().unwrap_or_else(|| self.room.take());
        whole.copy_from(other.whole());
        self.known = OnceCell::from(whole);
        self.states.clone_from(&other.states);
        self.is_decoupled = other.is_decoupled;
        self.shapes.clone_from(&other.shapes);
    }

    /// Lengths of the lists.
    pub(super) fn lengths(&self) -> [usize; 3] {
        let Track { position, velocity } = self.whole();
        [position.len(), velocity.len(), self.states.len()]
    }

    /// Whether everything is a number.
    pub(super) fn is_finite(&self) -> bool {
        let Track { position, velocity } = self.whole();
        let numbers = position.iter().chain(velocity);
        let mut numbers = numbers.chain(self.states.as_flattened());
        numbers.all(|number| number.is_finite())
    }
}

impl PartialEq for Pose {
    fn eq(&self, other: &Pose) -> bool {
        self.whole() == other.whole()
            && self.states == other.states
            && self.is_decoupled == other.is_decoupled
    }
}

impl From<Pose> for Saved {
    fn from(pose: Pose) -> Saved {
        Saved {
            whole: pose.whole().clone(),
            states: pose.states,
            is_decoupled: pose.is_decoupled,
        }
    }
}

impl From<Saved> for Pose {
    fn from(saved: Saved) -> Pose {
        Pose {
            is_decoupled: saved.is_decoupled,
            states: saved.states,
            ..Pose::new(saved.whole, 0)
        }
    }
}
