//! The lab object.

use super::fields::Fields;
use super::format::{CAMERA, LAB};
use super::problem::{Mistake, Problem};
use super::read;
use super::{Allowance, Control, Plot, Readout, Verify, allow, control, plot, verify};
use crate::json::{Json, Node, Number};
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
    /// Findings that are not told of it.
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
            own => own.iter().map(|s| s.value).collect(),
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
        let own = [&self.setup, &self.controller].into_iter().flatten();
        let mut all: Vec<(Form, &Text)> = own.map(|t| (Form::Statements, t)).collect();
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

/// Reads a lab.
pub(super) fn read(node: &Node, problems: &mut Vec<Problem>) -> Option<Lab> {
    let mut fields = Fields::open(node, &LAB, problems)?;
    let f = &mut fields;
    let lab = Lab {
        span: f.span(),
        model: f.text("model"),
        xml: f.text("xml"),
        key: f.whole("key"),
        title: f.text("title"),
        kind: f.text("kind"),
        note: f.text("note"),
        height: f.number("height"),
        dock: f.flag("dock"),
        autoplay: f.flag("autoplay"),
        camera: f.node("camera").and_then(|n| camera(n, f.problems)).unwrap_or_default(),
        overlays: overlays(f),
        toggles: f.list("toggles").iter().filter_map(|n| read::text(n, "a toggle", f.problems)).collect(),
        force_scale: f.number("forceScale"),
        trail: f.text("trail"),
        speeds: f.list("speeds").iter().filter_map(|n| read::number(n, "a speed", f.problems)).collect(),
        stop_at: f.number("stopAt"),
        setup: f.text("setup"),
        controller: f.text("controller"),
        unread_controls: false,
        controls: f.list("controls").iter().filter_map(|n| control::read(n, f.problems)).collect(),
        plots: f.list("plots").iter().filter_map(|n| plot::read(n, f.problems)).collect(),
        readouts: f.list("readouts").iter().filter_map(|n| plot::readout(n, f.problems)).collect(),
        verify: f.node("verify").and_then(|n| verify::read(n, f.problems)),
        lint: allow::read(f.node("lint"), f.span(), f.problems),
        expect: f.text("expect").and_then(|t| expected(&t, f.problems)),
    };
    let listed = f.list("controls").len();
    fields.finish();
    Some(Lab { unread_controls: lab.controls.len() < listed || no_list_of_controls(node), ..lab })
}

/// Whether the list of controls itself could not be read.
fn no_list_of_controls(node: &Node) -> bool {
    node.get("controls").is_some_and(|n| !matches!(n.json, Json::Array(_)))
}

fn expected(text: &Text, problems: &mut Vec<Problem>) -> Option<Expect> {
    if text.as_str() == "breaks" {
        return Some(Expect::Breaks(text.span()));
    }
    problems.push(Mistake::LabExpects(text.value.clone()).at(text.span()));
    None
}

fn camera(node: &Node, problems: &mut Vec<Problem>) -> Option<Camera> {
    let mut fields = Fields::open(node, &CAMERA, problems)?;
    let standard = Camera::default();
    let camera = Camera {
        azimuth: fields.number("azimuth").map_or(standard.azimuth, |n| n.value),
        elevation: fields.number("elevation").map_or(standard.elevation, |n| n.value),
        distance: fields.number("distance").map(|n| n.value),
        target: fields.node("target").and_then(|n| point(n, fields.problems)),
    };
    fields.finish();
    Some(camera)
}

/// Three numbers.
fn point(node: &Node, problems: &mut Vec<Problem>) -> Option<[f64; 3]> {
    if let Json::Array(items) = &node.json
        && let [Json::Number(x), Json::Number(y), Json::Number(z)] =
            items.iter().map(|n| &n.json).collect::<Vec<_>>()[..]
    {
        return Some([*x, *y, *z]);
    }
    if node.is_broken() || matches!(&node.json, Json::Array(items) if items.iter().any(Node::is_broken)) {
        return None;
    }
    problems.push(Mistake::NoPoint.at(node.span.clone()));
    None
}

fn overlays(fields: &mut Fields<'_, '_>) -> Vec<(Text, bool)> {
    let mut all = Vec::new();
    for member in fields.map("overlays") {
        match member.value.json {
            Json::Bool(on) => all.push((member.key.clone(), on)),
            Json::Broken => {}
            _ => fields.problems.push(Mistake::NoSwitch.at(member.value.span.clone())),
        }
    }
    all
}
