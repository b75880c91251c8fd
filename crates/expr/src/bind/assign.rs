//! Assignments: what may stand on the left, and why not what may not.

use super::name::{is_language, view_of};
use super::{Attempt, Binder, Meaning, Reported, Thing};
use crate::ast::{BinaryOp, Expr, ExprKind};
use crate::code;
use crate::diagnostic::{Diagnostic, Span};
use crate::ir::{Index, Ir, Kind, Place};
use crate::schema::{Field, FieldKind, Type};
use crate::value::Value;

impl Binder<'_> {
    /// `target = value` of a control that sets.
    pub(super) fn set(&mut self, target: &Expr, given: Type) -> Attempt<Ir> {
        let place = self.place(target, false)?;
        self.effects.uses_value = true;
        let value = Ir::new(Kind::Input, given, target.span);
        Ok(Ir::new(Kind::Store(Box::new(place), None, Box::new(value)), given, target.span))
    }

    /// `target = value` or `target op= value` as a statement; its value may be assigned further.
    pub(super) fn assign(
        &mut self,
        target: &Expr,
        op: Option<BinaryOp>,
        value: &Expr,
        span: Span,
    ) -> Attempt<Ir> {
        let place = self.place(target, op.is_some());
        let value = match &value.kind {
            ExprKind::Assign { target, op, value, .. } => self.assign(target, *op, value, span),
            ExprKind::Array(_) if matches!(place, Ok(Place::Element(..))) => {
                let report = array_in_element(value.span);
                self.refuse(report)
            }
            _ => self.value(value),
        };
        let (place, value) = (place?, value?);
        self.check_stored_in(&place, op, &value);
        let ty = match (op, &place) {
            (None, _) => value.ty,
            (Some(BinaryOp::Add), Place::Element(..)) if value.never_text() => Type::Number,
            (Some(BinaryOp::Add), _) if value.ty == Type::String => Type::String,
            (Some(BinaryOp::Add), _) => Type::Any,
            (Some(_), _) => Type::Number,
        };
        Ok(Ir::new(Kind::Store(Box::new(place), op, Box::new(value)), ty, span))
    }

    /// `target++` and its like. Adding is subtracting -1, which also turns text into a number, as `++` does.
    pub(super) fn update(&mut self, target: &Expr, increment: bool, span: Span) -> Attempt<Ir> {
        let place = self.place(target, true)?;
        let step = Ir::constant(Value::Number(if increment { -1.0 } else { 1.0 }), span);
        Ok(Ir::new(
            Kind::Store(Box::new(place), Some(BinaryOp::Subtract), Box::new(step)),
            Type::Number,
            span,
        ))
    }

    /// What can be assigned to. `reads`: a compound assignment also reads it.
    fn place(&mut self, target: &Expr, reads: bool) -> Attempt<Place> {
        match &target.kind {
            ExprKind::Name(name) => self.named_place(name, target.span, reads),
            ExprKind::Member { object, name } if self.is_globals(object) => {
                self.global_place(&name.text, target.span, reads)
            }
            ExprKind::Index { object, index } if self.is_globals(object) => {
                let name = self.global_name(index)?;
                self.global_place(&name, target.span, reads)
            }
            ExprKind::Member { .. } => {
                let thing = self.thing(target)?;
                self.place_of(thing, target, reads)
            }
            ExprKind::Index { object, index } => match self.thing(object) {
                Ok(Thing::Field(field)) => {
                    let checked = self.check_assignable(&field, target.span);
                    let index = self.index(&field, index, target.span)?;
                    checked?;
                    Ok(self.element_place(&field, index, reads))
                }
                Ok(_) => {
                    let thing = self.thing(target)?;
                    self.place_of(thing, target, reads)
                }
                Err(Reported) => {
                    let _ = self.value(index);
                    Err(Reported)
                }
            },
            ExprKind::Error => Err(Reported),
            _ => {
                let report = self.not_a_place(target);
                self.refuse(report)
            }
        }
    }

    fn is_globals(&mut self, object: &Expr) -> bool {
        matches!(&object.kind, ExprKind::Name(name) if name == "ctx" && !self.locals.iter().any(|l| l.name == "ctx"))
    }

    fn global_place(&mut self, name: &str, span: Span, reads: bool) -> Attempt<Place> {
        self.check_machinery(name, span)?;
        let slot = self.globals.mention(name, self.program, span, true);
        self.effects.write_global(slot);
        if reads {
            self.effects.read_global(slot);
        }
        Ok(Place::Global(slot))
    }

    fn element_place(&mut self, field: &Field, index: Index, reads: bool) -> Place {
        let view = view_of(field);
        self.write(view, Some(&index));
        if reads {
            self.read(view, Some(&index));
        }
        Place::Element(view, index)
    }

    /// A plain name on the left.
    fn named_place(&mut self, name: &str, span: Span, reads: bool) -> Attempt<Place> {
        let local = self.locals.iter().rev().find(|l| l.name == name).cloned();
        if let Some(local) = local {
            return match local.meaning {
                Meaning::Unknown => Err(Reported),
                _ if local.constant => self.refuse(
                    Diagnostic::error(code::ASSIGN_CONST, span, format!("`{name}` is declared with `const`"))
                        .why("a `const` name keeps its first value; JavaScript stops the program here")
                        .help(format!("declare it with `let {name}`, or use another name")),
                ),
                Meaning::Slot(slot, _) => Ok(Place::Local(slot)),
                Meaning::Alias(_) => self.refuse(
                    Diagnostic::error(
                        code::NOT_ASSIGNABLE,
                        span,
                        format!("`{name}` stands for a part of the simulation"),
                    )
                    .help("assign one of its elements or fields, or use another name"),
                ),
            };
        }
        if self.schema.root(name).is_none() && !is_language(name) {
            let report = self.undeclared(name, span);
            return self.refuse(report);
        }
        if is_language(name) {
            let report =
                Diagnostic::error(code::NOT_ASSIGNABLE, span, format!("`{name}` cannot be assigned"));
            return self.refuse(match name {
                "ctx" => report
                    .why("it holds the variables of the lab")
                    .help("assign a variable, as `ctx.peak = 0`"),
                "value" => report
                    .why("it is what the control gives")
                    .help("use another name, as `const x = value / 2`"),
                _ => report.why("it means the same everywhere").help("use another name"),
            });
        }
        let expr = Expr { kind: ExprKind::Name(name.to_owned()), span };
        let thing = self.thing(&expr)?;
        self.place_of(thing, &expr, reads)
    }

    fn undeclared(&self, name: &str, span: Span) -> Diagnostic {
        if self.declared_later.iter().any(|n| n == name) {
            return Diagnostic::error(
                code::USED_TOO_EARLY,
                span,
                format!("`{name}` is assigned before its declaration"),
            )
            .help(format!("move the declaration of `{name}` up"));
        }
        let report = Diagnostic::error(code::UNKNOWN_NAME, span, format!("`{name}` is not declared"))
            .why("an assignment without a declaration would make a variable of the whole page");
        match self.closest_root(name) {
            Some(meant) => report.help(format!("did you mean `{meant}`?")).fix(span, meant),
            None => report.help(format!(
                "write `const {name} = …` for this text only, or `ctx.{name} = …` to keep it in the lab"
            )),
        }
    }

    /// A thing behind a name or a point on the left.
    fn place_of(&mut self, thing: Thing, target: &Expr, reads: bool) -> Attempt<Place> {
        match thing {
            Thing::Field(field) => {
                self.check_assignable(&field, target.span)?;
                if field.is_scalar() {
                    return Ok(self.element_place(&field, Index::At(0), reads));
                }
                let text = self.text(target.span).to_owned();
                self.refuse(
                    Diagnostic::error(code::ASSIGN_ARRAY, target.span, format!("`{}` is an array and cannot be replaced as a whole", field.path))
                        .why("its elements are the memory of the simulation; an assignment to the name would change none of them")
                        .help(format!("assign an element, as `{text}[0] = …`, or all of them with `{text}.fill(…)` or `{text}.set([…], 0)`")),
                )
            }
            _ => {
                let report = self.not_a_place(target);
                self.refuse(report)
            }
        }
    }

    fn not_a_place(&self, target: &Expr) -> Diagnostic {
        let text = self.text(target.span);
        let report =
            Diagnostic::error(code::NOT_ASSIGNABLE, target.span, format!("`{text}` cannot hold a value"));
        match &target.kind {
            ExprKind::Number(_) | ExprKind::String(_) | ExprKind::Boolean(_) | ExprKind::Null => report
                .why("it is a fixed value")
                .help("write the field on the left of `=` and the value on the right"),
            ExprKind::Call { .. } => report
                .why("a call gives a value; it is not a place to store one")
                .help("assign a field or a `ctx` variable"),
            ExprKind::Logical { .. } | ExprKind::Conditional { .. } => report
                .why("`=` binds less tightly than what stands before it")
                .help("to compare, write `===`; to assign, put the assignment into a statement of its own"),
            ExprKind::Binary { .. } | ExprKind::Unary { .. } => report
                .why("it is a computation")
                .help("write the field on the left of `=` and the computation on the right"),
            _ => report.help("assign a field, as `data.qpos[0]`, or a variable of the lab, as `ctx.peak`"),
        }
    }

    /// Whether the kind of a field allows assigning.
    pub(super) fn check_assignable(&mut self, field: &Field, span: Span) -> Attempt<()> {
        match &field.kind {
            FieldKind::State | FieldKind::Input | FieldKind::Constant | FieldKind::Inertial => Ok(()),
            FieldKind::Structure => self.refuse(
                Diagnostic::error(
                    code::ASSIGN_STRUCTURE,
                    span,
                    format!("`{}` is fixed when the model is compiled", field.path),
                )
                .why(format!("it is {}; the engine finds its way in memory by it", doc(field)))
                .help("change the model itself"),
            ),
            FieldKind::Derived { by } => {
                let computed =
                    if by.is_empty() { "computed".to_owned() } else { format!("computed by {by}") };
                let report = Diagnostic::error(
                    code::ASSIGN_DERIVED,
                    span,
                    format!("`{}` is {computed}; it cannot be set", field.path),
                )
                .why("whatever is stored there is overwritten by the next computation");
                self.refuse(match self.schema.refresh() {
                    Some(refresh) => {
                        report.help(format!("set the state that it follows from, then call `{refresh}`"))
                    }
                    None => report.help("set what it is computed from"),
                })
            }
        }
    }

    fn check_stored_in(&mut self, place: &Place, op: Option<BinaryOp>, value: &Ir) {
        if matches!(place, Place::Element(..)) || op.is_some_and(|op| op != BinaryOp::Add) {
            self.check_stored(value);
        }
    }

    /// Warns of text that is stored where numbers live.
    pub(super) fn check_stored(&mut self, value: &Ir) {
        if value.ty != Type::String {
            return;
        }
        let report = Diagnostic::warning(
            code::STRING_AS_NUMBER,
            value.span,
            "a string is stored where a number belongs",
        );
        let report = match value.known().map(Value::to_number) {
            Some(x) if x.is_nan() => {
                report.why("JavaScript stores NaN, and the simulation breaks").help("write the number")
            }
            Some(x) => {
                let meant = crate::number::to_text(x);
                report
                    .why("JavaScript stores the number in it")
                    .help(format!("write `{meant}`"))
                    .fix(value.span, meant)
            }
            None => report
                .why("JavaScript stores the number in it, or NaN when there is none")
                .help("write `+text` if that is meant"),
        };
        self.report(report);
    }
}

fn array_in_element(span: Span) -> Diagnostic {
    Diagnostic::error(code::ASSIGN_ARRAY, span, "an array cannot be stored in one element")
        .why("an element is one number")
        .help("store several numbers with `.set([…], offset)`")
}

/// What a field is, for the middle of a sentence.
fn doc(field: &Field) -> &str {
    if field.doc.is_empty() { "a size, a type or an address" } else { &field.doc }
}
