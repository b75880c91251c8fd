//! Checks the claims of one `verify` object: executes its runs and checks its answer, quotes and closed forms.

use super::bound::BoundVerify;
use super::event_at_start::check_events;
use super::identical_runs::check_identical_runs;
use super::judgement::{Judgement, Measured, RunReport, not_executable};
use super::late_time::check_times;
use super::options::is_undecided;
use super::outcome::MeasuredRuns;
use super::outcomes::{Outcomes, run_all_numerics};
use super::quote::RenderedText;
use super::quote_checker::QuoteChecker;
use super::{answer, column, exact, mixed_claims, says, units};
use crate::finding::{Finding, Severity};
use crate::json::read::named;
use crate::rules;
use crate::run::StepVariant;
use crate::source::Text;
use crate::spec::{BreakExpectation, Column, Question, Verify};

/// Checks the claims of one `verify` object. `question` is the question that contains it, or `None` if it belongs to a lab;
/// `rendered` is the rendered text of the lesson.
pub fn check_verify(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    question: Option<&Question>,
    rendered: &RenderedText,
    findings: &mut Vec<Finding>,
) -> Judgement {
    match run_all_numerics(bound, verify, findings) {
        Some(outcomes) => {
            check_identical_runs(bound, &outcomes.nominal, findings);
            mixed_claims::check_dimensions(bound, verify, findings);
            let before = findings.len();
            let judgement = judge(bound, &outcomes, verify, question, rendered, findings);
            // A claim that is refuted has its finding.
            if !findings.iter().skip(before).any(|f| f.severity == Severity::Error) {
                check_events(bound, &outcomes.nominal, verify, findings);
                check_times(bound, &outcomes.nominal, verify, findings);
            }
            judgement
        }
        None => not_executable(verify, question, "a run cannot be executed"),
    }
}

/// Like [`check_verify`], with the numerics of the lesson only: tests the claims, not their robustness. `None` where a run
/// cannot be executed.
pub(crate) fn check_nominal(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    question: Option<&Question>,
    rendered: &RenderedText,
) -> Option<Judgement> {
    let findings = &mut Vec::new();
    let nominal = bound.outcome(StepVariant::NOMINAL, findings)?;
    let perturbed = std::array::from_fn(|_| Some(nominal.clone()));
    let outcomes = Outcomes { nominal, perturbed };
    Some(judge(bound, &outcomes, verify, question, rendered, findings))
}

fn judge(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    verify: &Verify,
    question: Option<&Question>,
    rendered: &RenderedText,
    findings: &mut Vec<Finding>,
) -> Judgement {
    let mut judgement = Judgement {
        runs: report_runs(bound, &outcomes.nominal, findings),
        measures: list_measures(bound, outcomes),
        ..Judgement::default()
    };
    if let Some(question) = question {
        judgement.answer = answer::check_answer(bound, outcomes, verify, question, findings);
    }
    judgement.quotes = {
        let checker = QuoteChecker { bound, outcomes, rendered };
        says::check_quotes(checker, verify, question, findings)
    };
    judgement.exact =
        verify.exact.iter().map(|claim| exact::check_closed_form(bound, claim, findings)).collect();
    judgement
}

/// Lints every text of a `verify` object without executing runs.
pub(crate) fn lint_verify(bound: &BoundVerify<'_>, verify: &Verify, findings: &mut Vec<Finding>) {
    let options = verify.options.iter().filter(|text| !is_undecided(text));
    let quoted: Vec<_> = verify.says.iter().flat_map(|says| &says.exprs).collect();
    let quoted: Vec<_> = quoted.into_iter().flat_map(|expr| bound.numbers_of_quote(expr)).collect();
    bound.lint_texts(options.chain(&verify.value).chain(quoted.iter().map(|expr| &**expr)), findings);
    for text in verify.table.iter().flat_map(Column::expressions) {
        lint_column(bound, text, findings);
    }
    bound.lint_searches(findings);
    for claim in &verify.exact {
        let _ = exact::bind_closed_form(bound, claim, findings);
    }
}

/// Lints an expression of a column. A list states a number for each row, so its members are linted.
fn lint_column(bound: &BoundVerify<'_>, text: &Text, findings: &mut Vec<Finding>) {
    let mut whole = Vec::new();
    bound.lint_texts(std::iter::once(text), &mut whole);
    if whole.iter().any(|f| f.code == labspec_expr::rules::WHOLE_ARRAY.code) {
        whole.clear();
        bound.lint_texts(std::iter::once(&column::part(text, "[0]")), &mut whole);
    }
    findings.extend(whole);
}

/// Reports the runs. A run that breaks unexpectedly is a finding, and so is one that is declared to break and does not.
fn report_runs(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    findings: &mut Vec<Finding>,
) -> Vec<RunReport> {
    let mut all = Vec::new();
    for (i, run) in outcome.runs.iter().enumerate() {
        let (span, mut expect) = bound.run_place(i);
        if run.broke.is_some() && expect.forbids() && bound.reads_warnings(i) {
            expect = BreakExpectation::MayBreak;
        }
        let title = run.title();
        let [name, broke] = [title.as_str(), run.broke.as_deref().unwrap_or("")];
        if run.broke.is_some() && expect.forbids() {
            findings.push(
                Finding::error(rules::RUN_BREAKS, span.clone(), format!("the run {} breaks: {broke}", named(name)))
                    .why("its measures prove nothing")
                    .help("fix the run; if the lesson is about the break, write \"expect\": \"breaks\" in the run (\"may break\" for a sweep of which some members break), or a condition that reads its `warnings`"),
            );
        }
        if run.broke.is_none() && expect.requires() {
            findings.push(
                Finding::error(
                    rules::DOES_NOT_BREAK,
                    span.clone(),
                    format!("the run {} is expected to break, but it does not", named(name)),
                )
                .why("the lesson does not show what it says")
                .help("delete \"expect\": \"breaks\", or change the run so that it breaks"),
            );
        }
        all.push(RunReport { name: name.to_string(), span, broke: run.broke.clone(), expect });
    }
    all
}

fn list_measures(bound: &BoundVerify<'_>, outcomes: &Outcomes) -> Vec<Measured> {
    let halved = outcomes.perturbed[0].as_ref().map(MeasuredRuns::list);
    let halved_value = |i: usize, value: f64| {
        halved.as_ref().and_then(|h| h.get(i)).map(|(_, x)| *x).filter(|x| *x != value)
    };
    let nominal = &outcomes.nominal;
    let of_runs = nominal.runs.iter().enumerate().flat_map(|(run, made)| {
        (0..made.measures.len()).map(move |measure| units::of_measure(bound, run, measure))
    });
    // The results of searches come last, and have no known unit.
    let units = of_runs.chain(std::iter::repeat(None));
    let list = nominal.list().into_iter().enumerate().zip(units);
    list.map(|((i, (name, value)), unit)| Measured {
        name,
        value,
        halved: halved_value(i, value),
        unit: unit.unwrap_or_default(),
    })
    .collect()
}
