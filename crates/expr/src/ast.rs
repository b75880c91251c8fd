//! The tree of a source text. Every node keeps the bytes that it came from.

use crate::Span;
pub use crate::operators::{BinaryOp, LogicalOp, UnaryOp};

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where it stands, parentheses around it not included.
    pub span: Span,
}

/// A name with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// The text.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

/// The kinds of expressions.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// `1.5`; never negative, infinite or NaN.
    Number(f64),
    /// `"text"`
    String(String),
    /// `true`, `false`
    Boolean(bool),
    /// `null`
    Null,
    /// A name; `undefined`, `NaN` and `Infinity` are names too, as in JavaScript.
    Name(String),
    /// `object.name`
    Member {
        /// Before the point.
        object: Box<Expr>,
        /// After it.
        name: Name,
    },
    /// `object[index]`
    Index {
        /// Before the brackets.
        object: Box<Expr>,
        /// Between them.
        index: Box<Expr>,
    },
    /// `callee(arguments)`
    Call {
        /// What is called.
        callee: Box<Expr>,
        /// In order.
        args: Vec<Expr>,
    },
    /// `[items]`
    Array(Vec<Expr>),
    /// `-operand` and its like.
    Unary {
        /// The sign.
        op: UnaryOp,
        /// What it applies to.
        operand: Box<Expr>,
    },
    /// `left + right` and its like.
    Binary {
        /// The operator.
        op: BinaryOp,
        /// Left operand.
        left: Box<Expr>,
        /// Right operand.
        right: Box<Expr>,
    },
    /// `left && right`, `left || right`
    Logical {
        /// The operator.
        op: LogicalOp,
        /// Left operand.
        left: Box<Expr>,
        /// Right operand, evaluated only when needed.
        right: Box<Expr>,
    },
    /// `test ? then : otherwise`
    Conditional {
        /// Before the question mark.
        test: Box<Expr>,
        /// The value when `test` holds.
        then: Box<Expr>,
        /// The value when it does not.
        otherwise: Box<Expr>,
    },
    /// `target = value`, `target += value`
    Assign {
        /// What is assigned to.
        target: Box<Expr>,
        /// The operator of a compound assignment.
        op: Option<BinaryOp>,
        /// Where `=` or `+=` stands.
        op_span: Span,
        /// The new value, or the right operand of `op`.
        value: Box<Expr>,
    },
    /// `target++`, `--target`
    Update {
        /// What is changed.
        target: Box<Expr>,
        /// `++` rather than `--`.
        increment: bool,
        /// The operator stands before the target.
        prefix: bool,
    },
    /// Could not be read; already reported.
    Error,
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Stmt {
    /// What it is.
    pub kind: StmtKind,
    /// Where it stands, without the semicolon.
    pub span: Span,
}

/// The kinds of statements.
#[derive(Clone, Debug, PartialEq)]
pub enum StmtKind {
    /// An expression for its effect: an assignment or a call.
    Expr(Expr),
    /// `const a = 1, b = 2` or `let …`
    Declare {
        /// `const` rather than `let`.
        constant: bool,
        /// At least one.
        declarators: Vec<Declarator>,
    },
    /// Could not be read; already reported.
    Error,
}

/// `name = value` of a declaration.
#[derive(Clone, Debug, PartialEq)]
pub struct Declarator {
    /// The new name.
    pub name: Name,
    /// Its first value; without one it is `undefined`.
    pub value: Option<Expr>,
}
