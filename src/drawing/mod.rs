//! Pictures of a train and of the answers of [`crate::analysis`], as SVG text.
//!
//! | picture | of |
//! |---|---|
//! | [`side_view`], [`axial_view`] | the train, to scale |
//! | [`mode_shapes`] | one rotor's basis modes |
//! | [`mesh_stiffness`] | k over two pitches |
//! | [`campbell_diagram`] | natural frequencies over speed |
//! | [`basis_check`] | errors of the basis over frequency |
//!
//! Pure functions: the same train gives the same text. Shapes have classes; [`STYLE`] colours them with the variables that
//! a page defines (`description/page.css`), for light, dark and print. Knows no page, no file, no browser.

mod axes;
mod axial;
mod basis;
mod bodies;
mod campbell;
mod labels;
mod mode_shapes;
mod side;
mod stack;
mod stiffness;
mod svg;

use core::f64::consts::TAU;

pub use axial::axial_view;
pub use basis::basis_check;
pub use campbell::campbell_diagram;
pub use mode_shapes::mode_shapes;
pub use side::side_view;
pub use stiffness::mesh_stiffness;

/// Style sheet of all pictures.
pub const STYLE: &str = include_str!("drawing.css");

/// A speed [rad/s] for people.
fn rpm(speed: f64) -> String {
    format!("{} rpm", short(speed * 60.0 / TAU))
}

/// A number with two decimals, without trailing zeros.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_string()
    } else {
        text.to_string()
    }
}
