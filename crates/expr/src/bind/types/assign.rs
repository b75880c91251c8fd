//! Assignments: which targets are valid, and why others are not.

use super::access::{GlobalName, select_element};
use super::binder::{Binder, Entity, VariableMeaning};
use super::member::{internal_member, view_of};
use super::typed::Expectation;
use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp};
use crate::bind::names::INTERNAL_MEMBERS;
use crate::ir::{AssignmentTarget, Index, Ir, IrKind, UpdateResult};
use crate::parse::{Attempt, Reported};
use crate::rules;
use crate::schema::{Field, FieldKind};
use crate::types::Type;
use labspec_finding::{Finding, Span};

impl<'a> Binder<'a> {
    /// Binds `target = value` of a control with `set`.
    pub(super) fn set(&mut self, target: &'a Expr, given: Type) -> Attempt<Ir> {
        let place = self.place(target)?;
        let value = Ir::new(IrKind::Input, given, target.span);
        Ok(Ir::new(IrKind::Store(Box::new(place), None, Box::new(value)), given, target.span))
    }

    /// Binds an expression that changes something: an assignment, `++` or `--`.
    #[inline(never)]
    pub(super) fn changing(&mut self, expr: &'a Expr) -> Attempt<Ir> {
        let span = expr.span;
        match &expr.kind {
            ExprKind::Assign { target, op, value, .. } => self.assign(target, *op, value, span),
            ExprKind::AssignLogical { target, op, value, .. } => self.assign_if(target, *op, value, span),
            ExprKind::Update { target, increment, prefix } => self.update(target, *increment, *prefix, span),
            _ => self.value(expr),
        }
    }

    /// Binds `target = value` or `target op= value`. The result may be assigned again.
    pub(super) fn assign(
        &mut self,
        target: &'a Expr,
        op: Option<BinaryOp>,
        value: &'a Expr,
        span: Span,
    ) -> Attempt<Ir> {
        let place = self.place(target);
        let scalar = matches!(place, Ok(AssignmentTarget::Element(..)));
        let value = match &value.kind {
            ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } => self.changing(value),
            ExprKind::Array(_) if scalar => {
                let report = array_in_element(value.span);
                self.refuse(report)
            }
            _ if scalar || op.is_some_and(|op| op != BinaryOp::Add) => self.operand(value),
            _ => self.value(value),
        };
        let (place, value) = (place?, value?);
        self.check_kept(&place, &value)?;
        self.record_stored_expectation(&place, op, &value);
        let old = self.type_of_place(&place);
        let ty = match op {
            None => value.ty,
            Some(BinaryOp::Add) if old == Type::String || value.ty == Type::String => Type::String,
            Some(BinaryOp::Add) if old.is_plain() && value.is_plain() => Type::Number,
            Some(BinaryOp::Add) => Type::Any,
            Some(_) => Type::Number,
        };
        self.stored(target, &place, ty);
        Ok(Ir::new(IrKind::Store(Box::new(place), op, Box::new(value)), ty, span))
    }

    /// Binds `target ||= value`, `target &&= value` and `target ??= value`.
    fn assign_if(&mut self, target: &'a Expr, op: LogicalOp, value: &'a Expr, span: Span) -> Attempt<Ir> {
        let place = self.place(target);
        let value = if matches!(place, Ok(AssignmentTarget::Element(..))) {
            self.operand(value)
        } else {
            self.value(value)
        };
        let (place, value) = (place?, value?);
        self.check_kept(&place, &value)?;
        self.record_stored_expectation(&place, None, &value);
        let ty = self.type_of_place(&place).or(value.ty);
        self.stored(target, &place, ty);
        Ok(Ir::new(IrKind::StoreIf(op, Box::new(place), Box::new(value)), ty, span))
    }

    /// Binds `target++` and its variants.
    fn update(&mut self, target: &'a Expr, increment: bool, prefix: bool, span: Span) -> Attempt<Ir> {
        let place = self.place(target)?;
        self.stored(target, &place, Type::Number);
        let (step, gives) =
            (if increment { 1.0 } else { -1.0 }, if prefix { UpdateResult::New } else { UpdateResult::Old });
        Ok(Ir::new(IrKind::Update(Box::new(place), step, gives), Type::Number, span))
    }

    /// The type of the value that is stored in a target.
    fn type_of_place(&mut self, place: &AssignmentTarget) -> Type {
        match place {
            AssignmentTarget::Element(..) => Type::Element,
            AssignmentTarget::Local(id) => match self.keys.get(*id as usize) {
                Some(key) => self.facts.ty(*key),
                None => Type::Any,
            },
            _ => Type::Any,
        }
    }

    /// Records the type that is stored in a variable of the text.
    fn stored(&mut self, target: &Expr, place: &AssignmentTarget, ty: Type) {
        let (AssignmentTarget::Local(id), ExprKind::Name(_)) = (place, &target.kind) else { return };
        if let Some(key) = self.keys.get(*id as usize) {
            self.facts.widen(*key, ty);
        }
    }

    /// Refuses to store an array of the simulation in `ctx`: it would continue to change there.
    fn check_kept(&mut self, place: &AssignmentTarget, value: &Ir) -> Attempt<()> {
        let is_global = matches!(place, AssignmentTarget::Global(_) | AssignmentTarget::GlobalNamed(_));
        if !(is_global && value.ty == Type::View) {
            return Ok(());
        }
        let text = self.text(value.span);
        self.refuse(
            Finding::error(
                rules::WHOLE_ARRAY,
                value.span,
                format!("`{text}` is an array of the {}, but `ctx` stores values", self.host_terms().world),
            )
            .why("the stored array would keep changing, which is rarely intended")
            .help(format!("store a copy, as `{text}.slice()`, or a single element, as `{text}[0]`"))
            .guess(value.span.after(), ".slice()"),
        )
    }

    /// Binds the target of an assignment.
    fn place(&mut self, target: &'a Expr) -> Attempt<AssignmentTarget> {
        match &target.kind {
            ExprKind::Name(name) => self.named_place(name, target.span),
            ExprKind::Member { object, name, optional: false } => match self.entity(object)? {
                Entity::Globals => self.global_place(&name.text, target.span),
                Entity::Value(ir) => self.member_place(ir, name, target.span),
                entity => {
                    let entity = self.member_of(entity, object.span, name, false, target.span)?;
                    self.place_of(entity, target)
                }
            },
            ExprKind::Index { object, index, optional: false } => match self.entity(object) {
                Ok(Entity::Globals) => match self.global_name(index)? {
                    GlobalName::Constant(name) => self.global_place(&name, target.span),
                    GlobalName::Computed(name) => Ok(AssignmentTarget::GlobalNamed(name)),
                },
                Ok(Entity::Field(field)) => {
                    let checked = self.check_assignable(&field, target.span);
                    let index = self.index(&field, index, target.span)?;
                    checked?;
                    self.name_element(&field, &index, target.span);
                    Ok(AssignmentTarget::Element(view_of(&field), index))
                }
                Ok(Entity::Value(ir)) if ir.ty.may_have_parts() => {
                    let index = self.value(index)?;
                    Ok(AssignmentTarget::Item(ir, index))
                }
                Ok(entity) => {
                    let report = match entity {
                        Entity::Value(ref ir) if !matches!(ir.kind, IrKind::Load(..)) => {
                            self.not_a_place(target)
                        }
                        other => self.not_indexable(&other, object, index, target.span),
                    };
                    self.refuse(report)
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

    /// Binds the target `value.name`.
    fn member_place(&mut self, ir: Ir, name: &crate::ast::Name, span: Span) -> Attempt<AssignmentTarget> {
        if INTERNAL_MEMBERS.contains(&name.text.as_str()) {
            return self.refuse(internal_member(&name.text, name.span));
        }
        if matches!(ir.ty, Type::Record | Type::Any | Type::Never | Type::List) {
            return Ok(AssignmentTarget::Member(ir, name.text.as_str().into()));
        }
        let message =
            format!("`{}` is {}, so it has no members to assign", self.text(ir.span), ir.ty.describe());
        self.refuse(
            Finding::error(rules::NOT_ASSIGNABLE, span, message)
                .help("assign a member of a record, or a variable, as `ctx.peak`"),
        )
    }

    fn global_place(&mut self, name: &str, span: Span) -> Attempt<AssignmentTarget> {
        self.check_internal_member(name, span)?;
        let slot = self.globals.mention(name, self.program, span, true);
        Ok(AssignmentTarget::Global(slot))
    }

    /// Binds a plain name as a target.
    fn named_place(&mut self, name: &str, span: Span) -> Attempt<AssignmentTarget> {
        if let Some(variable) = self.variable(name, span)? {
            return match variable.meaning {
                VariableMeaning::Unknown if variable.ready => Err(Reported),
                _ => {
                    self.capture(&variable);
                    Ok(AssignmentTarget::Local(variable.id))
                }
            };
        }
        let entity = self.root(name, span)?;
        let expr = Expr { kind: ExprKind::Name(name.to_owned()), span };
        self.place_of(entity, &expr)
    }

    /// Binds an entity, named directly or as a member, as a target.
    fn place_of(&mut self, entity: Entity, target: &Expr) -> Attempt<AssignmentTarget> {
        match entity {
            Entity::Field(field) => {
                self.check_assignable(&field, target.span)?;
                if field.is_scalar() {
                    return Ok(AssignmentTarget::Element(view_of(&field), Index::At(0)));
                }
                let text = self.text(target.span).to_owned();
                self.refuse(
                    Finding::error(rules::ASSIGN_ARRAY, target.span, format!("`{}` is an array and cannot be replaced as a whole", field.path))
                        .why(format!("its elements are the memory of the {}; assigning the name would change none of them", self.host_terms().world))
                        .help(match field.len() {
                            Some(1) => format!("name its only element, `{text}[0]`"),
                            Some(n @ 2..) => format!("{}; a statement such as `{text}.fill(…)` or `{text}.set([…], 0)` changes all of them", select_element(&text, n)),
                            _ => format!("name an element, as `{text}[0]`; a statement such as `{text}.fill(…)` or `{text}.set([…], 0)` changes all of them"),
                        }),
                )
            }
            _ => {
                let report = self.not_a_place(target);
                self.refuse(report)
            }
        }
    }

    fn not_a_place(&self, target: &Expr) -> Finding {
        let text = self.text(target.span);
        let report =
            Finding::error(rules::NOT_ASSIGNABLE, target.span, format!("`{text}` cannot hold a value"));
        match &target.kind {
            ExprKind::Number(_) | ExprKind::String(_) | ExprKind::Boolean(_) | ExprKind::Null => report
                .why("it is a fixed value")
                .help("write the field on the left of `=` and the value on the right"),
            ExprKind::Call { .. } => {
                report.why("a call returns a value; it is not a place to store one").help(format!(
                    "name a field or a `ctx` variable, or write the call as a statement, in {}",
                    self.host_terms().statements
                ))
            }
            ExprKind::Logical { .. } | ExprKind::Conditional { .. } => report
                .why("`=` binds less tightly than the operators before it")
                .help("to compare, write `===`; to assign, put the assignment into a statement of its own"),
            ExprKind::Binary { .. } | ExprKind::Unary { .. } => report
                .why("it is a computation")
                .help("write the field on the left of `=` and the computation on the right"),
            _ => {
                let (array, lab) = (self.host_terms().array, self.host_terms().lab);
                report.help(format!(
                    "assign a field, as `{array}[0]`, or a variable of the {lab}, as `ctx.peak`"
                ))
            }
        }
    }

    /// Checks whether the kind of a field allows assignment.
    pub(super) fn check_assignable(&mut self, field: &Field, span: Span) -> Attempt<()> {
        match &field.kind {
            FieldKind::State | FieldKind::Input | FieldKind::Constant | FieldKind::Inertial => Ok(()),
            FieldKind::Structure => self.refuse(
                Finding::error(
                    rules::ASSIGN_STRUCTURE,
                    span,
                    format!("`{}` is fixed with the {}", field.path, self.host_terms().model),
                )
                .why(match &*field.doc {
                    "" => "the positions of other fields depend on it".to_owned(),
                    doc => format!("it is {doc}; the positions of other fields depend on it"),
                })
                .help(format!("change the {} itself", self.host_terms().model)),
            ),
            FieldKind::Derived { by } => {
                let computed =
                    if by.is_empty() { "computed".to_owned() } else { format!("computed by {by}") };
                let report = Finding::error(
                    rules::ASSIGN_DERIVED,
                    span,
                    format!("`{}` is {computed}, so it cannot be set", field.path),
                )
                .why("the next computation overwrites a stored value");
                self.refuse(match self.schema.refresh() {
                    Some(refresh) => {
                        report.help(format!("set the state that it depends on, then call `{refresh}`"))
                    }
                    None => report.help("set the values that it is computed from"),
                })
            }
        }
    }

    /// Records for the lints that a number is expected here.
    fn record_stored_expectation(&mut self, place: &AssignmentTarget, op: Option<BinaryOp>, value: &Ir) {
        let element = match (place, op) {
            (AssignmentTarget::Element(view, Index::At(i)), None) => {
                Some((view.field, view.first as usize + i))
            }
            (AssignmentTarget::Element(..), _) => None,
            (_, Some(op)) if op != BinaryOp::Add => None,
            _ => return,
        };
        self.record_expectation(value, value.span, Expectation::Element(element));
    }
}

fn array_in_element(span: Span) -> Finding {
    Finding::error(rules::ASSIGN_ARRAY, span, "an array cannot be stored in one element")
        .why("an element is a single number")
        .help("store several numbers with `.set([…], offset)`")
}
