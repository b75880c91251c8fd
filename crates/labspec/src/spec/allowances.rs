//! The suppressions of a lesson: in its objects, and in comments before blocks of prose.

use super::allow::Allowance;
use super::comment::{self, Comment};
use super::lesson::Lesson;
use std::ops::Range;

impl Lesson {
    /// All suppressions, in the order of the text.
    pub fn allowances(&self) -> Vec<Allowance> {
        let mut all: Vec<Allowance> = self.all_labs().iter().filter_map(|lab| lab.lint.clone()).collect();
        for quiz in &self.quizzes {
            all.extend(quiz.lint.clone());
            all.extend(quiz.numbered().filter_map(|(_, question)| question.lint.clone()));
        }
        all.extend(self.allowances_in_comments());
        all.sort_by_key(|a| a.span.start);
        all
    }

    /// The suppressions in comments.
    fn allowances_in_comments(&self) -> Vec<Allowance> {
        let text = self.file.text();
        let one = |comment: Comment| {
            let (codes, why) = read_codes(text, comment.inside)?;
            Some(Allowance { span: comment.span, codes, why, over: comment.over })
        };
        comment::comments(&self.file, &self.scan, "allow").into_iter().filter_map(one).collect()
    }
}

/// The codes with their spans, and the reason, of a labspec comment.
type CodesAndReason = (Vec<(String, Range<usize>)>, String);

fn read_codes(text: &str, inside: Range<usize>) -> Option<CodesAndReason> {
    let rest = text.get(inside.clone())?;
    let (codes, why) = rest.split_once(':').unwrap_or((rest, ""));
    let mut offset = inside.end - rest.len();
    let mut found = Vec::new();
    for part in codes.split(',') {
        let start = offset + part.len() - part.trim_start().len();
        found.push((part.trim().to_string(), start..start + part.trim().len()));
        offset += part.len() + 1;
    }
    Some((found, why.trim().to_string()))
}

#[cfg(test)]
mod tests {
    use super::super::read_lesson;
    use crate::source::SourceFile;

    /// A comment applies to the text after it, up to the end of the block or the paragraph.
    #[test]
    fn a_comment_is_about_what_follows() {
        let text = "<!-- labspec allow a: x --> one <!-- labspec allow b: y --> two\nthree\n\nfour\n\n\
                    <!-- labspec allow c: z -->\n\n```lab simlab\n{}\n\n\n```\n\nfive <!-- labspec allow d: w -->";
        let lesson = read_lesson(SourceFile::new("a.md", text));
        let over: Vec<&str> = lesson.allowances().iter().map(|a| lesson.file.slice(a.over.clone())).collect();
        assert_eq!(over.len(), 4);
        assert!(over[0].starts_with("one") && over[0].ends_with("three\n"), "{over:?}");
        assert!(over[1].starts_with("two") && over[1].ends_with("three\n"), "{over:?}");
        assert!(over[2].starts_with("```lab") && over[2].trim_end().ends_with("```"), "{over:?}");
        assert_eq!(over[3], "");
    }

    /// A reason may continue on the next line.
    #[test]
    fn a_comment_may_have_several_lines() {
        let text = "# A\n\n<!-- labspec allow a,\nb: read\naloud -->\n\nthis\n\nnot <!-- labspec\nallow c: x --> that\n";
        let lesson = read_lesson(SourceFile::new("a.md", text));
        let all = lesson.allowances();
        assert_eq!(all.len(), 2, "{all:#?}");
        let codes = |i: usize| {
            all[i].codes.iter().map(|(code, span)| (code.as_str(), lesson.file.slice(span.clone())))
        };
        assert_eq!(codes(0).collect::<Vec<_>>(), [("a", "a"), ("b", "b")]);
        assert_eq!((all[0].why.as_str(), lesson.file.slice(all[0].over.clone())), ("read\naloud", "this\n"));
        assert_eq!(codes(1).collect::<Vec<_>>(), [("c", "c")]);
    }

    /// A hundred thousand comments in one paragraph: each end is found once. A repeated search would read 10^11 bytes, and
    /// the test would not end.
    #[test]
    fn many_comments_are_read_once() {
        let text = "x <!-- labspec allow a: b -->".repeat(100_000);
        let lesson = read_lesson(SourceFile::new("a.md", text.as_str()));
        let all = lesson.allowances();
        assert_eq!(all.len(), 100_000);
        assert!(all.iter().all(|a| a.over.end == text.len()));
    }
}
