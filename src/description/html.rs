//! An HTML page while it is written: well-formed as XML too, one style, no script, nothing from outside.

use core::fmt::Write;

use quick_xml::escape::escape;

use crate::drawing;

/// A page.
#[derive(Debug, Clone)]
pub struct Html {
    body: String,
}

/// A cell of a table.
#[derive(Debug, Clone)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number: as it is shown, and with all its bits.
    Number(String, f64),
    /// Several of them.
    Numbers(Vec<(String, f64)>),
}

impl From<&str> for Cell {
    fn from(text: &str) -> Cell {
        Cell::Text(text.to_string())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Cell {
        Cell::Text(text)
    }
}

impl Cell {
    /// A number with so many decimals.
    pub fn fixed(value: f64, decimals: usize) -> Cell {
        Cell::Number(format!("{value:.decimals$}"), value)
    }

    /// Numbers with so many decimals.
    pub fn list(values: &[f64], decimals: usize) -> Cell {
        let shown = values
            .iter()
            .map(|value| (format!("{value:.decimals$}"), *value));
        Cell::Numbers(shown.collect())
    }

    /// A share in percent.
    pub fn percent(share: f64) -> Cell {
        let percent = 100.0 * share;
        let decimals = if percent.abs() < 10.0 { 2 } else { 0 };
        Cell::Number(format!("{percent:.decimals$} %"), share)
    }

    /// A number with so many digits after the first and a power of ten.
    pub fn scientific(value: f64, digits: usize) -> Cell {
        Cell::Number(format!("{value:.digits$e}"), value)
    }
}

impl Html {
    /// An empty page.
    pub fn new() -> Html {
        Html {
            body: String::new(),
        }
    }

    /// The text of the page; `title` is what its tab says.
    pub fn finish(self, title: &str) -> String {
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{}</title>\n\
             <style>\n{}{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
            escape(title),
            include_str!("page.css"),
            drawing::STYLE,
            self.body
        )
    }

    /// An element with text.
    pub fn text(&mut self, element: &str, text: &str) {
        let text = escape(text);
        self.push(format_args!("<{element}>{text}</{element}>"));
    }

    /// An element of a class with text.
    pub fn classed(&mut self, element: &str, class: &str, text: &str) {
        let text = escape(text);
        self.push(format_args!(
            "<{element} class=\"{class}\">{text}</{element}>"
        ));
    }

    /// A heading that links can reach.
    pub fn heading(&mut self, id: &str, text: &str) {
        let text = escape(text);
        self.push(format_args!("<h2 id=\"{id}\">{text}</h2>"));
    }

    /// Links to headings: identifier and text.
    pub fn links(&mut self, links: &[(&str, &str)]) {
        let link = |(id, text): &(&str, &str)| format!("<a href=\"#{id}\">{}</a>", escape(*text));
        let links: String = links.iter().map(link).collect();
        self.push(format_args!("<nav>{links}</nav>"));
    }

    /// Lines of code.
    pub fn code(&mut self, code: &str) {
        let code = escape(code);
        self.push(format_args!("<pre><code>{code}</code></pre>"));
    }

    /// A picture ([`crate::drawing`]) with what one sees in it.
    pub fn figure(&mut self, svg: &str, caption: &str) {
        let caption = escape(caption);
        self.push(format_args!(
            "<figure>\n{svg}<figcaption>{caption}</figcaption>\n</figure>"
        ));
    }

    /// Short answers beside each other: class (`good`, `bad` or nothing), what, value, more.
    pub fn cards(&mut self, cards: &[[String; 4]]) {
        self.push(format_args!("<div class=\"cards\">"));
        for [class, what, value, more] in cards {
            let [what, value, more] = [what, value, more].map(|text| escape(text.as_str()));
            self.push(format_args!(
                "<div class=\"card {class}\"><span class=\"what\">{what}</span><span class=\"value\">{value}</span>\
                 <span class=\"more\">{more}</span></div>"
            ));
        }
        self.push(format_args!("</div>"));
    }

    /// A table; columns whose first cell is a number stand right.
    pub fn table(&mut self, head: &[&str], rows: &[Vec<Cell>]) {
        self.push(format_args!("<div class=\"scroll\">\n<table>"));
        let right = |column: usize| {
            let first = rows.iter().filter_map(|row| row.get(column));
            let number = |cell: &Cell| matches!(cell, Cell::Number(..));
            if first.clone().any(number) {
                " class=\"n\""
            } else {
                ""
            }
        };
        let titles = head.iter().enumerate();
        let titles =
            titles.map(|(column, title)| format!("<th{}>{}</th>", right(column), escape(*title)));
        let titles: String = titles.collect();
        self.push(format_args!("<tr>{titles}</tr>"));
        for row in rows {
            let cells = row.iter().enumerate().map(|(column, cell)| match cell {
                Cell::Text(text) => format!("<td{}>{}</td>", right(column), escape(text.as_str())),
                Cell::Number(shown, value) => {
                    format!("<td class=\"n\">{}</td>", data(shown, *value))
                }
                Cell::Numbers(numbers) => {
                    let numbers = numbers.iter().map(|(shown, value)| data(shown, *value));
                    format!("<td>{}</td>", numbers.collect::<Vec<_>>().join(", "))
                }
            });
            let cells: String = cells.collect();
            self.push(format_args!("<tr>{cells}</tr>"));
        }
        self.push(format_args!("</table>\n</div>"));
    }

    /// Something to be unfolded.
    pub fn folded(&mut self, summary: &str, inside: impl FnOnce(&mut Html)) {
        let summary = escape(summary);
        self.push(format_args!("<details><summary>{summary}</summary>"));
        inside(self);
        self.push(format_args!("</details>"));
    }

    fn push(&mut self, element: core::fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        let _ = writeln!(self.body, "{element}");
    }
}

/// A number as it is shown, and to the last bit for programs.
fn data(shown: &str, value: f64) -> String {
    format!("<data value=\"{value:?}\">{shown}</data>")
}

impl Default for Html {
    fn default() -> Html {
        Html::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_well_formed_whatever_names_say() {
        let mut html = Html::new();
        html.text("p", "a < b & \"c\"");
        html.cards(&[["bad".into(), "<".into(), "&".into(), "'".into()]]);
        html.table(
            &["<x>"],
            &[vec![Cell::fixed(1.0 / 3.0, 2)], vec!["-".into()]],
        );
        html.folded("more", |html| html.code("<rotor>"));
        let page = html.finish("</title>");
        let mut reader = quick_xml::Reader::from_str(&page);
        while reader.read_event().unwrap() != quick_xml::events::Event::Eof {}
        assert!(page.contains("<data value=\"0.3333333333333333\">0.33</data>"));
        assert!(!page.contains("</title></title>"));
    }
}
