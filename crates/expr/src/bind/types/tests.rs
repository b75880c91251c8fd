//! Type inference terminates after few rounds with a valid result, for any input.

use super::binder::{BindContext, BoundText, bind};
use super::facts::{FactKey, FactKind, TypeFacts};
use crate::bind::names::{NameContext, resolve};
use crate::bind::source::SourceTree;
use crate::globals::Globals;
use crate::mock::{Mock, execute};
use crate::parse_statements;
use crate::types::Type;

/// All types.
const TYPES: [Type; 13] = [
    Type::Number,
    Type::Boolean,
    Type::String,
    Type::Null,
    Type::Undefined,
    Type::Any,
    Type::Void,
    Type::List,
    Type::Record,
    Type::Function,
    Type::View,
    Type::Never,
    Type::Element,
];

fn bound(source: &str) -> BoundText {
    let parsed = parse_statements(source);
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics);
    let tree = SourceTree::Statements(&parsed.tree);
    let mut globals = Globals::new();
    let around = NameContext { schema: Some(&Mock), globals: &globals, mode: tree.mode(), has_value: false };
    let (names, found) = resolve(around, |walk| walk.block(&parsed.tree));
    assert!(found.is_empty() && !names.stopped, "{found:?}");
    let id = globals.next_program();
    let mut context = BindContext { schema: &Mock, globals: &mut globals, value: None, explains: false };
    bind(&mut context, source, tree, &names, id)
}

#[test]
fn types_join_in_a_lattice_of_four_levels() {
    for a in TYPES {
        assert_eq!(a.or(a), a);
        assert_eq!(a.or(Type::Never), a);
        assert_eq!(a.or(Type::Any), Type::Any);
        for b in TYPES {
            assert_eq!(a.or(b), b.or(a));
            for c in TYPES {
                assert_eq!(a.or(b).or(c), a.or(b.or(c)), "{a:?} {b:?} {c:?}");
                // No value, a value, a number or undefined, any: a type that is joined with other types
                // widens at most three times.
                let steps = [Type::Never, a, a.or(b), a.or(b).or(c)];
                assert!(steps.windows(2).filter(|w| w[0] != w[1]).count() <= 3);
            }
        }
    }
    let key = FactKey { site: 0, offset: 0, what: FactKind::Name };
    let mut facts = TypeFacts::default();
    for ty in TYPES {
        facts.widen(key, ty);
    }
    assert_eq!(facts.found(key), Type::Any);
}

/// A program in which type information flows from the last statement to the first, by one statement per round.
fn backwards(n: usize, first: &str, step: impl Fn(usize) -> String) -> String {
    let declared: String = (0..=n).map(|i| format!("let a{i} = {first};")).collect();
    let steps: String = (0..n).map(step).collect();
    format!("{declared} for (let i = 0; i < {n}; i++) {{ {steps} }} ctx.out = a0; ctx.free = data.time;")
}

#[test]
fn programs_that_are_made_to_be_slow_take_few_rounds() {
    let slow = [
        backwards(800, "1", |i| format!("a{i} = a{};", i + 1)) + "a800 = 'x'",
        backwards(700, "1", |i| format!("a{i} = a{} + 1;", i + 1)) + "a700 = 'x'",
        backwards(180, "1", |i| format!("a{i} = a{}.map(x => x);", i + 1)) + "a180 = ctx.z",
        backwards(400, "[1]", |i| format!("a{i} = a{}[0];", i + 1)),
        backwards(500, "''", |i| format!("a{i} = a{}.at(0);", i + 1)),
        backwards(90, "1", |i| {
            format!("const f{i} = x => {{ a{i} = a{}; return x }}; a{i} = f{i}(a{});", i + 1, i + 1)
        }),
        (0..40)
            .map(|i| format!("function f{i}(x) {{ return f{}(f{}(x)) }}", (i + 1) % 40, (i * 7) % 40))
            .collect(),
        (0..100).map(|i| format!("let b{i} = () => b{}; b{i} = 'x' + b{i};", (i + 1) % 100)).collect(),
    ];
    for source in slow {
        let bound = bound(&source);
        assert!(bound.rounds <= 9, "{} rounds: {}", bound.rounds, source.split_at(60).0);
    }
}

#[test]
fn a_text_without_type_cycles_takes_one_round() {
    for source in [
        "const a = data.time; const b = a * 2; ctx.out = b + a",
        "const f = x => x * x; ctx.out = f(2) + f(data.time)",
        "ctx.out = data.qpos.map(x => x + 1).some(x => x > 0)",
        "let s = 0; for (let i = 0; i < 14; i++) s += data.qpos[i]; ctx.out = s",
    ] {
        assert_eq!(bound(source).rounds, 1, "{source}");
    }
}

#[test]
fn the_types_of_the_last_round_are_those_of_the_run() {
    // All variables are numbers, until a string is assigned through all of them.
    let n = 40;
    let steps: String = (0..n).map(|i| format!("a{i} = a{};", i + 1)).collect();
    let handed = format!(" a{n} = 'x'; for (let k = 0; k < {n}; k++) {{ {steps} }} ctx.out");
    let source = backwards(n, "1", |i| format!("a{i} = a{};", i + 1)).replace(" ctx.out", &handed);
    assert_eq!(execute(&source).1.to_string(), "x");
}
