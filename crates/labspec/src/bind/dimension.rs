//! What the numbers of a lab measure: every text with the variables that the other texts store.

use super::labels;
use super::{ControlProgram, ModelNames, Programs, Scope};
use crate::spec::{Control, ControlKind, Lab};
use labspec_core::Model;
use labspec_expr::dimension::{Dimension, Measure};
use labspec_expr::{Compiler, Given, Globals, Measured, Type};
use std::collections::BTreeMap;

/// What the texts of a lab measure, in the order of its [`Programs`]. A text with mistakes has nothing.
#[derive(Clone, Debug, Default)]
pub struct Dimensions {
    /// Traces, then readouts.
    pub probes: Vec<Option<Measured>>,
    /// Controls.
    pub controls: Vec<Option<Measured>>,
    /// Setup and controller.
    pub others: Vec<Option<Measured>>,
}

/// Rounds in which variables learn from each other; what has not settled then is unknown.
const ROUNDS: usize = 6;

/// What the texts of a lab measure.
pub fn dimensions(lab: &Lab, model: &Model, programs: &Programs) -> Dimensions {
    settle(lab, model, programs).2
}

/// The dimension of an expression that names what a lab's texts name; `None` where it is not certain.
pub fn dimension_of(lab: &Lab, model: &Model, programs: &Programs, code: &str) -> Option<Dimension> {
    let (mut work, variables, _) = settle(lab, model, programs);
    let given = Given { variables, ..Given::default() };
    let measured =
        Compiler::new(&work.names, &mut work.globals).measuring(&given).expression(code).measured?;
    match measured.value {
        Measure::Known(dimension) => Some(dimension),
        _ => None,
    }
}

/// What the variables of a lab hold, for texts that read them.
pub(crate) fn given(lab: &Lab, model: &Model, programs: &Programs) -> Given {
    let (_, variables, _) = settle(lab, model, programs);
    Given { variables, ..Given::default() }
}

/// Measures all texts until the variables that they store have settled.
fn settle<'l>(
    lab: &'l Lab,
    model: &'l Model,
    programs: &'l Programs,
) -> (Work<'l>, BTreeMap<u32, Measure>, Dimensions) {
    let names = ModelNames::new(model, Scope::Lab).with(&programs.functions);
    let mut work = Work { names, globals: programs.globals.clone(), lab, programs };
    let mut variables = BTreeMap::new();
    let computed = programs.bound().any(|b| b.program.effects().any_ctx);
    if computed {
        let all = (0..programs.globals.len() as u32).map(|slot| (slot, Measure::Unknown));
        variables.extend(all);
    }
    for _ in 0..ROUNDS {
        let found = work.round(&variables);
        let stored = work.stored(&found);
        let settled = stored.iter().all(|(slot, m)| variables.get(slot) == Some(m));
        if settled || computed {
            return (work, variables, found);
        }
        variables = stored;
    }
    variables.values_mut().for_each(|m| *m = Measure::Unknown);
    let found = work.round(&variables);
    (work, variables, found)
}

/// What a slider gives, by its unit.
pub(crate) fn given_by(control: &Control) -> Measure {
    let unit = match &control.kind {
        ControlKind::Slider { unit: Some(unit), .. } => labels::unit(unit.as_str()),
        _ => labels::of_label(control.label.as_str()).map(|(_, d)| d),
    };
    unit.map_or(Measure::Unknown, Measure::Known)
}

struct Work<'l> {
    names: ModelNames<'l>,
    globals: Globals,
    lab: &'l Lab,
    programs: &'l Programs,
}

impl Work<'_> {
    /// Every text once.
    fn round(&mut self, variables: &BTreeMap<u32, Measure>) -> Dimensions {
        let (lab, programs) = (self.lab, self.programs);
        let given = Given { variables: variables.clone(), ..Given::default() };
        let probes = programs.probes.iter().map(|p| {
            let text = &p.bound.as_ref()?.text;
            Compiler::new(&self.names, &mut self.globals).measuring(&given).expression(&text.value).measured
        });
        let probes = probes.collect();
        let others = [&programs.setup, &programs.controller].map(|bound| {
            let text = &bound.as_ref()?.text;
            Compiler::new(&self.names, &mut self.globals).measuring(&given).statements(&text.value).measured
        });
        let controls = lab.controls.iter().zip(&programs.controls);
        let controls =
            controls.map(|(control, (_, program))| self.control(control, program, &given)).collect();
        Dimensions { probes, controls, others: others.into() }
    }

    fn control(&mut self, control: &Control, program: &ControlProgram, given: &Given) -> Option<Measured> {
        let of_value = given_by(control);
        match program {
            ControlProgram::Press(run) => {
                let text = &run.as_ref()?.text;
                let mut compiler = Compiler::new(&self.names, &mut self.globals).measuring(given);
                compiler.statements(&text.value).measured
            }
            ControlProgram::Change(_, action) => {
                let given = Given { value: of_value, ..given.clone() };
                let sets = control.action().is_some_and(|a| a.set.is_some());
                let measured = action.run.as_ref().and_then(|bound| {
                    let compiler = Compiler::new(&self.names, &mut self.globals);
                    let mut compiler = compiler.with_value(Some(Type::Number)).measuring(&given);
                    let text = &bound.text.value;
                    if sets { compiler.assignment(text) } else { compiler.statements(text) }.measured
                });
                let mut measured = match (measured, action.param) {
                    (Some(measured), _) => measured,
                    (None, Some(_)) => Measured::default(),
                    (None, None) => return None,
                };
                if let Some(slot) = action.param {
                    let known = measured.variables.entry(slot).or_insert(Measure::Anything);
                    *known = known.or(of_value);
                }
                Some(measured)
            }
        }
    }

    /// What every variable holds, whoever stores it.
    fn stored(&self, found: &Dimensions) -> BTreeMap<u32, Measure> {
        let mut all = BTreeMap::new();
        let texts = found.probes.iter().chain(&found.controls).chain(&found.others).flatten();
        for (slot, measure) in texts.flat_map(|m| &m.variables) {
            let known = all.entry(*slot).or_insert(Measure::Anything);
            *known = Measure::or(*known, *measure);
        }
        all
    }
}
