//! SystemStructure.ssd: FMUs and the connections between them (System Structure and Parameterization 1.0).
//!
//! Only inputs with a connection become connectors: masters set every one, and those that lead nowhere to zero.

use std::io;

use quick_xml::events::{BytesDecl, Event};

use super::{Xml, number, written};
use crate::interface::{Causality, Interface};

/// One FMU of a system.
#[derive(Debug, Clone, Copy)]
pub struct Component<'a> {
    /// Its name in the system.
    pub name: &'a str,
    /// Its variables.
    pub interface: &'a Interface,
}

/// From component and output to component and input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Connection {
    /// Index of the component and name of the output.
    pub from: (usize, String),
    /// Index of the component and name of the input.
    pub to: (usize, String),
}

/// The text of SystemStructure.ssd; the FMUs stand in `resources/<name>.fmu`.
pub fn system_structure(
    name: &str,
    stop_time: f64,
    components: &[Component<'_>],
    connections: &[Connection],
) -> String {
    const SSD: &str = "http://ssp-standard.org/SSP1/SystemStructureDescription";
    const SSC: &str = "http://ssp-standard.org/SSP1/SystemStructureCommon";
    written(|xml| {
        xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        xml.create_element("ssd:SystemStructureDescription")
            .with_attributes([
                ("xmlns:ssd", SSD),
                ("xmlns:ssc", SSC),
                ("version", "1.0"),
                ("name", name),
                (
                    "generationTool",
                    concat!("geartrain ", env!("CARGO_PKG_VERSION")),
                ),
            ])
            .write_inner_content(|xml| {
                xml.create_element("ssd:System")
                    .with_attribute(("name", "system"))
                    .write_inner_content(|xml| system(xml, components, connections))?;
                xml.create_element("ssd:DefaultExperiment")
                    .with_attributes([("startTime", "0.0"), ("stopTime", &number(stop_time))])
                    .write_empty()?;
                Ok(())
            })?;
        Ok(())
    })
}

fn system(
    xml: &mut Xml,
    components: &[Component<'_>],
    connections: &[Connection],
) -> io::Result<()> {
    xml.create_element("ssd:Elements")
        .write_inner_content(|xml| {
            for (index, one) in components.iter().enumerate() {
                let connected = |name: &str| {
                    connections
                        .iter()
                        .any(|link| link.to.0 == index && link.to.1 == name)
                };
                component(xml, one, connected)?;
            }
            Ok(())
        })?;
    xml.create_element("ssd:Connections")
        .write_inner_content(|xml| {
            for Connection { from, to } in connections {
                xml.create_element("ssd:Connection")
                    .with_attributes([
                        ("startElement", components[from.0].name),
                        ("startConnector", from.1.as_str()),
                        ("endElement", components[to.0].name),
                        ("endConnector", to.1.as_str()),
                    ])
                    .write_empty()?;
            }
            Ok(())
        })?;
    Ok(())
}

fn component(
    xml: &mut Xml,
    Component { name, interface }: &Component<'_>,
    connected: impl Fn(&str) -> bool,
) -> io::Result<()> {
    let source = format!("resources/{name}.fmu");
    xml.create_element("ssd:Component")
        .with_attributes([
            ("name", *name),
            ("type", "application/x-fmu-sharedlibrary"),
            ("source", &source),
        ])
        .write_inner_content(|xml| {
            xml.create_element("ssd:Connectors")
                .write_inner_content(|xml| {
                    for variable in &interface.variables {
                        let kind = match variable.causality() {
                            Causality::Output => "output",
                            Causality::Input if connected(&variable.name) => "input",
                            _ => continue,
                        };
                        xml.create_element("ssd:Connector")
                            .with_attributes([("name", variable.name.as_str()), ("kind", kind)])
                            .write_inner_content(|xml| {
                                xml.create_element("ssc:Real").write_empty()?;
                                Ok(())
                            })?;
                    }
                    Ok(())
                })?;
            Ok(())
        })?;
    Ok(())
}
