//! The typed tree: a program with every name resolved. `bind` builds it, and `lower` reads it.

use std::sync::Arc;

use crate::math;
use crate::operators::{BinaryOp, LogicalOp, UnaryOp};
use crate::tables::{ExposedView, FreeFunctionId, MemberTable, MethodId, UnitId};
use crate::types::{FunctionId, Type};
use crate::value::{Value, View};
use labspec_finding::Span;

/// An expression of the typed tree.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ir {
    pub(crate) kind: IrKind,
    pub(crate) ty: Type,
    pub(crate) span: Span,
}

/// A local variable, numbered across all functions of a program.
pub(crate) type LocalId = u32;

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum IrKind {
    Constant(Value),
    /// An element of a field; `undefined` past the end.
    Load(View, Index),
    /// The number of elements of a view.
    Length(View),
    /// A `ctx` variable.
    Global(u32),
    /// A `ctx` variable whose name is computed.
    GlobalNamed(Box<Ir>),
    Local(LocalId),
    /// The selected value of a control, `value`.
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
    /// `place = value` or `place op= value`. The result is the stored value.
    Store(Box<AssignmentTarget>, Option<BinaryOp>, Box<Ir>),
    /// `place ||= value`, `place &&= value` and `place ??= value`.
    StoreIf(LogicalOp, Box<AssignmentTarget>, Box<Ir>),
    /// `place++` and similar: adds the number. The result is the new or the old value.
    Update(Box<AssignmentTarget>, f64, UpdateResult),
    /// Stores one number in every element.
    Fill(View, Box<Ir>),
    /// Stores several values in succession, from an element of the view on.
    StoreAll(View, usize, Vec<Ir>),
    /// A list literal, with spreads.
    List(Vec<IrItem>),
    Record(Vec<IrEntry>),
    /// `object[index]` of an object that is known only at run time.
    Element(Box<Ir>, Box<Ir>),
    /// `object.name` of an object that is known only at run time.
    Member(Box<Ir>, Arc<str>),
    /// A method of a value.
    Method(MethodId, Box<Ir>, Vec<IrItem>),
    /// A free function (not a method).
    Native(FreeFunctionId, Vec<IrItem>),
    /// A function of the text, as a value.
    Closure(UnitId),
    /// A call of a known function of the text.
    Invoke(UnitId, Vec<Ir>),
    /// A call of a function value.
    InvokeValue(Box<Ir>, Vec<IrItem>),
    /// The array that belongs to the object with a computed name.
    Pick(Arc<MemberTable>, Box<Ir>),
    /// A whole chain that contains `?.`.
    Chain(Box<Ir>),
    /// The operand of `?.`: if it is `null` or `undefined`, the enclosing chain is `undefined`.
    Present(Box<Ir>),
    /// Statements, then a value.
    Block(Vec<IrStatement>, Box<Ir>),
}

/// Which value `++` or `--` returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum UpdateResult {
    New,
    Old,
}

/// An item of a list or an argument.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IrItem {
    pub(crate) value: Ir,
    /// Whether its elements are inserted instead of the value itself.
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

/// A target of an assignment.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum AssignmentTarget {
    Element(View, Index),
    Global(u32),
    GlobalNamed(Ir),
    Local(LocalId),
    /// An element of an object that is known only at run time.
    Item(Ir, Ir),
    Member(Ir, Arc<str>),
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum IrStatement {
    /// Evaluated for its effect.
    Effect(Ir),
    /// Initializes a variable.
    Declare(LocalId, Ir),
    /// Creates the cell of a shared variable, without a value.
    Reserve(LocalId),
    /// Gives a shared variable a new cell with the same value: each iteration of a loop has its own variable.
    Renew(LocalId),
    If(Ir, Vec<IrStatement>, Vec<IrStatement>),
    Loop(Box<IrLoop>),
    Break,
    Continue,
    Return(Ir),
    /// Inlined statements: `Return` ends only these, and stores its value in the variable. The span is that of the call.
    Inline(LocalId, Vec<IrStatement>, Span),
}

/// A loop of any kind.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IrLoop {
    /// Evaluated before every iteration, or after it if `late`.
    pub(crate) test: Option<Ir>,
    pub(crate) late: bool,
    pub(crate) body: Vec<IrStatement>,
    /// Executed after every iteration.
    pub(crate) update: Vec<IrStatement>,
    pub(crate) span: Span,
}

/// A function of the program, or the program itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct IrFunction {
    pub(crate) params: Vec<LocalId>,
    /// Captured variables of enclosing functions.
    pub(crate) captures: Vec<LocalId>,
    pub(crate) body: Vec<IrStatement>,
    /// The type of the result.
    pub(crate) result: Option<Type>,
}

/// The properties of a local variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Local {
    pub(crate) ty: Type,
    /// Whether it changes while several functions use it, so that they must share one cell.
    pub(crate) shared: bool,
}

/// All functions and variables of a program. The first function is the program itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct IrProgram {
    pub(crate) units: Vec<IrFunction>,
    pub(crate) locals: Vec<Local>,
    /// Arrays used as values, with the types of their elements.
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

    /// The value, if it is a known primitive.
    pub(crate) fn as_constant(&self) -> Option<&Value> {
        match &self.kind {
            IrKind::Constant(value) if value.is_primitive() => Some(value),
            _ => None,
        }
    }

    /// The value, if it may decide a branch at compile time. NaN decides at run time, where a watch records it.
    fn decided(&self) -> Option<&Value> {
        self.as_constant().filter(|value| !value.is_nan())
    }

    /// Whether the value is never a string, list, record or function, so that arithmetic can use plain numbers.
    pub(crate) fn is_plain(&self) -> bool {
        match (&self.kind, self.ty) {
            (IrKind::Logical(_, a, b) | IrKind::Choice(_, a, b), Type::Any) => a.is_plain() && b.is_plain(),
            (_, ty) => ty.is_plain(),
        }
    }

    pub(crate) fn not(operand: Ir, span: Span) -> Ir {
        Ir::sign(UnaryOp::Not, operand, span)
    }

    /// `op operand`, evaluated at compile time if the operand is known.
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
            // The value is a number or `undefined`, and `right` replaces `undefined`.
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
        // A NaN that would disappear in the result is handled at run time, where a watch records it.
        let keeps_nan = |(nan, x): &(bool, f64)| !nan || x.is_nan() || ty == Type::Boolean;
        match applied.filter(keeps_nan).filter(|_| !args.is_empty()).map(|(_, x)| x) {
            Some(x) if ty == Type::Boolean => Ir::constant(Value::Boolean(x != 0.0), span),
            Some(x) => Ir::number(x, span),
            None => Ir::new(IrKind::Math(function, args), ty, span),
        }
    }
}

/// Whether all paths through the statements return.
pub(crate) fn always_return(steps: &[IrStatement]) -> bool {
    steps.iter().any(|step| match step {
        IrStatement::Return(_) => true,
        IrStatement::If(_, then, otherwise) => always_return(then) && always_return(otherwise),
        _ => false,
    })
}
