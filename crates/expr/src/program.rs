//! The compiled [`Program`]: its properties, and its execution.

use std::sync::Arc;

use crate::analysis::measure::{KnownDimensions, TextDimensions, measured};
use crate::analysis::{self, WriteOrder};
use crate::code::MachineCode;
use crate::context::Context;
use crate::dimension::Measure;
use crate::effects::{Access, Effects};
use crate::formula::Formula;
use crate::global_names::GlobalNames;
use crate::globals::Globals;
use crate::host::Host;
use crate::ir::IrProgram;
use crate::lower::{emit, lower, whole_formula};
use crate::row::Row;
use crate::rules;
use crate::runtime_event::RuntimeError;
use crate::schema::Schema;
use crate::types::{FunctionId, Type};
use crate::value::Value;
use crate::vm;
use labspec_finding::Span;

/// A call of an aggregate function in a program: `first(contact('a', 'b'))`, `max(x)`. The host runs `args` over many samples,
/// stores the result with [`Context::set_aggregate`], and then runs the program.
#[derive(Clone, Debug)]
pub struct Aggregate {
    /// The function.
    pub function: FunctionId,
    /// Its arguments, each of which is a program. They may contain further aggregates.
    pub args: Vec<Program>,
    /// The slot of the result; each aggregate of a source text has a different one.
    pub slot: usize,
    /// The span of the call.
    pub span: Span,
}

impl Aggregate {
    /// The measure of its result.
    fn measure(&self, schema: &dyn Schema, given: &KnownDimensions) -> Measure {
        let arg = |i: usize| self.args.get(i).map_or(Measure::Unknown, |p| p.measured(schema, given).value);
        schema.function(self.function).gives.resolve(arg)
    }
}

/// A compiled source text.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) code: Arc<MachineCode>,
    pub(crate) effects: Effects,
    pub(crate) result: Type,
    pub(crate) aggregates: Vec<Aggregate>,
    pub(crate) order: WriteOrder,
    /// The variables that existed when it was compiled.
    pub(crate) global_names: GlobalNames,
    /// Identifies the model to which its fields and elements belong ([`crate::Schema::identity`]).
    pub(crate) identity: u64,
    /// Its formula, if it is a numeric expression without effects.
    pub(crate) formula: Option<Arc<Formula>>,
    /// The faster representation of that formula.
    pub(crate) row: Option<Arc<Row>>,
}

impl Program {
    /// Compiles a tree that was bound to a schema, with the variables that exist by then.
    pub(crate) fn new(
        tree: &IrProgram,
        schema: &dyn Schema,
        result: Type,
        aggregates: Vec<Aggregate>,
        globals: &Globals,
    ) -> Program {
        let form = lower(tree);
        let effects = analysis::effects(&form, schema);
        let formula = form.units.first().and_then(whole_formula).map(Arc::new);
        let row = formula.as_deref().and_then(Row::from_formula).map(Arc::new);
        let order = WriteOrder::analyze(&form, &effects);
        Program {
            code: emit(form, row.is_none()).into(),
            effects,
            result,
            aggregates,
            order,
            global_names: globals.shared_names().clone(),
            identity: schema.identity(),
            formula,
            row,
        }
    }

    /// The [`crate::Schema::identity`] for which it was compiled.
    pub fn identity(&self) -> u64 {
        self.identity
    }

    /// Its effects.
    pub fn effects(&self) -> &Effects {
        &self.effects
    }

    /// The dimensions of its numbers. `schema` is the one for which it was compiled; it may know more units by now.
    pub fn measured(&self, schema: &dyn Schema, given: &KnownDimensions) -> TextDimensions {
        let aggregates = self.aggregates.iter().map(|a| (a.slot, a.measure(schema, given))).collect();
        measured(&self.code.form, schema, given, &aggregates).of_type(self.result)
    }

    /// The elements that every run stores after the last possible call of `function`, or `None` if it never calls it. Writes
    /// that some path through the program bypasses are not certain and not included.
    pub fn writes_after(&self, function: FunctionId) -> Option<Vec<Access>> {
        self.order.writes_after(function)
    }

    /// The elements that the program may store itself, without those stored by functions of the host.
    pub fn own_writes(&self) -> Vec<Access> {
        self.order.own_writes()
    }

    /// The type of its value; [`Type::Void`] for statements.
    pub fn result_type(&self) -> Type {
        self.result
    }

    /// The aggregates whose results it needs before it runs.
    pub fn aggregates(&self) -> &[Aggregate] {
        &self.aggregates
    }

    /// Runs the program once. `value` is the value of a control, if there is one. Statements return `undefined`.
    ///
    /// # Errors
    /// The host has a different identity than the program, such as that of another model; then nothing is run. A function of
    /// the host fails, the host refuses to store a value, or a string exceeds its limit. As in JavaScript, values stored before
    /// the error remain stored.
    pub fn run(
        &self,
        host: &mut dyn Host,
        context: &mut Context,
        value: Option<&Value>,
    ) -> Result<Value, RuntimeError> {
        if host.identity() != self.identity {
            return Err(foreign());
        }
        if let Some(row) = &self.row
            && let Some(value) = self.formula_value(row, host, context)
        {
            context.events.clear();
            return Ok(value);
        }
        context.learn(&self.global_names);
        vm::run(&self.code, host, context, value)
    }

    /// Returns the value of a formula, or `None` if the virtual machine must run it: an element does not
    /// exist, or a watch needs spans.
    #[inline]
    fn formula_value(&self, row: &Row, host: &dyn Host, context: &mut Context) -> Option<Value> {
        match &mut context.watch {
            None => row.value(|elements, out| host.read(elements, out), &mut context.numbers),
            Some(watch) => {
                watch.begin();
                row.watched_value(|elements, out| host.read(elements, out), &mut context.numbers, watch)
                    .filter(|_| !watch.loses())
            }
        }
    }
}

#[cold]
fn foreign() -> RuntimeError {
    let message = "the program was compiled for something else; compile it for what it runs on".to_string();
    RuntimeError { rule: rules::HOST_CALL, span: Span::default(), message }
}
