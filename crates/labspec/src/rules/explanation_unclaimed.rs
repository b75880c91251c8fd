//! Numbers in the explanation of a verified question that no claim checks.

use crate::json::Scalar;
use crate::spec::{ControlKind, Lab, Lesson, Question, Quiz, Run, SweepValue, Verify, VerifyLab};
use crate::verify::{Counted, Stated};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// The explanation of a verified question states a number that no claim checks.
pub const EXPLANATION_UNCLAIMED: &Rule = &Rule {
    code: "explanation-unclaimed",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "the explanation of a verified question states a number that no claim checks",
    why: "a student reads the explanation beside a verified answer; only the answer was checked",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It falls and lands after ⟦0.52 s⟧.",
 "verify": {"lab": "#1", "measure": {"z": "final(data.qpos[2])"}, "options": ["z < 0.9", "z > 1.1"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It falls and lands after 0.44 s.",
 "verify": {"lab": "#1", "measure": {"z": "final(data.qpos[2])", "t": "first(contact('ball', 'floor'))"}, "options": ["z < 0.9", "z > 1.1"], "says": [["0.44 s", "t"]]}}"##,
    ),
};

/// Reports the numbers of explanations that are not claimed, once for each question with a true answer; `verified` are the spans of
/// their `verify` objects. Numbers that the question, its answer or a setting gives are not results. Returns the reported numbers.
pub(crate) fn check_explanations(
    lesson: &Lesson,
    counted: &Counted,
    verified: &[Range<usize>],
    findings: &mut Vec<Finding>,
) -> Vec<Stated> {
    let mut reported: Vec<Stated> = Vec::new();
    for (_, question) in lesson.quizzes.iter().flat_map(Quiz::numbered) {
        let Some(explanation) = &question.explain else { continue };
        let is_verified = |verify: &&Verify| verify.claims_answer() && verified.contains(&verify.span);
        let Some(verify) = question.verify.as_ref().filter(is_verified) else { continue };
        let whole = lesson.whole(verify);
        let lab = match &whole.lab {
            Some(VerifyLab::Reference(_, address)) => lesson.lab(address),
            Some(VerifyLab::Inline(lab)) => Some(&**lab),
            _ => question.sim(),
        };
        let mut given = given_by_runs(&whole.runs);
        given.extend(lab.into_iter().flat_map(given_by_lab));
        given.extend(given_by_question(question, counted));
        let span = explanation.span();
        let inside = |s: &&Stated| span.start <= s.span.start && s.span.end <= span.end;
        // The answer itself was checked, at the digits that the explanation prints.
        let answer = question.numeric().map(|(answer, _)| answer);
        let is_answer = |s: &Stated| answer.is_some_and(|x| s.read.is(x));
        let open = counted.left.iter().filter(inside).filter(|s| !is_given(s, &given) && !is_answer(s));
        let open: Vec<&Stated> = open.collect();
        let Some(first) = open.first() else { continue };
        let others = match open.len() - 1 {
            0 => String::new(),
            1 => ", and 1 more".to_string(),
            n => format!(", and {n} more"),
        };
        let message = format!("no claim checks {} in the explanation of this question{others}", first.quote);
        findings.push(Finding::new(EXPLANATION_UNCLAIMED, first.span.clone(), message).help(format!(
            "add [\"{}\", \"…\"] to the `says` of its `verify`, with the measure that gives it; or delete it",
            first.quote
        )));
        reported.extend(open.into_iter().cloned());
    }
    reported
}

/// The numbers that the runs of a claim set.
fn given_by_runs(runs: &[Run]) -> Vec<f64> {
    let mut all = Vec::new();
    for run in runs {
        all.extend(run.set.iter().filter_map(|(_, value)| number(value)));
        all.extend(run.press.iter().map(|(_, time)| time.value));
        all.extend(run.until.iter().map(|until| until.value));
        let changed = run.model.iter().flat_map(|change| change.value.split_whitespace());
        all.extend(changed.filter_map(|part| part.parse::<f64>().ok()));
        for axis in run.sweep.iter().flat_map(|sweep| &sweep.axes) {
            all.extend(axis.values.iter().filter_map(|value| match value {
                SweepValue::Number(x) => Some(*x),
                SweepValue::Text(_) => None,
            }));
        }
    }
    all
}

/// The numbers that the controls of a lab can be set to at their ends and at the start.
fn given_by_lab(lab: &Lab) -> Vec<f64> {
    let of_slider = |kind: &ControlKind| match kind {
        ControlKind::Slider { min, max, value, .. } => vec![min.value, max.value, value.value],
        _ => Vec::new(),
    };
    let mut all: Vec<f64> = lab.controls.iter().flat_map(|control| of_slider(&control.kind)).collect();
    all.extend(lab.stop_at.iter().map(|stop| stop.value));
    all
}

/// The numbers that the question and its options state.
fn given_by_question(question: &Question, counted: &Counted) -> Vec<f64> {
    let texts = question.html().into_iter().filter(|text| Some(*text) != question.explain.as_ref());
    let spans: Vec<_> = texts.map(crate::source::Text::span).collect();
    let stated = counted.claimed.iter().chain(&counted.left).chain(&counted.others);
    let of_question =
        |s: &&Stated| spans.iter().any(|range| range.start <= s.span.start && s.span.end <= range.end);
    stated.filter(of_question).flat_map(values).collect()
}

fn number(value: &Scalar) -> Option<f64> {
    match value {
        Scalar::Number(n) => Some(n.value),
        Scalar::Text(text) => text.value.parse().ok(),
        Scalar::Bool(..) => None,
    }
}

/// A number as written, and in SI units.
fn values(s: &Stated) -> [f64; 2] {
    [s.read.value, s.read.value / s.dimension.factor]
}

fn is_given(s: &Stated, given: &[f64]) -> bool {
    let equal = |a: f64, b: f64| (a.abs() - b.abs()).abs() <= 1e-9 * a.abs().max(b.abs());
    given.iter().any(|x| values(s).into_iter().any(|value| equal(value, *x)))
}
