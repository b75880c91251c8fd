//! Detects programs that change one parameter of a model without the values that depend on it: constants that follow from
//! masses, the inertia of a changed mass, the bounding radius of a changed size, the bias of a changed gain. The effect and
//! the suggested repair are both determined by running the lab.
//!
//! Constants (subtree masses, inverse weights of contacts) keep their old value until `mj_setConst`, which also resets qpos
//! to that of the model. So a lab is run unchanged, with the constants recomputed and the state preserved, and with the
//! parameters of [`coupled`](crate::bind::coupled) corrected after the program. Without a visible difference, nothing is
//! reported. The suggestion is run too.

mod advice;
mod bench;
mod compare;
mod difference;
mod findings;

pub(crate) use bench::SetConstBench;
pub(crate) use difference::digits;
pub(super) use findings::{by_rule, left};

use crate::bind::coupled::{self, PairSet};
use crate::bind::{Bound, ControlProgram, Programs, functions, writes_kind};
use crate::finding::Finding;
use crate::rules;
use crate::spec::{Lab, Run, Verify};
use labspec_core::Model;
use labspec_core::reflect::{FieldId, Kind, Object};
use labspec_expr::{Type, Value};

/// The location of a program.
#[derive(Clone, Copy)]
enum ProgramSite<'a> {
    Setup,
    Controller,
    Control(usize),
    /// The setup of a run of a `verify` object.
    Run(&'a Run),
}

/// A program that changes a parameter on which others depend.
struct SuspectProgram<'a> {
    place: ProgramSite<'a>,
    bound: &'a Bound,
    /// A field from which constants follow, if they are not recomputed after it is written; `true` where mj_setConst is
    /// called before.
    inertial: Option<(FieldId, bool)>,
    /// The pairs whose parameter it writes.
    pairs: PairSet,
    /// Whether its text is the target of a `set`.
    target: bool,
    /// The type of `value` in the program.
    given: Option<Type>,
}

/// Checks the programs of a lab.
pub(super) fn check_setconst(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    let suspect = |place, b, target, given| find_suspect(place, b, target, given, programs);
    let of_lab = [(ProgramSite::Setup, &programs.setup), (ProgramSite::Controller, &programs.controller)];
    let mut all: Vec<SuspectProgram<'_>> =
        of_lab.into_iter().filter_map(|(place, b)| suspect(place, b.as_ref()?, false, None)).collect();
    for (i, ((_, program), control)) in programs.controls.iter().zip(&lab.controls).enumerate() {
        let (bound, given) = match program {
            ControlProgram::Press(run) => (run.as_ref(), None),
            ControlProgram::Change(Value::Number(_), action) => (action.run.as_ref(), Some(Type::Number)),
            ControlProgram::Change(_, action) => (action.run.as_ref(), Some(Type::Any)),
        };
        let target =
            |b: &Bound| control.action().and_then(|a| a.set.as_ref()).is_some_and(|set| *set == b.text);
        all.extend(bound.and_then(|b| suspect(ProgramSite::Control(i), b, target(b), given)));
    }
    let mut bench = SetConstBench::new(lab, model, programs);
    findings.extend(all.iter().flat_map(|s| bench.judge(s)));
}

/// Checks the setup of a run of a `verify` object, as [`check_setconst`] checks that of the lab.
pub(super) fn check_run(
    verify: &Verify,
    run: &Run,
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    findings: &mut Vec<Finding>,
) {
    let Some(text) = &run.setup else { return };
    let mut bench = SetConstBench::new(lab, model, programs);
    let bound = bench.compile(text, &text.value, None);
    let Some(s) = bound.as_ref().and_then(|b| find_suspect(ProgramSite::Run(run), b, false, None, programs))
    else {
        return;
    };
    if bench.paired(&s, verify) {
        return;
    }
    for finding in bench.judge(&s) {
        let anew = bench.corrected(&s, PairSet::NONE);
        if finding.code != rules::MISSING_SETCONST.code || !bench.is_contrasted(&s, verify, &anew) {
            findings.push(finding);
        }
    }
}

fn find_suspect<'a>(
    place: ProgramSite<'a>,
    bound: &'a Bound,
    target: bool,
    given: Option<Type>,
    programs: &Programs,
) -> Option<SuspectProgram<'a>> {
    let inertial = inertial(bound);
    let pairs = PairSet::written_by(&bound.program);
    let pairs = pairs.without(coupled::intentionally_separate(programs, bound, pairs));
    let found = inertial.is_some() || !pairs.is_empty();
    found.then_some(SuspectProgram { place, bound, inertial, pairs, target, given })
}

/// A field from which constants follow and which a program changes without recomputing them; `true` where it recomputes
/// them before.
fn inertial(bound: &Bound) -> Option<(FieldId, bool)> {
    let inertial = |f: &FieldId| f.info().object == Object::Model && f.info().kind == Kind::Inertial;
    let set_const =
        bound.program.effects().calls.iter().find(|&&f| functions::name(f) == Some("mj_setConst"));
    match set_const {
        None => Some((writes_kind(bound, Object::Model, &[Kind::Inertial])?, false)),
        Some(&call) => {
            let after = bound.program.writes_after(call)?;
            Some((after.iter().filter_map(|a| FieldId::new(a.field.0 as usize)).find(inertial)?, true))
        }
    }
}
