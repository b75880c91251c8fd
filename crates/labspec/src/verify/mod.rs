//! The truth of what a lesson claims: runs, measures over them, and verdicts.
//!
//! | stage | module |
//! |---|---|
//! | the labs of the runs, as they stand or changed | `run_cache` |
//! | runs and measures, bound to their labs | `bound` |
//! | one run, with what is measured in it | `runner`, `measure`, `reads` |
//! | values that are searched for | `search` |
//! | what conditions read | `outcome`, at the places of `layout` |
//! | an expression over measures, compiled once | `claim` |
//! | its value, and what that rests on | `found` |
//! | whether it could have come out otherwise | `evidence` |
//! | whether and how well a condition holds | `condition` |
//! | the answer of a question | `answer` |
//! | numbers in the texts of options | `option_numbers` |
//! | numbers and words in the text | `says`, `quote` |
//! | columns of tables | `column` |
//! | what their numbers measure | `units` |
//! | closed forms | `exact` |
//! | the same with the numbers of the real library | `judge` |
//! | what the labs show in the runs, for a report | `curves` |

mod answer;
mod bound;
mod claim;
mod column;
mod condition;
mod curves;
mod evidence;
mod exact;
mod found;
mod imagined;
pub(crate) mod judge;
mod layout;
mod measure;
mod option_numbers;
mod outcome;
mod over;
mod quote;
mod reads;
mod run_cache;
mod runner;
mod says;
mod search;
mod units;

pub use answer::{Answer, UNDECIDED, Verdict, Weight};
pub use bound::BoundVerify;
pub use curves::Curves;
pub use exact::ClosedForm;
pub use quote::{
    Counted, Form, Other, QuoteOutcome, QuoteState, Quoted, ShownText, Stated, Style, Unread, answered,
    claimed, counted, folded, plain, quoted, stated,
};
pub use reads::labels;
pub use run_cache::{BoundLab, Stage};
pub use says::Quote;

use crate::finding::Finding;
use crate::ledger::State;
use crate::rules;
use crate::run::StepVariant;
use crate::source::Text;
use crate::spec::{Question, Verify};
use labspec_core::integrator;
use outcome::Outcome;
use std::ops::Range;

/// Everything that came of one `verify` object.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judgement {
    /// The answer of the question, when the object says how to check it.
    pub answer: Option<Answer>,
    /// The numbers under `says`, in order.
    pub quotes: Vec<Quote>,
    /// The closed forms under `exact`, in order.
    pub exact: Vec<ClosedForm>,
    /// The runs, in order.
    pub runs: Vec<RunReport>,
    /// Every measure of every run, named as conditions read it.
    pub measures: Vec<Measured>,
    /// Why no run was made, where none could be.
    pub unmade: Option<String>,
}

/// A run of a `verify` object.
#[derive(Clone, Debug, PartialEq)]
pub struct RunReport {
    /// Its name.
    pub name: String,
    /// Its place in the lesson.
    pub span: Range<usize>,
    /// What broke in it.
    pub broke: Option<String>,
    /// The lesson says that it breaks.
    pub expected: bool,
}

/// A measure under the numerics of the lesson, and under others.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// `run.measure`, or the measure alone where there is one run.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its value at half the timestep; `None` when that was not needed, or the lesson states every timestep itself.
    pub halved: Option<f64>,
}

pub(crate) const HALVED: StepVariant = StepVariant { timestep: 0.5, ..StepVariant::NOMINAL };
const QUARTERED: StepVariant = StepVariant { timestep: 0.25, ..StepVariant::NOMINAL };
const FAST: StepVariant = StepVariant { integrator: Some(integrator::IMPLICITFAST), ..StepVariant::NOMINAL };
const RK4: StepVariant = StepVariant { integrator: Some(integrator::RK4), ..StepVariant::NOMINAL };
const TIGHT: StepVariant = StepVariant { tight: true, ..StepVariant::NOMINAL };
/// Far below what anybody could set or measure; a system that shows it after seconds is chaotic.
const NUDGE: f64 = 1e-14;
pub(crate) const NUDGED: StepVariant = StepVariant { perturbation: NUDGE, ..StepVariant::NOMINAL };
pub(crate) const NUDGED_BACK: StepVariant = StepVariant { perturbation: -NUDGE, ..StepVariant::NOMINAL };

/// Other numerics that every answer is put to.
const CHANGES: usize = 4;

/// The changes of the numerics that an answer must survive, and how to call them. The first and the third are those of quotes.
const PERTURBED: [(StepVariant, &str); CHANGES] = [
    (HALVED, "at half the timestep"),
    (TIGHT, "with the solver run to convergence"),
    (NUDGED, "with a start moved by 1e-14"),
    (FAST, "with the integrator implicitfast"),
];

/// Those that an answer must survive besides, where what the others change of a condition could turn it over.
const CLOSER: [(StepVariant, &str); 2] =
    [(QUARTERED, "at a quarter of the timestep"), (RK4, "with the integrator RK4")];

/// Every measure of an object with one run; `None` where the run cannot be made, or breaks.
pub(crate) fn measured(bound: &BoundVerify<'_>, numerics: StepVariant) -> Option<Vec<f64>> {
    let outcome = bound.outcome(numerics, &mut Vec::new())?;
    let run = outcome.runs.into_iter().next().filter(|run| run.broke.is_none())?;
    Some(run.measures.into_iter().map(|(_, x)| x).collect())
}

/// The runs of a `verify` object under every numerics that its claims need.
struct Outcomes {
    nominal: Outcome,
    /// In the order of [`PERTURBED`]; `None` where nothing needs them.
    perturbed: [Option<Outcome>; CHANGES],
    /// The other direction, for a value that the first one moved.
    nudged_back: Option<Outcome>,
}

/// Checks the claims of one `verify` object. `question` is what carries it, unless a lab does; `shown` is what a reader of
/// the lesson sees.
pub fn check(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    question: Option<&Question>,
    shown: &ShownText,
    findings: &mut Vec<Finding>,
) -> Judgement {
    match outcomes(bound, verify, findings) {
        Some(outcomes) => judge(bound, &outcomes, verify, question, shown, findings),
        None => unmade(verify, question, "a run cannot be made"),
    }
}

/// The same with the numerics of the lesson alone: what a claim says, and not whether it survives others. `None` where a run cannot
/// be made.
pub(crate) fn check_nominal(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    question: Option<&Question>,
    shown: &ShownText,
) -> Option<Judgement> {
    let findings = &mut Vec::new();
    let nominal = bound.outcome(StepVariant::NOMINAL, findings)?;
    let perturbed = std::array::from_fn(|_| Some(nominal.clone()));
    let outcomes = Outcomes { nominal, perturbed, nudged_back: None };
    Some(judge(bound, &outcomes, verify, question, shown, findings))
}

fn judge(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    verify: &Verify,
    question: Option<&Question>,
    shown: &ShownText,
    findings: &mut Vec<Finding>,
) -> Judgement {
    let mut judgement = Judgement {
        runs: runs(bound, &outcomes.nominal, findings),
        measures: measures(outcomes),
        ..Judgement::default()
    };
    if let Some(question) = question {
        judgement.answer = answer::check(bound, outcomes, verify, question, findings);
    }
    judgement.quotes = {
        let court = says::QuoteChecker { bound, outcomes, shown };
        says::check(court, verify, question, findings)
    };
    judgement.exact = verify.exact.iter().map(|claim| exact::check(bound, claim, findings)).collect();
    judgement
}

/// Looks at every text of a `verify` object, and runs nothing.
pub(crate) fn lint_verify(bound: &BoundVerify<'_>, verify: &Verify, findings: &mut Vec<Finding>) {
    let options = verify.options.iter().filter(|text| !answer::is_undecided(text));
    bound.lint_texts(options.chain(&verify.value).chain(verify.quoted()), findings);
    for claim in &verify.exact {
        let _ = exact::bind(bound, claim, findings);
    }
}

/// What remains of a `verify` object whose runs cannot be made: claims that could not be checked.
pub fn unmade(verify: &Verify, question: Option<&Question>, reason: &str) -> Judgement {
    let run = |run: &crate::spec::Run| RunReport {
        name: run.name.value.clone(),
        span: run.name.span(),
        broke: None,
        expected: run.breaks,
    };
    Judgement {
        answer: question.filter(|_| verify.claims_answer()).map(|_| Answer::failed(reason)),
        quotes: verify
            .says
            .iter()
            .map(|s| &s.quote)
            .chain(verify.table.iter().map(|c| &c.column))
            .map(|text| Quote::unclear(text, reason))
            .collect(),
        exact: verify.exact.iter().map(|e| ClosedForm::unchecked(e, reason)).collect(),
        runs: verify.runs.iter().map(run).collect(),
        measures: Vec::new(),
        unmade: Some(reason.to_string()),
    }
}

impl Judgement {
    /// Calls nothing true of what it holds, for a reason that belongs to all of it.
    pub(crate) fn withdraw(&mut self, reason: &str) {
        let is_true = |state: State| matches!(state, State::True(_));
        for answer in self.answer.iter_mut().filter(|a| is_true(a.verdict.state())) {
            *answer = Answer { verdict: Verdict::Failed, reason: reason.to_string(), ..answer.clone() };
        }
        for quote in self.quotes.iter_mut().filter(|q| q.state == QuoteState::Right) {
            (quote.state, quote.reason) = (QuoteState::Unclear, reason.to_string());
        }
        for form in self.exact.iter_mut().filter(|form| is_true(form.state)) {
            (form.state, form.remark) = (State::Unchecked, reason.to_string());
        }
    }
}

/// Every run under every numerics that is needed.
fn outcomes(bound: &BoundVerify<'_>, verify: &Verify, findings: &mut Vec<Finding>) -> Option<Outcomes> {
    let nominal = bound.outcome(StepVariant::NOMINAL, findings)?;
    let answers = verify.claims_answer();
    let quotes = !verify.says.is_empty() || !verify.table.is_empty();
    let needed = |i: usize| answers || quotes && (i == 0 || i == 2);
    let mut perturbed = [None, None, None, None];
    let about_numerics = bound.states_every_timestep();
    for (i, (numerics, how)) in PERTURBED.into_iter().enumerate().filter(|(i, _)| needed(*i)) {
        let same = about_numerics && (numerics.timestep != 1.0 || numerics.integrator.is_some());
        let mut said = Vec::new();
        perturbed[i] = if same { Some(nominal.clone()) } else { bound.outcome(numerics, &mut said) };
        if perturbed[i].is_none() {
            // What stops the run here does not stop the nominal one: it takes too long.
            findings.extend(said.into_iter().take(1).map(|f| {
                let message = format!("{how}: {}", f.message);
                Finding { message, ..f }
            }));
            return None;
        }
    }
    let moved = perturbed[2].as_ref().is_some_and(|o| o.list() != nominal.list());
    let nudged_back = moved.then(|| bound.outcome(NUDGED_BACK, &mut Vec::new())).flatten();
    Some(Outcomes { nominal, perturbed, nudged_back })
}

/// What became of the runs. One that breaks is a finding, and so is one that does not although the lesson says so.
fn runs(bound: &BoundVerify<'_>, outcome: &Outcome, findings: &mut Vec<Finding>) -> Vec<RunReport> {
    let mut all = Vec::new();
    for (i, run) in outcome.runs.iter().enumerate() {
        let (span, expected) = bound.run_place(i);
        let title = run.title();
        let [name, broke] = [title.as_str(), run.broke.as_deref().unwrap_or("")];
        if run.broke.is_some() && !expected {
            findings.push(
                Finding::error(rules::RUN_BREAKS, span.clone(), format!("the run {} breaks: {broke}", crate::json::read::named(name)))
                    .why("its measures prove nothing")
                    .help("fix the run; if the lesson is about the break, write \"expect\": \"breaks\" in the run, or a condition that reads its `warnings`"),
            );
        }
        if run.broke.is_none() && expected {
            findings.push(
                Finding::error(
                    rules::DOES_NOT_BREAK,
                    span.clone(),
                    format!(
                        "the run {} is expected to break, but it does not",
                        crate::json::read::named(name)
                    ),
                )
                .why("the lesson does not show what it says")
                .help("delete \"expect\": \"breaks\", or change the run so that it breaks"),
            );
        }
        all.push(RunReport { name: name.to_string(), span, broke: run.broke.clone(), expected });
    }
    all
}

fn measures(outcomes: &Outcomes) -> Vec<Measured> {
    let halved = outcomes.perturbed[0].as_ref().map(Outcome::list);
    let at = |i: usize, value: f64| {
        halved.as_ref().and_then(|h| h.get(i)).map(|(_, x)| *x).filter(|x| *x != value)
    };
    let list = outcomes.nominal.list().into_iter().enumerate();
    list.map(|(i, (name, value))| Measured { name, value, halved: at(i, value) }).collect()
}

/// The value of an expression that a claim may rest on: it has one, it depends on what was measured if it reads that, no NaN
/// decides it, and the runs that it reads did not break. Otherwise why not, which is reported.
fn grounded(
    bound: &BoundVerify<'_>,
    outcome: &Outcome,
    text: &Text,
    findings: &mut Vec<Finding>,
) -> Result<found::MeasuredValue, String> {
    let found = decided(bound, outcome, text, findings)?;
    // What has no finite value is told as that.
    let some = !matches!(found.value, labspec_expr::Value::Number(x) if !x.is_finite());
    if some && (found.unread || !bound.could_differ(&found, None)) {
        return Err(empty(text, findings));
    }
    Ok(found)
}

/// The same for numerics other than the lesson's own, with which a claim is not tried again.
fn decided(
    bound: &BoundVerify<'_>,
    outcome: &Outcome,
    text: &Text,
    findings: &mut Vec<Finding>,
) -> Result<found::MeasuredValue, String> {
    if condition::is_bare_constant(&text.value) {
        let message = format!("`{}` is a constant and proves nothing", text.value.trim());
        findings.push(
            Finding::error(rules::CONSTANT_CLAIM, text.span(), message.clone())
                .why("it gives the same result whatever the simulation does, so it checks nothing")
                .help("compare something that a run measures, or write the formula that gives the number"),
        );
        return Err(message);
    }
    let found = bound.find(outcome, text, findings).ok_or("the expression cannot be evaluated")?;
    if let Some(broke) = &found.broke {
        return Err(broke.clone());
    }
    match &found.undecided {
        Some(undecided) => Err(undecided_by_nan(text, undecided, findings)),
        None => Ok(found),
    }
}

/// An expression whose value is the same whatever was measured.
fn empty(text: &Text, findings: &mut Vec<Finding>) -> String {
    let message = format!(
        "`{}` gives the same result whatever the runs give, so it proves nothing",
        shorten(text.value.trim())
    );
    findings.push(
        Finding::error(rules::CONSTANT_CLAIM, text.span(), message.clone())
            .why("other values in place of the measured ones did not change it")
            .help("compare a measure of a run with something that it could miss"),
    );
    message
}

/// An expression that a NaN decides.
fn undecided_by_nan(text: &Text, undecided: &found::Undecided, findings: &mut Vec<Finding>) -> String {
    let part = &undecided.part;
    let because = undecided.because.as_deref();
    let why = because.unwrap_or("a measure is NaN if its event never happens in the run").to_string();
    findings.push(
        Finding::error(rules::COMPARES_NAN, text.span(), format!("`{part}` compares NaN"))
            .why(format!("a comparison with NaN says nothing about the claim: {why}"))
            .help("make the run longer, correct the measure, or test for it with `isNaN(x)`"),
    );
    format!("`{part}` compares NaN")
}

/// A number with six significant digits, without trailing zeros.
pub(crate) fn significant(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let exponent = x.abs().log10().floor() as i32;
    if !(-4..=6).contains(&exponent) {
        return format!("{x:.5e}");
    }
    let text = labspec_expr::to_fixed(x, (5 - exponent).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// The beginning of a text, for messages.
fn shorten(text: &str) -> String {
    let short: String = text.chars().take(48).collect();
    if short.len() < text.len() { format!("{short}…") } else { short }
}
