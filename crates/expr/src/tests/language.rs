//! Statements, functions, lists, records, methods and limits, as tables of a source text and the value of `ctx.out`.

use crate::mock::{Mock, World, execute};
use crate::*;

fn check_rows(rows: &[(&str, &str)]) {
    for (source, expected) in rows {
        let source = format!("{source}; ctx.out = String(ctx.out)");
        assert_eq!(execute(&source).1.to_string(), *expected, "{source}");
    }
}

#[test]
fn conditions_and_loops() {
    check_rows(&[
        ("if (data.time > 1) ctx.out = 1; else if (data.ncon) ctx.out = 2; else ctx.out = 3", "2"),
        ("let s = 0; for (let i = 0; i < 5; i++) s += i; ctx.out = s", "10"),
        (
            "let s = ''; for (const x of [1, 'a', null]) { if (x === 'a') continue; s += x } ctx.out = s",
            "1null",
        ),
        ("let n = 0; while (true) { n++; if (n > 7) break } ctx.out = n", "8"),
        ("let n = 9; do { n-- } while (n > 3); ctx.out = n", "3"),
        ("let s = 0; for (const v of data.qvel) s += v; ctx.out = s", "2466"),
        ("let s = ''; for (const c of 'aé😀') s = c + s; ctx.out = s", "😀éa"),
        ("for (let i = 0, j = 10; i < j; i++, j--) ctx.out = i * 100 + j", "406"),
    ]);
    assert_eq!(execute("ctx.out = 1; if (data.time === 0) return; ctx.out = 2").1, Value::Number(1.0));
    let (world, _) = execute("for (let g = 0; g < model.geom_solref.length; g++) model.geom_solref[g] = 7");
    assert_eq!(world.fields[9], [7.0; 4]);
}

/// A function of the host is a value where a method calls it for every element, and it may get another name.
#[test]
fn functions_of_the_host_as_callbacks() {
    check_rows(&[
        ("ctx.out = ['heavy', 'light'].map(bodyId)", "1,2"),
        ("ctx.out = ['heavy', 'light'].map(n => bodyId(n))", "1,2"),
        ("ctx.out = Array.from(['light'], bodyId)", "2"),
        ("ctx.out = [[3, 4], [6, 8]].map(norm).join()", "5,10"),
        ("ctx.out = ['heavy', 'world'].filter(bodyId)", "heavy"),
        ("const id = bodyId; ctx.out = id('light') + ['heavy'].map(id)[0]", "3"),
    ]);
}

#[test]
fn functions() {
    check_rows(&[
        ("const f = (x, k = 3) => x * k; ctx.out = [f(2), f(2, 5)]", "6,10"),
        ("function fact(n) { return n <= 1 ? 1 : n * fact(n - 1) } ctx.out = fact(10)", "3628800"),
        (
            "const even = n => n === 0 ? true : odd(n - 1), odd = n => n === 0 ? false : even(n - 1); ctx.out = even(10)",
            "true",
        ),
        ("const make = k => x => k * x; const f = make(3); ctx.out = f(4)", "12"),
        ("let n = 0; const inc = () => { n += 2 }; inc(); inc(); ctx.out = n", "4"),
        ("const fs = []; for (let i = 0; i < 3; i++) fs.push(() => i); ctx.out = fs.map(f => f())", "0,1,2"),
        (
            "const counter = () => { let n = 0; return {up: () => ++n, read: () => n} }; const c = counter(); c.up(); c.up(); ctx.out = c.read()",
            "2",
        ),
        ("ctx.out = (() => { if (data.time > 1) { return 'late' } return 'early' })()", "early"),
        ("const compose = (f, g) => x => f(g(x)); ctx.out = compose(x => x + 1, x => x * 2)(5)", "11"),
        ("const f = ({a, b: [c, d = 9]}) => a + c + d; ctx.out = f({a: 1, b: [2]})", "12"),
        (
            "const s = (x) => { x = Math.min(Math.max(x, 0), 1); return x * x * x * (10 - 15 * x + 6 * x * x); }; ctx.out = [s(0), s(0.5), s(2)]",
            "0,0.5,1",
        ),
        ("const f = (a, b) => b; ctx.out = [f(...[1, 2])]", "2"),
        ("const later = () => y + 1; const y = 4; ctx.out = later()", "5"),
    ]);
}

#[test]
fn functions_live_in_ctx() {
    let mut globals = Globals::new();
    let mut compiler = Compiler::new(&Mock, &mut globals);
    let setup = compiler.statements("let n = 0; ctx.step = (x) => { n++; return n * x }").program.unwrap();
    let run = compiler.statements("ctx.out = ctx.step(10)").program.unwrap();
    let (mut world, mut context) = (World::new(), Context::for_globals(&globals));
    setup.run(&mut world, &mut context, None).unwrap();
    for expected in [10.0, 20.0, 30.0] {
        run.run(&mut world, &mut context, None).unwrap();
        assert_eq!(context.get(globals.slot("out").unwrap()), &Value::Number(expected));
    }
    assert!(run.effects().calls_values && !run.effects().pure());
}

#[test]
fn lists_and_records() {
    check_rows(&[
        ("const v = [1, 2, 3]; v[5] = 9; ctx.out = v", "1,2,3,,,9"),
        ("const [a, , b = 7] = [1, 2]; ctx.out = [a, b]", "1,7"),
        ("const {x, y: {z}} = {x: 1, y: {z: 2}}; ctx.out = [x, z]", "1,2"),
        ("const {potential, kinetic} = energy(); ctx.out = potential + kinetic", "4"),
        (
            "ctx.r = {a: 1, ...{b: 2, a: 3}, ['c' + 1]: 4}; ctx.out = Object.entries(ctx.r).map(e => e.join('=')).join(' ')",
            "a=3 b=2 c1=4",
        ),
        ("const r = {}; r.n ??= 4; r.n += 1; r['m'] = r.n; ctx.out = r.m", "5"),
        (
            "ctx.out = [data.qpos.map(x => x / 2)[1], data.qpos.slice(0, 2).length, [...data.qvel].pop()]",
            "50.5,2,211",
        ),
        ("ctx.out = [norm([3, 4]), norm(data.efc_force) > 800]", "5,true"),
        ("ctx.out = data.qpos.filter((x, i) => i % 7 === 2).join(' ')", "102 109"),
        ("ctx.out = Math.hypot(...[3, 4]) + Math.max(...data.efc_force)", "606"),
        ("ctx.out = ctx.none?.a.b.c ?? 'nothing'", "nothing"),
        ("ctx.a = {b: [1, {c: 2}]}; ctx.out = ctx.a?.b[1]?.c", "2"),
        ("ctx.out = `${1 + 1} of ${[1, 2]}: ${`<${'x'}>`}`", "2 of 1,2: <x>"),
        ("for (const i of [0, 1]) ctx['q' + i] = i + 5; ctx.out = ctx.q0 + ctx['q' + 1]", "11"),
        (
            "let s = 0; for (const n of ['light_free', 'heavy_free']) s += data.joint(n).qvel[2]; ctx.out = s",
            "410",
        ),
        (
            "let s = 0; for (const n of ['heavy', 'light']) s += model.body(n).mass + bodyId(n); ctx.out = s",
            "1406",
        ),
        (
            "const v = data.time > 1 ? data.qpos : data.qvel; v[0] = 5; ctx.out = [v.length, data.qvel[0]]",
            "12,5",
        ),
        ("data.qpos.set([1, 2], data.ncon - 400 + 3); ctx.out = data.qpos.slice(3, 5)", "1,2"),
        (
            "ctx.out = [typeof ctx.out, typeof (() => 1), typeof [], typeof null]",
            "undefined,function,object,object",
        ),
    ]);
}

/// A context can be created at any time: a program that is compiled later finds values that earlier programs stored under
/// computed names, and the other way round.
#[test]
fn a_context_is_never_made_too_early() {
    let mut globals = Globals::new();
    let mut compile = |text: &str| Compiler::new(&Mock, &mut globals).statements(text).program.unwrap();
    let store = compile("const i = 1; ctx['q' + i] = 5");
    let load = compile("const i = 2; ctx.out = ctx['q' + i]");
    let mut context = Context::new();
    let run =
        |program: &Program, context: &mut Context| program.run(&mut World::new(), context, None).unwrap();
    run(&store, &mut context);
    // Compiled after the context was created, and after the first run in it.
    let late = Compiler::new(&Mock, &mut globals).statements("ctx.q2 = ctx.q1 + 1").program.unwrap();
    run(&late, &mut context);
    run(&load, &mut context);
    let out = globals.slot("out").unwrap();
    assert_eq!(context.get(out), &Value::Number(6.0));
    // A value that the host stores can be found by name, although no program with that name has run.
    let (mut context, q2) = (Context::new(), globals.slot("q2").unwrap());
    context.store(&globals, q2, Value::Number(9.0));
    run(&load, &mut context);
    assert_eq!(context.get(out), &Value::Number(9.0));
}

#[test]
fn limits_have_their_own_errors() {
    let code = |source: &str| {
        let mut globals = Globals::new();
        let compiled = Compiler::new(&Mock, &mut globals).statements(source);
        let program = compiled.program.unwrap_or_else(|| panic!("{:#?}", compiled.diagnostics));
        program.run(&mut World::new(), &mut Context::for_globals(&globals), None).map_err(|e| e.rule.code)
    };
    for (source, expected) in [
        ("let n = 0; while (n >= 0) n++", rules::BUDGET),
        ("const f = n => f(n + 1) + 1; ctx.a = f(0)", rules::CALL_DEPTH),
        ("const v = []; for (let i = 0; i < 1e7; i++) v.push([i, i, i])", rules::MEMORY),
        ("let s = 'x'; for (let i = 0; i < 60; i++) s += s", rules::TEXT_TOO_LONG),
        ("ctx.a = 'x'.repeat(1e9)", rules::TEXT_TOO_LONG),
        ("ctx.a = ctx.nothing.x", rules::NO_PARTS),
        ("ctx.nothing()", rules::NOT_CALLABLE),
        ("ctx.a = [].reduce((a, b) => a + b)", rules::NO_PARTS),
    ] {
        assert_eq!(code(source), Err(expected.code), "{source}");
    }
    // Cyclic lists are collected, and garbage does not accumulate.
    let mut globals = Globals::new();
    let source = "for (let i = 0; i < 20000; i++) { const a = [i, 'some text']; a.push(a) }";
    let program = Compiler::new(&Mock, &mut globals).statements(source).program.unwrap();
    let (mut world, mut context) = (World::new(), Context::for_globals(&globals));
    for _ in 0..30 {
        program.run(&mut world, &mut context, None).unwrap();
    }
}

#[test]
fn bare_indexes_get_names_that_mean_the_same() {
    let mut globals = Globals::new();
    let mut compiler = Compiler::new(&Mock, &mut globals).explaining();
    let source = "data.qvel[8] = 2 * data.qpos[9] + data.time; data.qpos[0] += model.body_mass[1]";
    let compiled = compiler.statements(source);
    let named = compiled.modernized(source);
    assert_eq!(
        named,
        "data.joint(\"heavy_free\").qvel[2] = 2 * data.joint(\"heavy_free\").qpos[2] + data.time; \
         data.joint(\"light_free\").qpos[0] += model.body_mass[1]"
    );
    let again = compiler.statements(&named);
    assert_eq!(compiled.program.unwrap().effects(), again.program.unwrap().effects());
}

#[test]
fn help_describes_the_expression_at_a_place() {
    let mut globals = Globals::new();
    let source = "2 * data.joint('light_free').qpos[2] + Math.sin(data.time)";
    let mut compiler = Compiler::new(&Mock, &mut globals).explaining();
    let help = compiler.expression(source).help;
    let help_for = |text: &str| {
        let start = source.find(text).unwrap();
        let span = Span::new(start, start + text.len());
        help.iter().find(|(s, _)| *s == span).map(|(_, h)| (h.title.clone(), h.lines.first().cloned()))
    };
    assert_eq!(
        help_for("data.joint('light_free').qpos[2]"),
        Some(("data.joint(\"light_free\").qpos[2]".into(), Some("coordinate 2".into())))
    );
    assert_eq!(help_for("Math.sin(data.time)").unwrap().1.as_deref(), Some("sine of an angle in rad"));
}

/// A fixed number of random texts that resemble the language, or as many as fit into LABSPEC_FUZZ_SECONDS, starting
/// with the seed LABSPEC_SEED.
#[test]
fn fuzzing_finds_no_panic_and_no_hang() {
    const TEXTS: u64 = 5000;
    let from_env = |name: &str| std::env::var(name).ok().and_then(|s| s.parse::<u64>().ok());
    let seconds = from_env("LABSPEC_FUZZ_SECONDS");
    let pieces = [
        "data",
        ".qpos",
        "[",
        "]",
        "2",
        "(",
        ")",
        "=",
        "==",
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
        "${",
        "}",
        "{",
        "\"",
        "/",
        "/*",
        "//",
        "=>",
        "if (",
        "for (",
        "of ",
        "while (",
        "else ",
        "function ",
        "return ",
        "value",
        ",",
        "...",
        "?.",
        "??",
        "&&=",
        "++",
        ".map(",
        "x => x",
        ".reduce((a, b) => a + b, 0)",
        "Math.",
        "max",
        "data.joint('light_free')",
        "[1, 2]",
        "{a: 1}",
        ".push(",
        "break",
        "continue",
        "do ",
        "typeof ",
        "ctx['q' + 1]",
        "data.qpos.length",
        "const [a, b] = ",
        "const {c} = ",
        "é",
        "0x",
        "1e",
        "async ",
        "new ",
    ];
    let mut state = 88172645463325252u64 ^ from_env("LABSPEC_SEED").unwrap_or(0);
    let mut next = |n: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as usize % n
    };
    let started = std::time::Instant::now();
    let mut texts = 0;
    while seconds.map_or(texts < TEXTS, |limit| started.elapsed().as_secs() < limit) {
        let source = match next(8) {
            0 => pieces[next(pieces.len())].repeat(next(4000)),
            _ => (0..next(40)).map(|_| pieces[next(pieces.len())]).collect(),
        };
        let text_started = std::time::Instant::now();
        let mut globals = Globals::new();
        let mut compiler = Compiler::new(&Mock, &mut globals).with_value(Some(Type::Any));
        for compiled in
            [compiler.expression(&source), compiler.statements(&source), compiler.assignment(&source)]
        {
            if let Some(program) = compiled.program {
                let _ = program.run(&mut World::new(), &mut Context::new(), Some(&Value::Number(1.0)));
            }
        }
        assert!(text_started.elapsed().as_secs() < 60, "{source}");
        texts += 1;
    }
    println!("{texts} texts");
}
