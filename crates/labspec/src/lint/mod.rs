//! The rules: one table, and the checks of a lesson's structure.
//!
//! A rule is declared once, beside its check, with its reason and two examples; the list of rules, the long
//! explanations and the tests all come from that declaration.

mod models;
pub mod rules;

pub use models::ModelFolder;
pub(crate) use models::{lesson_folder, root_of};

use crate::finding::{Finding, Severity};
use crate::spec::Lesson;

/// A rule: what it is called, why it exists, and how the wrong and the right thing look.
#[derive(Debug)]
pub struct Rule {
    /// Stable name, in words: `unknown-key`.
    pub code: &'static str,
    /// How bad a violation is, as a rule.
    pub severity: Severity,
    /// What is wrong, in one line.
    pub summary: &'static str,
    /// Why it matters to students.
    pub why: &'static str,
    /// Something that violates the rule.
    pub bad: Example,
    /// The same, done right.
    pub good: Example,
}

/// An example of a rule.
#[derive(Clone, Copy, Debug)]
pub enum Example {
    /// A whole lesson, Markdown.
    Lesson(&'static str),
    /// The JSON of a lab.
    Lab(&'static str),
    /// The JSON of a quiz.
    Quiz(&'static str),
    /// A stand-alone JSON file.
    Json(&'static str),
    /// A lesson that says the same thing very often.
    Repeated(&'static str, usize),
}

impl Example {
    /// The example as a file: its name and its text.
    pub fn file(&self) -> (&'static str, String) {
        let name = if matches!(self, Example::Json(_)) { "example.json" } else { "example.md" };
        (name, self.text())
    }

    fn text(&self) -> String {
        match self {
            Example::Lesson(text) | Example::Json(text) => (*text).to_string(),
            Example::Repeated(text, times) => text.repeat(*times),
            Example::Lab(json) => format!("```lab simlab\n{json}\n```\n"),
            Example::Quiz(json) => format!("```quiz\n{json}\n```\n"),
        }
    }
}

/// All rules, by families.
pub fn all() -> impl Iterator<Item = &'static Rule> {
    rules::FAMILIES.iter().flat_map(|family| family.iter().copied())
}

/// The rule with this code.
pub fn find(code: &str) -> Option<&'static Rule> {
    all().find(|rule| rule.code == code)
}

/// The long explanation of a rule, as Markdown: what, why, wrong, right.
pub fn explain(code: &str) -> Option<String> {
    let rule = find(code)?;
    let mut text = format!("# {} ({})\n\n{}\n", rule.code, rule.severity.as_str(), sentence(rule.summary));
    if !rule.why.is_empty() {
        text.push_str(&format!("\n{}\n", sentence(rule.why)));
    }
    for (title, example) in [("Wrong", rule.bad), ("Right", rule.good)] {
        let (language, shown) = match example {
            Example::Repeated(text, times) => {
                ("markdown", format!("{}\n… and so on, {times} times", text.trim_end()))
            }
            Example::Json(_) => ("json", example.text()),
            _ => ("markdown", example.text()),
        };
        text.push_str(&format!("\n## {title}\n\n````{language}\n{}\n````\n", shown.trim_end()));
    }
    Some(text)
}

/// With a capital and a full stop.
fn sentence(text: &str) -> String {
    let mut chars = text.chars();
    let first = chars.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    let stop = if text.ends_with(['.', '?', '!']) { "" } else { "." };
    format!("{first}{}{stop}", chars.as_str())
}

/// Checks the structure of a lesson: everything that needs no engine.
pub(crate) fn check(lesson: &Lesson, models: &ModelFolder, findings: &mut Vec<Finding>) {
    for lab in lesson.all_labs() {
        rules::model::check(lab, models, findings);
        rules::ranges::check_lab(lab, findings);
        rules::control::check(lab, findings);
        rules::plot::check(lab, findings);
        rules::html::check_lab(lab, findings);
        rules::latex::check_lab(lab, findings);
        rules::quotes::check_lab(lab, findings);
    }
    for quiz in &lesson.quizzes {
        rules::quiz::check(quiz, findings);
        rules::html::check_quiz(quiz, findings);
        rules::latex::check_quiz(quiz, findings);
    }
    rules::verify::check(lesson, findings);
    rules::ids::within(lesson, findings);
}

/// Checks what only several lessons together can get wrong: ids that are used twice in a course.
pub fn check_course(lessons: &[&Lesson]) -> Vec<Finding> {
    rules::ids::across(lessons)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceFile;
    use crate::spec::load_lesson;
    use std::collections::BTreeSet;

    fn fired(example: &Example) -> Vec<&'static str> {
        let models = ModelFolder::with_names(["ball", "pendulum"]);
        let (name, text) = example.file();
        load_lesson(SourceFile::new(name, text), &models).findings.iter().map(|f| f.code).collect()
    }

    #[test]
    fn every_bad_example_fires_and_every_good_one_is_clean() {
        for rule in all() {
            assert!(fired(&rule.bad).contains(&rule.code), "{}: {:?}", rule.code, fired(&rule.bad));
            assert_eq!(fired(&rule.good), Vec::<&str>::new(), "{}", rule.code);
        }
    }

    #[test]
    fn codes_are_unique_and_in_words() {
        let codes: BTreeSet<_> = all().map(|r| r.code).collect();
        assert_eq!(codes.len(), all().count());
        for rule in all() {
            assert!(rule.code.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{}", rule.code);
            assert!(!rule.summary.is_empty() && !rule.summary.ends_with('.'), "{}", rule.code);
        }
    }

    #[test]
    fn explanations_show_both_examples() {
        insta::assert_snapshot!(explain("unknown-key").unwrap());
        assert_eq!(explain("no-such-rule"), None);
    }
}
