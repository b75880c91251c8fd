//! Numbers quoted in the text, compared at the precision that they are printed with.

use crate::bind::scene::finding;
use crate::bind::warning;
use crate::finding::Finding;
use crate::source::Text;
use crate::spec::{Lesson, Question, Said};
use std::ops::Range;

/// A number as it is printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quoted {
    /// Its value.
    pub value: f64,
    /// Half a unit of its last digit.
    pub half_unit: f64,
    /// Decimals of the mantissa, and exponent.
    pub decimals: usize,
    /// The power of ten, 0 without an exponent.
    pub exponent: i32,
}

impl Quoted {
    /// Whether a number prints as this one.
    pub fn is(&self, x: f64) -> bool {
        // A value half way may be rounded either way; its own rounding error must not decide.
        (x - self.value).abs() <= self.half_unit * (1.0 + 1e-6) + 1e-12 * self.value.abs()
    }

    /// Another number, printed with the same precision.
    pub fn print(&self, x: f64) -> String {
        if self.exponent == 0 {
            format!("{x:.*}", self.decimals)
        } else {
            format!("{:.*}e{}", self.decimals, x / 10f64.powi(self.exponent), self.exponent)
        }
    }
}

/// The first number in a text: sign, digits, decimals, exponent. The minus sign may be typographic.
pub fn quoted(text: &str) -> Option<Quoted> {
    let chars: Vec<char> = text.chars().collect();
    let start = chars.iter().position(char::is_ascii_digit)?;
    let digit = |i: usize| chars.get(i).is_some_and(char::is_ascii_digit);
    // `.5` is a number too.
    let from = if start > 0 && chars[start - 1] == '.' { start - 1 } else { start };
    let negative = from > 0 && matches!(chars[from - 1], '-' | '\u{2212}' | '\u{2013}');
    let (mut mantissa, mut decimals, mut i) = (String::new(), 0, from);
    while digit(i) {
        mantissa.push(chars[i]);
        i += 1;
    }
    if chars.get(i) == Some(&'.') && digit(i + 1) {
        mantissa.push('.');
        i += 1;
        while digit(i) {
            mantissa.push(chars[i]);
            decimals += 1;
            i += 1;
        }
    }
    let mut exponent = 0;
    if matches!(chars.get(i), Some('e' | 'E')) {
        let sign = usize::from(matches!(chars.get(i + 1), Some('-' | '+')));
        let digits: String =
            chars.iter().skip(i + 1 + sign).take_while(|c| c.is_ascii_digit()).take(4).collect();
        if let Ok(e) = digits.parse::<i32>() {
            exponent = if chars.get(i + 1) == Some(&'-') { -e } else { e };
        }
    }
    let value: f64 = format!("{}{mantissa}e{exponent}", if negative { "-" } else { "" }).parse().ok()?;
    let half_unit = 0.5 * 10f64.powi(exponent.saturating_sub(decimals as i32));
    Some(Quoted { value, half_unit, decimals, exponent })
}

/// The value of the same expression under other numerics.
#[derive(Clone, Debug, PartialEq)]
pub struct Other {
    /// Which, in words: `at half the timestep`.
    pub how: &'static str,
    /// The value.
    pub value: f64,
}

/// What became of a quote.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuoteState {
    /// It is what the simulation gives.
    Right,
    /// It is not.
    Wrong,
    /// It could not be checked.
    Unclear,
}

/// A quote that was compared.
#[derive(Clone, Debug, PartialEq)]
pub struct QuoteOutcome {
    /// What became of it.
    pub state: QuoteState,
    /// Why it is not right.
    pub reason: String,
    /// The number that was read.
    pub read: Option<Quoted>,
    /// What the simulation gives.
    pub computed: f64,
    /// Where the text says it.
    pub places: Vec<Range<usize>>,
    /// Other values whose printed digits differ.
    pub moved: Vec<(&'static str, String)>,
}

pub(super) fn check(
    said: &Said,
    computed: f64,
    _: &[Other],
    _: &[Other],
    question: Option<&Question>,
    lesson: &Lesson,
    findings: &mut Vec<Finding>,
) -> QuoteOutcome {
    let before = findings.len();
    let right = check_old(said, computed, question, lesson, findings);
    let state = if right { QuoteState::Right } else { QuoteState::Wrong };
    let reason = findings.get(before).map_or(String::new(), |f| f.message.clone());
    QuoteOutcome { state, reason, read: None, computed, places: Vec::new(), moved: Vec::new() }
}

/// Compares a quoted number with what the simulation gives, and looks for it in the text. `false` when it is
/// wrong.
fn check_old(
    said: &Said,
    computed: f64,
    question: Option<&Question>,
    lesson: &Lesson,
    findings: &mut Vec<Finding>,
) -> bool {
    let Some(quoted) = quoted(&said.quote.value) else {
        findings.push(
            finding("quote-without-number", said.quote.span(), "there is no number in this quote")
                .help("quote the number as the text prints it, such as \"0.442 s\""),
        );
        return false;
    };
    let place = find(&said.quote, question, lesson);
    if place.is_none() {
        findings.push(
            warning("quote-not-found", said.quote.span(), format!("the lesson does not say \"{}\" anywhere", said.quote.value))
                .why("the check is about a number that no reader sees; the text was changed, or says it in other words")
                .help("quote the text to the letter, spaces and unit included, or remove this line"),
        );
    }
    if quoted.is(computed) {
        return true;
    }
    let right = quoted.print(computed);
    findings.push(
        finding(
            "quote-wrong",
            place.unwrap_or(said.quote.span()),
            format!("the text says {}, the simulation gives {right}", said.quote.value),
        )
        .why("a reader who measures it finds another number")
        .help(format!("write {right}, or correct the expression that it is compared with"))
        .related(said.expr.span(), format!("this is {}", super::significant(computed))),
    );
    false
}

/// Where the text says it: in the question itself, else anywhere in the lesson outside of `verify` objects.
fn find(quote: &Text, question: Option<&Question>, lesson: &Lesson) -> Option<Range<usize>> {
    let wanted = quote.value.as_str();
    let in_question = question.iter().flat_map(|q| q.html()).find_map(|text| {
        let at = position(&text.value, wanted)?;
        Some(text.span_of(at..at + wanted.len()))
    });
    in_question.or_else(|| {
        let file = lesson.file.text();
        let hidden = verify_spans(lesson);
        let mut from = 0;
        while let Some(at) = file.get(from..).and_then(|rest| position(rest, wanted)) {
            let span = from + at..from + at + wanted.len();
            if !hidden.iter().any(|h| h.start <= span.start && span.end <= h.end) {
                return Some(span);
            }
            from = span.end;
        }
        None
    })
}

/// Where `wanted` stands as a number of its own: `0.44` is not said by `0.442`, nor `1.5` by `21.5`.
fn position(text: &str, wanted: &str) -> Option<usize> {
    let numeric = |c: char| c.is_ascii_digit() || c == '.';
    text.match_indices(wanted).map(|(i, _)| i).find(|&i| {
        let before = text[..i].chars().next_back();
        let mut after = text[i + wanted.len()..].chars();
        let (next, second) = (after.next(), after.next());
        let starts = !(wanted.starts_with(numeric) && before.is_some_and(numeric));
        let goes_on = next.is_some_and(|c| c.is_ascii_digit())
            || (next == Some('.') && second.is_some_and(|c| c.is_ascii_digit()));
        starts && !(wanted.ends_with(numeric) && goes_on)
    })
}

fn verify_spans(lesson: &Lesson) -> Vec<Range<usize>> {
    let labs = lesson.all_labs().into_iter().filter_map(|l| l.verify.as_ref());
    let questions = lesson.quizzes.iter().flat_map(|q| q.numbered()).filter_map(|(_, q)| q.verify.as_ref());
    labs.chain(questions).map(|v| v.span.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_printed() {
        let q = |t: &str| quoted(t).map(|q| (q.value, q.half_unit));
        assert_eq!(q("0.442 s"), Some((0.442, 0.5e-3)));
        assert_eq!(q("about 29 mm"), Some((29.0, 0.5)));
        assert_eq!(q("-14.7150"), Some((-14.715, 0.5e-4)));
        assert_eq!(q("\u{2212}1.5"), Some((-1.5, 0.05)));
        assert_eq!(q("5e4 rad"), Some((5e4, 5e3)));
        assert_eq!(q("3.0e-7"), Some((3e-7, 0.5e-8)));
        assert_eq!(q(".5 m"), Some((0.5, 0.05)));
        assert_eq!(q("2 e"), Some((2.0, 0.5)));
        assert_eq!(q("none"), None);
        assert!(q("1e99999").is_some());
    }

    #[test]
    fn precision_is_that_of_the_print() {
        let q = quoted("0.442 s").unwrap();
        assert!(q.is(0.4424) && q.is(0.4415) && !q.is(0.4426) && !q.is(f64::NAN));
        assert_eq!(q.print(0.46), "0.460");
        assert_eq!(quoted("3.0e-7").unwrap().print(4.44e-7), "4.4e-7");
        // 12.2625 is half way between two prints of three decimals.
        assert!(quoted("12.263").unwrap().is(12.2625) && quoted("12.262").unwrap().is(12.2625));
    }

    #[test]
    fn a_quote_is_a_number_of_its_own() {
        assert_eq!(position("at 0.442 s", "0.44"), None);
        assert_eq!(position("at 0.44.", "0.44"), Some(3));
        assert_eq!(position("21.5 and 1.5", "1.5"), Some(9));
        assert_eq!(position("x -0.7357 y", "-0.7357"), Some(2));
    }
}
