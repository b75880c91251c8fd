//! Remedies: each change of the model is tested in a run, and reported only if the run has no fault.

use super::truth;
use labspec::interrupt;
use labspec::run::{Session, sets_integrator, two_digits};
use labspec::spec::{Control, ControlKind};
use labspec::stress::{
    Action, Change, FaultGroup, FaultKind, Interaction, RunOutcome, StressCase, worst_fault,
};
use labspec_core::math::rows_mut;
use labspec_core::{Model, integrator};
use labspec_expr::Value;

/// A change that removes a fault.
#[derive(Clone, Debug, PartialEq)]
pub struct Remedy {
    /// The change in words.
    pub change: String,
    /// The work per simulated second with the change, relative to that of the unchanged lab.
    pub work: f64,
    /// The same as measured with a clock.
    pub time: f64,
    /// The largest error of any displayed number with the change, relative to the range of the number: compared with the motion
    /// that the model describes, computed with much shorter steps. `None` if that is unknown.
    pub error: Option<f64>,
}

/// A change that works, with its work, and how to perform a run with it.
struct WorkingRemedy {
    change: String,
    /// Whether it is a shorter timestep, of which only one needs to be reported.
    timestep: bool,
    work: f64,
    interaction: Interaction,
    apply: Box<dyn Fn(&mut Model)>,
}

/// The number of halvings of the timestep that are tried if it may be the cause, and the divisor of the work for one run.
const MAX_HALVINGS: i32 = 6;
const PART: u64 = 4;
/// The maximum number of working timesteps that are examined, and the error, relative to the range,
/// above which a lab is useless.
const TIMESTEPS: usize = 3;
const MIN_IMPROVEMENT: f64 = 0.5;
/// A slow drift counts as stopped if its speed falls below this part of the speed before.
const STOPPED: f64 = 0.1;

/// A change of the model, and its description.
type ModelChange = (String, Box<dyn Fn(&mut Model)>);

/// The tests of remedies for one finding.
pub(super) struct RemedyTests<'c, 'a> {
    pub(super) case: &'c StressCase<'a>,
    pub(super) length: f64,
    /// The time that a student watches, s: only visible errors count.
    pub(super) window: f64,
    /// The work per simulated second of the unchanged lab.
    pub(super) work_per_second: f64,
    /// The remaining work.
    pub(super) left: u64,
    pub(super) work: u64,
}

impl RemedyTests<'_, '_> {
    /// Returns the remedies for a finding, or `None` if the work limit is reached.
    pub(super) fn remedies(&mut self, found: &FaultGroup) -> Option<Vec<Remedy>> {
        let before = self.run(&found.interaction, None)?;
        let model = self.case.start(&found.interaction, self.left).world.model;
        let mut list = Vec::new();
        let halvings = match found.fault.kind {
            FaultKind::Penetrates => 1,
            FaultKind::Drifts => 0,
            _ => MAX_HALVINGS,
        };
        let interaction = || found.interaction.clone();
        for k in 1..=halvings {
            let h = model.opt.timestep * 0.5f64.powi(k);
            let apply = move |m: &mut Model| *m.edit().opt.timestep = h;
            if let Some(work) = self.work_with_change(found, &before, &apply)? {
                let change = format!("a timestep of {} s", two_digits(h));
                list.push(WorkingRemedy {
                    change,
                    timestep: true,
                    work,
                    interaction: interaction(),
                    apply: Box::new(apply),
                });
                if list.len() == TIMESTEPS {
                    break;
                }
            }
        }
        for (change, apply) in
            candidates(&model, found.fault.kind, sets_integrator(&self.case.programs.access))
        {
            if let Some(work) = self.work_with_change(found, &before, &apply)? {
                list.push(WorkingRemedy { change, timestep: false, work, interaction: interaction(), apply });
            }
        }
        list.extend(self.shorter_slider(found, &before)?);
        Some(self.costs(found, list))
    }

    /// Determines the cost of each remedy: its error relative to the exact motion, and its run time.
    fn costs(&mut self, found: &FaultGroup, list: Vec<WorkingRemedy>) -> Vec<Remedy> {
        if list.is_empty() {
            return Vec::new();
        }
        let mut work = 0;
        let truth = truth::truth(self.case, &found.interaction, self.window, &mut work);
        let mut remedies: Vec<Remedy> = Vec::new();
        let mut enough = false;
        for WorkingRemedy { change, timestep, work: cost, interaction, apply } in list {
            if timestep && enough {
                continue;
            }
            let change_of = move |session: &mut Session<'_>| apply(&mut session.world.model);
            let apply: Change<'_> = &change_of;
            // Another value of a slider gives another motion, with its own exact solution.
            let error = if interaction == found.interaction {
                truth.as_ref().and_then(|t| truth::error(self.case, t, apply, &mut work))
            } else {
                let truth = truth::truth(self.case, &interaction, self.window, &mut work);
                truth.and_then(|t| truth::error(self.case, &t, apply, &mut work))
            };
            if error.is_some_and(|error| error > MIN_IMPROVEMENT) {
                continue;
            }
            enough |= timestep;
            let time = truth::time(self.case, &interaction, apply, self.window);
            remedies.push(Remedy { change, work: cost, time, error });
        }
        self.work += work;
        remedies
    }

    fn run(
        &mut self,
        interaction: &Interaction,
        change: Option<&dyn Fn(&mut Session<'_>)>,
    ) -> Option<RunOutcome> {
        if self.left == 0 || interrupt::requested() {
            return None;
        }
        let outcome = self.case.run(interaction, change, self.length, self.left.div_ceil(PART));
        self.left = self.left.saturating_sub(outcome.spent);
        self.work += outcome.spent;
        Some(outcome)
    }

    /// The work per simulated second with a change, if the change removes the fault.
    fn work_with_change(
        &mut self,
        found: &FaultGroup,
        before: &RunOutcome,
        apply: &dyn Fn(&mut Model),
    ) -> Option<Option<f64>> {
        let change = |session: &mut Session<'_>| apply(&mut session.world.model);
        let outcome = self.run(&found.interaction, Some(&change))?;
        let cost = outcome.spent as f64 / outcome.covered.max(f64::MIN_POSITIVE) / self.work_per_second;
        Some((!outcome.cut && has_no_new_fault(found, before, &outcome)).then_some(cost))
    }

    /// A smaller range of a slider, if the slider alone causes the fault: the largest value without a
    /// fault, by bisection on its grid.
    fn shorter_slider(&mut self, found: &FaultGroup, before: &RunOutcome) -> Option<Option<WorkingRemedy>> {
        let base = &self.case.base.actions;
        let mut added = found.interaction.actions.iter().filter(|a| !base.contains(a));
        let (Some(action), None) = (added.next(), added.next()) else { return Some(None) };
        let Some(control) = self.case.lab.controls.get(action.control) else { return Some(None) };
        let (ControlKind::Slider { min, value, .. }, Some(Value::Number(end))) =
            (&control.kind, &action.value)
        else {
            return Some(None);
        };
        let Some(step) = control.step().filter(|s| *s > 0.0) else { return Some(None) };
        let (min, end) = (min.value, *end);
        let place = |x: f64| (x - min) / step;
        // The last value of the grid without a fault, and the first one with a fault.
        let up = end > value.value;
        let (mut good, mut bad) = match up {
            true => (place(value.value).floor(), place(end).ceil()),
            false => (place(value.value).ceil(), 0.0),
        };
        while (bad - good).abs() > 1.5 {
            let middle = (0.5 * (good + bad)).round();
            let outcome = self.run(&with(found, action, on_grid(min, step, middle)), None)?;
            if !outcome.cut && has_no_new_fault(found, before, &outcome) {
                good = middle
            } else {
                bad = middle
            }
        }
        let last = on_grid(min, step, good);
        let moved = if up { last > value.value } else { last < value.value };
        let interaction = with(found, action, last);
        Some(moved.then(|| WorkingRemedy {
            change: ends(control, last),
            timestep: false,
            work: 1.0,
            interaction,
            apply: Box::new(|_| {}),
        }))
    }
}

/// The setting of a finding, with one slider at another value.
fn with(found: &FaultGroup, action: &Action, value: f64) -> Interaction {
    let mut interaction = found.interaction.clone();
    let same = interaction.actions.iter_mut().filter(|a| *a == action);
    same.for_each(|a| a.value = Some(Value::Number(value)));
    interaction
}

fn on_grid(min: f64, step: f64, k: f64) -> f64 {
    // Rounded, to remove the last digits of rounding errors.
    let x = min + k * step;
    format!("{x:.11e}").parse().unwrap_or(x)
}

fn ends(control: &Control, last: f64) -> String {
    format!("a smaller range of \"{}\", up to {}", control.label.value, Value::Number(last))
}

/// Whether a run has no faults except those that existed before besides the finding.
fn has_no_new_fault(found: &FaultGroup, before: &RunOutcome, after: &RunOutcome) -> bool {
    let FaultGroup { fault, .. } = found;
    if fault.kind == FaultKind::Drifts {
        let speed = after
            .speeds
            .iter()
            .find(|(subject, _)| *subject == fault.subject)
            .map_or(0.0, |(_, speed)| *speed);
        return speed <= STOPPED * fault.size && worst_fault(&after.faults, &[]).is_none();
    }
    let others = before.faults.iter().filter(|f| (f.kind, &f.subject) != (fault.kind, &fault.subject));
    let others: Vec<(FaultKind, String)> = others.map(|f| (f.kind, f.subject.clone())).collect();
    worst_fault(&after.faults, &others).is_none()
}

/// Possible remedies for a fault of this kind. Another integrator is none where a program sets it.
fn candidates(model: &Model, kind: FaultKind, sets_integrator: bool) -> Vec<ModelChange> {
    let mut list: Vec<ModelChange> = Vec::new();
    let steps = [
        ("`integrator=\"discrete\"`", integrator::DISCRETE),
        ("`integrator=\"implicitfast\"`", integrator::IMPLICITFAST),
        ("`integrator=\"RK4\"`", integrator::RK4),
    ];
    let breaks =
        matches!(kind, FaultKind::Diverges | FaultKind::Grows | FaultKind::Silent | FaultKind::Chatters);
    if breaks {
        let is_choice = |(_, id): &(&str, i32)| !sets_integrator && *id != model.opt.integrator;
        for (name, id) in steps.into_iter().filter(is_choice) {
            list.push((name.into(), Box::new(move |m| *m.edit().opt.integrator = id)));
        }
        list.push(("contacts four times as soft (`solref`)".into(), Box::new(|m| soften(m, 4.0))));
    }
    match kind {
        FaultKind::Penetrates | FaultKind::Tunnels => {
            let least = 2.0 * model.opt.timestep;
            let change =
                format!("contacts as hard as the timestep allows, `solref=\"{} 1\"`", two_digits(least));
            list.push((change, Box::new(move |m| make_stiffer(m, least))));
        }
        FaultKind::Drifts => {
            list.push((
                "`noslip_iterations=\"10\"`".into(),
                Box::new(|m| *m.edit().opt.noslip_iterations = 10),
            ));
            if model.dof_frictionloss.iter().any(|&loss| loss > 0.0) {
                let hard = |m: &mut Model| {
                    rows_mut::<5>(m.edit().dof_solimp).iter_mut().for_each(|s| s[..2].fill(0.9999));
                };
                list.push((
                    "a harder friction of joints, `solimpfriction=\"0.9999 0.9999\"`".into(),
                    Box::new(hard),
                ));
            }
            list.push((
                "`cone=\"elliptic\"` and `impratio=\"100\"`".into(),
                Box::new(|m| (*m.edit().opt.cone, *m.edit().opt.impratio) = (1, 100.0)),
            ));
        }
        _ => {}
    }
    list
}

/// Multiplies the time constants of contacts.
fn soften(m: &mut Model, times: f64) {
    let edit = m.edit();
    for list in [edit.geom_solref, edit.pair_solref] {
        for s in rows_mut::<2>(list) {
            *s = if s[0] > 0.0 { [times * s[0], s[1]] } else { [s[0] / (times * times), s[1] / times] };
        }
    }
}

fn make_stiffer(m: &mut Model, time: f64) {
    let edit = m.edit();
    for list in [edit.geom_solref, edit.pair_solref] {
        rows_mut::<2>(list).iter_mut().for_each(|s| *s = [time, 1.0]);
    }
}
