//! Lists, records, templates, and destructuring declarations.

use super::binder::{Binder, Entity, VariableMeaning};
use super::facts::FactKind;
use crate::ast::{Element, Expr, ExprKind, Pattern, Property};
use crate::bind::names::names_of;
use crate::ir::{Ir, IrEntry, IrItem, IrKind, IrStatement};
use crate::operators::BinaryOp;
use crate::parse::{Attempt, Reported};
use crate::rules;
use crate::types::Type;
use labspec_finding::{Finding, Span};

impl<'a> Binder<'a> {
    /// Binds the items of a list, or arguments, with their spreads.
    pub(super) fn items(&mut self, items: &'a [Expr]) -> Attempt<Vec<IrItem>> {
        let mut bound = Vec::new();
        let mut failed = false;
        for item in items {
            let spread = match &item.kind {
                ExprKind::Spread(inner) => self.spread(inner),
                _ => self.value(item).map(|value| vec![IrItem { value, spread: false }]),
            };
            match spread {
                Ok(items) => bound.extend(items),
                Err(Reported) => failed = true,
            }
        }
        if failed { Err(Reported) } else { Ok(bound) }
    }

    /// Binds `...list`. A short array of known size is expanded.
    fn spread(&mut self, inner: &'a Expr) -> Attempt<Vec<IrItem>> {
        let entity = self.entity(inner)?;
        if let Entity::Field(field) = &entity
            && !field.is_scalar()
            && let Some(elements) = self.elements(field, inner.span)
        {
            return Ok(elements.into_iter().map(|value| IrItem { value, spread: false }).collect());
        }
        let value = self.value_of(entity, inner.span)?;
        self.expect_elements(&value)?;
        Ok(vec![IrItem { value, spread: true }])
    }

    /// Refuses a value that is not iterable.
    pub(super) fn expect_elements(&mut self, value: &Ir) -> Attempt<()> {
        if matches!(value.ty, Type::List | Type::View | Type::String | Type::Any | Type::Never) {
            return Ok(());
        }
        let text = self.text(value.span);
        let report = Finding::error(
            rules::NO_PARTS,
            value.span,
            format!("`{text}` is {}, so it has no elements to iterate over", value.ty.describe()),
        )
        .why("JavaScript stops the text here");
        self.refuse(match value.ty {
            Type::Number => report.help("to count, write `for (let i = 0; i < n; i++)`"),
            Type::Record => report.help(format!("write `Object.values({text})` for its values")),
            _ => report
                .help(format!("write a list, as `[1, 2, 3]`, or an array, as `{}`", self.host_terms().array)),
        })
    }

    /// Binds `[a, b]`.
    #[inline(never)]
    pub(super) fn list(&mut self, items: &'a [Expr], span: Span) -> Attempt<Ir> {
        let items = self.items(items)?;
        Ok(Ir::new(IrKind::List(items), Type::List, span))
    }

    /// Binds `{a: 1}`.
    #[inline(never)]
    pub(super) fn record(&mut self, properties: &'a [Property], span: Span) -> Attempt<Ir> {
        let mut entries = Vec::new();
        let mut failed = false;
        for property in properties {
            let entry = match property {
                Property::Named { key, value } => self
                    .check_internal_member(&key.text, key.span)
                    .and_then(|()| Ok(IrEntry::Named(key.text.as_str().into(), self.value(value)?))),
                Property::Computed { key, value } => {
                    let key = self.value(key);
                    let value = self.value(value);
                    key.and_then(|key| Ok(IrEntry::Computed(Ir::to_text(key, span), value?)))
                }
                Property::Spread(value) => self.value(value).map(IrEntry::Spread),
            };
            match entry {
                Ok(entry) => entries.push(entry),
                Err(Reported) => failed = true,
            }
        }
        if failed { Err(Reported) } else { Ok(Ir::new(IrKind::Record(entries), Type::Record, span)) }
    }

    /// Binds `` `text ${value}` ``.
    #[inline(never)]
    pub(super) fn template(&mut self, texts: &'a [String], values: &'a [Expr], span: Span) -> Attempt<Ir> {
        let text = |i: usize| texts.get(i).map_or("", String::as_str);
        let mut whole = Ir::constant(text(0).into(), span);
        let mut failed = false;
        for (i, value) in values.iter().enumerate() {
            match self.value(value) {
                Ok(ir) => {
                    let ir = Ir::to_text(ir, value.span);
                    whole = Ir::binary(BinaryOp::Add, whole, ir, span);
                    if !text(i + 1).is_empty() {
                        whole =
                            Ir::binary(BinaryOp::Add, whole, Ir::constant(text(i + 1).into(), span), span);
                    }
                }
                Err(Reported) => failed = true,
            }
        }
        if failed { Err(Reported) } else { Ok(whole) }
    }

    /// Destructures a value. The value has its own storage, so that it can be read repeatedly.
    pub(super) fn destructure_value(
        &mut self,
        pattern: &'a Pattern,
        whole: Ir,
        steps: &mut Vec<IrStatement>,
    ) {
        match pattern {
            Pattern::Name(name) => self.initialize(name, whole, steps),
            Pattern::List { items, span } => {
                if self.expect_elements(&whole).is_err() {
                    return self.mark_unbound(pattern);
                }
                // A value that is not known to be a list is converted to one, or refused, as in JavaScript.
                let whole = match (whole.ty, crate::natives::find_function("_parts")) {
                    (Type::List | Type::View, _) | (_, None) => whole,
                    (_, Some(function)) => {
                        let item = IrItem { value: whole, spread: false };
                        let parts = Ir::new(IrKind::Native(function, vec![item]), Type::List, *span);
                        self.store_in_temporary(parts, Span { start: span.end, ..*span }, steps)
                    }
                };
                for (i, item) in items.iter().enumerate() {
                    let Some(item) = item else { continue };
                    let ty = if whole.ty == Type::View { Type::Element } else { Type::Any };
                    let index = Box::new(Ir::number(i as f64, *span));
                    let part = Ir::new(IrKind::Element(Box::new(whole.clone()), index), ty, *span);
                    self.part(item, part, steps);
                }
            }
            Pattern::Record { entries, span } => {
                for (key, element) in entries {
                    let object = whole.clone();
                    match self.value_member(object, key, false, *span) {
                        Ok(entity) => match self.value_of(entity, key.span) {
                            Ok(part) => self.part(element, part, steps),
                            Err(Reported) => self.mark_unbound(&element.target),
                        },
                        Err(Reported) => self.mark_unbound(&element.target),
                    }
                }
            }
        }
    }

    /// Binds one element of a pattern, with its default.
    fn part(&mut self, element: &'a Element, part: Ir, steps: &mut Vec<IrStatement>) {
        let span = element.target.span();
        let mut value = part;
        if let Some(default) = &element.default {
            let Ok(default) = self.value(default) else { return self.mark_unbound(&element.target) };
            let place = self.store_in_temporary(value, span, steps);
            let test = Ir::binary(BinaryOp::StrictEqual, place.clone(), Ir::undefined(span), span);
            value = Ir::choice(test, default, place, span);
        }
        match &element.target {
            Pattern::Name(name) => self.initialize(name, value, steps),
            pattern => {
                let place = self.store_in_temporary(value, span, steps);
                self.destructure_value(pattern, place, steps);
            }
        }
    }

    /// Stores a value in an unnamed local variable.
    pub(super) fn store_in_temporary(&mut self, value: Ir, span: Span, steps: &mut Vec<IrStatement>) -> Ir {
        let key = self.key(span.start, FactKind::Part);
        self.facts.widen(key, value.ty);
        let (place, ty) = (self.new_local(key, false), self.facts.ty(key));
        steps.push(IrStatement::Declare(place, value));
        Ir::new(IrKind::Local(place), ty, span)
    }

    /// Marks the names of a pattern that could not be bound, so that their uses are not reported as further errors.
    pub(super) fn mark_unbound(&mut self, pattern: &'a Pattern) {
        names_of(pattern, &mut |name| self.mark_declared(name, VariableMeaning::Unknown));
    }

    /// Binds `const {kinetic, total} = lib.energy()`. The names are checked against the members of the function's result.
    pub(super) fn destructure(
        &mut self,
        pattern: &'a Pattern,
        value: &'a Expr,
        steps: &mut Vec<IrStatement>,
    ) {
        let Ok(entity) = self.entity(value) else { return self.mark_unbound(pattern) };
        // Parts of `model`, `data`, `ctx` or `Math` become aliases.
        if let (Pattern::Record { entries, .. }, Entity::Object(_) | Entity::Math | Entity::Globals) =
            (pattern, &entity)
        {
            for (key, element) in entries {
                let part = self.member_of(entity.clone(), value.span, key, false, key.span);
                match (part, &element.target) {
                    (Ok(part), Pattern::Name(name)) => self.initialize_part(name, part, key.span, steps),
                    (Ok(part), inner) => match self.value_of(part, key.span) {
                        Ok(ir) => {
                            let place = self.store_in_temporary(ir, inner.span(), steps);
                            self.destructure_value(inner, place, steps);
                        }
                        Err(Reported) => self.mark_unbound(inner),
                    },
                    (Err(Reported), inner) => self.mark_unbound(inner),
                }
            }
            return;
        }
        if let (Pattern::Record { entries, .. }, Entity::Value(ir)) = (pattern, &entity) {
            let values: Vec<Attempt<Ir>> = entries
                .iter()
                .filter(|_| ir.ty == Type::Record)
                .map(|(key, _)| self.record_member(ir.clone(), key, key.span))
                .collect();
            if values.iter().any(Result::is_err) {
                return self.mark_unbound(pattern);
            }
        }
        match self.value_of(entity, value.span) {
            Ok(ir) => {
                let place = self.store_in_temporary(ir, pattern.span(), steps);
                self.destructure_value(pattern, place, steps);
            }
            Err(Reported) => self.mark_unbound(pattern),
        }
    }

    fn initialize_part(
        &mut self,
        name: &'a crate::ast::Name,
        part: Entity,
        span: Span,
        steps: &mut Vec<IrStatement>,
    ) {
        match part {
            single @ Entity::Value(_) => match self.value_of(single, span) {
                Ok(ir) => self.initialize(name, ir, steps),
                Err(Reported) => self.mark_declared(name, VariableMeaning::Unknown),
            },
            Entity::Field(field) if field.is_scalar() => {
                let ir = self.load(&field, crate::ir::Index::At(0), span);
                self.initialize(name, ir, steps);
            }
            other => self.mark_declared(name, VariableMeaning::Alias(other)),
        }
    }
}
