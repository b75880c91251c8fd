//! Claims about ranges, searches, fits and ends of runs, by a known law; and closed forms.

use super::lesson::{Body, Claim, Truth};
use super::scenes::{Law, Scene};
use crate::support::random::Random;
use serde_json::{Value, json};

impl Law {
    fn at(&self, slider: f64) -> f64 {
        self.factor * slider.powf(self.power)
    }

    /// The value of the slider at which the measure has this value.
    fn reached(&self, x: f64) -> f64 {
        (x / self.factor).powf(1.0 / self.power)
    }

    fn verify(&self, runs: Value) -> Value {
        json!({"lab": "#1", "runs": runs, "measure": {self.measure: self.expr, "never": "first(data.time > 1000)"}})
    }
}

fn choice(kind: &'static str, variant: &str, truth: Truth, mut verify: Value, options: [String; 3]) -> Claim {
    verify["options"] = json!(options);
    let q = json!({"q": "What happens?", "options": ["This", "That", "Another thing"], "answer": 0, "explain": "So.", "verify": verify});
    Claim { kind, variant: variant.into(), truth, body: Body::Question(q) }
}

fn numeric(
    kind: &'static str,
    variant: &str,
    truth: Truth,
    mut verify: Value,
    value: &str,
    answer: f64,
    tol: f64,
) -> Claim {
    verify["value"] = json!(value);
    let [answer, tol] = [answer, tol].map(|x| format!("{x:.5}").parse::<f64>().unwrap());
    let q = json!({"kind": "numeric", "q": "How much?", "answer": answer, "tol": tol, "explain": "So.", "verify": verify});
    Claim { kind, variant: variant.into(), truth, body: Body::Question(q) }
}

pub(super) fn over(scene: &Scene) -> Vec<Claim> {
    let Some(law) = &scene.law else { return Vec::new() };
    let m = law.measure;
    let [most, least] = law.range.map(|s| law.at(s));
    let now = scene.lab["controls"][0]["value"].as_f64().unwrap();
    let far = [format!("{m} > {}", 5.0 * most), format!("{m} > {}", 6.0 * most)];
    let holds = format!("{m} > {} && {m} < {}", 0.9 * least, 1.1 * most);
    let options = |keyed: &str| [keyed.to_string(), far[0].clone(), far[1].clone()];
    let claim = |variant: &str, truth, runs: Value, slider: &str, range: [f64; 2], keyed: &str| {
        let mut verify = law.verify(runs);
        verify["over"] = json!({slider: range});
        choice("over", variant, truth, verify, options(keyed))
    };
    let free = json!({"r": {"until": law.until}});
    let set = json!({"r": {"set": {law.slider: now}, "until": law.until}});
    let beside = json!({"r": {"set": {law.slider: now}, "until": law.until}, "s": {"until": law.until}});
    let mut all = vec![
        claim("", Truth::True, free.clone(), law.slider, law.range, &holds),
        claim("the run sets the slider itself", Truth::Empty, set, law.slider, law.range, &holds),
        claim(
            "the run sets the slider itself",
            Truth::Empty,
            beside,
            law.slider,
            law.range,
            &holds.replace(m, &format!("r.{m}")),
        ),
        claim("a slider that changes nothing", Truth::Empty, free.clone(), "colour", [0.0, 1.0], &holds),
        claim(
            "a condition that cannot fail",
            Truth::Empty,
            free.clone(),
            law.slider,
            law.range,
            &format!("{m} >= 0"),
        ),
        claim(
            "decided by what is no number",
            Truth::Empty,
            free.clone(),
            law.slider,
            law.range,
            "!(never < 1)",
        ),
    ];
    let (low, high) = (law.at(now) * 0.9, law.at(now) * 1.1);
    if high < 0.95 * most {
        all.push(claim(
            "beyond what holds",
            Truth::False,
            free.clone(),
            law.slider,
            law.range,
            &format!("{m} < {}", (high + most) / 2.0),
        ));
    }
    if low > 1.05 * least {
        all.push(claim(
            "beyond what holds",
            Truth::False,
            free.clone(),
            law.slider,
            law.range,
            &format!("{m} > {}", (low + least) / 2.0),
        ));
        all.push(claim(
            "a band in the middle",
            Truth::False,
            free,
            law.slider,
            law.range,
            &format!("{m} > {} || {m} < {}", low, 0.95 * low),
        ));
    }
    all
}

pub(super) fn find(random: &mut Random, scene: &Scene) -> Vec<Claim> {
    let Some(law) = &scene.law else { return Vec::new() };
    let m = law.measure;
    let [from, to] = law.range;
    let middle = from + (to - from) * (0.3 + 0.04 * random.below(11) as f64);
    let bound = law.at(middle);
    let limit = law.reached(bound);
    let object = |variant: &str, condition: &str| {
        let mut verify = law.verify(json!({"r": {"until": law.until}}));
        verify["find"] = json!({"limit": {variant: law.slider, "from": from, "to": to, "run": "r", "while": condition, "tol": 0.01 * from}});
        verify
    };
    let (right, tol) = (format!("{m} > {bound}"), 0.03 * limit);
    let claim = |variant: &str, truth, verify: Value, answer: f64| {
        numeric("find", variant, truth, verify, "limit", answer, tol)
    };
    let mut all = vec![
        claim("", Truth::True, object("largest", &right), limit),
        claim("another limit", Truth::False, object("largest", &right), 1.1 * limit),
        claim("another limit", Truth::False, object("largest", &right), 0.9 * limit),
        claim("another limit", Truth::False, object("largest", &right), -limit),
        claim("another limit", Truth::False, object("largest", &right), to),
        claim(
            "another condition",
            Truth::False,
            object("largest", &format!("{m} > {}", law.at(middle * 1.15))),
            limit,
        ),
        claim("from the other side", Truth::False, object("smallest", &right), limit),
        claim("from the other side", Truth::False, object("smallest", &right), from),
        claim(
            "holds everywhere",
            Truth::Empty,
            object("largest", &format!("{m} > {}", 0.5 * law.at(to))),
            to,
        ),
        claim(
            "holds nowhere",
            Truth::Empty,
            object("largest", &format!("{m} > {}", 2.0 * law.at(from))),
            from,
        ),
        claim("a condition that cannot fail", Truth::Empty, object("largest", &format!("{m} === {m}")), to),
        claim("decided by what is no number", Truth::Empty, object("largest", "!(never < 1)"), to),
        claim("a number instead of a condition", Truth::Empty, object("largest", m), to),
        claim(
            "a number instead of a condition",
            Truth::Empty,
            object("largest", &format!("{m} * 0 + 1")),
            to,
        ),
    ];
    for (truth, text) in [(Truth::True, limit), (Truth::False, 1.2 * limit)] {
        let quote = format!("{text:.0}");
        // The steps of the run change the limit by up to one percent.
        let sure = (0.99 * limit).round() == (1.01 * limit).round();
        if sure && (truth == Truth::True || (text - limit).abs() > 1.0) {
            let mut verify = object("largest", &right);
            verify["says"] = json!([[quote, "limit"]]);
            let variant = if truth == Truth::True { "" } else { "another limit" };
            all.push(Claim {
                kind: "find",
                variant: variant.into(),
                truth,
                body: Body::Text(verify, format!("It holds up to {quote} here.")),
            });
        }
    }
    all
}

pub(super) fn fit(scene: &Scene) -> Vec<Claim> {
    let Some(law) = &scene.law else { return Vec::new() };
    let [from, to] = law.range;
    let values: Vec<f64> = (0..5).map(|i| from + (to - from) * f64::from(i) / 4.0).collect();
    let verify = law.verify(json!({"r": {"sweep": {law.slider: values}, "until": law.until}}));
    let m = format!("r.{}", law.measure);
    let power = format!("fit({m}, 'power')");
    let claim = |variant: &str, truth, text: &str, answer: f64| {
        numeric("fit", variant, truth, verify.clone(), text, answer, 0.03)
    };
    let option = |text: &str| {
        let others = [format!("{m}[0] > 1e6"), format!("{m}[1] > 1e6")];
        let variant = "the same whatever is measured";
        choice(
            "fit",
            variant,
            Truth::Empty,
            verify.clone(),
            [text.to_string(), others[0].clone(), others[1].clone()],
        )
    };
    vec![
        option(&format!("true || {m}[0] > 3")),
        option(&format!("{m}.length > 3")),
        option(&format!("{m}.length === {m}.length")),
        option(&format!("{m}.every(t => t === t)")),
        claim("", Truth::True, &power, law.power),
        claim("another exponent", Truth::False, &power, -law.power),
        claim("another exponent", Truth::False, &power, law.power + 0.1),
        claim("another exponent", Truth::False, &power, 2.0 * law.power),
        claim("another exponent", Truth::False, &power, 0.0),
        claim("another law", Truth::False, &format!("fit({m}, 'exponential')"), law.power),
        claim("another law", Truth::False, &format!("slope({m}) + 1e6"), law.power),
        claim("another list", Truth::False, "fit(r.value.map(v => v ** 3), 'power', r.value)", law.power),
        claim(
            "another list",
            Truth::False,
            &format!("fit({m}.map(t => t ** 2), 'power', r.value)"),
            law.power,
        ),
        claim(
            "the same whatever is measured",
            Truth::Empty,
            &format!("{} + 0 * {power}", law.power),
            law.power,
        ),
        claim(
            "decided by what is no number",
            Truth::Empty,
            &format!("(fit(r.never, 'power') || 0) + {}", law.power),
            law.power,
        ),
    ]
}

/// Runs that end when a condition holds.
pub(super) fn stop() -> Vec<Claim> {
    let claim = |variant: &str, truth, stop: &str, keyed: &str| {
        let verify = json!({"lab": "#1", "runs": {"r": {"stop": stop, "until": 1}}, "measure": {"end": "final(data.time)"}});
        choice("stop", variant, truth, verify, [keyed.to_string(), "end > 5".into(), "end > 6".into()])
    };
    let mut all = vec![
        claim("", Truth::True, "data.time > 0.3", "abs(end - 0.3) < 0.02"),
        claim("another end", Truth::False, "data.time > 0.4", "abs(end - 0.3) < 0.02"),
        claim("another end", Truth::False, "data.time > 2", "abs(end - 0.3) < 0.02"),
    ];
    for stop in [
        "!(Math.sqrt(-1 - data.time) > 0)",
        "!(Math.log(-1 - data.time) < 5)",
        "(Math.sqrt(-1 - data.time) || 0) < 1",
        "Math.sqrt(-1 - data.time) !== 3",
    ] {
        all.push(claim("decided by what is no number", Truth::Empty, stop, "end < 0.1"));
    }
    for stop in ["Math.sqrt(-1 - data.time) > 0", "Math.sqrt(0.3 - data.time) > 9"] {
        all.push(claim("decided by what is no number", Truth::Empty, stop, "end > 0.9"));
    }
    all
}

pub(super) fn exact(random: &mut Random, scene: &Scene) -> Vec<Claim> {
    let claim = |variant: &str, truth, trace: &str, form: Value| {
        let verify = json!({"lab": "#1", "exact": {trace: form}});
        Claim {
            kind: "exact",
            variant: variant.into(),
            truth,
            body: Body::Text(verify, "It follows a formula.".into()),
        }
    };
    let mut all = Vec::new();
    for form in &scene.forms {
        if !form.right.is_empty() {
            all.push(claim("", Truth::True, form.trace, json!(form.right)));
        }
        for wrong in &form.wrong {
            all.push(claim("another formula", Truth::False, form.trace, json!(wrong)));
        }
        let traced = scene.lab["plots"][0]["traces"].as_array().unwrap();
        let trace_expr = traced.iter().find(|t| t["label"] == form.trace).unwrap()["expr"].as_str().unwrap();
        let reads = [
            trace_expr.to_string(),
            format!("1 * {trace_expr}"),
            format!("{trace_expr} + 0 * data.time"),
            format!("(() => {trace_expr})()"),
            format!("data.time > 1e6 ? 0 : {trace_expr}"),
        ];
        all.push(claim("reads the data", Truth::Empty, form.trace, json!(random.pick(&reads))));
        let tol = json!({"is": random.pick(&reads), "tol": 0.01});
        all.push(claim("reads the data", Truth::Empty, form.trace, tol));
        all.push(claim("a missing number", Truth::Empty, form.trace, json!("Math.sqrt(-1 - data.time)")));
        all.push(claim(
            "a missing number",
            Truth::Empty,
            form.trace,
            json!({"is": "Math.sqrt(-1 - data.time)", "tol": 1}),
        ));
        let wide = json!({"is": random.pick(&form.wrong), "tol": 1e6});
        all.push(claim("a tolerance of everything", Truth::Empty, form.trace, wide));
        let narrow = json!({"is": random.pick(&form.wrong), "tol": 1e-4});
        all.push(claim("another formula", Truth::False, form.trace, narrow));
    }
    all
}

/// Columns of tables whose rows are members of a sweep.
pub(super) fn columns(random: &mut Random, scene: &Scene) -> Vec<Claim> {
    let Some(law) = &scene.law else { return Vec::new() };
    let [from, to] = law.range;
    let values: Vec<f64> = (0..3).map(|i| (from + (to - from) * f64::from(i) / 2.0).round()).collect();
    let unit = if law.slider == "g" { "m/s^2" } else { "N/m" };
    let claim = |variant: &str, truth, heads: [&str; 2], rows: &[[String; 2]]| {
        let mut verify = law.verify(json!({"r": {"sweep": {law.slider: values}, "until": law.until}}));
        let is = format!("r.{}", law.measure);
        verify["table"] = json!([{"column": heads[1], "by": [heads[0], "r.value"], "is": is}]);
        let rows: String = rows.iter().map(|[a, b]| format!("| {a} | {b} |\n")).collect();
        let block = format!("| {} | {} |\n|---|---|\n{}", heads[0], heads[1], rows.trim_end());
        Claim { kind: "column", variant: variant.into(), truth, body: Body::Text(verify, block) }
    };
    // Two decimals, and only texts whose digits half a step of the run cannot change.
    let cell = |x: f64| {
        let text = format!("{x:.2}");
        ((x - text.parse::<f64>().unwrap()).abs() < 0.003).then_some(text)
    };
    let rows: Vec<[String; 2]> =
        values.iter().filter_map(|v| Some([format!("{v}"), cell(law.at(*v))?])).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let heads = [format!("{} ({unit})", law.slider), format!("{} (s)", law.measure)];
    let heads = [heads[0].as_str(), heads[1].as_str()];
    let mut all = vec![claim("", Truth::True, heads, &rows)];
    let changed = |f: &dyn Fn(&mut [[String; 2]])| {
        let mut rows = rows.clone();
        f(&mut rows);
        rows
    };
    let i = random.below(rows.len());
    let plus = |text: &str, by: f64| format!("{:.2}", text.parse::<f64>().unwrap() + by);
    all.push(claim("another number", Truth::False, heads, &changed(&|r| r[i][1] = plus(&r[i][1], 0.02))));
    all.push(claim("another number", Truth::False, heads, &changed(&|r| r[i][1] = plus(&r[i][1], -0.03))));
    all.push(claim("another sign", Truth::False, heads, &changed(&|r| r[i][1] = format!("-{}", r[i][1]))));
    all.push(claim("another row", Truth::False, heads, &changed(&|r| r[i][0] = plus(&r[i][0], 0.5))));
    if rows.len() > 1 && rows[0][1] != rows[rows.len() - 1][1] {
        let last = rows.len() - 1;
        let exchanged = changed(&|r| {
            let text = r[0][1].clone();
            r[0][1] = r[last][1].clone();
            r[last][1] = text;
        });
        all.push(claim("another row", Truth::False, heads, &exchanged));
    }
    for other in ["ms", "kg", "min", "m"] {
        let head = format!("{} ({other})", law.measure);
        all.push(claim("another unit", Truth::False, [heads[0], &head], &rows));
    }
    for other in ["mm/s^2", "kg", "s", "kN/m"] {
        let head = format!("{} ({other})", law.slider);
        all.push(claim("another unit of the rows", Truth::False, [&head, heads[1]], &rows));
    }
    // Words whose condition is a number.
    let mut words =
        claim("a number instead of a condition", Truth::Empty, heads, &changed(&|r| r[i][1] = "so".into()));
    if let Body::Text(verify, _) = &mut words.body {
        verify["table"][0]["row"] = json!(rows[i][0]);
        verify["table"][0]["is"] =
            json!({"so": format!("r.{}", law.measure), "not so": format!("r.{} > 1e6", law.measure)});
    }
    all.push(words);
    for text in ["?", "many", "see below", ""] {
        all.push(claim("a cell without a number", Truth::Empty, heads, &changed(&|r| r[i][1] = text.into())));
    }
    all
}
