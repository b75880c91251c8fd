//! Listings that lost what a program needs on their way through a text editor.

use crate::finding::Finding;
use crate::markdown::is_typographic;
use crate::rules;
use crate::source::Text;
use std::ops::Range;

/// Looks at a listing. An unclosed one may hold text that is no code: it is read up to an empty line or a table.
pub(crate) fn check_listing(language: &str, body: &Text, closed: bool, findings: &mut Vec<Finding>) {
    let Some(language) = Language::named(language) else { return };
    let mut end = 0;
    for line in body.value.split_inclusive('\n') {
        if !closed && end > 0 && (line.trim().is_empty() || line.starts_with('|')) {
            break;
        }
        end += line.len();
    }
    let code = body.value.get(..end).unwrap_or("");
    let scan = CodeScan::scan_code(code, language);
    typographic(body, &scan, findings);
    if language == Language::Python {
        python(body, code, &scan, findings);
    }
}

/// Languages whose comments and strings are known well enough.
#[derive(Clone, Copy, PartialEq)]
enum Language {
    Python,
    Shell,
    CLike,
    Xml,
    Json,
}

impl Language {
    fn named(name: &str) -> Option<Language> {
        Some(match name.to_ascii_lowercase().as_str() {
            "python" | "py" | "python3" => Language::Python,
            "bash" | "sh" | "shell" | "yaml" | "toml" => Language::Shell,
            "c" | "cpp" | "c++" | "rust" | "js" | "javascript" | "ts" | "typescript" => Language::CLike,
            "xml" | "mjcf" | "html" => Language::Xml,
            "json" => Language::Json,
            _ => return None,
        })
    }
}

/// Code with its comments and strings blanked out, and the typographic quotes outside of them.
struct CodeScan {
    /// As long as the code; what is not code is a space.
    bare: String,
    quotes: Vec<Range<usize>>,
    /// Start offsets of lines that begin inside of brackets or of a string.
    continued: Vec<usize>,
}

impl CodeScan {
    fn scan_code(code: &str, language: Language) -> CodeScan {
        let mut scan =
            CodeScan { bare: String::with_capacity(code.len()), quotes: Vec::new(), continued: Vec::new() };
        let mut inside: Option<&str> = None;
        let mut depth = 0i64;
        let mut at = 0;
        while let Some(rest) = code.get(at..)
            && let Some(c) = rest.chars().next()
        {
            let mut length = c.len_utf8();
            let mut keep = inside.is_none();
            match inside {
                Some(end) => {
                    if c == '\\' && end != "-->" && end != "\n" {
                        length += rest.chars().nth(1).map_or(0, char::len_utf8);
                    } else if rest.starts_with(end) {
                        length = end.len();
                        inside = None;
                        keep = end == "\n";
                    } else if c == '\n' && end.len() == 1 {
                        // A string that is not closed on its line: broken, but the next line is code again.
                        inside = None;
                        keep = true;
                    }
                }
                None => {
                    let opened = opens(rest, language);
                    if let Some((mark, end)) = opened {
                        length = mark.len();
                        inside = Some(end);
                        keep = false;
                    } else if is_typographic(c) {
                        let before = code.get(..at).and_then(|b| b.chars().next_back());
                        let after = rest.chars().nth(1);
                        let letter = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
                        // Between letters it is an apostrophe, which code has only in text.
                        if !(matches!(c, '‘' | '’') && letter(before) && letter(after)) {
                            scan.quotes.push(at..at + length);
                        }
                    } else if matches!(c, '(' | '[' | '{') {
                        depth += 1;
                    } else if matches!(c, ')' | ']' | '}') {
                        depth = (depth - 1).max(0);
                    }
                }
            }
            for part in code.get(at..at + length).unwrap_or("").chars() {
                if keep || part == '\n' {
                    scan.bare.push(part);
                } else {
                    (0..part.len_utf8()).for_each(|_| scan.bare.push(' '));
                }
            }
            at += length;
            if c == '\n' && (depth > 0 || inside.is_some()) {
                scan.continued.push(at);
            }
        }
        scan
    }
}

/// The comment or string that begins here: what opens it and what ends it.
fn opens(rest: &str, language: Language) -> Option<(&'static str, &'static str)> {
    let marks: &[(&str, &str)] = match language {
        Language::Python => &[("\"\"\"", "\"\"\""), ("'''", "'''"), ("\"", "\""), ("'", "'"), ("#", "\n")],
        Language::Shell => &[("\"", "\""), ("'", "'"), ("#", "\n")],
        Language::CLike => &[("//", "\n"), ("/*", "*/"), ("\"", "\"")],
        Language::Xml => &[("<!--", "-->"), ("\"", "\""), ("'", "'"), (">", "<")],
        Language::Json => &[("\"", "\"")],
    };
    marks.iter().find(|(open, _)| rest.starts_with(open)).copied()
}

fn typographic(body: &Text, scan: &CodeScan, findings: &mut Vec<Finding>) {
    let Some(first) = scan.quotes.first() else { return };
    // The first quote of every line.
    let mut lines: Vec<&Range<usize>> = Vec::new();
    for quote in &scan.quotes {
        let same = lines
            .last()
            .and_then(|last| scan.bare.get(last.start..quote.start))
            .is_some_and(|b| !b.contains('\n'));
        if !same {
            lines.push(quote);
        }
    }
    let on = if lines.len() > 1 { format!(", on {} lines", lines.len()) } else { String::new() };
    let mut finding = Finding::new(
        rules::TYPOGRAPHIC_QUOTE,
        body.span_of(first.clone()),
        format!("a listing has typographic quotes{on}"),
    )
    .help("write \" for “ and ”, and ' for ‘ and ’");
    for &quote in lines.iter().skip(1).take(7) {
        finding = finding.related(body.span_of(quote.clone()), "and on this line");
    }
    findings.push(finding);
}

fn python(body: &Text, code: &str, scan: &CodeScan, findings: &mut Vec<Finding>) {
    let mut at = 0;
    let mut header: Option<(usize, Range<usize>)> = None;
    for line in code.split_inclusive('\n') {
        let start = at;
        at += line.len();
        let bare = scan.bare.get(start..at).unwrap_or("");
        let indent = line.len() - line.trim_start().len();
        let content = start + indent..start + line.trim_end().len().max(indent);
        // The strings are blanked out, so the words of the listing itself are compared.
        let words = line.trim().replace(is_typographic, "\"");
        if words.starts_with("if name == \"main\"") || words.starts_with("if name == 'main'") {
            let end = content.start + "if name".len();
            findings.push(
                Finding::new(
                    rules::LISTING_UNDERSCORES,
                    body.span_of(content.start..end),
                    "the underscores of `__name__` are missing",
                )
                .help("write if __name__ == \"__main__\":"),
            );
        }
        if bare.trim().is_empty() || scan.continued.binary_search(&start).is_ok() {
            continue;
        }
        if let Some((outer, span)) = header.take()
            && indent <= outer
        {
            findings.push(
                Finding::new(
                    rules::LISTING_INDENTATION,
                    body.span_of(content.clone()),
                    "this line must be indented",
                )
                .related(body.span_of(span), "the line that it belongs to")
                .help("indent the block by four spaces"),
            );
        }
        if bare.trim_end().ends_with(':') {
            header = Some((indent, content.clone()));
        } else if let Some(second) = second_assignment(bare) {
            let from = start + second;
            findings.push(
                Finding::new(
                    rules::LISTING_LINE_BREAKS,
                    body.span_of(from..content.end),
                    "several statements are on one line",
                )
                .help("put every statement on its own line, indented below the `def`"),
            );
        }
    }
}

/// Where the second assignment of a `def` line begins, outside of brackets: more than one cannot follow it.
fn second_assignment(bare: &str) -> Option<usize> {
    if !bare.trim_start().starts_with("def ") || bare.contains(';') {
        return None;
    }
    let (mut depth, mut count) = (0i32, 0);
    for (at, c) in bare.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            '=' if depth == 0 && bare.get(at.saturating_sub(1)..at + 2) == Some(" = ") => {
                count += 1;
                if count == 2 {
                    // Back over the name that is assigned.
                    let name = bare.get(..at)?.trim_end();
                    return Some(name.rfind(' ').map_or(0, |space| space + 1));
                }
            }
            _ => {}
        }
    }
    None
}
