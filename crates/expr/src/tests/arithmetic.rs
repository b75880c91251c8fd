//! Random arithmetic compared with an independent evaluator, `evalexpr`. Its syntax differs: `^` is the power, and integers
//! divide as integers, so every literal is written as a float.

use proptest::prelude::*;

use crate::Value;
use crate::mock::evaluate;

/// The same arithmetic in both languages.
fn arithmetic() -> impl Strategy<Value = (String, String)> {
    let number = (-1000i32..1000).prop_map(|n| {
        let x = f64::from(n) / 8.0;
        (format!("({x:?})"), format!("({x:?})"))
    });
    number.prop_recursive(6, 64, 3, |inner| {
        let two = (inner.clone(), inner.clone());
        prop_oneof![
            (two.clone(), prop::sample::select(vec!["+", "-", "*", "/", "%"])).prop_map(|((a, b), op)| (
                format!("({} {op} {})", a.0, b.0),
                format!("({} {op} {})", a.1, b.1)
            )),
            two.clone().prop_map(|(a, b)| (
                format!("({} < {} ? {} : {})", a.0, b.0, a.0, b.0),
                format!("if({} < {}, {}, {})", a.1, b.1, a.1, b.1)
            )),
            two.prop_map(|(a, b)| (format!("({} ** {})", a.0, b.0), format!("({} ^ {})", a.1, b.1))),
            inner.clone().prop_map(|a| (format!("(-{})", a.0), format!("(-{})", a.1))),
            inner.prop_map(|a| (format!("Math.sqrt({})", a.0), format!("math::sqrt({})", a.1))),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn agrees_with_evalexpr((expression, reference) in arithmetic()) {
        let Ok(evalexpr::Value::Float(expected)) = evalexpr::eval(&reference) else { return Ok(()) };
        // The first source is folded at compile time; the second is evaluated by the virtual machine, because
        // `data.time` is 0 at run time.
        for source in [expression.clone(), expression.replace("(-", "(data.time + -").replace("(1", "(data.time + 1")] {
            let Value::Number(got) = evaluate(&source) else { panic!("{source} is not a number") };
            // `evalexpr` uses another library for powers, which may round differently, and later operations
            // may amplify the difference.
            let close = got == expected || got.is_nan() && expected.is_nan();
            let powers = expression.contains("**");
            prop_assert!(close || powers, "{source}: {got} and {expected}");
        }
    }
}
