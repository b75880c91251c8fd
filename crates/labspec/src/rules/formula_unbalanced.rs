use super::MAX_IN_TEXT;
use crate::markdown::html::tags;
use crate::markdown::tex;
use crate::source::Text;
use crate::spec::Lesson;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A formula or a group in it is not closed.
pub const FORMULA_UNBALANCED: &Rule = &Rule {
    code: "formula-unbalanced",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a formula or a group in it is not closed",
    why: "the page shows the source of the formula, or an error in red",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Why is it ⟦$\\frac{1}{2 g t^2$⟧?"}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Why is it $\\frac{1}{2} g t^2$?"}]}"#,
    ),
};

/// The maximum length of a formula, characters.
const MAX_FORMULA: usize = 4000;
/// The maximum length of the name of an environment, bytes.
const MAX_NAME: usize = 40;

/// The delimiters of formulas. A dollar counts only where a page reads it as a delimiter.
const DELIMITERS: [(&str, &str); 4] = [("$$", "$$"), ("$", "$"), ("\\(", "\\)"), ("\\[", "\\]")];

/// The faults of a text, with their places. `plain`: escaped brackets are brackets, as in Markdown. `work` counts the characters
/// that are read: at most [`MAX_READS`] for each character of the text.
fn faults(text: &str, plain: bool, work: &mut usize) -> Vec<(Range<usize>, String)> {
    let (mut faults, mut lost) = (Vec::new(), 0);
    let mut offset = 0;
    while let Some(rest) = text.get(offset..).filter(|r| !r.is_empty()) {
        *work += 1;
        let marks = DELIMITERS.iter().filter(|(open, _)| !plain || open.starts_with('$'));
        let Some((open, close)) = marks.into_iter().find(|(open, _)| rest.starts_with(open)) else {
            let step = match rest.strip_prefix('\\').and_then(|r| r.chars().next()) {
                Some(c) => 1 + c.len_utf8(),
                None => rest.chars().next().map_or(1, char::len_utf8),
            };
            offset += step;
            continue;
        };
        let inside = rest.get(open.len()..).unwrap_or("");
        let Some(length) = closing(inside, close, work) else {
            // Each of these scans the text that follows.
            lost += 1;
            if lost > MAX_IN_TEXT {
                break;
            }
            if faults.len() < MAX_IN_TEXT && is_formula(inside, open, work) {
                faults.push((
                    offset..offset + open.len(),
                    format!("the formula that `{open}` opens is not closed"),
                ));
            }
            // The text that follows is read as prose.
            offset += open.len();
            continue;
        };
        let body = inside.get(..length).unwrap_or("");
        let whole = offset..offset + open.len() + length + close.len();
        if let Some(message) = unbalanced(body, work) {
            faults.push((whole.clone(), message));
        }
        offset = whole.end;
    }
    faults
}

/// Where a formula ends. An escaped dollar does not end it, and a dollar before a digit starts a price.
fn closing(inside: &str, close: &str, work: &mut usize) -> Option<usize> {
    let mut escaped = false;
    for (i, c) in inside.char_indices().take(MAX_FORMULA) {
        *work += 1;
        let rest = inside.get(i..)?;
        if !escaped && rest.starts_with(close) {
            let after = rest.get(close.len()..).unwrap_or("");
            let price = close == "$" && after.starts_with(|c: char| c.is_ascii_digit());
            let spaced = close == "$"
                && inside.get(..i).is_some_and(|b| b.is_empty() || b.ends_with(char::is_whitespace));
            if !price && !spaced {
                return Some(i);
            }
        }
        // An empty line ends a formula.
        if rest.starts_with("\n\n") {
            return None;
        }
        escaped = c == '\\' && !escaped;
    }
    None
}

/// Whether the text after an opening delimiter looks like a formula. A price does not.
fn is_formula(inside: &str, open: &str, work: &mut usize) -> bool {
    let end = inside.char_indices().nth(MAX_FORMULA).map_or(inside.len(), |(offset, _)| offset);
    let inside = inside.get(..end).unwrap_or("").split("\n\n").next().unwrap_or("");
    *work += end;
    // A single letter is the name of a quantity: `$g is`. A price begins with a digit; the name of a shell variable is longer.
    let letters = inside.chars().take_while(|c| c.is_alphabetic()).count();
    let tex = inside.contains(['\\', '^', '_', '{']) || letters == 1;
    open != "$" || (tex && !inside.starts_with(|c: char| c.is_whitespace()))
}

/// The maximum number of times that a character is read. Each unclosed delimiter causes one scan of the text that follows, and a
/// second one that decides whether it is a formula.
#[cfg(test)]
const MAX_READS: usize = 2 * MAX_IN_TEXT + MAX_NAME + 3;

/// Describes what a formula opens and does not close.
fn unbalanced(body: &str, work: &mut usize) -> Option<String> {
    let (mut depth, mut left) = (0_i64, 0_i64);
    let mut inner: Vec<&str> = Vec::new();
    let mut offset = 0;
    while let Some(rest) = body.get(offset..).filter(|r| !r.is_empty()) {
        let c = rest.chars().next()?;
        *work += 1;
        if c != '\\' {
            depth += i64::from(c == '{') - i64::from(c == '}');
            if depth < 0 {
                return Some("a brace `}` closes nothing".into());
            }
            offset += c.len_utf8();
            continue;
        }
        let (after, command) = tex::command(rest).ok()?;
        let name = after.starts_with('{').then(|| {
            *work += MAX_NAME.min(after.len());
            tex::group(after, MAX_NAME - 1).map(|(_, name)| name).ok()
        });
        match (command, name.flatten()) {
            ("left", _) => left += 1,
            ("right", _) => left -= 1,
            ("begin", Some(name)) => inner.push(name),
            ("end", Some(name)) if inner.pop() != Some(name) => {
                return Some(format!("`\\end{{{}}}` closes nothing", crate::json::read::shorten(name)));
            }
            _ => {}
        }
        if left < 0 {
            return Some("`\\right` has no `\\left`".into());
        }
        offset = body.len() - after.len();
    }
    match (depth, left, inner.pop()) {
        (d, ..) if d > 0 => Some("a brace `{` is not closed".into()),
        (_, l, _) if l > 0 => Some("`\\left` has no `\\right`".into()),
        (.., Some(name)) => Some(format!("`\\begin{{{}}}` is not closed", crate::json::read::shorten(name))),
        _ => None,
    }
}

/// The text with code replaced by blanks, of the same length in bytes.
fn without_code(text: &str, code: impl Iterator<Item = Range<usize>>) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for range in code {
        if let Some(part) = bytes.get_mut(range) {
            part.fill(b' ');
        }
    }
    // Only ranges between characters are replaced, so the text is still UTF-8.
    String::from_utf8(bytes).unwrap_or_default()
}

/// The ranges of code in a text of HTML.
fn code(html: &str) -> Vec<Range<usize>> {
    let (mut all, mut open) = (Vec::new(), [None, None]);
    for tag in tags(html) {
        let kind = ["code", "pre"].iter().position(|name| *name == tag.name);
        let Some(open) = kind.and_then(|i| open.get_mut(i)) else { continue };
        if !tag.closing {
            open.get_or_insert(tag.span.start);
        } else if let Some(start) = open.take() {
            all.push(start..tag.span.end);
        }
    }
    all
}

fn finding(span: Range<usize>, message: String) -> Finding {
    Finding::new(FORMULA_UNBALANCED, span, message).help("close it, or write `\\$` for a dollar sign")
}

/// Checks a text of a lab or a quiz.
pub(crate) fn check_formulas(text: &Text, findings: &mut Vec<Finding>) {
    let html = without_code(text.as_str(), code(text.as_str()).into_iter());
    let found = faults(&html, false, &mut 0).into_iter().take(MAX_IN_TEXT);
    findings.extend(found.map(|(span, message)| finding(text.span_of(span), message)));
}

/// Checks the paragraphs of a lesson.
pub(crate) fn check_prose(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let text = lesson.file.text();
    for range in lesson.scan.paragraphs.iter().take(10 * MAX_IN_TEXT) {
        let blocks = &lesson.scan.blocks;
        let next = blocks.get(blocks.partition_point(|b| b.span.end <= range.start));
        let in_block = next.is_some_and(|b| b.span.start < range.end);
        let Some(paragraph) = text.get(range.clone()).filter(|p| p.contains('$') && !in_block) else {
            continue;
        };
        let from = lesson.scan.inline_code.partition_point(|c| c.start < range.start);
        let code_spans = lesson.scan.inline_code.iter().skip(from).take_while(|c| c.end <= range.end);
        let code_spans = code_spans.map(|c| c.start - range.start..c.end - range.start);
        let found = faults(&without_code(paragraph, code_spans), true, &mut 0).into_iter().take(MAX_IN_TEXT);
        findings.extend(
            found.map(|(span, message)| finding(range.start + span.start..range.start + span.end, message)),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delimiters_are_balanced() {
        let faults = |text: &str| faults(text, false, &mut 0);
        let count = |text: &str| faults(text).len();
        for right in [
            "$a_1$ and $$\\frac{1}{2}$$, \\(x\\)",
            "it costs $5, or $10",
            "\\$5 and $\\{x\\}$",
            "$\\left\\{ x \\right.$",
            "$\\begin{matrix}1\\end{matrix}$",
            "5 $ left",
            "the folder $HOME is mine",
        ] {
            assert_eq!(count(right), 0, "{right}: {:?}", faults(right));
        }
        for wrong in [
            "the time $\\sqrt{2h/g} is",
            "$\\frac{1}{2$",
            "$a}$",
            "$\\left( x$",
            "$x \\right)$",
            "$\\begin{matrix}1$",
            "\\(x and y",
            "it accelerates with $g. There is no air",
        ] {
            assert_eq!(count(wrong), 1, "{wrong}: {:?}", faults(wrong));
        }
        let html = "in <code>$a_{</code> and $b$";
        assert_eq!(faults(&without_code(html, code(html).into_iter())), []);
    }

    /// A megabyte of each opening delimiter: no character is read more often than the limit.
    #[test]
    fn hostile_texts_take_bounded_work() {
        const MEGABYTE: usize = 1 << 20;
        for piece in [
            "$",
            "$ ",
            "$a",
            "$1",
            "\\left(",
            "{",
            "$\\left(",
            "$\\left($ ",
            "$\\begin{$ ",
            "\\begin{",
            "\\(",
            "\\[ ",
            "$$a",
            "$$ $",
            "${",
            "$\n",
            "$a\n\n",
            "\\",
            "\\$",
            "ä$",
            "$\\begin{a}",
            "$\\end{a}$",
        ] {
            let text = piece.repeat(MEGABYTE / piece.len());
            for plain in [false, true] {
                let mut work = 0;
                let found = faults(&text, plain, &mut work);
                assert!(work <= MAX_READS * text.len(), "{piece:?}: {work}");
                assert!(found.len() <= text.len());
                // Unclosed delimiters cost one read each, and a limited number of scans of a formula's length.
                if piece == "$a" || piece == "\\left(" || piece == "{" {
                    assert!(work <= 3 * text.len() + 2 * MAX_IN_TEXT * MAX_FORMULA, "{piece:?}: {work}");
                }
            }
        }
        // Many short formulas, as in a quiz.
        let text = "$a ".repeat(60);
        let mut work = 0;
        (0..1000).for_each(|_| drop(faults(&text, false, &mut work)));
        assert!(work <= MAX_READS * 1000 * text.len(), "{work}");
    }
}
