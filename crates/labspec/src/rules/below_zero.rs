use crate::check::observations::ObservedLab;
use crate::check::setconst::digits;
use crate::run::Cell;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A quantity that is never negative is displayed below zero.
pub const BELOW_ZERO: &Rule = &Rule {
    code: "below-zero",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the displayed value of a quantity that cannot be negative is below zero",
    why: "an elapsed time, a number of contacts, a kinetic energy, a mass, a normal force and a magnitude are never negative: the sign or a subtracted term is wrong",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "kinetic energy (J)", "expr": "⟦-lib.energy().kinetic⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "kinetic energy (J)", "expr": "lib.energy().kinetic"}]}"#,
    ),
};

/// Quantities that are never negative: the word of their labels, and the name that the expression must contain so that it reads
/// only this quantity.
const NONNEGATIVE_QUANTITIES: [(&str, &str, &str); 9] = [
    ("nq", "model.nq", "a number of coordinates"),
    ("nv", "model.nv", "a number of degrees of freedom"),
    ("time", "data.time", "elapsed time"),
    ("contacts", "data.ncon", "a number of contacts"),
    ("rows", "data.nefc", "a number of rows"),
    ("kinetic energy", "kinetic", "a kinetic energy"),
    ("kinetic energy", "** 2", "a kinetic energy"),
    ("normal force", "lib.normalForce", "a normal force"),
    ("speed", "hypot", "the magnitude of a velocity"),
];
/// Values above this limit may be negative because of rounding.
const ROUNDING: f64 = -1e-9;

pub(crate) fn check_below_zero(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let lab = observed.bench.ready.lab;
    let traces = lab.traces().map(|t| (&t.label, &t.expr));
    let displayed = traces.chain(lab.readouts.iter().map(|r| (&r.label, &r.expr)));
    for (i, (label, expr)) in displayed.enumerate() {
        let (label, text) = (label.as_str(), expr.as_str());
        let bars = label.starts_with('|') && label.matches('|').count() == 2;
        let of_kind = |(word, code, _): &&(&str, &str, &str)| is_label_of(label, word) && text.contains(code);
        let Some(what) =
            NONNEGATIVE_QUANTITIES.iter().find(of_kind).map(|k| k.2).or(bars.then_some("a magnitude"))
        else {
            continue;
        };
        let numbers = || {
            let column = observed
                .records
                .iter()
                .flat_map(|r| &r.rows)
                .filter_map(|row| Some((row.first()?, row.get(1 + i)?)));
            let numbers = column.filter(|(_, c)| matches!(c, Cell::Number(x) if x.is_finite()));
            numbers.map(|(t, c)| (t.number(), c.number()))
        };
        // A value that is negative only part of the time may be an intended difference.
        let lowest = numbers().min_by(|a, b| a.1.total_cmp(&b.1));
        let (Some((time, low)), false) = (lowest, numbers().any(|(_, x)| x > -ROUNDING)) else { continue };
        if low < ROUNDING {
            let [low, time] = [low, time].map(|x| digits(x, 4));
            findings.push(
                Finding::warning(
                    BELOW_ZERO,
                    expr.span(),
                    format!("\"{label}\" is never above zero, but {what} is never negative"),
                )
                .why(format!(
                    "in {} it is 0 or negative at every sample: {low} at t = {time} s",
                    observed.runs()
                ))
                .help("check the sign, or say in the label what is subtracted"),
            );
        }
    }
}

/// Whether a label is this word, optionally followed by a unit or a name. `time left` is another quantity.
fn is_label_of(label: &str, word: &str) -> bool {
    let lower = label.to_lowercase();
    let rest = match lower.strip_prefix(word) {
        Some(rest) => rest.trim_start(),
        None => return lower.strip_suffix("active").is_some_and(|l| l.trim_end().ends_with(word)),
    };
    rest.is_empty()
        || rest.starts_with(['(', '[', ','])
        || rest.starts_with("along")
        || rest.starts_with("detected")
        || rest.starts_with("since")
}
