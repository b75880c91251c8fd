//! Constructs of JavaScript that are deliberately not in the language, each with the reason and an alternative.

use crate::host_terms::HostTerms;
use crate::rules;
use labspec_finding::{Finding, Span};

/// The finding for a construct, whose name is in the plural.
fn never(span: Span, name: &str, why: &str, help: &str) -> Finding {
    Finding::error(rules::NOT_IN_LANGUAGE, span, format!("{name} are not in this language"))
        .why(why)
        .help(help)
}

const NO_OBJECTS: &str = "the language has numbers, texts, lists and records, but no classes";
const NO_TIME: &str = "every text runs to its end at once and never waits";
const NO_EXCEPTIONS: &str = "mistakes are found before the run, so there is nothing to catch";
const STORE_HELP: &str = "store values in variables, as `ctx.peak`";

/// The finding for a reserved word of JavaScript where it is not allowed, or `None` for a word that is a name. One table, with
/// a row for each construct.
pub(super) fn word(word: &str, span: Span, host_terms: &HostTerms) -> Option<Finding> {
    let misplaced = |help: &str| {
        Finding::error(rules::MISPLACED, span, format!("`{word}` is not allowed here")).help(help)
    };
    Some(match word {
        "this" | "super" => {
            never(span, &format!("`{word}` references"), NO_OBJECTS, "name the object itself, as `ctx`")
        }
        "class" | "extends" | "enum" | "interface" => never(span, "classes", NO_OBJECTS, STORE_HELP),
        "new" => {
            never(span, "objects made with `new`", NO_OBJECTS, "write a list `[0, 0]` or a record `{a: 1}`")
        }
        "async" | "await" | "yield" => {
            never(span, &format!("`{word}` and waiting"), NO_TIME, host_terms.wait)
        }
        "try" | "catch" | "finally" | "throw" => {
            never(span, "exceptions", NO_EXCEPTIONS, "test for the case itself, with `if` or `? :`")
        }
        "import" | "export" => never(
            span,
            "modules",
            "a text cannot access anything outside itself",
            "use `Math` and the available functions",
        ),
        "delete" => never(
            span,
            "`delete` expressions",
            "a later reader of the variable should find a value, even if it is `null`",
            "store `null` or `undefined` instead",
        ),
        "void" => never(span, "`void` expressions", "they only give `undefined`", "write `undefined`"),
        "instanceof" | "in" => never(
            span,
            &format!("`{word}` tests"),
            "an unset variable is `undefined`, and a comparison can test for that",
            "to test for a value, write `ctx.start != null`",
        ),
        "with" => never(
            span,
            "`with` statements",
            "names must have the same meaning everywhere",
            "write the full names",
        ),
        "debugger" => never(
            span,
            "`debugger` statements",
            "a text does not run in a debugger",
            &format!("show the value in {}", host_terms.display),
        ),
        "switch" | "case" | "default" => never(
            span,
            "`switch` statements",
            "without a `break`, a case silently continues into the next one",
            "write `if … else if … else`, or choose a value with `test ? a : b`",
        ),
        "if" | "for" | "while" | "do" | "return" | "break" | "continue" => {
            misplaced("it starts a statement; to choose a value, write `test ? a : b`")
        }
        "else" => misplaced("`else` must directly follow the statement of its `if`"),
        _ => return None,
    })
}

/// `new Date()`
pub(super) fn new_date(span: Span, host_terms: &HostTerms) -> Finding {
    never(
        span,
        "dates",
        &format!(
            "a {} must give the same numbers in every run, so it cannot use the wall clock",
            host_terms.lesson
        ),
        host_terms.clock,
    )
}

/// Whether a word is reserved, so that it cannot be the name of a variable.
pub(super) fn is_reserved(text: &str) -> bool {
    let keywords = ["true", "false", "null", "const", "let", "var", "function", "typeof"];
    keywords.contains(&text) || word(text, Span::default(), &HostTerms::PLAIN).is_some()
}

/// The finding for a symbol that starts or continues an unsupported construct.
pub(super) fn symbol(text: &str, span: Span, host_terms: &HostTerms) -> Option<Finding> {
    Some(match text {
        "/" | "/=" => never(
            span,
            "regular expressions",
            &format!("a {} computes with numbers; text is only displayed", host_terms.lesson),
            "compare strings with `===`, or use `includes` and `startsWith`",
        ),
        "#" => never(
            span,
            "comments with `#`",
            "`#` starts a comment in Python; in JavaScript it is `//`",
            "write `//`",
        ),
        "@" => never(span, "decorators and private names", NO_OBJECTS, STORE_HELP),
        _ => return None,
    })
}

/// `for (key in object)`
pub(super) fn for_in(span: Span) -> Finding {
    never(
        span,
        "`for … in` loops",
        "they iterate over keys as text, in a surprising order",
        "write `for (const x of list)`, or count with `for (let i = 0; i < n; i++)`",
    )
}

/// A label, and `break` or `continue` to one.
pub(super) fn label(span: Span) -> Finding {
    never(
        span,
        "labels",
        "leaving several loops at once is hard to follow",
        "put the loops into a function and leave it with `return`",
    )
}

/// `(...rest) =>`
pub(super) fn rest(span: Span) -> Finding {
    never(
        span,
        "rest parameters",
        "their number would be known only during the run, so it could not be checked before",
        "pass one list, as `f([a, b])`",
    )
}

/// `function*`, `{ get x() {} }` and methods of literals.
pub(super) fn member_function(span: Span) -> Finding {
    never(span, "generators, getters and methods of literals", NO_OBJECTS, "write `{name: (x) => …}`")
}

/// The comma operator.
pub(super) fn comma(span: Span, decimal: Option<(Span, String)>) -> Finding {
    if let Some((number, meant)) = decimal {
        return Finding::error(rules::DECIMAL_COMMA, number, "this number has a decimal comma")
            .why("a comma separates values; the decimal separator is a point")
            .help(format!("write `{meant}`"))
            .guess(number, meant);
    }
    never(
        span,
        "values joined by a comma",
        "all values but the last would be computed and discarded",
        "separate statements with `;`",
    )
}

/// `var`, which is treated as `let` afterwards.
pub(super) fn var(span: Span) -> Finding {
    never(
        span,
        "`var` declarations",
        "a `var` name can be used before it has a value, which hides mistakes",
        "write `const`, or `let` if the value changes later",
    )
    .fix(span, "let")
}

/// `a ?? b || c` without parentheses.
pub(super) fn mixed(span: Span) -> Finding {
    Finding::error(rules::AMBIGUOUS_DEFAULT, span, "`??` is next to `||` or `&&` without parentheses")
        .why("it could group in two ways; JavaScript rejects it")
        .help("put one of them into parentheses, as `(a ?? b) || c`")
}
