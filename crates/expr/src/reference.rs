//! The reference page of the language, generated from the tables that compile and run it. Its examples are tested.

use std::fmt::Write;

use crate::ast::{BinaryOp, LogicalOp};
use crate::host_terms::HostTerms;
use crate::math;
use crate::natives::{self, ReceiverKind};
use crate::parse;

/// The grammar in the notation of ISO 14977, without the `,` between symbols: `{ }` repeats, `[ ]` is optional.
const GRAMMAR: &str = r#"
text         = { statement } ;                                   (* where statements are written *)
value        = expression ;                                      (* where a value is written *)
statement    = block | declaration | function | "if" "(" expression ")" statement [ "else" statement ]
             | "for" "(" [ declaration | effects ] ";" [ expression ] ";" [ effects ] ")" statement
             | "for" "(" ( "const" | "let" ) pattern "of" expression ")" statement
             | "while" "(" expression ")" statement | "do" statement "while" "(" expression ")"
             | "break" | "continue" | "return" [ expression ] | effects ;
block        = "{" { statement } "}" ;
declaration  = ( "const" | "let" ) pattern [ "=" expression ] { "," pattern [ "=" expression ] } ;
function     = "function" name parameters block ;
effects      = effect { "," effect } ;
effect       = expression | ( "++" | "--" ) place | place ( "++" | "--" ) ;
pattern      = name | "[" [ [ element ] { "," [ element ] } ] "]" | "{" [ entry { "," entry } ] "}" ;
element      = pattern [ "=" expression ] ;
entry        = name [ ":" pattern ] [ "=" expression ] ;
expression   = arrow | choice | place ( "=" | "+=" | "&&=" | "||=" | "??=" | … ) expression ;
arrow        = ( name | parameters ) "=>" ( expression | block ) ;
parameters   = "(" [ element { "," element } ] ")" ;
choice       = operation [ "?" expression ":" expression ] ;
operation    = unary { operator unary } ;
unary        = ( "-" | "+" | "!" | "~" | "typeof" ) unary | postfix ;
postfix      = primary { ( "." | "?." ) name | [ "?." ] "[" expression "]" | [ "?." ] "(" items ")" } ;
primary      = number | string | template | "true" | "false" | "null" | name | "(" expression ")"
             | "[" items "]" | "{" [ property { "," property } ] "}" | "function" parameters block ;
items        = [ [ "..." ] expression { "," [ "..." ] expression } ] ;
property     = name [ ":" expression ] | string ":" expression | "[" expression "]" ":" expression | "..." expression ;
template     = "`" { character | "${" expression "}" } "`" ;
place        = name | postfix "." name | postfix "[" expression "]" ;
"#;

/// A row of a table: the syntax, the result, and an example with its value.
struct ReferenceRow {
    name: String,
    doc: &'static str,
    example: (String, &'static str),
}

fn rows(receivers: &[ReceiverKind], array: &str) -> Vec<ReferenceRow> {
    let natives = natives::public_rows().filter(|r| receivers.contains(&r.on));
    let name = |row: &natives::Native| match row.calls() {
        true if row.on == ReceiverKind::Nothing => format!("{}(v, f)", row.name),
        true => format!("{}(f)", row.name),
        false => row.name.to_owned(),
    };
    natives.map(|r| ReferenceRow { name: name(r), doc: r.doc, example: r.example(array) }).collect()
}

fn functions_of_math() -> Vec<ReferenceRow> {
    let name = |name: &str| if name.starts_with("is") { name.to_owned() } else { format!("Math.{name}") };
    let rows = math::DOCS.iter();
    rows.map(|&(n, doc, (source, value))| ReferenceRow {
        name: name(n),
        doc,
        example: (source.into(), value),
    })
    .collect()
}

/// Writes a section with a table.
fn table(out: &mut String, title: &str, rows: Vec<ReferenceRow>) {
    let _ = write!(out, "\n## {title}\n\n| name | gives | example | value |\n|---|---|---|---|\n");
    for ReferenceRow { name, doc, example: (source, value) } in rows {
        let cell = |s: &str| s.replace('|', "\\|");
        let _ = writeln!(out, "| `{name}` | {} | `{}` | `{}` |", cell(doc), cell(&source), cell(value));
    }
}

/// Returns the page in Markdown, with the terms of a host.
pub fn language_page(host_terms: &HostTerms) -> String {
    let mut out = format!(
        "# The language of {0}s\n\nThe core of JavaScript that {0}s use. Values are JavaScript's, bit for bit: double arithmetic, `%`, `||` that returns an operand, numbers to text. The functions of `Math` whose result the standard leaves to the engine (`sin`, `exp`, `pow`, `**` …) are the same on every machine, and as near to node's as [measured](../measured/math.md).\n\n## Grammar\n\n```ebnf",
        host_terms.lesson
    );
    out.push_str(GRAMMAR);
    out.push_str("```\n\nA statement ends with `;`, with a line end where JavaScript ends it, or with `}`. Comments are `// …` and `/* … */`.\n\n## Operators\n\nFrom the loosest to the tightest:\n\n| level | operators |\n|---|---|\n");
    let logical = [LogicalOp::Or, LogicalOp::Nullish, LogicalOp::And];
    for power in 3..=14 {
        let binary = BinaryOp::ALL.iter().filter(|o| o.power() == power).map(|o| o.symbol());
        let symbols: Vec<String> = logical
            .iter()
            .filter(|o| o.power() == power)
            .map(|o| o.symbol())
            .chain(binary)
            .map(|s| format!("`{}`", s.replace('|', "\\|")))
            .collect();
        if !symbols.is_empty() {
            let _ = writeln!(out, "| {power} | {} |", symbols.join(" "));
        }
    }
    out.push_str("\n`**` groups from the right, all others from the left; a sign directly before `**` is rejected, as in JavaScript.\n");
    let sections = [
        (
            "Methods of lists and arrays",
            &[ReceiverKind::List, ReceiverKind::Growing, ReceiverKind::Untyped][..],
        ),
        ("Methods of texts", &[ReceiverKind::Text]),
        ("Methods of numbers", &[ReceiverKind::Number]),
        ("Functions", &[ReceiverKind::Nothing]),
    ];
    for (title, receivers) in sections {
        table(&mut out, title, rows(receivers, host_terms.array));
    }
    table(&mut out, "`Math`", functions_of_math());
    out.push_str("\nConstants: ");
    let constants: Vec<String> =
        math::names().filter(|n| math::constant(n).is_some()).map(|n| format!("`Math.{n}`")).collect();
    out.push_str(&constants.join(", "));
    out.push_str(".\n\nFunctions whose last digit the standard leaves open (`sin`, `log`, `**` with exponents other than 2, …) may differ from an engine's by one unit in the last place; they are the same on every platform here. A list has no holes: the elements between its end and an assignment beyond it are `undefined`.\n\n## Limits\n\n");
    let _ = writeln!(
        out,
        "A text has at most {} bytes and {} nested levels; a run does at most {} operations (an element that a method visits counts as five, a step of the {} as its own cost), functions call each other 200 deep, lists take 64 MB, a string 1 MB. Each limit has its own error.",
        parse::MAX_SOURCE,
        parse::MAX_DEPTH,
        crate::vm::MAX_WORK / crate::code::OPERATION,
        host_terms.world
    );
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock::execute;

    #[test]
    fn the_examples_give_their_results() {
        let all = rows(
            &[
                ReceiverKind::List,
                ReceiverKind::Growing,
                ReceiverKind::Untyped,
                ReceiverKind::Text,
                ReceiverKind::Number,
                ReceiverKind::Nothing,
            ],
            "data.qpos",
        );
        for ReferenceRow { name, example: (source, value), .. } in all.into_iter().chain(functions_of_math())
        {
            let (_, got) = execute(&format!("ctx.out = String({source})"));
            assert_eq!(got.to_string(), value, "{name}: {source}");
        }
        // Every function of `Math` has an example that calls it.
        for name in math::names().filter(|n| math::constant(n).is_none()) {
            let example = math::DOCS.iter().find(|(n, ..)| *n == name).map(|(.., (source, _))| *source);
            assert!(example.is_some_and(|e| e.contains(&format!("Math.{name}("))), "{name}: {example:?}");
        }
        assert!(language_page(&HostTerms::PLAIN).contains("| `map(f)` |"));
    }
}
