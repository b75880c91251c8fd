//! All lint rules. Those about lessons, runs and claims are declared here, each in its own file; those about the language and about
//! models are declared in their crates.
//!
//! A file contains the rule and its check: as a `CHECK`, which [`crate::lint`] calls, or as a function that a driver calls
//! (`lint/`, `check/`). If one pass decides several rules, the file names its function. A new rule is a file of this folder; the
//! build script lists the files.

mod claims;
pub mod example;
mod positions;
mod repeated;
mod wording;

pub use labspec_finding::{Example, Layer, Rule};

use crate::finding::Finding;
use crate::spec::{Control, Lab, Lesson, Question, Quiz};
use labspec_core::Model;

/// What a rule checks. The runner walks the lesson ([`crate::lint`]).
pub(crate) enum Check {
    /// Every lab, including those of questions.
    Lab(fn(&Lab, &mut Vec<Finding>)),
    /// Every control of every lab.
    Control(fn(&Control, &mut Vec<Finding>)),
    /// Every quiz.
    Quiz(fn(&Quiz, &mut Vec<Finding>)),
    /// Every question.
    Question(fn(&Question, &mut Vec<Finding>)),
    /// The lesson as a whole.
    Lesson(fn(&Lesson, &mut Vec<Finding>)),
    /// Every lab with its loaded model.
    Model(fn(&Lab, &Model, &mut Vec<Finding>)),
}

/// The maximum number of findings in one text of a lab or a quiz.
pub(crate) const MAX_IN_TEXT: usize = 100;

/// Checks what a lab states about its model.
pub(crate) fn check_model(lab: &Lab, model: &Model, findings: &mut Vec<Finding>) {
    for check in CHECKS {
        if let Check::Model(check) = check {
            check(lab, model, findings);
        }
    }
}

// The build script lists the files of this folder.
include!(concat!(env!("OUT_DIR"), "/rules.rs"));

/// All rules: about lessons with their runs and claims, about the language, about models.
pub fn all() -> impl Iterator<Item = &'static Rule> {
    let language = labspec_expr::rules::ALL.iter().copied();
    let models = labspec_core::xml::rules::ALL.iter().copied();
    let both = labspec_bind::rules::ALL.iter().copied();
    LESSONS.iter().copied().chain(language).chain(both).chain(models)
}

/// Checks several lessons together.
pub(crate) fn across(lessons: &[&Lesson]) -> Vec<Finding> {
    let mut findings = duplicate_id::across(lessons);
    findings.extend(uneven_answers::across(lessons));
    crate::finding::sort(&mut findings);
    findings
}

/// The rule with this code, if it exists.
pub fn find(code: &str) -> Option<&'static Rule> {
    all().find(|rule| rule.code == code)
}

/// The long explanation of a rule, as Markdown: what, why, wrong, right.
pub fn explain(code: &str) -> Option<String> {
    find(code).map(Rule::explain)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    #[test]
    fn codes_have_one_meaning_and_are_in_words() {
        let mut seen = BTreeSet::new();
        for rule in super::all() {
            assert!(seen.insert(rule.code), "{} twice", rule.code);
            let words = rule.code.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
            assert!(words && !rule.summary.is_empty() && !rule.summary.ends_with('.'), "{}", rule.code);
        }
    }

    /// A file has a check, or its first comment names the function that decides the rule.
    #[test]
    fn pages_have_their_check_or_name_it() {
        let crate_folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let source = crate_folder.join("src");
        let (mut here, mut elsewhere) = (0, 0);
        for rule in super::LESSONS {
            let page = source.join(format!("rules/{}.rs", rule.code.replace('-', "_")));
            let text = std::fs::read_to_string(&page).unwrap();
            let code = text.split("#[cfg(test)]").next().unwrap_or("");
            if code
                .lines()
                .any(|line| line.starts_with("fn ") || line.starts_with("pub") && line.contains(" fn "))
            {
                here += 1;
                continue;
            }
            let pointer =
                text.lines().find_map(|line| line.strip_prefix("/// Decided by `")?.strip_suffix("`."));
            let (function, path) = pointer.and_then(|p| p.split_once("` in `")).unwrap_or_else(|| {
                panic!(
                    "{} has no check, and does not say \"Decided by `function` in `file`.\"",
                    page.display()
                )
            });
            // In this crate, or in another one by its path in the repository.
            let file = match path.starts_with("crates/") {
                true => crate_folder.join("../..").join(path),
                false => source.join(path),
            };
            let decides = std::fs::read_to_string(file).unwrap_or_default();
            assert!(
                decides.contains(&format!("fn {function}")),
                "{}: no {function} in {path}",
                page.display()
            );
            elsewhere += 1;
        }
        assert!(
            here >= 100 && here + elsewhere == super::LESSONS.len(),
            "{here} here, {elsewhere} elsewhere"
        );
    }

    #[test]
    fn explanations_show_both_examples() {
        insta::assert_snapshot!(super::explain("unknown-key").unwrap());
        assert_eq!(super::explain("no-such-rule"), None);
    }
}
