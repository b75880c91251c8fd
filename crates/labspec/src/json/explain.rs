//! The JSON parser's errors in the words of a person who writes lessons.

use crate::finding::Finding;
use crate::lint::rules::json::SYNTAX;
use jsonc_parser::errors::{ParseError, ParseErrorKind as Kind};
use std::ops::Range;

/// A comma that is missing behind the value that ends at `at`.
pub(super) fn missing_comma(text: &str, at: usize) -> Finding {
    let at = text.get(..at).map_or(at, |before| before.trim_end().len());
    Finding::new(&SYNTAX, at..at, "a comma is missing here")
        .help("write `,` between two items of a list or two keys of an object")
        .fix(at..at, ",")
}

/// The parser's error in plain words. Spans are bytes of `text`.
pub(super) fn explain(text: &str, error: &ParseError) -> Finding {
    let range = error.range();
    let span = range.start.min(text.len())
        ..range.end.clamp(range.start, text.len().max(range.start)).min(text.len());
    let found = text.get(span.clone()).unwrap_or("").trim();
    let word: String = text
        .get(span.start..)
        .unwrap_or("")
        .chars()
        .take_while(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '+'))
        .take(40)
        .collect();
    let on_word = span.start..span.start + word.len().max(found.len().min(1));
    let at = |span: Range<usize>, message: String| Finding::new(&SYNTAX, span, message);
    match error.kind() {
        Kind::ExpectedComma => missing_comma(text, span.start),
        Kind::TrailingCommasNotAllowed => at(span.clone(), "a comma before a closing bracket".into())
            .help("delete this comma; JSON wants commas only between items")
            .fix(span, ""),
        Kind::UnexpectedComma => at(span.clone(), "a comma without a value before it".into())
            .help("delete this comma, or write the value that is missing"),
        Kind::CommentsNotAllowed | Kind::UnterminatedCommentBlock => {
            at(span, "JSON has no comments".into()).help("delete it, or say it in the text around the fence")
        }
        Kind::SingleQuotedStringsNotAllowed => {
            at(span, "a single quote where JSON needs a double quote".into())
                .help("write \"…\" around keys and texts; single quotes are fine inside a text")
        }
        Kind::ExpectedStringObjectProperty => {
            at(on_word, format!("the key `{word}` has no quotes")).help(format!("write \"{word}\""))
        }
        Kind::UnexpectedTokenInObject => {
            at(span, "here a key should begin, or the object end with `}`".into())
                .help("a key is a text in double quotes, then a colon: \"label\": …")
        }
        Kind::ExpectedColonAfterObjectKey => {
            at(span, "a colon is missing after this key".into()).help("write \"key\": value")
        }
        Kind::ExpectedObjectValue => {
            at(span, "the value of this key is missing".into()).help("write a value after the colon")
        }
        Kind::NonFiniteNumbersNotAllowed | Kind::UnexpectedWord | Kind::UnexpectedToken
            if is_not_finite(&word) =>
        {
            at(on_word, format!("`{word}` is not a number that JSON knows"))
                .help("leave the key out, or compute the value in an expression (a text in quotes)")
        }
        Kind::UnexpectedWord | Kind::UnexpectedToken
            if matches!(word.to_ascii_lowercase().as_str(), "true" | "false" | "null" | "none") =>
        {
            let right =
                if word.eq_ignore_ascii_case("none") { "null".into() } else { word.to_ascii_lowercase() };
            at(on_word.clone(), format!("`{word}` is written `{right}` in JSON"))
                .help(format!("write {right}"))
                .fix(on_word, right)
        }
        Kind::UnexpectedWord | Kind::UnexpectedToken if !word.is_empty() => {
            at(on_word, format!("`{word}` is neither a number nor a text in quotes"))
                .help(format!("write \"{word}\" if it is a text"))
        }
        Kind::HexadecimalNumbersNotAllowed
        | Kind::UnaryPlusNumbersNotAllowed
        | Kind::BareDecimalPointNumbersNotAllowed
        | Kind::ExpectedDigit
        | Kind::ExpectedDigitFollowingNegativeSign
        | Kind::ExpectedPlusMinusOrDigitInNumberLiteral => {
            at(on_word, format!("`{word}` is not a number as JSON writes it"))
                .help("digits before and after the point, no plus sign in front: 0.5, -2, 1e-3")
        }
        Kind::UnterminatedObject => at(opening(&span), "this object is never closed".into())
            .help("a `}` is missing, perhaps after an inner object"),
        Kind::UnterminatedArray => at(opening(&span), "this list is never closed".into())
            .help("a `]` is missing, perhaps after an inner list"),
        Kind::UnexpectedCloseBrace => at(span, "a `}` that closes nothing here".into())
            .help("delete it, or look for a `[` that is still open"),
        Kind::UnexpectedCloseBracket => at(span, "a `]` that closes nothing here".into())
            .help("delete it, or look for a `{` that is still open"),
        Kind::MultipleRootJsonValues => at(span, "text after the end of the JSON value".into())
            .why("one fence holds one object; what follows is read by nobody")
            .help("delete it, move it behind the closing ```, or look for a bracket that closes too early"),
        _ => at(span, format!("this is not JSON: {}", error.kind())).help("compare with the lines around it"),
    }
}

/// The opening bracket of a span that runs to the end of the text.
fn opening(span: &Range<usize>) -> Range<usize> {
    span.start..span.end.min(span.start + 1)
}

fn is_not_finite(word: &str) -> bool {
    matches!(word.trim_start_matches(['-', '+']), "NaN" | "Infinity" | "nan" | "inf")
}
