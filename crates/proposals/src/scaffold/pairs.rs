//! The runs that a question compares, in the order in which the question names them.

use crate::trace::{TraceRun, si, trials};
use labspec::json::{Number, Scalar};
use labspec::run::settings;
use labspec::spec::{Control, ControlKind, Lab, Question};
use labspec::verify::Stated;
use labspec_expr::Value;

/// The length of a run after a button is pressed, s.
const RUN_AFTER_PRESS: f64 = 10.0;
/// Words that state a change of a quantity, with the factor.
const CHANGES: [(&str, f64); 12] = [
    ("doubled", 2.0),
    ("double", 2.0),
    ("twice", 2.0),
    ("halved", 0.5),
    ("halve", 0.5),
    ("half", 0.5),
    ("tripled", 3.0),
    ("triple", 3.0),
    ("four times", 4.0),
    ("quadruple", 4.0),
    ("ten times", 10.0),
    ("tenfold", 10.0),
];

/// Runs, and pairs of them: before and after a change.
pub(super) struct RunPairs {
    pub(super) trials: Vec<TraceRun>,
    pub(super) pairs: Vec<(usize, usize)>,
}

/// The runs of a lab that a question names. The first is the unchanged lab.
pub(super) fn runs(question: &Question, question_text: &str, lab: &Lab, numbers: &[Stated]) -> RunPairs {
    let of_question: Vec<Stated> =
        numbers.iter().filter(|n| question.span.contains(&n.span.start) && !n.answer).cloned().collect();
    let stated: Vec<Stated> =
        of_question.iter().filter(|n| n.span.end <= question.q.span().end).cloned().collect();
    // Only numbers in the question itself are settings; numbers only in its options and explanation are results.
    let mut all = trials(lab, &stated);
    let base = all.first().cloned();
    for control in &lab.controls {
        if let Some(base) = &base {
            all.extend(changed(control, question_text, base));
        }
    }
    // Buttons that the question names are pressed in every run.
    let named = |label: &str| question_text.contains(&label.to_lowercase());
    let buttons = lab.controls.iter().filter(|c| matches!(c.kind, ControlKind::Button { .. }));
    let pressed: Vec<String> = buttons.map(|c| c.label.value.clone()).filter(|label| named(label)).collect();
    if !pressed.is_empty() {
        all.retain(|t| t.press.is_empty());
        for t in &mut all {
            t.press = pressed.clone();
            // The process that a button starts takes some time.
            t.until = t.until.or(lab.stop_at.is_none().then_some(RUN_AFTER_PRESS));
        }
    }
    let pairs = pairs(&all, question_text, lab, &stated);
    RunPairs { trials: all, pairs }
}

/// A run with a changed control, if the question names the label of the control together with a word for a change.
fn changed(control: &Control, question_text: &str, base: &TraceRun) -> Option<TraceRun> {
    let label = control.label.as_str();
    let ControlKind::Slider { value: start, min, .. } = &control.kind else { return None };
    let words = label.split(|c: char| !c.is_alphanumeric()).filter(|w| w.chars().count() > 2);
    let shared = words.filter(|w| super::relation::contains_words(question_text, &w.to_lowercase())).count();
    let (_, factor) =
        CHANGES.iter().find(|(words, _)| super::relation::contains_words(question_text, words))?;
    if shared == 0 {
        return None;
    }
    let step = control.step().unwrap_or(0.0);
    let target = start.value * factor;
    let x = if step > 0.0 { min.value + ((target - min.value) / step).round() * step } else { target };
    let x: f64 = format!("{x:.12}").parse().unwrap_or(x);
    let reached = settings::value(control, &Value::Number(x)).is_ok();
    if !reached || x == start.value || (x - target).abs() > 0.05 * target.abs() {
        return None;
    }
    Some(TraceRun {
        words: format!("with \"{label}\" at {x}"),
        set: vec![(label.to_string(), Scalar::Number(Number { value: x, span: 0..0 }))],
        ..base.clone()
    })
}

/// Pairs of before and after, in the order in which the question names the runs. A run that it does not name is the
/// unchanged lab, which comes first.
fn pairs(all: &[TraceRun], question_text: &str, lab: &Lab, stated: &[Stated]) -> Vec<(usize, usize)> {
    let place = |t: &TraceRun| {
        let (x, unit) = t.named?;
        stated.iter().position(|n| n.dimension.agrees(&unit) && (si(n) - x).abs() <= 1e-9 * x.abs())
    };
    let mut list = Vec::new();
    for (i, a) in all.iter().enumerate().skip(1) {
        for (j, b) in all.iter().enumerate().skip(1) {
            let alike = a.timestep.is_some() == b.timestep.is_some()
                && a.set.iter().map(|(l, _)| l).eq(b.set.iter().map(|(l, _)| l));
            if alike && place(a).zip(place(b)).is_some_and(|(p, q)| p < q) {
                list.push((i, j));
            }
        }
    }
    for (i, t) in all.iter().enumerate().skip(1) {
        list.push(if is_initial_run(t, question_text, lab) { (i, 0) } else { (0, i) });
    }
    list
}

/// Whether the question goes from this run to the unchanged lab: "from 10 to 1", where 1 is the initial value.
fn is_initial_run(t: &TraceRun, question_text: &str, lab: &Lab) -> bool {
    let [(label, value)] = t.set.as_slice() else { return false };
    let Some(control) = lab.control(label) else { return false };
    let written = |value: &Scalar| match value {
        Scalar::Number(n) => n.value.to_string(),
        Scalar::Text(text) => text.value.to_lowercase(),
        Scalar::Bool(b, _) => b.to_string(),
    };
    let start = match &control.kind {
        ControlKind::Slider { value, .. } => value.value.to_string(),
        ControlKind::Select { value, .. } => written(value),
        ControlKind::Button { .. } => return false,
    };
    let from = format!("from {} ", written(value));
    question_text.find(&from).is_some_and(|at| {
        let rest = question_text.get(at + from.len()..).unwrap_or_default();
        rest.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | '?')).take(4).any(|w| w == start)
    })
}
