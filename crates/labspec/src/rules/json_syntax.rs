//! Messages about JSON syntax for readers who do not know what a token is. `json/` decides what is broken, and which change repairs
//! it.

use crate::json::read::shorten;
use crate::json::{Mistake, Problem, literal};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// The JSON of a block is invalid.
pub const JSON_SYNTAX: &Rule = &Rule {
    code: "json-syntax",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Json,
    summary: "the JSON of a block is invalid",
    why: "the page parses the block as a whole, so one wrong character removes the whole lab or quiz",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": 2⟦⟧ "dock": true}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2, "dock": true}"#),
};

/// The texts about a problem: message, reason, help, and the description of the related place.
struct MessageParts {
    message: String,
    why: &'static str,
    help: String,
    related: String,
}

/// A message with a help text.
fn message_with_help(message: impl Into<String>, help: impl Into<String>) -> MessageParts {
    MessageParts { message: message.into(), why: "", help: help.into(), related: String::new() }
}

impl MessageParts {
    fn why(self, why: &'static str) -> MessageParts {
        MessageParts { why, ..self }
    }

    fn related(self, label: impl Into<String>) -> MessageParts {
        MessageParts { related: label.into(), ..self }
    }
}

/// Describes a mistake that no other rule reports.
pub(crate) fn describe_problem(problem: &Problem) -> Finding {
    let MessageParts { message, why, help, related } = describe(&problem.mistake);
    let mut finding = Finding::new(JSON_SYNTAX, problem.span.clone(), message).help(help);
    if !why.is_empty() {
        finding = finding.why(why);
    }
    match &problem.related {
        Some(span) => finding.related(span.clone(), related),
        None => finding,
    }
}

/// Reports a fence without content.
pub(crate) fn empty_fence(span: Range<usize>) -> Finding {
    Finding::new(JSON_SYNTAX, span, "this fence is empty")
        .help("write one JSON object between the two ``` lines: { … }")
}

/// The reason why a string must end on its line.
const ONE_LINE: &str = "a JSON string must end on the line where it begins";

/// The texts about a mistake. Each group of mistakes has its own function.
fn describe(mistake: &Mistake) -> MessageParts {
    let groups = [describe_separator, describe_bracket, describe_literal, describe_string, describe_quotes];
    if let Mistake::Nothing = mistake {
        return message_with_help("there is no JSON here", "write one JSON object: { … }");
    }
    let parts = groups.iter().find_map(|describe| describe(mistake));
    debug_assert!(parts.is_some(), "each mistake belongs to a group: {mistake:?}");
    parts.unwrap_or_else(|| message_with_help("this is not JSON", "correct it, or delete it"))
}

/// Describes commas and colons, and keys without a value.
fn describe_separator(mistake: &Mistake) -> Option<MessageParts> {
    Some(match mistake {
        Mistake::CommaMissing => message_with_help(
            "a comma is missing here",
            "write `,` between two items of a list or two keys of an object",
        ),
        Mistake::TrailingComma => message_with_help(
            "a comma is before a closing bracket",
            "delete this comma: JSON allows commas only between items",
        ),
        Mistake::ExtraComma { first } => message_with_help(
            if *first { "a comma has no value before it" } else { "there is an extra comma" },
            "delete this comma, or write the missing value",
        ),
        Mistake::Semicolon => message_with_help("a semicolon is used where JSON needs a comma", "write `,`"),
        Mistake::DecimalComma(right) => {
            message_with_help("a number has a decimal comma", format!("write decimals with a point: {right}"))
        }
        Mistake::ColonMissing => {
            message_with_help("a colon is missing after this key", "write \"key\": value")
        }
        Mistake::Equals => {
            message_with_help("an equals sign is used where JSON needs a colon", "write \"key\": value")
        }
        Mistake::SecondColon => message_with_help("there is an extra colon", "write \"key\": value"),
        Mistake::ValueMissing { colon } => message_with_help(
            "the value of this key is missing",
            match colon {
                true => "write a value after the colon",
                false => "write a colon and a value after the key",
            },
        ),
        Mistake::KeyMissing => message_with_help(
            "a key or the closing `}` of the object must follow here",
            "write a key as a text in double quotes, then a colon: \"label\": …",
        ),
        _ => return None,
    })
}

/// Describes brackets.
fn describe_bracket(mistake: &Mistake) -> Option<MessageParts> {
    Some(match mistake {
        Mistake::OpeningMissing => message_with_help("the opening `{` is missing", "write `{` here"),
        Mistake::Unclosed { open, closing } => {
            let what = if *open == '{' { "object" } else { "list" };
            let one = closing.chars().next().unwrap_or('}');
            let help = match closing.len() {
                1 => format!("write `{one}` where it ends"),
                n => format!(
                    "write `{one}` where it ends; {n} brackets are still open at the end: `{closing}`"
                ),
            };
            message_with_help(format!("this {what} is not closed"), help).related("the text ends here")
        }
        Mistake::StrayBracket(bracket) => {
            let open = if *bracket == '}' { '{' } else { '[' };
            message_with_help(
                format!("this `{bracket}` closes nothing"),
                format!("delete it, or look for a missing `{open}`"),
            )
        }
        Mistake::StrayBrackets(first) => message_with_help(
            format!("this `{first}` closes nothing"),
            "delete it, or look for a bracket that closes too early",
        ),
        Mistake::StrayQuote => message_with_help("this `\"` does not begin a string", "delete it"),
        Mistake::OtherBracket { expected, found } => {
            let what = if *expected == '}' { "an object" } else { "a list" };
            message_with_help(format!("`{found}` is used where {what} ends"), format!("write `{expected}`"))
        }
        Mistake::BracketMissing { expected, found } => {
            message_with_help(format!("a `{expected}` is missing here"), format!("write `{expected}`"))
                .related(match found {
                    '{' => "the next item of the list begins here".to_string(),
                    found => format!("this `{found}` closes the outer bracket"),
                })
        }
        Mistake::ListGoesOn => message_with_help("a `]` is missing here", "write `]`")
            .related("a key begins here, which a list cannot contain"),
        Mistake::Behind => message_with_help(
            "there is text after the end of the JSON value",
            "delete it, move it after the closing ```, or look for a bracket that closes too early",
        )
        .why("one fence holds one object, so the rest is ignored"),
        _ => return None,
    })
}

/// Describes tokens in the place of a value or a key: comments, words, numbers in another notation.
fn describe_literal(mistake: &Mistake) -> Option<MessageParts> {
    Some(match mistake {
        Mistake::Comment => {
            message_with_help("JSON has no comments", "delete it, or write it in the text around the fence")
        }
        Mistake::BareKey(word) => message_with_help(
            format!("the key `{}` has no quotes", shorten(word)),
            format!("write \"{}\"", shorten(word)),
        ),
        Mistake::Word { word, right } => {
            message_with_help(format!("`{word}` must be written `{right}` in JSON"), format!("write {right}"))
        }
        Mistake::NotFinite(word) => message_with_help(
            format!("JSON has no number `{word}`"),
            "delete the key, or compute the value in an expression (a text in quotes)",
        ),
        Mistake::TooLarge => {
            message_with_help("this number is too large", "use a number below 1.8e308")
        }
        Mistake::NumberForm { token, right } => message_with_help(
            match token.trim().is_empty() {
                true => "a number is missing here".to_string(),
                false => format!("`{}` is not a JSON number", shorten(token)),
            },
            match right {
                Some(right) => format!("write {right}"),
                None if literal::number_before_unit(token).is_some() => format!(
                    "write {}, and put the unit into its own key or leave it out",
                    literal::number_before_unit(token).unwrap_or("")
                ),
                None => "write digits before and after the point, nothing else: 0.5, -2, 1e-3; put a unit into its own key, a text into quotes".to_string(),
            },
        ),
        Mistake::BareText(word) => message_with_help(
            format!("`{}` is neither a number nor a text in quotes", shorten(word)),
            format!("write {} if it is a text", shorten(&format!("\"{}\"", crate::json::encode(word)))),
        ),
        Mistake::NotJson(text) => message_with_help(
            format!("`{}` is neither a number nor a text in quotes", shorten(text)),
            "write the result, because JSON does not compute, or put quotes around a text",
        ),
        Mistake::Stray(text) => message_with_help(
            format!("`{}` does not belong here", shorten(text)),
            "delete it, or look for a missing quote, comma or bracket before it",
        ),
        _ => return None,
    })
}

/// Describes the content of strings.
fn describe_string(mistake: &Mistake) -> Option<MessageParts> {
    Some(match mistake {
        Mistake::StringOpen { last: true } => {
            message_with_help("this string is not closed", "close it with `\"`")
        }
        Mistake::StringOpen { last: false } => {
            message_with_help("this string is not closed", "close it with `\"`").why(ONE_LINE)
        }
        Mistake::LineBreaks(count) => message_with_help(
            match count {
                1 => "a text contains a line break".to_string(),
                n => format!("a text contains {n} line breaks"),
            },
            "write the text on one line, with `\\n` where it breaks",
        )
        .why(ONE_LINE),
        Mistake::Escape('\\') => message_with_help(
            "this backslash is not followed by an escape character",
            "write `\\\\` for a backslash",
        ),
        Mistake::Escape(c) => message_with_help(
            format!("`\\{c}` is not a JSON escape"),
            format!("write `\\\\{c}` for a backslash"),
        )
        .why("in JSON a backslash starts an escape, so LaTeX needs two: `\\\\tau`"),
        Mistake::NeedlessEscape(c) => message_with_help(
            format!("`\\{c}` is not a JSON escape"),
            format!("write {c} without a backslash"),
        ),
        Mistake::HalfPair => message_with_help(
            "a `\\u` escape in this text is not a valid character",
            "write the character itself: JSON is UTF-8",
        ),
        Mistake::Control(c) => message_with_help(
            format!("a string contains a control character (U+{:04X})", u32::from(*c)),
            if *c == '\t' { "write `\\t`, or a space" } else { "delete it" },
        ),
        Mistake::JoinedLines => {
            message_with_help("a text contains a line break", "write the text on one line")
                .why("a JSON string must end on the line where it begins; a backslash does not continue it")
        }
        _ => return None,
    })
}

/// Describes other kinds of quotes, and invisible characters.
fn describe_quotes(mistake: &Mistake) -> Option<MessageParts> {
    Some(match mistake {
        Mistake::InnerQuotes(count) => message_with_help(
            match count {
                1 => "a text contains a double quote".to_string(),
                n => format!("a text contains {n} double quotes"),
            },
            "write `\\\"`, or single quotes, which a text may contain",
        )
        .why("a double quote ends the text, and what follows is not JSON"),
        Mistake::SingleQuotes { quote, count } => {
            let (which, one) = match quote {
                '`' => ("backticks", "a backtick"),
                _ => ("single quotes", "a single quote"),
            };
            message_with_help(
                match count {
                    1 => format!("JSON has {one} where it needs a double quote"),
                    n => format!("JSON has {n} texts in {which} where it needs double quotes"),
                },
                "write \"…\" around keys and texts; a text may contain single quotes",
            )
            .related("the last one")
        }
        Mistake::Invisible { first, count } => message_with_help(
            match count {
                1 => format!("an invisible character (U+{:04X}) is between values", u32::from(*first)),
                n => format!(
                    "invisible characters (such as U+{:04X}) are between values in {n} places",
                    u32::from(*first)
                ),
            },
            "delete it and type an ordinary space; it often comes from copying a web page",
        )
        .related("the last one"),
        _ => return None,
    })
}
