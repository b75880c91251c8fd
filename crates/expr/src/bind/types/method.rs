//! Calls of methods: of arrays of the simulation, lists, strings and numbers.

use super::binder::{Binder, Entity, MethodReceiver};
use super::member::view_of;
use super::typed::Expectation;
use crate::ast::{Expr, ExprKind};
use crate::ir::{Ir, IrItem, IrKind};
use crate::natives::{self, Native, ReceiverKind};
use crate::parse::Attempt;
use crate::rules;
use crate::schema::Field;
use crate::source_functions::source_function;
use crate::tables::MethodId;
use crate::types::Type;
use crate::value::Value;
use labspec_finding::{Finding, Span};

/// A conversion of `ir` to a list, which is a run-time error if the value is not a list: `method` is a method of lists only.
fn listed(ir: Ir, method: &str) -> Ir {
    let Some(function) = natives::find_function("_list") else { return ir };
    let span = ir.span;
    let items = [ir, Ir::constant(method.into(), span)].map(|value| IrItem { value, spread: false });
    Ir::new(IrKind::Native(function, items.into()), Type::Any, span)
}

impl<'a> Binder<'a> {
    /// Whether values of a type have the method.
    pub(super) fn is_method(&self, text: &str, ty: Type) -> bool {
        natives::find_method(text).is_some_and(|n| n.rows_for(ty).next().is_some())
    }

    /// The names of the methods of a type.
    pub(super) fn method_names(&self, ty: Type) -> Vec<&'static str> {
        let names = natives::public_rows().map(|row| row.name).filter(|name| self.is_method(name, ty));
        names.chain(["length"]).collect()
    }

    /// Binds `receiver.name(args)`.
    pub(super) fn method(
        &mut self,
        receiver: MethodReceiver,
        name: MethodId,
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<Ir> {
        if let MethodReceiver::Field(field) = &receiver
            && let Some(ir) = self.field_method(field, name.text(), args, span)?
        {
            return Ok(ir);
        }
        let changes = name.rows().any(|row| row.changes);
        if let (MethodReceiver::Field(field), true) = (&receiver, changes) {
            self.check_assignable(field, span)?;
        }
        let ty = match &receiver {
            MethodReceiver::Field(_) => Type::View,
            MethodReceiver::Value(ir) => ir.ty,
        };
        let rows: Vec<&'static Native> = name.rows_for(ty).collect();
        let run = rows.iter().copied().filter(|row| !row.calls());
        let runs = run.clone().next().is_some();
        if let Some(row) = rows.iter().copied().find(|row| row.calls() && !(runs && args.is_empty())) {
            let function = self.source_function(row, args, span)?;
            let first = match receiver {
                MethodReceiver::Field(field) => Entity::Field(field),
                MethodReceiver::Value(ir) if matches!(ir.ty, Type::List | Type::View) => Entity::Value(ir),
                MethodReceiver::Value(ir) => Entity::Value(listed(ir, row.name)),
            };
            return self.inline_method(function, row, first, args, span);
        }
        let receiver = match receiver {
            MethodReceiver::Field(field) => self.field_value(&field, span),
            MethodReceiver::Value(ir) => ir,
        };
        self.check_arity(&rows, args, span)?;
        let items = self.items(args)?;
        let ty = run.map(|row| row.returns(ty)).reduce(Type::or).unwrap_or(Type::Any);
        Ok(Ir::new(IrKind::Method(name, Box::new(receiver), items), ty, span))
    }

    /// The method's definition in the language, if it has one for these arguments.
    fn source_function(
        &mut self,
        row: &'static Native,
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<&'a crate::ast::Function> {
        let (name, example) = (row.name, self.call_of(row));
        if args.iter().any(|a| matches!(a.kind, ExprKind::Spread(_))) {
            return self.refuse(
                Finding::error(
                    rules::ARGUMENT_TYPE,
                    span,
                    format!("the arguments of `{name}` cannot be spread"),
                )
                .help(format!("write them out, as `{example}`")),
            );
        }
        match source_function(row, args.len()) {
            Some(function) => Ok(function),
            None => self.refuse(
                Finding::error(
                    rules::ARGUMENT_COUNT,
                    span,
                    match args.len() {
                        0 => format!("`.{name}` needs a function"),
                        n => format!("`.{name}` does not take {n} arguments"),
                    },
                )
                .why("it is called for every element")
                .help(format!("write `{example}`")),
            ),
        }
    }

    /// The example of a method, from its name on: `.map(x => 2 * x)`.
    fn call_of(&self, row: &Native) -> String {
        let (example, _) = row.example("");
        let start = example.find(row.name).unwrap_or(0);
        let from = example.split_at(start).1;
        if row.on == ReceiverKind::Nothing { from.to_owned() } else { format!(".{from}") }
    }

    /// The finding for an argument that is not a function where a method requires one.
    pub(super) fn needs_function(&self, row: &Native, span: Span) -> Finding {
        let point = if row.on == ReceiverKind::Nothing { "" } else { "." };
        Finding::error(rules::ARGUMENT_TYPE, span, format!("`{point}{}` needs a function", row.name))
            .why("it is called for every element")
            .help(format!("write `{}`", self.call_of(row)))
    }

    /// Checks the number of arguments of a function of the language that one of these rows implements.
    pub(super) fn check_arity(
        &mut self,
        rows: &[&'static Native],
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<()> {
        let Some(row) = rows.first() else { return Ok(()) };
        let least = rows.iter().map(|row| row.arity().0).min().unwrap_or(0);
        let most = rows.iter().map(|row| row.arity().1).max().unwrap_or(0);
        let spread = args.iter().any(|a| matches!(a.kind, ExprKind::Spread(_)));
        if spread || (least..=most).contains(&args.len()) {
            return Ok(());
        }
        self.check_arguments(args);
        let expected = match (least, most) {
            _ if least == most => super::call::count(least, "argument"),
            (_, usize::MAX) => format!("at least {}", super::call::count(least, "argument")),
            _ => format!("{least} to {}", super::call::count(most, "argument")),
        };
        let point = if row.on == ReceiverKind::Nothing { "" } else { "." };
        let (example, value) = row.example(self.host_terms().array);
        self.refuse(
            Finding::error(
                rules::ARGUMENT_COUNT,
                span,
                format!("`{point}{}` takes {expected}, not {}", row.name, args.len()),
            )
            .why(format!("what it gives: {}", row.doc))
            .help(format!("an example: `{example}` is `{value}`")),
        )
    }

    /// Binds `.fill` and `.set` of an array of the simulation, if they need no list.
    fn field_method(
        &mut self,
        field: &Field,
        text: &str,
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<Option<Ir>> {
        let view = view_of(field);
        let kind = match (text, args) {
            ("fill", [value]) if !matches!(value.kind, ExprKind::Spread(_)) => {
                let assignable = self.check_assignable(field, span);
                let value = self.operand(value)?;
                assignable?;
                self.record_expectation(&value, value.span, Expectation::Element(None));
                IrKind::Fill(view, Box::new(value))
            }
            ("set", [Expr { kind: ExprKind::Array(items), .. }, rest @ ..])
                if rest.len() < 2 && !items.iter().any(|i| matches!(i.kind, ExprKind::Spread(_))) =>
            {
                let assignable = self.check_assignable(field, span);
                // The offset is known only at run time: the general method handles it.
                let Some(offset) = rest.first().map_or(Ok(Some(0)), |offset| self.known_offset(offset))?
                else {
                    return Ok(None);
                };
                let bound: Vec<Attempt<Ir>> = items.iter().map(|item| self.operand(item)).collect();
                let values = bound.into_iter().collect::<Attempt<Vec<Ir>>>()?;
                for value in &values {
                    self.record_expectation(value, value.span, Expectation::Element(None));
                }
                self.check_fits(field, values.len(), offset, span)?;
                assignable?;
                IrKind::StoreAll(view, offset, values)
            }
            ("set", [first, ..]) if matches!(first.kind, ExprKind::Number(_)) => {
                return self.refuse(
                    Finding::error(
                        rules::ARGUMENT_TYPE,
                        first.span,
                        "`.set` needs its numbers in square brackets",
                    )
                    .help(
                        "write `.set([0, 0, 1], 0)`; to store one number in all elements, write `.fill(0)`",
                    ),
                );
            }
            _ => return Ok(None),
        };
        Ok(Some(Ir::new(kind, Type::Void, span)))
    }

    /// The second argument of `.set`, if it is known.
    fn known_offset(&mut self, offset: &'a Expr) -> Attempt<Option<usize>> {
        let ir = self.operand(offset)?;
        match ir.as_constant() {
            Some(Value::Number(x)) if *x >= 0.0 && x.fract() == 0.0 => Ok(Some(*x as usize)),
            Some(_) => {
                let report = Finding::error(
                    rules::ARGUMENT_TYPE,
                    offset.span,
                    "the second argument of `.set` must be an integer from 0 on",
                )
                .why("it is the index of the first stored element")
                .help("write the number, as `.set([0, 0, 1], 7)`");
                self.refuse(report)
            }
            None => Ok(None),
        }
    }

    fn check_fits(&mut self, field: &Field, count: usize, offset: usize, span: Span) -> Attempt<()> {
        let end = offset.saturating_add(count);
        let Some(n) = field.len().filter(|n| end > *n) else { return Ok(()) };
        let numbers = |n| super::call::count(n, "number");
        self.refuse(
            Finding::error(
                rules::INDEX_RANGE,
                span,
                format!("{} from index {offset} on do not fit into `{}`", numbers(count), field.path),
            )
            .why(if field.owner.is_empty() {
                format!("it has {}", super::call::count(n, "element"))
            } else {
                field.owner.clone()
            })
            .help(format!("store at most {} from there", numbers(n.saturating_sub(offset)))),
        )
    }
}
