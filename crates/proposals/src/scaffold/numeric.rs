//! Questions with a number: the measure that the question names, in the run that it states, or the origin that a trace finds.

use super::change;
use super::decision::is_no_depth;
use super::outcome::{OF_TRACE, ScaffoldOutcome};
use super::question::QuestionText;
use crate::trace::{
    Candidate, MeasureMatch, Origin, ProposedVerify, TraceRun, TracedLab, Traces, factor, si,
};
use labspec::run::StepVariant;
use labspec::spec::{Question, QuestionKind};
use labspec::verify::{RunCache, Stated};
use std::collections::BTreeSet;

/// The object of a question with a numeric answer.
pub(super) fn numeric(
    question: &Question,
    found: &Traces<'_>,
    labs: &[&TracedLab<'_>],
    stage: &RunCache<'_>,
) -> ScaffoldOutcome {
    let QuestionKind::Numeric { answer: Some(_), .. } = &question.kind else {
        return ScaffoldOutcome::Open("it has no answer".into());
    };
    let tol = question.numeric().map_or(0.0, |(_, tol)| tol);
    let numbers: Vec<Stated> = found.numbers.iter().map(|n| n.stated.clone()).collect();
    let asked = QuestionText::new(question, &[], &numbers);
    let answer = numbers.iter().find(|s| s.answer && question.span.contains(&s.span.start));
    let named = answer.and_then(|answer| named(&asked, answer, tol, labs, stage));
    if let Some(named) = &named
        && named.is_answer
    {
        return named.outcome();
    }
    if let Some(outcome) = traced(question, &asked, found, tol) {
        return outcome;
    }
    match named {
        Some(named) => named.outcome(),
        None => ScaffoldOutcome::Open(
            "no run of the labs of the lesson, and no formula of the explanation, gives this value".into(),
        ),
    }
}

/// The measure that a question names, with its value.
struct NamedMeasure {
    verify: ProposedVerify,
    value: f64,
    is_answer: bool,
}

impl NamedMeasure {
    fn outcome(&self) -> ScaffoldOutcome {
        let verify = self.verify.clone();
        let expression = verify.value.clone().unwrap_or_default();
        if self.is_answer {
            let values = vec![(expression, self.value)];
            return ScaffoldOutcome::Proposed { verify, values, undecided: Vec::new(), verdict: None };
        }
        let value = labspec::verify::significant(self.value);
        let why = format!("the measure that the question seems to name, {expression}, is {value}");
        ScaffoldOutcome::Skeleton { why, verify }
    }
}

/// The measure that the question names, in the run that it states: in the first lab that has one. If several measures can be
/// meant, all must give the answer.
fn named(
    asked: &QuestionText,
    answer: &Stated,
    tol: f64,
    labs: &[&TracedLab<'_>],
    stage: &RunCache<'_>,
) -> Option<NamedMeasure> {
    let of_lab = |tried: &&TracedLab<'_>| {
        if change::compares(&asked.text, tried.lab, &asked.stated) {
            return None;
        }
        let run = change::stated_run(&asked.text, tried.lab, &asked.stated, None)?;
        let groups = asked.quantity(tried, &asked.text, std::slice::from_ref(&run)).groups;
        let values = tried.values_of(&run, stage, StepVariant::NOMINAL);
        let exists = |i: &&usize| {
            let agrees = tried.candidates.get(**i).is_some_and(|c| c.dimension.agrees(&answer.dimension));
            let is_depth = !is_no_depth(tried, **i, &values);
            agrees && is_depth && values.get(**i).is_some_and(|x| x.is_finite())
        };
        let mut existing =
            groups.iter().map(|group| group.iter().filter(exists).copied().collect::<Vec<_>>());
        let group = existing.find(|group| !group.is_empty())?;
        let measures: Vec<(&Candidate, f64)> =
            group.iter().filter_map(|i| Some((tried.candidates.get(*i)?, *values.get(*i)?))).collect();
        Some(of_measures(tried, &run, &measures, answer, tol))
    };
    let mut all = labs.iter().filter_map(of_lab);
    let first = all.next()?;
    match first.is_answer {
        true => Some(first),
        false => all.find(|named| named.is_answer).or(Some(first)),
    }
}

fn of_measures(
    tried: &TracedLab<'_>,
    run: &TraceRun,
    measures: &[(&Candidate, f64)],
    answer: &Stated,
    tol: f64,
) -> NamedMeasure {
    let ratio = |c: &Candidate| answer.dimension.factor / c.dimension.factor;
    let in_unit = |(c, x): &(&Candidate, f64)| x * ratio(c);
    let is_answer = |sign: f64| measures.iter().all(|m| (sign * in_unit(m) - answer.read.value).abs() <= tol);
    let sign = if is_answer(-1.0) { "-" } else { "" };
    let is_answer = is_answer(1.0) || is_answer(-1.0);
    let mut verify = ProposedVerify::default();
    verify.lab = Some(tried.address.to_string());
    let mut value = f64::NAN;
    if let Some(measure) = measures.first() {
        let (c, _) = measure;
        let name = verify.measured(0, Some(run), &c.text, Some(c));
        verify.value = Some(format!("{}{name}", factor(sign, ratio(c))));
        value = if sign.is_empty() { in_unit(measure) } else { -in_unit(measure) };
    }
    NamedMeasure { verify, value, is_answer }
}

/// The origin of the answer, or of a number in the text of the question that equals it.
fn traced(
    question: &Question,
    asked: &QuestionText,
    found: &Traces<'_>,
    tol: f64,
) -> Option<ScaffoldOutcome> {
    let QuestionKind::Numeric { answer: Some(answer), .. } = &question.kind else { return None };
    let inside = found.numbers.iter().filter(|n| question.span.contains(&n.stated.span.start));
    let mut near: Vec<_> =
        inside.filter(|n| n.stated.answer || (n.stated.read.value - answer.value).abs() <= tol).collect();
    near.sort_by_key(|n| !n.stated.answer);
    let hits = near.into_iter().filter_map(|n| match &n.origin {
        Origin::From(hit) if !hit.fragile => Some(hit),
        _ => None,
    });
    hits.into_iter().find_map(|hit| of_origin(hit, asked, found))
}

fn of_origin(hit: &MeasureMatch, asked: &QuestionText, found: &Traces<'_>) -> Option<ScaffoldOutcome> {
    let mut verify = ProposedVerify::default();
    let value = match hit.place {
        None => format!("{}{}", hit.factor, hit.measure),
        Some((lab, trial)) => {
            let tried = found.labs.get(lab)?;
            let run = tried.trials.get(trial)?;
            let candidate = tried.candidates.iter().find(|c| c.text == hit.measure)?;
            if !is_stated(run, asked) || !is_asked(candidate, tried, asked, run) {
                return None;
            }
            verify.lab = Some(tried.address.to_string());
            format!("{}{}", hit.factor, verify.traced(OF_TRACE + trial, tried, trial, &hit.measure))
        }
    };
    verify.value = Some(value.clone());
    let values = vec![(value, hit.value)];
    Some(ScaffoldOutcome::Proposed { verify, values, undecided: Vec::new(), verdict: None })
}

/// Whether the question states the setting of a run: another setting has the answer by coincidence.
fn is_stated(run: &TraceRun, asked: &QuestionText) -> bool {
    let is_label = run.label.is_empty() || asked.text.contains(&run.label.to_lowercase());
    let same = |s: &Stated, x: f64| (si(s) - x).abs() <= 1e-9 * x.abs();
    is_label && run.named.is_none_or(|(x, _)| asked.stated.iter().any(|s| same(s, x)))
}

/// Whether the question names the measure: its quantity, or a word of it.
fn is_asked(candidate: &Candidate, tried: &TracedLab<'_>, asked: &QuestionText, run: &TraceRun) -> bool {
    let words: BTreeSet<String> = crate::trace::split_words(&asked.text).collect();
    let groups = asked.quantity(tried, &asked.text, std::slice::from_ref(run)).groups;
    let mut named = groups.iter().flatten().filter_map(|i| tried.candidates.get(*i));
    !candidate.words.is_disjoint(&words) || named.any(|c| c.text == candidate.text)
}
