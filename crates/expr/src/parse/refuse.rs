//! Constructs of JavaScript that lessons do not have, on purpose: each with its reason and what to write instead.

use crate::rules;
use crate::words::Words;
use crate::{Finding, Span};

/// The finding for a construct, in the plural.
fn never(span: Span, name: &str, why: &str, help: &str) -> Finding {
    Finding::error(rules::NOT_IN_LANGUAGE, span, format!("{name} are not in this language"))
        .why(why)
        .help(help)
}

const NO_OBJECTS: &str =
    "the language works on numbers, texts, lists and records; it has no classes of its own";
const NO_TIME: &str = "every text runs to its end at once; nothing is ever waited for";
const NO_EXCEPTIONS: &str = "mistakes are found before the run, so there is nothing to catch";
const STORE_HELP: &str = "keep values in variables, as `ctx.peak`";

/// The finding for a reserved word of JavaScript where it cannot stand; `None` for a word that is a name.
pub(super) fn word(word: &str, span: Span, words: &Words) -> Option<Finding> {
    let misplaced =
        |help: &str| Finding::error(rules::MISPLACED, span, format!("`{word}` has no place here")).help(help);
    Some(match word {
        "this" | "super" => {
            never(span, &format!("`{word}` references"), NO_OBJECTS, "name the thing itself, as `ctx`")
        }
        "class" | "extends" | "enum" | "interface" => never(span, "classes", NO_OBJECTS, STORE_HELP),
        "new" => {
            never(span, "objects made with `new`", NO_OBJECTS, "write a list `[0, 0]` or a record `{a: 1}`")
        }
        "async" | "await" | "yield" => never(span, &format!("`{word}` and waiting"), NO_TIME, words.wait),
        "try" | "catch" | "finally" | "throw" => {
            never(span, "exceptions", NO_EXCEPTIONS, "test for the case itself, with `if` or `? :`")
        }
        "import" | "export" => never(
            span,
            "modules",
            "a text reaches nothing outside itself",
            "use `Math` and the functions that there are",
        ),
        "delete" => never(
            span,
            "`delete` expressions",
            "whoever reads the variable next should find a value, if only `null`",
            "store `null` or `undefined` instead",
        ),
        "void" => never(span, "`void` expressions", "they only give `undefined`", "write `undefined`"),
        "instanceof" | "in" => never(
            span,
            &format!("`{word}` tests"),
            "a variable that nothing has stored yet is `undefined`, which a comparison tells as well",
            "to ask whether there is a value, write `ctx.start != null`",
        ),
        "with" => {
            never(span, "`with` statements", "names must mean the same everywhere", "write the names in full")
        }
        "debugger" => never(
            span,
            "`debugger` statements",
            "a text is not run in a debugger",
            &format!("show the value in {}", words.shown),
        ),
        "switch" | "case" | "default" => never(
            span,
            "`switch` statements",
            "a forgotten `break` runs on into the next case, and nothing shows it",
            "write `if … else if … else`, or choose a value with `test ? a : b`",
        ),
        "if" | "for" | "while" | "do" | "return" | "break" | "continue" => {
            misplaced("it starts a statement of its own; a value is chosen with `test ? a : b`")
        }
        "else" => misplaced("`else` follows directly behind the statement of its `if`"),
        _ => return None,
    })
}

/// `new Date()`
pub(super) fn new_date(span: Span, words: &Words) -> Finding {
    never(
        span,
        "dates",
        &format!(
            "a {} must give the same numbers whenever it is run, and the clock on the wall is no part of it",
            words.lesson
        ),
        words.clock,
    )
}

/// Whether a word means something of its own, so that it cannot be the name of a variable.
pub(super) fn is_reserved(text: &str) -> bool {
    let own = ["true", "false", "null", "const", "let", "var", "function", "typeof"];
    own.contains(&text) || word(text, Span::default(), &Words::PLAIN).is_some()
}

/// The finding for a symbol that starts or continues a construct that is not read.
pub(super) fn symbol(text: &str, span: Span, words: &Words) -> Option<Finding> {
    Some(match text {
        "/" | "/=" => never(
            span,
            "regular expressions",
            &format!("a {} computes with numbers; text is only shown", words.lesson),
            "compare strings with `===`, or use `includes` and `startsWith`",
        ),
        "@" | "#" => never(span, "decorators and private names", NO_OBJECTS, STORE_HELP),
        _ => return None,
    })
}

/// `for (key in object)`
pub(super) fn for_in(span: Span) -> Finding {
    never(
        span,
        "`for … in` loops",
        "they walk over the keys as text, in an order that surprises",
        "write `for (const x of list)`, or count with `for (let i = 0; i < n; i++)`",
    )
}

/// A label, and `break` or `continue` to one.
pub(super) fn label(span: Span) -> Finding {
    never(
        span,
        "labels",
        "a jump out of several loops at once is hard to follow",
        "put the loops into a function and leave it with `return`",
    )
}

/// `(...rest) =>`
pub(super) fn rest(span: Span) -> Finding {
    never(
        span,
        "parameters that collect the rest",
        "how many there are would be known in the run only, and could not be checked before it",
        "give the function one list, as `f([a, b])`",
    )
}

/// `function*`, `{ get x() {} }` and methods of literals.
pub(super) fn member_function(span: Span) -> Finding {
    never(span, "generators, getters and methods of literals", NO_OBJECTS, "write `{name: (x) => …}`")
}

/// The comma operator.
pub(super) fn comma(span: Span, decimal: Option<(Span, String)>) -> Finding {
    if let Some((number, meant)) = decimal {
        return Finding::error(rules::DECIMAL_COMMA, number, "a decimal comma")
            .why("a comma separates things; the decimal sign is a point")
            .help(format!("write `{meant}`"))
            .guess(number, meant);
    }
    never(
        span,
        "values joined by a comma",
        "all but the last value would be computed and dropped",
        "separate statements with `;`",
    )
}

/// `var`, which is read as `let` after this.
pub(super) fn var(span: Span) -> Finding {
    never(
        span,
        "`var` declarations",
        "a `var` name can be used before it has a value, which hides mistakes",
        "write `const`, or `let` when the value changes later",
    )
    .fix(span, "let")
}

/// `a ?? b || c` without parentheses.
pub(super) fn mixed(span: Span) -> Finding {
    Finding::error(rules::AMBIGUOUS_DEFAULT, span, "`??` next to `||` or `&&` without parentheses")
        .why("it could group in two ways; JavaScript refuses it")
        .help("put one of them into parentheses, as `(a ?? b) || c`")
}
