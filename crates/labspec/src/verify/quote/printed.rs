//! Numbers of the text that a displayed output has.
//!
//! A number is claimed by an output only if a coincidence is unlikely: it has two significant digits and the unit of the printed
//! number, or three if the output prints no unit. Another unit of the same dimension is converted: `0.45 s` is `450 ms`. It must
//! be a rounding of the printed number, and not a value halfway, because the displayed number may be rounded itself.

use super::fold;
use super::number::{NumberForm, Quoted};
use super::numeral::Chars;
use super::quantity::{Quantity, separate_quantities};
use super::stated::{Stated, counted};
use super::unit_text::Link;
use crate::spec::Lesson;
use labspec_expr::dimension::Dimension;
use std::ops::Range;

/// A displayed output.
#[derive(Clone, Debug)]
pub struct OutputBlock<'l> {
    /// Its bytes in the file.
    pub span: Range<usize>,
    /// Its text, or `None` for a table, whose cells are numbers of the lesson.
    pub text: Option<&'l str>,
}

/// A number of the text that an output has.
#[derive(Clone, Debug)]
pub struct OutputMatch {
    /// The index of the first such output.
    pub output: usize,
    /// The number.
    pub number: Stated,
    /// Whether it is a part of the displayed output itself.
    pub is_displayed: bool,
}

/// A number of an output.
struct OutputNumber {
    /// The index of the output.
    output: usize,
    quoted: Quoted,
    /// The dimension of its unit, or `None` without a unit.
    dimension: Option<Dimension>,
}

/// The maximum length of a line of an output that is read, in bytes.
const MAX_LINE: usize = 2000;
/// The maximum number of numbers of all outputs of a lesson that are compared.
const MAX_PRINTED: usize = 5000;
/// The maximum length of a lesson that is searched, in bytes.
const MAX_LESSON: usize = 2 << 20;
/// The minimum number of significant digits of a number whose unit the output prints, and of one whose unit it does not print.
const MIN_DIGITS: [usize; 2] = [2, 3];

/// The unclaimed numbers of the text, outside of labs and quizzes, that one of the outputs has.
pub fn numbers_in_outputs(lesson: &Lesson, outputs: &[OutputBlock<'_>]) -> Vec<OutputMatch> {
    if outputs.is_empty() || lesson.file.text().len() > MAX_LESSON {
        return Vec::new();
    }
    let blocks = lesson.labs.iter().map(|lab| &lab.span).chain(lesson.quizzes.iter().map(|quiz| &quiz.span));
    let blocks: Vec<&Range<usize>> = blocks.collect();
    let is_text = |s: &Stated| !s.answer && !blocks.iter().any(|block| contains(block, &s.span));
    let stated: Vec<Stated> = counted(lesson).left.into_iter().filter(is_text).collect();
    let cell_of = |s: &Stated| outputs.iter().position(|output| contains(&output.span, &s.span));
    let mut printed: Vec<OutputNumber> = Vec::new();
    for (output, block) in outputs.iter().enumerate() {
        match block.text {
            Some(text) => add_numbers(output, text, &mut printed),
            None => printed.extend(
                stated.iter().filter(|s| contains(&block.span, &s.span)).map(|s| OutputNumber {
                    output,
                    quoted: s.read,
                    dimension: Some(s.dimension),
                }),
            ),
        }
        printed.truncate(MAX_PRINTED);
    }
    let find = |number: Stated| {
        // What is displayed was compared itself.
        let displayed = cell_of(&number);
        let equal = || printed.iter().find(|n| is_claimed_by(lesson, &number, n)).map(|n| n.output);
        Some(OutputMatch { output: displayed.or_else(equal)?, is_displayed: displayed.is_some(), number })
    };
    stated.iter().cloned().filter_map(find).collect()
}

fn contains(outer: &Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

/// Adds the numbers of a displayed text. Numbers with an unknown unit, and parts of other expressions, are omitted.
fn add_numbers(output: usize, text: &str, all: &mut Vec<OutputNumber>) {
    let lines = text.lines().filter(|line| line.len() <= MAX_LINE);
    // Columns are separated by wide gaps, tabs or bars.
    let cells = lines.flat_map(|line| line.split("  ").flat_map(|part| part.split(['\t', '|'])));
    for cell in cells.map(str::trim).filter(|cell| cell.contains(|c: char| c.is_ascii_digit())) {
        if all.len() >= MAX_PRINTED {
            return;
        }
        let (folded, _) = fold::fold(cell, false);
        let chars: Vec<char> = folded.chars().collect();
        let chars = Chars(&chars);
        for q in separate_quantities(chars) {
            // `1 960` may be two numbers.
            let has_gap = matches!(q.quoted.form, NumberForm::Plain(style) if style.group.is_some_and(char::is_whitespace));
            let is_certain = q.refused.is_none()
                && q.ambiguities.is_empty()
                && q.is_ambiguous.is_none()
                && !(q.change || has_gap);
            if let Some(dimension) = printed_dimension(chars, &q).filter(|_| is_certain) {
                all.push(OutputNumber { output, quoted: q.quoted, dimension });
            }
        }
    }
}

/// The dimension of the unit directly after a printed number: `Some(None)` without a unit, `None` if the unit is unknown.
fn printed_dimension(chars: Chars<'_>, q: &Quantity) -> Option<Option<Dimension>> {
    match q.unit.as_ref().filter(|unit| unit.link == Link::Direct) {
        Some(unit) if unit.is_counted() => None,
        Some(unit) => unit.dimension.map(Some),
        None => {
            let after = chars.text(q.number_end, q.number_end + 2);
            let mut after = after.chars();
            // What follows the number at once or after one space may be a unit.
            let next = match after.next() {
                Some(' ') => after.next(),
                next => next,
            };
            let is_word = |c: char| c.is_alphabetic() || matches!(c, '%' | '‰' | '°' | '/' | '*' | '^');
            (!next.is_some_and(is_word)).then_some(None)
        }
    }
}

/// Whether a number of the text is the printed one in its unit, rounded.
fn is_claimed_by(lesson: &Lesson, s: &Stated, number: &OutputNumber) -> bool {
    let (read, printed) = (&s.read, &number.quoted);
    let (factor, digits) = match &number.dimension {
        Some(dimension) => match factor_between(dimension, &s.dimension) {
            Some(factor) => (factor, MIN_DIGITS[0]),
            None => return false,
        },
        None => (1.0, MIN_DIGITS[1]),
    };
    // Shares are fractions of one, whatever their unit.
    let (is_same_form, factor) = match (read.form, printed.form) {
        // `1,500` is 1.5 in some languages.
        (NumberForm::Plain(style), NumberForm::Plain(_)) => {
            (style.group != Some(',') || lesson.conventions.languages.decimal_comma() == Some(false), factor)
        }
        (NumberForm::Share, NumberForm::Share) => (true, 1.0),
        _ => (false, factor),
    };
    let (value, half_unit) = (printed.value * factor, printed.half_unit * factor * (1.0 - 1e-6));
    let difference = (read.value - value).abs();
    let zeros = 10f64.powi(insignificant_zeros(read));
    let is_equal =
        difference <= 1e-9 * read.half_unit + 1e-12 * value.abs() && half_unit <= read.half_unit * zeros;
    let is_rounded = difference < read.half_unit * (1.0 - 1e-6) && half_unit <= read.half_unit;
    is_same_form && significant_digits(read) >= digits && (is_equal || is_rounded)
}

/// The factor that converts a number from a unit to another one; `None` if they measure different quantities. An angle is not
/// omitted: 1 Hz is not 1 rad/s.
fn factor_between(from: &Dimension, to: &Dimension) -> Option<f64> {
    let factor = to.factor / from.factor;
    let is_same_quantity = from.agrees(to) && from.angle() == to.angle();
    (is_same_quantity && factor.is_finite() && factor > 0.0).then_some(factor)
}

/// The digits of a number without the point.
fn digits_of(number: &Quoted) -> String {
    let units = (number.value.abs() / (2.0 * number.half_unit)).round();
    if (1.0..1e18).contains(&units) { format!("{units:.0}") } else { String::new() }
}

/// The number of zeros at the end of a whole number: `500` has two. They are not significant.
fn insignificant_zeros(number: &Quoted) -> i32 {
    let digits = digits_of(number);
    match number.decimals == 0 && number.exponent == 0 {
        true => (digits.len() - digits.trim_end_matches('0').len()) as i32,
        false => 0,
    }
}

/// The number of significant digits: `500` has one digit.
fn significant_digits(number: &Quoted) -> usize {
    digits_of(number).len() - insignificant_zeros(number) as usize
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use crate::source::SourceFile;
    use crate::spec::read_lesson;

    /// The numbers of a text that an output has.
    fn claimed_by(output: &str, text: &str) -> Vec<String> {
        let lesson = read_lesson(SourceFile::new("a.md", text));
        let outputs = [OutputBlock { span: text.len()..text.len(), text: Some(output) }];
        numbers_in_outputs(&lesson, &outputs).into_iter().map(|m| m.number.quote).collect()
    }

    const OUTPUT: &str = "t = 0.4401 s, v = 4.317 m/s\nmu = 3.9857E+14 m^3/s^2\nlost 94.2%, E = -2.943e+07 J/kg\n1   960.0   0.5530\nn = 12 balls\n0.445 kg\n254.95 K +/- 0.13 K";

    #[test]
    fn roundings_with_the_same_unit_are_claimed() {
        let text = "# After 0.44 s\n\nIt lands after 0.4401 s at 4.3 m/s, and 94.2 % or 94 % is lost.\n\nThe parameter is $3.99 \\times 10^{14}$ m^3/s^2 and the energy -2.94e7 J/kg. It takes 0.553 s.\n";
        let expected = [
            "0.44 s",
            "0.4401 s",
            "4.3 m/s",
            "94.2 %",
            "94 %",
            "3.99×10^14 m^3/s^2",
            "-2.94e7 J/kg",
            "0.553 s",
        ];
        assert_eq!(claimed_by(OUTPUT, text), expected);
    }

    #[test]
    fn other_numbers_are_not_claimed() {
        for wrong in [
            "0.45 s",         // another number
            "0.44010 s",      // more digits than printed
            "0.4 s",          // one digit
            "0.44 m",         // another unit
            "4.317 m",        // another unit
            "0.55 s",         // two digits, and the output prints no unit
            "960 m",          // the same
            "12 kg",          // the output counts balls
            "0.44 kg",        // halfway: the displayed number may be rounded
            "0.45 kg",        // the same
            "0.13 K",         // an uncertainty
            "2.943e7 J/kg",   // another sign
            "1960 m",         // two columns
            "0.44 to 0.50 s", // a range
        ] {
            assert_eq!(claimed_by(OUTPUT, &format!("It is {wrong}.\n")), [""; 0], "{wrong}");
        }
    }

    /// Each text with a number in another unit than the output, and changes of a digit, of the precision, or of the unit.
    #[test]
    fn units_are_converted() {
        let cases: [(&str, &str, &[&str]); 15] = [
            ("0.45 s", "450 ms", &["451 ms", "440 ms", "550 ms", "450 μs", "450.0 ms", "450 mm"]),
            ("0.4401 s", "440.1 ms", &["440.2 ms", "441.1 ms", "540.1 ms", "440.10 ms"]),
            ("0.4401 s", "440 ms", &["441 ms", "430 ms"]),
            ("450 ms", "0.450 s", &["0.451 s", "0.4500 s", "0.460 s"]),
            ("450 ms", "0.45 s", &["0.46 s", "0.5 s"]),
            ("0.83 mm", "8.3e-4 m", &["8.4e-4 m", "8.3e-3 m"]),
            ("4.317 m/s", "15.54 km/h", &["15.55 km/h", "15.53 km/h", "15.541 km/h"]),
            ("0.785 rad", "45.0°", &["45.1°", "44.9°", "44.98 °"]),
            ("12.5 N m", "12.5 J", &["12.6 J"]),
            ("5400 s", "1.5 h", &["1.6 h", "15 h"]),
            ("0.445 kg", "445 g", &["446 g", "44 g", "445 mg"]),
            ("2.5e3 Pa", "2.5 kPa", &["2.4 kPa", "2.50 kPa"]),
            ("94.2%", "942 ‰", &["943 ‰", "94.2 ‰"]),
            ("30.0 rpm", "3.1 rad/s", &["3.2 rad/s", "3.14 rad/s"]),
            ("2.54 s^-1", "2.54 Hz", &["2.54 rad/s", "2.55 Hz"]),
        ];
        for (output, right, wrong) in cases {
            assert_eq!(claimed_by(output, &format!("It is {right}.\n")), [right], "{output}");
            for wrong in wrong {
                assert_eq!(claimed_by(output, &format!("It is {wrong}.\n")), [""; 0], "{output}: {wrong}");
            }
        }
    }

    #[test]
    fn the_cells_of_a_displayed_table_are_claimed_with_their_unit() {
        let text = "It is 1.47 mm, not 2.95 mm or 1.47 s.\n\n| h (s) | error (mm) |\n|---|---|\n| 0.001 | 1.4715 |\n| 0.002 | 2.9430 |\n";
        let lesson = read_lesson(SourceFile::new("a.md", text));
        let outputs = [OutputBlock { span: text.find('|').unwrap()..text.len(), text: None }];
        let found: Vec<String> =
            numbers_in_outputs(&lesson, &outputs).into_iter().map(|m| m.number.quote).collect();
        assert_eq!(found, ["1.47 mm", "0.001", "1.4715", "0.002", "2.9430"]);
    }

    #[test]
    fn digits_are_counted() {
        let digits = |text: &str| significant_digits(&super::super::read::quoted(text).unwrap());
        for (text, n) in [
            ("0.044", 2),
            ("500", 1),
            ("510", 2),
            ("5.0", 2),
            ("5e3", 1),
            ("5.00e-3", 3),
            ("0.0", 0),
            ("007", 1),
        ] {
            assert_eq!(digits(text), n, "{text}");
        }
    }
}
