//! Proposes a first `verify` object for questions and labs that have none: `labspec scaffold`.
//!
//! | stage | module |
//! |---|---|
//! | factors and shares in words: four times, a third | `factors` |
//! | the relation that the words of an option state: same, more, twice, gone | `relation` |
//! | the runs that a question compares: the control that it names, before and after, and other settings that it states | `change` |
//! | the measures that the quantity in question can mean | `quantity` |
//! | the options that runs and measures decide | `decision` |
//! | the text of a question | `question` |
//! | questions with one right option | `choose` |
//! | options that are objects, values, changes or quantities | `objects` |
//! | statements, and questions with several right options | `statement` |
//! | questions with a number | `numeric` |
//! | the objects, inserted into the lesson | this module |
//!
//! Every proposal was run, and is checked again as part of the lesson. The runs and the measure are selected by the words of the
//! question, independent of its key. If the question does not name them, there is only a skeleton for the author. If the runs support
//! another option, this is reported, and nothing is proposed.

mod change;
mod choose;
mod decision;
mod factors;
mod numeric;
mod objects;
mod outcome;
mod quantity;
mod question;
mod relation;
mod statement;
mod words;

use crate::trace::{self, Origin, ProposedVerify, TracedLab, Traces, trace};

use decision::Decision;
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::lint::reload_lesson;
use labspec::source::Text;
use labspec::spec::{ChoiceStyle, LabAddress, Lesson, Question, QuestionKind};
use labspec::verify::{RunCache, Stated, Verdict, significant};
use outcome::OF_TRACE;
pub use outcome::ScaffoldOutcome;
use question::{QuestionText, Undecided};
use std::ops::Range;

const WITHOUT_VALUES: &str =
    "no measure of its lab has a value, so nothing could be compared with it; `labspec check` says why";

/// A question or a lab without a claim, and the result.
#[derive(Clone, Debug)]
pub struct Scaffold {
    /// `quiz drop, question 2`, `lab #1`.
    pub name: String,
    /// `drop.2`, `#1`.
    pub address: String,
    /// The span of its object in the file, including braces.
    pub span: Range<usize>,
    /// The result.
    pub found: ScaffoldOutcome,
}

/// Processes every question and lab of a lesson without claims. `report_progress` receives descriptions
/// of the current activity.
pub fn scaffold(lesson: &Lesson, models: &Models, report_progress: &mut dyn FnMut(&str)) -> Vec<Scaffold> {
    let found = trace(lesson, models, report_progress);
    let stage = RunCache::new(models, lesson.conventions.languages);
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
            None if found.without_values.contains(&address) => ScaffoldOutcome::Open(WITHOUT_VALUES.into()),
            None => ScaffoldOutcome::Open(
                "no number of the text comes from this lab, so there is nothing to quote".into(),
            ),
        };
        let (name, address) = (format!("lab {address}"), address.to_string());
        all.push(Scaffold { name, address, span: lab.span.clone(), found });
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
            let address = format!("{id}.{number}");
            all.push(Scaffold { name, address, span: question.span.clone(), found });
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
    let none: &[Text] = &[];
    let (options, is_single) = match &question.kind {
        QuestionKind::Choice { options, style, .. } => (options.as_slice(), *style != ChoiceStyle::Multiple),
        QuestionKind::TrueFalse { .. } => (none, false),
        QuestionKind::Numeric { .. } => {
            return numeric::numeric(question, found, &labs(question, found), stage);
        }
        QuestionKind::Open { .. } => return ScaffoldOutcome::Open("an open question has no key".into()),
    };
    let key = match is_single {
        true => question.right_option().map(|option| vec![option]),
        false => question.keyed(),
    };
    let Some(key) = key else { return ScaffoldOutcome::Open("it has no key".into()) };
    let labs = labs(question, found);
    let is_of_question = |address: &LabAddress| match address {
        LabAddress::Sim { .. } => lesson
            .lab(address)
            .is_some_and(|lab| question.span.start <= lab.span.start && lab.span.end <= question.span.end),
        LabAddress::Lab(_) => false,
    };
    if labs.is_empty() && found.without_values.iter().any(is_of_question) {
        return ScaffoldOutcome::Open(WITHOUT_VALUES.into());
    }
    if labs.is_empty() {
        return ScaffoldOutcome::Open("there is no lab to run it in: write one under `verify`".into());
    }
    let numbers: Vec<Stated> = found.numbers.iter().map(|n| n.stated.clone()).collect();
    let asked = QuestionText::new(question, options, &numbers);
    let decided = match &question.kind {
        QuestionKind::TrueFalse { .. } => statement::statement(&asked, &labs, stage),
        _ if is_single => choose::choose(&asked, &labs, stage),
        _ => statement::several(&asked, &labs, stage),
    };
    match decided {
        Err(Undecided { why, skeleton: None }) => ScaffoldOutcome::Open(why),
        Err(Undecided { why, skeleton: Some(verify) }) => ScaffoldOutcome::Skeleton { why, verify: *verify },
        Ok(decision) if decision.holding == key => proposed(lesson, question, found, &decision),
        Ok(decision) => contradicted(&decision, is_single),
    }
}

/// The outcome of runs that support another key.
fn contradicted(decision: &Decision<'_, '_>, is_single: bool) -> ScaffoldOutcome {
    match decision.holding.as_slice() {
        [option] if is_single => ScaffoldOutcome::Contradicted { option: *option, values: decision.values() },
        holding => {
            let values =
                decision.values().into_iter().map(|(what, x)| format!("{what} is {}", significant(x)));
            let values = values.collect::<Vec<_>>().join("; ");
            let options: Vec<String> = holding.iter().map(|i| (i + 1).to_string()).collect();
            let held = if options.is_empty() { "none".to_string() } else { options.join(", ") };
            let why = format!("the runs support another key (conditions that hold: {held}): {values}");
            ScaffoldOutcome::Open(why)
        }
    }
}

/// The labs of a question: its own, then those of the lesson, the nearest one before it first.
fn labs<'t, 'l>(question: &Question, found: &'t Traces<'l>) -> Vec<&'t TracedLab<'l>> {
    let is_own = |t: &&TracedLab<'_>| t.owner.as_ref().is_some_and(|o| *o == question.span);
    let mut all: Vec<&TracedLab<'_>> = found.labs.iter().filter(is_own).collect();
    let mut others: Vec<&TracedLab<'_>> =
        found.labs.iter().filter(|t| matches!(t.address, LabAddress::Lab(_))).collect();
    // A lab after the question is shown when it has been answered.
    let start = question.span.start;
    others.sort_by_key(|t| (t.lab.span.start > start, t.lab.span.start.abs_diff(start)));
    all.extend(others);
    all
}

/// The object of a question with options.
fn proposed(
    lesson: &Lesson,
    question: &Question,
    found: &Traces<'_>,
    choice: &Decision<'_, '_>,
) -> ScaffoldOutcome {
    let mut block = ProposedVerify::default();
    let mut values = Vec::new();
    let conditions = choice.conditions(&mut block, &mut values);
    // Numbers of the question that originate from the same lab.
    for n in found.numbers.iter().filter(|n| question.span.contains(&n.stated.span.start) && !n.stated.answer)
    {
        let Origin::From(hit) = &n.origin else { continue };
        let Some((lab, trial)) = hit.place.filter(|_| !hit.fragile) else { continue };
        let Some(tried) = found.labs.get(lab).filter(|t| t.address == choice.tried.address) else { continue };
        // The number of a run whose setting the question does not state equals it by coincidence, and so does another measure.
        let run = tried.trials.get(trial).filter(|run| choice.has_run(run) && choice.reads(&hit.measure));
        if run.is_none() {
            continue;
        }
        // Runs of the trace have other places than those of the comparison.
        let measured = block.traced(OF_TRACE + trial, tried, trial, &hit.measure);
        let line = (n.stated.quote.clone(), format!("{}{measured}", hit.factor));
        if !block.says.contains(&line) {
            block.says.push(line);
        }
    }
    let sim_lab = question.sim().and_then(|_| lesson.lab(&choice.tried.address));
    let is_own_lab = sim_lab.is_some_and(|lab| question.span.contains(&lab.span.start));
    block.lab = (!is_own_lab).then(|| choice.tried.address.to_string());
    let undecided = conditions.iter().enumerate().filter(|(_, c)| *c == "undecided").map(|(i, _)| i + 1);
    let undecided = undecided.collect();
    block.options = conditions;
    ScaffoldOutcome::Proposed { verify: block, values, undecided, verdict: None }
}

/// The lesson with objects inserted: all proposals, or those of the named questions and labs, skeletons too.
pub fn written(lesson: &Lesson, all: &[Scaffold], names: &[String]) -> String {
    let mut text = lesson.file.text().to_string();
    let mut places: Vec<(usize, String)> = Vec::new();
    for one in all {
        let verify = match &one.found {
            ScaffoldOutcome::Proposed { verify, .. } if names.is_empty() => verify,
            ScaffoldOutcome::Proposed { verify, .. } | ScaffoldOutcome::Skeleton { verify, .. }
                if names.contains(&one.address) =>
            {
                verify
            }
            _ => continue,
        };
        let Some(object) = text.get(one.span.clone()) else { continue };
        let Some(inner) = object.strip_suffix('}') else { continue };
        let offset = one.span.start + inner.trim_end().len();
        let line = text.get(..one.span.start).and_then(|t| t.rsplit('\n').next()).unwrap_or_default();
        let indent: String = line.chars().take_while(|c| c.is_whitespace()).collect();
        let step = indentation_step(&text, object, &indent);
        let comma = if inner.trim_end().ends_with([',', '{']) { "" } else { "," };
        let block = indented(&trace::format_verify(verify), &format!("{indent}{step}"), &step);
        places.push((offset, format!("{comma}\n{indent}{step}\"verify\": {block}")));
    }
    places.sort_by_key(|(offset, _)| std::cmp::Reverse(*offset));
    for (offset, block) in places {
        text.insert_str(offset, &block);
    }
    text
}

/// The step of indentation of an object: the first line inside it compared with its own, otherwise that of the lesson.
fn indentation_step(lesson: &str, object: &str, indent: &str) -> String {
    let space = |line: &str| line.chars().take_while(|c| c.is_whitespace()).collect::<String>();
    let inside = object.lines().nth(1).map(space);
    if let Some(step) =
        inside.as_deref().and_then(|inside| inside.strip_prefix(indent)).filter(|step| !step.is_empty())
    {
        return step.to_string();
    }
    // The least indented line of JSON in the lesson.
    let keys = lesson.lines().filter(|line| line.trim_start().starts_with('"')).map(space);
    keys.filter(|space| !space.is_empty()).min_by_key(String::len).unwrap_or_else(|| " ".to_string())
}

/// A text with steps of two spaces, with other steps and below other text.
fn indented(text: &str, indent: &str, step: &str) -> String {
    let line = |(i, line): (usize, &str)| {
        let depth = (line.len() - line.trim_start().len()) / 2;
        let before = if i == 0 { String::new() } else { format!("{indent}{}", step.repeat(depth)) };
        format!("{before}{}", line.trim_start())
    };
    text.lines().enumerate().map(line).collect::<Vec<_>>().join("\n")
}

/// Checks the proposals as parts of the lesson. One that does not hold becomes a skeleton.
fn judge(lesson: &Lesson, models: &Models, all: &mut [Scaffold]) {
    let text = written(lesson, all, &[]);
    let level = CheckLevel { labs: false, ..CheckLevel::FULL };
    let checked = check::check_lesson(reload_lesson(lesson, &text, models.folder()), models, level);
    for one in all {
        let ScaffoldOutcome::Proposed { verify, verdict, .. } = &mut one.found else { continue };
        let claim = checked.claims.iter().find(|c| c.name == one.name);
        let Some(answer) = claim.and_then(|c| c.judgement.answer.as_ref()) else {
            // A lab has no answer; that of a question must have been judged.
            if verify.value.is_some() || !verify.options.is_empty() {
                let why = "a check of these conditions has no result".to_string();
                one.found = ScaffoldOutcome::Skeleton { why, verify: verify.clone() };
            }
            continue;
        };
        match answer.verdict {
            Verdict::Verified | Verdict::Computed => *verdict = Some((answer.verdict, answer.reason.clone())),
            other => {
                let reason =
                    if answer.reason.is_empty() { String::new() } else { format!(": {}", answer.reason) };
                let why = format!("a check of these conditions says {}{reason}", other.as_str());
                one.found = ScaffoldOutcome::Skeleton { why, verify: verify.clone() };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_have_the_indentation_of_the_lesson() {
        let text = "{\n  \"a\": [\n    1\n  ]\n}";
        assert_eq!(indented(text, "\t", "\t"), "{\n\t\t\"a\": [\n\t\t\t1\n\t\t]\n\t}");
        assert_eq!(indentation_step("", "{\n    \"q\": 1\n}", ""), "    ");
        assert_eq!(indentation_step("[\n   \"x\"\n]", "{\"q\": 1}", "    "), "   ");
        assert_eq!(indentation_step("", "{}", ""), " ");
    }
}
