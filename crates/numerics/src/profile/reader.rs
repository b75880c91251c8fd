//! An additional reader, and the stages that it requires.

use labspec::bind::{ModelNames, Programs, Scope, include};
use labspec::run::RunError;
use labspec_core::reflect::{Object, Stage, data, field};
use labspec_core::{AccessSet, Model, Plan};
use labspec_expr::Compiler;

/// The cost of an additional reader: the stages and the time that it adds to those of the lab.
#[derive(Clone, Debug, PartialEq)]
pub struct ExtraReader {
    /// The text of the request.
    pub text: String,
    /// The fields that programs read and write with it.
    pub access: AccessSet,
    /// The stages that run only with it.
    pub joins: Vec<Stage>,
    /// The additional time of a step, ns; `None` if nothing was measured.
    pub cost: Option<f64>,
}

/// The readers separately and, if there are several, all of them together.
///
/// # Errors
/// A text is not a field, a sensor or a valid expression.
pub(super) fn readers(
    model: &Model,
    programs: &Programs,
    texts: &[String],
) -> Result<Vec<ExtraReader>, RunError> {
    let mut all = programs.access;
    let mut readers = Vec::new();
    for text in texts {
        let mut access = programs.access;
        read(model, programs, text, &mut access)?;
        read(model, programs, text, &mut all)?;
        readers.push(reader(model, programs, text, access));
    }
    if texts.len() > 1 {
        readers.push(reader(model, programs, "all of these", all));
    }
    Ok(readers)
}

fn reader(model: &Model, programs: &Programs, text: &str, access: AccessSet) -> ExtraReader {
    let (before, after) = (Plan::new(model, &programs.access), Plan::new(model, &access));
    let joins = after.decisions().iter().map(|d| d.stage).filter(|s| after.keeps(*s) && !before.keeps(*s));
    ExtraReader { text: text.to_string(), access, joins: joins.collect(), cost: None }
}

/// Adds the fields that a field name, a sensor name or an expression reads.
fn read(model: &Model, programs: &Programs, text: &str, access: &mut AccessSet) -> Result<(), RunError> {
    if let Some(field) = field(Object::Data, text.strip_prefix("data.").unwrap_or(text)) {
        access.reads.insert(field);
        return Ok(());
    }
    if let Ok(sensor) = model.sensor(text) {
        let places = sensor.values(model);
        access.reads.insert_elements(data::sensordata, places.start, Some(places.len()));
        return Ok(());
    }
    let names = ModelNames::new(model, Scope::Lab).with(&programs.functions);
    let mut globals = programs.globals.clone();
    let compiled = Compiler::new(&names, &mut globals).expression(text);
    match compiled.program {
        Some(program) => include(program.effects(), access),
        None => {
            let why = compiled.diagnostics.first().map_or(String::new(), |d| format!(": {}", d.message));
            return Err(RunError::new(format!(
                "`{text}` is not a field of the data, a sensor or an expression{why}"
            )));
        }
    }
    Ok(())
}
