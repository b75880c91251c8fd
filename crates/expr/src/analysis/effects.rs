//! Which fields, variables and functions a program reads, writes and calls, derived from its SSA form.

use crate::effects::{Access, Effects};
use crate::schema::Schema;
use crate::ssa::{Args, Op, SsaFunction, SsaProgram, Terminator, Val};
use crate::tables::UnitId;
use crate::value::{Value, View};

/// Returns the effects of a program, including all functions that it may call, in the order of their first occurrence.
pub(crate) fn effects(form: &SsaProgram, schema: &dyn Schema) -> Effects {
    let mut look =
        EffectWalk { form, schema, effects: Effects::default(), seen: vec![false; form.units.len()] };
    look.unit(0);
    let mut effects = look.effects;
    // Arrays used as values may be read. They may also be written if the program stores through any value.
    for exposed in &form.views {
        effects.read(whole(exposed.view));
        if effects.stores_items && exposed.assignable {
            effects.write(whole(exposed.view));
        }
    }
    effects
}

/// All elements of a view.
pub(super) fn whole(view: View) -> Access {
    Access { field: view.field, first: view.first as usize, count: view.count() }
}

/// One element of a view if its index is known, otherwise all elements.
pub(super) fn element(view: View, index: Option<f64>) -> Access {
    match index {
        Some(i) if i >= 0.0 && i.fract() == 0.0 => Access {
            field: view.field,
            first: (view.first as usize).saturating_add(i as usize),
            count: Some(1),
        },
        _ => whole(view),
    }
}

/// The elements that an operation stores directly.
pub(super) fn written(op: &Op, unit: &SsaFunction) -> Option<Access> {
    match *op {
        Op::Store(field, index, _) => Some(Access { field, first: index as usize, count: Some(1) }),
        Op::StoreAt(view, index, _) => Some(element(view, unit.constant(index))),
        Op::Fill(view, _) => Some(whole(view)),
        _ => None,
    }
}

/// Whether an operation may store elements through a value.
pub(super) fn stores_items(op: &Op) -> bool {
    match op {
        Op::StoreItem(_, _, _, record) | Op::StoreMember(_, _, _, record) => !record,
        Op::Method(_, name, _) | Op::MethodList(_, name, ..) => name.rows().any(|row| row.changes),
        _ => false,
    }
}

struct EffectWalk<'f> {
    form: &'f SsaProgram,
    schema: &'f dyn Schema,
    effects: Effects,
    /// Functions already visited.
    seen: Vec<bool>,
}

impl EffectWalk<'_> {
    fn unit(&mut self, id: UnitId) {
        let Some(unit) = self.form.units.get(id as usize) else { return };
        if self.seen.get_mut(id as usize).is_none_or(|seen| std::mem::replace(seen, true)) {
            return;
        }
        unit.ops.iter().for_each(|op| self.op(op, unit));
        // A loop may be stopped by the iteration limit, which is an error.
        self.effects.can_throw |= unit.blocks.iter().any(|b| matches!(b.end, Terminator::Again(_)));
    }

    fn op(&mut self, op: &Op, unit: &SsaFunction) {
        let effects = &mut self.effects;
        effects.can_throw |= op.may_fail();
        effects.stores_items |= stores_items(op);
        if let Some(access) = written(op, unit) {
            effects.write(access);
        }
        match *op {
            Op::Load(_, field, index) => {
                effects.read(Access { field, first: index as usize, count: Some(1) })
            }
            Op::LoadAt(_, view, index) | Op::LoadValueAt(_, view, index) => {
                effects.read(element(view, unit.constant(index)));
            }
            Op::LoadValue(_, view, index) => effects.read(element(view, Some(f64::from(index)))),
            Op::Length(_, view) => effects.read(whole(view)),
            Op::PickNumber(_, table, _) => {
                for (_, value) in self.form.picks.get(table as usize).iter().flat_map(|picks| &picks.members)
                {
                    if let Value::View(view) = value {
                        effects.read(whole(*view));
                    }
                }
            }
            Op::Input(_) => effects.uses_value = true,
            Op::Global(_, slot) | Op::GlobalNumber(_, slot) => effects.read_global(slot),
            Op::StoreGlobal(slot, _) => effects.write_global(slot),
            Op::GlobalNamed(..) | Op::StoreGlobalNamed(..) => effects.any_ctx = true,
            Op::Aggregate(..) => effects.aggregates = true,
            Op::CallHost(_, function, _) => {
                let info = self.schema.function(function);
                effects.call(function, &info.reads, &info.writes);
            }
            Op::Invoke(..) | Op::InvokeList(..) => effects.calls_values = true,
            Op::Call(unit) | Op::Closure(_, unit, _) => self.unit(unit),
            _ => {}
        }
    }
}

/// The array on which a method is called, if it is known statically.
pub(super) fn receiver(op: &Op, unit: &SsaFunction) -> Option<View> {
    let operand = |args: &Args| args.operands(&unit.args).first().copied();
    let name = match op {
        Op::Method(_, _, args) => operand(args)?,
        Op::MethodList(_, _, on, _) => on.0,
        _ => return None,
    };
    match unit.constant_value(Val(name))? {
        Value::View(view) => Some(*view),
        _ => None,
    }
}
