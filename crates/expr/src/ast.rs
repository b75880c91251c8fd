//! The tree of a source text. Every node keeps the bytes that it came from.

pub use crate::operators::{BinaryOp, LogicalOp, UnaryOp};
use labspec_finding::Span;

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
        /// `object?.name`
        optional: bool,
    },
    /// `object[index]`
    Index {
        /// Before the brackets.
        object: Box<Expr>,
        /// Between them.
        index: Box<Expr>,
        /// `object?.[index]`
        optional: bool,
    },
    /// `callee(arguments)`
    Call {
        /// What is called.
        callee: Box<Expr>,
        /// In order; some may be spreads.
        args: Vec<Expr>,
        /// `callee?.(arguments)`
        optional: bool,
    },
    /// Members, indexes and calls with at least one `?.` in their chain: where an optional one meets nothing, all
    /// of the chain is `undefined`.
    Chain(Box<Expr>),
    /// `[items]`; some may be spreads.
    Array(Vec<Expr>),
    /// `{key: value}`
    Object(Vec<Property>),
    /// `...list`, only among items and arguments.
    Spread(Box<Expr>),
    /// `` `text ${value} text` ``: texts and the values between them; one text more than values.
    Template {
        /// Before, between and behind the values.
        texts: Vec<String>,
        /// In order.
        values: Vec<Expr>,
    },
    /// `(x) => x * x`, or `function (x) { return x * x }`
    Function(Box<Function>),
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
    /// `target ||= value`, `target &&= value`, `target ??= value`
    AssignLogical {
        /// What is assigned to.
        target: Box<Expr>,
        /// Decides whether.
        op: LogicalOp,
        /// Where the operator stands.
        op_span: Span,
        /// The new value.
        value: Box<Expr>,
    },
    /// `first, second`: only as a statement and in the head of a `for`.
    Sequence(Vec<Expr>),
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

/// A part of an object literal.
#[derive(Clone, Debug, PartialEq)]
pub enum Property {
    /// `key: value`, or `key` alone for `key: key`
    Named {
        /// The key.
        key: Name,
        /// Its value.
        value: Expr,
    },
    /// `[key]: value`
    Computed {
        /// Gives the key.
        key: Expr,
        /// Its value.
        value: Expr,
    },
    /// `...record`
    Spread(Expr),
}

/// A function of the text's own.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// The name by which a `function` that is a value can call itself. A declaration holds its own.
    pub name: Option<Name>,
    /// In order.
    pub params: Vec<Element>,
    /// What it does.
    pub body: Body,
    /// All of it.
    pub span: Span,
}

/// What a function does.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// Gives a value.
    Value(Expr),
    /// Runs statements up to `return`.
    Block(Vec<Stmt>),
}

/// What a declaration names: one value, or parts of a list or a record.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// `name`
    Name(Name),
    /// `[a, , b]`
    List {
        /// `None` for an element that is passed over.
        items: Vec<Option<Element>>,
        /// All of it.
        span: Span,
    },
    /// `{a, b: c}`
    Record {
        /// Key and what it is bound to.
        entries: Vec<(Name, Element)>,
        /// All of it.
        span: Span,
    },
}

impl Pattern {
    /// Where it stands.
    pub fn span(&self) -> Span {
        match self {
            Pattern::Name(name) => name.span,
            Pattern::List { span, .. } | Pattern::Record { span, .. } => *span,
        }
    }
}

/// A part of a pattern, or a parameter: what it names, and the value it takes instead of `undefined`.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// What it names.
    pub target: Pattern,
    /// `= value`
    pub default: Option<Expr>,
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
    /// `function name(x) { … }`
    Function {
        /// The new name.
        name: Name,
        /// What it does.
        function: Box<Function>,
    },
    /// `if (test) then else otherwise`
    If {
        /// Between the parentheses.
        test: Expr,
        /// Run when it holds.
        then: Box<Stmt>,
        /// Run when it does not.
        otherwise: Option<Box<Stmt>>,
    },
    /// `for (init; test; update) body`
    For {
        /// Run once before.
        init: Option<Box<Stmt>>,
        /// Asked before every turn.
        test: Option<Expr>,
        /// Run after every turn.
        update: Option<Expr>,
        /// Run in every turn.
        body: Box<Stmt>,
    },
    /// `for (const target of items) body`
    ForOf {
        /// `const` rather than `let`.
        constant: bool,
        /// Names each item.
        target: Pattern,
        /// A list, an array of the simulation or a string.
        items: Expr,
        /// Run for every item.
        body: Box<Stmt>,
    },
    /// `while (test) body`
    While {
        /// Asked before every turn.
        test: Expr,
        /// Run in every turn.
        body: Box<Stmt>,
    },
    /// `do body while (test)`
    DoWhile {
        /// Run in every turn.
        body: Box<Stmt>,
        /// Asked after every turn.
        test: Expr,
    },
    /// `{ … }`
    Block(Vec<Stmt>),
    /// `break`
    Break,
    /// `continue`
    Continue,
    /// `return value`
    Return(Option<Expr>),
    /// `;`
    Empty,
    /// Could not be read; already reported.
    Error,
}

/// `target = value` of a declaration.
#[derive(Clone, Debug, PartialEq)]
pub struct Declarator {
    /// The new name, or names.
    pub target: Pattern,
    /// Its first value; without one it is `undefined`.
    pub value: Option<Expr>,
}
