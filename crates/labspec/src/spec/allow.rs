//! Findings that an author has looked at and keeps: `"lint": {"allow": […], "why": "…"}` in a lab, a quiz or a question, and
//! `<!-- labspec allow CODE, CODE: reason -->` before a block of prose.

use super::comment::Comment;
use super::fields::Fields;
use super::format::LINT;
use super::problem::Problem;
use super::{Lesson, read as values};
use crate::json::Node;
use crate::source::Text;
use std::ops::Range;

/// Some codes, for a stretch of a lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct Allowance {
    /// Bytes of the file: the object or the comment that says it.
    pub span: Range<usize>,
    /// The codes, and where they stand.
    pub codes: Vec<(String, Range<usize>)>,
    /// The reason; empty where there is none.
    pub why: String,
    /// Bytes of the file that it is about.
    pub over: Range<usize>,
}

/// Reads `lint` of an object with these bytes.
pub(super) fn read(
    node: Option<&Node>,
    over: Range<usize>,
    problems: &mut Vec<Problem>,
) -> Option<Allowance> {
    let mut fields = Fields::open(node?, &LINT, problems)?;
    let codes: Vec<Text> =
        fields.list("allow").iter().filter_map(|n| values::text(n, "a code", fields.problems)).collect();
    let why = fields.text("why").map_or(String::new(), |t| t.value.trim().to_string());
    let span = fields.span();
    fields.finish();
    let codes = codes.into_iter().map(|t| (t.value.clone(), t.span())).collect();
    Some(Allowance { span, codes, why, over })
}

impl Lesson {
    /// Everything that is allowed in it, in the order of the text.
    pub fn allowances(&self) -> Vec<Allowance> {
        let mut all: Vec<Allowance> = self.all_labs().iter().filter_map(|lab| lab.lint.clone()).collect();
        for quiz in &self.quizzes {
            all.extend(quiz.lint.clone());
            all.extend(quiz.numbered().filter_map(|(_, question)| question.lint.clone()));
        }
        all.extend(self.remarked());
        all.sort_by_key(|a| a.span.start);
        all
    }

    /// Those in comments.
    fn remarked(&self) -> Vec<Allowance> {
        let text = self.file.text();
        let one = |comment: Comment| {
            let (codes, why) = codes(text, comment.inside)?;
            Some(Allowance { span: comment.span, codes, why, over: comment.over })
        };
        self.comments("allow").into_iter().filter_map(one).collect()
    }
}

/// Codes with their places, and the reason, of a comment that is ours.
type Said = (Vec<(String, Range<usize>)>, String);

fn codes(text: &str, inside: Range<usize>) -> Option<Said> {
    let rest = text.get(inside.clone())?;
    let (codes, why) = rest.split_once(':').unwrap_or((rest, ""));
    let mut at = inside.end - rest.len();
    let mut found = Vec::new();
    for part in codes.split(',') {
        let start = at + part.len() - part.trim_start().len();
        found.push((part.trim().to_string(), start..start + part.trim().len()));
        at += part.len() + 1;
    }
    Some((found, why.trim().to_string()))
}

#[cfg(test)]
mod tests {
    use super::super::read_lesson;
    use crate::source::SourceFile;

    /// What a comment is about: from what follows it to the end of the block or the paragraph.
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

    /// A reason may go on in the next line.
    #[test]
    fn a_comment_may_have_several_lines() {
        let text = "# A\n\n<!-- labspec allow a,\nb: read\naloud -->\n\nthis\n\nnot <!-- labspec\nallow c: x --> that\n";
        let lesson = read_lesson(SourceFile::new("a.md", text));
        let all = lesson.allowances();
        assert_eq!(all.len(), 2, "{all:#?}");
        let codes =
            |i: usize| all[i].codes.iter().map(|(code, at)| (code.as_str(), lesson.file.slice(at.clone())));
        assert_eq!(codes(0).collect::<Vec<_>>(), [("a", "a"), ("b", "b")]);
        assert_eq!((all[0].why.as_str(), lesson.file.slice(all[0].over.clone())), ("read\naloud", "this\n"));
        assert_eq!(codes(1).collect::<Vec<_>>(), [("c", "c")]);
    }

    /// A hundred thousand comments in one paragraph: each end is found once. Each anew would be 10^11 bytes, and no test that ends.
    #[test]
    fn many_comments_are_read_once() {
        let text = "x <!-- labspec allow a: b -->".repeat(100_000);
        let lesson = read_lesson(SourceFile::new("a.md", text.as_str()));
        let all = lesson.allowances();
        assert_eq!(all.len(), 100_000);
        assert!(all.iter().all(|a| a.over.end == text.len()));
    }
}
