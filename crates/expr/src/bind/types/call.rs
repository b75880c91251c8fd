//! Calls: functions of the host, `Math`, named objects, functions of the text, and aggregates.

use super::access::ObjectChoice;
use super::binder::{Binder, Entity};
use super::extra_arguments::{report_extra_arguments, report_extra_index};
use super::member::quoted;
use super::typed::Expectation;
use crate::ast::{Expr, ExprKind};
use crate::ir::{Ir, IrFunction, IrItem, IrKind, IrProgram, IrStatement};
use crate::math;
use crate::natives;
use crate::parse::{Attempt, Reported};
use crate::program::{Aggregate, Program};
use crate::rules;
use crate::schema::{FunctionInfo, Help, Param, signature};
use crate::source_functions::source_function;
use crate::tables::{FreeFunctionId, MemberTable};
use crate::types::{CollectionId, FunctionId, ObjectId, Type};
use crate::value::Value;
use labspec_finding::order;
use labspec_finding::{Finding, Span};

/// Functions whose argument is an angle.
const ANGLE_FUNCTIONS: [&str; 3] = ["Math.sin", "Math.cos", "Math.tan"];

impl<'a> Binder<'a> {
    /// Binds `callee(args)` or `callee?.(args)`.
    pub(super) fn call(
        &mut self,
        callee: &'a Expr,
        args: &'a [Expr],
        optional: bool,
        span: Span,
    ) -> Attempt<Entity> {
        let entity = match self.entity(callee) {
            Ok(entity) => entity,
            Err(Reported) => {
                self.check_arguments(args);
                return Err(Reported);
            }
        };
        match entity {
            Entity::Collection(id) => self.named(id, callee.span, args, span),
            Entity::Function(id) => self.host_call(id, args, callee.span, span).map(Entity::Value),
            Entity::MathFunction(function) => self.math_call(function, args, span).map(Entity::Value),
            Entity::Method(receiver, name) => self.method(*receiver, name, args, span).map(Entity::Value),
            Entity::Native(function) => self.native_call(function, args, span).map(Entity::Value),
            Entity::Namespace(name) => match natives::find_function(name) {
                Some(function) => self.native_call(function, args, span).map(Entity::Value),
                None => {
                    self.check_arguments(args);
                    self.refuse(
                        Finding::error(
                            rules::NOT_IN_LANGUAGE,
                            callee.span,
                            format!("`{name}(…)` is not in this language"),
                        )
                        .why("it would create a JavaScript object around the value")
                        .help("write a list `[0, 0]` or a record `{a: 1}`"),
                    )
                }
            },
            Entity::Closure(index) => self.call_known(index, args, span).map(Entity::Value),
            Entity::Value(ir) if matches!(ir.ty, Type::Function | Type::Any | Type::Never) => {
                let callee = if optional { self.present(ir) } else { ir };
                let items = self.items(args)?;
                Ok(Entity::Value(self.call_value(callee, items, span)))
            }
            other => {
                self.check_arguments(args);
                let report = self.not_callable(&other, callee.span);
                self.refuse(report)
            }
        }
    }

    /// Binds a call of a function of the language: `Number(x)`, `Array.from(v, f)`.
    #[inline(never)]
    fn native_call(&mut self, function: FreeFunctionId, args: &'a [Expr], span: Span) -> Attempt<Ir> {
        let row = function.row();
        let args = self.accepted_args(args, row.arity().1);
        if let (Some(method), [first, rest @ ..]) =
            (function.rows().find_map(|row| source_function(row, args.len())), args)
        {
            let first = self.value(first).map(Entity::Value)?;
            return self.inline_method(method, row, first, rest, span);
        }
        self.check_arity(&[row], args, span)?;
        let items = self.items(args)?;
        if let [IrItem { value, spread: false }] = items.as_slice() {
            match row.name {
                "Number" if value.is_plain() => return Ok(Ir::to_number(value.clone(), span)),
                "String" => return Ok(Ir::to_text(value.clone(), span)),
                "Boolean" => return Ok(Ir::not(Ir::not(value.clone(), span), span)),
                _ => {}
            }
        }
        Ok(Ir::new(IrKind::Native(function, items), row.returns(Type::Any), span))
    }

    /// The arguments that a function accepts, of those that an inlined method passes: element, index and list.
    fn accepted_args(&self, args: &'a [Expr], most: usize) -> &'a [Expr] {
        if self.site.is_some() { args.get(..most).unwrap_or(args) } else { args }
    }

    /// Binds arguments only to report their errors; the results are discarded.
    pub(super) fn check_arguments(&mut self, args: &'a [Expr]) {
        for arg in args {
            let _ = match &arg.kind {
                ExprKind::Spread(inner) => self.entity(inner),
                _ => self.entity(arg),
            };
        }
    }

    #[inline(never)]
    fn not_callable(&self, entity: &Entity, span: Span) -> Finding {
        let text = self.text(span);
        let what = match entity {
            Entity::Field(field) if !field.is_scalar() => "an array",
            Entity::Field(_) => "a number",
            Entity::Object(_) | Entity::Math | Entity::Globals => "an object",
            Entity::Value(ir) => ir.ty.describe(),
            _ => "a value",
        };
        let report = Finding::error(rules::NOT_CALLABLE, span, format!("`{text}` is {what}, not a function"));
        match entity {
            Entity::Field(field) if !field.is_scalar() => report
                .why("parentheses call a function")
                .help(format!("select elements with square brackets, as `{text}[0]`")),
            _ => report
                .why("parentheses after a name call a function")
                .help("write `*` before the bracket for a product"),
        }
    }

    /// The finding for a function that is named but not called.
    pub(super) fn not_called(&self, entity: &Entity, span: Span) -> Finding {
        let text = self.text(span);
        let call = match entity {
            Entity::Function(id) => {
                let signature = self.signature(&self.schema.function(*id));
                let arguments = signature.split_once('(').map_or(")", |(_, rest)| rest);
                format!("{text}({arguments}")
            }
            _ => format!("{text}(…)"),
        };
        Finding::error(rules::NOT_CALLED, span, format!("`{text}` is a function, but it is not called"))
            .why("a function without parentheses does nothing, and is not a value here")
            .help(format!("write `{call}`"))
    }

    #[inline(never)]
    fn math_call(&mut self, function: math::MathFunction, args: &'a [Expr], span: Span) -> Attempt<Ir> {
        let path = function.path();
        let title = path.clone();
        let args = self.accepted_args(args, function.arity().1.unwrap_or(usize::MAX));
        // A method that calls a function for every element also passes the index and the list.
        if let Some(site) = self.site.filter(|_| args.len() > 2 && function.arity().1.is_none()) {
            return self.refuse(report_extra_arguments(&path, &site.called(), span));
        }
        self.explain(span, || Help {
            title: format!("{title}(…)"), lines: vec![function.doc().to_owned()]
        });
        if args.iter().any(|a| matches!(a.kind, ExprKind::Spread(_))) {
            return self.math_over(function, args, span);
        }
        let mut numbers = Vec::new();
        let mut failed = false;
        for arg in args {
            match self.math_argument(&path, function, arg) {
                Ok(ir) => {
                    self.record_expectation(&ir, arg.span, Expectation::Number(path.clone()));
                    if ANGLE_FUNCTIONS.contains(&path.as_str()) {
                        self.record_expectation(&ir, arg.span, Expectation::Angle(path.clone()));
                    }
                    numbers.push(Ir::to_number(ir, arg.span));
                }
                Err(Reported) => failed = true,
            }
        }
        let (least, most) = function.arity();
        if args.len() < least {
            let message = format!("`{path}` needs {}", count(least, "argument"));
            return self.refuse(
                Finding::error(rules::ARGUMENT_COUNT, span, message)
                    .why("a missing argument is `undefined`, which JavaScript converts to NaN")
                    .help(format!("write `{path}({})`", if least == 2 { "a, b" } else { "x" })),
            );
        }
        if let Some(most) = most.filter(|most| args.len() > *most) {
            let first = args.get(most).map_or(span, |a| a.span);
            let last = args.last().map_or(span, |a| a.span);
            let message = format!("`{path}` takes {}, so this argument is ignored", count(most, "argument"));
            let report =
                Finding::warning(rules::ARGUMENT_COUNT, first.to(last), message).why("JavaScript ignores it");
            self.report(if path == "Math.round" {
                let rounding = self.host_terms().rounding;
                report.help(format!("to round to decimals, write `Math.round(100 * x) / 100`{rounding}"))
            } else {
                report.help("remove it")
            });
            numbers.truncate(most);
        }
        if failed { Err(Reported) } else { Ok(Ir::math(function, numbers, span)) }
    }

    /// Binds an argument of a function of `Math`. A list is an error: `Math.max([1, 2])` should be `Math.max(...[1, 2])`.
    fn math_argument(&mut self, path: &str, function: math::MathFunction, arg: &'a Expr) -> Attempt<Ir> {
        let entity = self.entity(arg)?;
        let report = match &entity {
            Entity::Field(field) if !field.is_scalar() => Some(self.whole_array(field, arg.span)),
            Entity::Value(ir) if matches!(ir.ty, Type::List | Type::View) => Some(self.not_single(ir)),
            _ => None,
        };
        match report.filter(|_| function.arity().1.is_none()) {
            Some(report) => {
                let text = self.text(arg.span);
                let help = format!("write `{path}(...{text})` for all its elements, or `{text}[0]` for one");
                self.refuse(report.help(help).guess(Span::new(arg.span.start, arg.span.start), "..."))
            }
            None => self.operand_of(entity, arg.span),
        }
    }

    /// Binds a call of a function of `Math` with spread arguments; lists of known length are expanded.
    #[inline(never)]
    fn math_over(&mut self, function: math::MathFunction, args: &'a [Expr], span: Span) -> Attempt<Ir> {
        let items = self.items(args)?;
        if items.iter().all(|i| !i.spread) {
            let numbers = items.into_iter().map(|i| Ir::to_number(i.value, span)).collect();
            return Ok(Ir::math(function, numbers, span));
        }
        let ty = if function.gives_boolean() { Type::Boolean } else { Type::Number };
        let list = match items.as_slice() {
            [only] if only.value.ty != Type::String => only.value.clone(),
            _ => Ir::new(IrKind::List(items), Type::List, span),
        };
        Ok(Ir::new(IrKind::MathOver(function, Box::new(list)), ty, span))
    }

    /// Binds a call of a function of the host.
    #[inline(never)]
    pub(super) fn host_call(
        &mut self,
        id: FunctionId,
        args: &'a [Expr],
        callee: Span,
        span: Span,
    ) -> Attempt<Ir> {
        let info = self.schema.function(id);
        if let Some(spread) = args.iter().find(|a| matches!(a.kind, ExprKind::Spread(_))) {
            let report = Finding::error(
                rules::ARGUMENT_TYPE,
                spread.span,
                format!("the arguments of `{}` cannot be spread", info.name),
            )
            .why("they are checked one by one before the run")
            .help(format!("write `{}`", self.signature(&info)));
            return self.refuse(report);
        }
        if info.aggregate {
            return self.aggregate(id, &info, args, span);
        }
        let implied = info.implied && args.is_empty();
        let required = info.params.len().saturating_sub(info.optional);
        let args = self.accepted_args(args, info.params.len());
        // A method that calls a function for every element also passes the index, which an optional argument would receive.
        if let Some(site) = self.site.filter(|_| args.len() > required.max(1)) {
            return self.refuse(report_extra_index(&info.name, &site.called(), span));
        }
        if !implied && (args.len() < required || args.len() > info.params.len()) {
            self.check_arguments(args);
            let callee = self.site.is_none().then_some(callee);
            let report = self.wrong_count(&info, args, callee, span);
            return self.refuse(report);
        }
        let mut passed = Vec::new();
        let mut failed = false;
        for (i, (param, arg)) in info.params.iter().zip(args).enumerate() {
            // `f(data, model)` is one mistake, not two: after a wrong argument, objects are not checked.
            if failed && matches!(param, Param::Object(_)) {
                continue;
            }
            match self.argument(&info, i, *param, arg) {
                Ok(ir) => passed.extend(ir),
                Err(Reported) => failed = true,
            }
        }
        if failed {
            return Err(Reported);
        }
        Ok(Ir::new(IrKind::Call(id, passed), info.returns, span))
    }

    fn wrong_count(&self, info: &FunctionInfo, args: &[Expr], callee: Option<Span>, span: Span) -> Finding {
        let signature = self.signature(info);
        let n = info.params.len();
        let expected = if info.optional > 0 {
            format!("{} to {}", n.saturating_sub(info.optional), count(n, "argument"))
        } else {
            count(n, "argument")
        };
        let message = format!("`{}` takes {expected}, not {}", info.name, args.len());
        let mut report = Finding::error(rules::ARGUMENT_COUNT, span, message);
        if !info.doc.is_empty() {
            report = report.why(format!("it does this: {}", info.doc));
        }
        let only_objects =
            !info.params.is_empty() && info.params.iter().all(|p| matches!(p, Param::Object(_)));
        if let Some(callee) = callee.filter(|_| only_objects) {
            let arguments = signature.split_once('(').map_or("", |(_, rest)| rest);
            let meant = format!("{}({arguments}", self.text(callee));
            return report.help(format!("write `{meant}`")).fix(span, meant);
        }
        report.help(format!("write `{signature}`"))
    }

    /// `mj.mj_setConst(model, data)`
    pub(super) fn signature(&self, info: &FunctionInfo) -> String {
        signature(self.schema, info)
    }

    /// Binds and checks an argument. Returns `None` for an object, which is not passed.
    fn argument(
        &mut self,
        info: &FunctionInfo,
        i: usize,
        param: Param,
        arg: &'a Expr,
    ) -> Attempt<Option<Ir>> {
        let span = arg.span;
        match param {
            Param::Object(expected) => self.object_argument(info, i, expected, arg).map(|()| None),
            Param::Name(collection) => self.name_argument(collection, arg).map(Some),
            Param::Number | Param::Angle => {
                let ir = self.operand(arg)?;
                if ir.ty == Type::String {
                    return self.wrong_type(info, i, &ir, "a number");
                }
                if param == Param::Angle {
                    self.record_expectation(&ir, span, Expectation::Angle(info.name.clone()));
                }
                Ok(Some(Ir::to_number(ir, span)))
            }
            Param::Text => {
                let ir = self.operand(arg)?;
                if !matches!(ir.ty, Type::String | Type::Any | Type::Never) {
                    return self.wrong_type(info, i, &ir, "a string");
                }
                Ok(Some(Ir::to_text(ir, span)))
            }
            Param::Numbers => self.numbers_argument(info, i, arg).map(Some),
            Param::Boolean => {
                let ir = self.value(arg)?;
                Ok(Some(Ir::not(Ir::not(ir, span), span)))
            }
            Param::Any | Param::Lazy => self.value(arg).map(Some),
        }
    }

    /// Checks an argument that must be an object of the host.
    fn object_argument(
        &mut self,
        info: &FunctionInfo,
        i: usize,
        expected: ObjectId,
        arg: &'a Expr,
    ) -> Attempt<()> {
        if matches!(self.entity(arg)?, Entity::Object(id) if id == expected) {
            return Ok(());
        }
        let object = self.schema.describe(expected);
        let message = format!("argument {} of `{}` must be {}", i + 1, info.name, quoted(&object));
        self.refuse(
            Finding::error(rules::ARGUMENT_TYPE, arg.span, message)
                .why("there is only one such object, and it belongs in this position")
                .help(format!("write `{}`", self.signature(info))),
        )
    }

    /// Binds the name of an object of a collection as its id.
    fn name_argument(&mut self, collection: CollectionId, arg: &'a Expr) -> Attempt<Ir> {
        match self.object_name(collection, arg)? {
            ObjectChoice::Constant(object) => Ok(Ir::number(f64::from(object.0), arg.span)),
            // The name is known only at run time: a table with the ids of all objects of the collection.
            ObjectChoice::Computed(name) => {
                let noun = self.schema.noun(collection).to_owned();
                let names = self.schema.names(collection);
                let id = |n: &String| {
                    Some((n.as_str().into(), Value::Number(f64::from(self.schema.lookup(collection, n)?.0))))
                };
                let mut members: Vec<_> = names.iter().filter_map(id).collect();
                order::sort_by(&mut members, |a: &(std::sync::Arc<str>, Value), b| a.0.cmp(&b.0));
                let picks = MemberTable { noun, members, scalar: false };
                Ok(Ir::new(IrKind::Pick(picks.into(), Box::new(name)), Type::Number, arg.span))
            }
        }
    }

    /// Binds a list of numbers.
    fn numbers_argument(&mut self, info: &FunctionInfo, i: usize, arg: &'a Expr) -> Attempt<Ir> {
        let ir = self.value(arg)?;
        match ir.ty {
            Type::List | Type::View | Type::Any | Type::Never => {}
            _ => return self.wrong_type(info, i, &ir, "a list of numbers"),
        }
        // The list is copied, so that the function receives only one kind of list.
        let copy = natives::find_function("Array.from").filter(|_| ir.ty != Type::List);
        Ok(match copy {
            Some(copy) => {
                let item = IrItem { value: ir, spread: false };
                Ir::new(IrKind::Native(copy, vec![item]), Type::List, arg.span)
            }
            None => ir,
        })
    }

    fn wrong_type<T>(&mut self, info: &FunctionInfo, i: usize, ir: &Ir, expected: &str) -> Attempt<T> {
        let message =
            format!("argument {} of `{}` must be {expected}, not {}", i + 1, info.name, ir.ty.describe());
        let report = Finding::error(rules::ARGUMENT_TYPE, ir.span, message).why(info.doc.clone());
        let constant = ir.as_constant().map(|v| (v.type_of(), v.to_number()));
        self.refuse(match constant {
            Some((Type::String, x)) if !x.is_nan() => {
                let meant = crate::number::to_text(x);
                report.help(format!("write `{meant}` without quotes")).fix(ir.span, meant)
            }
            _ => report.help(format!("write `{}`", self.signature(info))),
        })
    }

    /// Binds a call whose arguments are separate programs.
    #[inline(never)]
    fn aggregate(
        &mut self,
        id: FunctionId,
        info: &FunctionInfo,
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<Ir> {
        let required = info.params.len().saturating_sub(info.optional);
        if args.len() < required || args.len() > info.params.len() {
            let report = self.wrong_count(info, args, None, span);
            return self.refuse(report);
        }
        let mut programs = Vec::new();
        let mut failed = false;
        for (i, (param, arg)) in info.params.iter().zip(args).enumerate() {
            // Each argument has its own reads and writes.
            let aggregates = std::mem::take(&mut self.aggregates);
            let variables = std::mem::take(&mut self.variables);
            let functions = std::mem::take(&mut self.functions);
            let alone = IrProgram { units: vec![IrFunction::default()], ..IrProgram::default() };
            let tree = std::mem::replace(&mut self.tree, alone);
            let keys = std::mem::take(&mut self.keys);
            let unit = std::mem::take(&mut self.unit);
            let bound = match param {
                Param::Lazy => self.operand(arg).map(Some),
                _ => self.argument(info, i, *param, arg),
            };
            let result = if let Ok(Some(ir)) = &bound { Some(ir.ty) } else { None };
            if let Ok(Some(ir)) = &bound {
                self.finish(vec![IrStatement::Return(ir.clone())], result);
            }
            let aggregates = std::mem::replace(&mut self.aggregates, aggregates);
            self.assign_types();
            let tree = std::mem::replace(&mut self.tree, tree);
            self.keys = keys;
            self.variables = variables;
            self.functions = functions;
            self.unit = unit;
            match bound {
                Ok(Some(ir)) => {
                    programs.push(Program::new(&tree, self.schema, ir.ty, aggregates, &self.globals));
                }
                Ok(None) => {}
                Err(Reported) => failed = true,
            }
        }
        if failed {
            return Err(Reported);
        }
        let slot = self.next_aggregate;
        self.next_aggregate += 1;
        self.aggregates.push(Aggregate { function: id, args: programs, slot, span });
        Ok(Ir::new(IrKind::Aggregate(slot as u32), Type::Number, span))
    }
}

/// `1 argument`, `2 arguments`
pub(super) fn count(n: usize, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}
