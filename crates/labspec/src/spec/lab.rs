//! The lab object.

use super::address::LabAddress;
use super::allow::Allowance;
use super::claim::{Change, Column, Exact, Find, Said, Sweep};
use super::control::Control;
use super::format::{CAMERA, LAB};
use super::plot::{Plot, Readout};
use crate::json::{Number, Scalar};
use crate::source::Text;
use std::ops::Range;

/// A lab: a scene, what a student can change, and what is shown of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Lab {
    /// Bytes of the file, braces included.
    pub span: Range<usize>,
    /// Name of a model of the lesson's model folder. A checked lab has exactly one of `model` and `xml`.
    pub model: Option<Text>,
    /// MJCF given inline.
    pub xml: Option<Text>,
    /// Keyframe to start from and to return to.
    pub key: Option<Number>,
    /// Shown title.
    pub title: Option<Text>,
    /// Shown kind, see [`Lab::kind`].
    pub kind: Option<Text>,
    /// Shown note, HTML.
    pub note: Option<Text>,
    /// Pixels, see [`Lab::height`].
    pub height: Option<Number>,
    /// Layout: docked beside the text.
    pub dock: bool,
    /// Starts playing.
    pub autoplay: bool,
    /// The view.
    pub camera: Camera,
    /// Overlays drawn at the start, with their places.
    pub overlays: Vec<(Text, bool)>,
    /// Overlays that get a checkbox.
    pub toggles: Vec<Text>,
    /// Metres per newton for drawn forces, see [`Lab::force_scale`].
    pub force_scale: Option<Number>,
    /// A site whose path is drawn.
    pub trail: Option<Text>,
    /// Playback speeds, see [`Lab::speeds`].
    pub speeds: Vec<Number>,
    /// Seconds; the run pauses once time reaches it.
    pub stop_at: Option<Number>,
    /// Statements after load and after every reset.
    pub setup: Option<Text>,
    /// Statements before every step.
    pub controller: Option<Text>,
    /// Sliders, selects and buttons.
    pub controls: Vec<Control>,
    /// Whether one of the controls could not be read, which is reported.
    pub unread_controls: bool,
    /// Plots.
    pub plots: Vec<Plot>,
    /// Readouts.
    pub readouts: Vec<Readout>,
    /// What the lesson claims about this lab.
    pub verify: Option<Verify>,
    /// Findings that are not reported about it.
    pub lint: Option<Allowance>,
    /// What the author expects of its runs.
    pub expect: Option<Expect>,
}

/// What an author expects of the runs of a lab, where it is not that they go well.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expect {
    /// `"breaks"`: the simulation meets a bad number or gains energy from nothing, and that is the lesson. With the
    /// place where it says so.
    Breaks(Range<usize>),
}

/// The view of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Degrees.
    pub azimuth: f64,
    /// Degrees.
    pub elevation: f64,
    /// Metres; `None` means 1.9 times the extent of the model.
    pub distance: Option<f64>,
    /// Metres; `None` means the centre of the model.
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

/// Where the scene of a lab comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ModelSource<'a> {
    /// A named model of the model folder.
    Model(&'a Text),
    /// MJCF in the lab itself.
    Xml(&'a Text),
}

impl Lab {
    /// Whether it is the lab of no model, in which nothing is.
    pub(crate) fn is_nothing(&self) -> bool {
        self.span.is_empty() && self.xml.is_none() && self.model.as_ref().is_some_and(|m| m.value.is_empty())
    }

    /// A lab that shows nothing of a model: what remains when only the model is of interest.
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
            plots: Vec::new(),
            readouts: Vec::new(),
            verify: None,
            lint: None,
            expect: None,
        }
    }

    /// The scene; `None` when the lab states none or two, which is an error already reported.
    pub fn scene(&self) -> Option<ModelSource<'_>> {
        match (&self.model, &self.xml) {
            (Some(model), None) => Some(ModelSource::Model(model)),
            (None, Some(xml)) => Some(ModelSource::Xml(xml)),
            _ => None,
        }
    }

    /// Where to point when the whole lab is meant: at its model.
    pub fn place(&self) -> Range<usize> {
        let scene = self.model.as_ref().or(self.xml.as_ref());
        scene.map_or(self.span.start..self.span.start + 1, Text::span)
    }

    /// Index of the keyframe to start from.
    pub fn keyframe(&self) -> Option<usize> {
        self.key.as_ref().map(|k| k.value.max(0.0) as usize)
    }

    /// Title, or a text that stands for it.
    pub fn title(&self) -> &str {
        self.title.as_ref().map_or(LAB.text("title"), Text::as_str)
    }

    /// The word above the title.
    pub fn kind(&self) -> &str {
        self.kind.as_ref().map_or(LAB.text("kind"), Text::as_str)
    }

    /// Height of the picture in pixels.
    pub fn height(&self) -> f64 {
        self.height.as_ref().map_or(LAB.number("height"), |h| h.value)
    }

    /// Metres per newton for drawn forces.
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

    /// All traces, in order of plots.
    pub fn traces(&self) -> impl Iterator<Item = &super::Trace> {
        self.plots.iter().flat_map(|p| &p.traces)
    }

    /// Every text that is code, with what it is, in the order of the lab format's table.
    pub fn code(&self) -> Vec<(Form, &Text)> {
        let statements = [&self.setup, &self.controller].into_iter().flatten();
        let mut all: Vec<(Form, &Text)> = statements.map(|t| (Form::Statements, t)).collect();
        for control in &self.controls {
            if let super::ControlKind::Button { run } = &control.kind {
                all.push((Form::Statements, run));
            }
            if let Some(action) = control.action() {
                all.extend(action.set.iter().map(|t| (Form::Target, t)));
                all.extend(action.apply.iter().map(|t| (Form::Statements, t)));
            }
        }
        let exprs = self.traces().map(|t| &t.expr).chain(self.readouts.iter().map(|r| &r.expr));
        all.extend(exprs.map(|t| (Form::Expression, t)));
        all
    }
}

/// What a text of code is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A value: a trace, a readout, a measure.
    Expression,
    /// What is done: a setup, a controller, what a control applies or a button runs.
    Statements,
    /// What a control sets.
    Target,
}

/// Runs, measures over them, and what must hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Verify {
    /// Bytes of the file, braces included.
    pub span: Range<usize>,
    /// The lab that runs; `None` means the question's `sim`, or the lab that carries this object.
    pub lab: Option<VerifyLab>,
    /// Whose runs and measures are those of this one, too: the lab or the question that carries them.
    pub uses: Option<(Text, LabAddress)>,
    /// The runs. Empty means one run of the lab as it stands.
    pub runs: Vec<Run>,
    /// Measures: name and expression, taken in every run.
    pub measure: Vec<(Text, Text)>,
    /// Values that are searched for.
    pub find: Vec<Find>,
    /// One condition per option of the question.
    pub options: Vec<Text>,
    /// Sliders by label, and the range of each over which the answer must hold.
    pub over: Vec<(Text, [f64; 2])>,
    /// The value of a numeric answer.
    pub value: Option<Text>,
    /// Values that the tolerance of a numeric answer must refuse: what a mistake leads to.
    pub wrong: Vec<Text>,
    /// Numbers quoted in the text, each with the expression it must equal as printed.
    pub says: Vec<Said>,
    /// Columns and cells of tables, each with what it must state.
    pub table: Vec<Column>,
    /// Closed forms that traces must follow.
    pub exact: Vec<Exact>,
}

/// The lab of a [`Verify`].
#[derive(Clone, Debug, PartialEq)]
pub enum VerifyLab {
    /// Written out.
    Inline(Box<Lab>),
    /// Another lab of the lesson: `#2`, `#quiz-id.1`.
    Reference(Text, LabAddress),
    /// A lab of another lesson: `other.md#2`. The path of its file is from the folder of this one.
    Elsewhere(Text, String, LabAddress),
    /// Something that is no lab, which is reported.
    Broken,
}

/// A named run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Its name, which measures are read by: `name.measure`.
    pub name: Text,
    /// The lab that it runs, where it is not that of the object.
    pub lab: Option<VerifyLab>,
    /// Changes of the model's text, before it is compiled.
    pub model: Vec<Change>,
    /// The keyframe to start from, instead of the lab's.
    pub key: Option<Scalar>,
    /// Statements before every step, instead of the lab's; empty for none.
    pub controller: Option<Text>,
    /// Control labels and the values they are set to before the run.
    pub set: Vec<(Text, Scalar)>,
    /// Button labels and the times (s) of their presses.
    pub press: Vec<(Text, Number)>,
    /// Further statements, after the lab's own setup.
    pub setup: Option<Text>,
    /// Length in seconds.
    pub until: Option<Number>,
    /// Length in steps.
    pub steps: Option<Number>,
    /// The run ends at the first sample at which this holds.
    pub stop: Option<Text>,
    /// What is tried with several values: a run for each.
    pub sweep: Option<Sweep>,
    /// The lesson says that this run breaks, and then it must.
    pub breaks: bool,
}
