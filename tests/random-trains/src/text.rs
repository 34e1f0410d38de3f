//! The model file of a train.

use std::f64::consts::PI;

use crate::{Law, Link, PRESSURE_ANGLE, Shaft, Support, Train, base_radius};

impl Train {
    /// The train as a model file.
    pub fn text(&self) -> String {
        let mut text = format!(
            "kind = \"gear_train\"\nname = \"drawn\"\n[simulation]\n{}\n[basis]\nlateral_modes = {}\ntorsional_modes = {}\n\
             [material.default]\nyoungs_modulus = 2.1e11\npoisson_ratio = 0.3\ndensity = 7800.0\n",
            self.simulation, self.modes[0], self.modes[1]
        );
        let (amplitude, frequency) = self.vibration;
        if amplitude != 0.0 {
            text += &format!(
                "[gearbox_vibration]\namplitude_x = {amplitude}\namplitude_y = {}\nphase_y = 0.7\nfrequency = {frequency}\n",
                0.6 * amplitude
            );
        }
        for (index, shaft) in self.shafts.iter().enumerate() {
            text += &self.shaft_text(index, shaft);
        }
        for (index, link) in self.links.iter().enumerate() {
            text += &self.link_text(index, link);
        }
        text
    }

    fn shaft_text(&self, index: usize, shaft: &Shaft) -> String {
        let (ratio, damper) = if self.damped {
            (0.02, 800.0)
        } else {
            (0.0, 0.0)
        };
        let mut text = format!(
            "[[rotor]]\nname = \"s{index}\"\nspeed = {}\nmax_element_length = 0.08\nlateral_damping_ratio = {ratio}\n\
             torsional_damping_ratio = {ratio}\n[[rotor.segment]]\nlength = 0.5\nouter_diameter = 0.05\n\
             [[rotor.unbalance]]\nname = \"u\"\nposition = 0.3\nmoment = {}\nphase = {}\n\
             [[rotor.torque]]\nname = \"t\"\nposition = 0.0\nvalue = {}\nslope = {}\n",
            shaft.speed, shaft.unbalance.0, shaft.unbalance.1, shaft.torque, shaft.slope
        );
        for (name, position) in [("b1", 0.02), ("b2", 0.48)] {
            text += &format!("[[rotor.bearing]]\nname = \"{name}\"\nposition = {position}\n");
            text += &self.support_text(shaft, damper);
        }
        for (gear, &teeth) in shaft.teeth.iter().enumerate() {
            let radius = base_radius(teeth);
            let mass = 7800.0 * PI * radius * radius * 0.03;
            text += &format!(
                "[[rotor.gear]]\nname = \"g{gear}\"\nposition = {}\nteeth = {teeth}\nbase_radius = {radius}\nmass = {mass}\n\
                 polar_inertia = {}\ndiametral_inertia = {}\n",
                0.08 + 0.06 * gear as f64,
                0.5 * mass * radius * radius,
                0.25 * mass * radius * radius
            );
        }
        text
    }

    /// What holds a shaft at each of its bearings.
    fn support_text(&self, shaft: &Shaft, damper: f64) -> String {
        let (k, skew) = (shaft.bearing, self.skew);
        let planar = |k: f64, damper: f64| {
            format!(
                "stiffness = {{ xx = {k}, xy = {skew}, yx = {} }}\ndamping = {{ xx = {damper} }}\n",
                -skew
            )
        };
        match shaft.support {
            Support::Linear => planar(k, damper),
            Support::OverSpeed(change) => {
                let speed = shaft.speed.abs();
                let at = |share: f64, factor: f64| {
                    format!(
                        "[[rotor.bearing.at_speed]]\nspeed = {}\n{}",
                        share * speed,
                        planar(k * factor, damper * factor)
                    )
                };
                format!(
                    "outside_speeds = \"hold\"\n{}{}{}",
                    at(0.5, 1.0 - change),
                    at(1.0, 1.0),
                    at(2.0, 1.0 + change)
                )
            }
            Support::Radial(exponent, clearance) => {
                // As stiff as the linear one at a depth of 10 um.
                let coefficient = k * 1e-5_f64.powf(1.0 - exponent);
                let law = if exponent == 1.0 {
                    format!("law = \"clearance\"\nstiffness = {coefficient}")
                } else {
                    format!("law = \"hertz\"\nexponent = {exponent}\ncoefficient = {coefficient}")
                };
                let soft = planar(0.1 * k, damper);
                format!("{soft}[rotor.bearing.nonlinear]\n{law}\nclearance = {clearance}\n")
            }
        }
    }

    fn link_text(&self, index: usize, link: &Link) -> String {
        let [a, b] = link
            .gears
            .map(|(shaft, gear)| format!("\"s{shaft}.g{gear}\""));
        let law = match link.law {
            Law::Constant => "law = \"constant\"\nmean = 3e8".to_string(),
            Law::Rectangular(ratio) => {
                format!("law = \"rectangular\"\npair = 2e8\ncontact_ratio = {ratio}")
            }
            Law::ToothPair(ratio) => {
                format!(
                    "law = \"tooth_pair\"\npair = 2e8\nquadratic = 0.3\nramp = 0.2\ncontact_ratio = {ratio}"
                )
            }
            Law::Fourier(cosine, sine) => {
                format!("law = \"fourier\"\nmean = 3e8\ncosine = [{cosine}]\nsine = [{sine}]")
            }
        };
        let contact = link.backlash.map_or(String::new(), |backlash| {
            format!("contact = \"unilateral\"\nbacklash = {backlash}\n")
        });
        format!(
            "[[mesh]]\nname = \"m{index}\"\ngears = [{a}, {b}]\ncenter_angle = {}\npressure_angle = {PRESSURE_ANGLE}\n\
             internal = {}\nflank = {}\nphase = {}\ndamping_ratio = {}\n{contact}[mesh.stiffness]\n{law}\n\
             [[mesh.transmission_error]]\norder = 1\namplitude = {}\nphase = {}\n",
            link.center_angle,
            link.internal,
            link.flank,
            link.phase,
            if self.damped { link.damping } else { 0.0 },
            link.error.0,
            link.error.1
        )
    }
}
