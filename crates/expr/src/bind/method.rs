//! Calls of methods: of arrays of the simulation, lists, texts and numbers.

use super::name::view_of;
use super::{Attempt, Binder, Receiver, Thing};
use crate::ast::{Expr, ExprKind};
use crate::ir::{Ir, Kind};
use crate::natives::{self, On, Row};
use crate::prelude;
use crate::rules;
use crate::schema::{Field, Type};
use crate::value::Value;
use crate::{Finding, Span};

impl<'a> Binder<'a> {
    /// Whether values of a type have a method.
    pub(super) fn is_method(&self, text: &str, ty: Type) -> bool {
        let calls = matches!(ty, Type::List | Type::View | Type::Any | Type::Never)
            && !prelude::arities(text).is_empty();
        let listed = match ty {
            Type::Any | Type::Never => natives::name(text).is_some(),
            _ => natives::name(text).is_some_and(|n| n.row_for(ty).is_some()),
        };
        // `toString` is a method of numbers only.
        calls || listed
    }

    /// The methods of values of a type.
    pub(super) fn method_names(&self, ty: Type) -> Vec<String> {
        let natives = natives::rows().filter(|row| row.on != On::Nothing).map(|row| row.name);
        let all = natives.chain(prelude::names()).chain(["length"]);
        all.filter(|name| *name == "length" || self.is_method(name, ty)).map(str::to_owned).collect()
    }

    /// `receiver.text(args)`
    pub(super) fn method(
        &mut self,
        receiver: Receiver,
        text: &str,
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<Ir> {
        if let Receiver::Field(field) = &receiver
            && let Some(ir) = self.field_method(field, text, args, span)?
        {
            return Ok(ir);
        }
        let changes =
            prelude::changes(text) || natives::name(text).is_some_and(|n| n.rows().any(|r| r.changes));
        if let (Receiver::Field(field), true) = (&receiver, changes) {
            self.check_assignable(field, span)?;
            self.write(view_of(field), None);
        }
        self.effects.stores_items |= changes;
        if let Some(function) = self.with_function(text, args, span)? {
            let first = match receiver {
                Receiver::Field(field) => Thing::Field(field),
                Receiver::Value(ir) => Thing::Value(ir),
            };
            return self.call_prelude(function, first, args, span);
        }
        let receiver = match receiver {
            Receiver::Field(field) => self.field_value(&field, span),
            Receiver::Value(ir) => ir,
        };
        let Some(name) = natives::name(text) else {
            let report = self.needs_function(text, span);
            return self.refuse(report);
        };
        let row = name.row_for(receiver.ty);
        self.check_arity(text, row.into_iter().chain(name.rows()).next(), args, span)?;
        let items = self.items(args)?;
        self.effects.can_throw = true;
        let same = name.rows().map(|r| r.returns).reduce(Type::or).unwrap_or(Type::Any);
        let ty = row.map_or(same, |row| row.returns);
        // A method that gives back what it was called on.
        let ty = match (text, ty) {
            ("fill" | "reverse" | "sort", Type::Any) => receiver.ty,
            ("subarray", _) => receiver.ty,
            ("at", _) if receiver.ty == Type::View => Type::Element,
            _ => ty,
        };
        Ok(Ir::new(Kind::Method(name, Box::new(receiver), items), ty, span))
    }

    /// The method of the prelude that is meant; none when it is called without a function.
    fn with_function(
        &mut self,
        text: &str,
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<Option<&'a crate::ast::Function>> {
        let arities = prelude::arities(text);
        if arities.is_empty() || natives::name(text).is_some() && args.is_empty() {
            return Ok(None);
        }
        if args.iter().any(|a| matches!(a.kind, ExprKind::Spread(_))) {
            return self.refuse(
                Finding::error(
                    rules::ARGUMENT_TYPE,
                    span,
                    format!("the arguments of `{text}` cannot be spread"),
                )
                .help(format!("write them out, as `.{text}(x => 2 * x)`")),
            );
        }
        match prelude::method(text, args.len()) {
            Some(function) => {
                let plain = matches!(
                    args.first().map(|a| &a.kind),
                    Some(
                        ExprKind::Number(_) | ExprKind::String(_) | ExprKind::Array(_) | ExprKind::Boolean(_)
                    )
                );
                if !plain {
                    return Ok(Some(function));
                }
                let report = self.needs_function(text, args.first().map_or(span, |a| a.span));
                self.refuse(report)
            }
            None => {
                let wanted = arities.iter().min().copied().unwrap_or(1);
                let report = Finding::error(
                    rules::ARGUMENT_COUNT,
                    span,
                    match args.len() {
                        0 => format!("`.{text}` needs a function"),
                        n => format!("`.{text}` does not take {n} arguments"),
                    },
                )
                .why("it is called for every element");
                self.refuse(match wanted {
                    1 if text.starts_with("reduce") => {
                        report.help(format!("write `.{text}((sum, x) => sum + x, 0)`"))
                    }
                    _ => report.help(format!("write `.{text}(x => 2 * x)`")),
                })
            }
        }
    }

    fn needs_function(&self, text: &str, span: Span) -> Finding {
        let example = match text {
            "reduce" | "reduceRight" => "(sum, x) => sum + x, 0",
            "sort" | "toSorted" => "(a, b) => a - b",
            "map" | "flatMap" | "forEach" | "Array.from" => "x => 2 * x",
            _ => "x => x > 0",
        };
        Finding::error(rules::ARGUMENT_TYPE, span, format!("`.{text}` needs a function"))
            .why("it is called for every element")
            .help(format!("write `.{text}({example})`"))
    }

    /// Checks how many arguments a function of the language gets.
    pub(super) fn check_arity(
        &mut self,
        text: &str,
        row: Option<&'static Row>,
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<()> {
        let Some(row) = row else { return Ok(()) };
        if args.iter().any(|a| matches!(a.kind, ExprKind::Spread(_))) {
            return Ok(());
        }
        if (row.least..=row.most).contains(&args.len()) {
            return Ok(());
        }
        self.only_check(args);
        let wanted = match (row.least, row.most) {
            (least, most) if least == most => super::call::count(least, "argument"),
            (least, usize::MAX) => format!("at least {}", super::call::count(least, "argument")),
            (least, most) => format!("{least} to {}", super::call::count(most, "argument")),
        };
        let point = if row.on == On::Nothing { "" } else { "." };
        self.refuse(
            Finding::error(
                rules::ARGUMENT_COUNT,
                span,
                format!("`{point}{text}` takes {wanted}, not {}", args.len()),
            )
            .why(format!("what it gives: {}", row.doc))
            .help(format!("an example: `{}` is `{}`", row.example.0, row.example.1)),
        )
    }

    /// `.fill` and `.set` of an array of the simulation, as far as they need no list.
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
                self.check_stored(&value);
                self.write(view, None);
                Kind::Fill(view, Box::new(value))
            }
            ("set", [Expr { kind: ExprKind::Array(items), .. }, rest @ ..])
                if rest.len() < 2 && !items.iter().any(|i| matches!(i.kind, ExprKind::Spread(_))) =>
            {
                let assignable = self.check_assignable(field, span);
                let offset = match rest.first() {
                    Some(offset) => {
                        let ir = self.operand(offset)?;
                        match ir.known() {
                            Some(Value::Number(x)) if *x >= 0.0 && x.fract() == 0.0 => *x as usize,
                            Some(_) => {
                                let report = Finding::error(
                                    rules::ARGUMENT_TYPE,
                                    offset.span,
                                    "the second argument of `.set` must be a whole number from 0 on",
                                )
                                .why("it is the index of the first element that is stored")
                                .help("write the number, as `.set([0, 0, 1], 7)`");
                                return self.refuse(report);
                            }
                            // Known only while running: the general method.
                            None => return Ok(None),
                        }
                    }
                    None => 0,
                };
                let bound: Vec<Attempt<Ir>> = items.iter().map(|item| self.operand(item)).collect();
                let values = bound.into_iter().collect::<Attempt<Vec<Ir>>>()?;
                for value in &values {
                    self.check_stored(value);
                }
                self.check_fits(field, values.len(), offset, span)?;
                assignable?;
                self.write(view, None);
                Kind::StoreAll(view, offset, values)
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
