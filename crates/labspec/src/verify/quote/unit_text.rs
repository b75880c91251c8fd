//! Reads the unit after a number.

use super::numeral::Chars;
use crate::language::Languages;
use labspec_bind::units;
use labspec_expr::dimension::Dimension;
use nom::branch::alt;
use nom::bytes::complete::{tag, tag_no_case, take_while1};
use nom::character::complete::{char, satisfy};
use nom::combinator::{consumed, fail, map, not, opt, peek, recognize, value, verify};
use nom::error::Error;
use nom::sequence::{preceded, terminated};
use nom::{IResult, Parser};

/// A unit as written.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) struct Unit {
    /// Its text, with single spaces.
    pub(in crate::verify) text: String,
    /// Its dimension; `None` where that is unknown: `mm per step`, `dB`.
    pub(in crate::verify) dimension: Option<Dimension>,
    /// How it is linked to its number.
    pub(in crate::verify) link: Link,
}

/// How a unit is linked to a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::verify) enum Link {
    /// It directly follows the number.
    Direct,
    /// It follows a later number, or is in the heading of the column.
    Shared,
    /// It is elsewhere in the clause of the number, and may belong to another quantity.
    Clause,
}

/// The power of ten that converts a number in this unit to a fraction of one: -2 for a percentage.
pub(super) fn share(unit: &str) -> Option<i32> {
    match unit {
        "%" | "percent" | "per cent" | "pct" | "Prozent" => Some(-2),
        "‰" | "per mille" | "permille" => Some(-3),
        _ => None,
    }
}

impl Unit {
    /// The power of ten that converts it to a fraction of one: -2 for a percentage.
    pub(super) fn share(&self) -> Option<i32> {
        share(&self.text)
    }

    /// The factor that converts a percentage to a fraction of one; `None` for other units.
    pub(in crate::verify) fn percentage(&self) -> Option<f64> {
        self.share().map(|power| 10f64.powi(power))
    }

    /// The unit of a ratio to one: `2.45 : 1`.
    pub(super) fn ratio() -> Unit {
        Unit { text: RATIO.to_string(), dimension: Some(Dimension::NUMBER), link: Link::Direct }
    }

    /// Whether it follows its number or is shared with another one, and is not a name of counted things.
    pub(super) fn is_own(&self) -> bool {
        let is_multiple = multiple(&self.text).is_ok() || factor_suffix(&self.text).is_ok();
        self.link != Link::Clause && !self.is_counted() && !is_multiple && self.text != RATIO
    }

    /// Whether it is a name of counted things: `steps`, `bounces`.
    pub(super) fn is_counted(&self) -> bool {
        is_counted(&self.text)
    }

    /// Whether it may also be a symbol of a formula: `2 h` means two hours or two timesteps.
    pub(super) fn is_doubtful(&self) -> bool {
        phrase_rate(&self.text).is_ok()
            || matches!(self.text.as_str(), "A" | "C" | "K" | "L" | "V" | "T" | "g" | "h" | "l")
    }
}

/// The text of the unit of a ratio, for messages.
const RATIO: &str = "a ratio";

/// Maximum length of a unit, in characters.
const MAX_UNIT_LENGTH: usize = 40;

/// The unit after a number that ends at index `end`, and the index where it ends.
pub(super) fn unit_after(chars: Chars<'_>, end: usize) -> Option<(Unit, usize)> {
    let text = chars.text(end, end + MAX_UNIT_LENGTH);
    let line = text.split('\n').next().unwrap_or("");
    let (rest, unit) = unit(line).ok()?;
    Some((unit, end + line.chars().count() - rest.chars().count()))
}

/// The unit at the beginning of a text, including the space before it.
fn unit(line: &str) -> IResult<&str, Unit> {
    let hyphenated = preceded(
        (char('-'), peek(satisfy(char::is_alphabetic))),
        alt((
            map(known_unit, |(text, dimension)| unit_named(text, dimension)),
            map(terminated(recognize(factor_suffix), word_end), |text| {
                unit_named(text, Some(Dimension::NUMBER))
            }),
        )),
    );
    let space = (opt(char(' ')), not(char(' ')));
    // The superscript ring of TeX: `30^\circ`.
    let ring = opt(terminated(char('^'), peek(char('°'))));
    let counted = alt((
        counted_rate,
        multiple,
        map(verify(word, is_counted), |word| unit_named(word, Some(Dimension::NUMBER))),
    ));
    // A number per thing that is not a unit, such as `per step`.
    let of_things = map(recognize((over, word)), |text| unit_named(text, None));
    alt((hyphenated, preceded((space, ring), alt((percentage, measured, counted, of_things, phrase_rate)))))
        .parse(line)
}

/// The suffix of a factor after a hyphen: `3-fold`, `3-mal`.
fn factor_suffix(text: &str) -> IResult<&str, &str> {
    alt((
        tag("fold"),
        tag("mal"),
        tag("fachen"),
        tag("facher"),
        tag("faches"),
        tag("fachem"),
        tag("fache"),
        tag("fach"),
    ))
    .parse(text)
}

/// Words for a factor of another quantity, which is a number without a unit: `2.45 times the speed on the moon`.
fn multiple(text: &str) -> IResult<&str, Unit> {
    let times = alt((tag("times"), tag("fois"), tag("veces"), tag("volte"), tag("Mal"), tag("mal")));
    let number = |rest: &str| {
        let next = rest.trim_start().split(|c: char| !c.is_alphanumeric()).next().unwrap_or("");
        let spelled = Languages::ALL.iter().any(|language| language.numerals.contains(&next));
        rest.trim_start().starts_with(|c: char| !c.is_alphabetic() && !".,;:!?)\"”".contains(c))
            || spelled
            || next.chars().count() == 1
    };
    let (rest, text) = terminated(times, word_end).parse(text)?;
    if number(rest) { fail().parse(rest) } else { Ok((rest, unit_named(text, Some(Dimension::NUMBER)))) }
}

/// A rate of counted things: `3 bounces per second`, `0.7 times per second`.
fn counted_rate(text: &str) -> IResult<&str, Unit> {
    let things = verify(word, |word: &str| is_counted(word) || word == "times");
    let (rest, (text, (_, _, (_, dimension)))) =
        consumed((things, alt((tag(" per "), tag(" a "), tag("/"))), known_unit)).parse(text)?;
    Ok((rest, unit_named(text, dimension.and_then(|d| d.power(-1.0)))))
}

/// A rate of things that are not known: `3 body lengths per second`. Its dimension is that of counted things.
fn phrase_rate(text: &str) -> IResult<&str, Unit> {
    let things = (word, opt((char(' '), word)));
    let (rest, (text, (_, _, (_, dimension)))) = consumed((
        things,
        alt((tag(" per "), terminated(tag(" a "), peek(alt((tag("second"), tag("minute"))))))),
        known_unit,
    ))
    .parse(text)?;
    Ok((rest, unit_named(text, dimension.and_then(|d| d.power(-1.0)))))
}

fn unit_named(text: &str, dimension: Option<Dimension>) -> Unit {
    Unit { text: text.to_string(), dimension, link: Link::Direct }
}

/// A unit with its prefix "per" and suffix: `m/s`, `per second`, `/s`; `0.7 mm per step` and `0.7 mm/step` include the
/// suffix.
fn measured(text: &str) -> IResult<&str, Unit> {
    let per_thing = (alt((tag(" per "), tag("/"), tag(" / "))), word);
    let (rest, (text, (over, (_, dimension), thing))) =
        consumed((opt(over), known_unit, opt(per_thing))).parse(text)?;
    let dimension = if over.is_some() { dimension.and_then(|d| d.power(-1.0)) } else { dimension };
    Ok((rest, unit_named(text, dimension.filter(|_| thing.is_none()))))
}

fn over(text: &str) -> IResult<&str, &str> {
    alt((tag("per "), tag("/"))).parse(text)
}

/// A known unit that ends at a word boundary.
fn known_unit(text: &str) -> IResult<&str, (&str, Option<Dimension>)> {
    let read =
        units::read(text).and_then(|found| Some((text.split_at_checked(found.length)?, found.dimension)));
    let Some(((unit, rest), dimension)) = read else { return fail().parse(text) };
    value((unit, dimension), word_end).parse(rest)
}

/// A word for a percentage.
fn percentage(text: &str) -> IResult<&str, Unit> {
    let words = ["percent", "per cent", "per mille", "permille", "pct", "Prozent"];
    let found = words.into_iter().find_map(|word| {
        let (rest, _) = terminated(tag_no_case::<_, _, Error<&str>>(word), word_end).parse(text).ok()?;
        let factor = if word.ends_with("mille") { 1000.0 } else { 100.0 };
        Some((rest, unit_named(word, Some(Dimension::NUMBER.times(factor)))))
    });
    found.map_or_else(|| fail().parse(text), Ok)
}

/// Names of counted things, which have no other unit.
const COUNTED: [&str; 15] = [
    "steps",
    "frames",
    "samples",
    "ticks",
    "beats",
    "bounces",
    "contacts",
    "collisions",
    "swings",
    "periods",
    "oscillations",
    "cycles",
    "laps",
    "jumps",
    "pieces",
];

/// Whether a word is a name of counted things, in capital letters or not.
fn is_counted(word: &str) -> bool {
    COUNTED.contains(&word.to_lowercase().as_str())
}

/// The letters of a word.
fn word(text: &str) -> IResult<&str, &str> {
    take_while1(|c: char| c.is_alphabetic() && !units::is_wide(c)).parse(text)
}

/// The end of a word.
fn word_end(text: &str) -> IResult<&str, ()> {
    not(satisfy(|c| c.is_alphanumeric() && !units::is_wide(c) || c == '_')).parse(text)
}
