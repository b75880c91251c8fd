use super::Check;
use super::wording::normalized_words;
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The explanation calls a different option correct than the answer key.
pub const EXPLAINS_ANOTHER_OPTION: &Rule = &Rule {
    code: "explains-another-option",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the explanation calls a different option correct than the answer key",
    why: "a student reads that an option is correct that is graded as wrong",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": ⟦0⟧, "explain": "Option B is right: mass cancels."}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1, "explain": "Option B is right: mass cancels."}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

const ORDINALS: [&str; 6] = ["first", "second", "third", "fourth", "fifth", "sixth"];
/// The number of options that have a letter.
const MAX_OPTIONS: usize = 26;
const OPTION_NOUNS: [&str; 3] = ["option", "answer", "choice"];
const RIGHT: [&str; 2] = ["right", "correct"];

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let QuestionKind::Choice { options, key: Some(keyed), .. } = &question.kind else { return };
    let (Some(explain), Some(key)) = (&question.explain, question.right_option()) else { return };
    let sentences: Vec<String> =
        explain.as_str().split(". ").map(|sentence| format!(" {} ", normalized_words(sentence))).collect();
    let named = (0..options.len().min(MAX_OPTIONS)).filter(|i| {
        let option = options.get(*i).map_or("", |option| option.as_str());
        sentences.iter().any(|sentence| calls_correct(sentence, *i, option))
    });
    let named: Vec<usize> = named.collect();
    if let [other] = named.as_slice()
        && *other != key
        && let Some(option) = options.get(*other)
    {
        findings.push(
            Finding::new(
                EXPLAINS_ANOTHER_OPTION,
                keyed.span.clone(),
                format!(
                    "the answer is option {}, but the explanation calls option {} correct",
                    letter(key),
                    letter(*other)
                ),
            )
            .related(explain.span(), "the explanation")
            .related(option.span(), "the option that it calls correct")
            .help("correct the answer, which counts from 0, or the explanation"),
        );
    }
}

fn letter(i: usize) -> char {
    u8::try_from(i).ok().and_then(|i| b'A'.checked_add(i)).map_or('?', char::from)
}

/// Words of somebody else's opinion.
const OPINIONS: [&str; 5] = ["believe", "believes", "think", "thinks", "say"];
/// The number of words between them and what they are about.
const OPINION_LENGTH: usize = 3;

/// Whether a text states a sentence as its own and whole: not `many believe that …`, and not `… for the speed`.
fn states(text: &str, sentence: &str) -> bool {
    text.match_indices(sentence).any(|(start, _)| {
        let before = text.get(..start).unwrap_or("");
        let behind = text.get(start + sentence.len()..).unwrap_or("");
        let is_opinion =
            before.split_whitespace().rev().take(OPINION_LENGTH).any(|word| OPINIONS.contains(&word));
        !is_opinion && !["for ", "about ", "in "].iter().any(|word| behind.starts_with(word))
    })
}

/// Whether a text explicitly calls this option correct.
fn calls_correct(text: &str, i: usize, option: &str) -> bool {
    let letter = letter(i).to_lowercase().to_string();
    let words = normalized_words(option);
    let long = words.chars().count() >= 3;
    RIGHT.iter().any(|right| {
        let named = OPTION_NOUNS.iter().any(|thing| {
            let ordinal = ORDINALS.get(i).is_some_and(|o| {
                states(text, &format!(" {o} {thing} is {right} "))
                    || states(text, &format!(" {right} {thing} is the {o} "))
            });
            ordinal
                || states(text, &format!(" {thing} {letter} is {right} "))
                || states(text, &format!(" {right} {thing} is {letter} "))
                || (long && states(text, &format!(" {right} {thing} is {words} ")))
        });
        named
            || (long
                && states(text, &format!(" {words} is {right} "))
                && !text.contains(&format!(" not {words} is ")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_explicit_statements_count() {
        let calls = |text: &str| {
            (0..3)
                .filter(|i| {
                    calls_correct(
                        &format!(" {} ", normalized_words(text)),
                        *i,
                        ["up", "it falls", "it stays"][*i],
                    )
                })
                .collect::<Vec<_>>()
        };
        assert_eq!(calls("Option B is right."), [1]);
        assert_eq!(calls("The correct answer is the third."), [2]);
        assert_eq!(calls("The right option is \"it falls\"."), [1]);
        for text in [
            "Option B is wrong, it falls at first.",
            "Option A is correct for the speed.",
            "Many believe that the first answer is correct.",
        ] {
            assert_eq!(calls(text), [] as [usize; 0], "{text}");
        }
    }
}
