//! The signature of the call around a position of a source text that may be incomplete, and the argument at the position.

use crate::chain::{PathMeaning, Tokens};
use crate::complete::{OpenConstruct, unclosed};
use crate::lex::TokenKind;
use crate::math::{self, MathFunction};
use crate::natives::{self, Native};
use crate::schema::{Schema, parameters};
use crate::types::Type;
use labspec_finding::Span;

/// Limit on the number of enclosing brackets that are searched for a call.
const MAX_BRACKETS: usize = 64;
/// The maximum number of parameters that are listed of a function that takes any number.
const FEW: usize = 3;
/// What follows the parameters of a function that takes any number.
const MORE: &str = "…";

/// The signature of a call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CallSignature {
    /// The function with its parameters: `Math.atan2(x, y)`.
    pub label: String,
    /// The bytes of the label that name each parameter.
    pub params: Vec<Span>,
    /// The index of the parameter at the position; `None` if the function has no such parameter.
    pub active: Option<usize>,
    /// Its documentation.
    pub doc: String,
}

/// Returns the signature of the innermost call whose arguments contain byte `offset`. `None` outside of calls, in comments,
/// and for functions that the text itself defines.
pub fn signature_at(schema: &dyn Schema, source: &str, offset: usize) -> Option<CallSignature> {
    let offset = labspec_finding::floor(source, offset);
    let before = source.get(..offset)?;
    let end = match unclosed(before) {
        OpenConstruct::Comment => return None,
        OpenConstruct::Text(start) => start,
        OpenConstruct::Nothing => offset,
    };
    let all = Tokens::read(schema, source.get(..end)?);
    let mut position = all.len();
    for _ in 0..MAX_BRACKETS {
        let (open, argument) = opening_before(&all, position)?;
        position = open;
        let before_open = open.checked_sub(1).and_then(|i| all.kind(i));
        match (all.kind(open)?, before_open) {
            // `if (`, `for (`: statements are not calls.
            (TokenKind::Symbol("("), Some(TokenKind::Word("if" | "for" | "while" | "switch"))) => {
                return None;
            }
            (TokenKind::Symbol("("), Some(TokenKind::Word(_) | TokenKind::Symbol(")" | "]"))) => {
                return called(schema, &all, open).map(|shape| shape.at(argument));
            }
            // Parentheses around a part of an argument, and list literals in it.
            (TokenKind::Symbol("(" | "["), _) => {}
            // An object literal. The braces of a function's body are no argument.
            (TokenKind::Symbol("{"), Some(TokenKind::Symbol("(" | "," | ":" | "["))) => {}
            _ => return None,
        }
    }
    None
}

/// Whether byte `offset` is in an argument of a function that the host evaluates over many samples.
pub fn is_in_aggregate(schema: &dyn Schema, source: &str, offset: usize) -> bool {
    let before = source.get(..labspec_finding::floor(source, offset)).unwrap_or("");
    let all = Tokens::read(schema, before);
    let mut position = all.len();
    while let Some((open, _)) = opening_before(&all, position) {
        position = open;
        if let Some((PathMeaning::Function(id), _)) = all.meaning(open)
            && schema.function(id).aggregate
        {
            return true;
        }
    }
    false
}

/// Whether byte `offset` is inside of brackets.
pub fn is_in_brackets(source: &str, offset: usize) -> bool {
    let before = source.get(..labspec_finding::floor(source, offset)).unwrap_or("");
    let all = Tokens::syntax(before);
    opening_before(&all, all.len()).is_some()
}

/// The innermost bracket that is open before a token, and the number of commas between its parts.
fn opening_before(all: &Tokens<'_>, end: usize) -> Option<(usize, usize)> {
    let (mut depth, mut commas, mut index) = (0usize, 0, end);
    loop {
        index = index.checked_sub(1)?;
        match all.kind(index)? {
            TokenKind::Symbol(")" | "]" | "}") => depth += 1,
            TokenKind::Symbol("(" | "[" | "{") if depth == 0 => return Some((index, commas)),
            TokenKind::Symbol("(" | "[" | "{") => depth -= 1,
            TokenKind::Symbol(",") if depth == 0 => commas += 1,
            _ => {}
        }
    }
}

/// A function with its parameters.
struct FunctionShape {
    name: String,
    params: Vec<String>,
    /// Whether more arguments of the last kind may follow.
    many: bool,
    doc: String,
}

impl FunctionShape {
    /// The signature with the argument of an index.
    fn at(self, argument: usize) -> CallSignature {
        let mut label = format!("{}(", self.name);
        let mut params = Vec::new();
        let more = self.many.then(|| MORE.to_string());
        for (i, text) in self.params.iter().chain(&more).enumerate() {
            if i > 0 {
                label.push_str(", ");
            }
            params.push(Span::new(label.len(), label.len() + text.len()));
            label.push_str(text);
        }
        label.push(')');
        let last = params.len().saturating_sub(1);
        let argument = if self.many { argument.min(last) } else { argument };
        let active = (argument < params.len()).then_some(argument);
        CallSignature { label, params, active, doc: self.doc }
    }
}

/// The function that is called with the parenthesis at a token.
fn called(schema: &dyn Schema, all: &Tokens<'_>, open: usize) -> Option<FunctionShape> {
    match all.meaning(open).map(|(meaning, _)| meaning) {
        Some(PathMeaning::Function(id)) => {
            let info = schema.function(id);
            let params = parameters(schema, &info);
            Some(FunctionShape { name: info.name, params, many: false, doc: info.doc })
        }
        Some(PathMeaning::Collection(id)) => {
            let Some(TokenKind::Word(name)) = all.kind(open.checked_sub(1)?) else { return None };
            let noun = schema.noun(id);
            let params = vec![format!("\"name of a {noun}\"")];
            let doc = format!("the {noun} of this name");
            Some(FunctionShape { name: (*name).to_string(), params, many: false, doc })
        }
        Some(_) => None,
        None => language_function(all, open),
    }
}

/// A function of the language: of `Math`, a global one, a free one such as `Array.from`, or a method.
fn language_function(all: &Tokens<'_>, open: usize) -> Option<FunctionShape> {
    let index = open.checked_sub(1)?;
    let Some(TokenKind::Word(name)) = all.kind(index) else { return None };
    let point = index.checked_sub(1).and_then(|i| all.kind(i));
    if !matches!(point, Some(TokenKind::Symbol("." | "?."))) {
        let global = math::global(name).map(of_math);
        return global.or_else(|| natives::find_function(name).map(|f| of_native(f.row())));
    }
    let receiver = index.checked_sub(2)?;
    match (all.meaning(receiver + 1).map(|(meaning, _)| meaning), all.kind(receiver)) {
        (Some(PathMeaning::Math), _) => math::function(name).map(of_math),
        (Some(PathMeaning::Field(_)), _) => method(name, Type::View),
        (Some(PathMeaning::Value(ty)), _) => method(name, ty),
        (None, Some(TokenKind::Word(holder))) => {
            let free = natives::find_function(&format!("{holder}.{name}"));
            free.map(|f| of_native(f.row())).or_else(|| method(name, Type::Any))
        }
        _ => method(name, Type::Any),
    }
}

/// A method that values of a type have.
fn method(name: &str, of: Type) -> Option<FunctionShape> {
    natives::find_method(name)?.rows_for(of).next().map(of_native)
}

fn of_math(function: MathFunction) -> FunctionShape {
    let (least, most) = function.arity();
    let count = most.unwrap_or(least.max(2));
    let params = ["x", "y"].iter().take(count).map(|name| (*name).to_string());
    // The parameters of `atan2` are named as in its description.
    let mut params: Vec<String> = params.collect();
    if function.name() == "atan2" {
        params.reverse();
    }
    FunctionShape { name: function.path(), params, many: most.is_none(), doc: function.doc().to_string() }
}

fn of_native(row: &Native) -> FunctionShape {
    let (least, most) = row.arity();
    let takes_function = matches!(row.body, natives::Implementation::Source(_));
    let many = most > FEW.max(least);
    let count = if many { least } else { most };
    let name = |i: usize| match i {
        0 if takes_function && row.on != natives::ReceiverKind::Nothing => "function".to_string(),
        i => format!("value{}", if count > 1 { (i + 1).to_string() } else { String::new() }),
    };
    let params = (0..count).map(name).collect();
    FunctionShape { name: row.title(), params, many, doc: row.doc.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock::Mock;

    /// The label with its active parameter in brackets.
    fn described(marked: &str) -> String {
        let offset = marked.find('|').unwrap();
        let Some(found) = signature_at(&Mock, &marked.replacen('|', "", 1), offset) else {
            return String::new();
        };
        let mut label = found.label;
        if let Some(span) = found.active.and_then(|i| found.params.get(i).copied()) {
            label.replace_range(span.end..span.end, "]");
            label.replace_range(span.start..span.start, "[");
        }
        label
    }

    #[test]
    fn the_innermost_call_and_its_argument_are_found() {
        for (text, expected) in [
            ("Math.atan2(|", "Math.atan2([y], x)"),
            ("Math.atan2(1, |", "Math.atan2(y, [x])"),
            ("Math.atan2(1, 2, |)", "Math.atan2(y, x)"),
            ("Math.max(1, 2, 3, |)", "Math.max(x, y, […])"),
            ("1 + Math.sqrt((2 * (3 + |", "Math.sqrt([x])"),
            ("Math.pow([1, 2, 3][|], 2)", "Math.pow([x], y)"),
            ("isNaN(|)", "isNaN([x])"),
            ("norm(|)", "norm([list])"),
            ("bodyId('he|avy')", "bodyId([\"name of a body\"])"),
            ("data.joint('|", "joint([\"name of a joint\"])"),
            ("Math.hypot(bodyId('heavy'), |", "Math.hypot(x, [y], …)"),
            ("data.qpos.map(|)", ".map([function])"),
            ("const v = [1]; v.slice(1, |)", ".slice(value1, [value2])"),
            ("Array.from(|)", "Array.from([value])"),
            // Outside of calls.
            ("|Math.sqrt(1)", ""),
            ("Math.sqrt(1)|", ""),
            ("if (|", ""),
            ("(1 + |", ""),
            ("const f = (x) => { |", ""),
            ("data.qpos.map((x) => { |", ""),
            ("// Math.sqrt(|", ""),
            ("unknown(|", ""),
        ] {
            assert_eq!(described(text), expected, "{text}");
        }
    }
}
