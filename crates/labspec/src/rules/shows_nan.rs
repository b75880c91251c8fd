use crate::bind::Bound;
use crate::check::lab_runs::{WatchedDisplay, moment};
use crate::run::Session;
use labspec_expr::Value;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::collections::BTreeSet;

/// A trace or a readout shows nan.
pub const SHOWS_NAN: &Rule = &Rule {
    code: "shows-nan",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a trace or a readout shows nan",
    why: "a student cannot tell whether the lab or the physics is broken. An intended gap writes `NaN` itself, or reads a variable that is stored later",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "readouts": [{"label": "shown", "expr": "⟦Math.sqrt(-1 - data.qpos[2])⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "readouts": [{"label": "shown", "expr": "Math.sqrt(data.qpos[2] ** 2)"}]}"#,
    ),
};

/// Reports a display without a number.
pub(crate) fn check_cell(display: &WatchedDisplay<'_>, value: &Value, t: f64, done: &str) -> Option<Finding> {
    let empty = match value {
        Value::Number(x) => x.is_nan(),
        value => matches!(value, Value::Undefined | Value::Null),
    };
    empty.then(|| {
        let what = if display.trace { "trace" } else { "readout" };
        let message = format!("{} shows nan ({})", display.name, moment(t, done));
        Finding::warning(SHOWS_NAN, display.bound.text.span(), message).why(display.consequence()).help(format!(
            "guard it with a condition, or write `NaN` for an intended gap, as `data.ncon > 0 ? … : NaN` in this {what}: 0 / 0, the root of a negative number or a missing element gives nan"
        ))
    })
}

/// Reports a display that is a gap in all runs.
pub(crate) fn always_a_gap(display: &WatchedDisplay<'_>) -> Finding {
    let message = format!("{} shows nan in every run", display.name);
    Finding::warning(SHOWS_NAN, display.bound.text.span(), message)
        .why("a student sees nan, or no curve at all, at every setting")
        .help(match display.mentions_gap {
            true => "write an expression to display: this one is only a gap",
            false => "store a value in the variable that it reads: no program does so",
        })
}

/// Whether a text contains a word.
pub(crate) fn contains_word(text: &str, word: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
    text.match_indices(word).any(|(start, _)| {
        let before = text.get(..start).and_then(|t| t.chars().next_back());
        let after = text.get(start + word.len()..).and_then(|t| t.chars().next());
        !before.is_some_and(part) && !after.is_some_and(part)
    })
}

/// Whether a text announces a gap. A comparison with `null` is no announcement.
pub(crate) fn mentions_gap(text: &str) -> bool {
    let mut asked = text.to_string();
    for how in ["=== ", "!== ", "== ", "!= ", "===", "!==", "==", "!="] {
        for word in ["null", "undefined"] {
            asked = asked.replace(&format!("{how}{word}"), "");
        }
    }
    ["NaN", "null", "undefined"].iter().any(|word| contains_word(&asked, word))
}

/// Whether a text reads a variable that has no value yet, or a NaN that a program stored on purpose.
pub(crate) fn is_unset(bound: &Bound, session: &Session<'_>, gaps: &BTreeSet<u32>) -> bool {
    let effects = bound.program.effects();
    let empty = |slot: &u32| match session.context.get(*slot) {
        Value::Undefined | Value::Null => true,
        Value::Number(x) => x.is_nan() && gaps.contains(slot),
        // Lists and records may contain gaps.
        Value::List(_) | Value::Record(_) => true,
        _ => false,
    };
    effects.any_ctx || effects.calls_values || effects.ctx_reads.iter().any(empty)
}
