//! Sliders, selects and buttons.

use super::plot::DIGITS;
use super::{Absent, Family, Key, KeyRule, Object, PairHalf, Type, Word, key};
use crate::spec::CodeForm;
use labspec_finding::docs;

static TYPES: [Word; 3] = [
    Word { text: "slider", doc: docs("a number between two ends") },
    Word { text: "select", doc: docs("one of several values") },
    Word { text: "button", doc: docs("statements that run when a student presses it") },
];

/// A slider, a select or a button.
pub static CONTROL: Family = Family {
    name: "control",
    what: "a control",
    doc: docs("What a student can change."),
    key: "type",
    words: &TYPES,
    objects: &[&SLIDER, &SELECT, &BUTTON],
};

const TYPE: Key = key("type", Type::Words(&TYPES), "which control it is", r#""select""#);

const LABEL: Key = key(
    "label",
    Type::Text,
    "the name that a student reads; runs refer to the control by it",
    r#""gravity""#,
)
.must("the student reads the label, and runs refer to the control by it");

const SET: Key =
    key("set", Type::Code(CodeForm::Target), "the field that gets the value", r#""model.opt.gravity[2]""#);

const APPLY: Key = key(
    "apply",
    Type::Code(CodeForm::Statements),
    "statements that see the value as `value`",
    r#""model.body_mass[1] = 1 + 0.05 * Math.abs(value); const q = data.qpos.slice(); mj.mj_setConst(model, data); data.qpos.set(q)""#,
);

const PARAM: Key = key(
    "param",
    Type::Text,
    "the name under which the value is stored: code reads it as `ctx.NAME`",
    r#""push""#,
);

const INIT: Key = key(
    "init",
    Type::Flag,
    "whether every reset applies the value again; needed if it is written into `data`, which a reset clears",
    "true",
);

const RESET: Key = key("reset", Type::Flag, "whether a change also resets the simulation", "true");

/// The rules for the keys of a slider and of a select.
const EFFECT: &[KeyRule] =
    &[KeyRule::AtLeastOne(&["set", "apply", "param"]), KeyRule::FirstCounts(&["set", "apply"])];

/// A slider.
pub static SLIDER: Object = Object {
    name: "slider",
    what: "a slider",
    doc: docs("A number between two ends."),
    tag: Some(("type", "slider")),
    minimal: r#"{"label": "gravity", "min": -20, "max": 0, "value": -9.81, "set": "model.opt.gravity[2]"}"#,
    keys: &[
        Key { example: r#""slider""#, absent: Absent::Text("slider"), ..TYPE },
        LABEL,
        key("unit", Type::Text, "the unit, displayed after the value", r#""m/s^2""#),
        key("min", Type::Number, "the lower end; below `max`", "-20").must("a slider needs two ends"),
        key("max", Type::Number, "the upper end", "0").must("a slider needs two ends"),
        key(
            "step",
            Type::Number,
            "the distance between the values of the slider, which start at `min`",
            "0.01",
        )
        .positive()
        .or(Absent::Described("a hundredth of the range")),
        key("value", Type::Number, "the initial value, between the two ends", "-9.81")
            .must("without it the slider starts as NaN, and the page assigns NaN"),
        DIGITS,
        SET,
        APPLY,
        PARAM,
        INIT,
        RESET,
    ],
    key_rules: EFFECT,
};

static CHOICE_PARTS: [PairHalf; 2] = [
    PairHalf { what: "the displayed text", ty: Type::Text },
    PairHalf { what: "the value", ty: Type::Scalar },
];
static CHOICE: Type = Type::Pair(&CHOICE_PARTS);

/// A select.
pub static SELECT: Object = Object {
    name: "select",
    what: "a select",
    doc: docs("One of several values, chosen by its text."),
    tag: Some(("type", "select")),
    minimal: r#"{"type": "select", "label": "integrator", "options": [["Euler", 0], ["RK4", 1]], "value": 0, "set": "model.opt.integrator"}"#,
    keys: &[
        TYPE.must(""),
        Key { example: r#""integrator""#, ..LABEL },
        key(
            "options",
            Type::List(&CHOICE),
            "the choices: for each one the displayed text and the value",
            r#"[["Euler", 0], ["RK4", 1], ["implicit", 2]]"#,
        )
        .items(1)
        .must("a select offers a list of [text, value] pairs"),
        key("value", Type::Scalar, "the initial value, one of those in `options`", "1")
            .must("without it the select starts with no value"),
        Key { example: r#""model.opt.integrator""#, ..SET },
        Key { example: r#""model.opt.timestep = 0.002 / (1 + value)""#, ..APPLY },
        PARAM,
        INIT,
        RESET,
    ],
    key_rules: EFFECT,
};

/// A button.
pub static BUTTON: Object = Object {
    name: "button",
    what: "a button",
    doc: docs("Statements that run whenever a student presses it. The simulation is not reset; `mj_forward` follows."),
    tag: Some(("type", "button")),
    minimal: r#"{"type": "button", "label": "Push", "run": "data.joint('ball').qvel[0] = 1"}"#,
    keys: &[
        Key { example: r#""button""#, ..TYPE }.must(""),
        Key { example: r#""Push""#, doc: docs("the text on the button; runs press it by this name"), ..LABEL },
        key(
            "run",
            Type::Code(CodeForm::Statements),
            "what a press does: it can set the state (a velocity is a kick), forces, fields of the model, or names of `ctx` that `controller` reads",
            r#""data.joint('ball').qvel[0] = 1""#,
        )
        .must("without statements the button does nothing"),
    ],
    key_rules: &[],
};
