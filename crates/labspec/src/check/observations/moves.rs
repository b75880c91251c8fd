//! Interactions during a run of a lab: the moves of its controls.

use crate::bind::scalar;
use crate::check::choices::choices;
use crate::spec::{Control, ControlKind, Lab};
use labspec_expr::Value;

/// Tried positions of a slider, as fractions of its range.
const SLIDER_POSITIONS: [f64; 5] = [0.0, 0.24, 0.5, 0.77, 1.0];
/// Maximum number of tried options.
const MOST_OPTIONS: usize = 8;

/// An interaction at a step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Move {
    pub(crate) step: usize,
    pub(crate) control: usize,
    /// `None` for pressing a button.
    pub(crate) value: Option<Value>,
}

impl Move {
    /// A press without effect: everything is recomputed, as after any press.
    pub(crate) fn nothing(step: usize) -> Move {
        Move { step, control: usize::MAX, value: None }
    }
}

/// Moves of the other controls.
pub(crate) type Setting = Vec<Move>;

/// The tried values of a control, in order; a button has none.
pub(crate) fn values(control: &Control) -> Vec<Option<Value>> {
    match &control.kind {
        // Another rule reports a slider that cannot be moved.
        ControlKind::Slider { min, max, .. } if min.value >= max.value => Vec::new(),
        ControlKind::Slider { min, max, .. } => {
            let step = control.step().filter(|s| *s > 0.0).unwrap_or(f64::NAN);
            let on_grid = |share: f64| {
                let x = min.value + (share * (max.value - min.value) / step).round() * step;
                let tidy = format!("{x:.12e}").parse().unwrap_or(x);
                if x.is_finite() { f64::max(min.value, f64::min(tidy, max.value)) } else { min.value }
            };
            let mut all: Vec<f64> = SLIDER_POSITIONS.iter().map(|s| on_grid(*s)).collect();
            if let Some(last) = all.last_mut() {
                *last = max.value;
            }
            all.dedup();
            all.into_iter().map(|x| Some(Value::Number(x))).collect()
        }
        ControlKind::Select { options, .. } => {
            options.iter().take(MOST_OPTIONS).map(|o| Some(scalar(&o.value))).collect()
        }
        ControlKind::Button { .. } => vec![None],
    }
}

/// The settings of the other controls: none, each button, all at their ends, both together, each alone.
pub(crate) fn settings(lab: &Lab, nominal: usize, press: usize) -> Vec<Setting> {
    let others = || lab.controls.iter().enumerate().filter(move |(i, _)| *i != nominal);
    let ends: Vec<(usize, Vec<Value>)> = others()
        .filter_map(|(i, c)| match &c.kind {
            ControlKind::Slider { min, max, .. } => {
                Some((i, vec![Value::Number(max.value), Value::Number(min.value)]))
            }
            ControlKind::Select { options, .. } => {
                Some((i, options.iter().rev().take(MOST_OPTIONS).map(|o| scalar(&o.value)).collect()))
            }
            ControlKind::Button { .. } => None,
        })
        .collect();
    let buttons: Vec<Setting> = others()
        .filter(|(_, c)| matches!(c.kind, ControlKind::Button { .. }))
        .map(|(i, _)| vec![Move { step: press, control: i, value: None }])
        .collect();
    let set = |control: usize, value: &Value| Move { step: 0, control, value: Some(value.clone()) };
    let together = |which: fn(&[Value]) -> Option<&Value>| -> Setting {
        ends.iter().filter_map(|(i, list)| Some(set(*i, which(list)?))).collect()
    };
    let mut all: Vec<Setting> = vec![Vec::new()];
    all.extend(buttons.iter().cloned());
    let corners = [together(<[Value]>::first), together(<[Value]>::last)];
    let alone = ends.iter().flat_map(|(i, list)| list.iter().map(|v| vec![set(*i, v)]));
    let more: Vec<Setting> = corners.into_iter().chain(alone).filter(|s| !s.is_empty()).collect();
    all.extend(more.iter().cloned());
    all.extend(buttons.iter().flat_map(|b| more.iter().map(|s| [s.clone(), b.clone()].concat())));
    let mut once: Vec<Setting> = Vec::new();
    for setting in all {
        if !once.contains(&setting) {
            once.push(setting);
        }
    }
    once
}

/// No move, then each control pressed or moved to a choice, one at a time; with a description of the move.
pub(crate) fn single_moves(lab: &Lab) -> Vec<(Option<Move>, String)> {
    let mut all = vec![(None, "as the lab stands,".to_string())];
    for (i, control) in lab.controls.iter().enumerate() {
        let label = &control.label.value;
        let move_to = |value| Some(Move { step: 1, control: i, value });
        if matches!(control.kind, ControlKind::Button { .. }) {
            all.push((move_to(None), format!("after \"{label}\" is pressed,")));
        }
        let values = choices(control).into_iter();
        all.extend(values.map(|v| (move_to(Some(v.clone())), format!("with \"{label}\" at {v},"))));
    }
    all
}
