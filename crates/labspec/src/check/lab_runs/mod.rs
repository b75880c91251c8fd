//! The runs that detect breakdowns, within a work budget for the whole file: every lab as loaded and with each control at
//! its ends, then further interactions.

mod attempt;
mod compared;
mod display;
mod interactions;
mod seen;

use super::observations::{self, Record};
use super::{PreparedLab, RanLab};
use crate::finding::Finding;
use crate::rules;
use crate::run::{self, Budget};
use crate::spec::{BreakExpectation, Control, ControlKind, Expect, Lab, LabAddress, Lesson};
use crate::stress::{self, Action, Fault, FaultGroup, Interaction, InteractionKind, StressCase};
use attempt::{Attempt, EndedRun};
use compared::ComparedFindings;
pub(crate) use display::{WatchedDisplay, moment};
use labspec_expr::Value;
use seen::LabDisplays;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Time at which buttons are pressed, s.
const PRESS_TIME: f64 = 0.1;
/// Work reserved for each lab whose first run is still to be made.
const FIRST_RUN_WORK: u64 = 50_000_000;

/// The coverage of the runs of a lab.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// Number of runs.
    pub runs: usize,
    /// Intended length of each run, s.
    #[serde(with = "crate::verify::float_bits")]
    pub requested: f64,
    /// Length of the shortest run, s.
    #[serde(with = "crate::verify::float_bits")]
    pub covered: f64,
    /// Number of runs that were not made: they cannot start, the budget ran out, or the lab breaks as loaded.
    pub skipped: usize,
    /// Whether a run broke.
    pub broke: bool,
    /// Why a run ended early, in one short sentence.
    pub ended: Option<String>,
}

/// One interaction with a lab.
struct Trial<'a> {
    interaction: Interaction,
    /// Length of the run, s.
    length: f64,
    /// The interaction in words, for messages.
    done: String,
    /// The control, unless the lab runs as loaded.
    control: Option<&'a Control>,
    /// The index of the control and its value; a button has no value.
    moved: Option<(usize, Option<Value>)>,
}

impl Trial<'_> {
    /// The span for findings.
    fn place(&self, lab: &Lab) -> Range<usize> {
        match self.control.filter(|_| !self.compares(lab)) {
            Some(control) => control.label.span(),
            None => lab.place(),
        }
    }

    /// Whether it moves the control whose values the lab compares.
    fn compares(&self, lab: &Lab) -> bool {
        let moved = self.moved.as_ref().map(|(index, _)| *index);
        lab.comparison.as_ref().is_some_and(|comparison| Some(comparison.control) == moved)
    }
}

/// The finding about a run that cannot be made.
fn impossible(place: Range<usize>, e: run::RunError) -> Finding {
    let finding = Finding::error(rules::RUN_IMPOSSIBLE, place, e.message);
    match e.help {
        Some(help) => finding.help(help),
        None => finding,
    }
}

/// The state of a lab during its runs.
struct LabRunState<'a> {
    ready: &'a PreparedLab<'a>,
    case: StressCase<'a>,
    requested: f64,
    /// The remaining runs with controls, in order.
    left: std::vec::IntoIter<Trial<'a>>,
    /// The faults of its runs, each kind once.
    faults: Vec<FaultGroup>,
    seen: LabDisplays<'a>,
    tried: Option<Coverage>,
    /// The samples of its runs.
    records: Vec<Record>,
    /// Whether a run lost its numbers, so that not every run was completed.
    lost: bool,
    /// Whether it breaks or does not start as loaded: it would with every control.
    has_no_remedy: bool,
    /// The findings of the runs that a lab compares.
    compared: ComparedFindings,
    /// The rules of the faults of runs with one control, and what the student does in these runs.
    shown_alone: Vec<(&'static str, Action)>,
}

impl LabRunState<'_> {
    /// Records the faults of a run, once for each kind and body.
    fn note(&mut self, trial: &Trial<'_>, faults: Vec<Fault>, left: &mut u64) {
        let Trial { interaction, length, .. } = trial;
        let (faults, spent) = stress::without_pushed_bodies(&self.case, interaction, faults, *length, *left);
        *left = left.saturating_sub(spent);
        faults.into_iter().for_each(|f| stress::add_fault(&mut self.faults, f, interaction));
    }

    /// Whether a control alone, at a value that an interaction also sets, shows the fault of this rule.
    fn is_shown_alone(&self, code: &str, interaction: &Interaction) -> bool {
        let sets = |of: &Action| {
            let is_same = |action: &Action| action.control == of.control && action.value == of.value;
            interaction.actions.iter().any(is_same)
        };
        self.shown_alone.iter().any(|(rule, action)| *rule == code && sets(action))
    }

    /// Counts skipped runs.
    fn skip(&mut self, runs: usize) {
        if let Some(tried) = &mut self.tried {
            tried.skipped += runs;
        }
    }
}

/// Runs every lab that has an address, as loaded and with each control at its ends.
pub(super) fn run_labs(
    lesson: &Lesson,
    ready: &[PreparedLab<'_>],
    findings: &mut Vec<Finding>,
) -> Vec<RanLab> {
    let addressed = lesson.addressed();
    let mut left = Budget::FILE.left;
    let mut states: Vec<(&LabAddress, &Lab, Option<LabRunState<'_>>)> = Vec::new();
    // The findings of each lab are separate, because its author may expect some of them.
    let mut found = vec![Vec::new(); addressed.len()];
    for (i, (address, lab)) in addressed.iter().enumerate() {
        let later = (addressed.len() - i - 1) as u64;
        let share =
            left.saturating_sub(FIRST_RUN_WORK * later).clamp(FIRST_RUN_WORK.min(left), Budget::TRIAL.left);
        let one = ready.iter().find(|r| std::ptr::eq(r.lab, *lab));
        let begin = |r| begin(r, Budget { left: share }, &mut left, &mut found[i]);
        states.push((address, lab, one.map(begin)));
    }
    // The labs share the remaining budget.
    let mut others = states.len() as u64;
    for (state, found) in states.iter_mut().map(|(.., state)| state).zip(&mut found) {
        let Some(state) = state else { continue };
        let mut share = left / others.max(1);
        others = others.saturating_sub(1);
        let before = share;
        go_on(state, &mut share, found);
        found.extend(state.compared.take());
        left -= before - share;
        let all = state.tried.as_ref().is_some_and(|t| t.skipped == 0 && t.ended.is_none());
        found.extend(state.seen.never(all));
        if all && state.ready.mistakes == 0 && !state.lost {
            observations::check_observations(state.ready, &state.records, state.requested, found);
        }
    }
    // Further interactions have a separate budget.
    let (mut left, mut others) = (Budget::FILE.left, states.len() as u64);
    for (state, found) in states.iter_mut().map(|(.., state)| state).zip(&mut found) {
        let mut share = left / others.max(1);
        others = others.saturating_sub(1);
        let before = share;
        state.iter_mut().for_each(|state| interactions::go_on(state, &mut share, found));
        left -= before - share;
    }
    for ((_, lab, state), mut found) in states.iter().zip(found) {
        let runs = state.as_ref().and_then(|t| t.tried.as_ref()).map_or(0, |t| t.runs);
        super::expect::settle(lab, runs, &mut found, 0);
        findings.extend(found);
    }
    let ran = |(address, lab, state): (&LabAddress, &Lab, Option<LabRunState<'_>>)| {
        let tried = state.and_then(|t| t.tried);
        let runs = tried.as_ref().map_or(0, |t| t.runs);
        let mistakes = ready.iter().find(|r| std::ptr::eq(r.lab, lab)).map_or(0, |r| r.mistakes);
        RanLab {
            address: address.clone(),
            title: lab.title().to_string(),
            runs,
            ran: runs > 0,
            tried,
            mistakes,
            expect: match lab.expect {
                None => BreakExpectation::None,
                Some(Expect::Breaks(_)) => BreakExpectation::Breaks,
                Some(Expect::MayBreak) => BreakExpectation::MayBreak,
            },
        }
    };
    states.into_iter().map(ran).collect()
}

/// Runs the lab as loaded.
fn begin<'a>(
    ready: &'a PreparedLab<'a>,
    budget: Budget,
    left: &mut u64,
    findings: &mut Vec<Finding>,
) -> LabRunState<'a> {
    let requested = stress::window(ready.lab);
    let trials = trials(ready.lab, requested);
    let mut state = LabRunState {
        ready,
        case: StressCase::new(ready.lab, &ready.model, &ready.programs, interactions::nothing()),
        requested,
        faults: Vec::new(),
        left: trials.into_iter(),
        seen: LabDisplays::new(ready),
        tried: None,
        records: Vec::new(),
        lost: false,
        has_no_remedy: false,
        compared: ComparedFindings::default(),
        shown_alone: Vec::new(),
    };
    let Some(first) = state.left.next() else { return state };
    let mut of_trial = Vec::new();
    let made = attempt::make(ready, &state.case, &first, budget, &mut state.seen, &mut of_trial);
    findings.extend(state.compared.add(&first, ready.lab, of_trial));
    match made {
        Ok(attempt) => {
            *left = left.saturating_sub(attempt.spent);
            if !attempt.broke
                && let Some(f) = rules::stiff_for_timestep::check_stiffness(
                    &attempt.model,
                    &ready.programs.access,
                    ready.lab.place(),
                    &seconds(attempt.covered),
                )
            {
                findings.push(f);
            }
            state.has_no_remedy = attempt.broke || attempt.covered == 0.0 && requested > 0.0;
            state.tried = Some(Coverage {
                runs: 0,
                requested,
                covered: requested,
                skipped: 0,
                broke: false,
                ended: None,
            });
            count(&mut state, &first, attempt, left);
        }
        Err(e) => {
            findings.push(impossible(first.place(ready.lab), e));
            state.has_no_remedy = true;
        }
    }
    if state.has_no_remedy {
        // What a lab compares is run nevertheless: one integrator may break where another does not.
        let (compared, rest): (Vec<_>, Vec<_>) = state.left.partition(|trial| trial.compares(ready.lab));
        state.left = compared.into_iter();
        state.skip(rest.len());
    }
    state
}

/// Makes the runs with each control at its ends, within the budget.
fn go_on(state: &mut LabRunState<'_>, left: &mut u64, findings: &mut Vec<Finding>) {
    while let Some(trial) = state.left.next() {
        if *left == 0 {
            let skipped = 1 + state.left.by_ref().count();
            return state.skip(skipped);
        }
        let budget = Budget { left: Budget::TRIAL.left.min(*left) };
        let mut of_trial = Vec::new();
        let made = attempt::make(state.ready, &state.case, &trial, budget, &mut state.seen, &mut of_trial);
        if let [action] = trial.interaction.actions.as_slice() {
            state.shown_alone.extend(of_trial.iter().map(|f| (f.code, action.clone())));
        }
        findings.extend(state.compared.add(&trial, state.ready.lab, of_trial));
        match made {
            Ok(attempt) => {
                *left = left.saturating_sub(attempt.spent);
                count(state, &trial, attempt, left);
            }
            Err(e) => {
                findings.push(impossible(trial.place(state.ready.lab), e));
                state.skip(1);
            }
        }
    }
}

/// Counts a completed run.
fn count(state: &mut LabRunState<'_>, trial: &Trial<'_>, attempt: Attempt, left: &mut u64) {
    state.note(trial, attempt.faults, left);
    state.records.push(attempt.record);
    state.lost |= attempt.lost;
    let Some(tried) = &mut state.tried else { return };
    tried.runs += 1;
    tried.broke |= attempt.broke;
    if attempt.covered < tried.covered {
        tried.covered = attempt.covered;
        let [covered, requested] = [attempt.covered, state.requested].map(seconds);
        tried.ended = match attempt.ended {
            Some(EndedRun::Threw) => Some(format!("frozen after {covered} of {requested} s")),
            Some(EndedRun::Spent) => Some(format!("first {covered} of {requested} s")),
            None => None,
        };
    }
}

/// A time in the format of a report: `4.0`, `0.25`, `20`.
fn seconds(t: f64) -> String {
    if t >= 10.0 && t.fract() == 0.0 || t == 0.0 { format!("{t:.0}") } else { run::two_digits(t) }
}

/// The lab as loaded, then with each control at its ends.
fn trials(lab: &Lab, requested: f64) -> Vec<Trial<'_>> {
    let alone = |action| Interaction { kind: InteractionKind::End, actions: vec![action] };
    let comparison = lab.comparison.as_ref();
    let of_integrator = |name: &str| format!("with the integrator {name}");
    let first = comparison.and_then(|comparison| comparison.integrators.first());
    let mut trials = vec![Trial {
        interaction: interactions::nothing(),
        length: requested,
        done: first.map_or("as it stands".into(), |name| of_integrator(name)),
        control: None,
        moved: None,
    }];
    for (index, control) in lab.controls.iter().enumerate() {
        let label = &control.label.value;
        let mut set = |value: Value| {
            let compares = comparison.is_some_and(|comparison| comparison.control == index);
            trials.push(Trial {
                done: match &value {
                    Value::String(name) if compares => of_integrator(name),
                    value => format!("with \"{label}\" at {value}"),
                },
                length: requested,
                interaction: alone(Action { time: 0.0, control: index, value: Some(value.clone()) }),
                control: Some(control),
                moved: Some((index, Some(value))),
            });
        };
        match &control.kind {
            ControlKind::Slider { min, max, .. } => {
                set(Value::Number(min.value));
                set(Value::Number(max.value));
            }
            ControlKind::Select { options, .. } => {
                options.iter().for_each(|o| set(crate::bind::scalar(&o.value)))
            }
            ControlKind::Button { .. } => trials.push(Trial {
                done: format!("after \"{label}\" is pressed"),
                length: requested,
                interaction: alone(Action {
                    time: PRESS_TIME.min(0.5 * requested),
                    control: index,
                    value: None,
                }),
                control: Some(control),
                moved: Some((index, None)),
            }),
        }
    }
    trials
}
