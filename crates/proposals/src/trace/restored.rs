//! Runs with the model as in its file. The setup of a lab, especially of a question, may change its model ("the cube weighs 1.2
//! kg"), while the text still refers to the model that the course has used so far.

use super::trials::{MOST, TraceRun};
use labspec::bind::{ControlProgram, Programs, functions};
use labspec::run::{Budget, Session, Start};
use labspec::spec::Lab;
use labspec_core::Model;
use labspec_core::reflect::{FieldId, Object};

/// A setup with more changes than this makes another model.
const CHANGED: usize = 8;

/// The runs of a lab, followed by the first one and those with a button, with the model as in its file.
pub(super) fn with(mut all: Vec<TraceRun>, lab: &Lab, model: &Model, programs: &Programs) -> Vec<TraceRun> {
    let Some(statements) = statements(lab, model, programs) else { return all };
    let again = |(index, trial): (usize, &TraceRun)| {
        (index == 0 || !trial.press.is_empty()).then(|| TraceRun {
            words: format!("{}, with the model as in its file", trial.words),
            name: format!("{}_of_file", trial.name),
            restored: Some(statements.clone()),
            ..trial.clone()
        })
    };
    let more: Vec<TraceRun> = all.iter().enumerate().filter_map(again).collect();
    all.extend(more);
    all.truncate(MOST);
    all
}

/// Statements that undo the changes that the setup of a lab makes to its model; `None` if there are no changes, or too many, or
/// if a control sets the same field.
fn statements(lab: &Lab, model: &Model, programs: &Programs) -> Option<String> {
    let setup = programs.setup.as_ref()?;
    let set = programs.controls.iter().filter_map(|(_, control)| match control {
        ControlProgram::Change(_, action) => action.run.as_ref(),
        ControlProgram::Press(run) => run.as_ref(),
    });
    let set: Vec<_> = set.flat_map(|bound| bound.program.own_writes()).map(|write| write.field).collect();
    let writes = setup.program.own_writes();
    if !writes.iter().any(|write| of_model(FieldId::new(write.field.0 as usize))) {
        return None;
    }
    let start = Start { budget: Budget::TRIAL, ..Start::of_lab(lab) };
    let session = Session::start(programs, model, start);
    let mut all: Vec<String> = Vec::new();
    for write in writes {
        let field = FieldId::new(write.field.0 as usize).filter(|f| of_model(Some(*f)));
        let Some(field) = field.filter(|_| !set.contains(&write.field)) else { continue };
        let (initial, current) = (model.field(field)?, session.world.model.field(field)?);
        let end = write.count.map_or(initial.len(), |n| write.first + n).min(initial.len());
        for i in write.first..end {
            let (initial, current) = (initial.get(i)?, current.get(i)?);
            let statement = format!("{} = {initial}", element(field, i));
            if initial != current && initial.is_finite() && !all.contains(&statement) {
                all.push(statement);
            }
        }
    }
    if all.is_empty() || all.len() > CHANGED {
        return None;
    }
    // Fields that depend on masses are recomputed if the setup does so.
    let calls = &setup.program.effects().calls;
    if calls.iter().any(|&f| functions::name(f) == Some("mj_setConst")) {
        all.push("mj.mj_setConst(model, data)".into());
    }
    Some(all.join("; "))
}

fn of_model(field: Option<FieldId>) -> bool {
    field.is_some_and(|f| matches!(f.info().object, Object::Model | Object::Option))
}

/// An element as a lab refers to it.
fn element(field: FieldId, index: usize) -> String {
    let info = field.info();
    let object = if info.object == Object::Option { "model.opt" } else { "model" };
    let suffix = if info.shape.is_empty() { String::new() } else { format!("[{index}]") };
    format!("{object}.{}{suffix}", info.name)
}
