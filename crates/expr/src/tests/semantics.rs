//! The values of expressions as in JavaScript, as tables of a source text and a value.

use crate::Value;
use crate::mock::evaluate;
use crate::mock::{Mock, World};
use crate::{Compiler, Context, Globals};

/// Whether two values are identical: NaN equals NaN, and zeros have the same sign.
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(x), Value::Number(y)) => x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan(),
        _ => a == b,
    }
}

fn check_rows(rows: &[(&str, Value)]) {
    for (source, expected) in rows {
        let got = evaluate(source);
        assert!(same(&got, expected), "{source} is {got:?}, not {expected:?}");
        // The same without constant folding, with operands that are known only at run time.
        let hidden =
            source.replace("NaN", "(data.time / data.time)").replace("is(data.time / data.time)", "isNaN");
        if hidden != *source {
            assert!(same(&evaluate(&hidden), expected), "{hidden}");
        }
    }
}

fn n(x: f64) -> Value {
    Value::Number(x)
}

fn b(x: bool) -> Value {
    Value::Boolean(x)
}

fn s(text: &str) -> Value {
    Value::from(text)
}

#[test]
fn numbers() {
    check_rows(&[
        ("0.1 + 0.2", n(0.30000000000000004)),
        ("1 / 0", n(f64::INFINITY)),
        ("-1 / 0", n(f64::NEG_INFINITY)),
        ("0 / 0", n(f64::NAN)),
        ("-0", n(-0.0)),
        ("0 * -1", n(-0.0)),
        ("5 % 3", n(2.0)),
        ("-5 % 3", n(-2.0)),
        ("5.5 % -2", n(1.5)),
        ("-4 % 2", n(-0.0)),
        ("5 % 0", n(f64::NAN)),
        ("5 % Infinity", n(5.0)),
        ("2 ** 10", n(1024.0)),
        ("2 ** -1", n(0.5)),
        ("2 ** 3 ** 2", n(512.0)),
        ("(-2) ** 2", n(4.0)),
        ("(-8) ** (1 / 3)", n(f64::NAN)),
        ("1 ** NaN", n(f64::NAN)),
        ("1 ** Infinity", n(f64::NAN)),
        ("NaN ** 0", n(1.0)),
        ("0xff", n(255.0)),
        ("1_000", n(1000.0)),
        (".5e1", n(5.0)),
        ("5 & 3", n(1.0)),
        ("5 | 3", n(7.0)),
        ("5 ^ 3", n(6.0)),
        ("~5", n(-6.0)),
        ("1 << 31", n(-2147483648.0)),
        ("1 << 33", n(2.0)),
        ("-1 >> 1", n(-1.0)),
        ("-1 >>> 0", n(4294967295.0)),
        ("2 ** 32 | 0", n(0.0)),
    ]);
}

#[test]
fn functions_of_math() {
    check_rows(&[
        ("Math.round(-2.5)", n(-2.0)),
        ("Math.round(2.5)", n(3.0)),
        ("Math.round(-0.4)", n(-0.0)),
        ("Math.max(NaN, 1)", n(f64::NAN)),
        ("Math.max()", n(f64::NEG_INFINITY)),
        ("Math.min()", n(f64::INFINITY)),
        ("Math.max(1, 3, 2)", n(3.0)),
        ("Math.sign(-0)", n(-0.0)),
        ("Math.sign(-3)", n(-1.0)),
        ("Math.hypot()", n(0.0)),
        ("Math.hypot(3, 4)", n(5.0)),
        ("Math.hypot(2, 3, 6)", n(7.0)),
        ("Math.atan2(1, -1)", n(2.356194490192345)),
        ("Math.fround(5.05)", n(5.050000190734863)),
        ("Math.trunc(-4.7)", n(-4.0)),
        ("Math.cbrt(-8)", n(-2.0)),
        ("Math.log2(1024)", n(10.0)),
        ("Math.log10(1000)", n(3.0)),
        ("Math.expm1(1e-10)", n(1.00000000005e-10)),
        ("Math.PI", n(std::f64::consts::PI)),
        ("Math.abs(null)", n(0.0)),
        ("Math.sqrt(-1)", n(f64::NAN)),
        ("isNaN(NaN)", b(true)),
        ("isFinite(1 / 0)", b(false)),
        ("isNaN(undefined)", b(true)),
    ]);
}

#[test]
fn equality_and_order() {
    check_rows(&[
        ("NaN === NaN", b(false)),
        ("NaN !== NaN", b(true)),
        ("0 === -0", b(true)),
        ("1 == '1'", b(true)),
        ("1 === '1'", b(false)),
        ("null == undefined", b(true)),
        ("null === undefined", b(false)),
        ("null == 0", b(false)),
        ("null >= 0", b(true)),
        ("undefined == 0", b(false)),
        ("'' == 0", b(true)),
        ("'a' == NaN", b(false)),
        ("true == 1", b(true)),
        ("true === 1", b(false)),
        ("'b' > 'a'", b(true)),
        ("'10' < '9'", b(true)),
        ("'10' < 9", b(false)),
        ("'Z' < 'a'", b(true)),
        ("NaN < 1", b(false)),
        ("NaN >= 1", b(false)),
        ("undefined < 1", b(false)),
        ("ctx.nothing == null", b(true)),
        ("ctx.nothing === null", b(false)),
        ("data.qpos[data.time + 99] === undefined", b(true)),
    ]);
}

#[test]
fn truth_and_choice() {
    check_rows(&[
        ("0 || 5", n(5.0)),
        ("NaN || 'x'", s("x")),
        ("'' || 0", n(0.0)),
        ("'0' && 7", n(7.0)),
        ("null && 7", Value::Null),
        ("ctx.peak || 0", n(0.0)),
        ("ctx.peak && 1", Value::Undefined),
        ("!''", b(true)),
        ("!!'false'", b(true)),
        ("!NaN", b(true)),
        ("NaN ? 1 : 2", n(2.0)),
        ("'a' ? 1 : 2", n(1.0)),
        ("data.time ? 'a' : 'b'", s("b")),
        ("data.qpos[0] > 1 ? 'slides' : 'holds'", s("slides")),
        ("data.time || 'start'", s("start")),
        ("data.time === 0 && 'start'", s("start")),
        ("data.time === 1 && 'start'", b(false)),
        ("1 + (data.time || 2)", n(3.0)),
        ("1 + (ctx.text || 2)", n(3.0)),
        ("-(data.time ? 1 : null)", n(-0.0)),
    ]);
}

#[test]
fn text() {
    check_rows(&[
        ("'a' + 1", s("a1")),
        ("1 + 2 + 'a'", s("3a")),
        ("'a' + 1 + 2", s("a12")),
        ("1 + true", n(2.0)),
        ("1 + null", n(1.0)),
        ("1 + undefined", n(f64::NAN)),
        ("'' + null + undefined", s("nullundefined")),
        ("'' + true", s("true")),
        ("'' + 1e21", s("1e+21")),
        ("'' + 1e-7", s("1e-7")),
        ("'' + 0.1", s("0.1")),
        ("'' + -0", s("0")),
        ("'' + 1 / 0", s("Infinity")),
        ("+'12'", n(12.0)),
        ("+''", n(0.0)),
        ("+'0x10'", n(16.0)),
        ("+'12px'", n(f64::NAN)),
        ("'3' * '4'", n(12.0)),
        ("-'3'", n(-3.0)),
        ("'t = ' + data.qpos[2]", s("t = 102")),
        ("data.qpos[2] + ' m'", s("102 m")),
        ("data.qpos[data.time + 99] + ''", s("undefined")),
        ("'a' + (data.time === 0)", s("atrue")),
        (r"'\x41\u00e9'", s("Aé")),
        ("ctx.a + 'x'", s("undefinedx")),
        ("ctx.a + 1", n(f64::NAN)),
        ("-(ctx.a + '5')", n(f64::NAN)),
    ]);
}

#[test]
fn fields_and_names() {
    check_rows(&[
        ("data.time", n(0.0)),
        ("data.qpos[2]", n(102.0)),
        ("data.qpos[data.time + 2]", n(102.0)),
        ("data.xpos[3 * 1 + 2]", n(305.0)),
        ("model.opt.gravity[2]", n(1002.0)),
        ("data.joint('heavy_free').qvel[2]", n(208.0)),
        ("data.joint(\"heavy_free\").qpos[data.time]", n(107.0)),
        ("model.body('light').mass", n(702.0)),
        ("model.body('light').id", n(2.0)),
        ("model.body_mass[model.body('heavy').id]", n(701.0)),
        ("model.body_mass[bodyId('light')]", n(702.0)),
        ("data.qpos.length", n(14.0)),
        ("data.efc_force.length", n(2.0)),
        ("data.efc_force[1]", n(601.0)),
        ("data.efc_force[2]", Value::Undefined),
        ("data.efc_force[2] + 1", n(f64::NAN)),
        ("data.qpos[0.5 + data.time]", Value::Undefined),
        ("data.qpos[ctx.i]", Value::Undefined),
        ("1000 * (data.qpos[2] - (1 - 0.5 * 9.81 * data.time * data.time))", n(101000.0)),
        ("0.5 * model.body_mass[1] * data.qvel[0] ** 2", n(14020000.0)),
        ("say('a', 1, data.time)", s("a|true|0")),
    ]);
}

#[test]
fn errors_of_a_page_are_errors_here() {
    for source in [
        "(() => { for (const [k] of [1, 2]) { return k } return 0 })()",
        "[1, 2].map(([a]) => a).length",
        "[undefined].map(({a}) => a).length",
        "(() => { const [a] = [1].find(x => x > 2); return a })()",
        "(() => { let n = 0; for (const x of [{length: 2}][0]) { n++ } return n })()",
    ] {
        let mut globals = Globals::new();
        let program = Compiler::new(&Mock, &mut globals).expression(source).program.unwrap();
        let thrown = program.run(&mut World::new(), &mut Context::for_globals(&globals), None);
        assert!(thrown.is_err(), "{source}: {thrown:?}");
    }
    check_rows(&[
        ("(() => { const [a, b] = [[1, 2]][0]; return a + b })()", n(3.0)),
        ("(() => { const [a, b] = ['xy'][0]; return b + a })()", s("yx")),
        ("(() => { const [a] = '😀x'; return a })()", s("😀")),
        ("[3, undefined, 1].sort((a, b) => b - a).join()", s("3,1,")),
        ("[undefined, 3, undefined, 1].toSorted((a, b) => a - b).join()", s("1,3,,")),
        ("(-2.5).toString(2)", s("-10.1")),
        ("(255.5).toString(16)", s("ff.8")),
        ("(0.1).toString(3)", s("0.0022002200220022002200220022002201")),
        ("(0.5).toString(36)", s("0.i")),
        ("'😀'.length", n(2.0)),
        ("[...'😀x'].length", n(2.0)),
    ]);
}

/// Strings contain only whole characters: selecting half of one is an error, not silently another character.
#[test]
fn half_a_character_is_refused() {
    for source in [
        "'😀'[0] === 'x'",
        "'😀'.charAt(1)",
        "'😀'.at(0)",
        "'x😀'.slice(0, 2)",
        "'😀'.split('').length",
        "'😀'.substring(1)",
        "'a'.padEnd(2, '😀')",
    ] {
        let mut globals = Globals::new();
        let program = Compiler::new(&Mock, &mut globals).expression(source).program.unwrap();
        let thrown = program.run(&mut World::new(), &mut Context::for_globals(&globals), None);
        assert!(thrown.is_err_and(|e| e.message.contains("half of a two-unit character")), "{source}");
    }
}
