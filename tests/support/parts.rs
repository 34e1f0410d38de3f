//! Parts of a rotor as text.

pub fn disk(position: f64, mass: f64, polar: f64, diametral: f64) -> String {
    format!(
        "[[rotor.disk]]\nposition = {position}\nmass = {mass}\npolar_inertia = {polar}\n\
         diametral_inertia = {diametral}\n"
    )
}

pub fn bearing(name: &str, position: f64, stiffness: f64, damping: f64) -> String {
    format!(
        "[[rotor.bearing]]\nname = \"{name}\"\nposition = {position}\n\
         stiffness = {{ xx = {stiffness:e} }}\ndamping = {{ xx = {damping} }}\n"
    )
}

pub fn shaft(name: &str, speed: f64, length: f64, diameter: f64, material: &str) -> String {
    format!(
        "[[rotor]]\nname = \"{name}\"\nspeed = {speed}\nmax_element_length = {length}\n\
         [[rotor.segment]]\nlength = {length}\nouter_diameter = {diameter}\nmaterial = \"{material}\"\n"
    )
}
