//! Options of questions: conditions that are true but could be false, and altered ones.

use super::lesson::{Body, Claim, Truth};
use super::random::printed;
use super::scenes::NEVER;
use super::values::other_units;
use crate::support::random::Random;
use serde_json::json;

/// A measure of a run, by its name in a claim, with its value.
#[derive(Clone)]
pub(super) struct MeasuredNumber {
    pub(super) name: String,
    pub(super) x: f64,
    pub(super) unit: &'static str,
    pub(super) positive: bool,
}

/// A question with this condition at the keyed option.
pub(super) fn question(
    kind: &'static str,
    variant: &str,
    truth: Truth,
    condition: &str,
    others: [&str; 2],
) -> Claim {
    let q = json!({
        "q": "What happens?", "options": ["This", "That", "Another thing"], "answer": 0, "explain": "It is so.",
        "verify": {"use": "#1", "options": [condition, others[0], others[1]]}
    });
    Claim { kind, variant: variant.into(), truth, body: Body::Question(q) }
}

/// Conditions that are false here but could be true.
fn not_so(k: &MeasuredNumber) -> [String; 2] {
    let MeasuredNumber { name, x, .. } = k;
    let far = 2.0 * x.abs() + 1.0;
    [format!("{name} > {}", x + far), format!("{name} < {}", x - far)]
}

fn option(variant: &str, truth: Truth, condition: &str, k: &MeasuredNumber) -> Claim {
    // Both other options use the first condition, which could be true even if the measure is never negative.
    let others = not_so(k);
    question("option", variant, truth, condition, [&others[0], &others[0]])
}

/// Questions with true conditions.
pub(super) fn right(random: &mut Random, measured: &[MeasuredNumber]) -> Vec<Claim> {
    let k = random.pick(measured);
    let MeasuredNumber { name, x, .. } = k;
    let d = 0.05 * x.abs() + 0.02;
    let texts = [
        format!("abs({name} - {x}) < {d}"),
        format!("{name} > {} && {name} < {}", x - d, x + d),
        format!("!({name} > {})", x + d),
        format!("Math.abs({name} - ({x})) <= {d}"),
    ];
    vec![option("", Truth::True, random.pick::<String>(&texts), k)]
}

/// Questions with false conditions.
pub(super) fn wrong(random: &mut Random, measured: &[MeasuredNumber]) -> Vec<Claim> {
    let k = random.pick(measured);
    let MeasuredNumber { name, x, .. } = k;
    let d = 0.05 * x.abs() + 0.02;
    let away = d * (1.5 + random.below(40) as f64) * if random.below(2) == 0 { 1.0 } else { -1.0 };
    let mut made = vec![
        ("another number", format!("abs({name} - {}) < {d}", x + away)),
        ("negated", format!("!(abs({name} - {x}) < {d})")),
        ("negated", format!("abs({name} - {x}) > {d}")),
        ("moved beyond the value", format!("{name} > {}", x + d)),
        ("moved beyond the value", format!("{name} < {} || {name} > {}", x - d, x + d)),
    ];
    if x.abs() > 0.2 {
        made.push(("another sign", format!("abs({name} + {x}) < {d}")));
        made.push(("another unit", format!("abs(1000 * {name} - {x}) < {d}")));
        made.push(("another unit", format!("abs({name} - {}) < {d}", 1000.0 * x)));
        made.push(("a factor", format!("abs(2 * {name} - {x}) < {d}")));
    }
    if (x - x * x).abs() > d * 2.0 {
        made.push(("a factor", format!("abs({name} ** 2 - {x}) < {d}")));
    }
    let other = random.pick(measured);
    if (other.x - x).abs() > 1.1 * d {
        let variant = if other.name.split('.').next_back() == name.split('.').next_back() {
            "another run"
        } else {
            "another measure"
        };
        made.push((variant, format!("abs({} - {x}) < {d}", other.name)));
    }
    made.into_iter().map(|(variant, text)| option(variant, Truth::False, &text, k)).collect()
}

/// Conditions without a statement about a measure `m` of value `x` and another measure `n`.
fn empty_of(m: &str, n: &str, x: f64, positive: bool) -> Vec<(&'static str, String)> {
    let mut all: Vec<(&'static str, String)> = [
        "{m} === {m}",
        "{m} == {m}",
        "{m} >= {m}",
        "{m} <= {m}",
        "!({m} < {m})",
        "!({m} !== {m})",
        "0 * {m} === 0",
        "{m} - {m} < 1",
        "{m} - {m} === 0",
        "{m} * 0 < 1",
        "1 + 0 * {m} > 0",
        "Math.pow({m}, 0) === 1",
        "{m} ** 0 > 0",
        "{m} > {x} || {m} <= {x}",
        "!({m} > {x} && {m} <= {x})",
        "{m} < {x} ? true : {m} >= {x}",
        "{m} > 0 || {m} <= 0",
        "{m} > 3 || true",
        "true || {m} > 3",
        "{m} > 3 ? true : true",
        "{m} > {n} || {m} <= {n}",
        "{m} + {n} === {n} + {m}",
        "({m} > {n}) === ({m} > {n})",
        "({m} > 1) !== !({m} > 1)",
        "[{m}].length === 1",
        "[{m}, {n}].length > 1",
        "abs({m}) >= 0",
        "Math.abs({m}) >= 0",
        "Math.abs({m}) > -1",
        "{m} * {m} >= 0",
        "{m} ** 2 + 1 > 0",
        "Math.sin({m}) <= 1",
        "Math.cos({m}) >= -1.5",
        "Math.hypot({m}, 1) >= 1",
        "Math.exp({m}) >= 0",
        "Math.max({m}, {n}) >= {m}",
        "Math.min({m}, 5) <= 5",
        "Math.max({m}, 1) > 0",
        "Math.sign({m}) < 2",
        "{m} % 1 < 1",
        "isNaN({m}) || !isNaN({m})",
        "String({m}).length > 0",
        "{m} !== undefined",
        "{m} != null",
        "[{m}].every(x => x === x)",
        "[{m}].some(x => x > 3 || x <= 3)",
        "[{m}].map(x => 0 * x)[0] === 0",
        "(() => { const a = {m}; return a - a < 1; })()",
        "[{m}, {n}].indexOf({m}) >= 0",
        "(x => x - x)({m}) === 0",
        "abs({m} - {n}) >= 0",
        "abs({m} - {n}) < 1 || abs({m} - {n}) >= 1",
    ]
    .iter()
    .map(|t| {
        (
            "says the same whatever is measured",
            t.replace("{m}", m).replace("{n}", n).replace("{x}", &x.to_string()),
        )
    })
    .collect();
    for text in ["true", "1", "'text'", "!0", "0.5", "text"] {
        all.push(("a constant", text.to_string()));
    }
    all.push(("a number instead of a condition", m.to_string()));
    all.push(("a number instead of a condition", format!("{m} + 0.1234567")));
    all.push(("a text instead of a condition", format!("'' + {m}")));
    all.push(("a list instead of a condition", format!("[{m} > 0]")));
    for text in [
        "data.qpos[0] < 1e9",
        "data.time < 1",
        "data.qvel[0] > -1e9",
        "!(data.qpos[0] > 1e6)",
        "data.time >= 0",
    ] {
        all.push(("reads the data outside of an aggregate", text.to_string()));
    }
    for text in [
        "min(data.time) >= 0",
        "count(data.qpos[0] > 0) >= 0",
        "max(abs(data.qpos[0])) >= 0",
        "holds(data.time > -1) < 2",
        "rms(data.qpos[0]) >= 0",
        "final(data.time - data.time) === 0",
        "max(0 * data.qpos[0]) < 1",
    ] {
        all.push(("true of every value of its kind", text.to_string()));
    }
    if positive {
        all.push(("true of every value of its kind", format!("{m} >= 0")));
        all.push(("true of every value of its kind", format!("{m} > -1")));
        all.push(("true of every value of its kind", format!("!({m} < 0)")));
        all.push(("true of every value of its kind", format!("Math.sqrt({m}) >= 0")));
    }
    all
}

/// Conditions that are decided by a missing number: the event of `z` never happens, and `m` is a measure.
fn missing_of(z: &str, m: &str) -> Vec<String> {
    [
        "!({z} < 1)",
        "!({z} >= 0)",
        "!({z} > {m})",
        "({z} || 0) < 1",
        "({z} | 0) === 0",
        "~~{z} === 0",
        "({z} >> 1) === 0",
        "Boolean({z}) === false",
        "!{z}",
        "!!{z} === false",
        "String({z}) === 'NaN'",
        "`${{z}}` !== '5'",
        "'' + {z} !== '0.5'",
        "[1, 2].indexOf({z}) < 0",
        "![1, 2].includes({z})",
        "![{z}].some(x => x > 1)",
        "[{z}].every(x => !(x > 1))",
        "[{z}].filter(x => x > 0).length === 0",
        "[{z}].map(x => x > 0)[0] === false",
        "[3, {z}, 1].sort((a, b) => a - b)[0] < 5",
        "[3, {z}, 1].sort()[0] < 5",
        "(() => { if ({z} > 1) { return false; } return true; })()",
        "(z => !(z > 1))({z})",
        "{z} > 1 ? false : true",
        "{z} ? false : true",
        "{z} !== {z}",
        "{z} !== 5",
        "{z} != 5",
        "!({z} === 5)",
        "Math.max(0, {z} || 0) === 0",
        "Math.sign({z}) !== 1",
        "Math.floor({z}) !== 3",
        "{z}.toFixed(2) !== '1.00'",
        "({z} > 1) + 0 === 0",
        "({z} & 1) === 0",
        "isNaN({m}) || !({z} < 1)",
        "!({z} < 1) || {m} > 1e9",
        "!({z} > 1 && {m} > -1e9)",
        "({z} && {m}) !== 1",
        "!({z} + {m} < 1)",
        "[{m}, {z}].reduce((a, b) => a + (b > 0 ? 1 : 0), 0) < 5",
        "(a => { let n = 0; for (const x of a) { if (x > 0) { n += 1; } } return n; })([{z}]) === 0",
        "(() => { let z = {z}; while (z > 0) { z = -1; } return z !== -1; })()",
        "Math.min(...[{z}].filter(x => x > 0), 7) === 7",
        "!(Math.abs({z} - {m}) < 1e9)",
        "Number({z} > 0) === 0",
        "({z} ^ 0) === 0",
        "JSON.stringify({z}) !== '5'",
        "Number.isInteger({z}) === false",
        "[{z}].indexOf(5) === -1",
        "[{z}].findIndex(x => x > 0) === -1",
        "parseFloat({z}) !== 3",
    ]
    .iter()
    .map(|t| t.replace("{z}", z).replace("{m}", m))
    .collect()
}

/// Conditions on samples some of which are NaN.
const MISSING: &[&str] = &[
    "holds(!(NaN < -1)) === 1",
    "hopeless === 1",
    "hidden === 1",
    "counted > 0",
    "rooted > 0.4",
    "rooted < 0.5",
    "max(Math.sqrt(0.2 - data.time)) > 0.4",
    "min(Math.sqrt(0.2 - data.time)) < 0.3",
    "mean(Math.sqrt(0.2 - data.time)) > 0.1",
    "holds(!(Math.sqrt(0.2 - data.time) > 9)) === 1",
    "count(!(Math.log(-1 - data.time) > 0)) === 1",
    "first(!(Math.sqrt(-1 - data.time) > 0)) < 0.1",
    "max((Math.sqrt(0.2 - data.time) || 0)) > 0.4",
    "last(!(Math.sqrt(0.2 - data.time) > 0)) > 0.3",
    "min([].length ? 1 : Math.sqrt(-1 - data.time)) < 5",
    "holds(Math.sqrt(-1 - data.time) !== 3) === 1",
    "max(Math.max(Math.sqrt(-1 - data.time) || 0, 0)) === 0",
    "!(min([][0]) > 0)",
    "!(final(Math.sqrt(-1 - data.time)) < 3)",
    "integral(Math.sqrt(0.2 - data.time)) > 0",
];

/// Conditions that the measures of a run satisfy in every run.
const ALWAYS_TRUE: &[&str] = &[
    "{r}.seven === 7",
    "{r}.seven > 3",
    "{r}.nothing === 0",
    "{r}.always === 1",
    "{r}.high >= {r}.low",
    "!({r}.low > {r}.high)",
    "{r}.high === {r}.top",
    "{r}.spread >= 0",
    "{r}.spread === {r}.high - {r}.low",
    "{r}.size + 1e-9 >= abs({r}.middle)",
    "abs({r}.high - {r}.top) < 1",
    "Math.max({r}.high, {r}.low) === {r}.high",
    "[{r}.low, {r}.high].every((x, i, all) => i === 0 || x >= all[0])",
    "{r}.late > 0.02 && {r}.late < 0.1 && {r}.seven === 7",
];

pub(super) fn empty(random: &mut Random, measured: &[MeasuredNumber]) -> Vec<Claim> {
    let k = random.pick(measured);
    let other = random.pick(measured);
    let run = k.name.split('.').next().unwrap();
    let z = format!("{run}.{}", random.pick(&NEVER).name);
    let in_run = |text: &str| {
        ["hopeless", "hidden", "counted", "rooted", "half", "text"].iter().fold(
            text.to_string(),
            |t, word| {
                if t.starts_with(word) { t.replacen(word, &format!("{run}.{word}"), 1) } else { t }
            },
        )
    };
    let mut all: Vec<(&str, String)> = Vec::new();
    let list = empty_of(&k.name, &other.name, k.x, k.positive);
    for _ in 0..8 {
        all.push(random.pick(&list).clone());
    }
    for _ in 0..3 {
        let text = random.pick(ALWAYS_TRUE).replace("{r}", run);
        all.push(("the same of every run", text));
    }
    let list = missing_of(&z, &k.name);
    for _ in 0..8 {
        all.push(("decided by what is no number", random.pick(&list).clone()));
    }
    for _ in 0..2 {
        all.push(("samples that are no number", (*random.pick(MISSING)).to_string()));
    }
    all.iter().map(|(variant, text)| option(variant, Truth::Empty, &in_run(text), k)).collect()
}

/// Options whose text states a number, with a condition on the same measure.
pub(super) fn texts(random: &mut Random, measured: &[MeasuredNumber]) -> Vec<Claim> {
    let k = random.pick(measured);
    let Some((x, _)) = printed(k.x).filter(|_| !k.unit.is_empty() && k.x > 0.05) else { return Vec::new() };
    let unit = k.unit;
    let d = 0.04 * k.x;
    let condition = format!("abs({} - {}) < {d}", k.name, k.x);
    let others = not_so(k);
    let claim = |variant: &str, truth, text: &str| {
        let mut made = question("text of an option", variant, truth, &condition, [&others[0], &others[0]]);
        if let Body::Question(q) = &mut made.body {
            q["options"][0] = json!(text);
        }
        made
    };
    let times = |f: f64| format!("{:.*}", if k.x * f < 1.0 { 4 } else { 2 }, k.x * f);
    let say = |number: &str, unit: &str, random: &mut Random| {
        let forms = [
            "about {}",
            "It comes to {}",
            "{}",
            "roughly {}, no more",
            "Just {}.",
            "**{}**",
            "They are {} apart",
        ];
        random.pick(&forms).replace("{}", &format!("{number} {unit}"))
    };
    let mut all = vec![claim("", Truth::True, &say(&x, unit, random))];
    // The text is only a number, and the condition has only one bound.
    for factor in [0.3, 3.0] {
        let condition = format!("{} < {}", k.name, 1.2 * k.x);
        let mut made = question(
            "text of an option",
            "another number alone",
            Truth::False,
            &condition,
            [&others[0], &others[0]],
        );
        if let Body::Question(q) = &mut made.body {
            q["options"][0] = json!(format!("{} {unit}", times(factor)));
        }
        all.push(made);
    }
    for factor in [0.1, 0.5, 0.8, 1.25, 2.0, 10.0] {
        all.push(claim("another number", Truth::False, &say(&times(factor), unit, random)));
    }
    // Only units of the same kind: with another kind of unit, the number could be a different quantity.
    let kind = |u: &&&str| match unit {
        "s" => ["ms", "min", "h", "µs"].contains(u),
        "m" => ["mm", "cm", "km"].contains(u),
        "m/s" => ["mm/s", "km/h", "cm/s"].contains(u),
        _ => false,
    };
    for other in other_units(unit).iter().filter(kind).filter(|u| **u != "h") {
        all.push(claim("another unit", Truth::False, &say(&x, other, random)));
    }
    all
}
