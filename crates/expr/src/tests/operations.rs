//! Every numeric operation has one meaning in all evaluators: constant folding, rows, columns, the virtual machine, and
//! formulas inside the virtual machine. The arguments include special values, and all bits must agree.

use crate::mock::{Mock, World};
use crate::operation::{select, truth, truthy};
use crate::operators::{BinaryOp, UnaryOp};
use crate::{Compiler, Context, Globals, Program, Recording, Value, math};

const DIFFICULT_NUMBERS: [(&str, f64); 20] = [
    ("NaN", f64::NAN),
    ("0", 0.0),
    ("(-0)", -0.0),
    ("1", 1.0),
    ("(-1)", -1.0),
    ("2", 2.0),
    ("0.5", 0.5),
    ("(-2.5)", -2.5),
    ("33", 33.0),
    ("Infinity", f64::INFINITY),
    ("(-Infinity)", f64::NEG_INFINITY),
    ("5e-324", 5e-324),
    ("(-1e-310)", -1e-310),
    ("2147483647.5", 2147483647.5),
    ("2147483648", 2147483648.0),
    ("(-2147483649)", -2147483649.0),
    ("9007199254740992", 9007199254740992.0),
    ("9007199254740994", 9007199254740994.0),
    ("1e308", 1e308),
    ("(-1e308)", -1e308),
];

type Write = Box<dyn Fn(&str, &str) -> String>;
type Means = Box<dyn Fn(f64, f64) -> f64>;

/// An operation on two numbers: its syntax, and its meaning by the table.
struct Case {
    write: Write,
    means: Means,
}

fn cases() -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    let mut add = |write: Write, means: Means| {
        cases.push(Case { write, means });
    };
    for op in BinaryOp::ALL {
        add(
            Box::new(move |a, b| format!("+((+{a}) {} (+{b}))", op.symbol())),
            Box::new(move |a, b| op.on_numbers(a, b)),
        );
    }
    // Operands that were just computed are in other registers than those that were read.
    for op in BinaryOp::ALL {
        add(
            Box::new(move |a, b| format!("+((+{a}) {} ({b} * 1))", op.symbol())),
            Box::new(move |a, b| op.on_numbers(a, b)),
        );
        add(
            Box::new(move |a, b| format!("+(({a} * 1) {} (+{b}))", op.symbol())),
            Box::new(move |a, b| op.on_numbers(a, b)),
        );
    }
    for op in [UnaryOp::Minus, UnaryOp::Plus, UnaryOp::Not, UnaryOp::BitNot] {
        let both = BinaryOp::Subtract;
        add(
            Box::new(move |a, b| format!("({}{a}) - ({}{b})", op.symbol(), op.symbol())),
            Box::new(move |a, b| both.on_numbers(op.on_number(a), op.on_number(b))),
        );
    }
    add(Box::new(|a, b| format!("({a} ? {b} : {a})")), Box::new(|a, b| select(a, b, a)));
    add(Box::new(|a, b| format!("+({a} && {b})")), Box::new(|a, b| if truthy(a) { b } else { a }));
    add(Box::new(|a, b| format!("+({a} || {b})")), Box::new(|a, b| if truthy(a) { a } else { b }));
    for name in math::names().chain(["isNaN", "isFinite"]) {
        let Some(f) = math::function(name).or_else(|| math::global(name)) else { continue };
        let path = f.path();
        match f.arity() {
            (_, Some(1)) => add(
                Box::new(move |a, b| format!("(+{path}({a})) - (+{path}({b}))")),
                Box::new(move |a, b| f.apply(&[a]) - f.apply(&[b])),
            ),
            (_, Some(_)) => {
                add(Box::new(move |a, b| format!("{path}({a}, {b})")), Box::new(move |a, b| f.apply(&[a, b])))
            }
            (_, None) => add(
                Box::new(move |a, b| format!("{path}({a}, {b}, {a})")),
                Box::new(move |a, b| f.apply(&[a, b, a])),
            ),
        }
    }
    cases
}

fn assert_same(computed: f64, table: f64, what: &str) {
    let same = computed.to_bits() == table.to_bits() || computed.is_nan() && table.is_nan();
    assert!(same, "{what} gives {computed:?}, the table {table:?}");
}

fn world(a: f64, b: f64) -> World {
    let mut world = World::new();
    world.fields[1][..2].copy_from_slice(&[a, b]);
    world
}

fn expression(text: &str) -> Program {
    Compiler::new(&Mock, &mut Globals::new()).expression(text).program.unwrap_or_else(|| panic!("{text}"))
}

const A: &str = "data.qpos[0]";
const B: &str = "data.qpos[1]";

/// Compares row, columns and virtual machine for all pairs, with operands that are literals and operands that are read.
fn check_back_ends(case: &Case, text: &str, pairs: &[(f64, f64)]) {
    let program = expression(text);
    assert!(program.row.is_some(), "{text} is no row");
    let mut recording = Recording::new();
    let columnar = recording.columns(&program).unwrap().unwrap_or_else(|| panic!("{text} has no columns"));
    let mut context = Context::new();
    for &(a, b) in pairs {
        let (mut world, table) = (world(a, b), (case.means)(a, b));
        recording.sample(&world).unwrap();
        assert_same(
            program.run(&mut world, &mut context, None).unwrap().to_number(),
            table,
            &format!("row: {text}"),
        );
        let machine = crate::vm::run(&program.code, &mut world, &mut context, None).unwrap();
        assert_same(machine.to_number(), table, &format!("machine: {text} of {a} and {b}"));
    }
    for (x, (a, b)) in columnar.evaluate(&recording).unwrap().iter().zip(pairs) {
        assert_same(*x, (case.means)(*a, *b), &format!("column: {text} of {a} and {b}"));
    }
}

#[test]
fn every_back_end_follows_the_table_of_operations() {
    let mut formulas = 0;
    for case in cases() {
        let all: Vec<(f64, f64)> = DIFFICULT_NUMBERS
            .iter()
            .flat_map(|(_, a)| DIFFICULT_NUMBERS.iter().map(|(_, b)| (*a, *b)))
            .collect();
        check_back_ends(&case, &(case.write)(A, B), &all);
        for (text, x) in DIFFICULT_NUMBERS {
            let left: Vec<(f64, f64)> = DIFFICULT_NUMBERS.iter().map(|(_, b)| (x, *b)).collect();
            let right: Vec<(f64, f64)> = DIFFICULT_NUMBERS.iter().map(|(_, a)| (*a, x)).collect();
            check_back_ends(&case, &(case.write)(text, B), &left);
            check_back_ends(&case, &(case.write)(A, text), &right);
            for (other, y) in DIFFICULT_NUMBERS {
                // Everything is folded.
                let folded = expression(&(case.write)(text, other));
                assert!(folded.effects().constant());
                let value = folded.run(&mut World::new(), &mut Context::new(), None).unwrap();
                assert_same(value.to_number(), (case.means)(x, y), &(case.write)(text, other));
            }
        }
        // Within a longer program. `Math.max` of three equal values does not change the value, and makes the expression
        // long enough for a formula.
        let part = (case.write)("a", "b");
        let text =
            format!("const a = {A}; const b = {B}; data.qpos[2] = Math.max({part}, {part}, {part}) * 1");
        let program = Compiler::new(&Mock, &mut Globals::new()).statements(&text).program.unwrap();
        formulas += program.code.units.iter().map(|u| u.formulas.len()).sum::<usize>();
        let mut context = Context::new();
        for (a, b) in all {
            let mut world = world(a, b);
            program.run(&mut world, &mut context, None).unwrap();
            assert_same(world.fields[1][2], (case.means)(a, b), &format!("{text} of {a} and {b}"));
        }
    }
    assert!(formulas > 50, "only {formulas} formulas within programs");
}

#[test]
fn truth_values_are_one_or_zero() {
    for (text, x) in DIFFICULT_NUMBERS {
        assert_eq!(truth(truthy(x)), f64::from(u8::from(Value::Number(x).truthy())), "{text}");
    }
}
