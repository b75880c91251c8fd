//! The interactions of a student with a lab: sliders moved, options chosen, buttons pressed, each at a time; and the list
//! of tested interactions.

use crate::bind::{Programs, scalar};
use crate::pairwise;
use crate::run::{RunError, presses, settings};
use crate::spec::{ControlKind, Lab};
use labspec_expr::Value;

/// A change of a control or a press of a button.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// Simulated time, s; 0 is before the first step.
    pub time: f64,
    /// Index of the control.
    pub control: usize,
    /// Its new value; `None` for a press.
    pub value: Option<Value>,
}

/// The kind of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InteractionKind {
    /// No interaction.
    AsItStands,
    /// A push too small to be seen, which shows instability that a scene in exact equilibrium hides.
    Touched,
    /// One slider at an end, or one chosen option.
    End,
    /// One button.
    Button,
    /// All buttons, one after the other.
    InOrder,
    /// Several controls at their ends, possibly with a button.
    Corner,
    /// Controls and buttons in turn during the run.
    Interleaved,
}

impl InteractionKind {
    /// All kinds, in the order in which they are tested.
    pub const ALL: [InteractionKind; 7] = [
        InteractionKind::AsItStands,
        InteractionKind::Touched,
        InteractionKind::End,
        InteractionKind::Button,
        InteractionKind::InOrder,
        InteractionKind::Corner,
        InteractionKind::Interleaved,
    ];

    /// The kind in words.
    pub fn description(self) -> &'static str {
        match self {
            InteractionKind::AsItStands => "as it stands",
            InteractionKind::Touched => "with a touch",
            InteractionKind::End => "each control at its ends",
            InteractionKind::Button => "each button",
            InteractionKind::InOrder => "buttons in order",
            InteractionKind::Corner => "corners",
            InteractionKind::Interleaved => "all in turn while it runs",
        }
    }
}

/// A run that a student can make.
#[derive(Clone, Debug, PartialEq)]
pub struct Interaction {
    /// Its kind.
    pub kind: InteractionKind,
    /// The actions, in order of time.
    pub actions: Vec<Action>,
}

impl Interaction {
    /// A base for other interactions: controls set before the first step, and buttons pressed at their times.
    ///
    /// # Errors
    /// A student cannot do this.
    pub fn base(
        lab: &Lab,
        programs: &Programs,
        set: &[(String, Value)],
        press: &[(String, f64)],
    ) -> Result<Interaction, RunError> {
        let mut actions = Vec::new();
        for (label, given) in set {
            let (control, value) = settings::chosen(lab, programs, label, given)?;
            actions.retain(|a: &Action| a.control != control);
            actions.push(Action { time: 0.0, control, value: Some(value) });
        }
        let pressed = presses(programs, press)?.into_iter();
        actions.extend(pressed.map(|(control, time)| Action { time, control, value: None }));
        Ok(Interaction { kind: InteractionKind::AsItStands, actions })
    }

    /// Adds actions to this base. Controls that they set before the first step replace those of the base.
    pub fn and(&self, kind: InteractionKind, more: Vec<Action>) -> Interaction {
        let sets = |a: &Action| a.time <= 0.0 && a.value.is_some();
        let again = |a: &&Action| !(sets(a) && more.iter().any(|b| sets(b) && b.control == a.control));
        let mut actions: Vec<Action> = self.actions.iter().filter(again).cloned().collect();
        actions.extend(more);
        // In order of time; at equal times, settings come before presses; otherwise in the given order.
        actions.sort_by(|a, b| a.time.total_cmp(&b.time).then(sets(b).cmp(&sets(a))));
        Interaction { kind, actions }
    }

    /// The interaction in words: `with "kp" at 5000, "Drop" pressed at 0.1 s`.
    pub fn describe(&self, programs: &Programs) -> String {
        let label = |i: usize| programs.controls.get(i).map_or("", |(label, _)| label.as_str());
        let one = |a: &Action| match &a.value {
            Some(value) if a.time > 0.0 => {
                format!("\"{}\" at {value} from {} s on", label(a.control), crate::run::time(a.time))
            }
            Some(value) => format!("\"{}\" at {value}", label(a.control)),
            None => format!("\"{}\" pressed at {} s", label(a.control), crate::run::time(a.time)),
        };
        let done = match self.actions.as_slice() {
            [] => "as it stands".into(),
            list => format!("with {}", list.iter().map(one).collect::<Vec<_>>().join(", ")),
        };
        match self.kind {
            InteractionKind::Touched => {
                format!(
                    "{done}, after a small perturbation (every joint starts with a speed of {PUSH_SPEED:e})"
                )
            }
            _ => done,
        }
    }
}

/// Default length of a run, s.
const WINDOW: f64 = 10.0;

/// The length for which a student watches a lab, s: until it stops, or the time range of its plots.
pub fn window(lab: &Lab) -> f64 {
    let longest = lab.plots.iter().map(|p| p.window()).filter(|w| w.is_finite()).fold(0.0, f64::max);
    match &lab.stop_at {
        Some(stop) if stop.value > 0.0 => stop.value,
        _ if longest > 0.0 => longest,
        _ => WINDOW,
    }
}

/// The speed of every joint after a push, m/s or rad/s.
pub(super) const PUSH_SPEED: f64 = 1e-6;
/// Time of the first press, s.
const FIRST_PRESS: f64 = 0.1;
/// All combinations are tested when there are at most this many.
const MAX_COMBINATIONS: usize = 16;
/// Maximum number of rows of a covering design, of controls in it, and of levels of each.
const MOST_ROWS: usize = 200;
const MOST_FACTORS: usize = 60;
const MOST_LEVELS: usize = 30;

/// Number of pairs of levels of two factors.
fn pairs(levels: &[usize]) -> usize {
    let mut before = 0usize;
    let mut count = 0usize;
    for n in levels {
        count = count.saturating_add(before.saturating_mul(*n));
        before = before.saturating_add(*n);
    }
    count
}

/// The controls that the interactions of a list move.
struct ListedControls {
    /// Each slider and select: its index, the values to test, and its value in the base.
    changes: Vec<(usize, Vec<Value>, Value)>,
    buttons: Vec<usize>,
}

impl ListedControls {
    fn new(lab: &Lab, base: &Interaction) -> ListedControls {
        let mut controls = ListedControls { changes: Vec::new(), buttons: Vec::new() };
        let start = |i: usize, initial: Value| {
            let set = base.actions.iter().find(|a| a.control == i);
            set.and_then(|a| a.value.clone()).unwrap_or(initial)
        };
        for (i, control) in lab.controls.iter().enumerate() {
            match &control.kind {
                ControlKind::Slider { min, max, value, .. } => {
                    let mut ends = vec![Value::Number(min.value), Value::Number(max.value)];
                    ends.dedup();
                    controls.changes.push((i, ends, start(i, Value::Number(value.value))));
                }
                ControlKind::Select { options, value, .. } => {
                    let all = options.iter().map(|o| scalar(&o.value)).collect();
                    controls.changes.push((i, all, start(i, scalar(value))));
                }
                ControlKind::Button { .. } => controls.buttons.push(i),
            }
        }
        controls
    }
}

/// Sets a control before the first step.
fn set(control: usize, value: &Value) -> Action {
    Action { time: 0.0, control, value: Some(value.clone()) }
}

fn press_at(control: usize, time: f64) -> Action {
    Action { time, control, value: None }
}

/// All tested interactions on a base, the simplest first, for a lab that a student watches for `window` seconds. Also
/// returns the number of pairs of settings that no run covers.
pub fn list_interactions(lab: &Lab, window: f64, base: &Interaction) -> (Vec<Interaction>, usize) {
    let press = FIRST_PRESS.min(0.5 * window);
    let controls = ListedControls::new(lab, base);
    let ListedControls { changes, buttons } = &controls;
    let mut all = vec![base.clone(), base.and(InteractionKind::Touched, Vec::new())];
    for (i, values, start) in changes {
        let moved = values.iter().filter(|v| *v != start);
        all.extend(moved.map(|v| base.and(InteractionKind::End, vec![set(*i, v)])));
    }
    all.extend(buttons.iter().map(|b| base.and(InteractionKind::Button, vec![press_at(*b, press)])));
    let spread = |k: usize, count: usize| press + (window - press).max(0.0) * k as f64 / count.max(1) as f64;
    if buttons.len() > 1 {
        let actions = buttons.iter().enumerate().map(|(k, b)| press_at(*b, spread(k, buttons.len())));
        all.push(base.and(InteractionKind::InOrder, actions.collect()));
    }
    let (corners, missing) = corners(&controls, press);
    all.extend(corners.into_iter().map(|actions| base.and(InteractionKind::Corner, actions)));
    all.extend(
        interleaved(changes, buttons, spread).map(|more| base.and(InteractionKind::Interleaved, more)),
    );
    (all, missing)
}

/// Combinations of the ends of controls, possibly with a button: all of them where they are few, else a pairwise design.
/// Also returns the number of pairs of settings that none of them covers.
fn corners(controls: &ListedControls, press: f64) -> (Vec<Vec<Action>>, usize) {
    let ListedControls { changes, buttons } = controls;
    // The last factor is the pressed button, if any.
    let mut levels: Vec<usize> = changes.iter().map(|(_, values, _)| values.len()).collect();
    if !buttons.is_empty() {
        levels.push(1 + buttons.len());
    }
    let every = pairs(&levels);
    levels.truncate(MOST_FACTORS);
    levels.iter_mut().for_each(|n| *n = (*n).min(MOST_LEVELS));
    let many = levels.iter().fold(1usize, |n, k| n.saturating_mul(*k));
    let (rows, missing) = match (levels.len(), many) {
        (0 | 1, _) => (Vec::new(), 0),
        (_, n) if n <= MAX_COMBINATIONS => (pairwise::all(&levels), 0),
        _ => pairwise::pairwise(&levels, MOST_ROWS),
    };
    let missing = missing + every.saturating_sub(pairs(&levels));
    let actions = |row: Vec<usize>| {
        let chosen =
            changes.iter().zip(&row).filter_map(|((i, values, _), k)| Some(set(*i, values.get(*k)?)));
        let mut actions: Vec<Action> = chosen.collect();
        let button = row.get(changes.len()).and_then(|k| buttons.get(k.checked_sub(1)?));
        actions.extend(button.map(|b| press_at(*b, press)));
        actions
    };
    (rows.into_iter().map(actions).collect(), missing)
}

/// Moves every control to its far end and then to the other one, with a press of a button after each move.
fn interleaved(
    changes: &[(usize, Vec<Value>, Value)],
    buttons: &[usize],
    spread: impl Fn(usize, usize) -> f64,
) -> Option<Vec<Action>> {
    if changes.is_empty() {
        return None;
    }
    let mut list: Vec<(usize, Option<Value>)> = Vec::new();
    let mut next = buttons.iter().cycle();
    for far in [true, false] {
        for (i, values, _) in changes {
            let value = if far { values.last() } else { values.first() };
            list.push((*i, value.cloned()));
            list.extend(next.next().map(|b| (*b, None)));
        }
    }
    // A select without options has no value.
    let is_button = |i: &usize| buttons.contains(i);
    list.retain(|(i, value)| is_button(i) || value.is_some());
    let count = list.len();
    let timed = list.into_iter().enumerate();
    Some(timed.map(|(k, (control, value))| Action { time: spread(k, count), control, value }).collect())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use crate::lint::{ModelFolder, load_lesson};
    use crate::source::SourceFile;

    fn lab(controls: &str) -> Lab {
        let text = format!(r#"{{"model": "ball", "controls": [{controls}]}}"#);
        load_lesson(SourceFile::new("lab.json", text), &ModelFolder::unknown()).all_labs()[0].clone()
    }

    fn nothing() -> Interaction {
        Interaction { kind: InteractionKind::AsItStands, actions: Vec::new() }
    }

    const SLIDER: &str = r#"{"label": "m", "param": "m", "min": 0, "max": 5, "value": 5}"#;
    const SELECT: &str = r#"{"type": "select", "label": "i", "param": "i", "options": [["a", 0], ["b", 1], ["c", 2]], "value": 1}"#;
    const BUTTON: &str = r#"{"type": "button", "label": "Go", "run": "ctx.go = 1"}"#;

    fn counts(lab: &Lab) -> [usize; 7] {
        let (all, _) = list_interactions(lab, 2.0, &nothing());
        InteractionKind::ALL.map(|kind| all.iter().filter(|h| h.kind == kind).count())
    }

    #[test]
    fn ends_options_buttons_and_corners_are_tested() {
        assert_eq!(counts(&lab("")), [1, 1, 0, 0, 0, 0, 0]);
        // One slider is at an end already; both ends are tested during the run.
        assert_eq!(counts(&lab(SLIDER)), [1, 1, 1, 0, 0, 0, 1]);
        // Two ends, three options, with or without the button.
        assert_eq!(counts(&lab(&[SLIDER, SELECT, BUTTON].join(","))), [1, 1, 3, 1, 0, 12, 1]);
        let two = BUTTON.replace("Go", "Stop");
        assert_eq!(counts(&lab(&[BUTTON, &two].join(","))), [1, 1, 0, 2, 1, 0, 0]);
    }

    #[test]
    fn many_controls_are_combined_in_pairs() {
        let sliders: Vec<String> = (0..12).map(|k| SLIDER.replace("\"m\"", &format!("\"m{k}\""))).collect();
        let (all, missing) = list_interactions(&lab(&sliders.join(",")), 2.0, &nothing());
        let corners: Vec<&Interaction> = all.iter().filter(|h| h.kind == InteractionKind::Corner).collect();
        assert!(missing == 0 && corners.len() < 20, "{}", corners.len());
        for i in 0..12 {
            for j in 0..i {
                for (a, b) in [(0.0, 0.0), (0.0, 5.0), (5.0, 0.0), (5.0, 5.0)] {
                    let has =
                        |h: &&Interaction, k: usize, x: f64| h.actions[k].value == Some(Value::Number(x));
                    assert!(corners.iter().any(|h| has(h, i, a) && has(h, j, b)), "{i} at {a}, {j} at {b}");
                }
            }
        }
    }

    #[test]
    fn sequential_actions_are_in_the_window_and_in_order() {
        let (all, _) = list_interactions(&lab(&[SLIDER, SELECT, BUTTON].join(",")), 2.0, &nothing());
        let last = all.last().unwrap();
        assert_eq!(last.actions.len(), 8);
        assert!(last.actions.windows(2).all(|two| two[0].time < two[1].time) && last.actions[7].time < 2.0);
    }
    #[test]
    fn the_base_settings_come_first() {
        let set = |control, x| Action { time: 0.0, control, value: Some(Value::Number(x)) };
        let press = |control, time| Action { time, control, value: None };
        let base = Interaction {
            kind: InteractionKind::AsItStands,
            actions: vec![set(0, 2.0), press(2, 0.0), press(2, 0.5)],
        };
        let (all, _) = list_interactions(&lab(&[SLIDER, SELECT, BUTTON].join(",")), 2.0, &base);
        assert_eq!((&all[0], all[1].kind, &all[1].actions), (&base, InteractionKind::Touched, &base.actions));
        // Both ends of the slider differ from its value in the base.
        let ends: Vec<&Interaction> = all.iter().filter(|h| h.kind == InteractionKind::End).collect();
        assert_eq!(ends.len(), 4);
        assert_eq!(ends[0].actions, [set(0, 0.0), press(2, 0.0), press(2, 0.5)]);
        assert_eq!(ends[2].actions, [set(0, 2.0), set(1, 0.0), press(2, 0.0), press(2, 0.5)]);
        let button = all.iter().find(|h| h.kind == InteractionKind::Button).unwrap();
        assert_eq!(button.actions, [set(0, 2.0), press(2, 0.0), press(2, 0.1), press(2, 0.5)]);
    }
}
