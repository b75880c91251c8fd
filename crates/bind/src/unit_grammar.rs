//! The grammar of units.
//!
//! ```text
//! unit   = factor { [ "/" | "per" | "a" | "·" | "*" | "×" | " " | "" ] factor }
//! factor = ( symbol | name | "%" | "1" | "(" unit ")" ) [ power ]
//! power  = [ "^" | "**" ] integer | raised digits | "squared" | "cubed"
//! ```

use crate::unit_table::{is_other, is_wide, symbol};
use labspec_expr::dimension::Dimension;
use nom::branch::alt;
use nom::bytes::complete::{tag, take_while, take_while_m_n, take_while1};
use nom::character::complete::{alpha1, anychar, char, one_of, satisfy};
use nom::combinator::{eof, fail, map, map_opt, not, opt, peek, recognize, value, verify};
use nom::multi::{fold_many_m_n, fold_many1};
use nom::sequence::{delimited, pair, preceded, terminated};
use nom::{IResult, Parser};

/// The dimension of a unit, or `None` if it is a known unit that is not supported (`dB`) or is ambiguous (`N m/rad s`).
type Meaning = Option<Dimension>;

/// Limits on nested brackets, on the factors of one unit, and on the characters of a word.
const MAX_NESTING: usize = 4;
const MAX_FACTORS: usize = 8;
const MAX_WORD: usize = 40;

/// Parses the longest product at the beginning of a text.
pub(crate) fn unit(text: &str) -> IResult<&str, Meaning> {
    product(text, 0)
}

fn product(text: &str, depth: usize) -> IResult<&str, Meaning> {
    let (rest, first) = factor(text, depth, true)?;
    let linked = pair(link, |text| factor(text, depth, depth > 0));
    let multiply = |(all, divided): (Meaning, bool), (divides, next): (bool, Meaning)| {
        // After a division, only one unit or a bracket may follow, unless every further factor has its own division.
        let clear = divides || !divided;
        let power = if divides { -1.0 } else { 1.0 };
        (all.filter(|_| clear).and_then(|all| all.product(next?.power(power)?)), divides || divided)
    };
    map(fold_many_m_n(0, MAX_FACTORS - 1, linked, || (first, false), multiply), |(all, _)| all).parse(rest)
}

/// Parses the separator of two factors, and returns whether the second is a divisor.
fn link(text: &str) -> IResult<&str, bool> {
    let space = || opt(char(' '));
    let spaces = || take_while(|c| c == ' ');
    alt((
        value(true, (char(' '), alt((tag("per "), tag("pro "), tag("par "), tag("por "))))),
        value(true, (char(' '), alt((tag("in der "), tag("je "), tag("à la "), tag("al "), tag("all'"))))),
        value(
            true,
            (char(' '), alt((tag("a "), tag("an "), tag("each "), tag("every "))), peek(time_of_rate)),
        ),
        value(true, (space(), one_of("/⁄÷∕每毎"), spaces())),
        value(false, (space(), one_of("·⋅*×∙•"), spaces())),
        // `m.s^-1`: a point separates factors if the next one has a power.
        value(false, (char('.'), peek((map_opt(take_while1(is_letter), symbol), satisfy(begins_power))))),
        value(false, space()),
    ))
    .parse(text)
}

/// Parses a time after `a` that makes it a divisor: `metres a second`. In `3 metres a second later` and `a second ball` it is
/// another phrase.
fn time_of_rate(text: &str) -> IResult<&str, &str> {
    const TIMES: [&str; 7] = ["second", "minute", "hour", "day", "week", "month", "year"];
    const NEXT: [&str; 28] = [
        "and", "or", "but", "as", "at", "on", "in", "for", "with", "when", "while", "if", "by", "to", "from",
        "than", "is", "are", "was", "here", "there", "upon", "just", "squared", "per", "a", "each", "every",
    ];
    let (rest, word) = alpha1(text)?;
    let next = rest.strip_prefix(' ').unwrap_or("").split(|c: char| !c.is_alphabetic()).next().unwrap_or("");
    let ends = !rest.starts_with([' ', '-']) || NEXT.contains(&next);
    if TIMES.contains(&word) && ends { Ok((rest, word)) } else { fail().parse(text) }
}

/// Parses a unit with its power. `first` states whether `1` is allowed here.
fn factor(text: &str, depth: usize, first: bool) -> IResult<&str, Meaning> {
    let (rest, found) = base(text, depth, first)?;
    let (rest, raised) = opt(|text| power(text, depth)).parse(rest)?;
    Ok((rest, raised.map_or(found, |n| found?.power(n))))
}

fn base(text: &str, depth: usize, first: bool) -> IResult<&str, Meaning> {
    let inner = |text| if depth < MAX_NESTING { product(text, depth + 1) } else { fail().parse(text) };
    let number = |factor| Some(Dimension::NUMBER.times(factor));
    // In `1/s`, the `1` is a part of the unit; in `m 1`, it is a number.
    let before_stroke = peek(alt((recognize((take_while(|c| c == ' '), char('/'))), eof)));
    alt((
        delimited(char('('), inner, char(')')),
        value(number(100.0), char('%')),
        value(number(1000.0), char('‰')),
        value(number(1.0), verify(terminated(char('1'), before_stroke), |_| first)),
        map(preceded(tag("square "), map_opt(alpha1, symbol)), |d| d.power(2.0)),
        map(preceded(tag("cubic "), map_opt(alpha1, symbol)), |d| d.power(3.0)),
        name,
    ))
    .parse(text)
}

/// Parses a symbol or a name: letters up to the next other character. In scripts without spaces between words, it is the
/// longest prefix that is a unit.
fn name(text: &str) -> IResult<&str, Meaning> {
    let wide = text.starts_with(is_wide);
    let letter = |c: char| is_letter(c) && is_wide(c) == wide || matches!(c, '°' | 'µ' | '℃' | '℉');
    let (_, word) = take_while_m_n(1, MAX_WORD, letter).parse(text)?;
    let ends = word.char_indices().rev().map(|(start, c)| start + c.len_utf8()).take(if wide {
        MAX_WORD
    } else {
        1
    });
    let meaning = |word: &str| {
        if is_other(word) { Some(None) } else { symbol(&word.replace('µ', "μ")).map(Some) }
    };
    let found = ends.into_iter().find_map(|end| Some((text.get(end..)?, meaning(text.get(..end)?)?)));
    found.map_or_else(|| fail().parse(text), Ok)
}

/// Parses the power after a symbol.
fn power(text: &str, depth: usize) -> IResult<&str, f64> {
    let word_ends = || not(satisfy(char::is_alphanumeric));
    let whole = || terminated(integer, not(decimals));
    alt((
        value(2.0, (alt((tag(" squared"), tag("平方"))), word_ends())),
        value(3.0, (tag(" cubed"), word_ends())),
        preceded(alt((tag("**"), tag("^"))), alt((delimited(one_of("({"), integer, one_of(")}")), whole()))),
        preceded(peek(satisfy(is_raised)), whole()),
        |text| bare_power(text, depth),
    ))
    .parse(text)
}

fn integer(text: &str) -> IResult<&str, f64> {
    let plus = value(1.0, one_of("⁺+"));
    let digits = fold_many1(digit, || 0_u32, |n, digit| n.saturating_mul(10).saturating_add(digit));
    let (rest, (sign, n)) = (opt(alt((minus, plus))), verify(digits, |n| *n < 128)).parse(text)?;
    Ok((rest, sign.unwrap_or(1.0) * f64::from(n)))
}

/// Parses a power without a sign for it, as in `s-1`: a digit from 1 to 6 that is not part of a longer
/// number and has no unit itself.
fn bare_power(text: &str, depth: usize) -> IResult<&str, f64> {
    let goes_on = satisfy(|c| c.is_alphanumeric() && !is_wide(c));
    let unit_behind = preceded(char(' '), |text| base(text, depth, true));
    let small = verify(digit, |n| (1..=6).contains(n));
    let (rest, (sign, n, _)) =
        (opt(minus), small, (not(goes_on), not(decimals), not(unit_behind))).parse(text)?;
    Ok((rest, sign.unwrap_or(1.0) * f64::from(n)))
}

fn minus(text: &str) -> IResult<&str, f64> {
    value(-1.0, one_of("⁻-−–")).parse(text)
}

/// Parses a digit, superscript or not.
fn digit(text: &str) -> IResult<&str, u32> {
    let raised = |c| RAISED.chars().position(|digit| digit == c).map(|n| n as u32);
    map_opt(anychar, |c| c.to_digit(10).or_else(|| raised(c))).parse(text)
}

fn decimals(text: &str) -> IResult<&str, (char, char)> {
    pair(one_of(".,"), satisfy(|c| c.is_ascii_digit())).parse(text)
}

const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";

fn is_raised(c: char) -> bool {
    RAISED.contains(c) || matches!(c, '⁻' | '⁺')
}

fn is_letter(c: char) -> bool {
    c.is_alphabetic() && !is_raised(c)
}

fn begins_power(c: char) -> bool {
    c == '^' || c == '-' || is_raised(c) || c.is_ascii_digit()
}
