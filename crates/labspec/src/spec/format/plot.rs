//! Plots, their traces and reference lines, and readouts.

use super::{Absent, Key, Object, Type, key};
use crate::spec::CodeForm;
use labspec_finding::docs;

/// The maximum number of decimals: a double has 17 significant digits.
pub const MAX_DIGITS: u32 = 17;

/// `digits`, for a slider and a readout.
pub(super) const DIGITS: Key = key("digits", Type::Whole, "the number of decimals displayed", "2")
    .between(0.0, MAX_DIGITS as f64)
    .or(Absent::Number(3.0));

static ONE_TRACE: Type = Type::Object(&TRACE);
static ONE_REF_LINE: Type = Type::Object(&REF_LINE);

/// A plot.
pub static PLOT: Object = Object {
    name: "plot",
    what: "a plot",
    doc: docs("Curves over time."),
    tag: None,
    minimal: r#"{"traces": [{"label": "height (m)", "expr": "data.joint('ball').qpos[2]"}]}"#,
    keys: &[
        key(
            "traces",
            Type::List(&ONE_TRACE),
            "the curves",
            r#"[{"label": "height (m)", "expr": "data.joint('ball').qpos[2]"}]"#,
        )
        .items(1),
        key("ylabel", Type::Text, "what the vertical axis shows, with its unit", r#""height (m)""#),
        key("xlabel", Type::Text, "what the horizontal axis shows", r#""t (s)""#)
            .or(Absent::Text("time (s)")),
        key("window", Type::Number, "the time span of the horizontal axis", "1.5")
            .unit("s")
            .positive()
            .or(Absent::Number(5.0)),
        key("ymin", Type::Number, "the lower end of the vertical axis; below `ymax`", "0")
            .or(Absent::Described("follows the curves")),
        key("ymax", Type::Number, "the upper end of the vertical axis", "2")
            .or(Absent::Described("follows the curves")),
        key("height", Type::Number, "the height of the plot", "180")
            .unit("px")
            .positive()
            .or(Absent::Number(140.0)),
        key(
            "refLines",
            Type::List(&ONE_REF_LINE),
            "horizontal lines to compare the curves with: a set point, a limit, an expected value",
            r#"[{"y": 2, "label": "start"}]"#,
        )
        .or(Absent::Empty),
    ],
    key_rules: &[],
};

/// A curve.
pub static TRACE: Object = Object {
    name: "trace",
    what: "a trace",
    doc: docs("One curve of a plot."),
    tag: None,
    minimal: r#"{"label": "height (m)", "expr": "data.joint('ball').qpos[2]"}"#,
    keys: &[
        key(
            "label",
            Type::Text,
            "its name in the legend and in written tables; `exact` refers to it by this name",
            r#""height (m)""#,
        )
        .must("the legend and the written table use it as the name of the curve"),
        key(
            "expr",
            Type::Code(CodeForm::Expression),
            "what the curve shows: a number, evaluated after every step",
            r#""data.joint('ball').qpos[2]""#,
        )
        .must("it is the expression of the curve"),
        key("dash", Type::Flag, "whether the curve is dashed", "true"),
    ],
    key_rules: &[],
};

/// A horizontal line of a plot.
pub static REF_LINE: Object = Object {
    name: "refLine",
    what: "a reference line",
    doc: docs("A horizontal line in a plot."),
    tag: None,
    minimal: r#"{"y": 2}"#,
    keys: &[
        key("y", Type::Number, "its height, in the unit of the vertical axis", "1.5")
            .must("it is the height of the line"),
        key("label", Type::Text, "the text beside it", r#""start""#),
    ],
    key_rules: &[],
};

/// A value displayed as text.
pub static READOUT: Object = Object {
    name: "readout",
    what: "a readout",
    doc: docs("A value displayed as text."),
    tag: None,
    minimal: r#"{"label": "time (s)", "expr": "data.time"}"#,
    keys: &[
        key("label", Type::Text, "its name, with the unit", r#""time (s)""#)
            .must("a number without a name means nothing to a reader"),
        key(
            "expr",
            Type::Code(CodeForm::Expression),
            "the displayed value: a number, a text, true or false",
            r#""data.time""#,
        )
        .must("it is the displayed expression"),
        DIGITS,
    ],
    key_rules: &[],
};
