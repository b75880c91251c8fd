//! What stands between values: spaces, and what authors take for spaces or for comments.

use super::parser::Parser;
use super::problem::{Mistake, Problem, RepeatedMistake};

impl Parser<'_> {
    /// Walks to the next character that means something. Comments and invisible characters are reported.
    pub(super) fn gap(&mut self) {
        while let Some(c) = self.peek() {
            let start = self.at;
            match c {
                ' ' | '\t' | '\n' | '\r' => self.at += 1,
                '#' => self.line_comment(),
                '/' if self.starts("//") => self.line_comment(),
                '/' if self.starts("/*") => {
                    let end = self.comment_end();
                    self.comment(end);
                }
                // Invisible, and a space to some programs: the author cannot see what is wrong.
                _ if is_invisible(c) => {
                    while self.peek().is_some_and(is_invisible) {
                        self.bump();
                    }
                    let range = start..self.at;
                    self.change(RepeatedMistake::Invisible, vec![(range, " ".to_string())]);
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
        let range = self.at..end;
        self.at = end;
        self.say(Problem::replaced(Mistake::Comment, range, ""));
    }

    /// The end of a comment between `/*` and `*/`; that of the line when it is never closed.
    fn comment_end(&mut self) -> usize {
        if self.comment_open {
            return self.line_end();
        }
        match self.text.get(self.at + 2..).and_then(|rest| rest.find("*/")) {
            Some(i) => self.at + 2 + i + 2,
            None => {
                // Not looked for again: a hostile text can open thousands.
                self.comment_open = true;
                self.line_end()
            }
        }
    }

    /// Whether a comment begins at `at`.
    pub(super) fn is_comment(&self, at: usize) -> bool {
        self.text
            .get(at..)
            .is_some_and(|t| t.starts_with(['#']) || t.starts_with("//") || t.starts_with("/*"))
    }
}

/// A character that cannot be seen and that JSON does not take for a space.
fn is_invisible(c: char) -> bool {
    !matches!(c, ' ' | '\t' | '\n' | '\r')
        && (c.is_whitespace()
            || c.is_control()
            || matches!(c, '\u{feff}' | '\u{200b}'..='\u{200f}' | '\u{2060}' | '\u{ad}'))
}
