//! Pairs in the programs of a lab: which of them are corrected, which the lab intentionally separates, and the statements
//! that repair a program.

use super::correction::Coupled;
use super::pair_set::{PairSet, writes_field};
use super::statements::{Repair, StatementWriter};
use super::table::{CoupledPair, PAIRS};
use crate::bind::programs::{Bound, ControlProgram, Programs, include};
use labspec_bind::{ModelNames, Scope};
use labspec_core::Model;
use labspec_core::reflect::FieldId;
use labspec_expr::{Compiler, Globals};

impl Coupled {
    /// Makes the runs of these programs corrected runs.
    pub(crate) fn install(self, programs: &mut Programs, model: &Model) {
        // The access set of the lab includes the reads and writes of the correction.
        let names = ModelNames::new(model, Scope::Lab);
        let mut globals = Globals::new();
        let set_const = "const q = data.qpos.slice(); mj.mj_setConst(model, data); data.qpos.set(q)";
        if let Some(program) = Compiler::new(&names, &mut globals).statements(set_const).program {
            include(program.effects(), &mut programs.access);
        }
        PAIRS.iter().for_each(|pair| programs.access.writes.insert(pair.partner));
        programs.coupled = Some(self);
    }
}

/// Maximum number of elements that a repair names individually.
const MAX_NAMED_ELEMENTS: usize = 4;

impl Repair {
    /// The statements for these pairs; `None` where a pair has none.
    pub(crate) fn of_program(bound: &Bound, pairs: PairSet, model: &Model) -> Option<Repair> {
        let mut made = StatementWriter { model, text: &bound.text.value, repair: Repair::default() };
        for (_, pair) in pairs.pairs() {
            let written = written_elements(bound, pair.parameter)
                .filter(|w| w.len() <= MAX_NAMED_ELEMENTS)
                .unwrap_or_default();
            (pair.repair?)(&mut made, &written)?;
        }
        Some(made.repair)
    }
}

/// The pairs that a lab intentionally separates: a control that does not write the parameter sets the coupled parameter. A
/// student then chooses both values independently.
pub(crate) fn intentionally_separate(programs: &Programs, bound: &Bound, pairs: PairSet) -> PairSet {
    let controls = programs.controls.iter().filter_map(|(_, c)| match c {
        ControlProgram::Change(_, action) => action.run.as_ref(),
        ControlProgram::Press(_) => None,
    });
    let others: Vec<&Bound> = controls.filter(|other| other.text != bound.text).collect();
    let has_separate_writer = |pair: &CoupledPair| {
        let partners: Vec<_> =
            written_elements(bound, pair.parameter).into_iter().flatten().flat_map(pair.partners).collect();
        let has = |other: &&Bound| {
            let coupled = written_elements(other, pair.partner).unwrap_or_default();
            !writes_field(&other.program, pair.parameter) && partners.iter().any(|i| coupled.contains(i))
        };
        others.iter().any(has)
    };
    pairs.pairs().filter(|(_, pair)| has_separate_writer(pair)).map(|(one, _)| one).collect()
}

/// Maximum number of elements of a field that are listed individually.
const MOST_ELEMENTS: usize = 64;

/// The elements of a field that a program writes itself, if they are known.
fn written_elements(bound: &Bound, field: FieldId) -> Option<Vec<usize>> {
    let written = bound.program.own_writes();
    let mut all = Vec::new();
    for access in written.iter().filter(|a| a.field.0 as usize == field.index()) {
        let count = access.count.filter(|n| *n <= MOST_ELEMENTS)?;
        all.extend(access.first..access.first + count);
    }
    all.sort_unstable();
    all.dedup();
    (!all.is_empty()).then_some(all)
}
