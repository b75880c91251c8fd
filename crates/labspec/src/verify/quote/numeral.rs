//! Numerals: digits with their separators, decimals, fractions and powers of ten. The grammar is in `docs/quantities.md`.

use super::number::{NumberForm, Quoted, Style, ten};
use labspec_bind::units::is_wide;
use nom::branch::alt;
use nom::bytes::complete::{tag, tag_no_case, take_while, take_while_m_n};
use nom::character::complete::{anychar, char, digit0, digit1, one_of, satisfy};
use nom::combinator::{fail, map, map_opt, not, opt, value, verify};
use nom::error::Error;
use nom::multi::{fold_many_m_n, many0, many1};
use nom::sequence::{delimited, preceded, terminated};
use nom::{IResult, Parser};

/// A number with its position, in characters.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Numeral {
    pub(super) quoted: Quoted,
    /// First character, the sign included.
    pub(super) start: usize,
    /// Index after the last character.
    pub(super) end: usize,
    /// Other possible values.
    pub(super) ambiguities: Vec<f64>,
    /// The reason why it must not be reported as wrong, or must not be read.
    pub(super) is_ambiguous: Option<&'static str>,
    pub(super) refused: Option<&'static str>,
}

/// Why a number with one comma is ambiguous.
pub(super) const DECIMAL_COMMA: &str = "its comma may separate decimals or two numbers";

/// Maximum number of digits of a number; no computation has more.
const MAX_DIGITS: usize = 30;
/// Largest power of ten, so that printing does not overflow.
const MAX_EXPONENT: i32 = 290;

/// The value of a fraction character.
pub(super) fn fraction(c: char) -> Option<f64> {
    Some(match c {
        '½' => 0.5,
        '¼' => 0.25,
        '¾' => 0.75,
        '⅓' => 1.0 / 3.0,
        '⅔' => 2.0 / 3.0,
        '⅕' => 0.2,
        '⅖' => 0.4,
        '⅗' => 0.6,
        '⅘' => 0.8,
        '⅙' => 1.0 / 6.0,
        '⅚' => 5.0 / 6.0,
        '⅛' => 0.125,
        '⅜' => 0.375,
        '⅝' => 0.625,
        '⅞' => 0.875,
        _ => return None,
    })
}

/// The characters of a text.
#[derive(Clone, Copy)]
pub(super) struct Chars<'a>(pub(super) &'a [char]);

impl Chars<'_> {
    pub(super) fn at(&self, i: usize) -> Option<char> {
        self.0.get(i).copied()
    }

    pub(super) fn before(&self, i: usize) -> Option<char> {
        self.at(i.checked_sub(1)?)
    }

    pub(super) fn digit(&self, i: usize) -> bool {
        self.at(i).is_some_and(|c| c.is_ascii_digit())
    }

    /// The index after the spaces that begin at `i`. Text that is displayed separately is on another line.
    pub(super) fn skip_blanks(&self, mut i: usize) -> usize {
        while self.at(i) == Some(' ') {
            i += 1;
        }
        i
    }

    /// Whether this word begins at `i`.
    pub(super) fn has(&self, i: usize, word: &str) -> bool {
        word.chars().enumerate().all(|(k, c)| self.at(i + k).is_some_and(|x| x.eq_ignore_ascii_case(&c)))
    }

    /// The index after the digits that begin at `i`.
    pub(super) fn digits(&self, mut i: usize) -> usize {
        while self.digit(i) {
            i += 1;
        }
        i
    }

    pub(super) fn text(&self, from: usize, to: usize) -> String {
        self.0.get(from..to.min(self.0.len())).unwrap_or_default().iter().collect()
    }
}

/// The digits of a number as they are written.
#[derive(Default)]
struct Mantissa {
    /// All digits, with a point before the decimals; empty for a fraction character alone.
    digits: String,
    decimals: usize,
    /// The separator between groups of three digits.
    group: Option<char>,
    ambiguities: Vec<f64>,
    is_ambiguous: Option<&'static str>,
    refused: Option<&'static str>,
}

/// Exactly three digits after a separator.
fn group(text: &str, separator: char) -> IResult<&str, &str> {
    let three = take_while_m_n(3, 3, |c: char| c.is_ascii_digit());
    preceded(char(separator), terminated(three, not(digit))).parse(text)
}

/// Digits after a point or a comma.
fn decimals(text: &str, mark: char) -> IResult<&str, &str> {
    preceded(char(mark), digit1).parse(text)
}

fn digit(text: &str) -> IResult<&str, char> {
    satisfy(|c| c.is_ascii_digit()).parse(text)
}

fn spaces(text: &str) -> IResult<&str, &str> {
    take_while(|c| c == ' ').parse(text)
}

/// Digits in groups of three, and their separator.
fn whole(text: &str) -> IResult<&str, (Vec<&str>, Option<char>)> {
    let (rest, first) = digit0(text)?;
    let grouped = (1..=3).contains(&first.len()) && !first.starts_with('0');
    for separator in [',', ' ', '\''].into_iter().filter(|_| grouped) {
        if let Ok((rest, mut groups)) = many1(|text| group(text, separator)).parse(rest) {
            groups.insert(0, first);
            return Ok((rest, (groups, Some(separator))));
        }
    }
    Ok((rest, (vec![first], None)))
}

/// An integer, with decimals after a point or a comma.
fn mantissa(text: &str) -> IResult<&str, Mantissa> {
    let (rest, (groups, group)) = whole(text)?;
    let mut all = Mantissa { digits: groups.concat(), group, ..Mantissa::default() };
    if group == Some(' ') {
        all.ambiguities.extend(
            [groups.first(), groups.last()].into_iter().flatten().filter_map(|n| n.parse::<f64>().ok()),
        );
    }
    if let Ok((rest, after)) = decimals(rest, '.') {
        return Ok(all.with_decimals(rest, after));
    }
    if let Ok((rest, after)) = decimals(rest, ',') {
        // The comma is no thousands separator: it is a decimal comma, or separates a list.
        let again = decimals(rest, ',').is_ok() || decimals(rest, '.').is_ok();
        if group.is_some() || again {
            all.refused = Some("digits with several commas");
            return Ok((rest, all));
        }
        all.is_ambiguous = (all.digits != "0").then_some(DECIMAL_COMMA);
        all.decimals = after.len();
        all.digits = format!("{}.{after}", all.digits);
        return Ok((rest, all));
    }
    if let (Some(','), [first, second]) = (group, groups.as_slice()) {
        // 1,500: a thousands separator in English, a decimal comma in other languages.
        all.ambiguities.extend(format!("{first}.{second}").parse::<f64>());
    }
    Ok((rest, all))
}

impl Mantissa {
    /// Adds decimals, which may be in groups of three: 0.000 833.
    fn with_decimals<'t>(mut self, rest: &'t str, after: &str) -> (&'t str, Mantissa) {
        self.digits = format!("{}.{after}", self.digits);
        self.decimals = after.len();
        let groups =
            many0(|text| group(text, ' ')).parse(rest).ok().filter(|_| after.len().is_multiple_of(3));
        let (rest, groups) = groups.unwrap_or((rest, Vec::new()));
        for group in groups {
            if self.digits.len() <= MAX_DIGITS {
                self.ambiguities.extend(self.digits.parse::<f64>());
            }
            self.digits += group;
            self.decimals += group.len();
        }
        if decimals(rest, '.').is_ok() {
            self.refused = Some("digits with several points");
        } else if decimals(rest, ',').is_ok() {
            self.refused = Some("digits with a comma after a point");
        }
        (rest, self)
    }
}

/// A signed integer of at most eight digits.
fn integer(text: &str) -> IResult<&str, i32> {
    let sign = alt((value(-1, one_of("-–")), value(1, char('+'))));
    let digits = terminated(take_while_m_n(1, 8, |c: char| c.is_ascii_digit()), not(digit));
    map((opt(sign), map_opt(digits, |n: &str| n.parse::<i32>().ok())), |(sign, n)| sign.unwrap_or(1) * n)
        .parse(text)
}

/// A power of ten in figures, and whether it is written out: `e3`, `×10^3`.
fn power(text: &str) -> IResult<&str, (i32, bool)> {
    let letter = (opt(char(' ')), one_of("eE"));
    let base = (spaces, one_of("×·*xX"), spaces, tag("10"), alt((tag("**"), tag("^"))));
    alt((
        map(delimited(letter, integer, not(satisfy(char::is_alphanumeric))), |n| (n, false)),
        map(preceded(base, integer), |n| (n, true)),
    ))
    .parse(text)
}

/// Words for powers of ten.
const FACTORS: [(&str, i32); 11] = [
    ("hundred hundert", 2),
    ("thousand tausend mille mil", 3),
    ("万 萬", 4),
    ("million millions Millionen 百万", 6),
    ("千万", 7),
    ("億 亿", 8),
    ("billion Milliarden milliards", 9),
    ("trillion", 12),
    ("hundredth hundredths", -2),
    ("thousandth thousandths", -3),
    ("millionth millionths", -6),
];

/// A word for a power of ten.
fn factor(text: &str) -> IResult<&str, i32> {
    let (word_start, blanks) = spaces(text)?;
    let behind = |word: &str| {
        let (rest, _) = tag_no_case::<_, _, Error<&str>>(word).parse(word_start).ok()?;
        let whole = !blanks.is_empty() && !rest.starts_with(char::is_alphanumeric);
        (whole || word.chars().all(is_wide)).then_some(rest)
    };
    let found = FACTORS.iter().find_map(|(words, n)| Some((words.split(' ').find_map(behind)?, *n)));
    found.map_or_else(|| fail().parse(text), Ok)
}

/// The scale after the digits of a number, or in place of them: a fraction (`2½`, `½`), or a power of ten.
enum NumeralScale {
    Fraction(f64),
    /// Its exponent, and whether it is written out.
    Power(i32, bool),
    /// A power whose base is the digits: `10^3`, with its exponent.
    PowerOfDigits(i32),
}

fn scale<'t>(text: &'t str, mantissa: &Mantissa) -> IResult<&'t str, NumeralScale> {
    let is_whole = mantissa.decimals == 0 && mantissa.group.is_none() && mantissa.refused.is_none();
    let alone = mantissa.digits.is_empty();
    let blanks = verify(spaces, |blanks: &str| blanks.is_empty() || !alone);
    alt((
        map(verify(preceded(blanks, map_opt(anychar, fraction)), |_| is_whole), NumeralScale::Fraction),
        map(power, |(n, written)| NumeralScale::Power(n, written)),
        map(verify(preceded(char('^'), integer), |_| mantissa.digits == "10"), NumeralScale::PowerOfDigits),
    ))
    .parse(text)
}

/// Reads the number at the beginning of a text, including a point or a fraction but not its sign. Returns the number of
/// bytes read.
fn numeral(text: &str, negative: bool) -> (Numeral, usize) {
    let (rest, mut written) = mantissa(text).unwrap_or((text, Mantissa::default()));
    let (rest, scale) = opt(|text| scale(text, &written)).parse(rest).unwrap_or((rest, None));
    let factors = fold_many_m_n(1, 3, factor, || 0, |all, n| all + n).parse(rest).ok();
    let (rest, factor) = factors.map_or((rest, None), |(rest, n)| (rest, Some(n)));
    let (mut extra, mut exponent, mut times) = (None, 0, factor.is_some());
    match scale {
        Some(NumeralScale::Fraction(x)) => (extra, written.decimals) = (Some(x), 2),
        Some(NumeralScale::Power(n, written_out)) => (exponent, times) = (n, times || written_out),
        Some(NumeralScale::PowerOfDigits(n)) => (written.digits, exponent, times) = ("1".into(), n, true),
        None => {}
    }
    match (factor, extra) {
        (Some(_), Some(_)) => written.refused = Some("a fraction of a word for a power of ten"),
        (n, _) => exponent += n.unwrap_or(0),
    }
    if factor.is_some() {
        written.ambiguities.clear();
    }
    let count = written.digits.bytes().filter(u8::is_ascii_digit).count();
    if count > MAX_DIGITS || exponent.abs() > MAX_EXPONENT {
        written.refused = Some("a number with more digits than a computation has");
        (exponent, written.decimals) = (0, 0);
    }
    let Mantissa { digits, decimals, group, mut ambiguities, is_ambiguous, refused } = written;
    let sign = if negative { -1.0 } else { 1.0 };
    let digits = if digits.is_empty() { "0" } else { &digits };
    let value = format!("{digits}e{exponent}").parse::<f64>().unwrap_or(f64::NAN) + extra.unwrap_or(0.0);
    let half_unit = 0.5 * ten(exponent.saturating_sub(decimals as i32));
    ambiguities.iter_mut().for_each(|x| *x *= sign);
    let form = if extra.is_some() { NumberForm::Fraction } else { NumberForm::Plain(Style { group, times }) };
    let quoted = Quoted { value: sign * value, half_unit, decimals, exponent, form };
    (Numeral { quoted, start: 0, end: 0, ambiguities, is_ambiguous, refused }, text.len() - rest.len())
}

/// All numbers of a text, each with the index of its first digit. Digits in words, indexes and exponents (`H2O`, `x_1`,
/// `L^2`, `3D`, `2nd`) are skipped.
pub(super) fn numbers(chars: Chars<'_>) -> Vec<(Numeral, usize)> {
    let text = chars.text(0, chars.0.len());
    let bytes: Vec<usize> = text.char_indices().map(|(offset, _)| offset).collect();
    let mut all: Vec<(Numeral, usize)> = Vec::new();
    let mut i = 0;
    while let Some(c) = chars.at(i) {
        let point = c == '.' && chars.digit(i + 1) && chars.before(i) != Some('.');
        if !(c.is_ascii_digit() || point || fraction(c).is_some()) {
            i += 1;
            continue;
        }
        let sign = chars.before(i).filter(|c| matches!(c, '-' | '–' | '+'));
        let word = |c: char| c.is_alphabetic() && !is_wide(c) || matches!(c, '_' | '^' | '#');
        let front = i - usize::from(sign.is_some());
        if chars.before(front).is_some_and(word) {
            let part = |c: char| c.is_alphanumeric() && !is_wide(c) || matches!(c, '_' | '^' | '.');
            while chars.at(i).is_some_and(part) {
                i += 1;
            }
            continue;
        }
        let adjacent = chars.before(front).is_some_and(|c| c.is_ascii_digit() || c == ')');
        let mut negative = matches!(sign, Some('-' | '–')) && !adjacent;
        let mut start = if adjacent { i } else { front };
        // A sign separated by a space: `= - 0.5`, `-\,0.5`.
        if sign.is_none() && chars.before(i) == Some(' ') && matches!(chars.before(i - 1), Some('-' | '–'))
        {
            let edge = i.saturating_sub(2);
            let opens = |c: char| matches!(c, '=' | '≈' | '(' | ':' | '\n');
            let before = (0..edge).rev().find_map(|k| chars.at(k).filter(|c| *c != ' '));
            if before.is_none_or(opens) {
                (negative, start) = (true, edge);
            }
        }
        let tail = bytes.get(i).and_then(|offset| text.get(*offset..)).unwrap_or("");
        let (found, length) = numeral(tail, negative);
        let end = i + tail.get(..length).map_or(0, |number| number.chars().count());
        let found = Numeral { start, end, ..found };
        let next = end.max(i + 1);
        if !is_word(chars, &found, i) {
            all.push((found, i));
        }
        i = next;
    }
    all
}

/// Whether the digits are an ordinal or a name and not a measurement: `2nd`, `3D`.
fn is_word(chars: Chars<'_>, number: &Numeral, first_digit: usize) -> bool {
    let whole = (first_digit..number.end).all(|i| chars.digit(i));
    let letters: String =
        (number.end..).map_while(|i| chars.at(i)).take_while(|c| c.is_alphabetic()).take(3).collect();
    whole && matches!(letters.as_str(), "st" | "nd" | "rd" | "th" | "D")
}
