//! The runs that look for what breaks: every lab as it stands, and with each control at its ends.

use super::{RanLab, Ready};
use crate::bind::scene::finding;
use crate::bind::warning;
use crate::finding::Finding;
use crate::run::{self, RunOptions, Session, Trouble};
use crate::spec::{Control, ControlKind, Lab, LabAddress, Lesson};
use labspec_core::stability;
use labspec_expr::Value;
use std::ops::Range;

/// Length of the runs that look for what breaks, s.
const TRIAL: f64 = 2.0;
/// When buttons are pressed in them, s.
const PRESS: f64 = 0.1;
/// Most steps of such a run.
const TRIAL_STEPS: usize = 20_000;

/// Runs every lab that has an address, as it stands and with each control at its ends.
pub(super) fn run_labs(lesson: &Lesson, ready: &[Ready<'_>], findings: &mut Vec<Finding>) -> Vec<RanLab> {
    let each = |(address, lab): (LabAddress, &Lab)| {
        let before = findings.len();
        let runs = ready.iter().find(|r| std::ptr::eq(r.lab, lab)).map_or(0, |r| try_lab(r, findings));
        super::expect::settle(lab, runs, findings, before);
        RanLab { address, title: lab.title().to_string(), runs, ran: runs > 0 }
    };
    lesson.addressed().into_iter().map(each).collect()
}

/// One thing that a student may do before pressing play.
struct Trial<'a> {
    options: RunOptions,
    /// What was done, for the message.
    done: String,
    /// The control, unless it is the lab as it stands.
    control: Option<&'a Control>,
}

fn try_lab(ready: &Ready<'_>, findings: &mut Vec<Finding>) -> usize {
    let mut trials =
        vec![Trial { options: RunOptions::default(), done: "as it stands".into(), control: None }];
    for control in &ready.lab.controls {
        let label = &control.label.value;
        let mut set = |value: Value| {
            trials.push(Trial {
                done: format!("with \"{label}\" at {value}"),
                options: RunOptions { set: vec![(label.clone(), value)], ..RunOptions::default() },
                control: Some(control),
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
                options: RunOptions { press: vec![(label.clone(), PRESS)], ..RunOptions::default() },
                control: Some(control),
            }),
        }
    }
    let mut broken_anyway = false;
    for trial in &trials {
        // A lab that breaks as it stands breaks with every control: say it once.
        if broken_anyway {
            break;
        }
        let broken = attempt(ready, trial, findings);
        broken_anyway |= broken && trial.control.is_none();
    }
    trials.len()
}

/// Makes one run and reports what broke; `true` when something did.
fn attempt(ready: &Ready<'_>, trial: &Trial<'_>, findings: &mut Vec<Finding>) -> bool {
    let lab = ready.lab;
    let key = lab.keyframe();
    let mut session = Session::start(&ready.programs, &ready.model, key, &ready.programs.demand);
    let place = trial.control.map_or(lab_place(lab), |c| c.label.span());
    let prepared = run::set_controls(&mut session, ready.lab, &ready.programs, &trial.options.set)
        .and_then(|()| run::presses(&ready.programs, &trial.options.press));
    let timestep = session.world.model.opt.timestep;
    let steps = run::count_steps(lab, lab.stop_at.is_none().then_some(TRIAL), None, timestep);
    let (presses, steps) = match (prepared, steps) {
        (Ok(p), Ok(n)) => (p, n.min(TRIAL_STEPS)),
        (Err(e), _) | (_, Err(e)) => {
            findings.push(finding("run-impossible", place, e.0));
            return true;
        }
    };
    let mut pending = presses.as_slice();
    session.press_due(&mut pending);
    session.sample();
    session.watch(steps);
    for i in 1..=steps {
        session.press_due(&mut pending);
        session.step();
        // Expressions rarely start to throw in mid-run: look at them now and then.
        if i % 50 == 0 || i == steps {
            session.sample();
        }
    }
    let troubles = session.troubles.iter().map(|t| trouble(t, &trial.done));
    let before = findings.len();
    findings.extend(troubles);
    if let Some(f) = diverged(&session, &trial.done, place.clone()) {
        findings.push(f);
    } else if trial.control.is_none()
        && let Some(f) = too_stiff(&session, place)
    {
        findings.push(f);
    }
    findings.len() > before
}

/// Where to point when a whole lab is meant: at its model.
fn lab_place(lab: &Lab) -> Range<usize> {
    let scene = lab.model.as_ref().or(lab.xml.as_ref());
    scene.map_or(lab.span.start..lab.span.start + 1, |t| t.span())
}

/// A program that threw, at its place.
fn trouble(t: &Trouble, done: &str) -> Finding {
    finding(t.code, t.text.span_of(t.span.clone()), format!("{} ({done}, at t = {} s)", t.message, t.time))
        .why("on the page an error in `setup` or `controller` freezes the lab, and one in a trace shows nan")
        .help("correct the statement, or guard it with a condition")
}

/// A simulation that met a bad number, or gained energy from nothing, with time, joint and likely cause.
fn diverged(session: &Session<'_>, done: &str, place: Range<usize>) -> Option<Finding> {
    let breakdown = run::Breakdown::of(session)?;
    Some(
        warning(breakdown.code, place, format!("the simulation breaks {done}: {}", breakdown.what))
            .why(breakdown.why)
            .help(breakdown.help),
    )
}

/// What of a lab's scene no step of its length can follow, whether or not a run shows it.
fn too_stiff(session: &Session<'_>, place: Range<usize>) -> Option<Finding> {
    let model = &session.world.model;
    let worst = stability::suspects(model).into_iter().next()?;
    let [owner, times] = [run::owner(model, &worst), run::times(&worst)];
    let message = format!("{owner} is {times} times too stiff for its timestep");
    Some(
        warning("stiff-for-timestep", place, message)
            .why("every step pushes farther than the last one missed: it oscillates ever wider, without a word from MuJoCo until a number is beyond 1e10")
            .help(run::remedy(model, &worst)),
    )
}
