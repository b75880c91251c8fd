//! Proposes a first `verify` object for questions and labs that have none: `labspec scaffold`.
//!
//! | stage | module |
//! |---|---|
//! | the relation that the words of an option state: same, more, twice, gone | `relation` |
//! | the two runs that a question compares | `pairs` |
//! | the measure that distinguishes the options, and its values | `choose` |
//! | the objects, inserted into the lesson | this module |
//!
//! Every proposal was run, and is checked again as part of the lesson. The measure is selected by the words of the question,
//! independent of its key. If the runs support another option, this is reported, and nothing is proposed.

mod choose;
mod pairs;
mod relation;

use crate::trace::{self, Origin, ProposedVerify, TracedLab, Traces, trace};
use choose::MeasureChoice;
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::lint::reload_lesson;
use labspec::spec::{ChoiceStyle, LabAddress, Lesson, Question, QuestionKind};
use labspec::verify::{RunCache, Verdict};
use std::ops::Range;

/// A question or a lab without a claim, and the result.
#[derive(Clone, Debug)]
pub struct Scaffold {
    /// `quiz drop, question 2`, `lab #1`.
    pub name: String,
    /// The span of its object in the file, including braces.
    pub span: Range<usize>,
    /// The result.
    pub found: ScaffoldOutcome,
}

/// The result for a question or a lab.
#[derive(Clone, Debug)]
pub enum ScaffoldOutcome {
    /// A proposed object.
    Proposed {
        /// The object.
        verify: ProposedVerify,
        /// The names of the measures in the object, and their values.
        values: Vec<(String, f64)>,
        /// Options, counted from 1, that the runs do not decide.
        undecided: Vec<usize>,
        /// The verdict of a check; `None` for a lab, whose object contains only quotes.
        verdict: Option<(Verdict, String)>,
    },
    /// The runs support another option than the key.
    Contradicted {
        /// The option, from 0.
        option: usize,
        /// The measures and their values.
        values: Vec<(String, f64)>,
    },
    /// Nothing could be proposed, for this reason.
    Open(String),
}

/// Processes every question and lab of a lesson without claims. `report_progress` receives descriptions
/// of the current activity.
pub fn scaffold(lesson: &Lesson, models: &Models, report_progress: &mut dyn FnMut(&str)) -> Vec<Scaffold> {
    let found = trace(lesson, models, report_progress);
    let stage = RunCache::new(models);
    let mut all = Vec::new();
    let blocks = trace::blocks(&found);
    for (address, lab) in lesson.addressed() {
        if lab.verify.is_some() || matches!(address, LabAddress::Sim { .. }) {
            continue;
        }
        let block = blocks.iter().find(|(entry, _)| *entry == address).map(|(_, block)| block.clone());
        let found = match block {
            Some(verify) => {
                ScaffoldOutcome::Proposed { verify, values: Vec::new(), undecided: Vec::new(), verdict: None }
            }
            None => ScaffoldOutcome::Open(
                "no number of the text comes from this lab, so there is nothing to quote".into(),
            ),
        };
        all.push(Scaffold { name: format!("lab {address}"), span: lab.span.clone(), found });
    }
    for quiz in &lesson.quizzes {
        let id = quiz.id.as_ref().map_or("", |t| t.as_str());
        for (number, question) in quiz.numbered() {
            let claims = question.verify.as_ref().is_some_and(|v| v.claims_answer());
            if claims || matches!(question.kind, QuestionKind::Open { .. }) {
                continue;
            }
            let name = format!("quiz {id}, question {number}");
            report_progress(&name);
            let found = match &question.verify {
                Some(_) => ScaffoldOutcome::Open(
                    "it already has a `verify`, but without a condition for each option".into(),
                ),
                None => propose(lesson, question, &found, &stage),
            };
            all.push(Scaffold { name, span: question.span.clone(), found });
        }
    }
    judge(lesson, models, &mut all);
    all
}

/// The proposal for a question.
fn propose(
    lesson: &Lesson,
    question: &Question,
    found: &Traces<'_>,
    stage: &RunCache<'_>,
) -> ScaffoldOutcome {
    match &question.kind {
        QuestionKind::Choice { style: ChoiceStyle::Multiple, .. } | QuestionKind::TrueFalse { .. } => {
            ScaffoldOutcome::Open(
                "proposals are for questions with one correct option and for numbers".into(),
            )
        }
        QuestionKind::Choice { options, .. } => {
            let Some(key) = question.right_option() else {
                return ScaffoldOutcome::Open("it has no key".into());
            };
            let labs = labs(question, found);
            if labs.is_empty() {
                return ScaffoldOutcome::Open(
                    "there is no lab to run it in: write one under `verify`".into(),
                );
            }
            let numbers: Vec<_> = found.numbers.iter().map(|n| n.stated.clone()).collect();
            match choose::choose(question, options, &labs, &numbers, stage) {
                Err(why) => ScaffoldOutcome::Open(why),
                Ok(choice) if choice.option != key => {
                    ScaffoldOutcome::Contradicted { option: choice.option, values: choice.values.clone() }
                }
                Ok(choice) => proposed(lesson, question, found, choice),
            }
        }
        QuestionKind::Numeric { .. } => numeric(question, found),
        QuestionKind::Open { .. } => ScaffoldOutcome::Open("an open question has no key".into()),
    }
}

/// The labs of a question: its own, otherwise those of the lesson.
fn labs<'t, 'l>(question: &Question, found: &'t Traces<'l>) -> Vec<&'t TracedLab<'l>> {
    let of_question: Vec<&TracedLab<'_>> =
        found.labs.iter().filter(|t| t.owner.as_ref().is_some_and(|o| *o == question.span)).collect();
    if !of_question.is_empty() || question.sim().is_some() {
        return of_question;
    }
    found.labs.iter().filter(|t| matches!(t.address, LabAddress::Lab(_))).collect()
}

/// The object of a question with options.
fn proposed(
    lesson: &Lesson,
    question: &Question,
    found: &Traces<'_>,
    choice: MeasureChoice<'_, '_>,
) -> ScaffoldOutcome {
    let mut block = ProposedVerify::default();
    let mut values = Vec::new();
    let conditions = choice.conditions(&mut block, &mut values);
    // Numbers of the question that originate from the same lab.
    for n in found.numbers.iter().filter(|n| question.span.contains(&n.stated.span.start) && !n.stated.answer)
    {
        let Origin::From(hit) = &n.origin else { continue };
        let Some((lab, trial)) = hit.place else { continue };
        let Some(tried) = found.labs.get(lab).filter(|t| t.address == choice.tried.address) else { continue };
        let measured = block.measured(trial, tried.trials.get(trial), &hit.measure);
        let line = (n.stated.quote.clone(), format!("{}{measured}", hit.factor));
        if !block.says.contains(&line) {
            block.says.push(line);
        }
    }
    let is_own_lab = question.sim().is_some() && lesson.lab(&choice.tried.address).is_some();
    block.lab = (!is_own_lab).then(|| choice.tried.address.to_string());
    let undecided = conditions.iter().enumerate().filter(|(_, c)| *c == "undecided").map(|(i, _)| i + 1);
    let undecided = undecided.collect();
    block.options = conditions;
    ScaffoldOutcome::Proposed { verify: block, values, undecided, verdict: None }
}

/// The object of a question with a numeric answer.
fn numeric(question: &Question, found: &Traces<'_>) -> ScaffoldOutcome {
    let QuestionKind::Numeric { answer: Some(answer), .. } = &question.kind else {
        return ScaffoldOutcome::Open("it has no answer".into());
    };
    let tol = question.numeric().map_or(0.0, |(_, tol)| tol);
    // The answer itself, otherwise a number in the text that equals the answer.
    let inside = found.numbers.iter().filter(|n| question.span.contains(&n.stated.span.start));
    let mut near: Vec<_> =
        inside.filter(|n| n.stated.answer || (n.stated.read.value - answer.value).abs() <= tol).collect();
    near.sort_by_key(|n| !n.stated.answer);
    for n in near {
        let Origin::From(hit) = &n.origin else { continue };
        let mut verify = ProposedVerify::default();
        let value = match hit.place {
            None => format!("{}{}", hit.factor, hit.measure),
            Some((lab, trial)) => {
                let Some(tried) = found.labs.get(lab) else { continue };
                let measured = verify.measured(trial, tried.trials.get(trial), &hit.measure);
                verify.lab = Some(tried.address.to_string());
                format!("{}{measured}", hit.factor)
            }
        };
        verify.value = Some(value.clone());
        let values = vec![(value, hit.value)];
        return ScaffoldOutcome::Proposed { verify, values, undecided: Vec::new(), verdict: None };
    }
    ScaffoldOutcome::Open(
        "no run of the labs of the lesson, and no formula of the explanation, gives this value".into(),
    )
}

/// The lesson with all proposals inserted.
pub fn written(lesson: &Lesson, all: &[Scaffold]) -> String {
    let mut text = lesson.file.text().to_string();
    let mut places: Vec<(usize, String)> = Vec::new();
    for one in all {
        let ScaffoldOutcome::Proposed { verify, .. } = &one.found else { continue };
        let Some(object) = text.get(one.span.clone()) else { continue };
        let Some(inner) = object.strip_suffix('}') else { continue };
        let at = one.span.start + inner.trim_end().len();
        let line = text.get(..one.span.start).and_then(|t| t.rsplit('\n').next()).unwrap_or_default();
        let indent: String = line.chars().take_while(|c| c.is_whitespace()).collect();
        let comma = if inner.trim_end().ends_with([',', '{']) { "" } else { "," };
        let block = trace::format_verify(verify).replace('\n', &format!("\n{indent} "));
        places.push((at, format!("{comma}\n{indent} \"verify\": {block}")));
    }
    places.sort_by_key(|(at, _)| std::cmp::Reverse(*at));
    for (at, block) in places {
        text.insert_str(at, &block);
    }
    text
}

/// Checks the proposals as parts of the lesson.
fn judge(lesson: &Lesson, models: &Models, all: &mut [Scaffold]) {
    let text = written(lesson, all);
    let level = CheckLevel { labs: false, ..CheckLevel::FULL };
    let checked = check::check_lesson(reload_lesson(lesson, &text, models.folder()), models, level);
    for one in all {
        let ScaffoldOutcome::Proposed { verdict, .. } = &mut one.found else { continue };
        let claim = checked.claims.iter().find(|c| c.name == one.name);
        let answer = claim.and_then(|c| c.judgement.answer.as_ref());
        *verdict = answer.map(|a| (a.verdict, a.reason.clone()));
    }
}
