//! The compiled [`Program`]: what it is known to do, and how it runs.

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

/// The call of an aggregate function in a program: `first(contact('a', 'b'))`, `max(x)`. The host runs `args` over
/// many samples, stores what it makes of them with [`Context::set_aggregate`], then runs the program.
#[derive(Clone, Debug)]
pub struct Aggregate {
    /// Which function.
    pub function: FunctionId,
    /// Its arguments, each a program. They may hold aggregates of their own.
    pub args: Vec<Program>,
    /// Where the result goes; no two aggregates of one source text share a slot.
    pub slot: usize,
    /// Where the call stands.
    pub span: Span,
}

impl Aggregate {
    /// What its result measures.
    fn measure(&self, schema: &dyn Schema, given: &KnownDimensions) -> Measure {
        let arg = |i: usize| self.args.get(i).map_or(Measure::Unknown, |p| p.measured(schema, given).value);
        schema.function(self.function).gives.resolve(arg)
    }
}

/// A compiled text.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) code: Arc<MachineCode>,
    pub(crate) effects: Effects,
    pub(crate) result: Type,
    pub(crate) aggregates: Vec<Aggregate>,
    pub(crate) order: WriteOrder,
    /// The variables that were named when it was compiled.
    pub(crate) global_names: GlobalNames,
    /// What the numbers of its fields and elements are of ([`crate::Schema::identity`]).
    pub(crate) identity: u64,
    /// What it computes, if it is a numeric expression without effects.
    pub(crate) formula: Option<Arc<Formula>>,
    /// The shorter way to run that.
    pub(crate) row: Option<Arc<Row>>,
}

impl Program {
    /// The code of a tree that was bound to a schema, with the variables that are named by then.
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

    /// What it was compiled for: the [`crate::Schema::identity`] of then.
    pub fn identity(&self) -> u64 {
        self.identity
    }

    /// What it touches.
    pub fn effects(&self) -> &Effects {
        &self.effects
    }

    /// What its numbers measure. `schema` is what it was compiled for; it may know more of the units by now.
    pub fn measured(&self, schema: &dyn Schema, given: &KnownDimensions) -> TextDimensions {
        let aggregates = self.aggregates.iter().map(|a| (a.slot, a.measure(schema, given))).collect();
        measured(&self.code.form, schema, given, &aggregates).of_type(self.result)
    }

    /// What every run stores after the last call of a function of the host that it may make; `None` when it never
    /// calls it. What some way through the text passes by is not certain and left out.
    pub fn writes_after(&self, function: FunctionId) -> Option<Vec<Access>> {
        self.order.writes_after(function)
    }

    /// What the text may store itself, rather than a function of the host that it calls.
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

    /// Runs it once. `value` is what the control gives, if any. Statements give `undefined`.
    ///
    /// # Errors
    /// The host is of something else than what the program was compiled for, as another model: nothing is run. A function of the
    /// host fails, the host refuses to store a value, or a string grows beyond its limit. What was stored before stays stored,
    /// as in JavaScript.
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
            && let Some(value) = self.quick(row, host, context)
        {
            context.events.clear();
            return Ok(value);
        }
        context.learn(&self.global_names);
        vm::run(&self.code, host, context, value)
    }

    /// The value of a formula; `None` where the machine has to run it: an element does not exist, or a watch needs places.
    #[inline]
    fn quick(&self, row: &Row, host: &dyn Host, context: &mut Context) -> Option<Value> {
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
