//! The order in which a program writes and calls, derived from its SSA form. Lints use it to find calls that come too
//! early. An operation that some path through a function bypasses is uncertain. A call of a function that is known only at
//! run time may call any function.

use super::effects::{receiver, stores_items, whole, written};
use crate::effects::{Access, Effects};
use crate::ssa::{Op, SsaFunction, SsaProgram, Terminator};
use crate::tables::UnitId;
use crate::types::FunctionId;
use crate::value::View;

/// A write or a call of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OrderedEvent {
    /// The program stores elements itself, not through a function of the host.
    Write(Access),
    /// It calls a function of the host.
    Call(FunctionId),
    /// It calls a function that is known only at run time.
    Anything,
}

/// The events of a program in order. The flag is `true` if every run that does not end early performs the event.
#[derive(Clone, Debug, Default)]
pub(crate) struct WriteOrder {
    events: Vec<(OrderedEvent, bool)>,
}

/// Limit on the operations visited. A function of the program that is called twice counts twice.
const MOST_PARTS: usize = 20_000;

impl WriteOrder {
    pub(crate) fn analyze(form: &SsaProgram, effects: &Effects) -> WriteOrder {
        // Most texts write nothing and call nothing.
        if effects.writes.is_empty() && effects.calls.is_empty() {
            return WriteOrder::default();
        }
        let mut walk = OrderWalk { form, events: Vec::new(), within: Vec::new(), parts: 0 };
        walk.unit(0, true);
        if walk.parts > MOST_PARTS {
            // The walk was cut off: nothing about the order is certain.
            walk.events.iter_mut().for_each(|(_, certain)| *certain = false);
            walk.events.push((OrderedEvent::Anything, false));
        }
        WriteOrder { events: walk.events }
    }

    /// The elements that every run stores after the last possible call of `function`, or `None` if the program never calls
    /// it.
    pub(crate) fn writes_after(&self, function: FunctionId) -> Option<Vec<Access>> {
        self.events.iter().position(|(e, _)| *e == OrderedEvent::Call(function))?;
        let may_call = |e: &OrderedEvent| *e == OrderedEvent::Call(function) || *e == OrderedEvent::Anything;
        let last = self.events.iter().rposition(|(e, _)| may_call(e))?;
        Some(self.events.get(last..)?.iter().filter(|(_, certain)| *certain).filter_map(store).collect())
    }

    /// The elements that the program may store itself, without those stored by functions of the host.
    pub(crate) fn own_writes(&self) -> Vec<Access> {
        let mut all: Vec<Access> = Vec::new();
        for access in self.events.iter().filter_map(store) {
            if !all.contains(&access) {
                all.push(access);
            }
        }
        all
    }
}

fn store((event, _): &(OrderedEvent, bool)) -> Option<Access> {
    if let OrderedEvent::Write(access) = event { Some(*access) } else { None }
}

struct OrderWalk<'f> {
    form: &'f SsaProgram,
    events: Vec<(OrderedEvent, bool)>,
    /// The functions being visited. A recursive function is visited once.
    within: Vec<UnitId>,
    parts: usize,
}

impl OrderWalk<'_> {
    fn unit(&mut self, id: UnitId, certain: bool) {
        let Some(unit) = self.form.units.get(id as usize).filter(|_| !self.within.contains(&id)) else {
            return;
        };
        self.within.push(id);
        for (block, always) in blocks_on_every_path(unit).into_iter().enumerate() {
            for op in unit.ops.get(unit.range(block as u32)).unwrap_or(&[]) {
                self.parts += 1;
                if self.parts <= MOST_PARTS {
                    self.op(op, unit, certain && always);
                }
            }
        }
        self.within.pop();
    }

    fn op(&mut self, op: &Op, unit: &SsaFunction, certain: bool) {
        if let Some(access) = written(op, unit) {
            self.events.push((OrderedEvent::Write(access), certain));
        }
        if stores_items(op) {
            self.through_values(receiver(op, unit));
        }
        match *op {
            Op::CallHost(_, function, _) => self.events.push((OrderedEvent::Call(function), certain)),
            Op::Invoke(..) | Op::InvokeList(..) => self.events.push((OrderedEvent::Anything, certain)),
            Op::Call(id) => self.unit(id, certain),
            // From here on, any call may run it.
            Op::Closure(_, id, _) => self.unit(id, false),
            _ => {}
        }
    }

    /// A store into an array that is used as a value: into `view`, or, if that is unknown, into any array used as a value.
    fn through_values(&mut self, view: Option<View>) {
        for exposed in self.form.views.iter().filter(|s| s.assignable && view.is_none_or(|v| v == s.view)) {
            self.events.push((OrderedEvent::Write(whole(exposed.view)), false));
        }
    }
}

/// Which blocks lie on every path from start to end. Blocks are in source order, so a block lies on every path if no jump
/// from an earlier block leads past it.
fn blocks_on_every_path(unit: &SsaFunction) -> Vec<bool> {
    let end = unit.blocks.len();
    let (mut reached, mut furthest) = (vec![false; end + 1], 0);
    let mut all = Vec::with_capacity(end);
    for (index, block) in unit.blocks.iter().enumerate() {
        let here = index == 0 || reached.get(index) == Some(&true);
        all.push(here && furthest <= index);
        if !here {
            continue;
        }
        let mut lead = |to: usize| {
            furthest = furthest.max(to);
            if let Some(place) = reached.get_mut(to) {
                *place = true;
            }
        };
        match &block.end {
            Terminator::Jump(edge) => lead(edge.to as usize),
            Terminator::If(_, _, edge) | Terminator::IfNothing(_, _, edge) => {
                lead(index + 1);
                lead(edge.to as usize);
            }
            Terminator::Return(_) => lead(end),
            Terminator::Again(_) => {}
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use crate::mock::Mock;
    use crate::*;

    fn after(source: &str) -> Option<Vec<usize>> {
        let mut globals = Globals::new();
        let compiled = Compiler::new(&Mock, &mut globals).statements(source);
        let program = compiled.program.unwrap_or_else(|| panic!("{source}: {:?}", compiled.diagnostics));
        let writes = program.writes_after(FunctionId(0))?;
        Some(writes.iter().map(|a| a.first).collect())
    }

    #[test]
    fn writes_after_the_last_call() {
        let cases: &[(&str, Option<&[usize]>)] = &[
            ("model.body_mass[1] = 2", None),
            ("mj_setConst; model.body_mass[1] = 2", Some(&[1])),
            ("model.body_mass[1] = 2; mj_setConst", Some(&[])),
            ("mj_setConst(); model.body_mass[1] *= 2; mj_setConst; model.body_mass[2]++", Some(&[2])),
            ("mj_setConst; const m = model.body_mass; m[1] = 2", Some(&[1])),
            ("const heavy = (x) => { model.body_mass[1] = x }; mj_setConst(); heavy(2)", Some(&[1])),
            ("const late = () => mj_setConst(); model.body_mass[1] = 2; late()", Some(&[])),
            // In these programs, no write after the call is certain.
            ("mj_setConst; if (data.time > 0) { model.body_mass[1] = 2 }", Some(&[])),
            ("mj_setConst; data.time > 0 && (model.body_mass[1] = 2)", Some(&[])),
            ("mj_setConst; for (let i = 0; i < 2; i++) model.body_mass[i] = 2", Some(&[])),
            ("mj_setConst; model.body_mass[1] = 2; if (data.time > 0) mj_setConst()", Some(&[])),
            ("mj_setConst; model.body_mass[1] = 2; ctx.f()", Some(&[])),
        ];
        for (source, expected) in cases {
            assert_eq!(after(source).as_deref(), *expected, "{source}");
        }
    }

    #[test]
    fn own_writes_are_not_those_of_functions() {
        let mut globals = Globals::new();
        let mut writes_of = |source: &str| {
            let program = Compiler::new(&Mock, &mut globals).statements(source).program.unwrap();
            program.own_writes().iter().map(|a| (a.field.0, a.first, a.count)).collect::<Vec<_>>()
        };
        assert_eq!(writes_of("mj_setConst()"), []);
        assert_eq!(writes_of("data.qvel[2] = 1; mj_setConst"), [(2, 2, Some(1))]);
        assert_eq!(writes_of("if (data.time > 0) data.qvel[2] = 1"), [(2, 2, Some(1))]);
        assert_eq!(writes_of("ctx.kept = data.qvel.slice()"), []);
        assert_eq!(
            writes_of("const q = data.qvel.slice(); data.qvel.set(q)").first().map(|a| (a.0, a.1)),
            Some((2, 0))
        );
    }
}
