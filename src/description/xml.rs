//! modelDescription.xml (FMI 2.0.4, chapter 2.2).

use std::io;

use quick_xml::events::{BytesDecl, Event};

use super::nominal::Nominals;
use super::{LOG_CATEGORIES, Xml, number, written};
use crate::config::Config;
use crate::interface::{Causality, Interface, OUTPUT_DERIVATIVE_ORDER, Unit, Variable};
use crate::model::ModalModel;
use crate::train::GearTrain;

/// The text of modelDescription.xml.
pub fn model_description(
    config: &Config,
    train: &GearTrain,
    model: &ModalModel,
    interface: &Interface,
) -> String {
    let nominals = Nominals::of(train, model);
    written(|xml| {
        xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        let guid = interface.fingerprint(config);
        let root = [
            ("fmiVersion", "2.0"),
            ("modelName", &config.name),
            ("guid", &guid),
            ("description", &config.description),
            ("version", env!("CARGO_PKG_VERSION")),
            (
                "generationTool",
                concat!("geartrain ", env!("CARGO_PKG_VERSION")),
            ),
            ("variableNamingConvention", "structured"),
        ];
        let given = root
            .into_iter()
            .filter(|(name, value)| *name != "description" || !value.is_empty());
        xml.create_element("fmiModelDescription")
            .with_attributes(given)
            .write_inner_content(|xml| {
                co_simulation(xml, config)?;
                units(xml)?;
                log_categories(xml)?;
                default_experiment(xml, config)?;
                variables(xml, interface, &nominals)?;
                structure(xml, config, interface)
            })?;
        Ok(())
    })
}

fn co_simulation(xml: &mut Xml, config: &Config) -> io::Result<()> {
    let order = OUTPUT_DERIVATIVE_ORDER.to_string();
    let attributes = [
        ("modelIdentifier", config.name.as_str()),
        ("canHandleVariableCommunicationStepSize", "true"),
        ("canNotUseMemoryManagementFunctions", "true"),
        ("canInterpolateInputs", "true"),
        ("maxOutputDerivativeOrder", order.as_str()),
        ("canGetAndSetFMUstate", "true"),
        ("canSerializeFMUstate", "true"),
        ("providesDirectionalDerivative", "true"),
    ];
    xml.create_element("CoSimulation")
        .with_attributes(attributes)
        .write_empty()?;
    Ok(())
}

fn units(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("UnitDefinitions")
        .write_inner_content(|xml| {
            for unit in Unit::NAMED {
                let definition = xml
                    .create_element("Unit")
                    .with_attribute(("name", unit.name()));
                definition.write_inner_content(|xml| base_and_display(xml, unit))?;
            }
            Ok(())
        })?;
    Ok(())
}

fn base_and_display(xml: &mut Xml, unit: Unit) -> io::Result<()> {
    let base = unit.base();
    let mut element = xml.create_element("BaseUnit");
    for (name, exponent) in ["kg", "m", "s", "rad"].into_iter().zip(base.exponents) {
        if exponent != 0 {
            element = element.with_attribute((name, exponent.to_string().as_str()));
        }
    }
    if base.factor != 1.0 {
        element = element.with_attribute(("factor", number(base.factor).as_str()));
    }
    element.write_empty()?;
    if let Some(display) = unit.display() {
        let factor = number(display.factor);
        let attributes = [("name", display.name), ("factor", factor.as_str())];
        xml.create_element("DisplayUnit")
            .with_attributes(attributes)
            .write_empty()?;
    }
    Ok(())
}

fn log_categories(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("LogCategories")
        .write_inner_content(|xml| {
            for (name, description) in LOG_CATEGORIES {
                let attributes = [("name", name), ("description", description)];
                xml.create_element("Category")
                    .with_attributes(attributes)
                    .write_empty()?;
            }
            Ok(())
        })?;
    Ok(())
}

fn default_experiment(xml: &mut Xml, config: &Config) -> io::Result<()> {
    let simulation = &config.simulation;
    let values = [
        ("startTime", 0.0),
        ("stopTime", simulation.stop_time),
        ("tolerance", simulation.tolerance),
        ("stepSize", simulation.step_size),
    ];
    let values = values.map(|(name, value)| (name, number(value)));
    let attributes = values.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element("DefaultExperiment")
        .with_attributes(attributes)
        .write_empty()?;
    Ok(())
}

fn variables(xml: &mut Xml, interface: &Interface, nominals: &Nominals<'_>) -> io::Result<()> {
    xml.create_element("ModelVariables")
        .write_inner_content(|xml| {
            for (reference, variable) in interface.variables.iter().enumerate() {
                scalar_variable(xml, reference, variable, nominals)?;
            }
            Ok(())
        })?;
    Ok(())
}

fn scalar_variable(
    xml: &mut Xml,
    reference: usize,
    variable: &Variable,
    nominals: &Nominals<'_>,
) -> io::Result<()> {
    let (causality, variability, initial) = words(variable.causality());
    let reference = reference.to_string();
    let mut element = xml.create_element("ScalarVariable").with_attributes([
        ("name", variable.name.as_str()),
        ("valueReference", &reference),
        ("description", &variable.description),
        ("causality", causality),
        ("variability", variability),
    ]);
    if let Some(initial) = initial {
        element = element.with_attribute(("initial", initial));
    }
    element.write_inner_content(|xml| {
        let mut real = xml.create_element("Real");
        if variable.unit != Unit::One {
            real = real.with_attribute(("unit", variable.unit.name()));
        }
        if let Some(display) = variable.unit.display() {
            real = real.with_attribute(("displayUnit", display.name));
        }
        let range = variable.quantity.range();
        let numbers = [
            ("min", range.min),
            ("max", range.max),
            ("nominal", nominals.value(variable.quantity)),
            ("start", variable.start),
        ];
        for (name, value) in numbers {
            if let Some(value) = value {
                real = real.with_attribute((name, number(value).as_str()));
            }
        }
        real.write_empty()?;
        Ok(())
    })?;
    Ok(())
}

/// causality, variability, initial.
fn words(causality: Causality) -> (&'static str, &'static str, Option<&'static str>) {
    match causality {
        Causality::Input => ("input", "continuous", None),
        Causality::Output => ("output", "continuous", Some("calculated")),
        Causality::Local => ("local", "continuous", Some("calculated")),
        Causality::Parameter => ("parameter", "fixed", Some("exact")),
        Causality::CalculatedParameter => ("calculatedParameter", "fixed", Some("calculated")),
    }
}

fn structure(xml: &mut Xml, config: &Config, interface: &Interface) -> io::Result<()> {
    let with = |wanted: &[Causality]| -> Vec<usize> {
        let variables = interface.variables.iter().enumerate();
        let matching = variables.filter(|(_, variable)| wanted.contains(&variable.causality()));
        matching.map(|(index, _)| index).collect()
    };
    xml.create_element("ModelStructure")
        .write_inner_content(|xml| {
            let outputs = with(&[Causality::Output]);
            if !outputs.is_empty() {
                xml.create_element("Outputs").write_inner_content(|xml| {
                    for index in outputs {
                        let inputs = interface.feed_through(config, &interface.variables[index]);
                        unknown(xml, index, Some(inputs))?;
                    }
                    Ok(())
                })?;
            }
            // Which inputs and parameters the initial outputs follow from is left open: all of them may.
            let unknowns = with(&[Causality::Output, Causality::CalculatedParameter]);
            if !unknowns.is_empty() {
                xml.create_element("InitialUnknowns")
                    .write_inner_content(|xml| {
                        for index in unknowns {
                            let origin = interface.origin(config, &interface.variables[index]);
                            unknown(xml, index, origin)?;
                        }
                        Ok(())
                    })?;
            }
            Ok(())
        })?;
    Ok(())
}

/// A variable that depends on others: an empty list means on none, and no list on any.
fn unknown(xml: &mut Xml, index: usize, dependencies: Option<Vec<usize>>) -> io::Result<()> {
    let mut element = xml
        .create_element("Unknown")
        .with_attribute(("index", one_based(index).as_str()));
    if let Some(dependencies) = dependencies {
        let list: Vec<String> = dependencies.into_iter().map(one_based).collect();
        element = element.with_attribute(("dependencies", list.join(" ").as_str()));
    }
    element.write_empty()?;
    Ok(())
}

fn one_based(index: usize) -> String {
    (index + 1).to_string()
}
