//! Typed tree to SSA form, one function after the other.

use super::builder::{FunctionBuilder, Variables};
use super::fold::fold;
use crate::ir::{self, IrProgram, LocalId};
use crate::ssa::{Op, Operand, Representation, SsaProgram, Terminator};
use labspec_finding::Span;

/// The SSA form of a program.
pub(crate) fn lower(tree: &IrProgram) -> SsaProgram {
    let mut form = SsaProgram { views: tree.views.clone(), ..SsaProgram::default() };
    let mut variables = Variables::default();
    for unit in &tree.units {
        let mut build = FunctionBuilder::new(tree, &mut form, variables);
        build.whole(unit);
        build.undo_stores(0);
        let mut done = build.unit;
        variables = build.variables;
        fold(&mut done);
        done.same.shorten();
        form.units.push(done);
    }
    form
}

impl FunctionBuilder<'_> {
    fn whole(&mut self, unit: &ir::IrFunction) {
        self.unit.result = unit.result.map_or(Representation::Value, Representation::for_type);
        self.unit.params = unit.params.iter().map(|p| self.slot(*p)).collect();
        self.unit.captures = unit.captures.iter().map(|c| self.slot(*c)).collect();
        let given: Vec<(LocalId, Operand)> =
            unit.params.iter().chain(&unit.captures).map(|&l| (l, self.given(l))).collect();
        for (i, (local, operand)) in given.into_iter().enumerate() {
            let operand = match operand {
                // A captured variable is passed as its cell already.
                Operand::Value(value) if self.is_shared(local) && i < unit.params.len() => {
                    Operand::Value(self.value_of(Span::default(), |dst| Op::NewCell(dst, value)))
                }
                operand => operand,
            };
            self.write(local, operand);
        }
        self.steps(&unit.body);
        self.end(Terminator::Return(None), Span::default());
    }

    /// The name of a parameter.
    fn given(&mut self, local: LocalId) -> Operand {
        match self.slot(local) {
            Representation::Value => Operand::Value(self.new_value()),
            Representation::Number | Representation::Boolean => Operand::Number(self.new_number()),
        }
    }
}
