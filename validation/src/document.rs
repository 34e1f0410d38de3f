//! The claims as a part of `docs/validation.md`.

use geartrain::config::TorqueCoupling;

use crate::claims::{Row, Rule, parts};
use crate::family::Family;
use crate::machine::Shapes;

/// The line of the page that the tables follow.
pub const MARK: &str = "## Claim by claim\n";

/// The four families of the table, in the order of its columns.
#[derive(Debug)]
pub struct Families {
    families: [Family; 4],
}

/// The columns.
const COLUMNS: [(Shapes, TorqueCoupling); 4] = [
    (Shapes::Three, TorqueCoupling::Consistent),
    (Shapes::Converged, TorqueCoupling::Consistent),
    (Shapes::Three, TorqueCoupling::AsPrinted),
    (Shapes::Converged, TorqueCoupling::AsPrinted),
];

/// A claim with its four values.
#[derive(Debug)]
pub struct Measured {
    /// What is claimed.
    pub row: Row,
    /// 3 modes, converged; both again with the printed torque.
    pub values: [f64; 4],
}

impl Families {
    /// Runs everything, on as many cores as there are.
    pub fn run() -> Families {
        let families = std::thread::scope(|scope| {
            let threads =
                COLUMNS.map(|(shapes, torque)| scope.spawn(move || Family::of(shapes, torque)));
            threads.map(|thread| thread.join().expect("a run that ends"))
        });
        Families { families }
    }

    /// The runs of one column; none for [`Shapes::Finer`].
    pub fn family(&self, shapes: Shapes, torque: TorqueCoupling) -> Option<&Family> {
        let columns = COLUMNS.iter().zip(&self.families);
        let mut found = columns.filter(|(column, _)| **column == (shapes, torque));
        found.next().map(|(_, family)| family)
    }

    /// Measures a claim.
    pub fn measure(&self, row: Row) -> Measured {
        let values = self.families.each_ref().map(row.measure);
        Measured { row, values }
    }

    /// All parts as Markdown.
    pub fn document(&self) -> String {
        let (mut counts, mut text) = ([0; 4], String::new());
        for part in parts() {
            text += &format!("### {}\n\n{HEAD}", part.title);
            for row in part.rows {
                let measured = self.measure(row);
                let [three, converged, ..] = measured.holds();
                counts[2 * usize::from(!three) + usize::from(!converged)] += 1;
                text += &measured.line();
            }
            for remark in part.remarks {
                text += &format!("\n* {remark}\n");
            }
            text += "\n";
        }
        let [both, only_three, only_converged, neither] = counts;
        format!(
            "Of {} rows, {both} hold with either basis, {only_three} only with three modes, {only_converged} only with a converged \
             basis and {neither} do not hold.\n\n{}\n",
            counts.iter().sum::<usize>(),
            text.trim_end()
        )
    }
}

/// Head of every table.
const HEAD: &str = "\
| claim | quantity (holds where) | 3 modes | converged | (6) as printed: 3 modes | converged | holds? |
|---|---|---|---|---|---|---|
";

impl Measured {
    /// Whether each value confirms the claim.
    pub fn holds(&self) -> [bool; 4] {
        self.values.map(|value| self.row.holds.confirms(value))
    }

    fn line(&self) -> String {
        let [a, b, c, d] = self.values.map(significant);
        let [three, converged, printed_three, printed] = self.holds();
        let mut holds = verdict(three, converged).to_string();
        if (printed_three, printed) != (three, converged) {
            holds += &format!("; as printed: {}", verdict(printed_three, printed));
        }
        let Row {
            claim, quantity, ..
        } = self.row;
        let rule = rule(self.row.holds);
        format!("| {claim} | {quantity} ({rule}) | {a} | {b} | {c} | {d} | {holds} |\n")
    }
}

fn verdict(three: bool, converged: bool) -> &'static str {
    match (three, converged) {
        (true, true) => "**yes**",
        (false, false) => "**no**",
        (true, false) => "**only with 3 modes**",
        (false, true) => "**only converged**",
    }
}

fn rule(rule: Rule) -> String {
    match rule {
        Rule::Above(limit) => format!("> {limit}"),
        Rule::Below(limit) => format!("< {limit}"),
        Rule::Between(low, high) => format!("{low} to {high}"),
    }
}

/// Three significant digits, without the noise of what is zero.
fn significant(value: f64) -> String {
    if value.abs() < 1e-3 {
        return "0.00".to_string();
    }
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    let whole = (libm::floor(libm::log10(rounded.abs())) as i32 + 1).max(0);
    let digits = usize::try_from(3 - whole).unwrap_or(0);
    format!("{rounded:.digits$}")
}
