//! The lab, its camera, and the order of events.

use super::lint::lint_key;
use super::{Absent, CONTROL, Key, KeyRule, LISTING, Named, Object, PLOT, READOUT, Type, VERIFY, Word, key};
use crate::spec::CodeForm;
use labspec_finding::docs;

/// What can be drawn over the scene.
pub static OVERLAYS: [Word; 8] = [
    Word { text: "frames", doc: docs("coordinate frames") },
    Word { text: "joints", doc: docs("joints") },
    Word { text: "contacts", doc: docs("the points of contact") },
    Word { text: "forces", doc: docs("the contact forces; `forceScale` sets their length") },
    Word { text: "com", doc: docs("centres of mass") },
    Word { text: "sites", doc: docs("sites") },
    Word { text: "cameras", doc: docs("cameras") },
    Word { text: "shadows", doc: docs("shadows") },
];

static OVERLAY: Type = Type::Words(&OVERLAYS);
static ONE_CONTROL: Type = Type::OneOf(&CONTROL);
static ONE_PLOT: Type = Type::Object(&PLOT);
static ONE_READOUT: Type = Type::Object(&READOUT);
static NUMBER: Type = Type::Number;
static TEXT: Type = Type::Text;
static LISTED: Type = Type::Object(&LISTING);

/// The results that a lab can be expected to have.
static EXPECTED: [Word; 2] = [
    Word {
        text: "breaks",
        doc: docs(
            "the simulation meets a bad number or gains energy without a source, and the lab shows this on purpose",
        ),
    },
    Word {
        text: "may break",
        doc: docs("some settings of the controls break the simulation, and the lab shows this on purpose"),
    },
];

/// `verify`, for a lab and for a question. (It is a function because a constant must not refer to itself.)
pub(super) const fn verify_key() -> Key {
    key(
        "verify",
        Type::Object(&VERIFY),
        "how the checker tests the claims of the text; the page does not read it",
        r##"{"lab": "#1", "measure": {"speed": "final(-data.joint('ball').qvel[2])"}, "says": [["9.81 m/s", "speed"]]}"##,
    )
}

/// A lab.
pub static LAB: Object = Object {
    name: "lab",
    what: "a lab",
    doc: docs("A model, the controls for a student, and what the page displays of it."),
    tag: None,
    minimal: r#"{"model": "fall"}"#,
    keys: &[
        key(
            "model",
            Type::Name(Named::Model),
            "the name of a model in the model folder, without path and extension",
            r#""fall""#,
        ),
        key(
            "xml",
            Type::Either(&TEXT, &LISTED),
            "a model (MJCF) written here instead of `model`; in a lab of a `verify` object also a listing of the lesson, `{\"listing\": \"pendulum.xml\"}`",
            r#""<mujoco><worldbody><body name='ball'><freejoint name='ball'/><geom size='0.1'/></body></worldbody></mujoco>""#,
        ),
        key(
            "key",
            Type::Whole,
            "the keyframe from which the lab starts and to which a reset returns, counted from 0",
            "0",
        )
        .at_least(0.0)
        .or(Absent::Described("the initial state of the model")),
        key("title", Type::Text, "the title of the lab", r#""A fall""#).or(Absent::Text("")),
        key("kind", Type::Text, "the word above the title", r#""Experiment""#).or(Absent::Text("Lab")),
        key(
            "note",
            Type::Html,
            "a remark below the lab",
            r#""Moving the slider starts the fall again.""#,
        ),
        key("height", Type::Number, "the height of the picture", "220")
            .unit("px")
            .positive()
            .or(Absent::Number(300.0)),
        key("dock", Type::Flag, "whether the lab is docked beside the text", "true"),
        key("autoplay", Type::Flag, "whether the lab plays as soon as it appears", "true"),
        key(
            "camera",
            Type::Object(&CAMERA),
            "the view of the scene",
            r#"{"azimuth": -90, "elevation": 0, "distance": 3, "target": [0, 0, 1]}"#,
        )
        .or(Absent::Empty),
        key(
            "overlays",
            Type::Switches(&OVERLAYS),
            "what the page draws over the scene at the start",
            r#"{"frames": true}"#,
        )
        .or(Absent::Empty),
        key(
            "toggles",
            Type::List(&OVERLAY),
            "overlays with a checkbox, with which a student shows or hides them",
            r#"["contacts", "forces"]"#,
        )
        .or(Absent::Empty),
        key("forceScale", Type::Number, "the length of a drawn force of 1 N", "0.05")
            .unit("m/N")
            .positive()
            .or(Absent::Number(0.02)),
        key(
            "trail",
            Type::Name(Named::Site),
            "the name of a site of the model; the page draws its path as a line",
            r#""tip""#,
        ),
        key(
            "speeds",
            Type::List(&NUMBER),
            "the playback speeds that a student can choose; 1 is real time, 0.1 is slow motion",
            "[0.25, 1]",
        )
        .positive()
        .or(Absent::Numbers(&[0.1, 0.25, 1.0, 4.0])),
        key(
            "stopAt",
            Type::Number,
            "the lab pauses once the simulation reaches this time; a check runs the lab for this long, or for 2 s",
            "1",
        )
        .unit("s")
        .positive()
        .or(Absent::Described("the lab never pauses")),
        key(
            "setup",
            Type::Code(CodeForm::Statements),
            "runs after loading and after every reset, after the values of the controls are applied",
            r#""data.joint('ball').qvel[2] = 1""#,
        ),
        key(
            "controller",
            Type::Code(CodeForm::Statements),
            "runs before every step",
            r#""data.body('ball').xfrc_applied[0] = 0.1""#,
        ),
        key(
            "controls",
            Type::List(&ONE_CONTROL),
            "sliders, selects and buttons, in display order",
            r#"[{"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "value": -9.81}]"#,
        )
        .or(Absent::Empty),
        key(
            "plots",
            Type::List(&ONE_PLOT),
            "plots over time, in display order",
            r#"[{"traces": [{"label": "height (m)", "expr": "data.joint('ball').qpos[2]"}]}]"#,
        )
        .or(Absent::Empty),
        key(
            "readouts",
            Type::List(&ONE_READOUT),
            "values displayed as text, in display order",
            r#"[{"label": "time (s)", "expr": "data.time"}]"#,
        )
        .or(Absent::Empty),
        verify_key(),
        lint_key(),
        key(
            "expect",
            Type::Words(&EXPECTED),
            "the intended result of the lab; a run with this result is not reported; with `breaks` it is an error if no run has it",
            r#""breaks""#,
        )
        .or(Absent::Described("every run must go well")),
    ],
    key_rules: &[KeyRule::ExactlyOne(&["model", "xml"])],
};

/// The view of a lab.
pub static CAMERA: Object = Object {
    name: "camera",
    what: "a camera",
    doc: docs(
        "The view of the scene. The camera looks at the target from a distance, in a direction given by two angles.",
    ),
    tag: None,
    minimal: "{}",
    keys: &[
        key("azimuth", Type::Number, "the direction in which the camera looks, around the vertical", "-90")
            .unit("degrees")
            .or(Absent::Number(-55.0)),
        key("elevation", Type::Number, "how far above the horizon the camera stands", "8")
            .unit("degrees")
            .or(Absent::Number(25.0)),
        key("distance", Type::Number, "how far the camera is from its target", "2")
            .unit("m")
            .or(Absent::Described("1.9 times the extent of the model")),
        key("target", Type::Numbers(3), "the point that the camera looks at: x, y, z", "[0, 0, 0.4]")
            .unit("m")
            .or(Absent::Described("the centre of the model")),
    ],
    key_rules: &[],
};

/// The order of events in a lab.
pub static EVENTS: [&str; 8] = [
    "The model is compiled, its data are made, and `mj_forward` computes the derived fields. With `key`, the data are set to that keyframe.",
    "Each control, in order: its `value` is stored as `ctx.<param>`, then `set` or `apply` runs with it. There is no reset in between.",
    "`setup` runs, then each control with `init` is applied again, in order, then `mj_forward`.",
    "Each step: first `controller`, then `mj_step`. Traces and readouts are evaluated between two steps: at the start, and after every step.",
    "A student moves a control: its value is stored and `set` or `apply` runs, as in 2. With `reset` a whole reset follows, else `mj_forward`.",
    "A student presses a button: its `run`, then `mj_forward`.",
    "A reset: the data return to the initial state or to the keyframe, `mj_forward`, then 3 again. The model and `ctx` keep what was written: a reset restores data, never the model.",
    "Once the time reaches `stopAt`, the lab pauses. A step that meets a bad number warns and resets the data to time 0; plots start again whenever the time goes back.",
];
