//! Constructs of JavaScript that are not read, in two families: what lessons do not have on purpose, with the
//! reason, and what is not supported yet, with what to write meanwhile.

use crate::code;
use crate::diagnostic::{Diagnostic, Span};

/// On purpose.
fn never(span: Span, name: &str, why: &str, help: &str) -> Diagnostic {
    Diagnostic::error(code::NOT_IN_LANGUAGE, span, format!("{name} are not in this language"))
        .why(why)
        .help(help)
}

/// Not yet.
fn not_yet(span: Span, name: &str, help: &str) -> Diagnostic {
    Diagnostic::error(code::NOT_SUPPORTED, span, format!("{name} are not supported yet")).help(help)
}

const NO_OBJECTS: &str = "a lesson works on numbers of the simulation; it has no objects of its own";
const NO_TIME: &str =
    "every text runs to its end between two steps of the simulation; nothing is ever waited for";
const NO_EXCEPTIONS: &str = "mistakes are found before the run, so there is nothing to catch";
const STORE_HELP: &str = "keep numbers in variables of the lab, as `ctx.peak`";

/// The finding for a reserved word of JavaScript; `None` for a word that is a name.
pub(super) fn word(word: &str, span: Span) -> Option<Diagnostic> {
    let name = format!("`{word}`");
    let statements = format!("`{word}` statements");
    Some(match word {
        "this" | "super" => never(
            span,
            &format!("{name} references"),
            NO_OBJECTS,
            "name the thing itself, as `data` or `ctx`",
        ),
        "class" | "extends" | "enum" | "interface" => never(span, "classes", NO_OBJECTS, STORE_HELP),
        "new" => never(span, "objects made with `new`", NO_OBJECTS, STORE_HELP),
        "async" | "await" | "yield" => {
            never(span, &format!("{name} and waiting"), NO_TIME, "test `data.time` in the controller instead")
        }
        "try" | "catch" | "finally" | "throw" => {
            never(span, "exceptions", NO_EXCEPTIONS, "test for the case itself, with `? :`")
        }
        "import" | "export" => never(
            span,
            "modules",
            "a lesson reaches nothing outside itself",
            "use `Math` and the functions that the lab offers",
        ),
        "delete" => never(span, "`delete` expressions", NO_OBJECTS, "store `null` or `undefined` instead"),
        "void" => never(span, "`void` expressions", "they only give `undefined`", "write `undefined`"),
        "instanceof" | "in" => {
            never(span, &format!("{name} tests"), NO_OBJECTS, "compare with a value, as `ctx.start == null`")
        }
        "with" => never(span, &statements, "names must mean the same everywhere", "write the names in full"),
        "debugger" => never(
            span,
            "`debugger` statements",
            "a lesson is not run in a debugger",
            "show the value in a readout",
        ),
        "if" | "else" => not_yet(
            span,
            &statements,
            "choose a value with `test ? a : b`, as `data.ctrl[0] = data.time > 1 ? 5 : 0`",
        ),
        "for" | "while" | "do" => not_yet(span, "loops", "write the statements out, one for each index"),
        "switch" | "case" | "default" => {
            not_yet(span, "`switch` statements", "choose a value with `test ? a : b`")
        }
        "break" | "continue" => not_yet(span, "loops", "write the statements out"),
        "return" => not_yet(span, "`return` statements", "write the value itself, or store it in `ctx`"),
        "function" => not_yet(span, "functions of one's own", "write the expression where it is needed"),
        "typeof" => {
            not_yet(span, "`typeof` tests", "compare with `null` or `undefined`, as `ctx.start == null`")
        }
        "var" | "const" | "let" | "true" | "false" | "null" => return None,
        _ => return None,
    })
}

/// The finding for a symbol that starts or continues a construct that is not read.
pub(super) fn symbol(text: &str, span: Span) -> Option<Diagnostic> {
    Some(match text {
        "=>" => not_yet(span, "arrow functions", "write the expression where it is needed"),
        "..." => not_yet(span, "spreads", "write the elements out"),
        "?." => not_yet(span, "optional members", "write `.`: names are checked before the run"),
        "??" | "??=" => not_yet(span, "`??` defaults", "write `x == null ? y : x`"),
        "&&=" | "||=" => not_yet(span, "logical assignments", "write `x = x || y`"),
        "{" => {
            not_yet(span, "object literals and blocks", "store the parts one by one, as `ctx.a` and `ctx.b`")
        }
        "/" | "/=" => never(
            span,
            "regular expressions",
            "a lesson computes with numbers; text is only shown",
            "compare strings with `===`",
        ),
        "@" | "#" => never(span, "decorators and private names", NO_OBJECTS, STORE_HELP),
        _ => return None,
    })
}

/// A template literal.
pub(super) fn template(span: Span) -> Diagnostic {
    not_yet(span, "template literals", "join the parts with `+`, as `\"h = \" + model.opt.timestep`")
}

/// A pattern on the left of a declaration.
pub(super) fn pattern(span: Span) -> Diagnostic {
    not_yet(span, "declarations that take an object or array apart", "declare one name after the other")
}

/// The comma operator.
pub(super) fn comma(span: Span, decimal: Option<(Span, String)>) -> Diagnostic {
    if let Some((number, meant)) = decimal {
        return Diagnostic::error(code::UNEXPECTED, number, "a decimal comma")
            .why("a comma separates things; the decimal sign is a point")
            .help(format!("write `{meant}`"))
            .fix(number, meant);
    }
    not_yet(span, "expressions joined by a comma", "separate statements with `;`")
}

/// `var`, which is read as `let` after this.
pub(super) fn var(span: Span) -> Diagnostic {
    never(
        span,
        "`var` declarations",
        "a `var` name can be used before it has a value, which hides mistakes",
        "write `const`, or `let` when the value changes later",
    )
    .fix(span, "let")
}
