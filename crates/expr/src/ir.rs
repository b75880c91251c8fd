//! The typed tree: what a program means, with every name resolved. Made by `bind`, read by `lower`.

use std::sync::Arc;

use crate::math;
use crate::operators::{BinaryOp, LogicalOp, UnaryOp};
use crate::tables::{ExposedView, FreeFunctionId, MemberTable, MethodId, UnitId};
use crate::types::{FunctionId, Type};
use crate::value::{Value, View};
use labspec_finding::Span;

/// A value to be computed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ir {
    pub(crate) kind: IrKind,
    pub(crate) ty: Type,
    pub(crate) span: Span,
}

/// A variable, counted over all functions of a program.
pub(crate) type LocalId = u32;

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum IrKind {
    Constant(Value),
    /// An element of a field; past the end it is `undefined`.
    Load(View, Index),
    /// The number of elements of a view.
    Length(View),
    /// A `ctx` variable.
    Global(u32),
    /// A `ctx` variable whose name is computed.
    GlobalNamed(Box<Ir>),
    Local(LocalId),
    /// The chosen value of a control, `value`.
    Input,
    /// The number that the host computed for an aggregate.
    Aggregate(u32),
    /// `!`, `-` or `~`.
    Unary(UnaryOp, Box<Ir>),
    ToNumber(Box<Ir>),
    ToText(Box<Ir>),
    TypeOf(Box<Ir>),
    Binary(BinaryOp, Box<Ir>, Box<Ir>),
    Logical(LogicalOp, Box<Ir>, Box<Ir>),
    Choice(Box<Ir>, Box<Ir>, Box<Ir>),
    Math(math::MathFunction, Vec<Ir>),
    /// A function of `Math` over all elements of a list.
    MathOver(math::MathFunction, Box<Ir>),
    Call(FunctionId, Vec<Ir>),
    /// `place = value` or `place op= value`; gives the stored value.
    Store(Box<AssignmentTarget>, Option<BinaryOp>, Box<Ir>),
    /// `place ||= value` and its like.
    StoreIf(LogicalOp, Box<AssignmentTarget>, Box<Ir>),
    /// `place++` and its like: adds the number; gives the new value, or the old one.
    Update(Box<AssignmentTarget>, f64, UpdateResult),
    /// Stores one number in every element.
    Fill(View, Box<Ir>),
    /// Stores values one after the other, from an element of the view on.
    StoreAll(View, usize, Vec<Ir>),
    /// A list, with spreads.
    List(Vec<IrItem>),
    Record(Vec<IrEntry>),
    /// `object[index]` of something known only while running.
    Element(Box<Ir>, Box<Ir>),
    /// `object.name` of something known only while running.
    Member(Box<Ir>, Arc<str>),
    /// A method of a value.
    Method(MethodId, Box<Ir>, Vec<IrItem>),
    /// A function that is no method.
    Native(FreeFunctionId, Vec<IrItem>),
    /// A function of the text, as a value.
    Closure(UnitId),
    /// A call of a known function of the text.
    Invoke(UnitId, Vec<Ir>),
    /// A call of whatever function the value is.
    InvokeValue(Box<Ir>, Vec<IrItem>),
    /// The array that belongs to the object of a computed name.
    Pick(Arc<MemberTable>, Box<Ir>),
    /// The end of a chain with `?.` in it.
    Chain(Box<Ir>),
    /// What stands before `?.`: where it is nothing, the chain around it is `undefined`.
    Present(Box<Ir>),
    /// Statements, then a value.
    Block(Vec<IrStatement>, Box<Ir>),
}

/// Which value a `++` gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum UpdateResult {
    New,
    Old,
}

/// An item of a list or an argument.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IrItem {
    pub(crate) value: Ir,
    /// Its elements, rather than itself.
    pub(crate) spread: bool,
}

/// An entry of a record.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum IrEntry {
    Named(Arc<str>, Ir),
    Computed(Ir, Ir),
    Spread(Ir),
}

/// An element of a view.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Index {
    At(usize),
    Computed(Box<Ir>),
}

/// What can be assigned to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum AssignmentTarget {
    Element(View, Index),
    Global(u32),
    GlobalNamed(Ir),
    Local(LocalId),
    /// An element of something known only while running.
    Item(Ir, Ir),
    Member(Ir, Arc<str>),
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum IrStatement {
    /// Computed for its effect.
    Effect(Ir),
    /// The first value of a variable.
    Declare(LocalId, Ir),
    /// A variable that functions share gets its place; it has no value yet.
    Reserve(LocalId),
    /// A variable that functions share gets a new place with its value: the next turn of a loop has its own.
    Renew(LocalId),
    If(Ir, Vec<IrStatement>, Vec<IrStatement>),
    Loop(Box<IrLoop>),
    Break,
    Continue,
    Return(Ir),
    /// Statements in which `Return` ends only them, and stores its value; the place is where they seem to stand.
    Inline(LocalId, Vec<IrStatement>, Span),
}

/// A loop of any kind.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IrLoop {
    /// Asked before every turn; at the end of every turn when `late`.
    pub(crate) test: Option<Ir>,
    pub(crate) late: bool,
    pub(crate) body: Vec<IrStatement>,
    /// Run after every turn.
    pub(crate) update: Vec<IrStatement>,
    pub(crate) span: Span,
}

/// A function of the text, or the text itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct IrFunction {
    pub(crate) params: Vec<LocalId>,
    /// Variables of the functions around it that it uses.
    pub(crate) captures: Vec<LocalId>,
    pub(crate) body: Vec<IrStatement>,
    /// Type of what it returns.
    pub(crate) result: Option<Type>,
}

/// What is known of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Local {
    pub(crate) ty: Type,
    /// It is changed while functions use it, so that they share one place.
    pub(crate) shared: bool,
}

/// All functions and variables of a program; the first function is the text itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct IrProgram {
    pub(crate) units: Vec<IrFunction>,
    pub(crate) locals: Vec<Local>,
    /// Arrays that become values, with what their elements are.
    pub(crate) views: Vec<ExposedView>,
}

impl Ir {
    pub(crate) fn new(kind: IrKind, ty: Type, span: Span) -> Ir {
        Ir { kind, ty, span }
    }

    pub(crate) fn constant(value: Value, span: Span) -> Ir {
        let ty = value.type_of();
        Ir { kind: IrKind::Constant(value), ty, span }
    }

    pub(crate) fn number(x: f64, span: Span) -> Ir {
        Ir::constant(Value::Number(x), span)
    }

    pub(crate) fn undefined(span: Span) -> Ir {
        Ir::constant(Value::Undefined, span)
    }

    /// The value, if it is known and a primitive one.
    pub(crate) fn as_constant(&self) -> Option<&Value> {
        match &self.kind {
            IrKind::Constant(value) if value.is_primitive() => Some(value),
            _ => None,
        }
    }

    /// The value, if it is known and may decide something before the run. NaN decides while running, where a watch sees it.
    fn decided(&self) -> Option<&Value> {
        self.as_constant().filter(|value| !value.is_nan())
    }

    /// Whether it is never a string nor something with parts: then arithmetic on it can use plain numbers.
    pub(crate) fn is_plain(&self) -> bool {
        match (&self.kind, self.ty) {
            (IrKind::Logical(_, a, b) | IrKind::Choice(_, a, b), Type::Any) => a.is_plain() && b.is_plain(),
            (_, ty) => ty.is_plain(),
        }
    }

    pub(crate) fn not(operand: Ir, span: Span) -> Ir {
        Ir::sign(UnaryOp::Not, operand, span)
    }

    /// `op operands`, computed at once when all operands are known.
    pub(crate) fn sign(op: UnaryOp, operand: Ir, span: Span) -> Ir {
        if op == UnaryOp::Plus {
            return Ir::to_number(operand, span);
        }
        let passes = op != UnaryOp::Not && op != UnaryOp::BitNot;
        if let Some(value) = operand.as_constant().filter(|value| passes || !value.is_nan()) {
            return Ir::constant(op.on_value(value), span);
        }
        let operand = Box::new(operand);
        match op {
            UnaryOp::TypeOf => Ir::new(IrKind::TypeOf(operand), Type::String, span),
            UnaryOp::Not => Ir::new(IrKind::Unary(op, operand), Type::Boolean, span),
            _ => Ir::new(IrKind::Unary(op, operand), Type::Number, span),
        }
    }

    pub(crate) fn to_number(operand: Ir, span: Span) -> Ir {
        match operand.as_constant() {
            Some(value) => Ir::number(value.to_number(), span),
            None if operand.ty == Type::Number => operand,
            None => Ir::new(IrKind::ToNumber(Box::new(operand)), Type::Number, span),
        }
    }

    pub(crate) fn to_text(operand: Ir, span: Span) -> Ir {
        match operand.decided() {
            Some(value) => Ir::constant(Value::String(value.to_string().into()), span),
            None if operand.ty == Type::String => operand,
            None => Ir::new(IrKind::ToText(Box::new(operand)), Type::String, span),
        }
    }

    pub(crate) fn binary(op: BinaryOp, left: Ir, right: Ir, span: Span) -> Ir {
        if let (Some(a), Some(b)) = (left.as_constant(), right.as_constant())
            && a.text_len() + b.text_len() < 1000
        {
            let value = op.on_values(a, b);
            if value.is_nan() || !a.is_nan() && !b.is_nan() {
                return Ir::constant(value, span);
            }
        }
        let ty = match op {
            _ if op.is_comparison() => Type::Boolean,
            BinaryOp::Add if left.ty == Type::String || right.ty == Type::String => Type::String,
            BinaryOp::Add if !(left.is_plain() && right.is_plain()) => Type::Any,
            _ => Type::Number,
        };
        Ir::new(IrKind::Binary(op, Box::new(left), Box::new(right)), ty, span)
    }

    pub(crate) fn logical(op: LogicalOp, left: Ir, right: Ir, span: Span) -> Ir {
        if let Some(value) = left.as_constant().filter(|value| op == LogicalOp::Nullish || !value.is_nan()) {
            return Ir { span, ..if op.keeps(value) { left } else { right } };
        }
        let ty = match (op, left.ty) {
            // What is left of a number or nothing in front of a default.
            (LogicalOp::Nullish | LogicalOp::Or, Type::Element) if right.ty == Type::Number => Type::Number,
            (LogicalOp::Nullish, Type::Number | Type::Boolean | Type::String) => left.ty,
            (LogicalOp::Nullish, Type::Undefined | Type::Null) => right.ty,
            _ => left.ty.or(right.ty),
        };
        Ir::new(IrKind::Logical(op, Box::new(left), Box::new(right)), ty, span)
    }

    pub(crate) fn choice(test: Ir, then: Ir, otherwise: Ir, span: Span) -> Ir {
        if let Some(value) = test.decided() {
            return Ir { span, ..if value.truthy() { then } else { otherwise } };
        }
        let ty = then.ty.or(otherwise.ty);
        Ir::new(IrKind::Choice(Box::new(test), Box::new(then), Box::new(otherwise)), ty, span)
    }

    pub(crate) fn math(function: math::MathFunction, args: Vec<Ir>, span: Span) -> Ir {
        let constants: Option<Vec<f64>> =
            args.iter().map(|a| a.as_constant().map(Value::to_number)).collect();
        let ty = if function.gives_boolean() { Type::Boolean } else { Type::Number };
        let applied = constants.map(|numbers| (numbers.iter().any(|x| x.is_nan()), function.apply(&numbers)));
        // A NaN that is lost is lost while running, where a watch sees it.
        let keeps_nan = |(nan, x): &(bool, f64)| !nan || x.is_nan() || ty == Type::Boolean;
        match applied.filter(keeps_nan).filter(|_| !args.is_empty()).map(|(_, x)| x) {
            Some(x) if ty == Type::Boolean => Ir::constant(Value::Boolean(x != 0.0), span),
            Some(x) => Ir::number(x, span),
            None => Ir::new(IrKind::Math(function, args), ty, span),
        }
    }
}

/// Whether statements never come to their end: all ways through them return.
pub(crate) fn always_return(steps: &[IrStatement]) -> bool {
    steps.iter().any(|step| match step {
        IrStatement::Return(_) => true,
        IrStatement::If(_, then, otherwise) => always_return(then) && always_return(otherwise),
        _ => false,
    })
}
