//! Mesh stiffness from tooth geometry: two spur gears, nothing measured.
//!
//! A pair of teeth in contact is a chain of springs. Each tooth is a cantilever of the involute's varying
//! thickness, clamped at the root circle; the gear body below it gives way, too; and the flanks flatten where
//! they touch (`involute.rs`, `compliance.rs`):
//!
//! ```text
//!   1/k(x) = 1/k_h + sum over both gears of (1/k_bending + 1/k_shear + 1/k_axial + 1/k_body)
//!   k(p)   = sum over the engaged pairs of k(x),   x = frac(p) + j in [0, eps]
//! ```
//!
//! **Phase.** x counts pitches along the line of action from the point where the tip of gear b touches the
//! root of gear a (x = 0) to the point where the tip of gear a leaves the root of gear b (x = eps). Where gear
//! a drives in the direction of its speed (s Om_a > 0), a pair comes into contact at x = 0, as ever at the
//! tip of the driven gear, and runs to eps; where it is driven (s Om_a < 0), a pair runs from eps to 0.
//!
//! **Left out.** Two pairs in contact bend the same gear bodies; simply adding them, as here and in most of
//! the literature, makes the mesh with two pairs too stiff. The fillet at the root is left out, too, which makes each
//! tooth too soft. Contact is that of undeformed teeth: no contact before and after the ideal path under load.
//! Spur gears, external mesh, no profile modification.
//!
//! Sources: Yang and Lin, Hertzian damping, tooth friction and bending elasticity in gear impact dynamics, J.
//! Mech. Trans. Autom. Des. 109 (1987); Tian, thesis, University of Alberta (2004); Wu, Zuo, Parey, J. Sound Vib. 317 (2008);
//! Liang, Zuo, Pandey, Mech. Mach. Theory 76 (2014) for root circles inside the base circle; Sainsot, Velex, Duverger,
//! J. Mech. Des. 126 (2004) for the gear body. ISO 6336-1 for comparison (`iso6336.rs`).
//! These name where the method comes from; the formulas are derived and tested here, contact and body also against a public program (ROSS).
//!
//! Knows two gears; knows no shafts, no time and no model file.

mod compliance;
mod involute;
mod iso6336;
mod pair_stiffness;

pub use compliance::FITTED_BODIES;
pub use involute::{PathOfContact, Tooth};
pub use iso6336::{Iso6336Stiffness, theoretical_single_stiffness};
pub(super) use pair_stiffness::PairStiffness;

/// Two external spur gears in mesh, a and b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpurPair {
    /// Module m [m]. > 0
    pub module: f64,
    /// Pressure angle of the basic rack [rad]. (0, pi/2)
    pub rack_pressure_angle: f64,
    /// Operating pressure angle [rad]: it sets the centre distance. (0, pi/2)
    pub pressure_angle: f64,
    /// Length of the teeth in contact [m]. > 0
    pub face_width: f64,
    /// Gear a and gear b.
    pub gears: [SpurGear; 2],
}

/// One gear of a pair. Lengths on the tooth are in modules, as on the basic rack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpurGear {
    /// Number of teeth z.
    pub teeth: f64,
    /// Addendum of the basic rack [modules]: tip radius = m (z/2 + x + addendum).
    pub addendum: f64,
    /// Dedendum of the basic rack [modules]: root radius = m (z/2 + x - dedendum).
    pub dedendum: f64,
    /// Profile shift x [modules].
    pub profile_shift: f64,
    /// Radius at which the gear body is held [m]. (0, root radius)
    pub bore_radius: f64,
    /// Young's modulus E [Pa]. > 0
    pub youngs_modulus: f64,
    /// Poisson's ratio nu. (-1, 0.5]
    pub poisson_ratio: f64,
}

impl SpurPair {
    /// The teeth of gear a and gear b.
    pub fn teeth(&self) -> [Tooth; 2] {
        self.gears
            .map(|gear| Tooth::new(&gear, self.module, self.rack_pressure_angle))
    }

    /// Where the teeth touch.
    pub fn path_of_contact(&self) -> PathOfContact {
        PathOfContact::new(&self.teeth(), self.pressure_angle)
    }

    /// Stiffness of one pair of teeth [N/m], x pitches along the path of contact, 0 <= x <= eps, by integration.
    pub fn pair_stiffness(&self, x: f64) -> f64 {
        let teeth = self.teeth();
        let path = PathOfContact::new(&teeth, self.pressure_angle);
        let rolls = path.roll_angles(&teeth, x);
        let flexibility: f64 = (0..2)
            .map(|side| {
                let gear = &self.gears[side];
                let tooth = compliance::tooth(&teeth[side], rolls[side], gear.poisson_ratio);
                let body = compliance::body(&teeth[side], rolls[side], gear.bore_radius);
                (tooth + body) / gear.youngs_modulus
            })
            .sum();
        self.face_width / (flexibility + compliance::contact(&self.gears))
    }
}

#[cfg(test)]
mod tests;
