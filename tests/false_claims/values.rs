//! Numeric questions: a value, its tolerance and unit, and the values of mistakes; true ones, and altered ones.

use super::conditions::MeasuredNumber;
use super::lesson::{Body, Claim, Truth};
use super::scenes::NEVER;
use crate::support::random::Random;
use serde_json::{Value, json};

struct ClaimedValue<'a> {
    answer: f64,
    tol: f64,
    unit: &'a str,
}

fn question(
    kind: &'static str,
    variant: &str,
    truth: Truth,
    asked: &ClaimedValue<'_>,
    value: &str,
    wrong: &[String],
) -> Claim {
    let mut verify = json!({"use": "#1", "value": value});
    if !wrong.is_empty() {
        verify["wrong"] = json!(wrong);
    }
    let mut q = json!({"kind": "numeric", "q": "How much is it?", "answer": asked.answer, "tol": asked.tol, "explain": "It is so.", "verify": verify});
    if !asked.unit.is_empty() {
        q["unit"] = Value::from(asked.unit);
    }
    Claim { kind, variant: variant.into(), truth, body: Body::Question(q) }
}

fn rounded(x: f64) -> f64 {
    format!("{x:.4}").parse().unwrap()
}

fn asked(k: &MeasuredNumber) -> ClaimedValue<'static> {
    ClaimedValue { answer: rounded(k.x), tol: rounded(0.03 * k.x.abs() + 0.01), unit: k.unit }
}

pub(super) fn right(random: &mut Random, measured: &[MeasuredNumber]) -> Vec<Claim> {
    let k = random.pick(measured);
    let asked = asked(k);
    let far = format!("{} + {}", k.name, rounded(3.0 * asked.tol));
    vec![
        question("value", "", Truth::True, &asked, &k.name, &[]),
        question(
            "wrong",
            "",
            Truth::True,
            &asked,
            &k.name,
            &[far, format!("{}", asked.answer + 2.5 * asked.tol)],
        ),
    ]
}

/// Units that differ from this one, of the same kind or of another.
pub(super) fn other_units(unit: &str) -> &'static [&'static str] {
    match unit {
        "s" => &["ms", "kg", "min", "h", "m", "N", "m/s", "µs", "s^2"],
        "m" => &["mm", "cm", "km", "s", "kg", "m^2", "m/s", "N"],
        "m/s" => &["mm/s", "km/h", "m", "s", "m/s^2", "kg", "cm/s"],
        "rad" => &["deg", "°", "mrad", "s", "m"],
        "rad/s" => &["deg/s", "rad", "m/s", "s", "kg"],
        _ => &[],
    }
}

/// The same number, computed by other expressions.
pub(super) fn through_code(random: &mut Random, k: &MeasuredNumber) -> String {
    let texts = [
        "{m}",
        "[{m}][0]",
        "[{m}, {m}].slice(1)[0]",
        "(x => x)({m})",
        "+{m}.toFixed(9)",
        "Number(`${{m}}`)",
        "parseFloat(String({m}))",
        "(() => { let s = 0; for (const x of [{m}]) { s += x } return s })()",
        "[{m}].map(x => x).reduce((a, b) => a + b, 0)",
        "({a: {m}}).a",
        "Math.max({m}, {m})",
        "Math.sign({m}) * Math.exp(Math.log(abs({m})))",
        "{m} ** 2 / {m}",
        "{m} < 0 ? -abs({m}) : abs({m})",
    ];
    random.pick(&texts).replace("{m}", &k.name)
}

pub(super) fn wrong(random: &mut Random, measured: &[MeasuredNumber]) -> Vec<Claim> {
    let k = random.pick(measured);
    let a = asked(k);
    let with = |answer: f64| ClaimedValue { answer: rounded(answer), ..asked(k) };
    let value = |variant: &str, truth, asked: &ClaimedValue<'_>, text: &str| {
        question("value", variant, truth, asked, text, &[])
    };
    let away = a.tol * (1.2 + 0.5 * random.below(60) as f64);
    let mut all = vec![
        value("another number", Truth::False, &with(k.x + away), &k.name),
        value("another number", Truth::False, &with(k.x - away), &k.name),
        value("a measure moved", Truth::False, &a, &format!("{} + {}", k.name, rounded(away))),
    ];
    if k.x.abs() > 2.0 * a.tol {
        all.push(value("another sign", Truth::False, &with(-k.x), &k.name));
        all.push(value("a factor", Truth::False, &with(1000.0 * k.x), &k.name));
        all.push(value("a factor", Truth::False, &a, &format!("2 * {}", k.name)));
        for unit in other_units(k.unit) {
            let text = through_code(random, k);
            all.push(value("another unit", Truth::False, &ClaimedValue { unit, ..asked(k) }, &text));
        }
        if !k.unit.is_empty() {
            let unit = *random.pick(&["furlongs", "S", "blinks", "fortnights", "Wb", "x"]);
            all.push(value("an unknown unit", Truth::False, &ClaimedValue { unit, ..asked(k) }, &k.name));
        }
    }
    let other = random.pick(measured);
    if (other.x - k.x).abs() > 1.2 * a.tol {
        all.push(value("another measure or run", Truth::False, &a, &other.name));
    }
    // The value of a mistake is within the tolerance, or is missing.
    let inside = format!("{} + {}", k.name, 0.4 * a.tol);
    all.push(question("wrong", "a mistake within the tolerance", Truth::False, &a, &k.name, &[inside]));
    all.push(question(
        "wrong",
        "a mistake within the tolerance",
        Truth::False,
        &a,
        &k.name,
        &[format!("{}", a.answer)],
    ));
    let run = k.name.split('.').next().unwrap();
    let z = format!("{run}.{}", random.pick(&NEVER).name);
    for text in [
        z.clone(),
        format!("{z} || 1e9"),
        format!("({z} | 0) + 1e6"),
        format!("{z} > 1 ? {} : 1e9", k.name),
        "Math.sqrt(-1)".into(),
    ] {
        all.push(question("wrong", "a mistake that is no number", Truth::Empty, &a, &k.name, &[text]));
    }
    all.push(question(
        "wrong",
        "a condition for a mistake",
        Truth::Empty,
        &a,
        &k.name,
        &[format!("{} > 1e9", k.name)],
    ));
    all
}

pub(super) fn empty(random: &mut Random, measured: &[MeasuredNumber]) -> Vec<Claim> {
    let k = random.pick(measured);
    let a = asked(k);
    let (m, x) = (&k.name, a.answer);
    let run = m.split('.').next().unwrap();
    let z = format!("{run}.{}", random.pick(&NEVER).name);
    let value = |variant: &str, asked: &ClaimedValue<'_>, text: String| {
        question("value", variant, Truth::Empty, asked, &text, &[])
    };
    let truth = ClaimedValue { answer: 1.0, tol: 0.1, unit: "" };
    let half = ClaimedValue { answer: 0.5, tol: 0.01, unit: "" };
    let mut all = Vec::new();
    for text in [
        format!("{x} + 0 * {m}"),
        format!("{x} + {m} - {m}"),
        format!("{m} > 0 ? {x} : {x}"),
        format!("[{x}, {m}][0]"),
        format!("{x} * {m} ** 0"),
        format!("Math.max({x}, Math.min({m}, {x}))"),
        format!("((a, b) => b)({m}, {x})"),
        format!("{x} * ({m} === {m} ? 1 : 0)"),
    ] {
        all.push(value("the same whatever is measured", &a, text));
    }
    for text in [
        format!("{m} > -1e9"),
        format!("!({m} > 1e9)"),
        format!("{m} < 1e9 && true"),
        format!("[{m} > -1e9][0]"),
    ] {
        all.push(value("a condition for a number", &truth, text));
    }
    for text in [format!("{x}"), format!("'{x}'"), format!("-(-({x}))")] {
        all.push(value("a constant", &a, text));
    }
    for text in ["'0.5'".to_string(), "'0.' + '5'".into(), "'a0.5'.slice(1)".into()] {
        all.push(value("a text for a number", &half, text));
    }
    for text in [
        format!("({z} || 0) + {x}"),
        format!("({z} | 0) + {x}"),
        format!("{z} > 1 ? 0 : {x}"),
        format!("[{x}, {z}].filter(v => v !== {z})[0]"),
        format!("{x} + [{z}].filter(v => v > 0).length"),
        format!("Math.max(...[{x}, {z}].filter(v => v > -1e9))"),
        format!("{x} + Boolean({z})"),
        format!("{x} + [1].indexOf({z}) + 1"),
    ] {
        all.push(value("decided by what is no number", &a, text));
    }
    let root = ClaimedValue { answer: 0.4472, tol: 0.02, unit: "" };
    for text in [
        format!("{run}.rooted"),
        "max(Math.sqrt(0.2 - data.time))".to_string(),
        "initial(Math.sqrt(0.2 - data.time)) + 0 * count(!(Math.sqrt(0.2 - data.time) > 9))".into(),
    ] {
        all.push(value("samples that are no number", &root, text));
    }
    all.push(value(
        "reads the data outside of an aggregate",
        &ClaimedValue { answer: 0.0, tol: 0.01, unit: "" },
        "data.time".into(),
    ));
    all.push(value("reads the data outside of an aggregate", &a, format!("{x} + 0 * data.time")));
    let mut chosen = Vec::new();
    for _ in 0..10 {
        chosen.push(random.pick(&all).clone());
    }
    let worked =
        |text: String| question("value", "a formula that reads no measure", Truth::Worked, &a, &text, &[]);
    chosen.push(worked(format!("{x} / 2 + {x} / 2")));
    chosen.push(question(
        "value",
        "a constant as a measure",
        Truth::Worked,
        &half,
        &format!("{run}.half"),
        &[],
    ));
    chosen
}
