//! The matrices of one rotor over its stations, full order.
//!
//! ```text
//!   M x'' + C_xx (x'-x_b') + C_xy (y'-y_b') + Om G y' + Om' G y + K_s x + K_xx (x-x_b) + K_xy (y-y_b) = F_x
//!   M y'' + C_yy (y'-y_b') + C_yx (x'-x_b') - Om G x' - Om' G x + K_s y + K_yy (y-y_b) + K_yx (x-x_b) = F_y
//!   J th'' + C_T th' + K_T th = T_ext + T_mesh
//! ```
//!
//! x and y hold [displacement, slope] of each station; Om G stands on the other plane's velocity (paper
//! (1)-(3) with the corrections of `docs/errata.md`). Bearings and supports are springs at stations and
//! are kept as lists, so that the modal equations can take them exactly.

use nalgebra::DMatrix;

use super::Stations;
use crate::config::Disk;
use crate::element::Shaft;
use crate::train::Rotor;

/// Matrices of the shaft with its disks and gears; N stations.
#[derive(Debug, Clone)]
pub struct FiniteElements {
    /// Where the stations are.
    pub stations: Stations,
    /// M, 2N x 2N, one plane [kg, kg m, kg m^2].
    pub mass: DMatrix<f64>,
    /// K_s, 2N x 2N, one plane, shaft alone [N/m, N, N m].
    pub shaft_stiffness: DMatrix<f64>,
    /// G, 2N x 2N.
    pub gyroscopic: DMatrix<f64>,
    /// J, N x N [kg m^2].
    pub inertia: DMatrix<f64>,
    /// K_T, N x N, shaft alone [N m/rad].
    pub torsional_stiffness: DMatrix<f64>,
}

impl FiniteElements {
    /// Assembles shaft elements, disks and gears.
    pub fn assemble(rotor: &Rotor) -> FiniteElements {
        let stations = Stations::of(rotor);
        let n = stations.count();
        let mut elements = FiniteElements {
            mass: DMatrix::zeros(2 * n, 2 * n),
            shaft_stiffness: DMatrix::zeros(2 * n, 2 * n),
            gyroscopic: DMatrix::zeros(2 * n, 2 * n),
            inertia: DMatrix::zeros(n, n),
            torsional_stiffness: DMatrix::zeros(n, n),
            stations,
        };
        for left in 0..n - 1 {
            elements.add_shaft(left, &shaft_between(rotor, &elements.stations, left));
        }
        for disk in rotor
            .disks
            .iter()
            .chain(rotor.gears.iter().map(|gear| &gear.body))
        {
            elements.add_disk(disk);
        }
        elements
    }

    fn add_shaft(&mut self, left: usize, shaft: &Shaft) {
        add_at(&mut self.mass, 2 * left, shaft.mass().as_slice());
        add_at(
            &mut self.shaft_stiffness,
            2 * left,
            shaft.stiffness().as_slice(),
        );
        add_at(
            &mut self.gyroscopic,
            2 * left,
            shaft.gyroscopic().as_slice(),
        );
        add_at(&mut self.inertia, left, shaft.polar_inertia().as_slice());
        add_at(
            &mut self.torsional_stiffness,
            left,
            shaft.torsional_stiffness().as_slice(),
        );
    }

    fn add_disk(&mut self, disk: &Disk) {
        let station = self.stations.at(disk.position);
        let (displacement, slope) = (2 * station, 2 * station + 1);
        self.mass[(displacement, displacement)] += disk.mass;
        self.mass[(slope, slope)] += disk.diametral_inertia;
        self.gyroscopic[(slope, slope)] += disk.polar_inertia;
        self.inertia[(station, station)] += disk.polar_inertia;
    }
}

fn shaft_between(rotor: &Rotor, stations: &Stations, left: usize) -> Shaft {
    let (start, end) = (stations.positions()[left], stations.positions()[left + 1]);
    let middle = 0.5 * (start + end);
    let inside = |section: &&crate::train::Section| middle <= section.end;
    let last = rotor.sections.len() - 1; // a valid rotor has sections
    let section = rotor
        .sections
        .iter()
        .find(inside)
        .unwrap_or(&rotor.sections[last]);
    Shaft {
        length: end - start,
        outer_diameter: section.outer_diameter,
        inner_diameter: section.inner_diameter,
        youngs_modulus: section.material.youngs_modulus,
        poisson_ratio: section.material.poisson_ratio,
        density: section.material.density,
    }
}

/// Adds a symmetric element matrix, given by its entries, at rows and columns `first ..`.
fn add_at(matrix: &mut DMatrix<f64>, first: usize, element: &[f64]) {
    let n = element.len().isqrt();
    for (index, value) in element.iter().enumerate() {
        matrix[(first + index % n, first + index / n)] += value;
    }
}
