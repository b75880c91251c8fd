//! Quoted numbers of texts and tables: true ones, and altered ones.

use super::conditions::MeasuredNumber;
use super::lesson::{Body, Claim, Truth};
use super::random::printed;
use super::scenes::NEVER;
use super::values::{other_units, through_code};
use crate::support::random::Random;
use serde_json::json;

fn says(variant: &str, truth: Truth, quote: &str, expr: &str, block: String) -> Claim {
    let verify = json!({"use": "#1", "says": [[quote, expr]]});
    Claim { kind: "says", variant: variant.into(), truth, body: Body::Text(verify, block) }
}

fn table(variant: &str, truth: Truth, heading: &str, cell: &str, is: &str) -> Claim {
    let verify = json!({"use": "#1", "table": [{"column": heading, "row": "here", "is": is}]});
    let block = format!("| place | {heading} |\n|---|---|\n| here | {cell} |");
    Claim { kind: "table", variant: variant.into(), truth, body: Body::Text(verify, block) }
}

struct Number {
    text: String,
    size: String,
    decimals: usize,
    minus: bool,
}

fn number(k: &MeasuredNumber) -> Option<Number> {
    let (text, decimals) = printed(k.x)?;
    // If the value is close to a rounding limit of the text, half a step of the run could change the digits.
    let unit = 10f64.powi(-(decimals as i32));
    let off = (k.x - text.parse::<f64>().unwrap()).abs() / unit;
    (off < 0.4).then(|| Number {
        size: text.trim_start_matches('-').to_string(),
        minus: text.starts_with('-'),
        text,
        decimals,
    })
}

fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() { number.to_string() } else { format!("{number} {unit}") }
}

pub(super) fn right(random: &mut Random, measured: &[MeasuredNumber]) -> Vec<Claim> {
    let k = random.pick(measured);
    let Some(n) = number(k) else { return Vec::new() };
    let text = with_unit(&n.text, k.unit);
    let blocks = [
        format!("It is {text} here."),
        format!("So much: **{text}**."),
        format!("About {text}, no more."),
        format!("- {text} is what comes of it."),
    ];
    let heading = if k.unit.is_empty() {
        "result".to_string()
    } else {
        random
            .pick(&[
                format!("result ({})", k.unit),
                format!("result in {}", k.unit),
                format!("result [{}]", k.unit),
            ])
            .clone()
    };
    vec![
        says("", Truth::True, &text, &k.name, random.pick(&blocks).clone()),
        table("", Truth::True, &heading, &n.text, &k.name),
    ]
}

/// Texts around a true number that make it state another number, or none: `{T}` is the number, `{U}` its unit, `{N}` both.
const FACTORS: &[&str] = &[
    "{T} thousand {U}",
    "{T} million {U}",
    "{T} e3 {U}",
    "{T}e3 {U}",
    "{T} × 10³ {U}",
    "{T}·10^3 {U}",
    "{T} %",
    "{T} % {U}",
    "2·{T} {U}",
    "2 · {T} {U}",
    "2 × {T} {U}",
    "√{T} {U}",
    "√({T}) {U}",
    "1+{T} {U}",
    "1 + {T} {U}",
    "3 {T} {U}",
    "{T}/2 {U}",
    "{T} / 3 {U}",
    "½ {T} {U}",
    "½·{T} {U}",
    "{T} ½ {U}",
    "{T}·2 {U}",
    "{T} × 2 {U}",
    "{T} + 1 {U}",
    "{T}² {U}",
    "{T}^2 {U}",
    "({T})² {U}",
    "twice {N}",
    "half of {N}",
    "a tenth of {N}",
    "{T} dozen {U}",
    "{T} hundred {U}",
    "3·10^2·{T} {U}",
    "5{T} {U}",
    "{T}5·10 {U}",
    "{T}7e1 {U}",
    "$2\\cdot {T}$ {U}",
    "$\\sqrt{{T}}$ {U}",
    "$\\frac{1}{2} {T}$ {U}",
    "$10^3 \\cdot {T}$ {U}",
    "{T}·10³ {U}",
    "$ {T}^2 $ {U}",
    "1/{T} {U}",
    "1 / {T} {U}",
    "10^{T} {U}",
    "{T}‰ {U}",
    "{T}k {U}",
    "π·{T} {U}",
    "π {T} {U}",
    "4 - {T} {U}",
    "log {T} {U}",
    "exp({T}) {U}",
    "{T} mille {U}",
];

const SIGNS: &[&str] = &[
    "minus {N}",
    "−{N}",
    "− {N}",
    "-{N}",
    "- {N}",
    "–{N}",
    "negative {N}",
    "Minus {N}",
    "$-{T}$ {U}",
    "$- {T}$ {U}",
    "&minus;{N}",
    "−&nbsp;{N}",
    "**−**{N}",
    "−**{N}**",
    "minus **{N}**",
    "(−{T}) {U}",
    "-<b>{N}</b>",
    "&#45;{N}",
];

const UNITS: &[&str] = &[
    "{N} per m",
    "{N} per kg",
    "{N}/m",
    "{N} / m",
    "{N} m",
    "{N}²",
    "{N}^2",
    "{N}-1",
    "{N}⁻¹",
    "{N}^-1",
    "{N}^{-1}",
    "{N}·m",
    "{N} · kg",
    "{T} m{U}",
    "{T} k{U}",
    "{T} µ{U}",
    "{T} minutes",
    "{T} hours",
    "{T} kg",
    "{T} kilogram",
    "{T} milli{U}",
    "{N} per minute",
    "{N}<sup>2</sup>",
    "{N}³",
    "{N} × m",
    "{N} kg m",
    "{N} / 2 m",
    "{T} per {U}",
    "{T} 1/{U}",
    "{T} /{U}",
];

/// Numbers whose unit `{O}` is not next to them, or is after a word.
const SEPARATE_UNIT: &[&str] = &[
    "In {O}: {T}",
    "x / {O} = {T}",
    "x/{O} = {T}",
    "x [{O}] = {T}",
    "x ({O}): {T}",
    "{O}: {T}",
    "in {O} {T}",
    "the value in {O} is {T}",
    "{T}, in {O},",
    "{T} (in {O})",
    "{T} [{O}]",
    "({T}) {O}",
    "{T} — in {O}",
    "{T}, counted in {O},",
    "{T} given in {O}",
    "{T} half {U}",
    "{T} double {U}",
    "{T} inverse {U}",
    "{T} tenths of a {U}",
    "{T} of a {U}",
    "{T} of one {O}",
    "{T} jiffies",
    "{T} steps",
    "{T} €",
    "{T} ♥",
];

/// Sentences that deny their number.
const DENIED: &[&str] = &[
    "It is wrong that it is {N}.",
    "It is not true that it comes to {N}.",
    "It does not come to {N}.",
    "It never is {N}.",
    "It isn't {N}.",
];

const HIDDEN: &[&str] = &[
    "<!-- {N} -->",
    "<template>{N}</template>",
    "<p hidden>{N}</p>",
    "<span style=\"display:none\">{N}</span>",
    "<noscript>{N}</noscript>",
    "Here <span style=\"visibility: hidden\">{N}</span> stands.",
    "Here <!-- {N} --> stands.",
    "Here <span hidden>{N}</span> stands.",
    "[^unused]: {N}",
    "<img alt=\"{N}\" src=\"a.png\">",
    "<div hidden>\n\n{N}\n\n</div>",
    "<script>{N}</script>",
    "<style>{N}</style>",
    "<template><p>{N}</p></template>",
    "Here <span title=\"{N}\">it</span> stands.",
    "[it](a.md \"{N}\")",
    "<span hidden=\"hidden\">{N}</span>",
    "<div style=\"display: none\">\n\n{N}\n\n</div>",
    "Here <template>{N}</template> stands.",
    "Here <SPAN HIDDEN>{N}</SPAN> stands.",
    "[unused]: a.md '{N}'",
    "<input value=\"{N}\">",
    "<span style=\"DISPLAY : NONE\">{N}</span>",
    "<div aria-label=\"{N}\">it</div>",
    "```json\n{\"it\": \"{N}\"}\n```",
    "```python\nit = \"{N}\"\n```",
    "<datalist><option>{N}</option></datalist>",
    "<span style=\"opacity:0\">{N}</span>",
    "<span style=\"font-size:0\">{N}</span>",
];

/// Cells, and the text around a table, that hide the number from a reader.
const HIDING_MARKUP: [(&str, &str); 6] = [
    ("~~{N}~~ 77777", "{B}"),
    ("<del>{N}</del> 77777", "{B}"),
    ("<span hidden>{N}</span> 77777", "{B}"),
    ("{N}", "<!--\n{B}\n-->\n\nNothing is here."),
    ("{N}", "<div hidden>\n\n{B}\n\n</div>\n\nNothing is here."),
    ("{N}", "```python\n{B}\n```\n\nNothing is here."),
];

pub(super) fn wrong(random: &mut Random, measured: &[MeasuredNumber]) -> Vec<Claim> {
    let k = random.pick(measured);
    let Some(n) = number(k) else { return Vec::new() };
    let whole = with_unit(&n.text, k.unit);
    let (size, unit) = (n.size.as_str(), k.unit);
    let fill = |t: &str| {
        t.replace("{N}", &with_unit(size, unit))
            .replace("{T}", size)
            .replace("{U}", unit)
            .trim_end()
            .to_string()
    };
    let mut all = Vec::new();
    // A false number, which differs by at least two units in the last digit.
    let step = (2 + random.below(80)) as f64 * 10f64.powi(-(n.decimals as i32));
    for x in [k.x + step, k.x - step, 10.0 * k.x, 0.1 * k.x] {
        let text = with_unit(&format!("{x:.*}", n.decimals), unit);
        all.push(says("another number", Truth::False, &text, &k.name, format!("It is {text} here.")));
        let cell = format!("{x:.*}", n.decimals);
        all.push(table("another number", Truth::False, &format!("result ({unit})"), &cell, &k.name));
    }
    // The quote is the whole text, or the number in it.
    let mut around = |variant: &str, template: &str, random: &mut Random| {
        let text = fill(template);
        // The quote is searched in the text as a reader sees it.
        let inner = match random.below(3) {
            0 => text.clone(),
            1 => fill("{N}"),
            _ => size.to_string(),
        };
        all.push(says(variant, Truth::False, &inner, &k.name, format!("It is {text} here.")));
        if random.below(2) == 0 {
            all.push(table(variant, Truth::False, &format!("result ({unit})"), &text, &k.name));
        }
    };
    // Some factors do not change a number near 1 (powers, roots, the reciprocal) or near 0, and a sign does not
    // change a negative number.
    // near 0 or 1 are left out.
    let telling = (k.x - 1.0).abs() > 0.2 && k.x.abs() > 0.02;
    if telling && !n.minus {
        for _ in 0..8 {
            around("a factor", random.pick::<&str>(FACTORS), random);
        }
    }
    if !n.minus {
        for _ in 0..4 {
            around("another sign", random.pick::<&str>(SIGNS), random);
        }
    } else {
        all.push(says(
            "another sign",
            Truth::False,
            &fill("{N}"),
            &k.name,
            format!("It is {} here.", fill("{N}")),
        ));
    }
    if !unit.is_empty() && !n.minus {
        for _ in 0..5 {
            let template = random.pick(UNITS);
            let text = fill(template);
            let quote = if random.below(2) == 0 { text.clone() } else { fill("{N}") };
            all.push(says("another unit", Truth::False, &quote, &k.name, format!("It is {text} here.")));
        }
        let other = random.pick(other_units(unit));
        let text = format!("{} {other}", n.text);
        let expr = through_code(random, k);
        all.push(says("another unit", Truth::False, &text, &expr, format!("It is {text} here.")));
        let heading = random
            .pick(&[
                format!("result ({other})"),
                format!("result [{other}]"),
                format!("result / {other}"),
                format!("result in {other}"),
            ])
            .clone();
        let expr = through_code(random, k);
        all.push(table("another unit", Truth::False, &heading, &n.text, &expr));
        let scaled = format!("result (10^{} {unit})", random.pick(&["-3", "3", "2", "-6"]));
        all.push(table("another unit", Truth::False, &scaled, &n.text, &k.name));
        // A percentage of a quantity is not the quantity itself.
        if ["s", "m", "m/s"].contains(&unit) {
            let share = with_unit(&format!("{:.2}", 100.0 * k.x), "%");
            all.push(says("another unit", Truth::False, &share, &k.name, format!("It is {share} here.")));
        }
    }
    if !unit.is_empty() && !n.minus {
        let others: Vec<&str> = other_units(unit).iter().copied().filter(|o| o.len() > 1).collect();
        for template in [random.pick::<&str>(SEPARATE_UNIT), random.pick::<&str>(SEPARATE_UNIT)] {
            let text = fill(template).replace("{O}", random.pick::<&str>(&others));
            all.push(says("a unit apart", Truth::False, size, &k.name, format!("It is {text} here.")));
        }
    }
    let block = fill(random.pick::<&str>(DENIED));
    all.push(says("a number that is denied", Truth::False, &fill("{N}"), &k.name, block));
    // Texts that are hidden from readers.
    for _ in 0..3 {
        let block = random.pick(HIDDEN).replace("{N}", &whole);
        all.push(says("hidden", Truth::False, &whole, &k.name, block));
    }
    let heading = format!("result ({unit})");
    for (cell, whole) in HIDING_MARKUP {
        let cell = cell.replace("{N}", &n.text);
        let mut made = table("hidden", Truth::False, &heading, &cell, &k.name);
        if let Body::Text(_, block) = &mut made.body {
            *block = whole.replace("{B}", block);
        }
        all.push(made);
    }
    // Words that the text denies.
    let so = format!("{} > {}", k.name, k.x - 1.0);
    for block in
        ["It does not hold.", "Here it doesn't hold.", "That will never hold.", "It can no longer hold."]
    {
        all.push(says("words that are denied", Truth::False, "hold", &so, block.into()));
    }
    // Another measure, or the same measure of another run.
    let other = random.pick(measured);
    if (other.x - k.x).abs() > 3.0 * 10f64.powi(-(n.decimals as i32)) {
        all.push(says(
            "another measure or run",
            Truth::False,
            &whole,
            &other.name,
            format!("It is {whole} here."),
        ));
        all.push(table(
            "another measure or run",
            Truth::False,
            &format!("result ({unit})"),
            &n.text,
            &other.name,
        ));
    }
    // Words with a false condition.
    all.push(says(
        "a condition that does not hold",
        Truth::False,
        "it is so",
        &format!("{} > {}", k.name, k.x + 1.0),
        "Now it is so.".into(),
    ));
    all
}

pub(super) fn empty(random: &mut Random, measured: &[MeasuredNumber]) -> Vec<Claim> {
    let k = random.pick(measured);
    let Some(n) = number(k) else { return Vec::new() };
    let whole = with_unit(&n.text, k.unit);
    let run = k.name.split('.').next().unwrap();
    let z = format!("{run}.{}", random.pick(&NEVER).name);
    let (m, x) = (&k.name, &n.text);
    let mut all = Vec::new();
    let list = [
        ("the same whatever is measured", format!("{x} + 0 * {m}")),
        ("the same whatever is measured", format!("{x} + {m} - {m}")),
        ("the same whatever is measured", format!("{m} > 0 ? {x} : {x}")),
        ("a constant", x.clone()),
        ("decided by what is no number", format!("({z} || 0) + {x}")),
        ("decided by what is no number", format!("({z} | 0) + {x}")),
        ("decided by what is no number", format!("{z} > 0 ? 0 : {x}")),
        ("decided by what is no number", format!("[{x}, {z}].filter(v => v > -1e9)[0]")),
        ("decided by what is no number", format!("{x} + Boolean({z})")),
        ("reads the data outside of an aggregate", format!("{x} + 0 * data.time")),
        ("a text for a number", format!("'{x}'")),
    ];
    for _ in 0..4 {
        let (variant, expr) = random.pick(&list);
        all.push(says(variant, Truth::Empty, &whole, expr, format!("It is {whole} here.")));
        let (variant, expr) = random.pick(&list);
        all.push(table(variant, Truth::Empty, &format!("result ({})", k.unit), &n.text, expr));
    }
    for (variant, expr) in [
        ("decided by what is no number", format!("!({z} < 1)")),
        ("decided by what is no number", format!("{z} || true")),
        ("the same whatever is measured", format!("{m} === {m}")),
        ("the same whatever is measured", format!("{m} > 0 || {m} <= 0")),
        ("a constant", "true".to_string()),
    ] {
        all.push(says(variant, Truth::Empty, "it is so", &expr, "Now it is so.".into()));
    }
    all
}
