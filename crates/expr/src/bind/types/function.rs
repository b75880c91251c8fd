//! Functions of a text. Each is bound when it is first called, for the argument types of its calls.

use super::binder::{Binder, Entity, KnownFunction, VariableMeaning};
use super::facts::{FactKey, FactKind};
use crate::ast::{Body, Element, Expr, ExprKind, Function, Pattern};
use crate::ir::{Ir, IrFunction, IrItem, IrKind, IrStatement, LocalId, always_return};
use crate::operators::BinaryOp;
use crate::parse::{Attempt, Reported};
use crate::rules;
use crate::tables::UnitId;
use crate::types::Type;
use labspec_finding::{Finding, Span};

impl<'a> Binder<'a> {
    /// Registers a function that the text defines here.
    pub(super) fn new_function(&mut self, function: &'a Function) -> Entity {
        self.functions.push(KnownFunction {
            function,
            key: self.key(function.span.start, FactKind::Result),
            around: self.unit,
            unit: None,
            site: self.site,
        });
        Entity::Closure(self.functions.len() - 1)
    }

    /// The key of the type of a parameter.
    fn param_key(&self, param: &Element) -> FactKey {
        let what =
            if matches!(param.target, Pattern::Name(_)) { FactKind::Name } else { FactKind::Parameter };
        self.key(param.target.span().start, what)
    }

    /// Binds the function for a call with these argument types, and returns its unit.
    fn unit_of(&mut self, index: usize, types: &[Type]) -> Attempt<UnitId> {
        let Some(called) = self.functions.get(index).cloned() else { return Err(Reported) };
        let site = std::mem::replace(&mut self.site, called.site);
        for (i, param) in called.function.params.iter().enumerate() {
            let key = self.param_key(param);
            self.facts.join(key);
            self.facts.widen(key, types.get(i).copied().unwrap_or(Type::Undefined));
        }
        let unit = called.unit.unwrap_or_else(|| self.bind_function(index, &called));
        self.site = site;
        Ok(unit)
    }

    fn bind_function(&mut self, index: usize, called: &KnownFunction<'a>) -> UnitId {
        let unit = self.tree.units.len() as UnitId;
        self.tree.units.push(IrFunction::default());
        if let Some(called) = self.functions.get_mut(index) {
            called.unit = Some(unit);
        }
        self.facts.join(called.key);
        let first = self.functions.len();
        let outer = (self.unit, self.loops, self.guards);
        (self.unit, self.loops, self.guards) = (unit, 0, 1);
        let (params, body) = self.body(called.function);
        self.leave(first);
        (self.unit, self.loops, self.guards) = outer;
        let result = self.facts.ty(called.key);
        if let Some(unit) = self.tree.units.get_mut(unit as usize) {
            unit.params = params;
            unit.body = body;
            unit.result = Some(result);
        }
        unit
    }

    fn body(&mut self, function: &'a Function) -> (Vec<LocalId>, Vec<IrStatement>) {
        let mut steps = Vec::new();
        let mut places = Vec::new();
        for param in &function.params {
            places.push(match &param.target {
                Pattern::Name(name) => self.declare_variable(name),
                _ => {
                    let key = self.param_key(param);
                    self.new_local(key, false)
                }
            });
        }
        for param in &function.params {
            if !matches!(param.target, Pattern::Name(_)) {
                self.hoist_pattern(&param.target, &mut steps);
            }
        }
        for (param, place) in function.params.iter().zip(&places) {
            self.param(param, *place, &mut steps);
        }
        let key = self.key(function.span.start, FactKind::Result);
        match &function.body {
            Body::Value(expr) => {
                if let Ok(ir) = self.body_value(expr) {
                    self.facts.widen(key, ir.ty);
                    steps.push(IrStatement::Return(ir));
                }
            }
            Body::Block(statements) => {
                self.returns.push(key);
                steps.extend(self.block(statements));
                self.returns.pop();
                if !always_return(&steps) {
                    self.facts.widen(key, Type::Undefined);
                }
            }
        }
        (places, steps)
    }

    /// Binds the result of an arrow function without braces: a value, or the result of an assignment such as `x = 1`.
    fn body_value(&mut self, expr: &'a Expr) -> Attempt<Ir> {
        match &expr.kind {
            ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Update { .. } => {
                self.changing(expr)
            }
            ExprKind::Call { .. } => {
                let entity = self.entity(expr)?;
                match entity {
                    // The call of a function without a result gives `undefined`.
                    Entity::Value(ir) if ir.ty == Type::Void => Ok(Ir { ty: Type::Undefined, ..ir }),
                    other => self.value_of(other, expr.span),
                }
            }
            _ => self.value(expr),
        }
    }

    /// Binds a parameter: applies its default and destructures it.
    fn param(&mut self, param: &'a Element, place: LocalId, steps: &mut Vec<IrStatement>) {
        let span = param.target.span();
        let key = self.param_key(param);
        let read = |ty| Ir::new(IrKind::Local(place), ty, span);
        if let Some(default) = &param.default
            && let Ok(value) = self.value(default)
        {
            self.facts.widen(key, value.ty);
            let ty = self.facts.ty(key);
            let test = Ir::binary(BinaryOp::StrictEqual, read(ty), Ir::undefined(span), span);
            let store =
                IrKind::Store(Box::new(crate::ir::AssignmentTarget::Local(place)), None, Box::new(value));
            steps.push(IrStatement::If(
                test,
                vec![IrStatement::Effect(Ir::new(store, ty, span))],
                Vec::new(),
            ));
        }
        let ty = self.facts.ty(key);
        match &param.target {
            Pattern::Name(name) => self.mark_declared(name, VariableMeaning::Slot),
            pattern => self.destructure_value(pattern, read(ty), steps),
        }
    }

    /// Binds a function that nothing has called yet, with parameters of type any.
    pub(super) fn bind_with_anything(&mut self, index: usize) {
        let n = self.functions.get(index).map_or(0, |k| k.function.params.len());
        let _ = self.unit_of(index, &vec![Type::Any; n]);
    }

    /// Binds a function as a value: it may be called from anywhere, with any arguments.
    pub(super) fn closure_value(&mut self, index: usize, span: Span) -> Attempt<Ir> {
        let n = self.functions.get(index).map_or(0, |k| k.function.params.len());
        let unit = self.unit_of(index, &vec![Type::Any; n])?;
        self.capture_for(index);
        Ok(Ir::new(IrKind::Closure(unit), Type::Function, span))
    }

    /// Records the variables that a called function captures: its caller must pass them.
    fn capture_for(&mut self, index: usize) {
        let Some(called) = self.functions.get(index) else { return };
        let (FactKey { site, offset, .. }, names) =
            (called.key, called.site.map_or(self.names, |site| site.names));
        for byte in names.captured(offset) {
            let found = self.variables.get(&FactKey { site, offset: byte, what: FactKind::Name }).cloned();
            if let Some(found) = found.filter(|v| !matches!(v.meaning, VariableMeaning::Alias(_))) {
                self.capture(&found);
            }
        }
    }

    /// Binds a call of a function that is known by its index.
    pub(super) fn call_known(&mut self, index: usize, args: &'a [Expr], span: Span) -> Attempt<Ir> {
        if args.iter().any(|a| matches!(a.kind, ExprKind::Spread(_))) {
            let callee = self.closure_value(index, span)?;
            let items = self.items(args)?;
            return Ok(self.call_value(callee, items, span));
        }
        let expected = self.functions.get(index).map_or(0, |k| k.function.params.len());
        let needed = self
            .functions
            .get(index)
            .map_or(0, |k| k.function.params.iter().rposition(|p| p.default.is_none()).map_or(0, |i| i + 1));
        let mut values = Vec::new();
        let mut extra = Vec::new();
        let mut failed = false;
        for (i, arg) in args.iter().enumerate() {
            // An extra argument is skipped if its evaluation can have no effect.
            if i >= expected && matches!(arg.kind, ExprKind::Name(_) | ExprKind::Number(_)) {
                continue;
            }
            match self.value(arg) {
                Ok(ir) if i < expected => values.push(ir),
                Ok(ir) => extra.push(IrStatement::Effect(ir)),
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
                .help("pass all arguments, or give the parameters a default value, as `(x, k = 1) => …`"),
            );
        }
        if failed {
            return Err(Reported);
        }
        let types: Vec<Type> = values.iter().map(|v| v.ty).collect();
        let unit = self.unit_of(index, &types)?;
        self.capture_for(index);
        let Some(key) = self.functions.get(index).map(|k| k.key) else { return Err(Reported) };
        let call = Ir::new(IrKind::Invoke(unit, values), self.facts.ty(key), span);
        if extra.is_empty() {
            return Ok(call);
        }
        let ty = call.ty;
        Ok(Ir::new(IrKind::Block(extra, Box::new(call)), ty, span))
    }

    /// Binds a call of a function that is known only at run time.
    pub(super) fn call_value(&mut self, callee: Ir, args: Vec<IrItem>, span: Span) -> Ir {
        Ir::new(IrKind::InvokeValue(Box::new(callee), args), Type::Any, span)
    }
}
