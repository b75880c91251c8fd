//! Functions of a text: bound when they are first called, with the types that they are called with.

use super::facts::Key;
use super::scope::{Known, Meaning};
use super::{Attempt, Binder, Reported, Thing};
use crate::ast::{Body, Element, Expr, ExprKind, Function, Name, Pattern};
use crate::ir::{Ir, Item, Kind, LocalId, Step, Unit, UnitId};
use crate::natives::Row;
use crate::operators::BinaryOp;
use crate::rules;
use crate::schema::Type;
use crate::{Finding, Span};

/// Functions of one text.
const MAX_FUNCTIONS: usize = 200;

impl<'a> Binder<'a> {
    /// A function that the text gives at this place.
    pub(super) fn new_function(&mut self, function: &'a Function) -> Thing {
        self.known.push(Known {
            function,
            key: self.key(function.span.start),
            reach: self.variables.len(),
            around: self.unit,
            unit: None,
            site: self.site,
        });
        Thing::Closure(self.known.len() - 1)
    }

    /// The place of a parameter, by which its type is kept.
    fn param_key(&self, param: &Element) -> Key {
        self.key(param.target.span().start)
    }

    /// The function as code, called with these types.
    fn unit_of(&mut self, at: usize, types: &[Type]) -> Attempt<UnitId> {
        let Some(known) = self.known.get(at).cloned() else { return Err(Reported) };
        for (i, param) in known.function.params.iter().enumerate() {
            let key = (known.key.0, param.target.span().start);
            self.facts.see(key, types.get(i).copied().unwrap_or(Type::Undefined));
        }
        match known.unit {
            Some(unit) => Ok(unit),
            None => self.bind_function(at, &known),
        }
    }

    fn bind_function(&mut self, at: usize, known: &Known<'a>) -> Attempt<UnitId> {
        let span = known.function.span;
        if self.tree.units.len() > MAX_FUNCTIONS {
            return self.refuse(
                Finding::error(
                    rules::TOO_LONG,
                    span,
                    format!("more than {MAX_FUNCTIONS} functions in one text"),
                )
                .help("split the text"),
            );
        }
        let unit = self.tree.units.len() as UnitId;
        self.tree.units.push(Unit::default());
        if let Some(known) = self.known.get_mut(at) {
            known.unit = Some(unit);
        }
        // The body sees the names around its definition, not those around the call.
        let hidden = self.variables.split_off(known.reach.min(self.variables.len()));
        let first = self.known.len();
        let outer = (self.unit, self.loops, self.guards, self.site);
        (self.unit, self.loops, self.guards, self.site) = (unit, 0, 1, known.site);
        let (params, body) = self.body(known.function);
        self.leave(known.reach, first);
        (self.unit, self.loops, self.guards, self.site) = outer;
        self.variables.extend(hidden);
        let result = self.facts.ty(known.key);
        if let Some(unit) = self.tree.units.get_mut(unit as usize) {
            unit.params = params;
            unit.body = body;
            unit.result = Some(result);
        }
        Ok(unit)
    }

    fn body(&mut self, function: &'a Function) -> (Vec<LocalId>, Vec<Step>) {
        let mut steps = Vec::new();
        let mut places = Vec::new();
        for param in &function.params {
            let place = match &param.target {
                Pattern::Name(name) => self.declare_variable(name, false),
                other => {
                    let key = self.key(other.span().start);
                    self.new_local(key)
                }
            };
            places.push(place);
        }
        let first = self.variables.len()
            - function.params.iter().filter(|p| matches!(p.target, Pattern::Name(_))).count();
        for param in &function.params {
            if !matches!(param.target, Pattern::Name(_)) {
                self.hoist_pattern(&param.target, false, first, &mut steps);
            }
        }
        for (param, place) in function.params.iter().zip(&places) {
            self.param(param, *place, &mut steps);
        }
        let key = self.key(function.span.start);
        match &function.body {
            Body::Value(expr) => {
                let ir = self.body_value(expr);
                if let Ok(ir) = ir {
                    self.facts.see(key, ir.ty);
                    steps.push(Step::Return(ir));
                }
            }
            Body::Block(statements) => {
                self.returns.push((key, self.unit));
                steps.extend(self.block(statements));
                self.returns.pop();
                if !ends(&steps) {
                    self.facts.see(key, Type::Undefined);
                }
            }
        }
        (places, steps)
    }

    /// What an arrow without braces gives: a value, or what a statement like `x = 1` leaves.
    fn body_value(&mut self, expr: &'a Expr) -> Attempt<Ir> {
        match &expr.kind {
            ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Update { .. } => {
                self.changing(expr)
            }
            ExprKind::Call { .. } => {
                let thing = self.thing(expr)?;
                match thing {
                    // A function without a result gives `undefined`.
                    Thing::Value(ir) if ir.ty == Type::Void => Ok(Ir { ty: Type::Undefined, ..ir }),
                    other => self.value_of(other, expr.span),
                }
            }
            _ => self.value(expr),
        }
    }

    /// A parameter gets its default, and is taken apart.
    fn param(&mut self, param: &'a Element, place: LocalId, steps: &mut Vec<Step>) {
        let span = param.target.span();
        let key = self.param_key(param);
        let read = |ty| Ir::new(Kind::Local(place), ty, span);
        if let Some(default) = &param.default
            && let Ok(value) = self.value(default)
        {
            self.facts.see(key, value.ty);
            let ty = self.facts.ty(key);
            let test = Ir::binary(BinaryOp::StrictEqual, read(ty), Ir::undefined(span), span);
            let store = Kind::Store(Box::new(crate::ir::Place::Local(place)), None, Box::new(value));
            steps.push(Step::If(test, vec![Step::Effect(Ir::new(store, ty, span))], Vec::new()));
        }
        let ty = self.facts.ty(key);
        match &param.target {
            Pattern::Name(name) => self.give(name, Meaning::Slot),
            pattern => self.take_apart(pattern, read(ty), steps),
        }
    }

    /// A function that nothing has called yet, as if it were called with anything.
    pub(super) fn bind_with_anything(&mut self, at: usize) {
        let n = self.known.get(at).map_or(0, |k| k.function.params.len());
        let _ = self.unit_of(at, &vec![Type::Any; n]);
    }

    /// A function as a value: it may be called from anywhere, with anything.
    pub(super) fn closure_value(&mut self, at: usize, span: Span) -> Attempt<Ir> {
        let n = self.known.get(at).map_or(0, |k| k.function.params.len());
        let unit = self.unit_of(at, &vec![Type::Any; n])?;
        self.capture_for(at);
        Ok(Ir::new(Kind::Closure(unit), Type::Function, span))
    }

    /// What a called function uses, its caller must hand in.
    fn capture_for(&mut self, at: usize) {
        let Some(known) = self.known.get(at) else { return };
        let key = known.key;
        for variable in self.facts.uses(key) {
            let found = self.variables.iter().rev().find(|v| v.key == variable).cloned();
            if let Some(found) = found {
                self.capture(&found);
            }
        }
    }

    /// A call of a function that is known by its place.
    pub(super) fn call_known(&mut self, at: usize, args: &'a [Expr], span: Span) -> Attempt<Ir> {
        if args.iter().any(|a| matches!(a.kind, ExprKind::Spread(_))) {
            let callee = self.closure_value(at, span)?;
            let items = self.items(args)?;
            return Ok(self.call_value(callee, items, span));
        }
        let wanted = self.known.get(at).map_or(0, |k| k.function.params.len());
        let needed = self
            .known
            .get(at)
            .map_or(0, |k| k.function.params.iter().rposition(|p| p.default.is_none()).map_or(0, |i| i + 1));
        let mut values = Vec::new();
        let mut extra = Vec::new();
        let mut failed = false;
        for (i, arg) in args.iter().enumerate() {
            // What a function has no parameter for is not even looked at, if that can have no effect.
            if i >= wanted && matches!(arg.kind, ExprKind::Name(_) | ExprKind::Number(_)) {
                continue;
            }
            match self.value(arg) {
                Ok(ir) if i < wanted => values.push(ir),
                Ok(ir) => extra.push(Step::Effect(ir)),
                Err(Reported) => failed = true,
            }
        }
        if self.site.is_none() && args.len() < needed {
            let name = self.text(Span::new(span.start, args.first().map_or(span.end, |a| a.span.start)));
            let name = name.split('(').next().unwrap_or("").trim();
            self.report(
                Finding::warning(
                    rules::ARGUMENT_COUNT,
                    span,
                    format!("`{name}` gets {} of {needed} arguments", args.len()),
                )
                .why("the missing ones are `undefined`, and a computation with them gives NaN")
                .help("write all arguments, or give the parameters a value, as `(x, k = 1) => …`"),
            );
        }
        if failed {
            return Err(Reported);
        }
        let types: Vec<Type> = values.iter().map(|v| v.ty).collect();
        let unit = self.unit_of(at, &types)?;
        self.capture_for(at);
        self.effects.can_throw = true;
        let key = self.known.get(at).map_or((0, 0), |k| k.key);
        let call = Ir::new(Kind::Invoke(unit, values), self.facts.ty(key), span);
        if extra.is_empty() {
            return Ok(call);
        }
        let ty = call.ty;
        Ok(Ir::new(Kind::Block(extra, Box::new(call)), ty, span))
    }

    /// A call of a function that is known only while running.
    pub(super) fn call_value(&mut self, callee: Ir, args: Vec<Item>, span: Span) -> Ir {
        self.effects.can_throw = true;
        self.effects.calls_values = true;
        Ir::new(Kind::InvokeValue(Box::new(callee), args), Type::Any, span)
    }

    /// A method that is written in the language, as if its text stood here.
    pub(super) fn call_written(
        &mut self,
        function: &'a Function,
        row: &'static Row,
        first: Thing,
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<Ir> {
        let mut things = vec![Ok(first)];
        // The function stands first among the arguments.
        things.extend(args.iter().enumerate().map(|(i, arg)| {
            let thing = self.argument_thing(arg)?;
            let calls = match &thing {
                Thing::Value(ir) => matches!(ir.ty, Type::Function | Type::Any | Type::Never),
                _ => true,
            };
            if i == 0 && !calls {
                let report = self.needs_function(row, arg.span);
                return self.refuse(report);
            }
            Ok(thing)
        }));
        let things = things.into_iter().collect::<Attempt<Vec<Thing>>>()?;
        let reach = self.variables.len();
        let known = self.known.len();
        let outer = (self.site.replace(span), self.guards);
        self.guards += 1;
        let mut steps = Vec::new();
        for (param, thing) in function.params.iter().zip(things) {
            let Pattern::Name(name) = &param.target else { continue };
            self.declare_variable(name, false);
            self.give_thing(name, thing, &mut steps);
        }
        let key = self.key(function.span.start);
        let Body::Block(statements) = &function.body else { return Err(Reported) };
        self.returns.push((key, self.unit));
        let loops = std::mem::take(&mut self.loops);
        let body = self.block(statements);
        self.loops = loops;
        self.returns.pop();
        if !ends(&body) {
            self.facts.see(key, Type::Undefined);
        }
        let result = self.new_local(key);
        let ty = self.facts.ty(key);
        self.leave(reach, known);
        (self.site, self.guards) = outer;
        steps.push(Step::Inline(result, body, span));
        let value = Ir::new(Kind::Local(result), ty, span);
        Ok(Ir::new(Kind::Block(steps, Box::new(value)), ty, span))
    }

    /// An argument of such a method: a function stays known.
    fn argument_thing(&mut self, arg: &'a Expr) -> Attempt<Thing> {
        match self.thing(arg)? {
            closure @ Thing::Closure(_) => Ok(closure),
            function @ (Thing::MathFunction(_) | Thing::Native(_)) => Ok(function),
            // `Number`, which is a function and holds some.
            Thing::Namespace(name) => match crate::natives::free(name) {
                Some(function) => Ok(Thing::Native(function)),
                None => self.value_of(Thing::Namespace(name), arg.span).map(Thing::Value),
            },
            other => self.value_of(other, arg.span).map(Thing::Value),
        }
    }

    /// A parameter of a written method: what needs no place of its own is only another word.
    fn give_thing(&mut self, name: &Name, thing: Thing, steps: &mut Vec<Step>) {
        match thing {
            Thing::Value(ir) => self.give_value(name, ir, steps),
            other => self.give(name, Meaning::Alias(other)),
        }
    }
}

/// Whether statements never come to their end: all ways through them return.
pub(super) fn ends(steps: &[Step]) -> bool {
    steps.iter().any(|step| match step {
        Step::Return(_) => true,
        Step::If(_, then, otherwise) => ends(then) && ends(otherwise),
        _ => false,
    })
}
