//! Calls: signatures of the host's functions, `Math`, named objects, `.fill` and `.set`, and aggregates.

use super::name::{quoted, view_of};
use super::{Attempt, Binder, Method, Reported, Thing};
use crate::ast::{Expr, ExprKind};
use crate::code;
use crate::diagnostic::{Diagnostic, Span};
use crate::ir::{Ir, Kind};
use crate::lower;
use crate::math;
use crate::operators::BinaryOp;
use crate::program::{Aggregate, Program};
use crate::schema::{Field, FunctionId, FunctionInfo, Param, Type};
use crate::suggest::closest;
use crate::value::Value;

impl Binder<'_> {
    /// `callee(args)`
    pub(super) fn call(&mut self, callee: &Expr, args: &[Expr], span: Span) -> Attempt<Thing> {
        let thing = match self.callee(callee) {
            Ok(thing) => thing,
            Err(Reported) => {
                self.only_check(args);
                return Err(Reported);
            }
        };
        match thing {
            Thing::Collection(id) => self.named(id, callee.span, args, span).map(Thing::Object),
            Thing::Function(id) => self.host_call(id, args, callee.span, span).map(Thing::Value),
            Thing::MathFunction(function) => self.math_call(function, args, span).map(Thing::Value),
            Thing::Method(method, field) => self.method(method, &field, args, span).map(Thing::Value),
            other => {
                self.only_check(args);
                let report = self.not_callable(&other, callee.span);
                self.refuse(report)
            }
        }
    }

    /// What is called. A name that nothing defines is looked for among functions.
    fn callee(&mut self, callee: &Expr) -> Attempt<Thing> {
        let before = self.diagnostics.len();
        let thing = self.thing(callee);
        let ExprKind::Name(_) = &callee.kind else { return thing };
        for report in self.diagnostics.iter_mut().skip(before) {
            if report.code == code::UNKNOWN_NAME {
                report.code = code::UNKNOWN_FUNCTION;
                report.message = report.message.replace("unknown name", "unknown function");
                if report.fix.is_none() {
                    report.help = Some("functions of one's own are not supported yet; write the expression where it is needed".into());
                }
            }
        }
        thing
    }

    /// Looks for mistakes in arguments that will not be used.
    fn only_check(&mut self, args: &[Expr]) {
        for arg in args {
            let _ = self.thing(arg);
        }
    }

    fn not_callable(&self, thing: &Thing, span: Span) -> Diagnostic {
        let text = self.text(span);
        let what = match thing {
            Thing::Field(field) if !field.is_scalar() => "an array",
            Thing::Field(_) => "a number",
            Thing::Object(_) | Thing::Math | Thing::Globals => "an object",
            _ => "a value",
        };
        let report =
            Diagnostic::error(code::NOT_CALLABLE, span, format!("`{text}` is {what}, not a function"));
        match thing {
            Thing::Field(field) if !field.is_scalar() => report
                .why("round brackets call a function")
                .help(format!("elements are chosen with square brackets, as `{text}[0]`")),
            _ => report
                .why("brackets behind a name call a function")
                .help("if a product is meant, write `*` before the bracket"),
        }
    }

    /// The finding for a function that is named but not called.
    pub(super) fn not_called(&self, thing: &Thing, span: Span) -> Diagnostic {
        let text = self.text(span);
        let call = match thing {
            Thing::Function(id) => {
                let signature = self.signature(&self.schema.function(*id));
                let arguments = signature.split_once('(').map_or(")", |(_, rest)| rest);
                format!("{text}({arguments}")
            }
            _ => format!("{text}(…)"),
        };
        Diagnostic::error(code::NOT_CALLED, span, format!("`{text}` is a function, but it is not called"))
            .why("without arguments in brackets nothing happens, and a function is not a value here")
            .help(format!("write `{call}`"))
    }

    fn math_call(&mut self, function: math::Function, args: &[Expr], span: Span) -> Attempt<Ir> {
        let path = function.path();
        let mut numbers = Vec::new();
        let mut failed = false;
        for arg in args {
            match self.value(arg) {
                Ok(ir) => {
                    self.expect_argument(&ir, &path);
                    numbers.push(Ir::to_number(ir, arg.span));
                }
                Err(Reported) => failed = true,
            }
        }
        let (least, most) = function.arity();
        if args.len() < least {
            let message = format!("`{path}` needs {}", count(least, "argument"));
            return self.refuse(
                Diagnostic::error(code::ARGUMENT_COUNT, span, message)
                    .why(format!("it gets {}, and JavaScript then gives NaN", args.len()))
                    .help(format!("write `{path}({})`", if least == 2 { "a, b" } else { "x" })),
            );
        }
        if let Some(most) = most.filter(|most| args.len() > *most) {
            let first = args.get(most).map_or(span, |a| a.span);
            let last = args.last().map_or(span, |a| a.span);
            let message = format!("`{path}` takes {}, this is ignored", count(most, "argument"));
            let report = Diagnostic::warning(code::ARGUMENT_COUNT, first.to(last), message)
                .why("JavaScript computes without it");
            self.report(if path == "Math.round" {
                report.help(
                    "to round to decimals, write `Math.round(100 * x) / 100`, or set `digits` of the readout",
                )
            } else {
                report.help("remove it")
            });
            numbers.truncate(most);
        }
        if failed { Err(Reported) } else { Ok(Ir::math(function, numbers, span)) }
    }

    fn expect_argument(&mut self, ir: &Ir, path: &str) {
        if ir.ty == Type::String {
            self.report(
                Diagnostic::warning(
                    code::STRING_AS_NUMBER,
                    ir.span,
                    format!("`{path}` needs a number, this is a string"),
                )
                .why("JavaScript reads the number in it, or gives NaN when there is none")
                .help("write the number"),
            );
        }
    }

    /// A call of a function of the host.
    pub(super) fn host_call(
        &mut self,
        id: FunctionId,
        args: &[Expr],
        callee: Span,
        span: Span,
    ) -> Attempt<Ir> {
        let info = self.schema.function(id);
        if info.aggregate {
            return self.aggregate(id, &info, args, span);
        }
        let implied = info.implied && args.is_empty();
        let required = info.params.len().saturating_sub(info.optional);
        if !implied && (args.len() < required || args.len() > info.params.len()) {
            self.only_check(args);
            let report = self.wrong_count(&info, args, callee, span);
            return self.refuse(report);
        }
        let mut passed = Vec::new();
        let mut failed = false;
        for (i, (param, arg)) in info.params.iter().zip(args).enumerate() {
            // `f(data, model)` is one mistake, not two.
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
        self.effects.call(id, &info.reads, &info.writes);
        Ok(Ir::new(Kind::Call(id, passed), info.returns, span))
    }

    fn wrong_count(&self, info: &FunctionInfo, args: &[Expr], callee: Span, span: Span) -> Diagnostic {
        let signature = self.signature(info);
        let n = info.params.len();
        let wanted = if info.optional > 0 {
            format!("{} to {}", n.saturating_sub(info.optional), count(n, "argument"))
        } else {
            count(n, "argument")
        };
        let message = format!("`{}` takes {wanted}, not {}", info.name, args.len());
        let report = Diagnostic::error(code::ARGUMENT_COUNT, span, message).why(info.doc.clone());
        let only_objects =
            !info.params.is_empty() && info.params.iter().all(|p| matches!(p, Param::Object(_)));
        if only_objects {
            let arguments = signature.split_once('(').map_or("", |(_, rest)| rest);
            let meant = format!("{}({arguments}", self.text(callee));
            return report.help(format!("write `{meant}`")).fix(span, meant);
        }
        report.help(format!("write `{signature}`"))
    }

    /// `mj.mj_setConst(model, data)`
    fn signature(&self, info: &FunctionInfo) -> String {
        let params = info.params.iter().map(|param| match param {
            Param::Number | Param::Lazy => "x".to_owned(),
            Param::Text => "\"text\"".to_owned(),
            Param::Boolean => "true".to_owned(),
            Param::Any => "value".to_owned(),
            Param::Object(id) => self.schema.describe(*id),
            Param::Name(id) => format!("\"name of a {}\"", self.schema.noun(*id)),
        });
        format!("{}({})", info.name, params.collect::<Vec<_>>().join(", "))
    }

    /// An argument, checked; nothing for an object, which is not passed.
    fn argument(&mut self, info: &FunctionInfo, i: usize, param: Param, arg: &Expr) -> Attempt<Option<Ir>> {
        let span = arg.span;
        match param {
            Param::Object(wanted) => {
                if matches!(self.thing(arg)?, Thing::Object(id) if id == wanted) {
                    return Ok(None);
                }
                let object = self.schema.describe(wanted);
                let message = format!("argument {} of `{}` must be {}", i + 1, info.name, quoted(&object));
                self.refuse(
                    Diagnostic::error(code::ARGUMENT_TYPE, span, message)
                        .why("there is only one model and one data in a lab, and they stand in this order")
                        .help(format!("write `{}`", self.signature(info))),
                )
            }
            Param::Name(collection) => {
                let object = self.object_name(collection, arg)?;
                Ok(Some(Ir::constant(Value::Number(f64::from(object.0)), span)))
            }
            Param::Number => {
                let ir = self.value(arg)?;
                if ir.ty == Type::String {
                    return self.wrong_type(info, i, &ir, "a number");
                }
                Ok(Some(Ir::to_number(ir, span)))
            }
            Param::Text => {
                let ir = self.value(arg)?;
                if !matches!(ir.ty, Type::String | Type::Any) {
                    return self.wrong_type(info, i, &ir, "a string");
                }
                Ok(Some(Ir::binary(BinaryOp::Add, Ir::constant(Value::from(""), span), ir, span)))
            }
            Param::Boolean => {
                let ir = self.value(arg)?;
                Ok(Some(Ir::not(Ir::not(ir, span), span)))
            }
            Param::Any | Param::Lazy => self.value(arg).map(Some),
        }
    }

    fn wrong_type<T>(&mut self, info: &FunctionInfo, i: usize, ir: &Ir, wanted: &str) -> Attempt<T> {
        let message =
            format!("argument {} of `{}` must be {wanted}, not {}", i + 1, info.name, ir.ty.describe());
        let report = Diagnostic::error(code::ARGUMENT_TYPE, ir.span, message).why(info.doc.clone());
        let known = ir.known().map(|v| (v.type_of(), v.to_number()));
        self.refuse(match known {
            Some((Type::String, x)) if !x.is_nan() => {
                let meant = crate::number::to_text(x);
                report.help(format!("write `{meant}` without quotes")).fix(ir.span, meant)
            }
            _ => report.help(format!("write `{}`", self.signature(info))),
        })
    }

    /// A call whose arguments are programs of their own.
    fn aggregate(&mut self, id: FunctionId, info: &FunctionInfo, args: &[Expr], span: Span) -> Attempt<Ir> {
        let required = info.params.len().saturating_sub(info.optional);
        if args.len() < required || args.len() > info.params.len() {
            let report = self.wrong_count(info, args, Span::new(span.start, span.start), span);
            return self.refuse(Diagnostic { fix: None, ..report });
        }
        let mut programs = Vec::new();
        let mut failed = false;
        for (i, (param, arg)) in info.params.iter().zip(args).enumerate() {
            // Each argument reads and writes on its own account.
            let effects = std::mem::take(&mut self.effects);
            let aggregates = std::mem::take(&mut self.aggregates);
            let locals = std::mem::take(&mut self.locals);
            let bound = match param {
                Param::Lazy => self.value(arg).map(Some),
                _ => self.argument(info, i, *param, arg),
            };
            let effects = std::mem::replace(&mut self.effects, effects);
            let aggregates = std::mem::replace(&mut self.aggregates, aggregates);
            self.locals = locals;
            match bound {
                Ok(Some(ir)) => {
                    programs.push(Program {
                        code: lower::expression(&ir),
                        effects,
                        result: ir.ty,
                        aggregates,
                    });
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
        self.effects.aggregates = true;
        self.aggregates.push(Aggregate { function: id, args: programs, slot, span });
        Ok(Ir::new(Kind::Aggregate(slot as u32), Type::Number, span))
    }

    /// `.fill(x)` and `.set([...], offset)`
    fn method(&mut self, method: Method, field: &Field, args: &[Expr], span: Span) -> Attempt<Ir> {
        let assignable = self.check_assignable(field, span);
        let view = view_of(field);
        let kind = match (method, args) {
            (Method::Fill, [value]) => {
                let value = self.value(value)?;
                self.check_stored(&value);
                self.write(view, None);
                Kind::Fill(view, Box::new(value))
            }
            (Method::Set, [items, rest @ ..]) if rest.len() < 2 => {
                let offset = match rest.first() {
                    Some(offset) => self.offset(offset)?,
                    None => 0,
                };
                let items = self.items(items)?;
                self.check_fits(field, &items, offset, span)?;
                self.write(view, None);
                Kind::StoreAll(view, offset, items)
            }
            _ => {
                self.only_check(args);
                let (name, example) = match method {
                    Method::Fill => ("fill", ".fill(0)"),
                    Method::Set => ("set", ".set([0, 0, 1], 0)"),
                };
                return self.refuse(
                    Diagnostic::error(
                        code::ARGUMENT_COUNT,
                        span,
                        format!("`.{name}` does not take {}", count(args.len(), "argument")),
                    )
                    .help(format!("write `{}{example}`", field.path)),
                );
            }
        };
        assignable?;
        Ok(Ir::new(kind, Type::Void, span))
    }

    /// The first index of `.set`.
    fn offset(&mut self, offset: &Expr) -> Attempt<usize> {
        let ir = self.value(offset)?;
        match ir.known() {
            Some(Value::Number(x)) if *x >= 0.0 && x.fract() == 0.0 => Ok(*x as usize),
            _ => self.refuse(
                Diagnostic::error(
                    code::ARGUMENT_TYPE,
                    offset.span,
                    "the second argument of `.set` must be a whole number, written out",
                )
                .why("it is the index of the first element that is stored")
                .help("write the number, as `.set([0, 0, 1], 7)`, or assign the elements one by one"),
            ),
        }
    }

    /// The values of `.set`.
    fn items(&mut self, items: &Expr) -> Attempt<Vec<Ir>> {
        let ExprKind::Array(items) = &items.kind else {
            return self.refuse(
                Diagnostic::error(
                    code::ARGUMENT_TYPE,
                    items.span,
                    "`.set` needs its numbers in square brackets",
                )
                .help("write `.set([0, 0, 1], 0)`; to store one number in all elements, write `.fill(0)`"),
            );
        };
        let bound: Vec<Attempt<Ir>> = items.iter().map(|item| self.value(item)).collect();
        let values = bound.into_iter().collect::<Attempt<Vec<Ir>>>()?;
        for value in &values {
            self.check_stored(value);
        }
        Ok(values)
    }

    fn check_fits(&mut self, field: &Field, items: &[Ir], offset: usize, span: Span) -> Attempt<()> {
        let end = offset.saturating_add(items.len());
        let Some(n) = field.len().filter(|n| end > *n) else { return Ok(()) };
        self.refuse(
            Diagnostic::error(
                code::INDEX_RANGE,
                span,
                format!(
                    "{} from index {offset} on do not fit into `{}`",
                    count(items.len(), "number"),
                    field.path
                ),
            )
            .why(if field.owner.is_empty() {
                format!("it has {}", count(n, "element"))
            } else {
                field.owner.clone()
            })
            .help(format!("store at most {} from there", count(n.saturating_sub(offset), "number"))),
        )
    }

    /// A function of the host that is probably meant by a misspelt one.
    pub(super) fn closest_root(&self, name: &str) -> Option<String> {
        let roots = self.schema.root_names();
        closest(name, roots.iter().map(String::as_str)).map(str::to_owned)
    }
}

/// `1 argument`, `2 arguments`
fn count(n: usize, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}
