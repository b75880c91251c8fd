//! The lab object.

use super::address::LabAddress;
use super::allow::Allowance;
use super::claim::{Change, Column, Exact, Find, QuotedClaim, Sweep};
use super::control::Control;
use super::format::{CAMERA, LAB};
use super::plot::{Plot, Readout};
use crate::json::{Number, Scalar};
use crate::source::Text;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A lab: a scene, the controls for the student, and the displayed values.
#[derive(Clone, Debug, PartialEq)]
pub struct Lab {
    /// Byte range in the file, braces included.
    pub span: Range<usize>,
    /// Name of a model in the model folder of the lesson. A checked lab has exactly one of `model` and `xml`.
    pub model: Option<Text>,
    /// Inline MJCF.
    pub xml: Option<Text>,
    /// The keyframe that sets the initial state, also after a reset.
    pub key: Option<Number>,
    /// The displayed title.
    pub title: Option<Text>,
    /// The displayed kind, see [`Lab::kind`].
    pub kind: Option<Text>,
    /// The displayed note, HTML.
    pub note: Option<Text>,
    /// In pixels, see [`Lab::height`].
    pub height: Option<Number>,
    /// Whether the lab is docked beside the text.
    pub dock: bool,
    /// Whether it starts playing when it appears.
    pub autoplay: bool,
    /// The view.
    pub camera: Camera,
    /// The overlays with their initial visibility.
    pub overlays: Vec<(Text, bool)>,
    /// The overlays with a checkbox.
    pub toggles: Vec<Text>,
    /// Length of a drawn force in metres per newton, see [`Lab::force_scale`].
    pub force_scale: Option<Number>,
    /// The site whose path is drawn.
    pub trail: Option<Text>,
    /// Playback speeds, see [`Lab::speeds`].
    pub speeds: Vec<Number>,
    /// In seconds; the run pauses once the time reaches it.
    pub stop_at: Option<Number>,
    /// Statements that run after loading and after every reset.
    pub setup: Option<Text>,
    /// Statements that run before every step.
    pub controller: Option<Text>,
    /// Sliders, selects and buttons.
    pub controls: Vec<Control>,
    /// Whether a control could not be read; this is reported.
    pub unread_controls: bool,
    /// A key that decides about its runs and could not be read; this is reported.
    pub unread_key: Option<&'static str>,
    /// Plots.
    pub plots: Vec<Plot>,
    /// Readouts.
    pub readouts: Vec<Readout>,
    /// The claims of the lesson about this lab.
    pub verify: Option<Verify>,
    /// The findings that are suppressed for this lab.
    pub lint: Option<Allowance>,
    /// The expected result of its runs.
    pub expect: Option<Expect>,
    /// What it compares, if it is a lab that compares integrators.
    pub comparison: Option<Comparison>,
}

/// What a lab compares: its runs differ in the value of one control.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Byte range of the list of integrators, or of the opening brace of the lab.
    pub span: Range<usize>,
    /// The list as it is written; `None` if it is absent.
    pub listed: Option<Vec<Text>>,
    /// The timestep of all runs, s; `None` for that of the model.
    pub timestep: Option<Number>,
    /// The compared integrators, each once: those of the list that exist, or all.
    pub integrators: Vec<&'static str>,
    /// The index of the select among the controls of the lab: the last one.
    pub control: usize,
}

/// Whether a run breaks, as the lesson says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum BreakExpectation {
    /// It must go well.
    #[default]
    None,
    /// It must break.
    Breaks,
    /// It may break: both results are as the lesson says.
    MayBreak,
}

impl BreakExpectation {
    /// Whether a break is a mistake.
    pub fn forbids(self) -> bool {
        self == BreakExpectation::None
    }

    /// Whether a run that does not break is a mistake.
    pub fn requires(self) -> bool {
        self == BreakExpectation::Breaks
    }
}

/// The expected result of the runs of a lab, if it is not that they succeed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expect {
    /// `"may break"`: some settings of its controls break the simulation, and the lesson shows this on purpose.
    MayBreak,
    /// `"breaks"`: the simulation produces an invalid number or gains energy without a source, and the lesson shows this on
    /// purpose. With the byte range of the word.
    Breaks(Range<usize>),
}

/// The view of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// In degrees.
    pub azimuth: f64,
    /// In degrees.
    pub elevation: f64,
    /// In metres; `None` means 1.9 times the extent of the model.
    pub distance: Option<f64>,
    /// In metres; `None` means the centre of the model.
    pub target: Option<[f64; 3]>,
}

impl Default for Camera {
    fn default() -> Camera {
        Camera {
            azimuth: CAMERA.number("azimuth"),
            elevation: CAMERA.number("elevation"),
            distance: None,
            target: None,
        }
    }
}

/// The source of the scene of a lab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ModelSource<'a> {
    /// A named model in the model folder.
    Model(&'a Text),
    /// Inline MJCF.
    Xml(&'a Text),
}

impl Lab {
    /// Whether it is a placeholder: a lab without a model.
    pub(crate) fn is_nothing(&self) -> bool {
        self.span.is_empty() && self.xml.is_none() && self.model.as_ref().is_some_and(|m| m.value.is_empty())
    }

    /// A lab with only a model, for work on the model alone.
    pub fn of_model(name: Text) -> Lab {
        Lab {
            span: 0..0,
            model: Some(name),
            xml: None,
            key: None,
            title: None,
            kind: None,
            note: None,
            height: None,
            dock: false,
            autoplay: false,
            camera: Camera::default(),
            overlays: Vec::new(),
            toggles: Vec::new(),
            force_scale: None,
            trail: None,
            speeds: Vec::new(),
            stop_at: None,
            setup: None,
            controller: None,
            controls: Vec::new(),
            unread_controls: false,
            unread_key: None,
            plots: Vec::new(),
            readouts: Vec::new(),
            verify: None,
            lint: None,
            expect: None,
            comparison: None,
        }
    }

    /// The scene; `None` if the lab has no model or two, which is reported as an error elsewhere.
    pub fn scene(&self) -> Option<ModelSource<'_>> {
        match (&self.model, &self.xml) {
            (Some(model), None) => Some(ModelSource::Model(model)),
            (None, Some(xml)) => Some(ModelSource::Xml(xml)),
            _ => None,
        }
    }

    /// The range for findings about the whole lab: that of its model.
    pub fn place(&self) -> Range<usize> {
        let scene = self.model.as_ref().or(self.xml.as_ref());
        scene.map_or(self.span.start..self.span.start + 1, Text::span)
    }

    /// Index of the initial keyframe.
    pub fn keyframe(&self) -> Option<usize> {
        self.key.as_ref().map(|k| k.value.max(0.0) as usize)
    }

    /// The title, or the default.
    pub fn title(&self) -> &str {
        self.title.as_ref().map_or(LAB.text("title"), Text::as_str)
    }

    /// The word above the title.
    pub fn kind(&self) -> &str {
        self.kind.as_ref().map_or(LAB.text("kind"), Text::as_str)
    }

    /// Height of the picture, in pixels.
    pub fn height(&self) -> f64 {
        self.height.as_ref().map_or(LAB.number("height"), |h| h.value)
    }

    /// Length of a drawn force, in metres per newton.
    pub fn force_scale(&self) -> f64 {
        self.force_scale.as_ref().map_or(LAB.number("forceScale"), |s| s.value)
    }

    /// Playback speeds.
    pub fn speeds(&self) -> Vec<f64> {
        match self.speeds.as_slice() {
            [] => LAB.numbers("speeds").to_vec(),
            given => given.iter().map(|s| s.value).collect(),
        }
    }

    /// The control with this label.
    pub fn control(&self, label: &str) -> Option<&Control> {
        self.controls.iter().find(|c| c.label.value == label)
    }

    /// All traces, in the order of the plots.
    pub fn traces(&self) -> impl Iterator<Item = &super::Trace> {
        self.plots.iter().flat_map(|p| &p.traces)
    }

    /// The controls that the author wrote: without the one that a comparison adds.
    pub fn authored_controls(&self) -> &[Control] {
        let count = self.comparison.as_ref().map_or(self.controls.len(), |comparison| comparison.control);
        self.controls.get(..count).unwrap_or(&self.controls)
    }

    /// All texts that the author wrote as code, each with its form, in the order of the lab format.
    pub fn code(&self) -> Vec<(CodeForm, &Text)> {
        let statements = [&self.setup, &self.controller].into_iter().flatten();
        let mut all: Vec<(CodeForm, &Text)> = statements.map(|t| (CodeForm::Statements, t)).collect();
        for control in self.authored_controls() {
            if let super::ControlKind::Button { run } = &control.kind {
                all.push((CodeForm::Statements, run));
            }
            if let Some(action) = control.action() {
                all.extend(action.set.iter().map(|t| (CodeForm::Target, t)));
                all.extend(action.apply.iter().map(|t| (CodeForm::Statements, t)));
            }
        }
        // A comparison adds the first plot.
        let added = usize::from(self.comparison.is_some());
        let exprs = self.traces().skip(added).map(|t| &t.expr).chain(self.readouts.iter().map(|r| &r.expr));
        all.extend(exprs.map(|t| (CodeForm::Expression, t)));
        all
    }
}

/// The form of a code text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeForm {
    /// A value: a trace, a readout, a measure.
    Expression,
    /// Statements: the setup, the controller, the `apply` of a control, the `run` of a button.
    Statements,
    /// The assignment target of a control.
    Target,
}

/// Runs, measures over them, and conditions that must hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Verify {
    /// Byte range in the file, braces included.
    pub span: Range<usize>,
    /// The lab that runs; `None` means the `sim` of the question, or the lab that contains this object.
    pub lab: Option<VerifyLab>,
    /// The lab or the question whose runs and measures are used as well.
    pub uses: Option<(Text, UsedObject)>,
    /// The runs. If empty, there is one run of the lab as loaded.
    pub runs: Vec<Run>,
    /// Measures: name and expression, evaluated in every run.
    pub measure: Vec<(Text, Text)>,
    /// Values determined by a search.
    pub find: Vec<Find>,
    /// One condition for each option of the question.
    pub options: Vec<Text>,
    /// Sliders by label, each with the range over which the answer must hold.
    pub over: Vec<(Text, [f64; 2])>,
    /// The value of a numeric answer.
    pub value: Option<Text>,
    /// Values that result from typical errors and that the tolerance of a numeric answer must reject.
    pub wrong: Vec<Text>,
    /// Numbers quoted in the text, each with the expression whose rounded value it must equal.
    pub says: Vec<QuotedClaim>,
    /// Columns and cells of tables, each with the values that it must contain.
    pub table: Vec<Column>,
    /// Closed forms that traces must follow.
    pub exact: Vec<Exact>,
}

/// The lab of a [`Verify`].
#[derive(Clone, Debug, PartialEq)]
pub enum VerifyLab {
    /// An inline lab.
    Inline(Box<Lab>),
    /// Another lab of the lesson: `#2`, `#quiz-id.1`.
    Reference(Text, LabAddress),
    /// A lab of another lesson: `other.md#2`. The path is relative to the folder of this lesson.
    Elsewhere(Text, String, LabAddress),
    /// Not a lab; this is reported.
    Broken,
}

/// The object whose runs and measures a `verify` object uses.
#[derive(Clone, Debug, PartialEq)]
pub enum UsedObject {
    /// That of a lab or a question: `#1`, `#quiz-id.2`.
    Owner(LabAddress),
    /// The one of a comment `labspec define`, by its name.
    Defined(String),
}

/// A named run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Its name; measures are accessed through it: `name.measure`.
    pub name: Text,
    /// The lab that it runs; `None` means that of the object.
    pub lab: Option<VerifyLab>,
    /// Changes to the text of the model, before it is compiled.
    pub model: Vec<Change>,
    /// The initial keyframe, instead of the keyframe of the lab.
    pub key: Option<Scalar>,
    /// Statements before every step, instead of the controller of the lab; empty for none.
    pub controller: Option<Text>,
    /// Labels of controls, with the values to set before the run.
    pub set: Vec<(Text, Scalar)>,
    /// Labels of buttons, with the times in s at which they are pressed.
    pub press: Vec<(Text, Number)>,
    /// Additional statements, after the setup of the lab.
    pub setup: Option<Text>,
    /// Length in seconds.
    pub until: Option<Number>,
    /// Length in steps.
    pub steps: Option<Number>,
    /// The run ends at the first sample at which this condition holds.
    pub stop: Option<Text>,
    /// A parameter with several values; each gives a run.
    pub sweep: Option<Sweep>,
    /// Whether it breaks, as the lesson says.
    pub expect: BreakExpectation,
    /// A key that could not be read; this is reported.
    pub unread_key: Option<&'static str>,
}
