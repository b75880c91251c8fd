use super::Check;
use super::wording::{TextNumber, normalized_words, numbers, plain};
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The explanation of a numeric question gives a different number than its answer, or that of a statement the other answer.
pub const ANSWER_AGAINST_EXPLANATION: &Rule = &Rule {
    code: "answer-against-explanation",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the explanation of a question gives a different number than its answer, or calls a true statement false",
    why: "a student who follows the explanation gets a number that is graded as wrong",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast, in m/s?", "answer": ⟦12.65⟧, "tol": 0.05, "unit": "m/s", "explain": "$v = \\sqrt{2 g h}$ = 12.64 m/s."}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast, in m/s?", "answer": 12.64, "tol": 0.05, "unit": "m/s", "explain": "$v = \\sqrt{2 g h}$ = 12.64 m/s."}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

/// The relative difference below which a number of the explanation counts as the answer.
const SAME_NUMBER: f64 = 0.02;
/// The number of characters before and after a number that are searched for its unit and meaning.
const CONTEXT_LENGTH: usize = 60;
/// How a common mistake changes a number.
const MISTAKE_FACTORS: [(f64, &str); 10] = [
    (-1.0, "the sign differs"),
    (10.0, "the explanation gives a tenth of the answer"),
    (100.0, "the explanation gives a hundredth of the answer"),
    (0.1, "the explanation gives ten times the answer"),
    (0.01, "the explanation gives a hundred times the answer"),
    (1000.0, "the explanation gives a thousandth of the answer"),
    (0.001, "the explanation gives a thousand times the answer"),
    (180.0 / std::f64::consts::PI, "the explanation gives the answer in radians"),
    (std::f64::consts::PI / 180.0, "the explanation gives the answer in degrees"),
    (2.0, "the explanation gives half of the answer"),
];

/// Words with which an explanation begins that calls the statement true, or false.
const TRUE_WORDS: [&str; 9] =
    ["true", "right", "correct", "yes", "wahr", "richtig", "vrai", "verdadero", "vero"];
const FALSE_WORDS: [&str; 7] = ["false", "wrong", "incorrect", "no", "falsch", "faux", "falso"];

/// Words with which a statement denies something.
const NEGATIONS: [&str; 14] = [
    " not ", " no ", " never ", " none ", " t ", " nicht ", " kein ", " keine ", " nie ", " ne ", " n ",
    " pas ", " non ", " nunca ",
];
/// Words with which the first sentence of an explanation goes on that agrees with a part of the statement only.
const CONCESSIONS: [&str; 7] = [" but ", " however ", " aber ", " jedoch ", " mais ", " pero ", " ma "];

/// Reports an explanation of a statement that begins with the other answer.
fn check_statement(question: &Question, findings: &mut Vec<Finding>) {
    let (Some(key), Some(explain)) = (question.key(), &question.explain) else { return };
    let Some(right) = question.keyed().map(|right| !right.is_empty()) else { return };
    let text = plain(explain.as_str());
    let text = text.trim_start_matches(|c: char| !c.is_alphanumeric());
    let end = text.find(|c: char| !c.is_alphanumeric()).unwrap_or(text.len());
    let (word, behind) = (text.get(..end).unwrap_or("").to_lowercase(), text.get(end..).unwrap_or(""));
    // `True friction …` is not an answer.
    let stands_alone =
        behind.trim_start().starts_with(['.', ':', ',', ';', '!', '—', '–', '*']) || behind.trim().is_empty();
    // "No" agrees with a statement that denies something, and "yes, but" with a part of it.
    let words = format!(" {} ", normalized_words(question.q.as_str()));
    let is_denial = NEGATIONS.iter().any(|negation| words.contains(negation));
    let first = explain.as_str().split(". ").next().unwrap_or("");
    let explanation = format!(" {} ", normalized_words(first));
    let concedes = CONCESSIONS.iter().any(|but| explanation.contains(but));
    if is_denial || concedes {
        return;
    }
    let says = |list: &[&str]| list.contains(&word.as_str()) && stands_alone;
    if (right && says(&FALSE_WORDS)) || (!right && says(&TRUE_WORDS)) {
        let message = format!("the answer is {right}, but its explanation begins with \"{word}\"");
        findings.push(
            Finding::new(ANSWER_AGAINST_EXPLANATION, key.span.clone(), message)
                .related(explain.span(), "the explanation")
                .help("correct the answer or the explanation"),
        );
    }
}

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    if matches!(question.kind, QuestionKind::TrueFalse { .. }) {
        return check_statement(question, findings);
    }
    let QuestionKind::Numeric { answer: Some(answer), unit, .. } = &question.kind else { return };
    let Some(explain) = &question.explain else { return };
    let key = answer.value;
    let decimals = format!("{key}").split_once('.').map_or(0, |(_, d)| d.len());
    let is = |n: &TextNumber, value: f64, decimals: usize| {
        (n.value - value).abs() <= 0.5000001 * 0.1_f64.powi(n.decimals.min(decimals) as i32)
    };
    let html = explain.as_str();
    let all = numbers(html);
    if key == 0.0 || all.iter().any(|n| is(n, key, decimals)) {
        return;
    }
    let unit = unit.as_ref().map_or(String::new(), |u| plain_unit(u.as_str()));
    let in_its_unit = |n: &&TextNumber| !unit.is_empty() && has_unit(html, n, &unit);
    let only = all.iter().filter(in_its_unit).count() == 1;
    let result = |n: &&TextNumber| {
        let precise = n.significant >= 2 || n.decimals >= 2;
        precise && (is_result(html, n, &unit) || only && in_its_unit(n))
    };
    let tolerance = question.numeric().map_or(0.0, |(_, tol)| tol.abs());
    let results: Vec<&TextNumber> = all.iter().filter(result).collect();
    let slip_of = |n: &&TextNumber| {
        let slip = MISTAKE_FACTORS.iter().find(|(by, _)| is(n, key / by, decimals + 2) && n.value != 0.0);
        match slip {
            _ if (n.value - key).abs() <= SAME_NUMBER * key.abs() => Some("the printed digits differ"),
            _ if ((n.value - key).abs() - 0.1_f64.powi(decimals as i32)).abs() < 1e-9 => {
                Some("the last digits differ by one")
            }
            slip => slip.map(|(_, words)| *words),
        }
    };
    let slipped = results.iter().find_map(|n| Some((*n, slip_of(n)?)));
    // The only number in the unit of the answer is another one. Several may be steps towards it.
    let other = results.iter().find(|n| only && in_its_unit(n) && (n.value - key).abs() > tolerance);
    let other = other.filter(|_| !is_combined(key, &all, question));
    let Some((n, why)) = slipped.or(other.map(|n| (*n, "no number in the explanation is the answer"))) else {
        return;
    };
    let printed = html.get(n.span.clone()).unwrap_or("");
    let sign = if n.value < 0.0 { "-" } else { "" };
    let message = format!("the answer is {key}, but its explanation gives {sign}{printed}: {why}");
    findings.push(
        Finding::new(ANSWER_AGAINST_EXPLANATION, answer.span.clone(), message)
            .related(explain.span_of(n.span.clone()), "the explanation")
            .help("compute it again, and write the same number in both places"),
    );
}

/// Whether an answer is the sum or the difference of two numbers, one of the explanation and one of it or of the question.
fn is_combined(key: f64, explained: &[TextNumber], question: &Question) -> bool {
    let given = numbers(question.q.as_str());
    // The difference of two numbers may have any sign, so that a negative answer would never be compared.
    let mut explained_numbers = explained.iter().enumerate().filter(|_| key > 0.0);
    explained_numbers.any(|(i, a)| {
        explained.iter().skip(i + 1).chain(&given).any(|b| {
            let digit = 0.1_f64.powi(a.decimals.max(b.decimals) as i32);
            let is_key = |x: f64| (x - key).abs() <= 1.5 * digit;
            a.significant > 1
                && b.significant > 1
                && (is_key((a.value - b.value).abs()) || is_key(a.value + b.value))
        })
    })
}

/// Whether the unit of the answer follows a number.
fn has_unit(html: &str, n: &TextNumber, unit: &str) -> bool {
    let after: String = html.get(n.span.end..).unwrap_or("").chars().take(CONTEXT_LENGTH).collect();
    let after = plain_unit(&plain(&after));
    let behind = after.strip_prefix(unit).and_then(|rest| rest.chars().next());
    after.starts_with(unit) && !behind.is_some_and(|c| c.is_alphanumeric() || c == '/' || c == '·')
}

/// Whether a number is the result of a line of the explanation: it follows `=`, `≈`, `:` or `is`, and has the unit of the answer.
fn is_result(html: &str, n: &TextNumber, unit: &str) -> bool {
    // The text near the number.
    let back = html
        .get(..n.span.start)
        .unwrap_or("")
        .char_indices()
        .rev()
        .nth(CONTEXT_LENGTH)
        .map_or(0, |(offset, _)| offset);
    let before = plain(html.get(back..n.span.start).unwrap_or(""));
    let before = before.trim_end_matches(['$', ' ', '-', '−', '{', '~']).trim_end_matches("about");
    let before = before.trim_end();
    let behind = ["=", "≈", ":", " is", "\\approx"].iter().any(|mark| before.ends_with(mark));
    let after: String = html.get(n.span.end..).unwrap_or("").chars().take(CONTEXT_LENGTH).collect();
    let after = plain_unit(&plain(&after));
    // A number in another unit is another quantity.
    let ends = after.is_empty() || after.starts_with(['.', ',', ';', ')', ':']);
    let in_its_unit = !unit.is_empty() && after.starts_with(unit);
    behind && (ends || in_its_unit)
}

/// A unit, or the text after a number, without spaces and formula markup.
fn plain_unit(text: &str) -> String {
    text.chars()
        .filter(|c| !c.is_whitespace() && !"$\\^{}°".contains(*c))
        .collect::<String>()
        .replace('²', "2")
}
