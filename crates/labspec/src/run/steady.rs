//! Controllers that need not run in every step: their writes depend only on constants, `ctx` variables, parameters of the
//! model and inputs. While none of these changes and the written values are unchanged, another run would write the same
//! numbers again.
//!
//! The effects of a controller show whether it is of this kind. Changes are detected by comparing every number, so they may
//! come from any source: a slider, a button, a reset, or the embedding program.

use crate::bind::World;
use labspec_core::reflect::{FieldId, Kind, Object};
use labspec_expr::{Access, Context, FieldKey, Host, Program, Value};

/// A controller of this kind, with the values after its last run.
#[derive(Clone, Debug)]
pub(super) struct SteadyController {
    /// Elements that it reads, and those that it writes.
    elements: Vec<(FieldKey, usize)>,
    /// The `ctx` variables that it reads.
    slots: Vec<u32>,
    /// The elements, then the variables, after the last run; and the work of that run.
    last_values: Vec<u64>,
    work: Option<u64>,
}

/// Maximum number of compared values: with more, running the controller is as fast.
const MAX_COMPARED: usize = 16;

/// Whether a controller is of this kind.
pub fn is_steady(program: &Program) -> bool {
    SteadyController::of_program(program).is_some()
}

impl SteadyController {
    pub(super) fn of_program(program: &Program) -> Option<SteadyController> {
        let effects = program.effects();
        let looks_further = effects.reads_everything
            || effects.writes_everything
            || effects.any_ctx
            || effects.calls_values
            || effects.uses_value
            || effects.aggregates
            || effects.stores_items();
        let one = |a: &Access| (a.count == Some(1)).then_some((a.field, a.first));
        let reads: Vec<_> = effects.reads.iter().map(one).collect::<Option<_>>()?;
        let writes: Vec<_> = effects.writes.iter().map(one).collect::<Option<_>>()?;
        let alone = effects.calls.is_empty() && effects.ctx_writes.is_empty();
        // An element that it both reads and writes may differ from run to run.
        let disjoint = !reads.iter().any(|r| writes.contains(r));
        let fits = reads.len() + writes.len() + effects.ctx_reads.len() <= MAX_COMPARED;
        if looks_further || !alone || !disjoint || !fits || !reads.iter().all(|(field, _)| stays(*field)) {
            return None;
        }
        let elements = reads.into_iter().chain(writes).collect();
        Some(SteadyController {
            elements,
            slots: effects.ctx_reads.clone(),
            last_values: Vec::new(),
            work: None,
        })
    }

    /// The work of the last run, if another run would change nothing.
    #[inline]
    pub(super) fn holds(&self, world: &World, context: &Context) -> Option<u64> {
        let work = self.work?;
        let current_values = self.current_values(world, context);
        self.last_values.iter().copied().map(Some).eq(current_values).then_some(work)
    }

    /// Stores the values after a run with this work. With `None`, the controller runs again in the next step.
    pub(super) fn keep(&mut self, world: &World, context: &Context, work: Option<u64>) {
        let mut numbers = std::mem::take(&mut self.last_values);
        numbers.clear();
        numbers.extend(self.current_values(world, context).map_while(|number| number));
        self.work = work.filter(|_| self.current_values(world, context).all(|number| number.is_some()));
        self.last_values = numbers;
    }

    /// The bits of all compared values; `None` for values that are not numbers.
    fn current_values<'a>(
        &'a self,
        world: &'a World,
        context: &'a Context,
    ) -> impl Iterator<Item = Option<u64>> + 'a {
        let elements = self.elements.iter().map(|(field, i)| world.get(*field, *i).map(f64::to_bits));
        elements.chain(self.slots.iter().flat_map(|slot| bits(context.get(*slot))))
    }
}

/// The type and the bits of a value; `None` for types that can change without a store.
fn bits(value: &Value) -> [Option<u64>; 2] {
    match value {
        Value::Undefined => [Some(0), Some(0)],
        Value::Null => [Some(1), Some(0)],
        Value::Boolean(b) => [Some(2), Some(u64::from(*b))],
        Value::Number(x) => [Some(3), Some(x.to_bits())],
        _ => [None, None],
    }
}

/// Whether steps do not change a field. Other fields change in every step, so comparing them is useless.
fn stays(FieldKey(field): FieldKey) -> bool {
    FieldId::new(field as usize).is_some_and(|f| {
        let info = f.info();
        info.object != Object::Data || info.kind == Kind::Input
    })
}
