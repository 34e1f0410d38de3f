//! Physical units of the FMU's variables, as FMI 2.0 describes them.

/// A unit of the interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Unit {
    /// No dimension: factors, modal coordinates.
    One,
    /// m
    Meter,
    /// m/s
    MeterPerSecond,
    /// m/s2
    MeterPerSecondSquared,
    /// N
    Newton,
    /// N.m
    NewtonMeter,
    /// N/m
    NewtonPerMeter,
    /// N.s/m
    NewtonSecondPerMeter,
    /// kg.m
    KilogramMeter,
    /// rad
    Radian,
    /// rad/s
    RadianPerSecond,
    /// Hz
    Hertz,
}

/// A unit in terms of SI base units: base = factor x value, with the exponents of kg, m, s and rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseUnit {
    /// Exponents of kg, m, s, rad.
    pub exponents: [i32; 4],
    /// Size of the unit in base units.
    pub factor: f64,
}

/// How people like to see a unit: shown = factor x value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplayUnit {
    /// Name.
    pub name: &'static str,
    /// Display units per unit.
    pub factor: f64,
}

impl Unit {
    /// All units with a name.
    pub const NAMED: [Unit; 11] = [
        Unit::Meter,
        Unit::MeterPerSecond,
        Unit::MeterPerSecondSquared,
        Unit::Newton,
        Unit::NewtonMeter,
        Unit::NewtonPerMeter,
        Unit::NewtonSecondPerMeter,
        Unit::KilogramMeter,
        Unit::Radian,
        Unit::RadianPerSecond,
        Unit::Hertz,
    ];

    /// The unit's name; empty for numbers without dimension.
    pub fn name(self) -> &'static str {
        match self {
            Unit::One => "",
            Unit::Meter => "m",
            Unit::MeterPerSecond => "m/s",
            Unit::MeterPerSecondSquared => "m/s2",
            Unit::Newton => "N",
            Unit::NewtonMeter => "N.m",
            Unit::NewtonPerMeter => "N/m",
            Unit::NewtonSecondPerMeter => "N.s/m",
            Unit::KilogramMeter => "kg.m",
            Unit::Radian => "rad",
            Unit::RadianPerSecond => "rad/s",
            Unit::Hertz => "Hz",
        }
    }

    /// The unit in SI base units.
    pub fn base(self) -> BaseUnit {
        let (exponents, factor) = match self {
            Unit::One => ([0, 0, 0, 0], 1.0),
            Unit::Meter => ([0, 1, 0, 0], 1.0),
            Unit::MeterPerSecond => ([0, 1, -1, 0], 1.0),
            Unit::MeterPerSecondSquared => ([0, 1, -2, 0], 1.0),
            Unit::Newton => ([1, 1, -2, 0], 1.0),
            Unit::NewtonMeter => ([1, 2, -2, 0], 1.0),
            Unit::NewtonPerMeter => ([1, 0, -2, 0], 1.0),
            Unit::NewtonSecondPerMeter => ([1, 0, -1, 0], 1.0),
            Unit::KilogramMeter => ([1, 1, 0, 0], 1.0),
            Unit::Radian => ([0, 0, 0, 1], 1.0),
            Unit::RadianPerSecond => ([0, 0, -1, 1], 1.0),
            Unit::Hertz => ([0, 0, -1, 1], core::f64::consts::TAU),
        };
        BaseUnit { exponents, factor }
    }

    /// The unit people prefer to read, where there is one.
    pub fn display(self) -> Option<DisplayUnit> {
        match self {
            Unit::Radian => Some(DisplayUnit {
                name: "deg",
                factor: 180.0 / core::f64::consts::PI,
            }),
            Unit::RadianPerSecond => Some(DisplayUnit {
                name: "rpm",
                factor: 30.0 / core::f64::consts::PI,
            }),
            Unit::Meter => Some(DisplayUnit {
                name: "um",
                factor: 1e6,
            }),
            _ => None,
        }
    }
}
