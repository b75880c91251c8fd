//! Text to tokens, with nom. Every token keeps its bytes and whether a line ends before it, which is all that
//! automatic semicolons need. A character that starts no token is reported once and skipped.

mod literal;

use nom::branch::alt;
use nom::bytes::complete::{tag, take_until, take_while, take_while1};
use nom::combinator::{recognize, rest};
use nom::{IResult, Parser};

use crate::{Finding, Span};
use crate::{number, rules};

/// A piece of the source text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Token {
    pub(crate) kind: Tok,
    pub(crate) span: Span,
    /// A line ends between the token before and this one.
    pub(crate) newline: bool,
}

/// What a token is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Tok {
    Number(f64),
    Text(String),
    Word(String),
    Symbol(&'static str),
    /// A template literal: its texts, and where the expressions between them stand.
    Template(Vec<String>, Vec<Span>),
    /// Could not be read; already reported.
    Bad,
    /// Behind the last character.
    End,
}

/// All symbols, longer ones before their beginnings.
const SYMBOLS: &[&str] = &[
    ">>>=", "===", "!==", "**=", "<<=", ">>=", ">>>", "...", "&&=", "||=", "??=", "=>", "==", "!=", "<=",
    ">=", "&&", "||", "??", "?.", "++", "--", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<", ">>",
    "**", "{", "}", "(", ")", "[", "]", ";", ",", "<", ">", "+", "-", "*", "/", "%", "&", "|", "^", "!", "~",
    "?", ":", "=", ".", "@", "#",
];

/// All tokens of a text, the last one [`Tok::End`].
pub(crate) fn tokens(source: &str, diagnostics: &mut Vec<Finding>) -> Vec<Token> {
    tokens_of(source, Span::new(0, source.len()), diagnostics)
}

/// All tokens of a part of a text, the last one [`Tok::End`].
pub(crate) fn tokens_of(source: &str, part: Span, diagnostics: &mut Vec<Finding>) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut input = part.text(source);
    let end = part.start + input.len();
    loop {
        let (at, gap) = blank(input).unwrap_or((input, ""));
        let gap_start = end - input.len();
        let start = end - at.len();
        check_comment(gap, gap_start, diagnostics);
        let newline = gap.contains(is_line_end);
        if at.is_empty() {
            tokens.push(Token { kind: Tok::End, span: Span::new(start, start), newline });
            return tokens;
        }
        let (behind, kind) = token(at, start, diagnostics);
        // Every branch of `token` takes at least one character; if one did not, this still ends.
        let behind = if behind.len() < at.len() { behind } else { "" };
        tokens.push(Token { kind, span: Span::new(start, end - behind.len()), newline });
        input = behind;
    }
}

fn is_line_end(c: char) -> bool {
    matches!(c, '\n' | '\r' | '\u{2028}' | '\u{2029}')
}

/// White space and comments; an unclosed comment reaches to the end.
fn blank(input: &str) -> IResult<&str, &str> {
    let mut behind = input;
    loop {
        let line = recognize((tag("//"), take_while(|c| !is_line_end(c))));
        let block = recognize((tag("/*"), alt((recognize((take_until("*/"), tag("*/"))), rest))));
        let space = take_while1(number::is_space);
        match alt((space, line, block)).parse(behind) {
            Ok((next, _)) => behind = next,
            Err(nom::Err::Error(nom::error::Error { .. })) => break,
            Err(other) => return Err(other),
        }
    }
    let (gap, behind) = input.split_at(input.len() - behind.len());
    Ok((behind, gap))
}

/// Reports a block comment at the end of a gap that is not closed.
fn check_comment(gap: &str, start: usize, diagnostics: &mut Vec<Finding>) {
    let mut from = 0;
    while let Some((at, opener)) = next_comment(gap, from) {
        let close = if opener == "/*" { "*/" } else { "\n" };
        match gap.get(at + 2..).and_then(|rest| rest.find(close)) {
            Some(n) => from = at + 2 + n + close.len(),
            None if opener == "/*" => {
                let span = Span::new(start + at, start + at + 2);
                diagnostics.push(
                    Finding::error(rules::UNCLOSED_COMMENT, span, "this comment is never closed")
                        .why("everything behind it is part of the comment and is not read")
                        .help("write `*/` where the comment ends"),
                );
                return;
            }
            None => return,
        }
    }
}

/// The first comment opener of a gap at or behind a byte.
fn next_comment(gap: &str, from: usize) -> Option<(usize, &'static str)> {
    let tail = gap.get(from..)?;
    let at = tail.find('/')?;
    let opener = if tail.get(at..)?.starts_with("/*") { "/*" } else { "//" };
    Some((from + at, opener))
}

/// One token at the beginning of `input`, which starts at byte `at` of the source.
fn token<'a>(input: &'a str, at: usize, diagnostics: &mut Vec<Finding>) -> (&'a str, Tok) {
    let mut chars = input.chars();
    let first = chars.next().unwrap_or(' ');
    let second = chars.next().unwrap_or(' ');
    if first.is_ascii_digit() || (first == '.' && second.is_ascii_digit()) {
        return literal::number(input, at, diagnostics);
    }
    if first == '"' || first == '\'' {
        return literal::string(input, at, diagnostics);
    }
    if first == '`' {
        return literal::template(input, at, diagnostics);
    }
    if let Ok((behind, text)) = word(input) {
        return (behind, Tok::Word(text.to_owned()));
    }
    if let Ok((behind, text)) = symbol(input) {
        return (behind, Tok::Symbol(text));
    }
    if let Some((behind, text)) = typographic(input) {
        let span = Span::new(at, at + input.len() - behind.len());
        diagnostics.push(
            Finding::error(rules::BAD_CHARACTER, span, "typographic quotes do not make a string")
                .why("word processors put them in place of the plain ones")
                .help("write `\"` or `'`")
                .fix(span, format!("\"{text}\"")),
        );
        return (behind, Tok::Text(text.to_owned()));
    }
    let behind = input.get(first.len_utf8()..).unwrap_or("");
    let span = Span::new(at, at + first.len_utf8());
    diagnostics.push(bad_character(first, span));
    // A look-alike of an operator is read as that operator, so that what follows is still understood.
    let meant = look_alike(first).and_then(|text| SYMBOLS.iter().find(|s| **s == text));
    (behind, meant.map_or(Tok::Bad, |s| Tok::Symbol(s)))
}

fn is_word_start(c: char) -> bool {
    c.is_alphabetic() || c == '_' || c == '$'
}

fn is_word_part(c: char) -> bool {
    is_word_start(c) || c.is_ascii_digit()
}

fn word(input: &str) -> IResult<&str, &str> {
    recognize((nom::character::complete::satisfy(is_word_start), take_while(is_word_part))).parse(input)
}

fn symbol(input: &str) -> IResult<&str, &'static str> {
    for text in SYMBOLS {
        let Ok((behind, _)) = tag::<_, _, nom::error::Error<&str>>(*text).parse(input) else { continue };
        // `a?.5:1` is a choice between .5 and 1, not an optional member.
        if *text == "?." && behind.starts_with(|c: char| c.is_ascii_digit()) {
            continue;
        }
        return Ok((behind, text));
    }
    Err(nom::Err::Error(nom::error::Error::new(input, nom::error::ErrorKind::Tag)))
}

fn is_typographic(c: char) -> bool {
    matches!(c, '“' | '”' | '„' | '‘' | '’' | '‚' | '«' | '»')
}

/// The text between two typographic quotes, and what is behind them.
fn typographic(input: &str) -> Option<(&str, &str)> {
    let inner = input.strip_prefix(is_typographic)?;
    let end = inner.find(|c| is_typographic(c) || is_line_end(c) || matches!(c, '"' | '\\'))?;
    let (text, closing) = inner.split_at(end);
    Some((closing.strip_prefix(is_typographic)?, text))
}

/// What people mean by signs that word processors and formula editors write.
fn look_alike(c: char) -> Option<&'static str> {
    Some(match c {
        '−' | '–' | '—' => "-",
        '×' | '·' | '⋅' | '∙' => "*",
        '÷' | '∕' => "/",
        '≤' => "<=",
        '≥' => ">=",
        '≠' => "!==",
        '≡' => "===",
        '¬' => "!",
        '∧' => "&&",
        '∨' => "||",
        '，' => ",",
        '；' => ";",
        '（' => "(",
        '）' => ")",
        _ => return None,
    })
}

fn bad_character(c: char, span: Span) -> Finding {
    let shown = if c.is_control() { c.escape_unicode().to_string() } else { c.to_string() };
    let report = Finding::error(rules::BAD_CHARACTER, span, format!("`{shown}` has no meaning here"));
    if let Some(text) = look_alike(c) {
        return report
            .why("it looks like an operator, but is another character, as word processors write it")
            .help(format!("write `{text}`"))
            .fix(span, text);
    }
    match c {
        c if is_typographic(c) => {
            report.why("typographic quotes do not make a string").help("write `\"` or `'`")
        }
        '²' => report.why("superscripts are not operators").help("write `** 2`").fix(span, " ** 2"),
        '³' => report.why("superscripts are not operators").help("write `** 3`").fix(span, " ** 3"),
        '√' => report.why("signs of mathematics are not operators").help("write `Math.sqrt(…)`"),
        '°' => report
            .why("angles have no unit sign; functions of `Math` take radians")
            .help("write `x * Math.PI / 180` for x degrees"),
        '\\' => report
            .why("a backslash has a meaning only inside a string")
            .help("remove it; inside JSON, `\\n` in the text is already a line end"),
        _ => report.help("remove it"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(source: &str) -> Vec<Tok> {
        let mut found = Vec::new();
        let tokens = tokens(source, &mut found);
        assert!(found.is_empty(), "{found:?}");
        tokens.into_iter().map(|t| t.kind).filter(|k| *k != Tok::End).collect()
    }

    #[test]
    fn tokens_keep_their_bytes() {
        let mut found = Vec::new();
        let source = "data.qpos[2] /* z */\n>= 'é'";
        let tokens = tokens(source, &mut found);
        let texts: Vec<&str> = tokens.iter().map(|t| t.span.text(source)).collect();
        assert_eq!(texts, ["data", ".", "qpos", "[", "2", "]", ">=", "'é'", ""]);
        assert!(tokens[6].newline && !tokens[7].newline);
    }

    #[test]
    fn a_question_mark_before_a_decimal_is_a_choice() {
        assert_eq!(
            kinds("a?.5:1"),
            [Tok::Word("a".into()), Tok::Symbol("?"), Tok::Number(0.5), Tok::Symbol(":"), Tok::Number(1.0)]
        );
    }

    #[test]
    fn comments_and_odd_white_space_are_blank() {
        assert_eq!(kinds("\u{feff}1 // 2 /*\n\u{a0}/* 3 \n */"), [Tok::Number(1.0)]);
    }

    #[test]
    fn an_unclosed_comment_is_found_behind_others() {
        let mut found = Vec::new();
        tokens("1 /* a */ // b /*\n /* c", &mut found);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].span, Span::new(19, 21));
    }
}
