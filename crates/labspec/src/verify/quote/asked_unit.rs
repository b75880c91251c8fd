//! The unit in which the text of a question asks for a number: `How fast is it, in km/h?`, `How many milliseconds …?`.

use super::table::rendered;
use super::unit_check::{is_unit, percentage};
use labspec_bind::units;

/// Words before the name of a unit that is counted.
const COUNTING: [&str; 6] = ["how many", "wie viele", "wieviele", "combien de", "cuántos", "quanti"];
/// Words before a unit at the end of a question.
const BEFORE_UNIT: [&str; 4] = ["in", "en", "expressed in", "measured in"];
/// The most characters of a question that are read.
const MAX_LENGTH: usize = 2000;

/// The unit in which a question asks, as it is written; `None` if its text names none.
pub(crate) fn asked_unit(question: &str) -> Option<String> {
    let text: String = rendered(question).chars().take(MAX_LENGTH).collect();
    counted(&text).or_else(|| at_the_end(&text)).or_else(|| between_commas(&text))
}

/// `How many milliseconds …`
fn counted(text: &str) -> Option<String> {
    let lower = text.to_lowercase();
    // Only where the places in both texts are the same.
    let lower = if lower.len() == text.len() { lower } else { text.to_string() };
    COUNTING.iter().find_map(|words| {
        let start = lower.find(words)? + words.len();
        let rest = text.get(start..)?.trim_start();
        let word = rest.split(|c: char| c.is_whitespace() || "?,.;:)".contains(c)).next()?;
        (word.chars().count() > 1 && is_known(word)).then(|| word.to_string())
    })
}

/// `…, in km/h?`, `… (km/h)?`, `… [km/h]`
fn at_the_end(text: &str) -> Option<String> {
    let text = text.trim_end_matches(|c: char| c.is_whitespace() || "?.:…_".contains(c));
    if let Some(inside) = text.strip_suffix([')', ']']) {
        let open = inside.rfind(['(', '['])?;
        let inside = inside.get(open + 1..)?.trim();
        let unit = inside.strip_prefix("in ").unwrap_or(inside).trim();
        return is_known(unit).then(|| unit.to_string());
    }
    BEFORE_UNIT.iter().find_map(|word| {
        let start = text.rfind(&format!(" {word} "))?;
        let unit = text.get(start + word.len() + 2..)?.trim();
        is_known(unit).then(|| unit.to_string())
    })
}

/// `At which angle, in degrees, does it turn round?`
fn between_commas(text: &str) -> Option<String> {
    let mut parts = text.split(", ").skip(1);
    parts.find_map(|part| {
        let (unit, _) = BEFORE_UNIT
            .iter()
            .find_map(|word| part.strip_prefix(&format!("{word} ")).map(|unit| (unit, word)))?;
        let is_whole = !unit.contains(char::is_whitespace) && !unit.contains('?');
        (is_whole && is_known(unit)).then(|| unit.to_string())
    })
}

fn is_known(unit: &str) -> bool {
    is_unit(unit) || percentage(unit).is_some()
}

/// Whether two units measure the same dimension on different scales: metres per second and kilometres per hour.
pub(crate) fn differ_in_scale(one: &str, other: &str) -> bool {
    let [a, b] = [one, other].map(rendered);
    if let [Some(x), Some(y)] = [&a, &b].map(|unit| percentage(unit)) {
        return x != y;
    }
    let [Some(a), Some(b)] = [&a, &b].map(|unit| units::parse(unit)) else { return false };
    let ratio = (a.factor / b.factor).abs();
    a.agrees(&b) && a.has_angle() == b.has_angle() && ratio.is_finite() && (ratio - 1.0).abs() > 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_of_a_question_is_read_in_its_text() {
        for (text, unit) in [
            ("How fast is it, in km/h?", Some("km/h")),
            ("After how many milliseconds does it land?", Some("milliseconds")),
            ("By how many percent is it slower?", Some("percent")),
            ("How high does it rise (in cm)?", Some("cm")),
            ("How high does it rise [cm]", Some("cm")),
            ("Wie schnell ist es, in km/h?", Some("km/h")),
            ("What is its speed in $\\mathrm{m/s}$?", Some("m/s")),
            ("At which angle, in degrees, does it turn round?", Some("degrees")),
            ("How many bounces are there?", None),
            ("How often does it bounce in a run?", None),
            ("What happens in the end?", None),
            ("How fast is it?", None),
        ] {
            assert_eq!(asked_unit(text).as_deref(), unit, "{text}");
        }
    }

    #[test]
    fn units_of_one_dimension_may_differ_in_scale() {
        for (a, b, differ) in [
            ("ms", "s", true),
            ("km/h", "m/s", true),
            ("m/s", "m/s", false),
            ("m", "s", false),
            ("seconds", "s", false),
            ("deg", "rad", true),
        ] {
            assert_eq!(differ_in_scale(a, b), differ, "{a} {b}");
        }
    }
}
