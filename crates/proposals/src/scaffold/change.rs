//! The two runs that a question compares: the control that it names, and its value before and after the change.

use super::factors::{percent, times};
use super::quantity;
use super::words::{contains_any, contains_words};
use crate::trace::{TraceRun, named_value, si, split_words, trials};
use labspec::bind::{given_by, scalar};
use labspec::json::{Number, Scalar};
use labspec::run::settings;
use labspec::spec::{Control, ControlKind, Lab};
use labspec::verify::Stated;
use labspec_expr::Value;
use labspec_expr::dimension::Measure;
use std::cmp::Ordering;

/// The length of a run after a button is pressed, s.
const RUN_AFTER_PRESS: f64 = 10.0;

/// Words for more and less of a quantity, without a factor.
const UP: [&str; 17] = [
    "higher",
    "larger",
    "greater",
    "bigger",
    "more",
    "increase",
    "increases",
    "raise",
    "raises",
    "heavier",
    "stronger",
    "longer",
    "stiffer",
    "add",
    "raised",
    "raising",
    "increasing",
];
const DOWN: [&str; 16] = [
    "lower",
    "smaller",
    "less",
    "fewer",
    "decrease",
    "decreases",
    "reduce",
    "reduces",
    "lighter",
    "weaker",
    "shorter",
    "softer",
    "remove",
    "lowering",
    "reducing",
    "decreasing",
];

/// Words of questions for the quantities of controls: part of a label or its unit, and the words.
const SYNONYMS: [(&str, &str, &[&str]); 7] = [
    ("mass", "kg", &["heavy", "heavier", "lighter", "weighs", "weight"]),
    ("length", "", &["long", "longer", "shorter"]),
    ("height", "", &["high", "higher", "lower"]),
    ("friction", "", &["slippery", "rough", "rougher", "smoother"]),
    ("stiffness", "N/m", &["stiff", "stiffer", "softer"]),
    ("speed", "m/s", &["fast", "faster", "slower"]),
    ("gravity", "m/s^2", &["moon", "mars", "jupiter"]),
];

/// The gravity of other worlds, m/s² (NASA's planetary fact sheet).
const WORLDS: [(&str, f64); 3] = [("moon", 1.62), ("mars", 3.73), ("jupiter", 23.12)];

/// Words of labels that do not name a quantity.
const FILLERS: [&str; 9] = ["the", "and", "for", "with", "from", "start", "initial", "value", "set"];

/// The two runs that a question compares.
pub(super) struct Comparison {
    pub(super) runs: [TraceRun; 2],
}

/// A control that a question names by words or by values, with the places of the values in the question.
struct Mention<'l> {
    control: &'l Control,
    score: usize,
    values: Vec<(usize, Scalar)>,
}

impl Mention<'_> {
    /// The only value that the question gives to the control, if the lab does not start with it.
    fn single(&self) -> Option<&Scalar> {
        match self.values.as_slice() {
            [(_, value)] if scalar(value) != scalar(&start(self.control)) => Some(value),
            _ => None,
        }
    }
}

/// The runs of a lab that a question compares.
///
/// # Errors
/// The reason why they are not known.
pub(super) fn comparison(question: &str, lab: &Lab, stated: &[Stated]) -> Result<Comparison, String> {
    let base = trials(lab, &[]).into_iter().next().ok_or("the lab cannot run")?;
    let mut runs = runs(question, lab, stated, &base)?;
    for run in &mut runs {
        press(question, lab, run);
    }
    Ok(Comparison { runs })
}

/// The run with the settings that a question states; `free` is a control that has no setting in it.
pub(super) fn stated_run(
    question: &str,
    lab: &Lab,
    stated: &[Stated],
    free: Option<&Control>,
) -> Option<TraceRun> {
    let base = trials(lab, &[]).into_iter().next()?;
    let mentions = mentions(question, lab, stated);
    let is_free = |m: &&Mention<'_>| free.is_none_or(|free| free.label.as_str() != m.control.label.as_str());
    let settings = mentions.iter().filter(is_free).filter_map(|m| Some((m.control, m.single()?.clone())));
    let mut run = settings.fold(base, |run, (control, value)| with(&run, control, value));
    press(question, lab, &mut run);
    Some(run)
}

/// Whether a question gives several values to a control, so that it compares runs.
pub(super) fn compares(question: &str, lab: &Lab, stated: &[Stated]) -> bool {
    mentions(question, lab, stated).iter().any(|m| m.values.len() > 1)
}

/// The value of a control for a number, if it is one of its values.
pub(super) fn settable(control: &Control, value: f64) -> Option<Scalar> {
    let is_slider = matches!(control.kind, ControlKind::Slider { .. });
    (is_slider && settings::value(control, &Value::Number(value)).is_ok()).then(|| number(value))
}

/// A run of the lab with a further setting.
pub(super) fn with(base: &TraceRun, control: &Control, value: Scalar) -> TraceRun {
    let label = control.label.value.clone();
    let text = scalar(&value);
    let is_start = text == scalar(&start(control));
    let is_base = base.set.is_empty();
    let words = match (is_base, is_start) {
        (true, _) => format!("with \"{label}\" at {text}"),
        (false, _) => format!("{} and \"{label}\" at {text}", base.words),
    };
    let name = match is_base {
        true => named_value(control, &value),
        false => format!("{}_{}", base.name, named_value(control, &value)),
    };
    let mut set = base.set.clone();
    if !is_start {
        set.push((label, value));
    }
    TraceRun { words, name, set, ..base.clone() }
}

/// How many words of a text name a control.
pub(super) fn named(text: &str, control: &Control) -> usize {
    score(text, control)
}

/// Presses the buttons that the question names.
fn press(question: &str, lab: &Lab, run: &mut TraceRun) {
    let buttons = lab.controls.iter().filter(|c| matches!(c.kind, ControlKind::Button { .. }));
    let labels = buttons.map(|c| c.label.value.clone());
    run.press = labels.filter(|label| contains_words(question, &label.to_lowercase())).collect();
    if !run.press.is_empty() {
        // The process that a button starts takes some time.
        run.until = run.until.or(lab.stop_at.is_none().then_some(RUN_AFTER_PRESS));
    }
}

/// The controls that a question names by words or by values.
fn mentions<'l>(question: &str, lab: &'l Lab, stated: &[Stated]) -> Vec<Mention<'l>> {
    let sliders: Vec<&Control> = lab.controls.iter().collect();
    let change = change_part(question);
    let is_named = lab.controls.iter().any(|c| score(change, c) > 0);
    let text = if is_named { change } else { question };
    let one = |control: &'l Control| {
        let mut values = match &control.kind {
            ControlKind::Select { .. } => options(question, control),
            _ => numbers(question, control, &sliders, stated),
        };
        values.dedup_by(|a, b| scalar(&a.1) == scalar(&b.1));
        Mention { control, score: score(text, control), values }
    };
    let all = lab.controls.iter().filter(|c| !matches!(c.kind, ControlKind::Button { .. })).map(one);
    all.filter(|m| m.score > 0 || !m.values.is_empty()).collect()
}

/// The part of a question that states what changes: what comes before the part that asks, otherwise the whole.
fn change_part(question: &str) -> &str {
    let asking = quantity::asking_part(question);
    let before = question.trim_end().strip_suffix(asking).unwrap_or("").trim();
    if before.is_empty() { question } else { before }
}

fn runs(question: &str, lab: &Lab, stated: &[Stated], base: &TraceRun) -> Result<[TraceRun; 2], String> {
    let mentions = mentions(question, lab, stated);
    let several: Vec<&Mention<'_>> = mentions.iter().filter(|m| m.values.len() > 1).collect();
    let best = mentions.iter().map(|m| m.score).max().unwrap_or(0);
    let by_words: Vec<&Mention<'_>> = match best {
        0 => mentions.iter().filter(|m| m.single().is_some()).collect(),
        _ => mentions.iter().filter(|m| m.score == best).collect(),
    };
    let named = if several.is_empty() { by_words } else { several };
    match named.as_slice() {
        [] => timesteps(question, lab, stated, base),
        [changed] if changed.values.len() < 2 && states_other_change(question, changed, stated) => {
            timesteps(question, lab, stated, base)
                .map_err(|_| "no control of the lab makes the change that the question states".to_string())
        }
        [changed] => {
            let [before, after] = values(question, changed)?;
            let others = mentions.iter().filter(|m| !std::ptr::eq(m.control, changed.control));
            let settings = others.filter_map(|m| Some((m.control, m.single()?.clone())));
            let base = settings.fold(base.clone(), |run, (control, value)| with(&run, control, value));
            Ok([with(&base, changed.control, before), with(&base, changed.control, after)])
        }
        several => {
            let labels: Vec<String> =
                several.iter().map(|m| format!("\"{}\"", m.control.label.as_str())).collect();
            Err(format!("it is unclear which control the question is about: {}", labels.join(" or ")))
        }
    }
}

/// Whether a question states a change between two numbers, "from 30 N to 60 N", that are no values of this control.
fn states_other_change(question: &str, changed: &Mention<'_>, stated: &[Stated]) -> bool {
    let is_change = |pair: &[Stated]| {
        let [first, second] = pair else { return false };
        let before = question.get(..first.offset.min(question.len())).unwrap_or("").trim_end();
        let between = question.get(first.offset..second.offset).unwrap_or("");
        let joins = before.ends_with("from") && contains_words(between, "to")
            || contains_words(between, "instead of");
        joins && first.dimension.agrees(&second.dimension)
    };
    let owns = |s: &Stated| changed.values.iter().any(|(offset, _)| *offset == s.offset);
    stated.windows(2).any(|pair| is_change(pair) && !pair.iter().all(owns))
}

/// How many words of a question name a control: those of its label, then those for its quantity.
fn score(question: &str, control: &Control) -> usize {
    if matches!(control.kind, ControlKind::Button { .. }) {
        return 0;
    }
    let label = control.label.as_str().to_lowercase();
    let name = label.split('(').next().unwrap_or(&label).trim();
    let words = split_words(name).filter(|word| !FILLERS.contains(&word.as_str()));
    let of_label = words.filter(|word| contains_words(question, word)).count();
    let symbol = name.chars().count() <= 2 && contains_words(question, name);
    let unit = match &control.kind {
        ControlKind::Slider { unit: Some(unit), .. } => unit.as_str(),
        _ => "",
    };
    let means = |(part, has_unit, words): &&(&str, &str, &[&str])| {
        let is_quantity =
            label.contains(part) || !has_unit.is_empty() && unit.replace('²', "^2") == *has_unit;
        is_quantity && words.iter().any(|word| contains_words(question, word))
    };
    let synonym = SYNONYMS.iter().any(|row| means(&row));
    let options = options(question, control).len();
    2 * of_label + 2 * usize::from(symbol) + usize::from(synonym) + options
}

/// The options of a select that a question names, in its order.
fn options(question: &str, control: &Control) -> Vec<(usize, Scalar)> {
    let ControlKind::Select { options, .. } = &control.kind else { return Vec::new() };
    let label = control.label.value.to_lowercase();
    let mut all: Vec<(usize, Scalar)> = Vec::new();
    for choice in options {
        let text = choice.text.value.to_lowercase();
        // "10 (as modelled)" is the option 10. A number alone says nothing.
        let text = text.split('(').next().unwrap_or(&text).trim();
        let is_number = text.parse::<f64>().is_ok();
        if !text.is_empty()
            && contains_words(question, text)
            && (!is_number || contains_words(question, &label))
            && let Some(offset) = question.find(text)
        {
            all.push((offset, choice.value.clone()));
        }
    }
    all.sort_by_key(|(offset, _)| *offset);
    all
}

/// The values of a control before and after the change.
fn values(question: &str, changed: &Mention<'_>) -> Result<[Scalar; 2], String> {
    let control = changed.control;
    let label = control.label.as_str();
    match changed.values.as_slice() {
        [] | [_] => match changed.single() {
            Some(value) => Ok([start(control), value.clone()]),
            None => changed_by_words(question, control).map(|after| [start(control), after]),
        },
        [(first_offset, first), (next, second)] => {
            let between = question.get(*first_offset..*next).unwrap_or("");
            let is_reversed = contains_any(between, &["instead of", "than", "compared"]);
            Ok(if is_reversed { [second.clone(), first.clone()] } else { [first.clone(), second.clone()] })
        }
        _ => Err(format!("the question names several values of \"{label}\"")),
    }
}

fn start(control: &Control) -> Scalar {
    match &control.kind {
        ControlKind::Slider { value, .. } => Scalar::Number(value.clone()),
        ControlKind::Select { value, .. } => value.clone(),
        ControlKind::Button { .. } => number(0.0),
    }
}

fn number(value: f64) -> Scalar {
    Scalar::Number(Number { value, span: 0..0 })
}

/// The values of a slider that a question states, with their places in it. A number that several sliders can have belongs to the
/// one that the question names.
fn numbers(question: &str, control: &Control, all: &[&Control], stated: &[Stated]) -> Vec<(usize, Scalar)> {
    let Measure::Dimension(_) = given_by(control) else { return bare_numbers(question, control) };
    let reached = |control: &Control, s: &Stated| {
        let Measure::Dimension(unit) = given_by(control) else { return None };
        let x: f64 = format!("{:.12e}", si(s) * unit.factor).parse().unwrap_or(f64::NAN);
        settable(control, x).filter(|_| s.dimension.agrees(&unit))
    };
    let is_owner = |s: &Stated| {
        let score_here = score(question, control);
        // A time is more often a time than a setting.
        if score_here == 0 && s.unit.ends_with('s') && !s.unit.contains('/') {
            return false;
        }
        let other = |c: &&&Control| c.label.as_str() != control.label.as_str() && reached(c, s).is_some();
        let rivals: Vec<&Control> = all.iter().filter(other).copied().collect();
        rivals.iter().all(|rival| match score_here.cmp(&score(question, rival)) {
            Ordering::Greater => true,
            Ordering::Less => false,
            // "5 kg on the left and 1 kg on the right": the label that is nearer.
            Ordering::Equal => {
                distance(question, s.offset, control, rival) < distance(question, s.offset, rival, control)
            }
        })
    };
    let owned = stated.iter().filter(|s| is_owner(s));
    owned.filter_map(|s| Some((s.offset.min(question.len()), reached(control, s)?))).collect()
}

/// The distance of a place in a question from the nearest word of a label that another label does not have.
fn distance(question: &str, offset: usize, control: &Control, other: &Control) -> usize {
    let words = |c: &Control| -> Vec<String> { split_words(&c.label.as_str().to_lowercase()).collect() };
    let others = words(other);
    let distinct = words(control).into_iter().filter(|w| !others.contains(w) && contains_words(question, w));
    let places = distinct.flat_map(|w| {
        question.match_indices(w.as_str()).map(|(i, _)| i.abs_diff(offset)).collect::<Vec<_>>()
    });
    places.min().unwrap_or(usize::MAX)
}

/// The numbers after the label of a slider without a unit: `impratio from 10 to 1`, `a gear ratio of 4`; other words may stand
/// before `from`: `the damping ratio of the contact is raised from 0.2 to 1`.
fn bare_numbers(question: &str, control: &Control) -> Vec<(usize, Scalar)> {
    let label = control.label.as_str().to_lowercase();
    let name = label.split('(').next().unwrap_or(&label).trim();
    let found = question.find(name).filter(|_| !name.is_empty() && contains_words(question, name));
    let Some(name_end) = found.map(|name_end| name_end + name.len()) else { return Vec::new() };
    let rest = question.get(name_end..).unwrap_or("");
    let sentence = rest.find(". ").map_or(rest, |end| rest.get(..end).unwrap_or(rest));
    let from = sentence.find(" from ").unwrap_or(0);
    let mut all = Vec::new();
    let mut place = name_end + from;
    for word in sentence.get(from..).unwrap_or("").split_whitespace() {
        let word = word.trim_end_matches([',', '.', '?', ';']);
        match word.parse::<f64>() {
            Ok(x) => match settable(control, x) {
                Some(value) => all.push((place, value)),
                None => break,
            },
            Err(_) if ["from", "to", "of", "at", "is", "=", "by", "and", "instead"].contains(&word) => {}
            Err(_) => break,
        }
        place += word.len() + 1;
    }
    all
}

/// The value of a slider after a change without a stated value: a factor, or the end of its range.
///
/// # Errors
/// The question states no change, or the slider cannot make it.
fn changed_by_words(question: &str, control: &Control) -> Result<Scalar, String> {
    let label = control.label.as_str();
    let ControlKind::Slider { value: start, min, max, .. } = &control.kind else {
        return Err(format!("the question does not state how \"{label}\" changes"));
    };
    let world = WORLDS.iter().find(|(world, _)| contains_words(question, world));
    if let Some((_, gravity)) = world.filter(|_| label.to_lowercase().contains("gravity")) {
        let signs = [*gravity, -gravity];
        let reached = signs.into_iter().find(|x| settings::value(control, &Value::Number(*x)).is_ok());
        return reached.map(number).ok_or_else(|| format!("\"{label}\" cannot be set to {gravity}"));
    }
    let change = change_part(question);
    if let Some(factor) = factor(change) {
        let target = start.value * factor;
        let step = control.step().unwrap_or(0.0);
        let x = if step > 0.0 { min.value + ((target - min.value) / step).round() * step } else { target };
        let x: f64 = format!("{x:.12}").parse().unwrap_or(x);
        let reaches =
            settings::value(control, &Value::Number(x)).is_ok() && (x - target).abs() <= 0.05 * target.abs();
        return match reaches && x != start.value {
            true => Ok(number(x)),
            false => Err(format!(
                "\"{label}\" cannot change by a factor of {factor}: it goes from {} to {}",
                min.value, max.value
            )),
        };
    }
    let [up, down] = [&UP[..], &DOWN].map(|words| contains_any(change, words));
    let end = match (up, down) {
        (true, false) => max.value,
        (false, true) => min.value,
        _ => return Err(format!("the question does not state how \"{label}\" changes")),
    };
    if end == start.value {
        return Err(format!("\"{label}\" is already at this end of its range, {end}"));
    }
    Ok(number(end))
}

/// Two timesteps that a question names, for a lab without a control for it.
fn timesteps(question: &str, lab: &Lab, stated: &[Stated], base: &TraceRun) -> Result<[TraceRun; 2], String> {
    let none = || "the question names no control of the lab".to_string();
    if !["timestep", "time step"].iter().any(|w| contains_words(question, w)) {
        return Err(none());
    }
    let runs: Vec<TraceRun> = trials(lab, stated).into_iter().filter(|run| run.timestep.is_some()).collect();
    match runs.as_slice() {
        [after] => Ok([base.clone(), after.clone()]),
        [before, after] => Ok([before.clone(), after.clone()]),
        _ => Err(none()),
    }
}

/// The factor of a change: `doubled`, `ten times as heavy`, `ten times smaller`, `20 % more`.
fn factor(change: &str) -> Option<f64> {
    let is_down = contains_any(change, &DOWN);
    match (times(change), percent(change)) {
        (Some(factor), _) => Some(if is_down && factor > 1.0 { 1.0 / factor } else { factor }),
        (None, Some(share)) if is_down => Some(1.0 - share),
        (None, Some(share)) if contains_any(change, &UP) => Some(1.0 + share),
        _ => contains_words(change, "half").then_some(0.5),
    }
}
