//! What is checked before the JSON parser may run: nesting, size, control characters, stray spaces.
//!
//! One pass over the bytes that only knows strings and brackets. It exists because the parser recurses (depth
//! must be bounded first) and because it accepts three things that `JSON.parse` does not.

use super::{MAX_DEPTH, MAX_VALUES};
use crate::finding::Finding;
use crate::lint::rules::json::{LIMIT, SYNTAX};

/// The first reason not to parse `text`, with its place in `text`.
pub(super) fn check(text: &str) -> Option<Finding> {
    let (mut depth, mut values) = (0usize, 0usize);
    let mut chars = text.char_indices().peekable();
    while let Some((at, c)) = chars.next() {
        match c {
            '"' => {
                if let Some(problem) = string(text, at, &mut chars) {
                    return Some(problem);
                }
            }
            '{' | '[' => {
                depth += 1;
                if depth > MAX_DEPTH {
                    return Some(
                        Finding::new(
                            &LIMIT,
                            at..at + 1,
                            format!("more than {MAX_DEPTH} brackets inside each other"),
                        )
                        .help("a lab needs about eight; look for a bracket that is not closed"),
                    );
                }
            }
            '}' | ']' => depth = depth.saturating_sub(1),
            ',' | ':' => {
                values += 1;
                if values > MAX_VALUES {
                    return Some(
                        Finding::new(
                            &LIMIT,
                            at..at + 1,
                            format!("more than {MAX_VALUES} values in one JSON text"),
                        )
                        .help("split it into several labs"),
                    );
                }
            }
            ' ' | '\t' | '\n' | '\r' => {}
            '\'' => {
                return Some(
                    Finding::new(&SYNTAX, at..at + 1, "a single quote where JSON needs a double quote")
                        .help("write \"…\" around keys and texts; single quotes are fine inside a text"),
                );
            }
            '#' => return Some(comment(at..at + 1)),
            '/' if matches!(chars.peek(), Some((_, '/' | '*'))) => return Some(comment(at..at + 2)),
            // Invisible, and a space to some programs: the author cannot see what is wrong.
            _ if c.is_whitespace() || c.is_control() || c == '\u{feff}' => {
                let end = at + c.len_utf8();
                return Some(
                    Finding::new(
                        &SYNTAX,
                        at..end,
                        format!("an invisible character (U+{:04X}) between values", c as u32),
                    )
                    .help(
                        "delete it and type an ordinary space; it often comes from copying out of a web page",
                    )
                    .fix(at..end, " "),
                );
            }
            _ => {}
        }
    }
    None
}

fn comment(span: std::ops::Range<usize>) -> Finding {
    Finding::new(&SYNTAX, span, "JSON has no comments")
        .help("delete it, or say it in the text around the fence")
}

/// Walks over a string whose opening quote stands at `open`.
fn string(
    text: &str,
    open: usize,
    chars: &mut std::iter::Peekable<std::str::CharIndices<'_>>,
) -> Option<Finding> {
    while let Some((at, c)) = chars.next() {
        match c {
            '"' => return None,
            '\\' => {
                if let Some((at, escape)) = chars.next()
                    && !matches!(escape, '"' | '\\' | '/' | 'b' | 'f' | 'n' | 'r' | 't' | 'u')
                {
                    let slash = at - 1;
                    return Some(
                        Finding::new(
                            &SYNTAX,
                            slash..at + escape.len_utf8(),
                            format!("`\\{escape}` is not an escape of JSON"),
                        )
                        .why("in JSON a backslash starts an escape, so LaTeX needs two: `\\\\tau`")
                        .help(format!("write `\\\\{escape}` for a backslash"))
                        .fix(slash..at, "\\\\"),
                    );
                }
            }
            '\n' | '\r' => {
                let rest = text.get(at..).unwrap_or("");
                let closes_later = rest.contains('"');
                return Some(
                    Finding::new(&SYNTAX, open..at, "this string is not closed on its line")
                        .why(if closes_later {
                            "a JSON string ends on the line it begins on, so everything up to the next `\"` would be read as text"
                        } else {
                            "a JSON string ends on the line it begins on"
                        })
                        .help("close it with `\"`, or write `\\n` where the text breaks"),
                );
            }
            '\u{0}'..='\u{1f}' => {
                return Some(
                    Finding::new(
                        &SYNTAX,
                        at..at + 1,
                        format!("a control character (U+{:04X}) inside a string", c as u32),
                    )
                    .help(if c == '\t' { "write `\\t`, or a space" } else { "delete it" })
                    .fix(at..at + 1, if c == '\t' { "\\t" } else { "" }),
                );
            }
            _ => {}
        }
    }
    Some(
        Finding::new(&SYNTAX, open..text.len().min(open + 1), "this string is never closed")
            .help("close it with `\"`"),
    )
}
