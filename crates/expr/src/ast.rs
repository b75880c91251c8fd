//! The syntax tree. Every node stores its source span.

pub use crate::operators::{BinaryOp, LogicalOp, UnaryOp};
use labspec_finding::Span;

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// The kind, with its operands.
    pub kind: ExprKind,
    /// The source span, without enclosing parentheses.
    pub span: Span,
}

/// A name with its location.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// The text.
    pub text: String,
    /// Its source span.
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
        /// The expression before the point.
        object: Box<Expr>,
        /// The name after it.
        name: Name,
        /// `object?.name`
        optional: bool,
    },
    /// `object[index]`
    Index {
        /// The expression before the brackets.
        object: Box<Expr>,
        /// The expression between them.
        index: Box<Expr>,
        /// `object?.[index]`
        optional: bool,
    },
    /// `callee(arguments)`
    Call {
        /// The function that is called.
        callee: Box<Expr>,
        /// The arguments in order; some may be spreads.
        args: Vec<Expr>,
        /// `callee?.(arguments)`
        optional: bool,
    },
    /// Members, indexes and calls with at least one `?.` in their chain: if the object of an optional link is `null` or
    /// `undefined`, the whole chain is `undefined`.
    Chain(Box<Expr>),
    /// `[items]`; some may be spreads.
    Array(Vec<Expr>),
    /// `{key: value}`
    Object(Vec<Property>),
    /// `...list`, only among items and arguments.
    Spread(Box<Expr>),
    /// `` `text ${value} text` ``: strings, and the values between them; there is one string more than values.
    Template {
        /// The strings before, between and after the values.
        texts: Vec<String>,
        /// The values in order.
        values: Vec<Expr>,
    },
    /// `(x) => x * x`, or `function (x) { return x * x }`
    Function(Box<Function>),
    /// `-operand` and the other unary operators.
    Unary {
        /// The operator.
        op: UnaryOp,
        /// Its operand.
        operand: Box<Expr>,
    },
    /// `left + right` and the other binary operators.
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
        /// The value if `test` holds.
        then: Box<Expr>,
        /// The value if `test` does not hold.
        otherwise: Box<Expr>,
    },
    /// `target = value`, `target += value`
    Assign {
        /// The target of the assignment.
        target: Box<Expr>,
        /// The operator of a compound assignment.
        op: Option<BinaryOp>,
        /// The span of `=` or `+=`.
        op_span: Span,
        /// The new value, or the right operand of `op`.
        value: Box<Expr>,
    },
    /// `target ||= value`, `target &&= value`, `target ??= value`
    AssignLogical {
        /// The target of the assignment.
        target: Box<Expr>,
        /// The operator that decides whether the assignment happens.
        op: LogicalOp,
        /// The span of the operator.
        op_span: Span,
        /// The new value.
        value: Box<Expr>,
    },
    /// `first, second`: only as a statement and in the head of a `for`.
    Sequence(Vec<Expr>),
    /// `target++`, `--target`
    Update {
        /// The target that changes.
        target: Box<Expr>,
        /// `true` for `++`, `false` for `--`.
        increment: bool,
        /// Whether the operator is in front of the target.
        prefix: bool,
    },
    /// An expression that could not be parsed; the error has been reported.
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
        /// The expression of the key.
        key: Expr,
        /// Its value.
        value: Expr,
    },
    /// `...record`
    Spread(Expr),
}

/// A function that the source text defines.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// The name by which a `function` expression can call itself. For a declaration, the name is in [`StmtKind::Function`].
    pub name: Option<Name>,
    /// The parameters in order.
    pub params: Vec<Element>,
    /// The body.
    pub body: Body,
    /// The span of the whole function.
    pub span: Span,
}

/// The body of a function.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// An expression whose value is returned.
    Value(Expr),
    /// Statements, executed up to `return`.
    Block(Vec<Stmt>),
}

/// The target of a declaration: one name, or a destructuring pattern of a list or a record.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// `name`
    Name(Name),
    /// `[a, , b]`
    List {
        /// `None` for an element that is skipped.
        items: Vec<Option<Element>>,
        /// The span of the whole pattern.
        span: Span,
    },
    /// `{a, b: c}`
    Record {
        /// Each key with its target.
        entries: Vec<(Name, Element)>,
        /// The span of the whole pattern.
        span: Span,
    },
}

impl Pattern {
    /// The span of the pattern.
    pub fn span(&self) -> Span {
        match self {
            Pattern::Name(name) => name.span,
            Pattern::List { span, .. } | Pattern::Record { span, .. } => *span,
        }
    }
}

/// An element of a pattern, or a parameter: its target, and the default that replaces `undefined`.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// The name or the pattern that it binds.
    pub target: Pattern,
    /// `= value`
    pub default: Option<Expr>,
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Stmt {
    /// The kind, with its parts.
    pub kind: StmtKind,
    /// The source span, without the semicolon.
    pub span: Span,
}

/// The kinds of statements.
#[derive(Clone, Debug, PartialEq)]
pub enum StmtKind {
    /// An expression evaluated for its effect: an assignment or a call.
    Expr(Expr),
    /// `const a = 1, b = 2` or `let …`
    Declare {
        /// `true` for `const`, `false` for `let`.
        constant: bool,
        /// The declarators, at least one.
        declarators: Vec<Declarator>,
    },
    /// `function name(x) { … }`
    Function {
        /// The declared name.
        name: Name,
        /// The function.
        function: Box<Function>,
    },
    /// `if (test) then else otherwise`
    If {
        /// The condition between the parentheses.
        test: Expr,
        /// Executed if the condition holds.
        then: Box<Stmt>,
        /// Executed if it does not hold.
        otherwise: Option<Box<Stmt>>,
    },
    /// `for (init; test; update) body`
    For {
        /// Executed once before the loop.
        init: Option<Box<Stmt>>,
        /// The condition, evaluated before every iteration.
        test: Option<Expr>,
        /// Executed after every iteration.
        update: Option<Expr>,
        /// Executed in every iteration.
        body: Box<Stmt>,
    },
    /// `for (const target of items) body`
    ForOf {
        /// `true` for `const`, `false` for `let`.
        constant: bool,
        /// The target that is bound to each item.
        target: Pattern,
        /// A list, an array of the simulation or a string.
        items: Expr,
        /// Executed for every item.
        body: Box<Stmt>,
    },
    /// `while (test) body`
    While {
        /// The condition, evaluated before every iteration.
        test: Expr,
        /// Executed in every iteration.
        body: Box<Stmt>,
    },
    /// `do body while (test)`
    DoWhile {
        /// Executed in every iteration.
        body: Box<Stmt>,
        /// The condition, evaluated after every iteration.
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
    /// A statement that could not be parsed; the error has been reported.
    Error,
}

/// `target = value` of a declaration.
#[derive(Clone, Debug, PartialEq)]
pub struct Declarator {
    /// The declared name, or a pattern of names.
    pub target: Pattern,
    /// Its initial value; without one it is `undefined`.
    pub value: Option<Expr>,
}
