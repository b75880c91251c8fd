//! Finds an operation in the heading of a column: the cells of `1000 t (s)`, `1/time` and `log time` are not the time.

use super::table::rendered;
use crate::bind::{behind_heading, of_heading};
use labspec_bind::units;

/// Functions whose name begins a heading, and words for operations.
const FUNCTIONS: [&str; 8] = ["log", "ln", "lg", "exp", "sqrt", "sin", "cos", "tan"];
const WORDS: [&str; 13] = [
    "minus ",
    "twice ",
    "half of ",
    "half the ",
    "double the ",
    "inverse of ",
    "reciprocal ",
    "square of ",
    "square root ",
    "root of ",
    " squared",
    " cubed",
    " times 10",
];

/// Words for a power of ten in which the cells count: `speed in thousands`.
const SCALES: [&str; 10] = [
    "thousands",
    "millions",
    "billions",
    "hundreds",
    "dozens",
    "tausend",
    "millionen",
    "milliers",
    "millones",
    "migliaia",
];

/// The part of a heading that computes with the quantity that it names: `1000 t` in `1000 t (s)`; `None` where it only names it.
pub(in crate::verify) fn operation_in_heading(head: &str) -> Option<String> {
    let head = rendered(head);
    let lower = head.to_lowercase();
    let mut words = lower.split(|c: char| !c.is_alphabetic()).skip(1);
    if words.any(|word| SCALES.contains(&word)) {
        return Some(head);
    }
    let label = without_unit(&head).trim();
    // `E = ½mv²` names the quantity.
    if label.contains(['=', '≈']) {
        return None;
    }
    let computes = has_operator(label) || begins_with_factor(label) || has_function(&label.to_lowercase());
    computes.then(|| label.to_string())
}

/// The heading without its unit: `t` in `t (10^-3 s)` and `t / ms`.
fn without_unit(head: &str) -> &str {
    let unit = of_heading(head).map(|(unit, _)| unit).filter(|unit| *unit != head);
    let Some(unit) = unit.or_else(|| behind_heading(head)) else { return head };
    let label = head.rfind(unit).and_then(|start| head.get(..start)).unwrap_or(head);
    let label = label.trim_end_matches([' ', '(', '[', '（', '/', ',', ':', '-', '–']);
    label.strip_suffix(" in").unwrap_or(label)
}

/// Whether a label contains a sign of an operation. A unit alone (`m/s²`) does not.
fn has_operator(label: &str) -> bool {
    let sign = ['-', '–', '−', '+'].into_iter().find_map(|sign| label.strip_prefix(sign));
    let signed = sign.is_some_and(|rest| rest.trim_start().starts_with(char::is_alphanumeric));
    let raised = |c: char| matches!(c, '^' | '√' | '÷');
    let product = |c: char| matches!(c, '×' | '·' | '*' | '⋅');
    let inverse = label.starts_with(|c: char| c.is_ascii_digit()) && label.contains('/');
    !units::is_unit(label) && (signed || inverse || label.contains(raised) || label.contains(product))
}

/// Whether a label begins with a number and a symbol: `1000 t`. `2 m` is a quantity, and `3 balls` are counted.
fn begins_with_factor(label: &str) -> bool {
    let rest = label.trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | ','));
    let symbol = rest.trim_start();
    let mut letters = symbol.chars();
    let one = matches!((letters.next(), letters.next()), (Some(c), None | Some('_' | ' ' | '(')) if c.is_alphabetic());
    let number = rest.len() < label.len() && label.starts_with(|c: char| c.is_ascii_digit());
    let is_symbol = one && !units::is_unit(symbol) && !symbol.starts_with(['x', 'X', 'D']);
    number && is_symbol && !rest.starts_with(char::is_uppercase)
}

/// Whether a label in lower case names an operation: `log time`, `the square root of the time`.
fn has_function(label: &str) -> bool {
    let applied = |rest: &str| rest.starts_with([' ', '(', '_']);
    FUNCTIONS.iter().filter_map(|name| label.strip_prefix(name)).any(applied)
        || WORDS.iter().any(|word| {
            label.match_indices(word).any(|(start, _)| {
                word.starts_with(' ')
                    || start == 0
                    || label.get(..start).is_some_and(|t| t.ends_with([' ', '(', '[']))
            })
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_that_compute_are_found() {
        for head in [
            "1000 t (s)",
            "time ×10³ (s)",
            "10³·time (s)",
            "2·time (s)",
            "1/time",
            "1/t (1/s)",
            "√time (s)",
            "−time (s)",
            "log time",
            "time² (s)",
            "time squared, s",
            "the square root of the time (s)",
            "t^2 / s",
            "speed in thousands",
            "speed (thousands)",
            "speed (thousands of m/s)",
            "Geschwindigkeit in Tausend",
        ] {
            assert!(operation_in_heading(head).is_some(), "{head}");
        }
        assert_eq!(operation_in_heading("1000 t (s)").as_deref(), Some("1000 t"));
        for head in [
            "time (s)",
            "t / ms",
            "t in ms",
            "t, ms",
            "t (10^-3 s)",
            "t (10³ s)",
            "m/s²",
            "speed (m/s^2)",
            "area in m²",
            "after 2 s",
            "2 m",
            "2 m (s)",
            "3 balls (s)",
            "run 2",
            "heavy/light",
            "half-life (s)",
            "double pendulum (s)",
            "logarithm",
            "2x speed (s)",
            "-",
            "",
            "t (°)",
            "E = ½mv² (J)",
        ] {
            assert_eq!(operation_in_heading(head), None, "{head}");
        }
    }
}
