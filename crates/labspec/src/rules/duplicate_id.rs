use super::Check;
use crate::finding::{Finding, InFile, Place};
use crate::json::read::named;
use crate::source::Text;
use crate::spec::Lesson;
use labspec_finding::{Example, Layer, Rule, Severity};
use std::collections::HashMap;

/// Two quizzes have the same id.
pub const DUPLICATE_ID: &Rule = &Rule {
    code: "duplicate-id",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "two quizzes have the same id",
    why: "the page stores answers under the id, so the answer to one quiz appears as the answer to the other",
    bad: Example::Lesson(
        "```quiz\n{\"id\": \"fall\", \"questions\": [{\"q\": \"Does mass matter?\", \"options\": [\"yes\", \"no\"], \"answer\": 1}]}\n```\n\n```quiz\n{\"id\": \"⟦fall⟧\", \"questions\": [{\"q\": \"Does size matter?\", \"options\": [\"yes\", \"no\"], \"answer\": 1}]}\n```\n",
    ),
    good: Example::Lesson(
        "```quiz\n{\"id\": \"fall-mass\", \"questions\": [{\"q\": \"Does mass matter?\", \"options\": [\"yes\", \"no\"], \"answer\": 1}]}\n```\n\n```quiz\n{\"id\": \"fall-size\", \"questions\": [{\"q\": \"Does size matter?\", \"options\": [\"yes\", \"no\"], \"answer\": 1}]}\n```\n",
    ),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let mut first: HashMap<&str, &Text> = HashMap::new();
    for id in lesson.quizzes.iter().filter_map(|q| q.id.as_ref()) {
        match first.get(id.as_str()) {
            Some(before) => {
                findings.push(duplicate(id).related(before.span(), "the first quiz with this id"))
            }
            None => {
                first.insert(id.as_str(), id);
            }
        }
    }
}

pub(super) fn across(lessons: &[&Lesson]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut first: HashMap<&str, (&Lesson, &Text)> = HashMap::new();
    for lesson in lessons {
        for id in lesson.quizzes.iter().filter_map(|q| q.id.as_ref()) {
            match first.get(id.as_str()) {
                Some((other, before)) if other.file.path() != lesson.file.path() => {
                    let mut finding = duplicate(id).at(&lesson.file);
                    finding.related.push(Place {
                        path: other.file.path().clone(),
                        span: before.span(),
                        label: "the first quiz with this id".into(),
                    });
                    findings.push(finding);
                }
                Some(_) => {}
                None => {
                    first.insert(id.as_str(), (lesson, id));
                }
            }
        }
    }
    findings
}

fn duplicate(id: &Text) -> Finding {
    Finding::new(DUPLICATE_ID, id.span(), format!("another quiz also has the id {}", named(id.as_str())))
        .help(format!(
            "give every quiz its own id: write `{}-2`, or the lesson number and a word",
            id.as_str()
        ))
}

#[cfg(test)]
mod tests {
    use crate::lint::load_lesson;
    use crate::lint::{ModelFolder, check_course};
    use crate::source::SourceFile;

    #[test]
    fn ids_are_unique_in_a_course() {
        let quiz = "```quiz\n{\"id\": \"a\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n";
        let load = |path: &str| load_lesson(SourceFile::new(path, quiz), &ModelFolder::unknown());
        let (one, two) = (load("1.md"), load("2.md"));
        let findings = check_course(&[&one, &two]);
        assert_eq!(findings.len(), 1);
        assert_eq!((&*findings[0].path, &*findings[0].related[0].path), ("2.md", "1.md"));
        assert!(one.findings.is_empty() && check_course(&[&one, &one]).is_empty());
    }
}
