//! Controllers that need not run in every step: those that write what follows from constants, `ctx` variables, parameters of the
//! model and inputs alone. While none of these changes, and nobody else changes what was written, one more run would write the same
//! numbers once more.
//!
//! Which controllers can be like this follows from their effects. Whether anything changed is seen by looking, number by number, so
//! that it does not matter who did it: a slider, a button, a reset, or the program around the session.

use crate::bind::World;
use labspec_core::reflect::{FieldId, Kind, Object};
use labspec_expr::{Access, Context, FieldKey, Host, Program, Value};

/// A controller of this kind, and how it was when it ran last.
#[derive(Clone, Debug)]
pub(super) struct Steady {
    /// Single numbers that it reads, and those that it writes.
    elements: Vec<(FieldKey, usize)>,
    /// The `ctx` variables that it reads.
    slots: Vec<u32>,
    /// The elements, then the variables, after the last run; and the work of that.
    last_values: Vec<u64>,
    work: Option<u64>,
}

/// A controller that looks at more numbers than this is as quickly run.
const MOST: usize = 16;

/// Whether a controller is of this kind.
pub fn is_steady(program: &Program) -> bool {
    Steady::of_program(program).is_some()
}

impl Steady {
    pub(super) fn of_program(program: &Program) -> Option<Steady> {
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
        // What it reads and writes itself differs from run to run.
        let apart = !reads.iter().any(|r| writes.contains(r));
        let fits = reads.len() + writes.len() + effects.ctx_reads.len() <= MOST;
        if looks_further || !alone || !apart || !fits || !reads.iter().all(|(field, _)| stays(*field)) {
            return None;
        }
        let elements = reads.into_iter().chain(writes).collect();
        Some(Steady { elements, slots: effects.ctx_reads.clone(), last_values: Vec::new(), work: None })
    }

    /// The work of the last run, when another one would change nothing.
    #[inline]
    pub(super) fn holds(&self, world: &World, context: &Context) -> Option<u64> {
        let work = self.work?;
        let now = self.now(world, context);
        self.last_values.iter().copied().map(Some).eq(now).then_some(work)
    }

    /// Keeps how things are after a run that did this work. Without it, another run follows.
    pub(super) fn keep(&mut self, world: &World, context: &Context, work: Option<u64>) {
        let mut numbers = std::mem::take(&mut self.last_values);
        numbers.clear();
        numbers.extend(self.now(world, context).map_while(|number| number));
        self.work = work.filter(|_| self.now(world, context).all(|number| number.is_some()));
        self.last_values = numbers;
    }

    /// All that it looks at, as bits; nothing for what is no number.
    fn now<'a>(&'a self, world: &'a World, context: &'a Context) -> impl Iterator<Item = Option<u64>> + 'a {
        let elements = self.elements.iter().map(|(field, i)| world.get(*field, *i).map(f64::to_bits));
        elements.chain(self.slots.iter().flat_map(|slot| bits(context.get(*slot))))
    }
}

/// What a value is, and which; nothing for what may change by itself.
fn bits(value: &Value) -> [Option<u64>; 2] {
    match value {
        Value::Undefined => [Some(0), Some(0)],
        Value::Null => [Some(1), Some(0)],
        Value::Boolean(b) => [Some(2), Some(u64::from(*b))],
        Value::Number(x) => [Some(3), Some(x.to_bits())],
        _ => [None, None],
    }
}

/// Whether steps leave a field alone: looking at others is not worth it.
fn stays(FieldKey(field): FieldKey) -> bool {
    FieldId::new(field as usize).is_some_and(|f| {
        let info = f.info();
        info.object != Object::Data || info.kind == Kind::Input
    })
}
