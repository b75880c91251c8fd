//! Numbers of the text that a displayed output has.
//!
//! A number is claimed by an output only if a coincidence is unlikely: it has two significant digits and the unit of the printed
//! number, or three if the output prints no unit. It must be a rounding of the printed number, and not a value halfway, because
//! the displayed number may be rounded itself.

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

/// Whether a number of the text is the printed one, rounded, with the same unit.
fn is_claimed_by(lesson: &Lesson, s: &Stated, number: &OutputNumber) -> bool {
    let (read, printed) = (&s.read, &number.quoted);
    let digits = match number.dimension {
        Some(dimension) if dimension == s.dimension => MIN_DIGITS[0],
        Some(_) => return false,
        None => MIN_DIGITS[1],
    };
    let is_same_form = match (read.form, printed.form) {
        (NumberForm::Plain(style), NumberForm::Plain(_)) => {
            // `1,500` is 1.5 in some languages.
            style.group != Some(',') || lesson.conventions.languages.decimal_comma() == Some(false)
        }
        (NumberForm::Share, NumberForm::Share) => true,
        _ => false,
    };
    let difference = (read.value - printed.value).abs();
    let is_equal = difference <= 1e-9 * read.half_unit;
    let is_rounded = difference < read.half_unit * (1.0 - 1e-6);
    is_same_form
        && significant_digits(read) >= digits
        && printed.half_unit <= read.half_unit * (1.0 + 1e-6)
        && (is_equal || is_rounded)
}

/// The number of significant digits. Zeros at the end of a whole number are not significant: `500` has one digit.
fn significant_digits(number: &Quoted) -> usize {
    let units = (number.value.abs() / (2.0 * number.half_unit)).round();
    if !(1.0..1e18).contains(&units) {
        return 0;
    }
    let digits = format!("{units:.0}");
    match number.decimals == 0 && number.exponent == 0 {
        true => digits.trim_end_matches('0').len(),
        false => digits.len(),
    }
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
