//! Reads the gaps between values: spaces, and characters that authors write as spaces or comments.

use super::parser::JsonParser;
use super::problem::{Mistake, Problem, RepeatedError};

impl JsonParser<'_> {
    /// Advances to the next significant character. Comments and invisible characters are reported.
    pub(super) fn gap(&mut self) {
        while let Some(c) = self.peek() {
            let start = self.offset;
            match c {
                ' ' | '\t' | '\n' | '\r' => self.offset += 1,
                '#' => self.line_comment(),
                '/' if self.starts("//") => self.line_comment(),
                '/' if self.starts("/*") => {
                    let end = self.comment_end();
                    self.comment(end);
                }
                // It is invisible, and a space in some programs: the author cannot see the error.
                _ if is_invisible(c) => {
                    while self.peek().is_some_and(is_invisible) {
                        self.bump();
                    }
                    let range = start..self.offset;
                    self.change(RepeatedError::Invisible, vec![(range, " ".to_string())]);
                }
                _ => return,
            }
        }
    }

    fn line_comment(&mut self) {
        let end = self.line_end();
        self.comment(end);
    }

    fn comment(&mut self, end: usize) {
        let range = self.offset..end;
        self.offset = end;
        self.report(Problem::replaced(Mistake::Comment, range, ""));
    }

    /// The end of a comment between `/*` and `*/`; the end of the line if it is never closed.
    fn comment_end(&mut self) -> usize {
        if self.comment_open {
            return self.line_end();
        }
        match self.text.get(self.offset + 2..).and_then(|rest| rest.find("*/")) {
            Some(i) => self.offset + 2 + i + 2,
            None => {
                // The search is not repeated: a hostile text can open thousands of comments.
                self.comment_open = true;
                self.line_end()
            }
        }
    }

    /// Whether a comment begins at `offset`.
    pub(super) fn is_comment(&self, offset: usize) -> bool {
        self.text
            .get(offset..)
            .is_some_and(|t| t.starts_with(['#']) || t.starts_with("//") || t.starts_with("/*"))
    }
}

/// Whether a character is invisible and not a space in JSON.
fn is_invisible(c: char) -> bool {
    !matches!(c, ' ' | '\t' | '\n' | '\r')
        && (c.is_whitespace()
            || c.is_control()
            || matches!(c, '\u{feff}' | '\u{200b}'..='\u{200f}' | '\u{2060}' | '\u{ad}'))
}
