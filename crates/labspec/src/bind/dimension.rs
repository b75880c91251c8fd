//! The dimensions of the numbers of a lab: of every text, including the variables that other texts store.

use super::labels;
use super::{Bound, ControlProgram, ModelNames, Programs, Scope};
use crate::spec::{Control, ControlKind, Lab};
use labspec_core::Model;
use labspec_expr::dimension::{Dimension, Measure};
use labspec_expr::{Compiler, KnownDimensions, TextDimensions};
use std::collections::BTreeMap;

/// The dimensions of the texts of a lab, in the order of its [`Programs`]; `None` for a text with errors.
#[derive(Clone, Debug, Default)]
pub struct Dimensions {
    /// Traces, then readouts.
    pub probes: Vec<Option<TextDimensions>>,
    /// Controls.
    pub controls: Vec<Option<TextDimensions>>,
    /// Setup and controller.
    pub others: Vec<Option<TextDimensions>>,
}

/// Maximum number of rounds in which variables are inferred from each other; variables that still change are unknown.
const ROUNDS: usize = 6;

/// The dimensions of the texts of a lab.
pub fn dimensions(lab: &Lab, model: &Model, programs: &Programs) -> Dimensions {
    settle(lab, model, programs).2
}

/// The dimension of an expression with the names of a lab's texts; `None` where it is not certain.
pub fn dimension_of(lab: &Lab, model: &Model, programs: &Programs, code: &str) -> Option<Dimension> {
    let (work, variables, _) = settle(lab, model, programs);
    let given = KnownDimensions { variables, ..KnownDimensions::default() };
    let mut globals = programs.globals.clone();
    let program = Compiler::new(&work.names, &mut globals).expression(code).program?;
    match program.measured(&work.names, &given).value {
        Measure::Dimension(dimension) => Some(dimension),
        _ => None,
    }
}

/// The dimensions of the variables of a lab, for texts that read them.
pub(crate) fn given(lab: &Lab, model: &Model, programs: &Programs) -> KnownDimensions {
    let (_, variables, _) = settle(lab, model, programs);
    KnownDimensions { variables, ..KnownDimensions::default() }
}

/// Infers the dimensions of all texts until those of the variables no longer change.
fn settle<'l>(
    lab: &'l Lab,
    model: &'l Model,
    programs: &'l Programs,
) -> (DimensionPass<'l>, BTreeMap<u32, Measure>, Dimensions) {
    let names = ModelNames::new(model, Scope::Lab).with(&programs.functions);
    let work = DimensionPass { names, lab, programs };
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

/// The dimension of the value of a control, by its unit.
pub fn given_by(control: &Control) -> Measure {
    let unit = match &control.kind {
        ControlKind::Slider { unit: Some(unit), .. } => {
            labels::unit_beside(unit.as_str(), control.label.as_str())
        }
        _ => labels::of_label(control.label.as_str()).map(|(_, d)| d),
    };
    unit.map_or(Measure::Unknown, Measure::Dimension)
}

struct DimensionPass<'l> {
    names: ModelNames<'l>,
    lab: &'l Lab,
    programs: &'l Programs,
}

impl DimensionPass<'_> {
    /// Infers every text once.
    fn round(&self, variables: &BTreeMap<u32, Measure>) -> Dimensions {
        let (lab, programs) = (self.lab, self.programs);
        let given = KnownDimensions { variables: variables.clone(), ..KnownDimensions::default() };
        let one = |bound: &Option<Bound>| self.one(bound, &given);
        let controls = lab.controls.iter().zip(&programs.controls);
        Dimensions {
            probes: programs.probes.iter().map(|p| one(&p.bound)).collect(),
            controls: controls
                .map(|(control, (_, program))| self.control(control, program, &given))
                .collect(),
            others: [&programs.setup, &programs.controller].map(one).into(),
        }
    }

    fn one(&self, bound: &Option<Bound>, given: &KnownDimensions) -> Option<TextDimensions> {
        bound.as_ref().map(|bound| bound.program.measured(&self.names, given))
    }

    fn control(
        &self,
        control: &Control,
        program: &ControlProgram,
        given: &KnownDimensions,
    ) -> Option<TextDimensions> {
        let of_value = given_by(control);
        match program {
            ControlProgram::Press(run) => self.one(run, given),
            ControlProgram::Change(_, action) => {
                let measured = self.one(&action.run, &KnownDimensions { value: of_value, ..given.clone() });
                let mut measured = match (measured, action.param) {
                    (Some(measured), _) => measured,
                    (None, Some(_)) => TextDimensions::default(),
                    (None, None) => return None,
                };
                if let Some(slot) = action.param {
                    let recorded = measured.variables.entry(slot).or_insert(Measure::Anything);
                    *recorded = recorded.or(of_value);
                }
                Some(measured)
            }
        }
    }

    /// The dimension of every variable, over all texts that store it.
    fn stored(&self, found: &Dimensions) -> BTreeMap<u32, Measure> {
        let mut all = BTreeMap::new();
        let texts = found.probes.iter().chain(&found.controls).chain(&found.others).flatten();
        for (slot, measure) in texts.flat_map(|m| &m.variables) {
            let recorded = all.entry(*slot).or_insert(Measure::Anything);
            *recorded = Measure::or(*recorded, *measure);
        }
        all
    }
}
