//! Mesh stiffness after ISO 6336-1 (2006), clause 9, method B, for comparison.
//!
//! ```text
//!   q'      = C1 + C2/z_1 + C3/z_2 + C4 x_1 + C5 x_1/z_1 + C6 x_2 + C7 x_2/z_2 + C8 x_1^2 + C9 x_2^2      [mm um / N]
//!   c'_th   = 1 / q'                                          one pair, theoretical                     [N / (mm um)]
//!   c'      = c'_th C_M C_R C_B E / E_steel                   one pair, greatest                         (spur gears: cos beta = 1)
//!   c_gamma = c' (0.75 eps + 0.25)                            mesh, mean over the phase
//!   C_M = 0.8 (measurements)     C_R = 1 (solid gears)
//!   C_B = (1 + 0.5 (1.2 - h_fP/m)) (1 - 0.02 (20 - alpha in degrees)), the mean of both gears
//! ```
//!
//! The coefficients are those of public programs; the standard was not at hand. Gear 1 is the one with fewer teeth. The standard fits these to steel gears with x_1 >= x_2, -0.5 <= x_1 + x_2 <= 2,
//! eps >= 1.2 and a load of more than 100 N per mm of face width; nothing of this is checked here.

use super::{SpurGear, SpurPair};

/// C1 to C9 of q'.
const C: [f64; 9] = [
    0.04723, 0.15551, 0.25791, -0.00635, -0.11654, -0.00193, -0.24188, 0.00529, 0.00182,
];

/// Young's modulus of the steel of the standard [Pa].
const STEEL: f64 = 2.06e11;

/// Correction factor C_M: measured stiffness against the theoretical one.
const MEASURED: f64 = 0.8;

/// 1 N/(mm um) in N/m per metre of face width.
const NEWTON_PER_MILLIMETRE_AND_MICROMETRE: f64 = 1e9;

/// Stiffnesses per face width after ISO 6336-1 [N/m per m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iso6336Stiffness {
    /// c'_th of one pair, of steel.
    pub theoretical_single: f64,
    /// c': one pair where it is stiffest.
    pub single: f64,
    /// c_gamma: mean over the phase of all pairs in contact.
    pub mesh: f64,
}

/// c'_th [N/m per m of face width] of two steel gears with these numbers of teeth and profile shifts [modules], the one with
/// fewer teeth first.
pub fn theoretical_single_stiffness(teeth: [f64; 2], profile_shift: [f64; 2]) -> f64 {
    let ([z1, z2], [x1, x2]) = (teeth, profile_shift);
    let terms = [
        1.0,
        1.0 / z1,
        1.0 / z2,
        x1,
        x1 / z1,
        x2,
        x2 / z2,
        x1 * x1,
        x2 * x2,
    ];
    let flexibility: f64 = C.iter().zip(terms).map(|(c, term)| c * term).sum();
    NEWTON_PER_MILLIMETRE_AND_MICROMETRE / flexibility
}

impl SpurPair {
    /// The stiffnesses of this pair after ISO 6336-1, method B, as of solid gears.
    pub fn iso6336(&self) -> Iso6336Stiffness {
        let [mut first, mut second] = self.gears;
        if first.teeth > second.teeth {
            (first, second) = (second, first);
        }
        let theoretical_single = theoretical_single_stiffness(
            [first.teeth, second.teeth],
            [first.profile_shift, second.profile_shift],
        );
        let rack = |gear: &SpurGear| {
            (1.0 + 0.5 * (1.2 - gear.dedendum))
                * (1.0 - 0.02 * (20.0 - self.rack_pressure_angle.to_degrees()))
        };
        let basic_rack = 0.5 * (rack(&first) + rack(&second));
        // E of two materials in series.
        let moduli = [first.youngs_modulus, second.youngs_modulus];
        let modulus = 2.0 * moduli[0] * moduli[1] / (moduli[0] + moduli[1]);
        let single = theoretical_single * MEASURED * basic_rack * modulus / STEEL;
        let contact_ratio = self.path_of_contact().contact_ratio();
        Iso6336Stiffness {
            theoretical_single,
            single,
            mesh: single * (0.75 * contact_ratio + 0.25),
        }
    }
}
