//! Numbers with units, such as `"40 inch"`: from a string to SI.
//!
//! A string is an expression of numbers and units with `+ - * / ^ ( )`. `fend-core` evaluates it in rational arithmetic, and
//! the nearest f64 is taken once, at the end: where the factor is exact, so is the result (40 inch are 1.016 m to the bit).
//!
//! fend knows more than units (functions, dates, `c`, `e`) and takes a radian for 1. So only the units named here get
//! through, in their own spelling, and `rad` is a unit of its own: revolutions are angles, and Hz is 1/s, not rad/s.

use std::sync::atomic::{AtomicUsize, Ordering};

use fend_core::{Context, CustomUnitAttribute, Interrupt, evaluate_with_interrupt};

use super::dimension::{Dimension, NAMED};

/// Units that take a prefix.
const PREFIXED: [&str; 7] = ["m", "g", "s", "N", "Pa", "Hz", "rad"];

const PREFIXES: [&str; 9] = ["n", "u", "µ", "m", "c", "d", "k", "M", "G"];

/// Units without prefix, as they are written and as fend is told.
const WHOLE: [(&str, &str); 28] = [
    ("inch", "inch"),
    ("inches", "inch"),
    ("in", "inch"),
    ("ft", "ft"),
    ("foot", "ft"),
    ("feet", "ft"),
    ("t", "tonne"),
    ("lb", "lb"),
    ("oz", "oz"),
    ("lbf", "lbf"),
    ("bar", "bar"),
    ("psi", "psi"),
    ("ksi", "ksi"),
    ("min", "min"),
    ("h", "hour"),
    ("deg", "deg"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("°", "deg"),
    ("arcmin", "arcmin"),
    ("arcsec", "arcsec"),
    ("rev", "rev"),
    ("turn", "rev"),
    ("turns", "rev"),
    ("rpm", "rpm"),
    ("rps", "rps"),
    ("pi", "pi"),
    ("π", "pi"),
];

/// Units as they are here, whatever fend takes them for.
const OWN: [(&str, &str, CustomUnitAttribute); 9] = [
    ("rad", "!", CustomUnitAttribute::AllowShortPrefix),
    ("deg", "pi/180 rad", CustomUnitAttribute::None),
    ("arcmin", "deg/60", CustomUnitAttribute::None),
    ("arcsec", "deg/3600", CustomUnitAttribute::None),
    ("rev", "2 pi rad", CustomUnitAttribute::None),
    ("rpm", "2 pi rad/min", CustomUnitAttribute::None),
    ("rps", "2 pi rad/s", CustomUnitAttribute::None),
    ("ksi", "1000 psi", CustomUnitAttribute::None),
    ("Hz", "1/s", CustomUnitAttribute::AllowShortPrefix),
];

/// Longer strings are no numbers [letters].
const LONGEST: usize = 100;

/// Work after which an expression is given up, counted by fend itself: 9^9^9^9 never ends.
const MOST_WORK: usize = 10_000;

/// The value of `text` in the SI unit of `wanted`, or what is wrong with it.
pub(super) fn quantity(text: &str, wanted: &Dimension) -> Result<f64, String> {
    let counts = |letter: char| letter.is_ascii_digit() || letter == 'π';
    let none = !text.contains(counts) && !text.contains("pi");
    if none || text.chars().count() > LONGEST {
        return Err(format!(
            "must be a number, with its unit where it has one, found the string \"{text}\""
        ));
    }
    let expression = translate(text)?;
    if !parentheses_match(&expression) {
        return Err(format!("\"{text}\": the parentheses do not match"));
    }
    if let Some(value) = converted(&expression, wanted) {
        return Ok(value);
    }
    let wants = match wanted.unit.as_ref() {
        "" => format!("{} is wanted", wanted.name),
        unit => format!("{} in {unit} is wanted", wanted.name),
    };
    if let Err(reason) = evaluate(&expression) {
        return Err(format!(
            "\"{text}\" cannot be calculated ({reason}), {wants}"
        ));
    }
    let plain = converted(&expression, &super::dimension::NUMBER).is_some();
    let is = NAMED
        .iter()
        .find(|kind| converted(&expression, kind).is_some());
    Err(match is {
        _ if plain => format!("\"{text}\" has no unit, {wants}"),
        Some(kind) => format!("\"{text}\" is {}, {wants}", kind.name),
        None => format!("\"{text}\" is something else, {wants}"),
    })
}

/// The expression in fend's words; what is not a number, an operator or a known unit is refused.
fn translate(text: &str) -> Result<String, String> {
    let mut expression = String::with_capacity(text.len() + 8);
    let mut rest = text.trim();
    while let Some(letter) = rest.chars().next() {
        let digits = rest.len() - rest.trim_start_matches(is_digit).len();
        let word = rest.len() - rest.trim_start_matches(is_unit_letter).len();
        let length = if digits > 0 {
            let length = digits + exponent_length(&rest[digits..]);
            expression.push_str(&rest[..length]);
            length
        } else if word > 0 {
            let unit = known(&rest[..word])
                .ok_or_else(|| format!("\"{text}\": {}", unknown(&rest[..word])))?;
            expression.push(' ');
            expression.push_str(&unit);
            word
        } else {
            expression.push_str(operator(letter).ok_or_else(|| {
                format!("\"{text}\" is not understood at \"{letter}\"; write a number and its unit, such as \"40 inch\"")
            })?);
            letter.len_utf8()
        };
        rest = &rest[length..];
    }
    Ok(expression)
}

/// fend itself completes missing parentheses.
fn parentheses_match(expression: &str) -> bool {
    let mut open = 0_usize;
    for letter in expression.chars() {
        match letter {
            '(' => open += 1,
            ')' if open == 0 => return false,
            ')' => open -= 1,
            _ => {}
        }
    }
    open == 0
}

fn is_digit(letter: char) -> bool {
    letter.is_ascii_digit() || letter == '.'
}

fn is_unit_letter(letter: char) -> bool {
    letter.is_alphabetic() || letter == '°'
}

/// Length of `e-3` after digits; the e of a unit is followed by no digit.
fn exponent_length(rest: &str) -> usize {
    let Some(after) = rest.strip_prefix(['e', 'E']) else {
        return 0;
    };
    let digits = after.strip_prefix(['+', '-']).unwrap_or(after);
    let rest_after = digits.trim_start_matches(|letter: char| letter.is_ascii_digit());
    if rest_after.len() == digits.len() {
        0
    } else {
        rest.len() - rest_after.len()
    }
}

fn operator(letter: char) -> Option<&'static str> {
    Some(match letter {
        ' ' => " ",
        '+' => "+",
        '-' | '−' => "-",
        '*' | '·' | '⋅' | '×' => "*",
        '/' => "/",
        '^' => "^",
        '²' => "^2",
        '³' => "^3",
        '(' => "(",
        ')' => ")",
        '%' => "%",
        _ => return None,
    })
}

/// What fend is told for a unit.
fn known(word: &str) -> Option<String> {
    if let Some((_, told)) = WHOLE.iter().find(|(written, _)| *written == word) {
        return Some((*told).to_string());
    }
    let with_prefix = PREFIXES.iter().any(|prefix| {
        let unit = word.strip_prefix(prefix);
        unit.is_some_and(|unit| PREFIXED.contains(&unit))
    });
    let found = PREFIXED.contains(&word) || with_prefix;
    found.then(|| word.replace(['µ', 'μ'], "u"))
}

/// The message about an unknown unit, with what was probably meant.
fn unknown(word: &str) -> String {
    let splits = word.char_indices().skip(1);
    let product = splits
        .map(|(index, _)| word.split_at(index))
        .find(|(left, right)| known(left).is_some() && known(right).is_some());
    let whole = WHOLE.iter().map(|(written, _)| *written);
    let spelling = whole
        .chain(PREFIXED)
        .find(|written| written.eq_ignore_ascii_case(word));
    let hint = match (product, spelling) {
        (Some((left, right)), _) => format!("write \"{left} {right}\""),
        (None, Some(spelling)) => format!("it is written \"{spelling}\""),
        (None, None) => {
            let whole = "inch, ft, t, lb, oz, lbf, bar, psi, ksi, min, h, deg, rev, rpm";
            format!(
                "known are {} with prefixes from n to G, and {whole}",
                PREFIXED.join(", ")
            )
        }
    };
    format!("unknown unit \"{word}\"; {hint}")
}

/// The value of an expression in a unit; `None` when it is of another kind.
fn converted(expression: &str, kind: &Dimension) -> Option<f64> {
    let unit = match kind.unit.as_ref() {
        "" => "1",
        unit => unit,
    };
    // 30 digits, read to the nearest f64: of a number that needs more, the rest does not matter.
    let result = evaluate(&format!("({expression}) to ({unit}) to 30 sf")).ok()?;
    let digits = result.strip_prefix("approx. ").unwrap_or(&result);
    digits.split(' ').next()?.parse().ok()
}

fn evaluate(expression: &str) -> Result<String, String> {
    let mut context = Context::new();
    for (name, definition, attribute) in &OWN {
        context.define_custom_unit_v1(name, name, definition, attribute);
    }
    let result = evaluate_with_interrupt(expression, &mut context, &Work(AtomicUsize::new(0)))?;
    Ok(result.get_main_result().to_string())
}

/// Counts how often fend asks whether to go on.
struct Work(AtomicUsize);

impl Interrupt for Work {
    fn should_interrupt(&self) -> bool {
        self.0.fetch_add(1, Ordering::Relaxed) >= MOST_WORK
    }
}
