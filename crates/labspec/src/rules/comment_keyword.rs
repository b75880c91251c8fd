use super::{Check, MAX_IN_TEXT};
use crate::spec::{Lesson, UnreadComment, unread_comments};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A comment for labspec is not read.
pub const COMMENT_KEYWORD: &Rule = &Rule {
    code: "comment-keyword",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a comment begins with `labspec` or has claims, but nothing reads it: its first words are not `labspec` and a keyword, or its marks are not those of a comment",
    why: "a claim in a comment that nothing reads is not checked, and an allowance does nothing",
    bad: Example::Lesson(
        "⟦<!-- labspec verfy {\"says\": [[\"9 m\", \"4 + 5\"]]} -->⟧\nIt is 9 m.\n\n```lab simlab\n{\"model\": \"ball\", \"plots\": []}\n```\n",
    ),
    good: Example::Lesson(
        "<!-- the numbers are those of the lab below -->\nIt falls.\n\n```lab simlab\n{\"model\": \"ball\", \"plots\": []}\n```\n",
    ),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let all = unread_comments(lesson.file.text(), &lesson.scan);
    for UnreadComment { span, keyword } in all.into_iter().take(MAX_IN_TEXT) {
        let message = match &keyword {
            Some(_) => "nothing reads this comment: its keyword is unknown",
            None => "nothing reads this comment: its marks are not `<!-- labspec` and `-->`",
        };
        let right = match keyword.flatten() {
            Some(near) => format!("write `<!-- labspec {near} … -->`"),
            None => "write `<!-- labspec verify {…} -->`, `<!-- labspec define NAME {…} -->` or `<!-- labspec allow CODE: reason -->`; a comment for people begins with another word".to_string(),
        };
        findings.push(Finding::new(COMMENT_KEYWORD, span, message).help(right));
    }
}
