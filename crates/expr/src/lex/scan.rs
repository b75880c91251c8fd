//! The lexer's main loop: reads every token, and every blank between tokens, with a parser of its kind.

use labspec_finding::order;
use std::collections::BTreeMap;
use std::sync::LazyLock;

use nom::branch::alt;
use nom::bytes::complete::take_while;
use nom::character::complete::{anychar, satisfy};
use nom::combinator::{map, recognize};
use nom::sequence::delimited;
use nom::{IResult, Parser};

use super::blank::{blank, is_line_end, unclosed_comment};
use super::literal;
use super::token::{RawToken, Token, TokenKind};
use crate::operators::{BinaryOp, LogicalOp};
use crate::rules;
use labspec_finding::{Finding, Span};

/// Symbols that are not binary operators.
const MARKS: [&str; 21] = [
    "(", ")", "[", "]", "{", "}", ",", ";", ":", "?", ".", "...", "?.", "=", "=>", "++", "--", "!", "~", "@",
    "#",
];

/// All symbols by their first character, longer ones before their prefixes.
static SYMBOLS: LazyLock<BTreeMap<char, Vec<String>>> = LazyLock::new(|| {
    let binary = BinaryOp::ALL.iter().map(|op| (op.symbol(), !op.is_comparison()));
    let operators = binary.chain(LogicalOp::ALL.iter().map(|op| (op.symbol(), true)));
    let mut all: BTreeMap<char, Vec<String>> = BTreeMap::new();
    let mut add = |text: String| all.entry(text.chars().next().unwrap_or(' ')).or_default().push(text);
    MARKS.iter().for_each(|mark| add((*mark).to_owned()));
    for (symbol, assigns) in operators {
        add(symbol.to_owned());
        if assigns {
            add(format!("{symbol}="));
        }
    }
    all.values_mut().for_each(|list| order::sort_by_key(list, |text| std::cmp::Reverse(text.len())));
    all
});

/// All tokens of a source text; the last one is [`TokenKind::End`].
pub(crate) fn tokens<'s>(source: &'s str, diagnostics: &mut Vec<Finding>) -> Vec<Token<'s>> {
    tokens_of(source, Span::new(0, source.len()), diagnostics)
}

/// All tokens of a part of a source text; the last one is [`TokenKind::End`].
pub(crate) fn tokens_of<'s>(source: &'s str, part: Span, diagnostics: &mut Vec<Finding>) -> Vec<Token<'s>> {
    let mut input = part.text(source);
    // On average, a token takes about three bytes.
    let mut tokens: Vec<Token<'s>> = Vec::with_capacity(input.len() / 3 + 1);
    let end = part.start + input.len();
    loop {
        let (rest, newline, open) = blank(input);
        if let Some(comment) = open {
            diagnostics.push(unclosed_comment(end - comment.len()));
        }
        let start = end - rest.len();
        if rest.is_empty() {
            tokens.push(Token { kind: TokenKind::End, span: Span::new(start, start), newline, doubt: None });
            return tokens;
        }
        // Only a template can fail: then it is not closed.
        let (behind, raw) = raw(rest).map_or(("", None), |(behind, raw)| (behind, Some(raw)));
        let span = Span::new(start, end - behind.len());
        let before = diagnostics.len();
        let kind = match raw {
            Some(raw) => token(raw, source, span, diagnostics),
            None => literal::unclosed_template(start, diagnostics),
        };
        let fraction = matches!(kind, TokenKind::Number(_)) && is_fraction(&tokens, source, span);
        let doubtful = fraction || rest.starts_with(is_typographic);
        let doubt =
            if doubtful && diagnostics.len() > before { diagnostics.pop().map(Box::new) } else { None };
        tokens.push(Token { kind, span, newline, doubt });
        input = behind;
    }
}

/// Whether a number directly follows digits and a comma, as in `0,02`.
fn is_fraction(tokens: &[Token<'_>], source: &str, span: Span) -> bool {
    let [.., whole, comma] = tokens else { return false };
    let digits = |span: Span| span.text(source).bytes().all(|b| b.is_ascii_digit());
    comma.kind == TokenKind::Symbol(",")
        && matches!(whole.kind, TokenKind::Number(_))
        && whole.span.end == comma.span.start
        && comma.span.end == span.start
        && digits(whole.span)
        && digits(span)
}

/// Reads one token at the beginning of `input`.
fn raw(input: &str) -> IResult<&str, RawToken<'_>> {
    let mut chars = input.chars();
    let (first, second) = (chars.next().unwrap_or(' '), chars.next().unwrap_or(' '));
    match first {
        c if is_word_start(c) => map(word, RawToken::Word).parse(input),
        '0'..='9' => number(input),
        '.' if second.is_ascii_digit() => number(input),
        '\'' | '"' => literal::string(first).parse(input),
        '`' => literal::template(input),
        _ => alt((
            map(|input| symbol(first, input), RawToken::Symbol),
            map(typographic, RawToken::Typographic),
            map(anychar, RawToken::Odd),
        ))
        .parse(input),
    }
}

fn number(input: &str) -> IResult<&str, RawToken<'_>> {
    map((literal::number, take_while(is_word_part)), |(text, tail)| RawToken::Number(text, tail)).parse(input)
}

/// Returns the meaning of a token, and reports what is wrong with it.
fn token<'s>(raw: RawToken<'s>, source: &str, span: Span, diagnostics: &mut Vec<Finding>) -> TokenKind<'s> {
    match raw {
        RawToken::Word(text) => TokenKind::Word(text),
        RawToken::Symbol(text) => TokenKind::Symbol(text),
        RawToken::Number(text, tail) => literal::number_of(text, tail, span, diagnostics),
        RawToken::Text(quote, parts, closed) => {
            literal::text_of(quote, &parts, closed, (source, span), diagnostics)
        }
        RawToken::Template(parts) => literal::template_of(parts, source, diagnostics),
        RawToken::Typographic(text) => {
            diagnostics.push(
                Finding::error(rules::BAD_CHARACTER, span, "typographic quotes do not make a string")
                    .why("word processors insert them instead of plain quotes")
                    .help("write `\"` or `'`")
                    .fix(span, format!("\"{text}\"")),
            );
            TokenKind::Text(text.to_owned())
        }
        RawToken::Odd(c) => {
            diagnostics.push(bad_character(c, span));
            // A character that looks like an operator is read as that operator, so that parsing can continue.
            similar_operator(c).map_or(TokenKind::Bad, TokenKind::Symbol)
        }
    }
}

fn is_word_start(c: char) -> bool {
    c.is_alphabetic() || c == '_' || c == '$'
}

fn is_word_part(c: char) -> bool {
    is_word_start(c) || c.is_ascii_digit()
}

fn word(input: &str) -> IResult<&str, &str> {
    recognize((satisfy(is_word_start), take_while(is_word_part))).parse(input)
}

/// Reads a symbol that begins with the character `first`.
fn symbol(first: char, input: &str) -> IResult<&str, &'static str> {
    let error = || nom::Err::Error(nom::error::Error::new(input, nom::error::ErrorKind::Tag));
    let read = |text: &'static String| {
        let behind = input.strip_prefix(text.as_str())?;
        // In `a?.5:1`, `?` is the conditional operator followed by .5, not an optional member.
        (text != "?." || !behind.starts_with(|c: char| c.is_ascii_digit())).then_some((behind, text.as_str()))
    };
    SYMBOLS.get(&first).into_iter().flatten().find_map(read).ok_or_else(error)
}

fn is_typographic(c: char) -> bool {
    matches!(c, '“' | '”' | '„' | '‘' | '’' | '‚' | '«' | '»')
}

/// Reads a string in typographic quotes.
fn typographic(input: &str) -> IResult<&str, &str> {
    let inside = |c: char| !(is_typographic(c) || is_line_end(c) || matches!(c, '"' | '\\'));
    delimited(satisfy(is_typographic), take_while(inside), satisfy(is_typographic)).parse(input)
}

/// The operator that is intended by a character of a word processor or formula editor.
fn similar_operator(c: char) -> Option<&'static str> {
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
    let character = if c.is_control() { c.escape_unicode().to_string() } else { c.to_string() };
    let report = Finding::error(rules::BAD_CHARACTER, span, format!("`{character}` has no meaning here"));
    if let Some(text) = similar_operator(c) {
        return report
            .why("it looks like an operator but is another character, which word processors insert")
            .help(format!("write `{text}`"))
            .fix(span, text);
    }
    match c {
        c if is_typographic(c) => {
            report.why("typographic quotes do not make a string").help("write `\"` or `'`")
        }
        '²' => report.why("superscripts are not operators").help("write `** 2`").fix(span, " ** 2"),
        '³' => report.why("superscripts are not operators").help("write `** 3`").fix(span, " ** 3"),
        '√' => report.why("mathematical symbols are not operators").help("write `Math.sqrt(…)`"),
        '°' => report
            .why("angles have no unit sign; functions of `Math` take radians")
            .help("write `x * Math.PI / 180` for x degrees"),
        '\\' => report
            .why("a backslash is allowed only inside a string")
            .help("remove it; in JSON, `\\n` in the text is already a line break"),
        _ => report.help("remove it"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(source: &str) -> Vec<TokenKind<'_>> {
        let mut found = Vec::new();
        let tokens = tokens(source, &mut found);
        assert!(found.is_empty(), "{found:?}");
        tokens.into_iter().map(|t| t.kind).filter(|k| *k != TokenKind::End).collect()
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
            [
                TokenKind::Word("a"),
                TokenKind::Symbol("?"),
                TokenKind::Number(0.5),
                TokenKind::Symbol(":"),
                TokenKind::Number(1.0)
            ]
        );
    }

    #[test]
    fn a_point_before_a_letter_chooses_a_member() {
        let members = [TokenKind::Word("a"), TokenKind::Symbol("."), TokenKind::Word("_b")];
        assert_eq!(kinds("a._b"), members);
    }

    #[test]
    fn comments_and_odd_white_space_are_blank() {
        assert_eq!(kinds("\u{feff}1 // 2 /*\n\u{a0}/* 3 \n */"), [TokenKind::Number(1.0)]);
    }

    #[test]
    fn an_unclosed_comment_is_found_after_others() {
        let mut found = Vec::new();
        tokens("1 /* a */ // b /*\n /* c", &mut found);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].span, Span::new(19, 21));
    }
}
