//! Laws of text and tree: reading what was printed gives the tree back, and no text makes the compiler panic.

use proptest::prelude::*;

use crate::ast::*;
use crate::mock::{Mock, World};
use crate::*;

fn bare(kind: ExprKind) -> Expr {
    Expr { kind, span: Span::default() }
}

fn name() -> impl Strategy<Value = Name> {
    prop::sample::select(vec!["a", "data", "qpos", "x_1", "$", "é"])
        .prop_map(|text| Name { text: text.into(), span: Span::default() })
}

fn expression() -> impl Strategy<Value = Expr> {
    let leaf = prop_oneof![
        prop_oneof![0.0..1e6f64, Just(1e300), Just(5e-324), Just(0.0), Just(f64::INFINITY)]
            .prop_map(|x| bare(ExprKind::Number(x))),
        any::<String>().prop_map(|s| bare(ExprKind::String(s))),
        any::<bool>().prop_map(|b| bare(ExprKind::Boolean(b))),
        Just(bare(ExprKind::Null)),
        name().prop_map(|n| bare(ExprKind::Name(n.text))),
    ];
    leaf.prop_recursive(5, 40, 3, |inner| {
        let one = || inner.clone().prop_map(Box::new);
        let many = || prop::collection::vec(inner.clone(), 0..3);
        let place = || {
            (name(), name()).prop_map(|(o, n)| {
                Box::new(bare(ExprKind::Member { object: Box::new(bare(ExprKind::Name(o.text))), name: n }))
            })
        };
        prop_oneof![
            (one(), name()).prop_map(|(object, name)| bare(ExprKind::Member { object, name })),
            (one(), one()).prop_map(|(object, index)| bare(ExprKind::Index { object, index })),
            (one(), many()).prop_map(|(callee, args)| bare(ExprKind::Call { callee, args })),
            many().prop_map(|items| bare(ExprKind::Array(items))),
            (prop::sample::select(vec![UnaryOp::Minus, UnaryOp::Plus, UnaryOp::Not, UnaryOp::BitNot]), one())
                .prop_map(|(op, operand)| bare(ExprKind::Unary { op, operand })),
            (prop::sample::select(BinaryOp::ALL.to_vec()), one(), one())
                .prop_map(|(op, left, right)| bare(ExprKind::Binary { op, left, right })),
            (any::<bool>(), one(), one()).prop_map(|(and, left, right)| {
                let op = if and { LogicalOp::And } else { LogicalOp::Or };
                bare(ExprKind::Logical { op, left, right })
            }),
            (one(), one(), one()).prop_map(|(test, then, otherwise)| bare(ExprKind::Conditional {
                test,
                then,
                otherwise
            })),
            (place(), one()).prop_map(|(target, value)| {
                bare(ExprKind::Assign { target, op: Some(BinaryOp::Power), op_span: Span::default(), value })
            }),
            (place(), any::<bool>(), any::<bool>())
                .prop_map(|(target, increment, prefix)| bare(ExprKind::Update { target, increment, prefix })),
        ]
    })
}

/// Forgets all places.
fn strip(e: &mut Expr) {
    e.span = Span::default();
    match &mut e.kind {
        ExprKind::Member { object, name } => {
            name.span = Span::default();
            strip(object);
        }
        ExprKind::Index { object: a, index: b }
        | ExprKind::Binary { left: a, right: b, .. }
        | ExprKind::Logical { left: a, right: b, .. } => {
            strip(a);
            strip(b);
        }
        ExprKind::Call { callee, args } => {
            strip(callee);
            args.iter_mut().for_each(strip);
        }
        ExprKind::Array(items) => items.iter_mut().for_each(strip),
        ExprKind::Unary { operand: a, .. } | ExprKind::Update { target: a, .. } => strip(a),
        ExprKind::Conditional { test, then, otherwise } => {
            [test, then, otherwise].into_iter().for_each(|x| strip(x))
        }
        ExprKind::Assign { target, value, op_span, .. } => {
            *op_span = Span::default();
            strip(target);
            strip(value);
        }
        _ => {}
    }
}

/// Pieces that make texts near the language.
fn shards() -> impl Strategy<Value = String> {
    let piece = prop::sample::select(vec![
        "data",
        ".",
        "qpos",
        "[",
        "]",
        "2",
        "(",
        ")",
        "=",
        "==",
        "ctx",
        "ctx.a",
        "const ",
        "let ",
        "x",
        ";",
        "\n",
        "+",
        "-",
        "**",
        "?",
        ":",
        "'a'",
        "`",
        "\"",
        "/",
        "/*",
        "//",
        "{",
        "}",
        "=>",
        "if",
        "for",
        "else ",
        "function ",
        "mj_setConst",
        "value",
        "final(",
        ",",
        "²",
        "−",
        "0x",
        "1e",
        ".5",
        "&&",
        "||",
        "!",
        "++",
        "+=",
        "Math.",
        "max",
        "NaN",
        "data.qpos.set([",
        "data.joint('light_free')",
        "\\",
        "é",
        " ",
        "do ",
        "while",
        "try{",
        "catch",
        "model.opt.gravity[2]",
        "data.xpos",
        "...",
        "?.",
        "var ",
    ]);
    prop::collection::vec(piece, 0..30).prop_map(|v| v.concat())
}

fn compile_all(source: &str) {
    let mut globals = Globals::new();
    let mut compiler = Compiler::new(&Mock, &mut globals);
    compiler.value = Some(Type::Any);
    for compiled in [compiler.expression(source), compiler.statements(source), compiler.assignment(source)] {
        for d in &compiled.diagnostics {
            assert!(source.get(d.span.start..d.span.end).is_some(), "{source:?}: {d:?}");
            assert!(code::ALL.iter().any(|(c, _)| *c == d.code));
            if let Some(fix) = &d.fix {
                assert!(source.get(fix.span.start..fix.span.end).is_some(), "{source:?}: {d:?}");
            }
        }
        assert_eq!(
            compiled.program.is_none(),
            compiled.diagnostics.iter().any(Diagnostic::is_error),
            "{source:?}: {:?}",
            compiled.diagnostics
        );
        if let Some(program) = compiled.program {
            let mut world = World::new();
            let _ = program.run(&mut world, &mut Context::new(), Some(&Value::Number(1.0)));
        }
    }
    globals.unset();
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1500) })]

    #[test]
    fn printing_and_reading_is_the_identity(tree in expression()) {
        let text = print(&tree);
        let mut parsed = parse_expression(&text);
        prop_assert!(parsed.diagnostics.is_empty(), "{text}: {:?}", parsed.diagnostics);
        strip(&mut parsed.tree);
        prop_assert_eq!(parsed.tree, tree, "{}", text);
    }

    #[test]
    fn no_text_makes_the_compiler_fail(source in shards()) {
        compile_all(&source);
    }

    #[test]
    fn no_characters_make_the_compiler_fail(source in any::<String>()) {
        compile_all(&source);
    }
}

#[test]
fn statements_print_one_a_line() {
    let parsed = parse_statements("const a=1,b = a*(2+3);data.qpos[ 0 ]+=-a ** 1\nlet c\nmj_setConst");
    let again =
        parse_statements("const a = 1, b = a * (2 + 3); data.qpos[0] += (-a) ** 1; let c; mj_setConst");
    assert_eq!(print_statements(&parsed.tree), print_statements(&again.tree));
    assert_eq!(
        print_statements(&again.tree),
        "const a = 1, b = a * (2 + 3);\ndata.qpos[0] += (-a) ** 1;\nlet c;\nmj_setConst;"
    );
}

#[test]
fn long_hostile_texts_end_soon() {
    let started = std::time::Instant::now();
    let pieces = [
        "a;",
        "a,",
        "qpso+",
        "f(a,",
        "data.qpso;",
        "“",
        "'",
        "`",
        "(a,",
        "a?",
        "[",
        "/*",
        "ctx.a=",
        "data.qpos[0]=1;",
        "if(",
        "const a=",
        "let a;",
        "x=>",
        "!",
        "0,5;",
        "Math.max(1,",
        "data.joint('a');",
    ];
    for piece in pieces {
        compile_all(&piece.repeat(MAX_SOURCE / piece.len()));
        let argument = piece.trim_end_matches([';', '+', ',', '(']);
        compile_all(&format!("Math.max({argument}{})", format!(", {argument}").repeat(500)));
    }
    // About a second; a quadratic search somewhere would take minutes.
    assert!(started.elapsed().as_secs() < 60);
}
