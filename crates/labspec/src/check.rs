//! The whole check of a lesson: structure, names, runs of every lab, verdicts of every question.

use crate::bind::scene::{Models, finding};
use crate::bind::{Bound, ControlProgram, Programs, functions, warning, writes_kind};
use crate::finding::{self, Finding};
use crate::run::{self, RunOptions, Session, Trouble};
use crate::spec::{Control, ControlKind, Lab, LabAddress, Lesson, Question, Verify, VerifyLab};
use crate::verify::{self, BoundVerify, Claim, Verdict};
use labspec_core::reflect::{Kind, Object};
use labspec_core::{Model, stability};
use labspec_expr::Value;
use std::ops::Range;
use std::sync::Arc;

/// A lab that was run, for the report.
#[derive(Clone, Debug, PartialEq)]
pub struct RanLab {
    /// Its address in the lesson.
    pub address: LabAddress,
    /// Its title, possibly empty.
    pub title: String,
    /// Number of runs: as it stands, and with each control moved to its ends.
    pub runs: usize,
    /// `false` when it could not be run.
    pub ran: bool,
}

/// A lesson with everything that is known about it.
#[derive(Debug)]
pub struct Checked {
    /// The lesson.
    pub lesson: Lesson,
    /// Everything that is wrong, in order.
    pub findings: Vec<Finding>,
    /// The labs.
    pub labs: Vec<RanLab>,
    /// The questions and the labs with claims.
    pub claims: Vec<Claim>,
}

/// What a check does beyond structure and names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depth {
    /// Run every lab.
    pub labs: bool,
    /// Verify every claim.
    pub claims: bool,
}

/// Length of the runs that look for what breaks, s.
const TRIAL: f64 = 2.0;
/// When buttons are pressed in them, s.
const PRESS: f64 = 0.1;
/// Most steps of such a run.
const TRIAL_STEPS: usize = 20_000;

/// A lab with its model and programs.
struct Ready<'l> {
    lab: &'l Lab,
    model: Arc<Model>,
    programs: Programs,
}

/// Checks a lesson that has been read. Findings of model files are left in `models`.
pub fn check(lesson: Lesson, models: &mut Models, depth: Depth) -> Checked {
    let mut findings = Vec::new();
    let (labs, claims) = {
        let ready: Vec<Ready<'_>> =
            lesson.all_labs().into_iter().filter_map(|lab| prepare(lab, models, &mut findings)).collect();
        let labs = if depth.labs { run_labs(&lesson, &ready, &mut findings) } else { Vec::new() };
        let claims = if depth.claims { claims(&lesson, &ready, &mut findings) } else { Vec::new() };
        (labs, claims)
    };
    let mut all = lesson.findings.clone();
    all.extend(findings.into_iter().map(|f| f.at(&lesson.file)));
    finding::sort(&mut all);
    Checked { lesson, findings: all, labs, claims }
}

/// Loads the model of a lab and binds its programs.
fn prepare<'l>(lab: &'l Lab, models: &mut Models, findings: &mut Vec<Finding>) -> Option<Ready<'l>> {
    let model = models.of(lab, findings)?;
    if let Some(key) = lab.key.as_ref().filter(|k| k.value >= model.nkey as f64) {
        findings.push(
            finding("keyframe-missing", key.span.clone(), format!("the model has no keyframe {}", key.value))
                .why("the page then silently starts from the default configuration")
                .help(match model.nkey {
                    0 => "the model has no keyframes: leave `key` out, or add <keyframe><key …/></keyframe> to it".to_string(),
                    n => format!("its keyframes are 0 to {}", n - 1),
                }),
        );
    }
    let programs = Programs::compile(lab, &model, findings);
    lint_programs(lab, &programs, findings);
    Some(Ready { lab, model, programs })
}

/// What programs do that a page lets pass in silence.
fn lint_programs(lab: &Lab, programs: &Programs, findings: &mut Vec<Finding>) {
    for bound in programs.bound() {
        let calls_set_const =
            bound.program.effects().calls.iter().any(|&f| functions::name(f) == Some("mj_setConst"));
        if let Some(field) = writes_kind(bound, Object::Model, &[Kind::Inertial])
            && !calls_set_const
        {
            let name = field.info().name;
            findings.push(
                warning("missing-setconst", bound.text.span(), format!("`model.{name}` is changed without `mj.mj_setConst(model, data)`"))
                    .why("constants that follow from it (subtree masses, inverse weights of contacts) keep the old value: a heavier ball then sinks deeper into the floor than any real one")
                    .help("add `; mj.mj_setConst(model, data)`; it also puts qpos back to the start"),
            );
        }
    }
    for (control, (label, program)) in lab.controls.iter().zip(&programs.controls) {
        let ControlProgram::Change(_, action) = program else { continue };
        let Some(bound) = &action.run else { continue };
        if action.init {
            continue;
        }
        if let Some(field) =
            writes_kind(bound, Object::Data, &[Kind::State, Kind::Input]).filter(|_| !calls_reset(bound))
        {
            findings.push(
                warning(
                    "lost-at-reset",
                    bound.text.span(),
                    format!("what \"{label}\" sets is lost at the next reset"),
                )
                .why(format!(
                    "a reset puts data.{} back, while the control still shows the chosen value",
                    field.info().name
                ))
                .help("add \"init\": true, so that it is applied again after every reset")
                .related(control.label.span(), "the control"),
            );
        }
    }
}

/// Whether a program resets or recomputes the data itself, so that its writes to it are a consequence.
fn calls_reset(bound: &Bound) -> bool {
    bound.program.effects().calls.iter().any(|&f| functions::name(f).is_some_and(|n| n.starts_with("mj_")))
}

/// Runs every lab that has an address, as it stands and with each control at its ends.
fn run_labs(lesson: &Lesson, ready: &[Ready<'_>], findings: &mut Vec<Finding>) -> Vec<RanLab> {
    let each = |(address, lab): (LabAddress, &Lab)| {
        let runs = ready.iter().find(|r| std::ptr::eq(r.lab, lab)).map_or(0, |r| try_lab(r, findings));
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
    let prepared = run::set_controls(&mut session, &ready.programs, &trial.options.set)
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

/// Checks every `verify` object; questions without one are listed as unverified.
fn claims(lesson: &Lesson, ready: &[Ready<'_>], findings: &mut Vec<Finding>) -> Vec<Claim> {
    let mut list = Vec::new();
    for (address, lab) in lesson.addressed() {
        if let Some(verify) = &lab.verify {
            let name = format!("lab {address}");
            list.push(claim(name, verify, Some(lab), None, lesson, ready, findings));
        }
    }
    for quiz in &lesson.quizzes {
        let id = quiz.id.as_ref().map_or("", |t| t.as_str());
        for (number, question) in quiz.numbered() {
            let name = format!("quiz {id}, question {number}");
            match &question.verify {
                Some(verify) => {
                    list.push(claim(name, verify, question.sim(), Some(question), lesson, ready, findings))
                }
                None => list.push(Claim {
                    name,
                    span: question.span.clone(),
                    verdict: Verdict::Unverified,
                    measures: Vec::new(),
                    quotes: 0,
                }),
            }
        }
    }
    list
}

fn claim(
    name: String,
    verify: &Verify,
    own: Option<&Lab>,
    question: Option<&Question>,
    lesson: &Lesson,
    ready: &[Ready<'_>],
    findings: &mut Vec<Finding>,
) -> Claim {
    let lab = match &verify.lab {
        None => own,
        Some(VerifyLab::Inline(lab)) => Some(&**lab),
        Some(VerifyLab::Reference(_, address)) => lesson.lab(address),
        Some(VerifyLab::Broken) => None,
    };
    let target = lab.and_then(|lab| ready.iter().find(|r| std::ptr::eq(r.lab, lab)));
    let bound = target.and_then(|r| BoundVerify::new(verify, r.lab, &r.model, &r.programs, findings));
    let judgement = bound.map(|b| verify::check(&b, verify, question, lesson, findings));
    let (verdict, measures, quotes) =
        judgement.map_or((Verdict::Failed, Vec::new(), 0), |j| (j.verdict, j.measures, j.quotes));
    Claim { name, span: verify.span.clone(), verdict, measures, quotes }
}
