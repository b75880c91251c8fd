//! What is said about broken JSON: in plain words, with the change that repairs it where that is certain.

use super::parse::{Change, Kind};
use super::quoted::{quoted, rewritten};
use super::read::shorten;
use super::strings::Trouble;
use super::{MAX_DEPTH, MAX_VALUES};
use crate::finding::Finding;
use crate::rules;
use crate::source::SourceMap;
use std::ops::Range;

fn syntax(span: Range<usize>, message: impl Into<String>) -> Finding {
    Finding::new(rules::JSON_SYNTAX, span, message)
}

/// A finding about bytes of a text, at its bytes of the file. A change that would reach over what stands between
/// the lines of the text (the `> ` of a quote) is left out.
pub(super) fn place(mut finding: Finding, below: &SourceMap) -> Finding {
    finding.span = below.span(finding.span);
    for other in &mut finding.related {
        other.span = below.span(other.span.clone());
    }
    finding.fix = finding.fix.filter(|f| below.is_unbroken(f.span.clone())).map(|mut f| {
        f.span = below.span(f.span);
        f
    });
    finding
}

pub(super) fn nothing() -> Finding {
    syntax(0..0, "nothing here").help("write one JSON object: { … }")
}

pub(super) fn too_deep(at: usize) -> Finding {
    Finding::new(rules::JSON_LIMIT, at..at + 1, format!("more than {MAX_DEPTH} brackets inside each other"))
        .help("a lab needs about eight; look for a bracket that is not closed")
}

pub(super) fn too_many(at: usize) -> Finding {
    Finding::new(rules::JSON_LIMIT, at..at + 1, format!("more than {MAX_VALUES} values in one JSON text"))
        .help("split it into several labs")
}

// Commas and colons.

pub(super) fn missing_comma(at: usize) -> Finding {
    syntax(at..at, "a comma is missing here")
        .help("write `,` between two items of a list or two keys of an object")
        .fix(at..at, ",")
}

pub(super) fn trailing_comma(at: usize) -> Finding {
    syntax(at..at + 1, "a comma before a closing bracket")
        .help("delete this comma; JSON wants commas only between items")
        .fix(at..at + 1, "")
}

pub(super) fn extra_comma(at: usize, first: bool) -> Finding {
    let message = if first { "a comma without a value before it" } else { "a comma too many" };
    syntax(at..at + 1, message)
        .help("delete this comma, or write the value that is missing")
        .fix(at..at + 1, "")
}

pub(super) fn semicolon(at: usize) -> Finding {
    syntax(at..at + 1, "a semicolon where JSON needs a comma").help("write `,`").fix(at..at + 1, ",")
}

pub(super) fn decimal_comma(at: usize) -> Finding {
    syntax(at..at + 1, "a number with a comma")
        .help("JSON writes decimals with a point: 0.5")
        .fix(at..at + 1, ".")
}

pub(super) fn colon_missing(at: usize) -> Finding {
    syntax(at..at, "a colon is missing after this key").help("write \"key\": value").fix(at..at, ":")
}

pub(super) fn not_a_colon(span: Range<usize>) -> Finding {
    syntax(span.clone(), "an equals sign where JSON needs a colon")
        .help("write \"key\": value")
        .fix(span, ":")
}

pub(super) fn second_colon(span: Range<usize>) -> Finding {
    syntax(span.clone(), "one colon is enough").help("write \"key\": value").fix(span, "")
}

pub(super) fn value_missing(key: Range<usize>, colon: bool) -> Finding {
    let help =
        if colon { "write a value after the colon" } else { "write a colon and a value after the key" };
    syntax(key, "the value of this key is missing").help(help)
}

pub(super) fn key_missing(at: usize) -> Finding {
    syntax(at..at + 1, "here a key should begin, or the object end with `}`")
        .help("a key is a text in double quotes, then a colon: \"label\": …")
}

// Brackets.

pub(super) fn opening_missing(at: usize) -> Finding {
    syntax(at..at, "the opening `{` is missing").help("write `{` here").fix(at..at, "{")
}

/// What is open at the end of the text.
pub(super) fn unclosed(open: &[(char, usize)], end: usize) -> Finding {
    let Some((innermost, at)) = open.last().copied() else { return nothing() };
    let closing: String = open.iter().rev().map(|(c, _)| if *c == '{' { '}' } else { ']' }).collect();
    let what = if innermost == '{' { "object" } else { "list" };
    let finding =
        syntax(at..at + 1, format!("this {what} is never closed")).related(end..end, "the text ends here");
    let one = closing.chars().next().unwrap_or('}');
    let finding = match closing.len() {
        1 => finding.help(format!("write `{one}` where it ends")),
        n => finding
            .help(format!("write `{one}` where it ends; {n} brackets are open at the end: `{closing}`")),
    };
    finding.fix(end..end, closing)
}

pub(super) fn stray_bracket(bracket: char, at: usize) -> Finding {
    let open = if bracket == '}' { '{' } else { '[' };
    syntax(at..at + 1, format!("a `{bracket}` that closes nothing here"))
        .help(format!("delete it, or look for a `{open}` that is missing"))
        .fix(at..at + 1, "")
}

pub(super) fn stray_quote(at: usize) -> Finding {
    syntax(at..at + 1, "a `\"` that begins no text").help("delete it").fix(at..at + 1, "")
}

pub(super) fn other_bracket(mine: char, found: char, at: usize) -> Finding {
    let what = if mine == '}' { "an object" } else { "a list" };
    syntax(at..at + 1, format!("`{found}` where {what} ends"))
        .help(format!("write `{mine}`"))
        .fix(at..at + 1, mine)
}

/// `end` is behind the last value, `at` is the bracket that closes what is around it.
pub(super) fn missing_bracket(mine: char, found: char, end: usize, at: usize) -> Finding {
    syntax(end..end, format!("a `{mine}` is missing here"))
        .related(at..at + 1, format!("this `{found}` closes what is around it"))
        .help(format!("write `{mine}`"))
        .fix(end..end, mine)
}

/// A list that ends at `end` without its bracket: a key follows.
pub(super) fn list_goes_on(end: usize, key: usize) -> Finding {
    syntax(end..end, "a `]` is missing here")
        .related(key..key + 1, "here a key begins, which cannot stand in a list")
        .help("write `]`")
        .fix(end..end, "]")
}

pub(super) fn behind(rest: Range<usize>, text: &str) -> Finding {
    let shown = text.get(rest.clone()).unwrap_or("");
    let line = rest.start + shown.find(['\n', '\r']).unwrap_or(shown.len());
    if shown.chars().all(|c| matches!(c, '}' | ']') || c.is_whitespace()) {
        let first = shown.chars().next().unwrap_or('}');
        return syntax(rest.clone(), format!("a `{first}` that closes nothing here"))
            .help("delete it, or look for a bracket that closes too early")
            .fix(rest, "");
    }
    syntax(rest.start..line, "text after the end of the JSON value")
        .why("one fence holds one object; what follows is read by nobody")
        .help("delete it, move it behind the closing ```, or look for a bracket that closes too early")
}

// Words and numbers.

pub(super) fn comment(span: Range<usize>) -> Finding {
    syntax(span.clone(), "JSON has no comments")
        .help("delete it, or say it in the text around the fence")
        .fix(span, "")
}

pub(super) fn bare_key(span: Range<usize>, text: &str) -> Finding {
    let word = text.get(span.clone()).unwrap_or("");
    syntax(span.clone(), format!("the key `{}` has no quotes", shorten(word)))
        .help(format!("write \"{}\"", shorten(word)))
        .fix(span, quoted(word))
}

pub(super) fn misspelt_word(span: Range<usize>, word: &str, right: &str) -> Finding {
    syntax(span.clone(), format!("`{word}` is written `{right}` in JSON"))
        .help(format!("write {right}"))
        .fix(span, right)
}

pub(super) fn not_finite(span: Range<usize>, word: &str) -> Finding {
    syntax(span, format!("`{word}` is not a number that JSON knows"))
        .help("leave the key out, or compute the value in an expression (a text in quotes)")
}

pub(super) fn too_large(span: Range<usize>) -> Finding {
    syntax(span, "this number is too large to compute with").help("the largest is about 1.8e308")
}

pub(super) fn number_form(span: Range<usize>, token: &str, right: Option<&str>) -> Finding {
    let finding = match token.trim().is_empty() {
        true => syntax(span.clone(), "a number is missing here"),
        false => syntax(span.clone(), format!("`{}` is not a number as JSON writes it", shorten(token))),
    };
    match right {
        Some(right) => finding.help(format!("write {right}")).fix(span, right),
        None => finding.help("digits before and after the point, nothing else: 0.5, -2, 1e-3; a unit has a key of its own, a text has quotes"),
    }
}

pub(super) fn bare_text(span: Range<usize>, word: &str) -> Finding {
    syntax(span.clone(), format!("`{}` is neither a number nor a text in quotes", shorten(word)))
        .help(format!("write {} if it is a text", shorten(&quoted(word))))
        .fix(span, quoted(word))
}

pub(super) fn not_json(span: Range<usize>, text: &str) -> Finding {
    syntax(span, format!("`{}` is neither a number nor a text in quotes", shorten(text)))
        .help("JSON does not compute: write the result, or put quotes around a text")
}

pub(super) fn stray(span: Range<usize>, text: &str) -> Finding {
    let shown = shorten(text.get(span.clone()).unwrap_or(""));
    syntax(span, format!("`{shown}` does not belong here"))
        .help("delete it, or look for quotes, a comma or a bracket that is missing before it")
}

// Texts.

/// A text from the quote at `open` to `end`, where its closing quote is missing.
pub(super) fn string_open(open: usize, end: usize, last: bool, fixed: bool) -> Finding {
    let finding = if last {
        syntax(open..open + 1, "this string is never closed")
    } else {
        syntax(open..end, "this string is not closed").why("a JSON string ends on the line it begins on")
    };
    let finding = finding.help("close it with `\"`");
    if fixed { finding.fix(end..end, "\"") } else { finding }
}

pub(super) fn line_breaks(lines: &[Change], text: &str) -> Finding {
    let Some((first, _)) = lines.first() else { return nothing() };
    let message = match lines.len() {
        1 => "a line break inside of a text".to_string(),
        n => format!("{n} line breaks inside of a text"),
    };
    let finding = syntax(first.clone(), message)
        .why("a JSON string ends on the line it begins on")
        .help("write the text on one line, with `\\n` where it breaks");
    match rewritten(&lines.iter().collect::<Vec<_>>(), text) {
        Some((span, right)) => finding.fix(span, right),
        None => finding,
    }
}

pub(super) fn in_string(span: Range<usize>, trouble: Trouble) -> Finding {
    let slash = span.start..span.start + 1;
    match trouble {
        Trouble::Escape('\\') => syntax(slash.clone(), "a backslash that escapes nothing")
            .help("write `\\\\` for a backslash")
            .fix(slash, "\\\\"),
        Trouble::Escape(c) => syntax(span, format!("`\\{c}` is not an escape of JSON"))
            .why("in JSON a backslash starts an escape, so LaTeX needs two: `\\\\tau`")
            .help(format!("write `\\\\{c}` for a backslash"))
            .fix(slash, "\\\\"),
        Trouble::Needless(c) => syntax(span.clone(), format!("`\\{c}` is not an escape of JSON"))
            .help(format!("write {c} without a backslash"))
            .fix(span, c),
        Trouble::Half => syntax(span, "a `\\u` escape in this text is not a character")
            .help("write the character itself: JSON is UTF-8"),
        Trouble::Control(c) => {
            syntax(span.clone(), format!("a control character (U+{:04X}) inside a string", c as u32))
                .help(if c == '\t' { "write `\\t`, or a space" } else { "delete it" })
                .fix(span, if c == '\t' { "\\t" } else { "" })
        }
        // Told for the whole text at once, see below.
        Trouble::Line => syntax(span, "a line break inside of a text"),
        Trouble::Quote => syntax(span, "a double quote inside of a text"),
        Trouble::Joined => syntax(span.clone(), "a line break inside of a text")
            .why("a JSON string ends on the line it begins on; a backslash does not continue it")
            .help("write the text on one line")
            .fix(span, ""),
    }
}

/// Double quotes within one text.
pub(super) fn inner_quotes(quotes: &[Change], text: &str) -> Finding {
    let Some((first, _)) = quotes.first() else { return nothing() };
    let message = match quotes.len() {
        1 => "a double quote inside of a text".to_string(),
        n => format!("{n} double quotes inside of a text"),
    };
    let finding = syntax(first.clone(), message)
        .why("a double quote ends the text, and what follows is no JSON")
        .help("write `\\\"`, or single quotes: they are fine inside a text");
    match rewritten(&quotes.iter().collect::<Vec<_>>(), text) {
        Some((span, right)) => finding.fix(span, right),
        None => finding,
    }
}

// What comes in crowds.

/// One finding for all mistakes of a kind; one for each where one change cannot repair them all.
pub(super) fn together(kind: Kind, list: &[Vec<Change>], text: &str, below: &SourceMap) -> Vec<Finding> {
    let all: Vec<&Change> = list.iter().flatten().collect();
    let Some((region, right)) = rewritten(&all, text) else { return Vec::new() };
    if below.is_unbroken(region.clone()) || list.len() == 1 {
        let count = match kind {
            Kind::Typographic => all.iter().filter(|(_, right)| right == "\"").count(),
            _ => list.len(),
        };
        let mut finding = crowd(kind, count, first(list, text), text).fix(region, right);
        if let Some((last, _)) = all.last().filter(|_| count > 1) {
            finding = finding.related(last.clone(), "the last one");
        }
        return vec![finding];
    }
    let each = |changes: &Vec<Change>| {
        let (region, right) = rewritten(&changes.iter().collect::<Vec<_>>(), text)?;
        let count = if kind == Kind::Typographic { changes.len() } else { 1 };
        let at = first(std::slice::from_ref(changes), text);
        Some(crowd(kind, count, at, text).fix(region, right))
    };
    list.iter().take(super::MAX_MISTAKES).filter_map(each).collect()
}

/// The place of the first mistake.
fn first(list: &[Vec<Change>], text: &str) -> Range<usize> {
    let span = list.first().and_then(|c| c.first()).map_or(0..0, |(span, _)| span.clone());
    let length = text.get(span.start..).and_then(|t| t.chars().next()).map_or(0, char::len_utf8);
    span.start..span.start + length
}

fn crowd(kind: Kind, count: usize, span: Range<usize>, text: &str) -> Finding {
    let s = if count == 1 { "" } else { "s" };
    let c = text.get(span.clone()).and_then(|t| t.chars().next()).unwrap_or(' ');
    match kind {
        Kind::Typographic => {
            Finding::new(rules::TYPOGRAPHIC_QUOTE, span, format!("{count} typographic quote{s} where JSON needs \""))
                .help("write straight quotes: \"model\": \"…\"; here they were read as straight ones, so the rest is checked")
        }
        Kind::Single => {
            let (which, message) = if c == '`' { ("backticks", "a backtick") } else { ("single quotes", "a single quote") };
            let message = match count {
                1 => format!("{message} where JSON needs a double quote"),
                n => format!("{n} texts in {which} where JSON needs double quotes"),
            };
            syntax(span, message).help("write \"…\" around keys and texts; single quotes are fine inside a text")
        }
        Kind::Invisible => {
            let message = match count {
                1 => format!("an invisible character (U+{:04X}) between values", c as u32),
                n => format!("invisible characters (such as U+{:04X}) between values, at {n} places", c as u32),
            };
            syntax(span, message)
                .help("delete it and type an ordinary space; it often comes from copying out of a web page")
        }
    }
}
