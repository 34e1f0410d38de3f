//! The texts inside an FMU: modelDescription.xml and the documentation page, both from the one table of
//! [`crate::interface`].

pub mod html;
mod nominal;
mod page;
mod ssd;
mod xml;

pub use page::documentation_page;
pub use ssd::{Component, Connection, system_structure};
pub use xml::model_description;

use std::io;

use quick_xml::Writer;

/// Log categories with their descriptions, as declared in modelDescription.xml.
pub const LOG_CATEGORIES: [(&str, &str); 3] = [
    (
        "logStatusError",
        "Calls that were refused or failed, with the reason",
    ),
    (
        "logStatusDiscard",
        "Information that was asked for and does not exist",
    ),
    (
        "logEvents",
        "What the slave does, for debugging of co-simulations",
    ),
];

type Xml = Writer<Vec<u8>>;

/// Runs `content` on a fresh writer; writing to memory cannot fail.
fn written(content: impl FnOnce(&mut Xml) -> io::Result<()>) -> String {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    content(&mut writer).expect("writing to memory does not fail");
    let mut text = String::from_utf8(writer.into_inner()).expect("only UTF-8 was written");
    text.push('\n');
    text
}

/// A number with as many digits as it takes to read back the same bits.
fn number(value: f64) -> String {
    format!("{value:?}")
}
