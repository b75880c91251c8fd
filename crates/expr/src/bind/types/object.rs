//! Members of values, and of objects whose name is computed at run time.

use labspec_finding::order;
use std::sync::Arc;

use super::binder::{Binder, Entity, MethodReceiver};
use super::member::{internal_member, view_of};
use crate::ast::{Expr, ExprKind, Name};
use crate::bind::names::{INTERNAL_MEMBERS, NameMeaning, list_names};
use crate::ir::{Index, Ir, IrKind};
use crate::natives;
use crate::parse::Attempt;
use crate::rules;
use crate::schema::{Entry, Field, Param};
use crate::tables::MemberTable;
use crate::types::{CollectionId, Type};
use crate::value::{Value, View};
use labspec_finding::{Finding, Span, nearest};

/// The maximum number of elements to which the spread of an array of the simulation is expanded.
const MAX_WRITTEN_OUT: usize = 64;

impl<'a> Binder<'a> {
    /// Binds `value.name`.
    pub(super) fn value_member(
        &mut self,
        ir: Ir,
        name: &Name,
        optional: bool,
        span: Span,
    ) -> Attempt<Entity> {
        let text = name.text.as_str();
        if INTERNAL_MEMBERS.contains(&text) {
            return self.refuse(internal_member(text, name.span));
        }
        let ir = if optional { self.present(ir) } else { ir };
        if let Some(method) = natives::find_method(text).filter(|_| self.is_method(text, ir.ty)) {
            return Ok(Entity::Method(Box::new(MethodReceiver::Value(ir)), method));
        }
        match ir.ty {
            Type::List | Type::View | Type::String if text == "length" => {
                Ok(Entity::Value(match self.known_length(&ir).filter(|_| has_no_effect(&ir)) {
                    Some(n) => Ir::number(n as f64, span),
                    None => Ir::new(IrKind::Member(Box::new(ir), text.into()), Type::Number, span),
                }))
            }
            Type::Record => self.record_member(ir, name, span).map(Entity::Value),
            Type::Any | Type::Never => {
                Ok(Entity::Value(Ir::new(IrKind::Member(Box::new(ir), text.into()), Type::Any, span)))
            }
            _ if optional => {
                Ok(Entity::Value(Ir::new(IrKind::Member(Box::new(ir), text.into()), Type::Any, span)))
            }
            ty => {
                let report = self.no_member(ty, name, span, ir.span);
                self.refuse(report)
            }
        }
    }

    /// Binds a member of a record. The name is checked if the function that creates the record is known.
    pub(super) fn record_member(&mut self, ir: Ir, name: &Name, span: Span) -> Attempt<Ir> {
        let mut ty = Type::Any;
        if let IrKind::Call(id, _) = &ir.kind {
            let info = self.schema.function(*id);
            match info.members.iter().find(|(member, _)| *member == name.text) {
                Some((_, found)) => ty = *found,
                None if info.members.is_empty() => {}
                None => {
                    let names: Vec<String> = info.members.iter().map(|(n, _)| n.clone()).collect();
                    let report = Finding::error(
                        rules::UNKNOWN_FIELD,
                        name.span,
                        format!("the result of `{}` has no `{}`", info.name, name.text),
                    )
                    .why(format!("it has {}", list_names(&names)));
                    return self.refuse(match nearest(&name.text, names.iter().map(String::as_str)) {
                        Some(meant) => {
                            report.help(format!("did you mean `{meant}`?")).guess(name.span, meant)
                        }
                        None => report.help("use one of them"),
                    });
                }
            }
        }
        Ok(Ir::new(IrKind::Member(Box::new(ir), name.text.as_str().into()), ty, span))
    }

    /// The finding for a member that the value does not have.
    fn no_member(&self, ty: Type, name: &Name, span: Span, object: Span) -> Finding {
        let text = name.text.as_str();
        let what = self.text(object);
        let message = if what == ty.describe() {
            format!("`{what}` has no member `{text}`")
        } else {
            format!("`{what}` is {}, so it has no member `{text}`", ty.describe())
        };
        let report = Finding::error(rules::UNKNOWN_FIELD, name.span, message);
        let xyz = ["x", "y", "z"].iter().position(|n| *n == text);
        match (ty, xyz) {
            (Type::List | Type::View, Some(i)) => {
                let meant = format!("{what}[{i}]");
                report.why("an index selects elements").help(format!("write `{meant}`")).fix(span, meant)
            }
            _ => match nearest(text, self.method_names(ty)) {
                Some(meant) => report.help(format!("did you mean `{meant}`?")).guess(name.span, meant),
                None if matches!(ty, Type::Undefined | Type::Null) => {
                    report.why("JavaScript stops the text here").help("test for it first, or write `?.`")
                }
                None => report.help(format!("remove `.{text}`")),
            },
        }
    }

    /// Binds the operand of `?.`.
    pub(super) fn present(&mut self, ir: Ir) -> Ir {
        let (ty, span) = (ir.ty, ir.span);
        let ty = if ty == Type::Element { Type::Number } else { ty };
        Ir::new(IrKind::Present(Box::new(ir)), ty, span)
    }

    /// The number of elements of a list literal, or of the result of a function with a known size.
    pub(super) fn known_length(&self, ir: &Ir) -> Option<usize> {
        match &ir.kind {
            IrKind::List(items) if items.iter().all(|i| !i.spread) => Some(items.len()),
            IrKind::Call(id, _) => self.schema.function(*id).length,
            IrKind::Constant(Value::View(view)) => view.count(),
            IrKind::Constant(Value::String(text)) => Some(text.encode_utf16().count()),
            _ => None,
        }
    }

    /// The field whose elements a call such as `lib.bodyPos('cube')` returns, used when only one element is read.
    pub(super) fn call_as_field(&mut self, object: &'a Expr) -> Option<Field> {
        let ExprKind::Call { callee, args, optional: false } = &object.kind else { return None };
        let ExprKind::Member { object: holder, name, .. } = &callee.kind else { return None };
        let ExprKind::Name(root) = &holder.kind else { return None };
        let [Expr { kind: ExprKind::String(chosen), .. }] = args.as_slice() else { return None };
        if self.names.at(holder.span.start) != NameMeaning::Outside {
            return None;
        }
        let Some(Entry::Object(holder)) = self.schema.root(root) else { return None };
        let Some(Entry::Function(id)) = self.schema.member(holder, &name.text) else { return None };
        let info = self.schema.function(id);
        let [Param::Name(collection)] = info.params.as_slice() else { return None };
        let object = self.schema.lookup(*collection, chosen)?;
        self.schema.result_field(id, object)
    }

    /// Binds a member of an object whose name is known only at run time: a table with that member of all objects, by name.
    pub(super) fn computed_member(
        &mut self,
        id: CollectionId,
        chosen: Ir,
        name: &Name,
        span: Span,
    ) -> Attempt<Entity> {
        let noun = self.schema.noun(id).to_owned();
        let names = self.schema.names(id);
        let mut members: Vec<(Arc<str>, Value)> = Vec::new();
        let mut scalar = false;
        let mut fields = Vec::new();
        for object_name in &names {
            let entry = self.schema.lookup(id, object_name).and_then(|o| self.schema.member(o, &name.text));
            match entry {
                Some(Entry::Field(field)) => {
                    scalar |= field.is_scalar();
                    members.push((object_name.as_str().into(), Value::View(view_of(&field))));
                    fields.push(field);
                }
                Some(Entry::Constant(value)) => members.push((object_name.as_str().into(), value)),
                _ => {}
            }
        }
        if members.is_empty() {
            // All objects of a collection have the same members, so the first one is used for the message.
            let object = names.first().and_then(|n| self.schema.lookup(id, n));
            let report = match object {
                Some(object) => self.unknown_member(object, name, span),
                None => Finding::error(
                    rules::UNKNOWN_FIELD,
                    name.span,
                    format!("no {noun} has a `{}`", name.text),
                ),
            };
            return self.refuse(report);
        }
        for field in &fields {
            if !scalar {
                self.show(field);
            }
        }
        order::sort_by(&mut members, |a, b| a.0.cmp(&b.0));
        members.dedup_by(|a, b| a.0 == b.0);
        let ty = match members.first() {
            Some((_, Value::View(_))) if scalar => Type::Number,
            Some((_, value)) => value.type_of(),
            None => Type::Any,
        };
        let picks = MemberTable { noun, members, scalar };
        Ok(Entity::Value(Ir::new(IrKind::Pick(picks.into(), Box::new(chosen)), ty, span)))
    }

    /// An array of the simulation as a value.
    pub(super) fn field_value(&mut self, field: &Field, span: Span) -> Ir {
        let view = self.show(field);
        Ir::constant(Value::View(view), span)
    }

    /// Records that an array is used as a value.
    pub(super) fn show(&mut self, field: &Field) -> View {
        let view = view_of(field);
        let exposed =
            crate::tables::ExposedView { view, elem: field.elem, assignable: field.is_assignable() };
        if !self.tree.views.contains(&exposed) {
            self.tree.views.push(exposed);
        }
        view
    }

    /// All elements of an array of known size as separate values, or `None` if there are too many.
    pub(super) fn elements(&mut self, field: &Field, span: Span) -> Option<Vec<Ir>> {
        let n = field.len().filter(|n| *n <= MAX_WRITTEN_OUT)?;
        Some((0..n).map(|i| self.load(field, Index::At(i), span)).collect())
    }
}

/// Whether evaluating the expression has no effect, so that it can be removed.
fn has_no_effect(ir: &Ir) -> bool {
    match &ir.kind {
        IrKind::Constant(_) | IrKind::Global(_) => true,
        IrKind::List(items) => items.iter().all(|i| !i.spread && has_no_effect(&i.value)),
        _ => false,
    }
}
