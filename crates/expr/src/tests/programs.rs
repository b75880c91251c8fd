//! Statements, effects, aggregates, run-time errors and events.

use crate::mock::{Mock, World, evaluate, execute};
use crate::*;

fn number((_, out): (World, Value)) -> f64 {
    out.to_number()
}

#[test]
fn assignments() {
    let (world, _) = execute("data.qpos[2] = 1.5; model.opt.timestep = 0.02\nmodel.body_mass[1] *= 2");
    assert_eq!(world.fields[1][2], 1.5);
    assert_eq!(world.fields[11][0], 0.02);
    assert_eq!(world.fields[7][1], 1402.0);
    let (world, _) = execute("data.qvel[0] = data.qvel[1] = 7; data.joint('heavy_free').qvel[0] += 0.5");
    assert_eq!(world.fields[2][..7], [7.0, 7.0, 202.0, 203.0, 204.0, 205.0, 206.5]);
    let (world, _) = execute("data.qvel.fill(0); data.qpos.set([1, data.qpos[0], 3], 7); data.time++");
    assert_eq!(world.fields[2], [0.0; 12]);
    assert_eq!(world.fields[1][6..11], [106.0, 1.0, 100.0, 3.0, 110.0]);
    assert_eq!(world.fields[0][0], 1.0);
}

#[test]
fn variables() {
    assert_eq!(number(execute("ctx.out = 3; ctx['out'] += 4")), 7.0);
    assert_eq!(execute("ctx.out = 'q'; ctx.out += 2").1, Value::from("q2"));
    assert_eq!(number(execute("ctx.n = '5'; ctx.n++; ctx.out = ctx.n")), 6.0);
    assert_eq!(number(execute("ctx.out = Math.max(ctx.out || 0, data.qpos[0])")), 100.0);
    assert_eq!(number(execute("ctx.out = ctx.a = 2; ctx.out *= 2")), 4.0);
    assert!(number(execute("ctx.out++")).is_nan());
}

#[test]
fn locals() {
    assert_eq!(number(execute("const a = 2, b = a * 3; ctx.out = a + b")), 8.0);
    assert_eq!(number(execute("let a = 2; a += 3; a *= 2; ctx.out = a")), 10.0);
    assert_eq!(number(execute("let a = 1\nlet b = a = 5\nctx.out = a + b")), 10.0);
    assert_eq!(execute("let a; a = 'x'; a += 1; ctx.out = a").1, Value::from("x1"));
    assert_eq!(number(execute("const v = data.qvel; ctx.out = v[2] + v.length")), 214.0);
    assert_eq!(
        number(execute(
            "const j = data.joint('light_free'), o = model.opt; ctx.out = j.qpos[2] + o.timestep"
        )),
        1202.0
    );
    assert_eq!(number(execute("const t = data.time; data.time = 5; ctx.out = t")), 0.0);
    assert_eq!(number(execute("let a = 1; a += a = 5; ctx.out = a")), 6.0);
    assert_eq!(number(execute("let a = 1; const b = a; a = 2; ctx.out = b")), 1.0);
}

#[test]
fn calls() {
    for source in ["mj.mj_setConst(model, data)", "mj_setConst", "mj_setConst()", "mj.mj_setConst"] {
        assert_eq!(execute(source).0.calls, [(0, Vec::new())], "{source}");
    }
    let (world, _) =
        execute("mj.mj_resetDataKeyframe(model, data, '1' * 1); mj.mj_resetDataKeyframe(model, data)");
    assert_eq!(world.calls, [(1, vec![Value::Number(1.0)]), (1, Vec::new())]);
    let (world, _) = execute("data.time > 1 && mj_setConst(); data.time < 1 && mj_setConst()");
    assert_eq!(world.calls.len(), 1);
    let (world, _) =
        execute("data.time > 1 ? (data.qvel[0] = 1) : mj_setConst; ctx.started || (data.qvel[1] = 2)");
    assert_eq!((world.calls.len(), world.fields[2][0], world.fields[2][1]), (1, 200.0, 2.0));
}

#[test]
fn controls_give_values() {
    let mut globals = Globals::new();
    let mut compiler = Compiler::new(&Mock, &mut globals).with_value(Some(Type::Number));
    let set = compiler.assignment("model.opt.gravity[2]").program.unwrap();
    let apply = compiler.statements("model.body_mass[2] = value * 2; mj_setConst").program.unwrap();
    assert!(set.effects().uses_value && apply.effects().uses_value);
    let (mut world, mut context) = (World::new(), Context::new());
    set.run(&mut world, &mut context, Some(&Value::Number(-1.62))).unwrap();
    apply.run(&mut world, &mut context, Some(&Value::Number(0.5))).unwrap();
    assert_eq!((world.fields[10][2], world.fields[7][2]), (-1.62, 1.0));
}

#[test]
fn effects_list_accessed_fields() {
    let mut globals = Globals::new();
    let mut compiler = Compiler::new(&Mock, &mut globals);
    let program = compiler
        .statements("ctx.peak = Math.max(ctx.peak || 0, data.joint('heavy_free').qpos[2]); model.body_mass[data.ncon] += 1; mj_setConst")
        .program
        .unwrap();
    let effects = program.effects();
    let access = |field, first, count| Access { field: FieldKey(field), first, count };
    assert_eq!(effects.reads, [access(1, 9, Some(1)), access(4, 0, Some(1)), access(7, 0, Some(3))]);
    assert_eq!(effects.writes, [access(7, 0, Some(3)), access(7, 0, None)]);
    assert_eq!(effects.calls, [FunctionId(0)]);
    assert_eq!((&effects.ctx_reads[..], &effects.ctx_writes[..]), (&[0][..], &[0][..]));
    assert!(
        effects.reads_everything && !effects.writes_everything && effects.can_throw && !effects.constant()
    );
    assert!(compiler.expression("2 * Math.PI").program.unwrap().effects().constant());
    assert!(!compiler.expression("ctx.a").program.unwrap().effects().constant());
}

#[test]
fn result_types() {
    let mut globals = Globals::new();
    let mut compiler = Compiler::new(&Mock, &mut globals);
    for (source, ty) in [
        ("data.time > 1", Type::Boolean),
        ("data.qpos[2] * 2", Type::Number),
        ("data.qpos[data.ncon] * 2", Type::Number),
        ("data.qpos[data.ncon] + 1", Type::Number),
        ("'a' + ctx.x", Type::String),
        ("ctx.x", Type::Any),
        ("data.time ? 1 : 'a'", Type::Any),
        ("null", Type::Null),
    ] {
        assert_eq!(compiler.expression(source).program.unwrap().result_type(), ty, "{source}");
    }
    assert_eq!(compiler.statements("").program.unwrap().result_type(), Type::Void);
}

#[test]
fn aggregates_are_programs_of_their_own() {
    let mut globals = Globals::new();
    let mut compiler = Compiler::new(&Mock, &mut globals);
    let program =
        compiler.expression("1000 * final(data.qpos[2] - final(data.time)) + final(1)").program.unwrap();
    let aggregates = program.aggregates();
    assert_eq!(aggregates.len(), 2);
    assert_eq!(program.effects().reads, []);
    assert!(program.effects().aggregates);
    let inner = aggregates[0].args[0].aggregates();
    assert_eq!((inner.len(), inner[0].slot, aggregates[0].slot, aggregates[1].slot), (1, 0, 1, 2));
    let (mut world, mut context) = (World::new(), Context::new());
    context.set_aggregate(0, 2.0);
    let argument = aggregates[0].args[0].run(&mut world, &mut context, None).unwrap().to_number();
    assert_eq!(argument, 100.0);
    context.set_aggregate(1, argument);
    context.set_aggregate(2, 1.0);
    assert_eq!(program.run(&mut world, &mut context, None), Ok(Value::Number(100001.0)));
}

#[test]
fn failures_have_their_span() {
    let run = |source: &str| {
        let mut globals = Globals::new();
        let program = Compiler::new(&Mock, &mut globals).statements(source).program.unwrap();
        program.run(&mut World::new(), &mut Context::new(), None).unwrap_err()
    };
    let error = run("data.time = 1; fail()");
    assert_eq!((error.rule, error.span), (rules::HOST_CALL, Span::new(15, 21)));
    assert_eq!(error.to_string(), "this function always fails");
    let error = run("model.opt.timestep = 0");
    assert_eq!((error.rule, error.span), (rules::HOST_STORE, Span::new(0, 22)));
}

#[test]
fn elements_past_the_end_are_recorded() {
    let mut globals = Globals::new();
    let mut compiler = Compiler::new(&Mock, &mut globals);
    let program =
        compiler.statements("ctx.i = 20; data.qpos[ctx.i] = 1; ctx.x = data.qpos[ctx.i] + data.efc_force[5]");
    let (mut world, mut context) = (World::new(), Context::new());
    program.program.unwrap().run(&mut world, &mut context, None).unwrap();
    let notes: Vec<String> = context
        .events()
        .iter()
        .map(|e| {
            format!(
                "{} {}..{}: {e}",
                e.rule().map_or("read-past-end", |rule| rule.code),
                e.span.start,
                e.span.end
            )
        })
        .collect();
    assert_eq!(
        notes,
        [
            "store-past-end 12..32: element 20 was assigned: nothing was stored; there are 14 elements now, indexes 0 to 13",
            "read-past-end 42..58: element 20 was read: the value is `undefined`; there are 14 elements now, indexes 0 to 13",
            "read-past-end 61..78: element 5 was read: the value is `undefined`; there are 2 elements now, indexes 0 to 1",
        ]
    );
}

#[test]
fn text_that_grows_without_end_is_stopped() {
    let mut globals = Globals::new();
    let program = Compiler::new(&Mock, &mut globals)
        .statements("ctx.s = (ctx.s || 'abcdefgh') + ctx.s")
        .program
        .unwrap();
    let (mut world, mut context) = (World::new(), Context::new());
    let failed = (0..40).find_map(|_| program.run(&mut world, &mut context, None).err());
    assert_eq!(failed.map(|e| e.rule), Some(rules::TEXT_TOO_LONG));
}

#[test]
fn long_and_deep_programs_run_on_a_small_stack() {
    let deep = format!("{}data.time{}", "(".repeat(100), ")".repeat(100));
    let chain = format!("data.time{}", " + 1".repeat(120));
    let signs = format!("{}data.time", "- ".repeat(120));
    let choices = format!("{}0", "data.time ? 1 : ".repeat(100));
    let run = move || {
        for source in [&deep, &chain, &signs, &choices] {
            evaluate(source);
            assert!(!print(&parse_expression(source).tree).is_empty());
        }
        let many = "data.qpos[1] += 1;".repeat(1500);
        assert_eq!(execute(&many).0.fields[1][1], 1601.0);
    };
    std::thread::Builder::new().stack_size(512 * 1024).spawn(run).unwrap().join().unwrap();
}

#[test]
fn functions_that_call_each_other_deeply_are_refused_on_a_small_stack() {
    let chain = |levels: usize, signs: &str| {
        let call = |i: usize| format!("const f{i} = () => {signs}f{}();", i + 1);
        let calls: String = (0..levels).map(call).collect();
        format!("{calls} const f{levels} = () => 1; ctx.a = f0()")
    };
    let run = move || {
        for (levels, signs) in [(190, "- ".repeat(60)), (190, "!(1, f)(".repeat(5)), (60, "- ".repeat(100))] {
            let text = chain(levels, &signs);
            assert!(text.len() < MAX_SOURCE);
            let mut globals = Globals::new();
            let compiled = Compiler::new(&Mock, &mut globals).statements(&text);
            assert!(compiled.diagnostics.iter().any(Finding::is_error) && compiled.program.is_none());
        }
        let mut globals = Globals::new();
        let compiled = Compiler::new(&Mock, &mut globals).statements(&chain(30, "2 * "));
        assert!(compiled.program.is_some(), "{:?}", compiled.diagnostics);
    };
    std::thread::Builder::new().stack_size(1024 * 1024).spawn(run).unwrap().join().unwrap();
}

#[test]
fn a_host_can_report_typographic_quotes_itself() {
    let mut globals = Globals::new();
    for source in ["data.joint(“heavy_free”).qpos[2]", "1 + ”", "`${data.joint(‘heavy_free’).qpos[2]}`"]
    {
        let compiled = Compiler::new(&Mock, &mut globals).without_quotes().expression(source);
        assert!(
            compiled.program.is_none() && compiled.diagnostics.iter().all(|d| d.code != "bad-character"),
            "{source}"
        );
        let bound = Compiler::new(&Mock, &mut globals).expression(source);
        assert!(bound.diagnostics.iter().any(|d| d.code == "bad-character"), "{source}");
    }
    let other = Compiler::new(&Mock, &mut globals).without_quotes().expression("data.time × 2");
    assert_eq!(other.diagnostics.first().map(|d| d.code), Some("bad-character"));
}
