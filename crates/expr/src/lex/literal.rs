//! Literals: numbers, strings, template literals (their texts, and the places of the expressions in them).

use nom::branch::alt;
use nom::bytes::complete::{tag_no_case, take_while, take_while1};
use nom::character::complete::{char, one_of};
use nom::combinator::{opt, recognize};
use nom::{IResult, Parser};

use super::{Tok, is_line_end, is_word_part};
use crate::number::from_digits;
use crate::rules;
use crate::{Finding, Span};

/// A number at the beginning of `input`.
pub(super) fn number<'a>(input: &'a str, at: usize, diagnostics: &mut Vec<Finding>) -> (&'a str, Tok) {
    let Ok((behind, text)) = alt((prefixed, decimal)).parse(input) else {
        return ("", Tok::Bad); // not reached: the caller saw a digit
    };
    let tail_length = behind.find(|c| !is_word_part(c)).unwrap_or(behind.len());
    let (tail, after) = behind.split_at(tail_length);
    let span = Span::new(at, at + text.len() + tail.len());
    let value = plain(&text.replace('_', ""));
    diagnostics.extend(complaint(text, tail, value, span));
    // Also a bad number stands for a number, so that what follows is understood.
    (after, Tok::Number(value.unwrap_or(0.0)))
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

/// What is wrong with a number of this value that is followed directly by the letters `tail`.
fn complaint(text: &str, tail: &str, value: Option<f64>, span: Span) -> Option<Finding> {
    let bad = |message: String| Finding::error(rules::BAD_NUMBER, span, message);
    if tail == "n" {
        return Some(
            bad("big integers are not part of the language".into())
                .why("every number here is a double, as every number of the simulation")
                .help(format!("write `{text}`"))
                .fix(span, text),
        );
    }
    if !tail.is_empty() {
        return Some(
            bad(format!("`{text}` runs into `{tail}`"))
                .why("a product needs its sign, and a name cannot start with a digit")
                .help(format!("write `{text} * {tail}` for the product"))
                .fix(span, format!("{text} * {tail}")),
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
            bad(format!("`{text}` starts with a zero too many"))
                .why("JavaScript refuses it, or reads it in base 8")
                .help(format!("write `{meant}`"))
                .fix(span, meant),
        );
    }
    // A separator stands between two digits, one at a time.
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

/// A string at the beginning of `input`, which starts with its quote.
pub(super) fn string<'a>(input: &'a str, at: usize, diagnostics: &mut Vec<Finding>) -> (&'a str, Tok) {
    let quote = if input.starts_with('"') { '"' } else { '\'' };
    let mut text = String::new();
    let mut rest = input.get(1..).unwrap_or("");
    loop {
        let Some(c) = rest.chars().next().filter(|c| !matches!(c, '\n' | '\r')) else {
            let span = Span::new(at, at + input.len() - rest.len());
            diagnostics.push(
                Finding::error(rules::BAD_STRING, span, "this string is never closed")
                    .why("a string ends on the line where it starts, with the quote that it starts with")
                    .help(format!("write `{quote}` where the string ends")),
            );
            return (rest, Tok::Text(text));
        };
        let behind = rest.get(c.len_utf8()..).unwrap_or("");
        if c == quote {
            return (behind, Tok::Text(text));
        }
        if c != '\\' {
            text.push(c);
            rest = behind;
            continue;
        }
        match escape(behind, &mut text) {
            Some(next) => rest = next,
            None => {
                let start = at + input.len() - rest.len();
                let length = 1 + behind.chars().next().map_or(0, char::len_utf8);
                diagnostics.push(
                    Finding::error(rules::BAD_STRING, Span::new(start, start + length), "this escape is broken")
                        .why("`\\x` takes two hexadecimal digits, `\\u` four or a code point in braces; other digits have no meaning")
                        .help("write the character itself, or `\\\\` for a backslash"),
                );
                rest = rest.get(length..).unwrap_or("");
            }
        }
    }
}

/// Reads what follows a backslash; `None` when it has no meaning.
fn escape<'a>(input: &'a str, text: &mut String) -> Option<&'a str> {
    let c = input.chars().next()?;
    let rest = input.get(c.len_utf8()..)?;
    match c {
        'n' => text.push('\n'),
        't' => text.push('\t'),
        'r' => text.push('\r'),
        'b' => text.push('\u{8}'),
        'f' => text.push('\u{c}'),
        'v' => text.push('\u{b}'),
        '0' if !rest.starts_with(|d: char| d.is_ascii_digit()) => text.push('\0'),
        '0'..='9' => return None,
        'x' => {
            let code = hex(rest.get(..2)?)?;
            text.push(char::from_u32(code)?);
            return rest.get(2..);
        }
        'u' => return unicode(rest, text),
        '\r' => return Some(rest.strip_prefix('\n').unwrap_or(rest)), // a continued line
        c if is_line_end(c) => {}
        c => text.push(c),
    }
    Some(rest)
}

/// Reads `{1F600}`, `00e9` or a pair of surrogates behind `\u`.
fn unicode<'a>(input: &'a str, text: &mut String) -> Option<&'a str> {
    if let Some(braced) = input.strip_prefix('{') {
        let (digits, rest) = braced.split_once('}')?;
        text.push(char::from_u32(hex(digits)?)?);
        return Some(rest);
    }
    let unit = hex(input.get(..4)?)?;
    let rest = input.get(4..)?;
    if let Some(c) = char::from_u32(unit) {
        text.push(c);
        return Some(rest);
    }
    // A code point beyond the basic plane: two halves, the second in DC00..E000.
    let low = hex(rest.strip_prefix("\\u")?.get(..4)?)?;
    let pair = [u16::try_from(unit).ok()?, u16::try_from(low).ok()?];
    text.push(char::decode_utf16(pair).next()?.ok()?);
    rest.get(6..)
}

fn hex(digits: &str) -> Option<u32> {
    let fine = !digits.is_empty() && digits.chars().all(|c| c.is_ascii_hexdigit());
    fine.then(|| u32::from_str_radix(digits, 16).ok())?
}

/// A template literal: texts and the places of the expressions between them. A line end in it is part of the text.
pub(super) fn template<'a>(input: &'a str, at: usize, diagnostics: &mut Vec<Finding>) -> (&'a str, Tok) {
    let (mut texts, mut values) = (Vec::new(), Vec::new());
    let mut text = String::new();
    let mut rest = input.get(1..).unwrap_or("");
    while let Some(c) = rest.chars().next() {
        let behind = rest.get(c.len_utf8()..).unwrap_or("");
        let here = at + input.len() - rest.len();
        match c {
            '`' => {
                texts.push(text);
                return (behind, Tok::Template(texts, values));
            }
            '$' if behind.starts_with('{') => {
                let code = behind.get(1..).unwrap_or("");
                let Some(length) = length_of_code(code) else { break };
                texts.push(std::mem::take(&mut text));
                values.push(Span::new(here + 2, here + 2 + length));
                rest = code.get(length + 1..).unwrap_or("");
            }
            '\\' => match escape(behind, &mut text) {
                Some(next) => rest = next,
                None => {
                    diagnostics.push(
                        Finding::error(rules::BAD_STRING, Span::new(here, here + 1), "this escape is broken")
                            .help("write the character itself, or `\\\\` for a backslash"),
                    );
                    rest = behind;
                }
            },
            // JavaScript reads every line end as a line feed.
            '\r' => {
                text.push('\n');
                rest = behind.strip_prefix('\n').unwrap_or(behind);
            }
            c => {
                text.push(c);
                rest = behind;
            }
        }
    }
    diagnostics.push(
        Finding::error(rules::BAD_STRING, Span::new(at, at + 1), "this backquote is never closed")
            .why("a template literal ends with a backquote, and every `${` in it with `}`")
            .help("write a backquote where the text ends"),
    );
    ("", Tok::Bad)
}

/// Bytes up to the `}` that closes an expression in a template; strings, comments and templates in it are skipped.
fn length_of_code(code: &str) -> Option<usize> {
    /// What the reader stands in.
    #[derive(PartialEq)]
    enum Inside {
        Braces,
        Template,
    }
    let mut inside = vec![Inside::Braces];
    let mut chars = code.char_indices().peekable();
    while let Some((i, c)) = chars.next() {
        let next = chars.peek().map_or(' ', |(_, c)| *c);
        let template = inside.last() == Some(&Inside::Template);
        match c {
            '\\' if template => {
                chars.next();
            }
            '`' if template => {
                inside.pop();
            }
            '$' if template && next == '{' => {
                chars.next();
                inside.push(Inside::Braces);
            }
            _ if template => {}
            '`' => inside.push(Inside::Template),
            '{' => inside.push(Inside::Braces),
            '}' => {
                inside.pop();
                if inside.is_empty() {
                    return Some(i);
                }
            }
            '"' | '\'' => {
                let mut escaped = false;
                for (_, d) in chars.by_ref() {
                    if !escaped && (d == c || is_line_end(d)) {
                        break;
                    }
                    escaped = !escaped && d == '\\';
                }
            }
            '/' if next == '/' => {
                for (_, d) in chars.by_ref() {
                    if is_line_end(d) {
                        break;
                    }
                }
            }
            '/' if next == '*' => {
                chars.next();
                let mut star = false;
                for (_, d) in chars.by_ref() {
                    if star && d == '/' {
                        break;
                    }
                    star = d == '*';
                }
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::super::tokens;
    use super::*;

    fn read(source: &str) -> (Tok, Vec<Finding>) {
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
                assert_eq!((kind, found.len()), (Tok::Number(value), 0), "{source}");
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
            assert_eq!(read(source), (Tok::Text(text.into()), Vec::new()), "{source}");
        }
        for source in ["'abc", "'\\x4'", "'\\u12'", "'\\uD800'", "'\\08'", "\"a\n\"", "'\\"] {
            assert!(!read(source).1.is_empty(), "{source}");
        }
    }
}
