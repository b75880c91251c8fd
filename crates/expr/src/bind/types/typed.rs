//! The types of the parts of a text, as the lints need them. Parts of methods that are written in the language are not
//! included, because the author did not write them.

use labspec_finding::order;
use std::collections::BTreeSet;

use crate::ir::{Index, Ir, IrKind};
use crate::operators::UnaryOp;
use crate::types::{FieldKey, Type};
use crate::value::Value;
use labspec_finding::Span;

/// The types of the parts of a text.
#[derive(Default)]
pub(in crate::bind) struct TypedText {
    /// Sorted by span when complete. If a span occurs several times, the last entry counts.
    pub(super) shapes: Vec<(Span, ExpressionShape)>,
    pub(super) idle: BTreeSet<Span>,
    /// Values of which something is expected.
    pub(in crate::bind) expectations: Vec<(Span, Expectation, ExpressionShape)>,
}

/// The known properties of a value.
#[derive(Clone)]
pub(in crate::bind) struct ExpressionShape {
    pub(in crate::bind) ty: Type,
    /// The value, if it is constant.
    pub(in crate::bind) constant: Option<Value>,
    /// The element of a field of the host, if the value is one.
    pub(in crate::bind) element: Option<(FieldKey, usize)>,
}

/// What is expected of a value.
pub(in crate::bind) enum Expectation {
    /// A number, expected by a function.
    Number(String),
    /// An angle, expected by a function.
    Angle(String),
    /// A number to be stored in an element of a field.
    Element(Option<(FieldKey, usize)>),
}

impl ExpressionShape {
    pub(super) fn of_ir(ir: &Ir) -> ExpressionShape {
        ExpressionShape { ty: ir.ty, constant: ir.as_constant().cloned(), element: element(ir) }
    }

    /// The value, if it is a constant number.
    pub(in crate::bind) fn number(&self) -> Option<f64> {
        match self.constant {
            Some(Value::Number(x)) => Some(x),
            _ => None,
        }
    }
}

/// The element of a field that a number is loaded from.
fn element(ir: &Ir) -> Option<(FieldKey, usize)> {
    match &ir.kind {
        IrKind::Load(view, Index::At(i)) => Some((view.field, view.first as usize + i)),
        IrKind::ToNumber(inner) | IrKind::Unary(UnaryOp::Minus, inner) => element(inner),
        _ => None,
    }
}

impl TypedText {
    /// Sorts the entries, when all are known.
    pub(super) fn sort(&mut self) {
        order::sort_by_key(&mut self.shapes, |(span, _)| *span);
    }

    /// The properties of the expression with a span.
    pub(in crate::bind) fn shape(&self, span: Span) -> Option<&ExpressionShape> {
        let behind = self.shapes.partition_point(|(other, _)| *other <= span);
        let (other, shape) = self.shapes.get(behind.checked_sub(1)?)?;
        (*other == span).then_some(shape)
    }

    /// Whether the statement with a span has no effect.
    pub(in crate::bind) fn is_idle(&self, span: Span) -> bool {
        self.idle.contains(&span)
    }
}
