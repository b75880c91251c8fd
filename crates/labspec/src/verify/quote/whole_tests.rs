//! A quote must match the whole number of the text: with its sign, factor, unit and context. True quantities in many forms
//! are read correctly; quantities that differ in one respect are never right.

use super::read::read_quote;
use super::*;
use crate::lint::{ModelFolder, load_lesson};
use crate::source::SourceFile;
use labspec_bind::units::parse;
use proptest::prelude::*;

/// The state of a quote in a lesson with this text, where the expression gives `computed` in `unit`.
fn state(text: &str, quote: &str, computed: f64, unit: &str) -> QuoteState {
    let lab = serde_json::json!({"xml": "<mujoco/>", "verify": {"says": [[quote, "x"]]}});
    let lesson = load_lesson(
        SourceFile::new("a.md", format!("{text}\n\n```lab simlab\n{lab}\n```\n")),
        &ModelFolder::unknown(),
    );
    let says = &lesson.labs[0].lab.as_ref().unwrap().verify.as_ref().unwrap().says[0];
    let rendered = RenderedText::of_lesson(&lesson);
    let dimension = parse(unit);
    let value = QuoteValue { computed, timestep: &[], start: &[], unit: &|| dimension, counts_turns: false };
    let claim = QuoteClaim { quote: &says.quote, part: says.quote.as_str(), expr: &says.exprs[0] };
    let places = places_of_quote(&says.quote, None, &rendered);
    let mut findings = Vec::new();
    let outcome = check_quote(&claim, &read_quote(quote), places, &value, &rendered, &mut findings);
    assert_eq!(
        outcome.state == QuoteState::Right,
        findings.iter().all(|f| !f.is_error() && f.code != "quote-not-found"),
        "{text}: {findings:?}"
    );
    outcome.state
}

const RIGHT: QuoteState = QuoteState::Right;

/// Numbers other than half a second that contain the characters `0.5`.
const OTHERS: [&str; 135] = [
    "minus 0.5 s",
    "- 0.5 s",
    "-0.5 s",
    "\u{2212}0.5 s",
    "\u{2212} 0.5 s",
    "–0.5 s",
    "= – 0.5 s",
    "(−)0.5 s",
    "negative 0.5 s",
    "0.5 s / m",
    "0.5 s/m",
    "0.5 s per m",
    "0.5 s m",
    "0.5 s·m",
    "0.5 s-1",
    "0.5 s^-1",
    "0.5 s⁻¹",
    "0.5 s²",
    "0.5 s squared",
    "0.5 s per lap",
    "0.5 s/lap",
    "2·0.5 s",
    "2 × 0.5 s",
    "2 * 0.5 s",
    "√0.5 s",
    "√(0.5 s)",
    "√ 0.5 s",
    "1+0.5 s",
    "1 + 0.5 s",
    "1/0.5 s",
    "1 / 0.5 s",
    "0.5/2 s",
    "0.5 / 2 s",
    "3 ½ s or 0.5² s",
    "0.5² s",
    "0.5^2 s",
    "10^0.5 s",
    "x^0.5 s",
    "x_0.5 s",
    "(0.5 s)²",
    "2(0.5 s)",
    "sin(0.5 s)",
    "log 0.5 s",
    "ln 0.5 s",
    "half of 0.5 s",
    "twice 0.5 s",
    "three times 0.5 s",
    "a third of 0.5 s",
    "the square root of 0.5 s",
    "0.5 thousand s",
    "0.5 million s",
    "0.5 e3 s",
    "0.5e3 s",
    "0.5 E3 s",
    "0.5 × 10³ s",
    "0.5·10^3 s",
    "0.5 x 10^3 s",
    "0.5 10^3 s",
    "0.5 ms",
    "0.5 μs",
    "0.5 ks",
    "0.5 k s",
    "0.5 %",
    "0.5 ‰",
    "0.5 percent",
    "0.5 kg",
    "0.5 min",
    "0.5 h",
    "0.5 minutes",
    "0.5 hours",
    "0.5 metres",
    "0.5°",
    "0.5 °C",
    "0.5 ft",
    "<0.5 s",
    "> 0.5 s",
    "≤ 0.5 s",
    "less than 0.5 s",
    "at most 0.5 s",
    "over 0.5 s",
    "not 0.5 s",
    "0.5 s ± 0.3 s",
    "0.5 ± 0.3 s",
    "± 0.5 s",
    "0.3–0.5 s",
    "0.3 to 0.5 s",
    "0.5 to 0.7 s",
    "between 0.3 and 0.5 s",
    "0.5 s or more",
    "0.5 s + 0.1 s",
    "0.5 - 0.1 s",
    "0.51 s",
    "10.5 s",
    "0.5.1 s",
    "0.5(3) s",
    "0.5π s",
    "0.5 π s",
    "π·0.5 s",
    "v0.5 s",
    "1,0.5 s",
    "0.5x s",
    "3:0.5 s",
    "$\\frac{0.5}{2}$ s",
    "$\\frac{1}{0.5}$ s",
    "$\\sqrt{0.5}$ s",
    "$e^{0.5}$ s",
    "$\\log 0.5$ s",
    "负0.5秒",
    "0.5秒以上",
    "每秒0.5米",
    "1 min 0.5 s",
    "2 h 3 min 0.5 s",
    "three 0.5 s",
    "3x 0.5 s",
    "tenfold 0.5 s",
    "0.5 s times 10",
    "0.5 s plus 10 s",
    "0.5 s minus 10 s",
    "0.5 s divided by 10",
    "zehnmal 0.5 s",
    "zweimal 0.5 s",
    "das Doppelte von 0.5 s",
    "die Hälfte von 0.5 s",
    "ein Zehntel von 0.5 s",
    "0.5 Tage",
    "0.5 Std.",
    "0.5 Zoll",
    "0.5 Jahre",
    "0.5 Wochen",
    "0.5 Monate",
    "0.5 Fuß",
    "0.5 Tonnen",
    "0.5 jours",
    "0.5 Steps",
    "0.5 steps",
];

#[test]
fn other_numbers_are_not_right() {
    let mut right = Vec::new();
    for text in OTHERS {
        for quote in ["0.5 s", "0.5", "0.5秒", "0.5 s."] {
            for sentence in [format!("It takes {text}."), format!("It takes {text} here"), text.to_string()] {
                // Markdown reads it as a list or a quotation.
                let marked = sentence.starts_with("- ") || sentence.starts_with("> ");
                if !marked && state(&sentence, quote, 0.5, "s") == RIGHT {
                    right.push(format!("{quote} in {sentence}"));
                }
            }
        }
    }
    assert!(right.is_empty(), "{} are right: {right:#?}", right.len());
}

/// Words and quantities beside half a second that do not change it.
#[test]
fn the_neighbours_of_a_number_may_be_harmless() {
    for text in ["at 1 m 0.5 s pass", "0.5 s plus tard", "the normal 0.5 s"] {
        assert_eq!(state(text, "0.5 s", 0.5, "s"), RIGHT, "{text}");
    }
}

/// Half a second.
#[test]
fn the_same_number_is_right() {
    for text in [
        "0.5 s",
        "0.5 s.",
        "(0.5 s)",
        "t = 0.5 s",
        "about 0.5 s",
        "~0.5 s",
        "≈ 0.5 s",
        "+0.5 s",
        "after 0.5 s, then",
        "0.5 s — and",
        "t: 0.5 s",
        "$t = 0.5$ s",
        "$\\mathrm{0.5\\,s}$",
        "**0.5** s",
        "0.5&nbsp;s",
        "\"0.5 s\"",
        "0.5 s (half a second)",
        "from 0.3 s to 0.5 s",
        "$\\SI{0.5}{s}$",
        "$\\SI{0.5}{\\second}$",
        "$\\qty{0.5}{s}$",
        "0.5 s = 500 ms",
        "0.3 s → 0.5 s",
        "It lasts 0.5 s!",
        "x/y: 0.5 s",
        "| t |\n|---|\n| 0.5 s |",
    ] {
        for quote in ["0.5 s", "0.5"] {
            assert_eq!(state(text, quote, 0.5, "s"), RIGHT, "{quote} in {text}");
        }
    }
    for (text, quote) in [
        ("下落需要0.5秒。", "0.5秒"),
        ("下落需要0.5秒。", "0.5"),
        ("落下には０．５秒かかる", "0.5秒"),
        ("落下には0.5秒かかる", "0.5"),
        ("大约0.5 秒", "0.5 秒"),
        ("a 0.5-second fall", "0.5"),
        ("0.5 seconds", "0.5 seconds"),
        ("0.5 Sekunden", "0.5"),
        ("0.5 sec", "0.5"),
        ("$\\num{0.5}$ s", "0.5 s"),
        ("| t (s) |\n|---|\n| 0.5 |", "0.5"),
        ("0,5 s", "0,5 s"),
        ("½ s", "½ s"),
        ("5e-1 s", "5e-1 s"),
        ("500 thousandths s", "500 thousandths s"),
    ] {
        assert_eq!(state(text, quote, 0.5, "s"), RIGHT, "{quote} in {text}");
    }
    // The column states the unit.
    for head in ["t (ms)", "t [ms]", "t / ms", "t in ms", "t, ms"] {
        assert_ne!(state(&format!("| {head} |\n|---|\n| 0.5 |"), "0.5", 0.5, "s"), RIGHT, "{head}");
    }
    // Minutes and degrees are converted.
    assert_eq!(state("It takes 2.0 min.", "2.0 min", 120.0, "s"), RIGHT);
    assert_ne!(state("It takes 2.0 min.", "2.0 min", 2.0, "s"), RIGHT);
    assert_eq!(state("It turns by 45.0°.", "45.0°", std::f64::consts::FRAC_PI_4, "rad"), RIGHT);
    assert_eq!(state("It is 0.5 s here, and 0.5 ms there.", "0.5", 0.5, "s"), RIGHT);
}

/// Forms of one number, in which the quote is right.
#[test]
fn quantities_in_formulas_brackets_and_words_are_right() {
    for (text, quote, computed, unit) in [
        (
            "$$\\begin{aligned} v &= \\sqrt{2gh} \\\\ &= 3.96\\,\\mathrm{m/s}\\end{aligned}$$",
            "3.96 m/s",
            3.963,
            "m/s",
        ),
        ("$$v = 3.96\\,\\frac{\\mathrm{m}}{\\mathrm{s}}$$", "3.96", 3.963, "m/s"),
        ("$$v = 3.96\\,\\frac{\\mathrm{m}}{\\mathrm{s}}$$", "3.96 m/s", 3.963, "m/s"),
        ("It lands at (3.96 ± 0.01) m/s.", "(3.96 ± 0.01) m/s", 3.963, "m/s"),
        ("It lands at (3.96 ± 0.01) m/s.", "3.96 ± 0.01", 3.963, "m/s"),
        ("It lands fast (3.96 ± 0.01 m/s).", "3.96 ± 0.01 m/s", 3.963, "m/s"),
        ("It lands at (3.9 to 4.0) m/s.", "(3.9 to 4.0) m/s", 3.963, "m/s"),
        ("It lands at 3.96 metres a second.", "3.96 metres a second", 3.963, "m/s"),
        (
            "It falls at 9.81 metres per second per second.",
            "9.81 metres per second per second",
            9.81,
            "m/s^2",
        ),
        ("Speed on landing – 3.96 m/s.", "3.96 m/s", 3.963, "m/s"),
        ("The times are 2.45 to 1.", "2.45 to 1", 2.453, "1"),
        ("The times are 2.45 : 1.", "2.45 : 1", 2.453, "1"),
        ("The times are 2.45:1.", "2.45:1", 2.453, "1"),
        ("Er landet mit zwischen 3 und 5 m/s.", "zwischen 3 und 5 m/s", 3.963, "m/s"),
        ("Elle arrive entre 3 et 5 m/s.", "entre 3 et 5 m/s", 3.963, "m/s"),
        ("Elle arrive avec de 3 à 5 m/s.", "de 3 à 5 m/s", 3.963, "m/s"),
        ("Llega entre 3 y 5 m/s.", "entre 3 y 5 m/s", 3.963, "m/s"),
        ("Arriva tra 3 e 5 m/s.", "tra 3 e 5 m/s", 3.963, "m/s"),
        ("Elle passe de 2,31 à 3,73 N m", "2,31", 2.31, "N m"),
        ("zwischen 0,4 J und 0,5 J", "0,5 J", 0.5, "J"),
        ("It lands at no less than 3 m/s.", "no less than 3 m/s", 3.963, "m/s"),
        ("It takes 2.45 times the time on the earth.", "2.45", 2.453, "1"),
        ("It bounces 3 times.", "3", 3.0, "1"),
        ("It swings 0.70 times per second.", "0.70", 0.704, "1/s"),
        ("1.65 m instead of 1.42 m", "1.42 m", 1.42, "m"),
        ("above the 0.5 m line", "0.5 m", 0.5, "m"),
        ("less than the 0.5 m that are needed", "0.5 m", 0.5, "m"),
        ("$v = \\sqrt{2 \\cdot 9.81 \\cdot 0.8} = 3.96$ m/s", "3.96", 3.963, "m/s"),
    ] {
        assert_eq!(state(text, quote, computed, unit), RIGHT, "{quote} in {text}");
    }
}

/// Bounds, negations, comparisons and other quantities, of which none states the value.
#[test]
fn words_that_state_something_else_are_not_right() {
    for (text, quote) in [
        ("It lands at no less than 4 m/s.", "no less than 4 m/s"),
        ("It lands at no less than 3.96 m/s.", "3.96 m/s"),
        ("It lands at a speed outside 3 to 5 m/s.", "outside 3 to 5 m/s"),
        ("It lands at a speed outside 3 to 5 m/s.", "3 to 5 m/s"),
        ("It surpasses 3.96 m/s by far.", "3.96 m/s"),
        ("It surpasses even 3.96 m/s.", "3.96 m/s"),
        ("It is more than about 3.96 m/s.", "3.96 m/s"),
        ("It falls short of 3.96 m/s.", "3.96 m/s"),
        ("It never reaches 3.96 m/s.", "3.96 m/s"),
        ("It is half as fast as 3.96 m/s.", "3.96 m/s"),
        ("It is heavier than 3.96 m/s.", "3.96 m/s"),
        ("Der Ball ist niemals 3,96 m/s schnell.", "3,96 m/s"),
        ("Er erreicht keinesfalls 3,96 m/s.", "3,96 m/s"),
        ("Er übersteigt 3,96 m/s.", "3,96 m/s"),
        ("Er ist halb so schnell wie 3,96 m/s.", "3,96 m/s"),
        ("La bola nunca alcanza 3,96 m/s.", "3,96 m/s"),
        ("La bola supera 3,96 m/s.", "3,96 m/s"),
        ("Elle n'atteint jamais 3,96 m/s.", "3,96 m/s"),
        ("Elle dépasse 3,96 m/s.", "3,96 m/s"),
        ("Elle est plus rapide que 3,96 m/s.", "3,96 m/s"),
        ("3.96 m/s is wrong.", "3.96 m/s"),
        ("3.96 m/s cannot be right.", "3.96 m/s"),
        ("3.96 m/s is never reached.", "3.96 m/s"),
        ("3,96 m/s wird nie erreicht.", "3,96 m/s"),
        ("It moves at 3.96 times the speed of sound.", "3.96"),
        ("It moves at 3.96 times the speed of sound.", "3.96 times the speed of sound"),
        ("It moves at 3.96 body lengths per second.", "3.96"),
        ("It moves at 3.96 body lengths per second.", "3.96 body lengths per second"),
        ("zwischen 4 und 50 m/s", "zwischen 4 und 50 m/s"),
        ("entre 4 et 50 m/s", "entre 4 et 50 m/s"),
        ("de 4 à 50 m/s", "de 4 à 50 m/s"),
        ("It lands at 3.96 to 1.", "3.96 to 1"),
        ("It lies at x = height – 3.96 m/s.", "3.96 m/s"),
        ("It is 5 m/s – 3.96 m/s.", "3.96 m/s"),
        ("It moves at (3.96 ± 0.01)² m/s.", "3.96 ± 0.01"),
        ("It never quite gets up to 3.96 m/s.", "3.96 m/s"),
        ("Er verfehlt die 3,96 m/s.", "3,96 m/s"),
        ("La palla supera i 3,96 m/s.", "3,96 m/s"),
        ("It lands at 3.96 m/s at the latest.", "3.96 m/s"),
        ("It lands at 3.96 body lengths a second.", "3.96"),
        ("It lands at Mach 3.96.", "3.96"),
        ("Er landet mit 3,96-facher Schallgeschwindigkeit.", "3,96"),
        ("$v = \\sqrt{2 \\cdot 9.81 \\cdot 3.5} = 3.96$ m/s", "3.96"),
    ] {
        assert_ne!(state(text, quote, 3.963, "m/s"), RIGHT, "{quote} in {text}");
    }
}

/// Units, each with the corresponding unit of the expression.
const UNITS: [(&str, &str); 9] = [
    ("s", "s"),
    ("ms", "ms"),
    ("m", "m"),
    ("mm", "mm"),
    ("kg", "kg"),
    ("m/s", "m/s"),
    ("N m", "N m"),
    ("m/s^2", "m/s^2"),
    ("rad/s", "rad/s"),
];

/// Text around a quantity that does not change its meaning.
const PLAIN: [(&str, &str); 9] = [
    ("It takes ", "."),
    ("(", ")"),
    ("x = ", ", then"),
    ("about ", " here"),
    ("≈ ", ""),
    ("is **", "** there"),
    ("`", "`"),
    ("$t = ", "$"),
    ("结果是", "。"),
];

/// Text around a quantity that changes its meaning.
const CHANGED: [(&str, &str); 25] = [
    ("minus ", ""),
    ("- ", ""),
    ("-", ""),
    ("\u{2212}", ""),
    ("2·", ""),
    ("2 × ", ""),
    ("√", ""),
    ("1+", ""),
    ("1/", ""),
    ("10^", ""),
    ("1", ""),
    ("half of ", ""),
    ("twice ", ""),
    ("< ", ""),
    ("more than ", ""),
    ("log ", ""),
    ("", "²"),
    ("", "/K"),
    ("", " per A"),
    ("", "·kg"),
    ("", " ± 0.1"),
    ("(", ")²"),
    ("", " · 2"),
    ("", " or more"),
    ("ten thousand ", ""),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn forms_are_read_and_changes_are_not_right(
        n in 1u32..99999, decimals in 0usize..4, unit in 0..UNITS.len(), around in 0..PLAIN.len(), change in 0..CHANGED.len(),
        form in 0usize..5, other in 0..UNITS.len(), alone in any::<bool>(),
    ) {
        let value = f64::from(n) / 10f64.powi(decimals as i32);
        let digits = format!("{value:.decimals$}");
        let (unit, dimension) = UNITS[unit];
        let printed = match form {
            0 => format!("{digits} {unit}"),
            1 => format!("{digits}\u{a0}{unit}"),
            2 => format!("{digits}&nbsp;{unit}"),
            3 => format!("${digits}\\,\\mathrm{{{unit}}}$"),
            _ => format!("$\\SI{{{digits}}}{{{unit}}}$"),
        };
        let (before, after) = PLAIN[around];
        // Code is displayed verbatim.
        prop_assume!(!(before == "`" || before.contains('$')) || form == 0);
        let quote = if alone { digits.clone() } else { format!("{digits} {unit}") };
        let text = format!("{before}{printed}{after}");
        prop_assert_eq!(state(&text, &quote, value, dimension), RIGHT, "{} in {}", quote, text);

        // A number literal that is a factor of the expression may have a dimension. The unit after a number that is quoted
        // alone is then uncertain.
        let exact = parse(dimension).is_some_and(|d| d.is_exact());
        prop_assume!(exact || !alone);
        let (front, back) = CHANGED[change];
        let changed = format!("It takes {front}{digits} {unit}{back} here.");
        prop_assert_ne!(state(&changed, &quote, value, dimension), RIGHT, "{} in {}", quote, changed);
        // Another unit, or another power of ten.
        let (wrong, _) = UNITS[other];
        if wrong != unit {
            let changed = format!("It takes {digits} {wrong} here.");
            prop_assert_ne!(state(&changed, &quote, value, dimension), RIGHT, "{} in {}", quote, changed);
        }
        for factor in ["thousand ", "%", "e3 ", "×10^3 ", "million ", "k "] {
            let changed = format!("It takes {digits} {factor}{unit} here.");
            prop_assert_ne!(state(&changed, &quote, value, dimension), RIGHT, "{} in {}", quote, changed);
        }
    }
}
