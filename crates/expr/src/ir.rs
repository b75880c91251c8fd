//! The typed tree: what a program means, with every name resolved. Made by `bind`, turned into code by `lower`.

use crate::diagnostic::Span;
use crate::math;
use crate::operators::{BinaryOp, LogicalOp};
use crate::schema::{FieldKey, FunctionId, Type};
use crate::value::Value;

/// A value to be computed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ir {
    pub(crate) kind: Kind,
    pub(crate) ty: Type,
    pub(crate) span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    Constant(Value),
    /// An element of a field; past the end it is `undefined`.
    Load(View, Index),
    /// The number of elements of a view.
    Length(View),
    /// A `ctx` variable.
    Global(u32),
    Local(u32),
    /// The chosen value of a control, `value`.
    Input,
    /// The number that the host computed for an aggregate.
    Aggregate(u32),
    Not(Box<Ir>),
    BitNot(Box<Ir>),
    Negate(Box<Ir>),
    ToNumber(Box<Ir>),
    Binary(BinaryOp, Box<Ir>, Box<Ir>),
    Logical(LogicalOp, Box<Ir>, Box<Ir>),
    Choice(Box<Ir>, Box<Ir>, Box<Ir>),
    Math(math::Function, Vec<Ir>),
    Call(FunctionId, Vec<Ir>),
    /// `place = value` or `place op= value`; gives the stored value.
    Store(Box<Place>, Option<BinaryOp>, Box<Ir>),
    /// Stores one number in every element.
    Fill(View, Box<Ir>),
    /// Stores values one after the other, from an element of the view on.
    StoreAll(View, usize, Vec<Ir>),
}

/// A part of a field, in elements of the whole field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct View {
    pub(crate) field: FieldKey,
    pub(crate) first: usize,
    /// `None`: to the end, which changes while running.
    pub(crate) count: Option<usize>,
}

/// An element of a view.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Index {
    At(usize),
    Computed(Box<Ir>),
}

/// What can be assigned to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Place {
    Element(View, Index),
    Global(u32),
    Local(u32),
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Step {
    /// Computed for its effect.
    Effect(Ir),
    /// A declaration. `fixed`: the name is never assigned again, so it keeps the type of its value.
    Declare { local: u32, fixed: bool, value: Ir },
}

impl Ir {
    pub(crate) fn new(kind: Kind, ty: Type, span: Span) -> Ir {
        Ir { kind, ty, span }
    }

    pub(crate) fn constant(value: Value, span: Span) -> Ir {
        let ty = value.type_of();
        Ir { kind: Kind::Constant(value), ty, span }
    }

    /// The value, if it is known.
    pub(crate) fn known(&self) -> Option<&Value> {
        if let Kind::Constant(value) = &self.kind { Some(value) } else { None }
    }

    /// Whether it is never a string: then arithmetic on it can use plain numbers.
    pub(crate) fn never_text(&self) -> bool {
        match (&self.kind, self.ty) {
            (_, Type::String) => false,
            (Kind::Load(..), _) => true, // a number or `undefined`
            (Kind::Logical(_, a, b) | Kind::Choice(_, a, b), Type::Any) => a.never_text() && b.never_text(),
            (_, Type::Any) => false,
            _ => true,
        }
    }

    /// `op operands`, computed at once when all operands are known.
    pub(crate) fn not(operand: Ir, span: Span) -> Ir {
        match operand.known() {
            Some(value) => Ir::constant(Value::Boolean(!value.truthy()), span),
            None => Ir::new(Kind::Not(Box::new(operand)), Type::Boolean, span),
        }
    }

    pub(crate) fn negate(operand: Ir, span: Span) -> Ir {
        match operand.known() {
            Some(value) => Ir::constant(Value::Number(-value.to_number()), span),
            None => Ir::new(Kind::Negate(Box::new(operand)), Type::Number, span),
        }
    }

    pub(crate) fn bit_not(operand: Ir, span: Span) -> Ir {
        match operand.known() {
            Some(value) => {
                Ir::constant(Value::Number(f64::from(!crate::number::to_int32(value.to_number()))), span)
            }
            None => Ir::new(Kind::BitNot(Box::new(operand)), Type::Number, span),
        }
    }

    pub(crate) fn to_number(operand: Ir, span: Span) -> Ir {
        match operand.known() {
            Some(value) => Ir::constant(Value::Number(value.to_number()), span),
            None if operand.ty == Type::Number => operand,
            None => Ir::new(Kind::ToNumber(Box::new(operand)), Type::Number, span),
        }
    }

    pub(crate) fn binary(op: BinaryOp, left: Ir, right: Ir, span: Span) -> Ir {
        if let (Some(a), Some(b)) = (left.known(), right.known()) {
            return Ir::constant(op.on_values(a, b), span);
        }
        let ty = match op {
            _ if op.is_comparison() => Type::Boolean,
            BinaryOp::Add if left.ty == Type::String || right.ty == Type::String => Type::String,
            BinaryOp::Add if !(left.never_text() && right.never_text()) => Type::Any,
            _ => Type::Number,
        };
        Ir::new(Kind::Binary(op, Box::new(left), Box::new(right)), ty, span)
    }

    pub(crate) fn logical(op: LogicalOp, left: Ir, right: Ir, span: Span) -> Ir {
        if let Some(value) = left.known() {
            let keeps_left = value.truthy() == (op == LogicalOp::Or);
            return Ir { span, ..if keeps_left { left } else { right } };
        }
        let ty = left.ty.or(right.ty);
        Ir::new(Kind::Logical(op, Box::new(left), Box::new(right)), ty, span)
    }

    pub(crate) fn choice(test: Ir, then: Ir, otherwise: Ir, span: Span) -> Ir {
        if let Some(value) = test.known() {
            return Ir { span, ..if value.truthy() { then } else { otherwise } };
        }
        let ty = then.ty.or(otherwise.ty);
        Ir::new(Kind::Choice(Box::new(test), Box::new(then), Box::new(otherwise)), ty, span)
    }

    pub(crate) fn math(function: math::Function, args: Vec<Ir>, span: Span) -> Ir {
        let known: Option<Vec<f64>> = args.iter().map(|a| a.known().map(Value::to_number)).collect();
        let ty = if function.gives_boolean() { Type::Boolean } else { Type::Number };
        match known.map(|numbers| function.apply(&numbers)) {
            Some(x) if ty == Type::Boolean => Ir::constant(Value::Boolean(x != 0.0), span),
            Some(x) => Ir::constant(Value::Number(x), span),
            None => Ir::new(Kind::Math(function, args), ty, span),
        }
    }
}
