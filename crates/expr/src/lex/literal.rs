//! Literals: numbers, strings and template literals (their strings, and the positions of the expressions between them).

use nom::branch::alt;
use nom::bytes::complete::{tag, tag_no_case, take_while, take_while_m_n, take_while1};
use nom::character::complete::{anychar, char, one_of, satisfy};
use nom::combinator::{cut, map, map_opt, not, opt, recognize, value};
use nom::multi::many0;
use nom::sequence::{delimited, preceded, terminated};
use nom::{IResult, Offset, Parser};

use super::blank::{blank, is_line_end};
use super::token::{LiteralPart, RawToken, TokenKind};
use crate::number::from_digits;
use crate::rules;
use labspec_finding::{Finding, Span};

/// The value of a number that is directly followed by the letters `tail`. An invalid number also gives a number token, so
/// that parsing can continue.
pub(super) fn number_of(
    text: &str,
    tail: &str,
    span: Span,
    diagnostics: &mut Vec<Finding>,
) -> TokenKind<'static> {
    let value = if text.contains('_') { plain(&text.replace('_', "")) } else { plain(text) };
    diagnostics.extend(suffix_finding(text, tail, value, span));
    TokenKind::Number(value.unwrap_or(0.0))
}

/// A number, including separators.
pub(super) fn number(input: &str) -> IResult<&str, &str> {
    alt((prefixed, decimal)).parse(input)
}

/// `0x1f`, `0b101`, `0o17`; the digits are checked later.
fn prefixed(input: &str) -> IResult<&str, &str> {
    let prefix = alt((tag_no_case("0x"), tag_no_case("0b"), tag_no_case("0o")));
    recognize((prefix, take_while(|c: char| c.is_ascii_hexdigit() || c == '_'))).parse(input)
}

/// `1`, `1.5`, `.5`, `5.`, `1e-3`
fn decimal(input: &str) -> IResult<&str, &str> {
    let fraction = (char('.'), take_while(is_digit));
    let mantissa = alt((
        recognize((take_while1(is_digit), opt(fraction))),
        recognize((char('.'), take_while1(is_digit))),
    ));
    let exponent = (one_of("eE"), opt(one_of("+-")), take_while1(is_digit));
    recognize((mantissa, opt(exponent))).parse(input)
}

fn is_digit(c: char) -> bool {
    c.is_ascii_digit() || c == '_'
}

/// The value of a well-formed number without separators.
fn plain(text: &str) -> Option<f64> {
    let digits = text.get(2..).unwrap_or("");
    match text.get(..2) {
        Some("0x" | "0X") => from_digits(digits, 16),
        Some("0b" | "0B") => from_digits(digits, 2),
        Some("0o" | "0O") => from_digits(digits, 8),
        _ => text.parse().ok(),
    }
}

/// The finding about a number of this value that is directly followed by the letters `tail`.
fn suffix_finding(text: &str, tail: &str, value: Option<f64>, span: Span) -> Option<Finding> {
    let bad = |message: String| Finding::error(rules::BAD_NUMBER, span, message);
    if tail == "n" {
        return Some(
            bad("big integers are not part of the language".into())
                .why("every number here is a double")
                .help(format!("write `{text}`"))
                .fix(span, text),
        );
    }
    if !tail.is_empty() {
        return Some(
            bad(format!("`{text}` runs into `{tail}`"))
                .why("a product needs its `*`, and a name cannot start with a digit")
                .help(format!("write `{text} * {tail}` for the product"))
                .guess(span, format!("{text} * {tail}")),
        );
    }
    let second = text.chars().nth(1).unwrap_or('.');
    if text.starts_with('0') && (second.is_ascii_digit() || second == '_') {
        let trimmed = text.trim_start_matches(['0', '_']);
        let meant = if trimmed.starts_with(|c: char| c.is_ascii_digit()) {
            trimmed.into()
        } else {
            format!("0{trimmed}")
        };
        return Some(
            bad(format!("`{text}` starts with an extra zero"))
                .why("JavaScript rejects it, or reads it in base 8")
                .help(format!("write `{meant}`"))
                .guess(span, meant),
        );
    }
    // A separator must be between two digits.
    let chars: Vec<char> = text.chars().collect();
    let stray = chars.iter().enumerate().any(|(i, c)| {
        let digit = |j: Option<usize>| j.and_then(|j| chars.get(j)).is_some_and(char::is_ascii_hexdigit);
        *c == '_' && !(digit(i.checked_sub(1)) && digit(Some(i + 1)))
    });
    (stray || value.is_none()).then(|| {
        bad(format!("`{text}` is not a number"))
            .help("write digits with a point, as `0.002`, or with an exponent, as `2e-3`")
    })
}

/// A string with this quote, up to its end or the end of the line.
pub(super) fn string<'a>(
    quote: char,
) -> impl Parser<&'a str, Output = RawToken<'a>, Error = nom::error::Error<&'a str>> {
    let plain = take_while1(move |c| c != quote && !matches!(c, '\\' | '\n' | '\r'));
    let parts = many0(alt((map(plain, LiteralPart::Plain), escape, invalid_part)));
    map((char(quote), parts, opt(char(quote))), move |(_, parts, end)| {
        RawToken::Text(quote, parts, end.is_some())
    })
}

/// A template literal. If it, or an expression in it, is not closed, the parser fails.
pub(super) fn template(input: &str) -> IResult<&str, RawToken<'_>> {
    let plain = take_while1(|c| !matches!(c, '`' | '$' | '\\' | '\r'));
    // JavaScript reads every line end in a template as a line feed.
    let line_end = value(LiteralPart::Char('\n'), alt((tag("\r\n"), tag("\r"))));
    let code = preceded(tag("${"), cut(terminated(code, char('}'))));
    let part = alt((
        map(plain, LiteralPart::Plain),
        map(code, LiteralPart::Code),
        dollar,
        line_end,
        escape,
        invalid_part,
    ));
    map(delimited(char('`'), many0(part), cut(char('`'))), RawToken::Template).parse(input)
}

fn dollar(input: &str) -> IResult<&str, LiteralPart<'_>> {
    map(tag("$"), LiteralPart::Plain).parse(input)
}

/// An escape sequence.
fn escape(input: &str) -> IResult<&str, LiteralPart<'_>> {
    let letter = map_opt(anychar, |c| {
        Some(match c {
            'n' => '\n',
            't' => '\t',
            'r' => '\r',
            'b' => '\u{8}',
            'f' => '\u{c}',
            'v' => '\u{b}',
            _ => return None,
        })
    });
    let zero = value('\0', terminated(char('0'), not(satisfy(|c| c.is_ascii_digit()))));
    let unit = |n| map_opt(take_while_m_n(n, n, |c: char| c.is_ascii_hexdigit()), hex);
    let point = map_opt(take_while1(|c: char| c.is_ascii_hexdigit()), hex);
    // A surrogate pair: a code point beyond the basic multilingual plane.
    let pair = map_opt((unit(4), tag("\\u"), unit(4)), |(high, _, low)| {
        let pair = [u16::try_from(high).ok()?, u16::try_from(low).ok()?];
        char::decode_utf16(pair).next()?.ok().filter(|c| c.len_utf16() == 2)
    });
    let unicode = alt((
        map_opt(delimited(char('{'), point, char('}')), char::from_u32),
        pair,
        map_opt(unit(4), char::from_u32),
    ));
    let hexadecimal = map_opt(unit(2), char::from_u32);
    let itself = satisfy(|c| !c.is_ascii_digit() && !matches!(c, 'x' | 'u') && !is_line_end(c));
    let line_end = alt((tag("\r\n"), recognize(satisfy(is_line_end))));
    let meant = alt((letter, zero, preceded(char('x'), hexadecimal), preceded(char('u'), unicode), itself));
    preceded(char('\\'), alt((map(meant, LiteralPart::Char), value(LiteralPart::Nothing, line_end))))
        .parse(input)
}

fn invalid_part(input: &str) -> IResult<&str, LiteralPart<'_>> {
    map(recognize((char('\\'), opt(satisfy(|c| !is_line_end(c))))), LiteralPart::Broken).parse(input)
}

fn hex(digits: &str) -> Option<u32> {
    u32::from_str_radix(digits, 16).ok()
}

/// The code of an expression in a template, up to the closing `}`. Strings, comments and templates in it are skipped.
fn code(input: &str) -> IResult<&str, &str> {
    /// A piece of code.
    #[derive(Clone, Copy, PartialEq)]
    enum LiteralPiece {
        Opens(EnclosingConstruct),
        Closes,
        Other,
    }
    /// The construct that contains the current position.
    #[derive(Clone, Copy, PartialEq)]
    enum EnclosingConstruct {
        Braces,
        Template,
    }
    let mut inside = vec![EnclosingConstruct::Braces];
    let mut behind = input;
    while let Some(around) = inside.last() {
        let opens = |text, what| value(LiteralPiece::Opens(what), tag(text));
        let other = || value(LiteralPiece::Other, anychar);
        let (next, piece) = match around {
            EnclosingConstruct::Template => alt((
                value(LiteralPiece::Other, (char('\\'), anychar)),
                value(LiteralPiece::Closes, char('`')),
                opens("${", EnclosingConstruct::Braces),
                other(),
            ))
            .parse(behind)?,
            EnclosingConstruct::Braces => alt((
                value(LiteralPiece::Other, alt((string('"'), string('\'')))),
                value(LiteralPiece::Other, comment),
                opens("`", EnclosingConstruct::Template),
                opens("{", EnclosingConstruct::Braces),
                value(LiteralPiece::Closes, char('}')),
                other(),
            ))
            .parse(behind)?,
        };
        match piece {
            LiteralPiece::Opens(what) => inside.push(what),
            LiteralPiece::Closes => drop(inside.pop()),
            LiteralPiece::Other => {}
        }
        if !inside.is_empty() {
            behind = next;
        }
    }
    let (code, _) = input.split_at(input.offset(behind));
    Ok((behind, code))
}

/// Comments and surrounding white space.
fn comment(input: &str) -> IResult<&str, ()> {
    let (marker_end, _) = alt((tag("//"), tag("/*"))).parse(input)?;
    let (behind, ..) = blank(input);
    Ok((if behind.len() < marker_end.len() { behind } else { marker_end }, ()))
}

/// Appends the contents of the parts of a string or a template to a string.
fn append_parts<'a>(
    parts: &[LiteralPart<'a>],
    source: &str,
    diagnostics: &mut Vec<Finding>,
    mut code: impl FnMut(&mut String, &'a str),
) -> String {
    let mut text = String::new();
    for part in parts {
        match part {
            LiteralPart::Plain(plain) => text.push_str(plain),
            LiteralPart::Char(c) => text.push(*c),
            LiteralPart::Nothing => {}
            LiteralPart::Code(inner) => code(&mut text, inner),
            LiteralPart::Broken(escape) => {
                let start = source.offset(escape);
                diagnostics.push(
                    Finding::error(
                        rules::BAD_STRING,
                        Span::new(start, start + escape.len()),
                        "this escape is invalid",
                    )
                    .why("`\\x` takes two hexadecimal digits, `\\u` four or a code point in braces; other digits have no meaning")
                    .help("write the character itself, or `\\\\` for a backslash"),
                );
            }
        }
    }
    text
}

/// The value of a string literal.
pub(super) fn text_of(
    quote: char,
    parts: &[LiteralPart<'_>],
    closed: bool,
    (source, span): (&str, Span),
    diagnostics: &mut Vec<Finding>,
) -> TokenKind<'static> {
    let text = append_parts(parts, source, diagnostics, |_, _| {});
    if !closed {
        diagnostics.push(
            Finding::error(rules::BAD_STRING, span, "this string is not closed")
                .why("a string must end on the line where it starts, with the same quote")
                .help(format!("write `{quote}` where the string ends")),
        );
    }
    TokenKind::Text(text)
}

/// The token of a template literal: its strings, and the positions of the expressions between them.
pub(super) fn template_of(
    parts: Vec<LiteralPart<'_>>,
    source: &str,
    diagnostics: &mut Vec<Finding>,
) -> TokenKind<'static> {
    let (mut texts, mut places) = (Vec::new(), Vec::new());
    let last = append_parts(&parts, source, diagnostics, |text, code| {
        let start = source.offset(code);
        texts.push(std::mem::take(text));
        places.push(Span::new(start, start + code.len()));
    });
    texts.push(last);
    TokenKind::Template(texts, places)
}

/// The token of a template literal without an end, which takes the rest of the text.
pub(super) fn unclosed_template(start: usize, diagnostics: &mut Vec<Finding>) -> TokenKind<'static> {
    diagnostics.push(
        Finding::error(rules::BAD_STRING, Span::new(start, start + 1), "this backquote is not closed")
            .why("a template literal ends with a backquote, and every `${` in it with `}`")
            .help("write a backquote where the text ends"),
    );
    TokenKind::Bad
}

#[cfg(test)]
mod tests {
    use super::super::tokens;
    use super::*;

    fn read(source: &str) -> (TokenKind<'_>, Vec<Finding>) {
        let mut found = Vec::new();
        let tokens = tokens(source, &mut found);
        (tokens[0].kind.clone(), found)
    }

    #[test]
    fn numbers() {
        for (source, value) in [
            ("1_000.5", 1000.5),
            (".5e1", 5.0),
            ("5.", 5.0),
            ("0x_ff", f64::NAN),
            ("0xff", 255.0),
            ("0B11", 3.0),
            ("1e400", f64::INFINITY),
        ] {
            let (kind, found) = read(source);
            if value.is_nan() {
                assert_eq!(found.len(), 1, "{source}");
            } else {
                assert_eq!((kind, found.len()), (TokenKind::Number(value), 0), "{source}");
            }
        }
        for source in ["2x", "10n", "010", "1__0", "1_", "0b2", "0x", "3.toFixed", "00"] {
            assert_eq!(read(source).1.len(), 1, "{source}");
        }
    }

    #[test]
    fn strings() {
        for (source, text) in [
            (r#""a\"b""#, "a\"b"),
            (r"'\x41\u00e9\u{1F600}\uD83D\uDE00'", "Aé😀😀"),
            ("'a\\\nb'", "ab"),
            (r"'\q\0'", "q\0"),
        ] {
            assert_eq!(read(source), (TokenKind::Text(text.into()), Vec::new()), "{source}");
        }
        for source in ["'abc", "'\\x4'", "'\\u12'", "'\\uD800'", "'\\08'", "\"a\n\"", "'\\"] {
            assert!(!read(source).1.is_empty(), "{source}");
        }
    }
}
