//! White space and comments between tokens.

use nom::branch::alt;
use nom::bytes::complete::{tag, take_until, take_while, take_while1};
use nom::combinator::{recognize, rest};
use nom::sequence::delimited;
use nom::{IResult, Parser};

use crate::{number, rules};
use labspec_finding::{Finding, Span};

pub(super) fn is_line_end(c: char) -> bool {
    matches!(c, '\n' | '\r' | '\u{2028}' | '\u{2029}')
}

/// Skips white space and comments. Returns the rest, whether a line ends in them, and the start of a
/// comment that is not closed.
pub(super) fn blank(input: &str) -> (&str, bool, Option<&str>) {
    // Most tokens directly follow each other.
    if !input.starts_with(|c| c == '/' || number::is_space(c)) {
        return (input, false, None);
    }
    let mut behind = input;
    let line = || recognize((tag("//"), take_while(|c| !is_line_end(c))));
    let block = || recognize(delimited(tag("/*"), take_until("*/"), tag("*/")));
    let mut closed = alt((take_while1(number::is_space), line(), block()));
    while let Ok((next, _)) = nom_str(&mut closed, behind) {
        behind = next;
    }
    let open = nom_str(&mut recognize((tag("/*"), rest)), behind).ok().map(|(_, comment)| comment);
    let behind = if open.is_some() { "" } else { behind };
    let gap = input.get(..input.len() - behind.len()).unwrap_or("");
    (behind, gap.contains(is_line_end), open)
}

/// Applies a nom parser once.
fn nom_str<'a, P: Parser<&'a str, Error = nom::error::Error<&'a str>>>(
    parser: &mut P,
    input: &'a str,
) -> IResult<&'a str, P::Output> {
    parser.parse(input)
}

pub(super) fn unclosed_comment(start: usize) -> Finding {
    Finding::error(rules::UNCLOSED_COMMENT, Span::new(start, start + 2), "this comment is not closed")
        .why("everything after it is part of the comment")
        .help("write `*/` where the comment ends")
}
