//! Sliders, selects and buttons.

use super::fields::Fields;
use super::format::{BUTTON, CONTROL, MAX_DIGITS, SELECT, SLIDER};
use super::problem::{Mistake, Problem};
use super::read;
use crate::json::{Json, Node, Number, Scalar};
use crate::source::Text;
use std::ops::Range;

/// A control of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// Bytes of the file.
    pub span: Range<usize>,
    /// Its label, by which runs address it.
    pub label: Text,
    /// Its kind.
    pub kind: ControlKind,
}

/// The three kinds of controls.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlKind {
    /// A number between two ends.
    Slider {
        /// Unit, for display.
        unit: Option<Text>,
        /// Lower end.
        min: Number,
        /// Upper end.
        max: Number,
        /// Step; `None` means a hundredth of the range, see [`Control::step`].
        step: Option<Number>,
        /// Start value.
        value: Number,
        /// Number of decimals, see [`Control::digits`].
        digits: Option<Number>,
        /// The effect of a change.
        action: Action,
    },
    /// One of several values.
    Select {
        /// The choices.
        options: Vec<Choice>,
        /// The start value.
        value: Scalar,
        /// The effect of a change.
        action: Action,
    },
    /// Statements at a press.
    Button {
        /// The statements.
        run: Text,
    },
}

/// The effect of a change of a slider or a select.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// An assignable expression that gets the value.
    pub set: Option<Text>,
    /// Statements that read the value as `value`.
    pub apply: Option<Text>,
    /// The value is stored as `ctx.<param>`.
    pub param: Option<Text>,
    /// Whether it is applied again after every reset.
    pub init: bool,
    /// Whether the simulation is reset after a change.
    pub reset: bool,
}

/// A choice of a select.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Displayed text.
    pub text: Text,
    /// The value.
    pub value: Scalar,
}

impl Control {
    /// The effect of a change; `None` for a button.
    pub fn action(&self) -> Option<&Action> {
        match &self.kind {
            ControlKind::Slider { action, .. } | ControlKind::Select { action, .. } => Some(action),
            ControlKind::Button { .. } => None,
        }
    }

    /// Step of a slider, by default a hundredth of its range.
    pub fn step(&self) -> Option<f64> {
        match &self.kind {
            ControlKind::Slider { min, max, step, .. } => {
                Some(step.as_ref().map_or((max.value - min.value) / 100.0, |s| s.value))
            }
            _ => None,
        }
    }

    /// Number of decimals of a slider.
    pub fn digits(&self) -> Option<u32> {
        match &self.kind {
            ControlKind::Slider { digits, .. } => Some(decimals(digits.as_ref())),
            _ => None,
        }
    }
}

/// Number of decimals, limited to the maximum of the rule on `digits`.
pub(super) fn decimals(digits: Option<&Number>) -> u32 {
    digits.map_or(SLIDER.number("digits"), |d| d.value.clamp(0.0, f64::from(MAX_DIGITS))) as u32
}

/// Reads a control.
pub(super) fn read(node: &Node, problems: &mut Vec<Problem>) -> Option<Control> {
    let mut fields = Fields::open_one(node, &CONTROL, problems)?;
    let kind = fields.text("type");
    let control = match kind.as_ref().map_or("slider", Text::as_str) {
        // Only a button has `run`.
        "slider" if kind.is_none() && has_key(node, "run") && !has_key(node, "min") => {
            let button = button(&mut fields);
            fields.missing("type", "without it, the page shows a slider", false);
            button
        }
        "slider" => slider(&mut fields),
        "select" => select(&mut fields),
        "button" => button(&mut fields),
        other => {
            let span = kind.as_ref().map_or(node.span.clone(), Text::span);
            fields.problems.push(Mistake::ControlType(other.to_string()).at(span));
            // The kind decides about the other keys, so they are not checked.
            return None;
        }
    };
    fields.finish();
    let (label, kind) = control?;
    Some(Control { span: node.span.clone(), label, kind })
}

fn has_key(node: &Node, key: &str) -> bool {
    matches!(&node.json, Json::Object(members) if members.iter().any(|member| member.key.value == key))
}

fn slider(fields: &mut Fields<'_, '_>) -> Option<(Text, ControlKind)> {
    fields.narrow(&SLIDER);
    let label = fields.text("label");
    let unit = fields.text("unit");
    let min = fields.number("min");
    let max = fields.number("max");
    let step = fields.number("step");
    let value = fields.number("value");
    let digits = fields.whole("digits");
    let action = action(fields);
    Some((label?, ControlKind::Slider { unit, min: min?, max: max?, step, value: value?, digits, action }))
}

fn select(fields: &mut Fields<'_, '_>) -> Option<(Text, ControlKind)> {
    fields.narrow(&SELECT);
    let label = fields.text("label");
    let options = fields.items("options");
    if options.is_some_and(<[Node]>::is_empty) {
        let mistake = Mistake::NothingOffered.at(fields.span());
        fields.problems.push(mistake);
    }
    // A broken option is already reported; without it, the start value cannot be checked.
    let mut reported = false;
    let options = options.map(|nodes| {
        let numbered = nodes.iter().enumerate();
        numbered.map(|(i, n)| choice(n, i, &mut reported, fields.problems)).collect::<Vec<_>>()
    });
    let options: Option<Vec<Choice>> = options.and_then(|all| all.into_iter().collect());
    let value = fields.scalar("value");
    let action = action(fields);
    Some((label?, ControlKind::Select { options: options?, value: value?, action }))
}

/// Reads an option. The first one that is not a pair is reported for all of them.
fn choice(node: &Node, index: usize, reported: &mut bool, problems: &mut Vec<Problem>) -> Option<Choice> {
    if node.is_broken() {
        return None;
    }
    if let Json::Array(pair) = &node.json
        && let [text, value] = pair.as_slice()
    {
        let text = read::text(text, "the text of an option", problems);
        let value = read::scalar(value, "the value of an option", problems);
        return Some(Choice { text: text?, value: value? });
    }
    let text = match &node.json {
        Json::Text(text) => Some(text.value.clone()),
        _ => None,
    };
    if !std::mem::replace(reported, true) {
        problems.push(Mistake::NoChoice { text, index }.at(node.span.clone()));
    }
    None
}

fn button(fields: &mut Fields<'_, '_>) -> Option<(Text, ControlKind)> {
    fields.narrow(&BUTTON);
    let label = fields.text("label");
    let run = fields.text("run");
    Some((label?, ControlKind::Button { run: run? }))
}

fn action(fields: &mut Fields<'_, '_>) -> Action {
    Action {
        set: fields.text("set"),
        apply: fields.text("apply"),
        param: fields.text("param"),
        init: fields.flag("init"),
        reset: fields.flag("reset"),
    }
}
