//! Laws of source text and tree: parsing a printed tree gives the same tree, and no text makes the compiler panic.

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

fn boxed(kind: ExprKind) -> Box<Expr> {
    Box::new(bare(kind))
}

pub(crate) fn expression() -> BoxedStrategy<Expr> {
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
        let items = || {
            let item = (inner.clone(), prop::bool::weighted(0.2));
            prop::collection::vec(
                item.prop_map(|(e, s)| if s { bare(ExprKind::Spread(Box::new(e))) } else { e }),
                0..3,
            )
        };
        let place = || {
            (name(), name()).prop_map(|(o, name)| {
                boxed(ExprKind::Member { object: boxed(ExprKind::Name(o.text)), name, optional: false })
            })
        };
        let unary = vec![UnaryOp::Minus, UnaryOp::Plus, UnaryOp::Not, UnaryOp::BitNot, UnaryOp::TypeOf];
        let logical = || prop::sample::select(vec![LogicalOp::And, LogicalOp::Or, LogicalOp::Nullish]);
        let property = prop_oneof![
            (name(), inner.clone()).prop_map(|(key, value)| Property::Named { key, value }),
            (any::<String>(), inner.clone()).prop_map(|(text, value)| {
                Property::Named { key: Name { text, span: Span::default() }, value }
            }),
            (inner.clone(), inner.clone()).prop_map(|(key, value)| Property::Computed { key, value }),
            inner.clone().prop_map(Property::Spread),
        ];
        let calls = prop_oneof![
            (one(), name()).prop_map(|(object, name)| bare(ExprKind::Member {
                object,
                name,
                optional: false
            })),
            (one(), one()).prop_map(|(object, index)| bare(ExprKind::Index {
                object,
                index,
                optional: false
            })),
            (one(), items()).prop_map(|(callee, args)| bare(ExprKind::Call {
                callee,
                args,
                optional: false
            })),
            (one(), name(), name()).prop_map(|(object, a, b)| {
                let object = boxed(ExprKind::Member { object, name: a, optional: true });
                bare(ExprKind::Chain(boxed(ExprKind::Member { object, name: b, optional: false })))
            }),
            (one(), one()).prop_map(|(object, index)| {
                bare(ExprKind::Chain(boxed(ExprKind::Index { object, index, optional: true })))
            }),
        ];
        let literals = prop_oneof![
            items().prop_map(|items| bare(ExprKind::Array(items))),
            prop::collection::vec(property, 0..3).prop_map(|p| bare(ExprKind::Object(p))),
            (prop::collection::vec((any::<String>(), inner.clone()), 0..3), any::<String>()).prop_map(
                |(parts, last)| {
                    let (mut texts, values): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
                    texts.push(last);
                    bare(ExprKind::Template { texts, values })
                }
            ),
            (elements(inner.clone()), inner.clone())
                .prop_map(|(params, value)| function(params, Body::Value(value))),
            (elements(inner.clone()), statements(inner.clone()))
                .prop_map(|(params, s)| function(params, Body::Block(s))),
        ];
        let operators = prop_oneof![
            (prop::sample::select(unary), one())
                .prop_map(|(op, operand)| bare(ExprKind::Unary { op, operand })),
            (prop::sample::select(BinaryOp::ALL.to_vec()), one(), one())
                .prop_map(|(op, left, right)| bare(ExprKind::Binary { op, left, right })),
            (logical(), one(), one()).prop_map(|(op, left, right)| bare(ExprKind::Logical {
                op,
                left,
                right
            })),
            (one(), one(), one()).prop_map(|(test, then, otherwise)| bare(ExprKind::Conditional {
                test,
                then,
                otherwise
            })),
            (place(), one()).prop_map(|(target, value)| {
                bare(ExprKind::Assign { target, op: Some(BinaryOp::Power), op_span: Span::default(), value })
            }),
            (place(), logical(), one()).prop_map(|(target, op, value)| {
                bare(ExprKind::AssignLogical { target, op, op_span: Span::default(), value })
            }),
            (place(), any::<bool>(), any::<bool>())
                .prop_map(|(target, increment, prefix)| bare(ExprKind::Update { target, increment, prefix })),
        ];
        prop_oneof![2 => calls, 3 => literals, 5 => operators]
    })
    .boxed()
}

fn function(params: Vec<Element>, body: Body) -> Expr {
    bare(ExprKind::Function(Box::new(Function { name: None, params, body, span: Span::default() })))
}

/// Names, list patterns and record patterns, with defaults.
fn elements(value: impl Strategy<Value = Expr> + Clone + 'static) -> impl Strategy<Value = Vec<Element>> {
    let plain = (name(), prop::option::weighted(0.2, value))
        .prop_map(|(name, default)| Element { target: Pattern::Name(name), default });
    let element = plain.boxed().prop_recursive(2, 4, 2, move |inner| {
        let item = prop::option::weighted(0.8, inner.clone());
        prop_oneof![
            prop::collection::vec(item, 0..3).prop_map(|items| Element {
                target: Pattern::List { items, span: Span::default() },
                default: None
            }),
            prop::collection::vec((name(), inner), 0..3).prop_map(|entries| Element {
                target: Pattern::Record { entries, span: Span::default() },
                default: None
            }),
        ]
    });
    prop::collection::vec(element, 0..3)
}

fn stmt(kind: StmtKind) -> Stmt {
    Stmt { kind, span: Span::default() }
}

fn statements(value: impl Strategy<Value = Expr> + Clone + 'static) -> impl Strategy<Value = Vec<Stmt>> {
    let v = move || value.clone();
    let declare = {
        let v = v.clone();
        move || {
            (any::<bool>(), elements(v()), v()).prop_map(|(constant, elements, value)| {
                let targets = elements.into_iter().map(|e| e.target);
                let declarators: Vec<_> =
                    targets.map(|target| Declarator { target, value: Some(value.clone()) }).collect();
                match declarators.is_empty() {
                    true => stmt(StmtKind::Break),
                    false => stmt(StmtKind::Declare { constant, declarators }),
                }
            })
        }
    };
    let leaf = prop_oneof![
        v().prop_map(|e| stmt(StmtKind::Expr(e))),
        prop::option::of(v()).prop_map(|e| stmt(StmtKind::Return(e))),
        Just(stmt(StmtKind::Continue)),
        (name(), elements(v()), v()).prop_map(|(name, params, value)| {
            let body = Body::Block(vec![stmt(StmtKind::Return(Some(value)))]);
            let function = Box::new(Function { name: None, params, body, span: Span::default() });
            stmt(StmtKind::Function { name, function })
        }),
    ];
    let nested = leaf.prop_recursive(3, 10, 3, move |inner| {
        let body = || inner.clone().prop_map(|s| Box::new(braced(s)));
        let w = &v;
        prop_oneof![
            (w(), body(), prop::option::of(body())).prop_map(|(test, then, otherwise)| {
                // Without braces, the `else` would belong to an inner `if`.
                let then =
                    if otherwise.is_some() { Box::new(stmt(StmtKind::Block(vec![*then]))) } else { then };
                stmt(StmtKind::If { test, then, otherwise })
            }),
            (w(), body()).prop_map(|(test, body)| stmt(StmtKind::While { test, body })),
            (w(), body()).prop_map(|(test, body)| stmt(StmtKind::DoWhile { body, test })),
            (name(), w(), body()).prop_map(|(name, items, body)| {
                stmt(StmtKind::ForOf { constant: true, target: Pattern::Name(name), items, body })
            }),
            (prop::option::of(declare()), prop::option::of(w()), prop::option::of(w()), body()).prop_map(
                |(init, test, update, body)| {
                    let init = init.filter(|s| matches!(s.kind, StmtKind::Declare { .. })).map(Box::new);
                    stmt(StmtKind::For { init, test, update, body })
                }
            ),
            prop::collection::vec(inner.clone(), 0..3).prop_map(|s| stmt(StmtKind::Block(s))),
        ]
    });
    prop::collection::vec(nested, 0..3)
}

/// A function declaration is not allowed as the only body of a condition.
fn braced(s: Stmt) -> Stmt {
    match s.kind {
        StmtKind::Function { .. } => stmt(StmtKind::Block(vec![s])),
        _ => s,
    }
}

/// The tree without its spans.
fn bones(tree: &impl std::fmt::Debug) -> String {
    let text = format!("{tree:?}");
    let mut out = String::new();
    let mut rest = text.as_str();
    while let Some(start) = rest.find("Span { start: ") {
        out += &rest[..start];
        rest = &rest[start..];
        rest = &rest[rest.find('}').unwrap_or(0) + 1..];
    }
    out + rest
}

/// Fragments for texts that resemble the language.
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
    let mut compiler = Compiler::new(&Mock, &mut globals).with_value(Some(Type::Any));
    for compiled in [compiler.expression(source), compiler.statements(source), compiler.assignment(source)] {
        for d in &compiled.diagnostics {
            assert!(source.get(d.span.start..d.span.end).is_some(), "{source:?}: {d:?}");
            assert!(rules::ALL.iter().any(|rule| *d.code == **rule));
            if let Some(fix) = &d.fix {
                assert!(source.get(fix.span.start..fix.span.end).is_some(), "{source:?}: {d:?}");
            }
        }
        assert_eq!(
            compiled.program.is_none(),
            compiled.diagnostics.iter().any(Finding::is_error),
            "{source:?}: {:?}",
            compiled.diagnostics
        );
        if let Some(program) = compiled.program {
            let mut world = World::new();
            let _ = program.run(&mut world, &mut Context::new(), Some(&Value::Number(1.0)));
        }
    }
    globals.unset(&HostTerms::PLAIN);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1500) })]

    #[test]
    fn printing_and_reading_is_the_identity(tree in expression()) {
        let text = print(&tree);
        let parsed = parse_expression(&text);
        prop_assert!(parsed.diagnostics.is_empty(), "{text}: {:?}", parsed.diagnostics);
        prop_assert_eq!(bones(&parsed.tree), bones(&tree), "{}", text);
        prop_assert_eq!(print(&parsed.tree), text.as_str());
        match format_expression(&text) {
            Some(again) => prop_assert_eq!(again, text),
            // A template that contains something like a comment is not formatted.
            None => prop_assert!(text.contains("//") || text.contains("/*"), "{}", text),
        }
    }

    #[test]
    fn printing_and_reading_statements_is_the_identity(tree in statements(expression())) {
        let text = print_statements(&tree);
        let parsed = parse_statements(&text);
        prop_assert!(parsed.diagnostics.is_empty(), "{text}: {:?}", parsed.diagnostics);
        prop_assert_eq!(bones(&parsed.tree), bones(&tree), "{}", text);
        prop_assert_eq!(print_statements(&parsed.tree), text.as_str());
        // On one line, the statements are the same.
        let Some(line) = format_statements(&text.replace('\n', " ")) else { return Ok(()) };
        prop_assert_eq!(bones(&parse_statements(&line).tree), bones(&tree), "{}", line);
        prop_assert!(!line.contains('\n'));
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
fn formatting_keeps_choices_of_the_author() {
    for (source, expression) in [
        ("1000*( data.qpos[2]-0.050 )", Some("1000 * (data.qpos[2] - 0.050)")),
        ("lib.bodyPos(\"cube\")[ 2 ]", Some("lib.bodyPos('cube')[2]")),
        ("(1e-3 ).toFixed( 2 )+'it\\'s'", Some("(1e-3).toFixed(2) + \"it's\"")),
        ("data.time // seconds", None),
        ("`${1 /* one */}`", None),
        ("'http://here'", Some("'http://here'")),
        ("data.time +", None),
    ] {
        assert_eq!(format_expression(source).as_deref(), expression, "{source}");
    }
    for (source, statements) in [
        ("data.qpos[0]=1;data.qvel.fill(0);", Some("data.qpos[0] = 1; data.qvel.fill(0)")),
        ("if(a){b();c()}else d()", Some("if (a) { b(); c(); } else d();")),
        ("for(let i=0;i<3;i++);", Some("for (let i = 0; i < 3; i++) ;")),
        (
            "const f=(x)=>{return x*x}\nctx.a=f(2)",
            Some("const f = (x) => {\n  return x * x;\n};\nctx.a = f(2);"),
        ),
        // A function that calls itself by name keeps the name; a function without a name becomes an arrow function.
        (
            "const g=function f(x){return f(x-1)};const h=function(x){return x}",
            Some("const g = function f(x) { return f(x - 1); }; const h = (x) => { return x; }"),
        ),
        ("(function f(){f()})()", Some("(function f() { f(); })()")),
        ("a = 1; /* why */ b = 2", None),
    ] {
        assert_eq!(format_statements(source).as_deref(), statements, "{source}");
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
    // Usually about a second. A quadratic search would take minutes.
    assert!(started.elapsed().as_secs() < 60);
}
