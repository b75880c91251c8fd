//! In which order a program writes and calls: what lints need to tell a call that comes too early.
//!
//! The walk is over the typed tree, in the order of JavaScript. What stands in a condition, in a loop or behind a jump
//! may not happen; a call of a function that is known only while running may call anything.

use crate::effects::{Access, Effects};
use crate::ir::{Index, Ir, Item, Kind, Place, Step, Tree, UnitId};
use crate::schema::FunctionId;
use crate::value::{Value, View};

/// Something that a program does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Event {
    /// It stores elements itself, rather than through a function of the host.
    Write(Access),
    /// It calls a function of the host.
    Call(FunctionId),
    /// It calls something that is known only while running.
    Anything,
}

/// What a program does, in order; `true` beside what every run does that does not end early.
#[derive(Clone, Debug, Default)]
pub(crate) struct Order {
    events: Vec<(Event, bool)>,
}

/// Parts of a tree that are looked at: a function of the text that is called twice counts twice.
const MOST_PARTS: usize = 20_000;

impl Order {
    pub(crate) fn of(tree: &Tree, effects: &Effects) -> Order {
        // Most texts write nothing and call nothing.
        if effects.writes.is_empty() && effects.calls.is_empty() {
            return Order::default();
        }
        let mut walk = Walk { tree, events: Vec::new(), within: Vec::new(), parts: 0 };
        walk.unit(0, true);
        if walk.parts > MOST_PARTS {
            // Not seen to the end: nothing is certain of the order.
            walk.events.iter_mut().for_each(|(_, certain)| *certain = false);
            walk.events.push((Event::Anything, false));
        }
        Order { events: walk.events }
    }

    /// What every run stores after the last call of `function` that it may make; `None` when it makes none.
    pub(crate) fn writes_after(&self, function: FunctionId) -> Option<Vec<Access>> {
        self.events.iter().position(|(e, _)| *e == Event::Call(function))?;
        let may_call = |e: &Event| *e == Event::Call(function) || *e == Event::Anything;
        let last = self.events.iter().rposition(|(e, _)| may_call(e))?;
        Some(self.events.get(last..)?.iter().filter(|(_, certain)| *certain).filter_map(written).collect())
    }

    /// What the text may store itself, calls of the host's functions left aside.
    pub(crate) fn own_writes(&self) -> Vec<Access> {
        let mut all: Vec<Access> = Vec::new();
        for access in self.events.iter().filter_map(written) {
            if !all.contains(&access) {
                all.push(access);
            }
        }
        all
    }
}

fn written((event, _): &(Event, bool)) -> Option<Access> {
    if let Event::Write(access) = event { Some(*access) } else { None }
}

struct Walk<'t> {
    tree: &'t Tree,
    events: Vec<(Event, bool)>,
    /// Functions around: one that calls itself is looked at once.
    within: Vec<UnitId>,
    parts: usize,
}

impl Walk<'_> {
    fn unit(&mut self, id: UnitId, certain: bool) {
        if self.within.contains(&id) {
            return;
        }
        if let Some(unit) = self.tree.units.get(id as usize) {
            self.within.push(id);
            self.steps(&unit.body, certain);
            self.within.pop();
        }
    }

    fn steps(&mut self, steps: &[Step], mut certain: bool) {
        for step in steps {
            match step {
                Step::Effect(ir) | Step::Declare(_, ir) => self.ir(ir, certain),
                Step::Reserve(_) | Step::Renew(_) => {}
                Step::If(test, then, otherwise) => {
                    self.ir(test, certain);
                    self.steps(then, false);
                    self.steps(otherwise, false);
                }
                Step::Loop(l) => {
                    l.test.iter().for_each(|test| self.ir(test, false));
                    self.steps(&l.body, false);
                    self.steps(&l.update, false);
                }
                Step::Return(ir) => self.ir(ir, certain),
                Step::Break | Step::Continue => {}
                Step::Inline(_, body, _) => self.steps(body, certain),
            }
            certain &= !jumps(step);
        }
    }

    fn ir(&mut self, ir: &Ir, certain: bool) {
        self.parts += 1;
        if self.parts > MOST_PARTS {
            return;
        }
        match &ir.kind {
            Kind::Constant(_) | Kind::Length(_) | Kind::Global(_) | Kind::Local(_) => {}
            Kind::Input | Kind::Aggregate(_) | Kind::Load(_, Index::At(_)) => {}
            Kind::Load(_, Index::Computed(x)) => self.ir(x, certain),
            Kind::GlobalNamed(x) | Kind::Unary(_, x) => self.ir(x, certain),
            Kind::ToNumber(x) | Kind::ToText(x) | Kind::TypeOf(x) => self.ir(x, certain),
            Kind::MathOver(_, x) | Kind::Member(x, _) | Kind::Pick(_, x) => self.ir(x, certain),
            // What follows `?.` may not happen.
            Kind::Chain(x) => self.ir(x, false),
            Kind::Present(x) => self.ir(x, certain),
            Kind::Binary(_, a, b) | Kind::Element(a, b) => {
                self.ir(a, certain);
                self.ir(b, certain);
            }
            Kind::Logical(_, a, b) => {
                self.ir(a, certain);
                self.ir(b, false);
            }
            Kind::Choice(test, a, b) => {
                self.ir(test, certain);
                self.ir(a, false);
                self.ir(b, false);
            }
            Kind::Math(_, list) => list.iter().for_each(|x| self.ir(x, certain)),
            Kind::Call(function, list) => {
                list.iter().for_each(|x| self.ir(x, certain));
                self.events.push((Event::Call(*function), certain));
            }
            Kind::Store(place, _, x) => self.store(place, Some(x), certain, certain),
            Kind::StoreIf(_, place, x) => self.store(place, Some(x), certain, false),
            Kind::Update(place, _, _) => self.store(place, None, certain, certain),
            Kind::Fill(view, x) => {
                self.ir(x, certain);
                self.write(*view, certain);
            }
            Kind::StoreAll(view, at, list) => {
                list.iter().for_each(|x| self.ir(x, certain));
                let access =
                    Access { field: view.field, first: view.first as usize + at, count: Some(list.len()) };
                self.events.push((Event::Write(access), certain));
            }
            Kind::List(items) | Kind::Native(_, items) => self.items(items, certain),
            Kind::Record(entries) => {
                for entry in entries {
                    match entry {
                        crate::ir::Entry::Named(_, x) | crate::ir::Entry::Spread(x) => self.ir(x, certain),
                        crate::ir::Entry::Computed(a, b) => {
                            self.ir(a, certain);
                            self.ir(b, certain);
                        }
                    }
                }
            }
            Kind::Method(name, on, items) => {
                self.ir(on, certain);
                self.items(items, certain);
                if name.rows().any(|row| row.changes) {
                    let known =
                        if let Kind::Constant(Value::View(view)) = &on.kind { Some(*view) } else { None };
                    self.through_values(known);
                }
            }
            // It may run whenever somebody calls it, from here on.
            Kind::Closure(unit) => self.unit(*unit, false),
            Kind::Invoke(unit, list) => {
                list.iter().for_each(|x| self.ir(x, certain));
                self.unit(*unit, certain);
            }
            Kind::InvokeValue(function, items) => {
                self.ir(function, certain);
                self.items(items, certain);
                self.events.push((Event::Anything, certain));
            }
            Kind::Block(steps, x) => {
                self.steps(steps, certain);
                self.ir(x, certain && !steps.iter().any(jumps));
            }
        }
    }

    fn items(&mut self, items: &[Item], certain: bool) {
        items.iter().for_each(|item| self.ir(&item.value, certain));
    }

    /// `around`: whether the place and the value are computed for certain.
    fn store(&mut self, place: &Place, value: Option<&Ir>, around: bool, certain: bool) {
        match place {
            Place::Element(_, Index::Computed(x)) => self.ir(x, around),
            Place::GlobalNamed(x) | Place::Member(x, _) => self.ir(x, around),
            Place::Item(a, b) => {
                self.ir(a, around);
                self.ir(b, around);
            }
            Place::Element(_, Index::At(_)) | Place::Global(_) | Place::Local(_) => {}
        }
        value.into_iter().for_each(|x| self.ir(x, around));
        match place {
            Place::Element(view, Index::At(i)) => {
                let access = Access { field: view.field, first: view.first as usize + i, count: Some(1) };
                self.events.push((Event::Write(access), certain));
            }
            Place::Element(view, Index::Computed(_)) => self.write(*view, certain),
            Place::Item(..) => self.through_values(None),
            _ => {}
        }
    }

    fn write(&mut self, view: View, certain: bool) {
        let access = Access { field: view.field, first: view.first as usize, count: view.count() };
        self.events.push((Event::Write(access), certain));
    }

    /// A store into an array that is a value: into this one, or into whichever became one.
    fn through_values(&mut self, view: Option<View>) {
        for shown in self.tree.views.iter().filter(|s| s.assignable && view.is_none_or(|v| v == s.view)) {
            self.write(shown.view, false);
        }
    }
}

/// Whether what stands behind a step may not be reached.
fn jumps(step: &Step) -> bool {
    match step {
        Step::Return(_) | Step::Break | Step::Continue => true,
        Step::If(_, then, otherwise) => then.iter().chain(otherwise).any(jumps),
        Step::Loop(l) => l.body.iter().chain(&l.update).any(jumps),
        // What returns in it ends only itself.
        Step::Effect(_) | Step::Declare(..) | Step::Reserve(_) | Step::Renew(_) | Step::Inline(..) => false,
    }
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
            // Nothing is certain of these.
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
        let mut of = |source: &str| {
            let program = Compiler::new(&Mock, &mut globals).statements(source).program.unwrap();
            program.own_writes().iter().map(|a| (a.field.0, a.first, a.count)).collect::<Vec<_>>()
        };
        assert_eq!(of("mj_setConst()"), []);
        assert_eq!(of("data.qvel[2] = 1; mj_setConst"), [(2, 2, Some(1))]);
        assert_eq!(of("if (data.time > 0) data.qvel[2] = 1"), [(2, 2, Some(1))]);
        assert_eq!(of("ctx.kept = data.qvel.slice()"), []);
        assert_eq!(
            of("const q = data.qvel.slice(); data.qvel.set(q)").first().map(|a| (a.0, a.1)),
            Some((2, 0))
        );
    }
}
