//! Masses and inertias that change without `mj_setConst`: whether it shows, and what to write instead, both by running.
//!
//! Constants follow from masses (subtree masses, inverse weights of contacts) and keep their old value until
//! `mj_setConst`, which also puts qpos back to the model's own. So a lab is run as it is, and with the constants
//! computed anew and the state kept; where nothing visible differs, nothing is said. The advice is run too.

mod bench;
mod difference;

pub(super) use bench::Bench;
pub(super) use difference::digits;

use crate::bind::{Bound, ControlProgram, Programs, functions, writes_kind};
use crate::finding::Finding;
use crate::rules;
use crate::spec::{Lab, Run, Verify};
use bench::Amended;
use labspec_core::Model;
use labspec_core::reflect::{FieldId, Kind, Object};
use labspec_expr::{Type, Value};

/// Where a program stands.
#[derive(Clone, Copy)]
enum Place<'a> {
    Setup,
    Controller,
    Control(usize),
    /// The setup of a run of a `verify` object.
    Run(&'a Run),
}

/// A program that changes what constants follow from.
struct Suspect<'a> {
    place: Place<'a>,
    bound: &'a Bound,
    field: FieldId,
    /// It calls mj_setConst, and writes behind it.
    late: bool,
    /// Its text is the target of a `set`.
    target: bool,
    /// The type of `value` in it.
    given: Option<Type>,
}

/// What stands behind the statements of a suspect.
#[derive(Clone, Copy, PartialEq)]
enum Advice {
    /// mj_setConst alone: for a lab whose qpos is the model's own then, or that is reset at once.
    Plain,
    /// mj_setConst with qpos kept.
    Keep,
}

impl Advice {
    fn statements(self, text: &str) -> String {
        let name =
            ["q", "kept", "qpos_kept"].into_iter().find(|n| !text.contains(n)).unwrap_or("qpos_as_it_was");
        match self {
            Advice::Plain => "mj.mj_setConst(model, data)".into(),
            Advice::Keep => {
                format!(
                    "const {name} = data.qpos.slice(); mj.mj_setConst(model, data); data.qpos.set({name})"
                )
            }
        }
    }

    /// What is written behind a text.
    fn tail(self, text: &str) -> String {
        let last_line = text.lines().last().unwrap_or("");
        let between = match text.trim_end() {
            _ if last_line.contains("//") => "\n",
            t if t.ends_with(';') => " ",
            _ => "; ",
        };
        format!("{between}{}", self.statements(text))
    }
}

/// Checks the programs of a lab.
pub(super) fn check(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    let own = [(Place::Setup, &programs.setup), (Place::Controller, &programs.controller)];
    let mut all: Vec<Suspect<'_>> =
        own.into_iter().filter_map(|(place, b)| suspect(place, b.as_ref()?, false, None)).collect();
    for (i, ((_, program), control)) in programs.controls.iter().zip(&lab.controls).enumerate() {
        let (bound, given) = match program {
            ControlProgram::Press(run) => (run.as_ref(), None),
            ControlProgram::Change(Value::Number(_), action) => (action.run.as_ref(), Some(Type::Number)),
            ControlProgram::Change(_, action) => (action.run.as_ref(), Some(Type::Any)),
        };
        let target =
            |b: &Bound| control.action().and_then(|a| a.set.as_ref()).is_some_and(|set| *set == b.text);
        all.extend(bound.and_then(|b| suspect(Place::Control(i), b, target(b), given)));
    }
    let mut bench = Bench::new(lab, model, programs);
    findings.extend(all.iter().filter_map(|s| bench.judge(s)));
}

/// Checks the setup of a run of a `verify` object, as `check` does that of the lab.
pub(super) fn check_run(
    verify: &Verify,
    run: &Run,
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    findings: &mut Vec<Finding>,
) {
    let Some(text) = &run.setup else { return };
    let mut bench = Bench::new(lab, model, programs);
    let bound = bench.compile(text, &text.value, None);
    let Some(s) = bound.as_ref().and_then(|b| suspect(Place::Run(run), b, false, None)) else { return };
    findings.extend(bench.judge(&s).filter(|_| !bench.contrasted(&s, verify)));
}

fn suspect<'a>(place: Place<'a>, bound: &'a Bound, target: bool, given: Option<Type>) -> Option<Suspect<'a>> {
    let inertial = |f: &FieldId| f.info().object == Object::Model && f.info().kind == Kind::Inertial;
    let set_const =
        bound.program.effects().calls.iter().find(|&&f| functions::name(f) == Some("mj_setConst"));
    let (field, late) = match set_const {
        None => (writes_kind(bound, Object::Model, &[Kind::Inertial])?, false),
        Some(&call) => {
            let after = bound.program.writes_after(call)?;
            (after.iter().filter_map(|a| FieldId::new(a.field.0 as usize)).find(inertial)?, true)
        }
    };
    Some(Suspect { place, bound, field, late, target, given })
}

impl Bench<'_> {
    /// The finding, unless nothing visible differs.
    fn judge(&mut self, s: &Suspect<'_>) -> Option<Finding> {
        let name = s.field.info().name;
        let when = if s.late { "after the last" } else { "without" };
        let text = &s.bound.text;
        let finding = Finding::warning(
            rules::MISSING_SETCONST,
            text.span(),
            format!("`model.{name}` is changed {when} `mj.mj_setConst(model, data)`"),
        );
        let why =
            "constants that follow from it (subtree masses, inverse weights of contacts) keep the old value";
        let advised = |advice: Advice| match (s.target, advice) {
            (true, _) => {
                let set = format!("{} = value; {}", text.value, advice.statements(&text.value));
                format!("instead of \"set\", write \"apply\": {}", serde_json::Value::from(set))
            }
            (false, _) => format!("add `{}`", advice.tail(&text.value).replace('\n', " ").trim()),
        };
        match self.compare(s) {
            Ok(None) => None,
            Ok(Some((evidence, advice))) => {
                let finding = finding.why(format!("{why}: {evidence}"));
                let reason = match advice {
                    Advice::Plain => "; tried, the lab then runs with the right constants",
                    Advice::Keep => {
                        "; tried. `mj_setConst` alone would also put qpos back to the model's own, so qpos is kept around it"
                    }
                };
                let finding = finding.help(format!("{}{reason}", advised(advice)));
                if s.target {
                    return Some(finding);
                }
                let end = text.span().end;
                let tail = serde_json::Value::from(advice.tail(&text.value)).to_string();
                Some(finding.fix(end..end, tail.trim_matches('"')))
            }
            Err(reason) => Some(
                finding
                    .why(format!("{why}: a heavier ball then sinks deeper into the floor than any real one"))
                    .help(format!(
                        "{}, which keeps qpos; whether it shows in this lab could not be tried: {reason}",
                        advised(Advice::Keep)
                    )),
            ),
        }
    }

    /// What differs, in words, and the advice that was run; `Err` says why it could not be tried.
    fn compare(&mut self, s: &Suspect<'_>) -> Result<Option<(String, Advice)>, String> {
        let refreshed = self.amended(s, Advice::Keep).ok_or("the statements cannot be amended")?;
        let steps = self.steps(s)?;
        let trials = self.trials(s, steps);
        let mut untried = None;
        let mut found = None;
        let mut kept = Vec::new();
        for (i, trial) in trials.iter().enumerate() {
            let records = self.record(s, None, trial, steps).and_then(|a| {
                let b = self.record(s, Some(&refreshed), trial, steps)?;
                Ok((a, b))
            });
            match records {
                Ok((as_is, anew)) => {
                    if found.is_none() {
                        found = self.columns().difference(&as_is, &anew).map(|d| d.said(&trial.said));
                    }
                    kept.push((i, anew));
                }
                Err(reason) => untried = untried.or(Some(format!("{}, {reason}", trial.said))),
            }
        }
        let Some(evidence) = found else { return untried.map_or(Ok(None), Err) };
        let plain = self.amended(s, Advice::Plain);
        let mut gives_the_same = |program: &Amended| {
            kept.iter().all(|(i, anew)| {
                let again = trials.get(*i).map(|trial| self.record(s, Some(program), trial, steps));
                again.is_some_and(|r| r.is_ok_and(|r| self.columns().difference(anew, &r).is_none()))
            })
        };
        let advice =
            if plain.as_ref().is_some_and(&mut gives_the_same) { Advice::Plain } else { Advice::Keep };
        Ok(Some((evidence, advice)))
    }
}
