//! The runs that look for what breaks, within a budget of work for the whole file: every lab as it stands and with each control at
//! its ends; then whatever else a student may do to it.

mod attempt;
mod display;
mod interactions;
mod seen;

use super::observations::{self, Record};
use super::{PreparedLab, RanLab};
use crate::finding::Finding;
use crate::rules;
use crate::run::{self, Budget};
use crate::spec::{Control, ControlKind, Lab, LabAddress, Lesson};
use crate::stress::{self, Action, Fault, FaultGroup, Interaction, Kind, StressCase};
use attempt::{Attempt, Ended};
pub(crate) use display::{WatchedDisplay, moment};
use labspec_expr::Value;
use seen::Seen;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// When buttons are pressed, s.
const PRESS: f64 = 0.1;
/// What is kept for each lab that is still to be run as it stands.
const RESERVE: u64 = 50_000_000;

/// What the runs of a lab covered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tried {
    /// Runs that were made.
    pub runs: usize,
    /// How long each was meant to be, s.
    #[serde(with = "crate::verify::float_bits")]
    pub wanted: f64,
    /// How long the shortest was, s.
    #[serde(with = "crate::verify::float_bits")]
    pub covered: f64,
    /// Runs that were not made: they cannot be, the budget was spent, or the lab breaks as it stands.
    pub skipped: usize,
    /// Something broke.
    pub broke: bool,
    /// Why a run ended before its time: one short sentence.
    pub ended: Option<String>,
}

/// One thing that a student may do to a lab.
struct Trial<'a> {
    interaction: Interaction,
    /// How long it is run, s.
    length: f64,
    /// What was done, for the message.
    done: String,
    /// The control, unless it is the lab as it stands.
    control: Option<&'a Control>,
    /// Its place in the list, and its value; a button has none.
    moved: Option<(usize, Option<Value>)>,
}

impl Trial<'_> {
    /// Where to point.
    fn place(&self, lab: &Lab) -> Range<usize> {
        self.control.map_or(lab.place(), |c| c.label.span())
    }
}

/// A run that cannot be made.
fn impossible(place: Range<usize>, e: run::RunError) -> Finding {
    Finding::error(rules::RUN_IMPOSSIBLE, place, e.0)
}

/// A lab on its way through its runs.
struct LabRunState<'a> {
    ready: &'a PreparedLab<'a>,
    case: StressCase<'a>,
    wanted: f64,
    /// Those with controls, in order.
    left: std::vec::IntoIter<Trial<'a>>,
    /// What went wrong in its runs, each kind once.
    faults: Vec<FaultGroup>,
    seen: Seen<'a>,
    tried: Option<Tried>,
    /// What was seen in its runs.
    records: Vec<Record>,
    /// A run lost its numbers, so that not every run came to its end.
    lost: bool,
    /// It breaks as it stands, or never begins to run: it would with every control.
    hopeless: bool,
}

impl LabRunState<'_> {
    /// Keeps what went wrong in a run, once for each kind and body.
    fn note(&mut self, trial: &Trial<'_>, faults: Vec<Fault>, left: &mut u64) {
        let Trial { interaction, length, .. } = trial;
        let (faults, spent) = stress::without_pushed_bodies(&self.case, interaction, faults, *length, *left);
        *left = left.saturating_sub(spent);
        faults.into_iter().for_each(|f| stress::add_fault(&mut self.faults, f, interaction));
    }

    /// Counts runs that were not made.
    fn skip(&mut self, runs: usize) {
        if let Some(tried) = &mut self.tried {
            tried.skipped += runs;
        }
    }
}

/// Runs every lab that has an address, as it stands and with each control at its ends.
pub(super) fn run_labs(
    lesson: &Lesson,
    ready: &[PreparedLab<'_>],
    findings: &mut Vec<Finding>,
) -> Vec<RanLab> {
    let addressed = lesson.addressed();
    let mut left = Budget::FILE.left;
    let mut states: Vec<(&LabAddress, &Lab, Option<LabRunState<'_>>)> = Vec::new();
    // What is found in each lab: its author may expect some of it.
    let mut found = vec![Vec::new(); addressed.len()];
    for (i, (address, lab)) in addressed.iter().enumerate() {
        let later = (addressed.len() - i - 1) as u64;
        let share = left.saturating_sub(RESERVE * later).clamp(RESERVE.min(left), Budget::TRIAL.left);
        let one = ready.iter().find(|r| std::ptr::eq(r.lab, *lab));
        let begin = |r| begin(r, Budget { left: share }, &mut left, &mut found[i]);
        states.push((address, lab, one.map(begin)));
    }
    // What is left is shared by the labs as they come.
    let mut others = states.len() as u64;
    for (state, found) in states.iter_mut().map(|(.., state)| state).zip(&mut found) {
        let Some(state) = state else { continue };
        let mut share = left / others.max(1);
        others = others.saturating_sub(1);
        let before = share;
        go_on(state, &mut share, found);
        left -= before - share;
        let all = state.tried.as_ref().is_some_and(|t| t.skipped == 0 && t.ended.is_none());
        found.extend(state.seen.never(all));
        if all && state.ready.mistakes == 0 && !state.lost {
            observations::check_observations(state.ready, &state.records, state.wanted, found);
        }
    }
    // What is beyond that has a budget of its own.
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
            expected: lab.expect.is_some(),
        }
    };
    states.into_iter().map(ran).collect()
}

/// The lab as it stands.
fn begin<'a>(
    ready: &'a PreparedLab<'a>,
    budget: Budget,
    left: &mut u64,
    findings: &mut Vec<Finding>,
) -> LabRunState<'a> {
    let wanted = stress::window(ready.lab);
    let trials = trials(ready.lab, wanted);
    let mut state = LabRunState {
        ready,
        case: StressCase::new(ready.lab, &ready.model, &ready.programs, interactions::nothing()),
        wanted,
        faults: Vec::new(),
        left: trials.into_iter(),
        seen: Seen::new(ready),
        tried: None,
        records: Vec::new(),
        lost: false,
        hopeless: false,
    };
    let Some(first) = state.left.next() else { return state };
    match attempt::make(ready, &state.case, &first, budget, &mut state.seen, findings) {
        Ok(attempt) => {
            *left = left.saturating_sub(attempt.spent);
            if !attempt.broke
                && let Some(f) = rules::stiff_for_timestep::check_stiffness(
                    &attempt.model,
                    ready.lab.place(),
                    &seconds(attempt.covered),
                )
            {
                findings.push(f);
            }
            state.hopeless = attempt.broke || attempt.covered == 0.0 && wanted > 0.0;
            state.tried =
                Some(Tried { runs: 0, wanted, covered: wanted, skipped: 0, broke: false, ended: None });
            count(&mut state, &first, attempt, left);
        }
        Err(e) => {
            findings.push(impossible(first.place(ready.lab), e));
            state.hopeless = true;
        }
    }
    if state.hopeless {
        let skipped = state.left.by_ref().count();
        state.skip(skipped);
    }
    state
}

/// The runs with each control at its ends, while something is left.
fn go_on(state: &mut LabRunState<'_>, left: &mut u64, findings: &mut Vec<Finding>) {
    while let Some(trial) = state.left.next() {
        if *left == 0 {
            let skipped = 1 + state.left.by_ref().count();
            return state.skip(skipped);
        }
        let budget = Budget { left: Budget::TRIAL.left.min(*left) };
        match attempt::make(state.ready, &state.case, &trial, budget, &mut state.seen, findings) {
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

/// Counts a run that was made.
fn count(state: &mut LabRunState<'_>, trial: &Trial<'_>, attempt: Attempt, left: &mut u64) {
    state.note(trial, attempt.faults, left);
    state.records.push(attempt.record);
    state.lost |= attempt.lost;
    let Some(tried) = &mut state.tried else { return };
    tried.runs += 1;
    tried.broke |= attempt.broke;
    if attempt.covered < tried.covered {
        tried.covered = attempt.covered;
        let [covered, wanted] = [attempt.covered, state.wanted].map(seconds);
        tried.ended = match attempt.ended {
            Some(Ended::Threw) => Some(format!("frozen after {covered} of {wanted} s")),
            Some(Ended::Spent) => Some(format!("first {covered} of {wanted} s")),
            None => None,
        };
    }
}

/// A time as a report names it: `4.0`, `0.25`, `20`.
fn seconds(t: f64) -> String {
    if t >= 10.0 && t.fract() == 0.0 || t == 0.0 { format!("{t:.0}") } else { run::two_digits(t) }
}

/// As it stands, then with each control at its ends.
fn trials(lab: &Lab, wanted: f64) -> Vec<Trial<'_>> {
    let alone = |action| Interaction { kind: Kind::End, actions: vec![action] };
    let mut trials = vec![Trial {
        interaction: interactions::nothing(),
        length: wanted,
        done: "as it stands".into(),
        control: None,
        moved: None,
    }];
    for (index, control) in lab.controls.iter().enumerate() {
        let label = &control.label.value;
        let mut set = |value: Value| {
            trials.push(Trial {
                done: format!("with \"{label}\" at {value}"),
                length: wanted,
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
                length: wanted,
                interaction: alone(Action { time: PRESS.min(0.5 * wanted), control: index, value: None }),
                control: Some(control),
                moved: Some((index, None)),
            }),
        }
    }
    trials
}
