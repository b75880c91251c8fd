//! What is said about broken JSON, in the words of a person who does not know what a token is. What is broken, and which change
//! repairs it, is decided in `json/`.

use crate::finding::Finding;
use crate::json::read::shorten;
use crate::json::{MAX_DEPTH, MAX_VALUES, Mistake, Problem};
use crate::rules;

/// What is said about a problem: message, reason, help, and what the other place is.
struct Words {
    message: String,
    why: &'static str,
    help: String,
    related: String,
}

/// A message with what to do.
fn message_with_help(message: impl Into<String>, help: impl Into<String>) -> Words {
    Words { message: message.into(), why: "", help: help.into(), related: String::new() }
}

impl Words {
    fn why(self, why: &'static str) -> Words {
        Words { why, ..self }
    }

    fn related(self, label: impl Into<String>) -> Words {
        Words { related: label.into(), ..self }
    }
}

/// What is said about broken JSON.
pub(crate) fn to_finding(problem: &Problem) -> Finding {
    let rule = match &problem.mistake {
        Mistake::TooDeep | Mistake::TooMany => rules::JSON_LIMIT,
        Mistake::Twice(_) => rules::DUPLICATE_KEY,
        Mistake::Typographic(_) => rules::TYPOGRAPHIC_QUOTE,
        _ => rules::JSON_SYNTAX,
    };
    let Words { message, why, help, related } = describe(&problem.mistake);
    let mut finding = Finding::new(rule, problem.span.clone(), message).help(help);
    if !why.is_empty() {
        finding = finding.why(why);
    }
    if let Some(span) = &problem.related {
        finding = finding.related(span.clone(), related);
    }
    match &problem.repair {
        Some((span, text)) => finding.fix(span.clone(), text.clone()),
        None => finding,
    }
}

fn describe(mistake: &Mistake) -> Words {
    const ONE_LINE: &str = "a JSON string ends on the line it begins on";
    match mistake {
        Mistake::Nothing => message_with_help("nothing here", "write one JSON object: { … }"),
        Mistake::TooDeep => message_with_help(
            format!("more than {MAX_DEPTH} brackets inside each other"),
            "a lab needs about eight; look for a bracket that is not closed",
        ),
        Mistake::TooMany => {
            message_with_help(format!("more than {MAX_VALUES} values in one JSON text"), "split it into several labs")
        }
        Mistake::Twice(key) => {
            let key = if key.is_empty() { "a key without a name".into() } else { format!("`{}`", shorten(key)) };
            message_with_help(format!("{key} is written twice in one object"), "keep one of the two")
                .related("the first one, which is ignored")
        }

        Mistake::CommaMissing => message_with_help(
            "a comma is missing here",
            "write `,` between two items of a list or two keys of an object",
        ),
        Mistake::TrailingComma => message_with_help(
            "a comma before a closing bracket",
            "delete this comma; JSON wants commas only between items",
        ),
        Mistake::ExtraComma { first } => message_with_help(
            if *first { "a comma without a value before it" } else { "a comma too many" },
            "delete this comma, or write the value that is missing",
        ),
        Mistake::Semicolon => message_with_help("a semicolon where JSON needs a comma", "write `,`"),
        Mistake::DecimalComma => {
            message_with_help("a number with a comma", "JSON writes decimals with a point: 0.5")
        }
        Mistake::ColonMissing => message_with_help("a colon is missing after this key", "write \"key\": value"),
        Mistake::Equals => message_with_help("an equals sign where JSON needs a colon", "write \"key\": value"),
        Mistake::SecondColon => message_with_help("one colon is enough", "write \"key\": value"),
        Mistake::ValueMissing { colon } => message_with_help(
            "the value of this key is missing",
            match colon {
                true => "write a value after the colon",
                false => "write a colon and a value after the key",
            },
        ),
        Mistake::KeyMissing => message_with_help(
            "here a key should begin, or the object end with `}`",
            "a key is a text in double quotes, then a colon: \"label\": …",
        ),

        Mistake::OpeningMissing => message_with_help("the opening `{` is missing", "write `{` here"),
        Mistake::Unclosed { open, closing } => {
            let what = if *open == '{' { "object" } else { "list" };
            let one = closing.chars().next().unwrap_or('}');
            let help = match closing.len() {
                1 => format!("write `{one}` where it ends"),
                n => format!("write `{one}` where it ends; {n} brackets are open at the end: `{closing}`"),
            };
            message_with_help(format!("this {what} is never closed"), help).related("the text ends here")
        }
        Mistake::StrayBracket(bracket) => {
            let open = if *bracket == '}' { '{' } else { '[' };
            message_with_help(
                format!("a `{bracket}` that closes nothing here"),
                format!("delete it, or look for a `{open}` that is missing"),
            )
        }
        Mistake::StrayBrackets(first) => message_with_help(
            format!("a `{first}` that closes nothing here"),
            "delete it, or look for a bracket that closes too early",
        ),
        Mistake::StrayQuote => message_with_help("a `\"` that begins no text", "delete it"),
        Mistake::OtherBracket { mine, found } => {
            let what = if *mine == '}' { "an object" } else { "a list" };
            message_with_help(format!("`{found}` where {what} ends"), format!("write `{mine}`"))
        }
        Mistake::BracketMissing { mine, found } => {
            message_with_help(format!("a `{mine}` is missing here"), format!("write `{mine}`"))
                .related(format!("this `{found}` closes what is around it"))
        }
        Mistake::ListGoesOn => message_with_help("a `]` is missing here", "write `]`")
            .related("here a key begins, which cannot stand in a list"),
        Mistake::Behind => message_with_help(
            "text after the end of the JSON value",
            "delete it, move it behind the closing ```, or look for a bracket that closes too early",
        )
        .why("one fence holds one object; what follows is read by nobody"),

        Mistake::Comment => {
            message_with_help("JSON has no comments", "delete it, or say it in the text around the fence")
        }
        Mistake::BareKey(word) => message_with_help(
            format!("the key `{}` has no quotes", shorten(word)),
            format!("write \"{}\"", shorten(word)),
        ),
        Mistake::Word { word, right } => {
            message_with_help(format!("`{word}` is written `{right}` in JSON"), format!("write {right}"))
        }
        Mistake::NotFinite(word) => message_with_help(
            format!("`{word}` is not a number that JSON knows"),
            "leave the key out, or compute the value in an expression (a text in quotes)",
        ),
        Mistake::TooLarge => {
            message_with_help("this number is too large to compute with", "the largest is about 1.8e308")
        }
        Mistake::NumberForm { token, right } => message_with_help(
            match token.trim().is_empty() {
                true => "a number is missing here".to_string(),
                false => format!("`{}` is not a number as JSON writes it", shorten(token)),
            },
            match right {
                Some(right) => format!("write {right}"),
                None => "digits before and after the point, nothing else: 0.5, -2, 1e-3; a unit has a key of its own, a text has quotes".to_string(),
            },
        ),
        Mistake::BareText(word) => message_with_help(
            format!("`{}` is neither a number nor a text in quotes", shorten(word)),
            format!("write {} if it is a text", shorten(&format!("\"{}\"", crate::json::encode(word)))),
        ),
        Mistake::NotJson(text) => message_with_help(
            format!("`{}` is neither a number nor a text in quotes", shorten(text)),
            "JSON does not compute: write the result, or put quotes around a text",
        ),
        Mistake::Stray(text) => message_with_help(
            format!("`{}` does not belong here", shorten(text)),
            "delete it, or look for quotes, a comma or a bracket that is missing before it",
        ),

        Mistake::StringOpen { last: true } => {
            message_with_help("this string is never closed", "close it with `\"`")
        }
        Mistake::StringOpen { last: false } => {
            message_with_help("this string is not closed", "close it with `\"`").why(ONE_LINE)
        }
        Mistake::LineBreaks(count) => message_with_help(
            match count {
                1 => "a line break inside of a text".to_string(),
                n => format!("{n} line breaks inside of a text"),
            },
            "write the text on one line, with `\\n` where it breaks",
        )
        .why(ONE_LINE),
        Mistake::Escape('\\') => message_with_help("a backslash that escapes nothing", "write `\\\\` for a backslash"),
        Mistake::Escape(c) => message_with_help(
            format!("`\\{c}` is not an escape of JSON"),
            format!("write `\\\\{c}` for a backslash"),
        )
        .why("in JSON a backslash starts an escape, so LaTeX needs two: `\\\\tau`"),
        Mistake::NeedlessEscape(c) => message_with_help(
            format!("`\\{c}` is not an escape of JSON"),
            format!("write {c} without a backslash"),
        ),
        Mistake::HalfPair => message_with_help(
            "a `\\u` escape in this text is not a character",
            "write the character itself: JSON is UTF-8",
        ),
        Mistake::Control(c) => message_with_help(
            format!("a control character (U+{:04X}) inside a string", u32::from(*c)),
            if *c == '\t' { "write `\\t`, or a space" } else { "delete it" },
        ),
        Mistake::JoinedLines => message_with_help("a line break inside of a text", "write the text on one line")
            .why("a JSON string ends on the line it begins on; a backslash does not continue it"),
        Mistake::InnerQuotes(count) => message_with_help(
            match count {
                1 => "a double quote inside of a text".to_string(),
                n => format!("{n} double quotes inside of a text"),
            },
            "write `\\\"`, or single quotes: they are fine inside a text",
        )
        .why("a double quote ends the text, and what follows is no JSON"),
        Mistake::Typographic(count) => message_with_help(
            format!("{count} typographic quote{} where JSON needs \"", if *count == 1 { "" } else { "s" }),
            "write straight quotes: \"model\": \"…\"; here they were read as straight ones, so the rest is checked",
        )
        .related("the last one"),
        Mistake::SingleQuotes { quote, count } => {
            let (which, one) = match quote {
                '`' => ("backticks", "a backtick"),
                _ => ("single quotes", "a single quote"),
            };
            message_with_help(
                match count {
                    1 => format!("{one} where JSON needs a double quote"),
                    n => format!("{n} texts in {which} where JSON needs double quotes"),
                },
                "write \"…\" around keys and texts; single quotes are fine inside a text",
            )
            .related("the last one")
        }
        Mistake::Invisible { first, count } => message_with_help(
            match count {
                1 => format!("an invisible character (U+{:04X}) between values", u32::from(*first)),
                n => format!(
                    "invisible characters (such as U+{:04X}) between values, at {n} places",
                    u32::from(*first)
                ),
            },
            "delete it and type an ordinary space; it often comes from copying out of a web page",
        )
        .related("the last one"),
    }
}
