use crate::check::observations::{ObservedLab, column};
use crate::check::setconst::digits;
use crate::run::Cell;
use crate::spec::Readout;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::collections::BTreeSet;

/// A readout prints nearly the same number although its value changes.
pub const TOO_FEW_DIGITS: &Rule = &Rule {
    code: "too-few-digits",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a readout prints nearly the same number although its value changes",
    why: "a student sees a number that does not move, or jumps once: it is printed with too few decimals",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "fallen (m)", "expr": "⟦1 - data.qpos[2]⟧", "digits": 0}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "fallen (m)", "expr": "1 - data.qpos[2]", "digits": 2}]}"#,
    ),
};

/// The relative change below which a value is nearly constant.
const MIN_RELATIVE_CHANGE: f64 = 0.5;
/// The same limit if only one text is printed, and if two texts without decimals are printed.
const NEARLY_CONSTANT: f64 = 0.05;
const NEARLY_CONSTANT_TWO_TEXTS: f64 = 0.1;
/// With this many different values, the quantity is not a count.
const MIN_VALUES: usize = 20;

/// Checks a readout. `c`: its column.
pub(crate) fn check_readout(observed: &ObservedLab<'_>, readout: &Readout, c: usize) -> Option<Finding> {
    let cells = || column(observed.records, c);
    let numbers = || cells().map(Cell::number);
    if cells().any(|c| !matches!(c, Cell::Number(x) if x.is_finite())) {
        return None;
    }
    let (low, high) = numbers().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let unit = 10_f64.powi(-(readout.digits() as i32));
    let values: BTreeSet<u64> = numbers().filter(|x| x.fract() != 0.0).map(f64::to_bits).collect();
    // Numbers near 0 are printed with an exponent, and thus not rounded.
    let rounded = 4 * numbers().filter(|x| *x == 0.0 || x.abs() >= 1e-3).count() >= 3 * numbers().count();
    let many = values.len() >= MIN_VALUES && rounded;
    let share = (high - low) / low.abs().max(high.abs());
    let printed: BTreeSet<String> =
        cells().map(|c| c.rounded(readout.digits()).trim_start_matches('-').to_string()).collect();
    // One text, or two adjacent ones, for all values.
    let few = readout.digits() == 0
        && (printed.len() == 1 && share > NEARLY_CONSTANT
            || printed.len() == 2 && share > NEARLY_CONSTANT_TWO_TEXTS);
    // A number that is never 0, but is printed as 0.
    let nothing = printed.iter().all(|t| t == "0") && (low >= 1e-3 || high <= -1e-3);
    let few = few || nothing;
    if !nothing && !(many && (share > MIN_RELATIVE_CHANGE && high - low < 2.0 * unit || few)) {
        return None;
    }
    let texts = printed.iter().take(2).cloned().collect::<Vec<_>>().join(" and ");
    let [low, high] = [low, high].map(|x| digits(x, 3));
    let message = format!("\"{}\" is printed with too few decimals", readout.label.value);
    let place = readout.digits.as_ref().map_or(readout.expr.span(), |d| d.span.clone());
    Some(
        Finding::warning(TOO_FEW_DIGITS, readout.expr.span(), message)
            .why(format!(
                "its value goes from {low} to {high} in {}, but it prints {}",
                observed.runs(),
                if few { texts } else { "numbers within two units of the last decimal".into() }
            ))
            .related(place, "decimals")
            .help("increase `digits`"),
    )
}
