//! Separates the code of a listing from its comments and strings.

use crate::markdown::is_typographic;
use std::ops::Range;

/// Languages whose comments and strings are recognized.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Language {
    Python,
    Shell,
    CLike,
    Xml,
    Json,
}

impl Language {
    pub(crate) fn named(name: &str) -> Option<Language> {
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

/// Code with its comments and strings replaced by spaces, and the typographic quotes outside of them.
pub(crate) struct CodeScan {
    /// The code with spaces in place of comments and strings; its length is unchanged.
    pub(crate) bare: String,
    pub(crate) quotes: Vec<Range<usize>>,
    /// Start offsets of lines that begin inside brackets or a string.
    continued: Vec<usize>,
}

impl CodeScan {
    pub(crate) fn scan_code(code: &str, language: Language) -> CodeScan {
        let mut scan =
            CodeScan { bare: String::with_capacity(code.len()), quotes: Vec::new(), continued: Vec::new() };
        let mut inside: Option<&str> = None;
        let mut depth = 0i64;
        let mut offset = 0;
        while let Some(rest) = code.get(offset..)
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
                        // An unterminated string: the error ends with the line.
                        inside = None;
                        keep = true;
                    }
                }
                None => {
                    let opened = comment_or_string_start(rest, language);
                    if let Some((mark, end)) = opened {
                        length = mark.len();
                        inside = Some(end);
                        keep = false;
                    } else if is_typographic(c) {
                        let before = code.get(..offset).and_then(|b| b.chars().next_back());
                        let after = rest.chars().nth(1);
                        let letter = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
                        // Between letters it is an apostrophe, which appears only in text.
                        if !(matches!(c, '‘' | '’') && letter(before) && letter(after)) {
                            scan.quotes.push(offset..offset + length);
                        }
                    } else if matches!(c, '(' | '[' | '{') {
                        depth += 1;
                    } else if matches!(c, ')' | ']' | '}') {
                        depth = (depth - 1).max(0);
                    }
                }
            }
            for part in code.get(offset..offset + length).unwrap_or("").chars() {
                if keep || part == '\n' {
                    scan.bare.push(part);
                } else {
                    (0..part.len_utf8()).for_each(|_| scan.bare.push(' '));
                }
            }
            offset += length;
            if c == '\n' && (depth > 0 || inside.is_some()) {
                scan.continued.push(offset);
            }
        }
        scan
    }
}

/// The comment or string that begins here: its opening and closing marks.
fn comment_or_string_start(rest: &str, language: Language) -> Option<(&'static str, &'static str)> {
    let marks: &[(&str, &str)] = match language {
        Language::Python => &[("\"\"\"", "\"\"\""), ("'''", "'''"), ("\"", "\""), ("'", "'"), ("#", "\n")],
        Language::Shell => &[("\"", "\""), ("'", "'"), ("#", "\n")],
        Language::CLike => &[("//", "\n"), ("/*", "*/"), ("\"", "\"")],
        Language::Xml => &[("<!--", "-->"), ("\"", "\""), ("'", "'"), (">", "<")],
        Language::Json => &[("\"", "\"")],
    };
    marks.iter().find(|(open, _)| rest.starts_with(open)).copied()
}

/// A line of a listing.
pub(crate) struct CodeLine<'c> {
    /// Start offset of the line.
    pub(crate) start: usize,
    /// The original line.
    pub(crate) text: &'c str,
    /// The line with comments and strings replaced by spaces.
    pub(crate) bare: &'c str,
    pub(crate) indent: usize,
    /// The range without indentation and trailing spaces.
    pub(crate) content: Range<usize>,
}

impl CodeScan {
    /// The lines of the scanned code.
    pub(crate) fn lines<'c>(&'c self, code: &'c str) -> impl Iterator<Item = CodeLine<'c>> {
        let mut offset = 0;
        code.split_inclusive('\n').map(move |text| {
            let start = offset;
            offset += text.len();
            let indent = text.len() - text.trim_start().len();
            let content = start + indent..start + text.trim_end().len().max(indent);
            CodeLine { start, text, bare: self.bare.get(start..offset).unwrap_or(""), indent, content }
        })
    }

    /// Whether a line begins a statement: it is not inside brackets or a string, and contains code.
    pub(crate) fn is_statement(&self, line: &CodeLine<'_>) -> bool {
        !line.bare.trim().is_empty() && self.continued.binary_search(&line.start).is_err()
    }
}
