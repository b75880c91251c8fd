//! What the types pass knows of the parts of a text when it is done: what the lints look at. Parts of written methods, which
//! nobody wrote here, are left out.

use labspec_finding::order;
use std::collections::BTreeSet;

use crate::ir::{Index, Ir, IrKind};
use crate::operators::UnaryOp;
use crate::types::{FieldKey, Type};
use crate::value::Value;
use labspec_finding::Span;

/// What is known of a text, part by part.
#[derive(Default)]
pub(in crate::bind) struct TypedText {
    /// In the order of their places, once all are known; the last one of a place counts.
    pub(super) shapes: Vec<(Span, ExpressionShape)>,
    pub(super) idle: BTreeSet<Span>,
    /// Values that are needed for something.
    pub(in crate::bind) wants: Vec<(Span, Expectation, ExpressionShape)>,
}

/// What is known of a value.
#[derive(Clone)]
pub(in crate::bind) struct ExpressionShape {
    pub(in crate::bind) ty: Type,
    /// The value, where it is known.
    pub(in crate::bind) constant: Option<Value>,
    /// The element of a field of the host that it is.
    pub(in crate::bind) element: Option<(FieldKey, usize)>,
}

/// What a value is needed for.
pub(in crate::bind) enum Expectation {
    /// A number, by a function.
    Number(String),
    /// An angle, by a function.
    Angle(String),
    /// To be stored in an element of a field.
    Element(Option<(FieldKey, usize)>),
}

impl ExpressionShape {
    pub(super) fn of_ir(ir: &Ir) -> ExpressionShape {
        ExpressionShape { ty: ir.ty, constant: ir.as_constant().cloned(), element: element(ir) }
    }

    /// The value, where it is a known number.
    pub(in crate::bind) fn number(&self) -> Option<f64> {
        match self.constant {
            Some(Value::Number(x)) => Some(x),
            _ => None,
        }
    }
}

/// The element that a number is.
fn element(ir: &Ir) -> Option<(FieldKey, usize)> {
    match &ir.kind {
        IrKind::Load(view, Index::At(i)) => Some((view.field, view.first as usize + i)),
        IrKind::ToNumber(inner) | IrKind::Unary(UnaryOp::Minus, inner) => element(inner),
        _ => None,
    }
}

impl TypedText {
    /// All is known.
    pub(super) fn sort(&mut self) {
        order::sort_by_key(&mut self.shapes, |(span, _)| *span);
    }

    /// What is known of the expression at a place.
    pub(in crate::bind) fn shape(&self, span: Span) -> Option<&ExpressionShape> {
        let behind = self.shapes.partition_point(|(at, _)| *at <= span);
        let (at, shape) = self.shapes.get(behind.checked_sub(1)?)?;
        (*at == span).then_some(shape)
    }

    /// Whether the statement at a place does nothing.
    pub(in crate::bind) fn is_idle(&self, span: Span) -> bool {
        self.idle.contains(&span)
    }
}
