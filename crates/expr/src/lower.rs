//! Typed tree to code. Each node is computed in the form that its surroundings ask for: as a number, as a value
//! of any type, or only for whether it is true. A numeric expression so never leaves the number registers.

mod call;
mod place;
mod step;

use std::collections::BTreeMap;

use crate::Span;
use crate::ir::{Entry, Index, Ir, Item, Kind, LocalId, Tree, Unit};
use crate::operators::{BinaryOp, LogicalOp};
use crate::schema::Type;
use crate::value::{Value, View};
use crate::vm::{Code, CodeUnit, Num, Op, Slot, Val};

/// The code of a program.
pub(crate) fn program(tree: &Tree) -> Code {
    let mut code = Code { views: tree.views.clone(), ..Code::default() };
    for unit in &tree.units {
        let done = Lowering::new(tree, &mut code).unit(unit);
        code.units.push(done);
    }
    code
}

/// Where a local lives.
#[derive(Clone, Copy)]
enum Home {
    Number(Num),
    Value(Val),
    /// A register that holds the shared place.
    Cell(Val),
}

/// A jump whose target is not known yet.
struct Pending(usize);

/// Jumps out of a loop.
#[derive(Default)]
struct Exits {
    breaks: Vec<Pending>,
    continues: Vec<Pending>,
}

/// Statements in the place of a call.
struct Inline {
    result: LocalId,
    exits: Vec<Pending>,
}

struct Lowering<'t> {
    tree: &'t Tree,
    code: &'t mut Code,
    unit: CodeUnit,
    /// Constants by their bits.
    constants: BTreeMap<u64, Num>,
    homes: BTreeMap<LocalId, Home>,
    loops: Vec<Exits>,
    inlines: Vec<Inline>,
    /// Jumps out of chains with `?.`.
    chains: Vec<Vec<Pending>>,
    /// Where all of it seems to stand.
    site: Option<Span>,
}

/// How a local of a type is handed over.
fn slot(tree: &Tree, local: LocalId) -> Slot {
    match tree.locals.get(local as usize) {
        Some(local) if local.shared => Slot::Value,
        Some(local) => Slot::of(local.ty),
        None => Slot::Value,
    }
}

impl<'t> Lowering<'t> {
    fn new(tree: &'t Tree, code: &'t mut Code) -> Lowering<'t> {
        // The first registers hold the result.
        let unit = CodeUnit { number_count: 1, value_count: 1, ..CodeUnit::default() };
        Lowering {
            tree,
            code,
            unit,
            constants: BTreeMap::new(),
            homes: BTreeMap::new(),
            loops: Vec::new(),
            inlines: Vec::new(),
            chains: Vec::new(),
            site: None,
        }
    }

    fn unit(mut self, unit: &Unit) -> CodeUnit {
        self.unit.result = unit.result.map_or(Slot::Value, Slot::of);
        self.unit.params = unit.params.iter().map(|p| slot(self.tree, *p)).collect();
        self.unit.captures = unit.captures.iter().map(|c| slot(self.tree, *c)).collect();
        for &param in &unit.params {
            let home = self.new_home(param, slot(self.tree, param));
            if let (Home::Value(place), true) = (home, self.is_shared(param)) {
                self.emit(Op::NewCell(place, place), Span::default());
                self.homes.insert(param, Home::Cell(place));
            }
        }
        for &capture in &unit.captures {
            let home = self.new_home(capture, slot(self.tree, capture));
            if let (Home::Value(place), true) = (home, self.is_shared(capture)) {
                self.homes.insert(capture, Home::Cell(place));
            }
        }
        self.steps(&unit.body);
        self.leave(None, Span::default());
        self.unit
    }

    fn is_shared(&self, local: LocalId) -> bool {
        self.tree.locals.get(local as usize).is_some_and(|l| l.shared)
    }

    /// A new register for a local.
    fn new_home(&mut self, local: LocalId, slot: Slot) -> Home {
        let home = match slot {
            Slot::Value => Home::Value(self.new_value()),
            Slot::Number | Slot::Boolean => Home::Number(self.new_number()),
        };
        self.homes.insert(local, home);
        home
    }

    fn emit(&mut self, op: Op, span: Span) {
        self.unit.ops.push(op);
        self.unit.spans.push(self.site.unwrap_or(span));
    }

    fn new_number(&mut self) -> Num {
        self.new_numbers(1)
    }

    /// Registers in a row, of which the first is returned.
    fn new_numbers(&mut self, count: usize) -> Num {
        let first = self.unit.number_count;
        self.unit.number_count += count as u32;
        Num(first)
    }

    fn new_value(&mut self) -> Val {
        self.new_values(1)
    }

    fn new_values(&mut self, count: usize) -> Val {
        let first = self.unit.value_count;
        self.unit.value_count += count as u32;
        Val(first)
    }

    /// A jump to a place that [`Self::land`] gives later.
    fn jump(&mut self, op: Op, span: Span) -> Pending {
        self.emit(op, span);
        Pending(self.unit.ops.len() - 1)
    }

    fn land(&mut self, jump: Pending) {
        let here = self.unit.ops.len() as u32;
        if let Some(Op::Jump(to) | Op::JumpIf(_, _, to) | Op::JumpIfNothing(_, _, to)) =
            self.unit.ops.get_mut(jump.0)
        {
            *to = here;
        }
    }

    fn constant(&mut self, x: f64) -> Num {
        if let Some(&register) = self.constants.get(&x.to_bits()) {
            return register;
        }
        let register = self.new_number();
        self.constants.insert(x.to_bits(), register);
        self.unit.numbers.push((register, x));
        register
    }

    fn constant_value(&mut self, value: &Value) -> Val {
        let known = self.unit.values.iter().find(|(_, v)| match (v, value) {
            (Value::Number(a), Value::Number(b)) => a.to_bits() == b.to_bits(),
            (a, b) => a == b,
        });
        if let Some((register, _)) = known {
            return *register;
        }
        let register = self.new_value();
        self.unit.values.push((register, value.clone()));
        register
    }

    fn text(&mut self, text: &std::sync::Arc<str>) -> u32 {
        match self.code.texts.iter().position(|t| t == text) {
            Some(at) => at as u32,
            None => {
                self.code.texts.push(text.clone());
                (self.code.texts.len() - 1) as u32
            }
        }
    }

    /// The register of the node as a number (JavaScript's `Number(x)`).
    fn number(&mut self, ir: &Ir) -> Num {
        let span = ir.span;
        match &ir.kind {
            Kind::Constant(value) if value.is_primitive() => self.constant(value.to_number()),
            Kind::Load(view, index) => self.load(*view, index, span),
            Kind::Length(view) => self.unary(span, |dst| Op::Length(dst, *view)),
            Kind::Aggregate(slot) => self.unary(span, |dst| Op::Aggregate(dst, *slot)),
            Kind::Global(slot) => self.unary(span, |dst| Op::GlobalNumber(dst, *slot)),
            Kind::Local(local) => match self.home(*local) {
                Home::Number(register) => register,
                Home::Value(register) => self.unary(span, |dst| Op::ToNumber(dst, register)),
                Home::Cell(_) => self.number_of_value(ir),
            },
            Kind::Not(a) => {
                let a = self.truth(a);
                self.unary(span, |dst| Op::Not(dst, a))
            }
            Kind::Negate(a) => {
                let a = self.number(a);
                self.unary(span, |dst| Op::Negate(dst, a))
            }
            Kind::BitNot(a) => {
                let a = self.number(a);
                self.unary(span, |dst| Op::BitNot(dst, a))
            }
            Kind::ToNumber(a) => self.number(a),
            Kind::Binary(op, a, b) => self.binary(*op, a, b, ir),
            Kind::Logical(LogicalOp::Nullish, a, _) if matches!(a.ty, Type::Number | Type::Boolean) => {
                self.number(a)
            }
            Kind::Logical(LogicalOp::Nullish, ..) => self.number_of_value(ir),
            Kind::Logical(op, a, b) => self.logical(*op, a, b, span),
            Kind::Choice(test, a, b) => {
                let dst = self.new_number();
                self.choice(test, span, |s| s.number_to(a, dst), |s| s.number_to(b, dst));
                dst
            }
            Kind::Math(function, args) => {
                let (function, count) = (*function, args.len() as u32);
                let first = self.row(args);
                self.unary(span, |dst| Op::Math(dst, function, first, count))
            }
            Kind::MathOver(function, list) => {
                let (function, list) = (*function, self.value(list));
                self.unary(span, |dst| Op::MathOver(dst, function, list))
            }
            Kind::Invoke(unit, args) if self.result_slot(*unit) != Slot::Value => {
                self.invoke(*unit, args, span);
                self.unary(span, Op::TakeNumber)
            }
            Kind::Store(place, op, value) if self.is_plain_store(place, *op, value) => {
                self.store(place, *op, value, span)
            }
            Kind::Update(place, step, gives) if self.is_plain_place(place) => {
                self.update(place, *step, *gives, span)
            }
            Kind::Block(steps, value) => {
                self.steps(steps);
                self.number(value)
            }
            Kind::Pick(picks, name) if picks.scalar => {
                let name = self.value(name);
                let table = self.table(picks);
                self.unary(span, |dst| Op::PickNumber(dst, table, name))
            }
            _ => self.number_of_value(ir),
        }
    }

    fn number_of_value(&mut self, ir: &Ir) -> Num {
        let value = self.value(ir);
        self.unary(ir.span, |dst| Op::ToNumber(dst, value))
    }

    fn number_to(&mut self, ir: &Ir, dst: Num) {
        let src = self.number(ir);
        self.emit(Op::Move(dst, src), ir.span);
    }

    /// The register of the node as a value of its own type.
    fn value(&mut self, ir: &Ir) -> Val {
        let span = ir.span;
        match (&ir.kind, ir.ty) {
            (Kind::Constant(value), _) => self.constant_value(value),
            (Kind::Fill(..) | Kind::StoreAll(..), _) => {
                self.effect(ir);
                self.constant_value(&Value::Undefined)
            }
            (Kind::Call(function, args), _) => {
                let first = self.value_row(args);
                let (function, count) = (*function, args.len() as u32);
                self.unary_value(span, |dst| Op::CallHost(dst, function, first, count))
            }
            (Kind::Input, _) => self.unary_value(span, Op::Input),
            (Kind::Local(local), _) => self.local_value(*local, span),
            (Kind::Store(place, op, value), _) if !self.is_plain_store(place, *op, value) => {
                self.store_value(place, *op, value, span)
            }
            (Kind::StoreIf(op, place, value), _) => self.store_if(*op, place, value, span),
            (Kind::Update(place, step, gives), _) if !self.is_plain_place(place) => {
                self.update_value(place, *step, *gives, span)
            }
            (Kind::Block(steps, value), _) => {
                self.steps(steps);
                self.value(value)
            }
            (Kind::Invoke(unit, args), _) => {
                self.invoke(*unit, args, span);
                match self.result_slot(*unit) {
                    Slot::Value => self.unary_value(span, Op::TakeValue),
                    slot => {
                        let number = self.unary(span, Op::TakeNumber);
                        self.boxed(number, slot, span)
                    }
                }
            }
            (Kind::Pick(picks, name), _) if !picks.scalar => {
                let name = self.value(name);
                let table = self.table(picks);
                self.unary_value(span, |dst| Op::Pick(dst, table, name))
            }
            (Kind::InvokeValue(callee, args), _) => self.invoke_value(callee, args, span),
            (Kind::Method(name, receiver, args), _) => self.method(*name, receiver, args, span),
            (Kind::Native(function, args), _) => self.native(*function, args, span),
            (Kind::Closure(unit), _) => self.closure(*unit, span),
            (Kind::List(items), _) => self.list(items, span),
            (Kind::Record(entries), _) => self.record(entries, span),
            (Kind::Element(object, index), _) => {
                let object = self.value(object);
                if index.ty == Type::Number {
                    let index = self.number(index);
                    return self.unary_value(span, |dst| Op::ElementAt(dst, object, index));
                }
                let index = self.value(index);
                self.unary_value(span, |dst| Op::Element(dst, object, index))
            }
            (Kind::Member(object, name), _) => {
                let object = self.value(object);
                let name = self.text(name);
                self.unary_value(span, |dst| Op::Member(dst, object, name))
            }
            (Kind::ToText(a), _) => {
                let a = self.value(a);
                self.unary_value(span, |dst| Op::ToText(dst, a))
            }
            (Kind::TypeOf(a), _) => {
                let a = self.value(a);
                self.unary_value(span, |dst| Op::TypeOf(dst, a))
            }
            (Kind::GlobalNamed(name), _) => {
                let name = self.value(name);
                self.unary_value(span, |dst| Op::GlobalNamed(dst, name))
            }
            (Kind::Chain(inner), _) => self.chain(inner, span),
            // A number register cannot tell `undefined` from NaN.
            (Kind::Logical(op @ LogicalOp::Nullish, a, b), _) => self.logical_value(*op, a, b, span),
            (Kind::Present(object), _) => {
                let value = self.value(object);
                let exit = self.jump(Op::JumpIfNothing(true, value, 0), span);
                match self.chains.last_mut() {
                    Some(exits) => exits.push(exit),
                    None => self.land(exit), // not reached: a chain is around it
                }
                value
            }
            (_, Type::Number) => {
                let src = self.number(ir);
                self.boxed(src, Slot::Number, span)
            }
            (_, Type::Boolean) => {
                let src = self.number(ir);
                self.boxed(src, Slot::Boolean, span)
            }
            (Kind::Load(view, index), _) => {
                let index = self.index(index);
                self.unary_value(span, |dst| Op::LoadValueAt(dst, *view, index))
            }
            (Kind::Global(slot), _) => self.unary_value(span, |dst| Op::Global(dst, *slot)),
            (Kind::Binary(_, a, b), _) => {
                let (a, b) = self.two_values(a, b);
                self.unary_value(span, |dst| Op::Plus(dst, a, b))
            }
            (Kind::Logical(op, a, b), _) => self.logical_value(*op, a, b, span),
            (Kind::Choice(test, a, b), _) => {
                let dst = self.new_value();
                self.choice(test, span, |s| s.value_to(a, dst), |s| s.value_to(b, dst));
                dst
            }
            // All other kinds give numbers or booleans.
            _ => {
                let src = self.number(ir);
                self.boxed(src, Slot::Number, span)
            }
        }
    }

    fn logical_value(&mut self, op: LogicalOp, a: &Ir, b: &Ir, span: Span) -> Val {
        let dst = self.new_value();
        self.value_to(a, dst);
        let end = self.keeps(op, dst, span);
        self.value_to(b, dst);
        self.land(end);
        dst
    }

    /// A jump that is taken when `value op …` is the value.
    fn keeps(&mut self, op: LogicalOp, value: Val, span: Span) -> Pending {
        if op == LogicalOp::Nullish {
            return self.jump(Op::JumpIfNothing(false, value, 0), span);
        }
        let test = self.unary(span, |dst| Op::Truthy(dst, value));
        self.jump(Op::JumpIf(op == LogicalOp::Or, test, 0), span)
    }

    fn boxed(&mut self, src: Num, slot: Slot, span: Span) -> Val {
        match slot {
            Slot::Boolean => self.unary_value(span, |dst| Op::BoxBoolean(dst, src)),
            _ => self.unary_value(span, |dst| Op::BoxNumber(dst, src)),
        }
    }

    fn value_to(&mut self, ir: &Ir, dst: Val) {
        let src = self.value(ir);
        self.emit(Op::MoveValue(dst, src), ir.span);
    }

    /// A number that is true when the node is.
    fn truth(&mut self, ir: &Ir) -> Num {
        match ir.known() {
            Some(value) => self.constant(f64::from(u8::from(value.truthy()))),
            None if ir.is_plain() && !matches!(ir.kind, Kind::Logical(LogicalOp::Nullish, ..)) => {
                self.number(ir)
            }
            None => {
                let value = self.value(ir);
                self.unary(ir.span, |dst| Op::Truthy(dst, value))
            }
        }
    }

    fn unary(&mut self, span: Span, op: impl FnOnce(Num) -> Op) -> Num {
        let dst = self.new_number();
        self.emit(op(dst), span);
        dst
    }

    fn unary_value(&mut self, span: Span, op: impl FnOnce(Val) -> Op) -> Val {
        let dst = self.new_value();
        self.emit(op(dst), span);
        dst
    }

    /// The number of a node that is read only after others were computed, which may store to where it lives.
    fn held(&mut self, ir: &Ir, then: &[&Ir]) -> Num {
        let register = self.number(ir);
        if matches!(ir.kind, Kind::Local(_)) && then.iter().any(|x| stores(x)) {
            return self.unary(ir.span, |dst| Op::Move(dst, register));
        }
        register
    }

    fn held_value(&mut self, ir: &Ir, then: &[&Ir]) -> Val {
        let register = self.value(ir);
        if matches!(ir.kind, Kind::Local(_)) && then.iter().any(|x| stores(x)) {
            return self.unary_value(ir.span, |dst| Op::MoveValue(dst, register));
        }
        register
    }

    /// Values of the nodes as numbers, in registers in a row.
    fn row(&mut self, items: &[Ir]) -> Num {
        // A single register is a row already.
        if let [item] = items {
            return self.number(item);
        }
        let mut sources = Vec::with_capacity(items.len());
        for (i, item) in items.iter().enumerate() {
            let rest: Vec<&Ir> = items.iter().skip(i + 1).collect();
            sources.push(self.held(item, &rest));
        }
        let first = self.new_numbers(items.len());
        for (i, (src, item)) in sources.into_iter().zip(items).enumerate() {
            self.emit(Op::Move(Num(first.0 + i as u32), src), item.span);
        }
        first
    }

    fn value_row<'i>(&mut self, items: impl IntoIterator<Item = &'i Ir>) -> Val {
        let items: Vec<&Ir> = items.into_iter().collect();
        let mut sources = Vec::with_capacity(items.len());
        for (i, item) in items.iter().enumerate() {
            sources.push(self.held_value(item, items.get(i + 1..).unwrap_or(&[])));
        }
        let first = self.new_values(items.len());
        for (i, (src, item)) in sources.into_iter().zip(&items).enumerate() {
            self.emit(Op::MoveValue(Val(first.0 + i as u32), src), item.span);
        }
        first
    }

    fn two_values(&mut self, a: &Ir, b: &Ir) -> (Val, Val) {
        let a = self.held_value(a, &[b]);
        (a, self.value(b))
    }

    fn load(&mut self, view: View, index: &Index, span: Span) -> Num {
        match (index, view.count()) {
            (Index::At(i), Some(_)) => {
                let at = view.first.saturating_add(u32::try_from(*i).unwrap_or(u32::MAX));
                self.unary(span, |dst| Op::Load(dst, view.field, at))
            }
            _ => {
                let index = self.index(index);
                self.unary(span, |dst| Op::LoadAt(dst, view, index))
            }
        }
    }

    fn index(&mut self, index: &Index) -> Num {
        match index {
            Index::At(i) => self.constant(*i as f64),
            Index::Computed(ir) if ir.ty == Type::Number => self.number(ir),
            Index::Computed(ir) => {
                let value = self.value(ir);
                self.unary(ir.span, |dst| Op::ToIndex(dst, value))
            }
        }
    }

    fn binary(&mut self, op: BinaryOp, a: &Ir, b: &Ir, ir: &Ir) -> Num {
        let span = ir.span;
        let plain = match op {
            BinaryOp::Add => ir.ty == Type::Number,
            // Equality of one type needs no conversion; order does, unless both may be strings.
            _ if op.power() == 8 => a.ty == b.ty && matches!(a.ty, Type::Number | Type::Boolean),
            _ if op.is_comparison() => a.is_plain() || b.is_plain(),
            _ => true,
        };
        if plain {
            let a = self.held(a, &[b]);
            let b = self.number(b);
            return self.unary(span, |dst| arithmetic(dst, op, a, b));
        }
        let (a, b) = self.two_values(a, b);
        if op == BinaryOp::Add {
            let sum = self.unary_value(span, |dst| Op::Plus(dst, a, b));
            return self.unary(span, |dst| Op::ToNumber(dst, sum));
        }
        self.unary(span, |dst| Op::Compare(dst, op, a, b))
    }

    /// `a && b` or `a || b` as a number.
    fn logical(&mut self, op: LogicalOp, a: &Ir, b: &Ir, span: Span) -> Num {
        let dst = self.new_number();
        let test = if a.is_plain() {
            self.number_to(a, dst);
            dst
        } else {
            // The text "0" is true, although it is 0 as a number.
            let value = self.value(a);
            self.emit(Op::ToNumber(dst, value), a.span);
            self.unary(a.span, |test| Op::Truthy(test, value))
        };
        let end = self.jump(Op::JumpIf(op == LogicalOp::Or, test, 0), span);
        self.number_to(b, dst);
        self.land(end);
        dst
    }

    fn choice(
        &mut self,
        test: &Ir,
        span: Span,
        then: impl FnOnce(&mut Self),
        otherwise: impl FnOnce(&mut Self),
    ) {
        let test = self.truth(test);
        let skip = self.jump(Op::JumpIf(false, test, 0), span);
        then(self);
        let end = self.jump(Op::Jump(0), span);
        self.land(skip);
        otherwise(self);
        self.land(end);
    }

    fn chain(&mut self, inner: &Ir, span: Span) -> Val {
        let dst = self.new_value();
        self.chains.push(Vec::new());
        self.value_to(inner, dst);
        let exits = self.chains.pop().unwrap_or_default();
        let end = self.jump(Op::Jump(0), span);
        exits.into_iter().for_each(|exit| self.land(exit));
        let nothing = self.constant_value(&Value::Undefined);
        self.emit(Op::MoveValue(dst, nothing), span);
        self.land(end);
        dst
    }

    fn list(&mut self, items: &[Item], span: Span) -> Val {
        if items.iter().all(|i| !i.spread) {
            let first = self.value_row(items.iter().map(|i| &i.value));
            let count = items.len() as u32;
            return self.unary_value(span, |dst| Op::List(dst, first, count));
        }
        let none = self.new_values(0);
        let list = self.unary_value(span, |dst| Op::List(dst, none, 0));
        for item in items {
            let value = self.value(&item.value);
            self.emit(Op::Append(list, value, item.spread), item.value.span);
        }
        list
    }

    fn record(&mut self, entries: &[Entry], span: Span) -> Val {
        let record = self.unary_value(span, Op::NewRecord);
        for entry in entries {
            match entry {
                Entry::Named(key, value) => {
                    let key = self.constant_value(&Value::String(key.clone()));
                    let src = self.value(value);
                    self.emit(Op::Put(record, key, src), value.span);
                }
                Entry::Computed(key, value) => {
                    let (key, src) = self.two_values(key, value);
                    self.emit(Op::Put(record, key, src), value.span);
                }
                Entry::Spread(value) => {
                    let src = self.value(value);
                    self.emit(Op::PutAll(record, src), value.span);
                }
            }
        }
        record
    }

    fn table(&mut self, picks: &std::sync::Arc<crate::ir::Picks>) -> u32 {
        self.code.picks.push(picks.clone());
        (self.code.picks.len() - 1) as u32
    }
}

fn arithmetic(dst: Num, op: BinaryOp, a: Num, b: Num) -> Op {
    match op {
        BinaryOp::Add => Op::Add(dst, a, b),
        BinaryOp::Subtract => Op::Subtract(dst, a, b),
        BinaryOp::Multiply => Op::Multiply(dst, a, b),
        BinaryOp::Divide => Op::Divide(dst, a, b),
        BinaryOp::Less => Op::Less(dst, a, b),
        _ => Op::Binary(dst, op, a, b),
    }
}

/// Whether computing a node may store to a local.
fn stores(ir: &Ir) -> bool {
    let any = |items: &[Item]| items.iter().any(|i| stores(&i.value));
    match &ir.kind {
        Kind::Store(..)
        | Kind::StoreIf(..)
        | Kind::Update(..)
        | Kind::Invoke(..)
        | Kind::InvokeValue(..)
        | Kind::Block(..) => true,
        Kind::Not(a)
        | Kind::BitNot(a)
        | Kind::Negate(a)
        | Kind::ToNumber(a)
        | Kind::ToText(a)
        | Kind::TypeOf(a) => stores(a),
        Kind::Chain(a) | Kind::Present(a) | Kind::Pick(_, a) | Kind::GlobalNamed(a) | Kind::Member(a, _) => {
            stores(a)
        }
        Kind::MathOver(_, a) => stores(a),
        Kind::Load(_, Index::Computed(a)) => stores(a),
        Kind::Binary(_, a, b) | Kind::Logical(_, a, b) | Kind::Element(a, b) => stores(a) || stores(b),
        Kind::Choice(a, b, c) => stores(a) || stores(b) || stores(c),
        Kind::Math(_, args) | Kind::Call(_, args) => args.iter().any(stores),
        Kind::List(items) | Kind::Native(_, items) => any(items),
        Kind::Method(_, object, args) => stores(object) || any(args),
        Kind::Record(entries) => entries.iter().any(|e| match e {
            Entry::Named(_, v) | Entry::Spread(v) => stores(v),
            Entry::Computed(k, v) => stores(k) || stores(v),
        }),
        _ => false,
    }
}
