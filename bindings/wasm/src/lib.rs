//! Labs and checks of lessons for pages: the functions of [`labspec::Player`] and [`labspec::Checker`] with JavaScript names.
//!
//! Nothing is evaluated as JavaScript. Failures throw an `Error` whose `findings` describe the mistakes and their locations.
//! Numbers of traces are views of the module's memory: a view is valid until the next call into the module.

#[cfg(feature = "checker")]
mod assist;
mod data;
mod error;
mod events;
mod expression;
mod fields;
mod files;
mod model;
mod textures;

use error::{call_error, thrown};
use events::Watched;
use files::PageModels;
#[cfg(feature = "checker")]
use js_sys::{Array, Object};
use js_sys::{Error, Float32Array, Float64Array, JSON};
#[cfg(feature = "checker")]
use labspec::Checker;
use labspec::Player;
use labspec::finding::Finding;
use labspec::player::{ControlKind, DisplayedIn, Saved, touching_pairs};
#[cfg(feature = "checker")]
use labspec_assist::EditorText;
use serde_json::{Value as Json, json};
#[cfg(feature = "checker")]
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
/** Models by their names: MJCF, or the bytes of a compiled model; and files that they name, by path. */
export type Models = Record<string, string | Uint8Array>;

/** Lessons whose labs others name, and snapshots, by their paths. */
export type Neighbours = Record<string, string>;

/** One thing that is wrong or doubtful, and where. */
export interface Finding {
  code: string;
  severity: "error" | "warning" | "note";
  file: string;
  /** Bytes of the text. */
  start: number;
  end: number;
  /** From 1; null where only the bytes are known. */
  line: number | null;
  column: number | null;
  message: string;
  why: string | null;
  help: string | null;
}

/** A slider, a select or a button. */
export interface Control {
  kind: "slider" | "select" | "button";
  label: string;
  start: number | string | boolean | null;
  min?: number;
  max?: number;
  step?: number;
  unit?: string;
  digits?: number;
  options?: [string, number | string | boolean | null][];
}

/** A trace of a plot, or a readout. */
export interface Shown {
  label: string;
  unit: string;
  /** The plot of a trace, from 0. */
  plot?: number;
  /** The decimals of a readout. */
  digits?: number;
}

/** A claim of a lesson, and what became of it. */
export interface Entry {
  owner: string;
  subject: string;
  /** `true`, `false`, `unchecked`, `left out`, `known` or `not claimed`. */
  state: string;
  word: string;
  remark: string;
}

/** What a check came to. */
export interface Report {
  outcome: string;
  findings: Finding[];
  entries: Entry[];
}
"#;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(typescript_type = "Models")]
    pub type Models;
    #[wasm_bindgen(typescript_type = "Neighbours")]
    pub type Neighbours;
    #[wasm_bindgen(typescript_type = "Control[]")]
    pub type Controls;
    #[wasm_bindgen(typescript_type = "Shown[]")]
    pub type ShownList;
    #[wasm_bindgen(typescript_type = "Finding[]")]
    pub type Findings;
    #[wasm_bindgen(typescript_type = "Report")]
    pub type Report;
    #[wasm_bindgen(typescript_type = "number | string | boolean")]
    pub type Input;
}

/// A lab that is open on a page.
#[wasm_bindgen]
pub struct Lab {
    player: Player,
    /// The rows of the last recording: time, then all displayed numbers.
    rows: Vec<f64>,
    /// The poses of geoms at the last request.
    poses: Vec<f32>,
    /// What [`Lab::advance`] saw after its last step.
    watched: Watched,
}

/// A state that a lab can restore.
#[wasm_bindgen]
pub struct State(Saved);

#[wasm_bindgen]
impl Lab {
    /// Opens a lab from its JSON.
    #[wasm_bindgen(constructor)]
    pub fn new(json: &str, models: &Models) -> Result<Lab, JsValue> {
        let player = Player::of_lab(json, PageModels::new(models)?).map_err(|e| thrown(&e))?;
        Ok(Lab::from_player(player))
    }

    fn from_player(player: Player) -> Lab {
        Lab { player, rows: Vec::new(), poses: Vec::new(), watched: Watched::default() }
    }

    /// The sliders, selects and buttons.
    #[wasm_bindgen(getter)]
    pub fn controls(&self) -> Result<Controls, JsValue> {
        let one = |c: &labspec::player::Control| {
            let mut one = json!({"label": c.label, "start": value(&c.start)});
            match &c.kind {
                ControlKind::Slider { min, max, step, unit, digits } => {
                    one["kind"] = json!("slider");
                    let facts = [("min", json!(min)), ("max", json!(max)), ("step", json!(step))];
                    facts.into_iter().for_each(|(key, fact)| one[key] = fact);
                    (one["unit"], one["digits"]) = (json!(unit), json!(digits));
                }
                ControlKind::Select { options } => {
                    one["kind"] = json!("select");
                    one["options"] = options.iter().map(|(text, v)| json!([text, value(v)])).collect();
                }
                ControlKind::Button => one["kind"] = json!("button"),
            }
            one
        };
        Ok(object(&self.player.controls().iter().map(one).collect())?.unchecked_into())
    }

    /// The traces of the plots, then the readouts, in the order of `numbers`.
    #[wasm_bindgen(getter, js_name = "shown")]
    pub fn displayed(&self) -> Result<ShownList, JsValue> {
        let one = |s: &labspec::player::DisplayedValue| match s.place {
            DisplayedIn::Plot(plot) => json!({"label": s.label, "unit": s.unit, "plot": plot}),
            DisplayedIn::Readout(digits) => json!({"label": s.label, "unit": s.unit, "digits": digits}),
        };
        Ok(object(&self.player.displayed().iter().map(one).collect())?.unchecked_into())
    }

    /// The simulated time, s.
    #[wasm_bindgen(getter)]
    pub fn time(&self) -> f64 {
        self.player.time()
    }

    /// The timestep, s.
    #[wasm_bindgen(getter)]
    pub fn timestep(&self) -> f64 {
        self.player.timestep()
    }

    /// Whether the lab has stopped permanently.
    #[wasm_bindgen(getter, js_name = isOver)]
    pub fn is_over(&self) -> bool {
        self.player.is_over()
    }

    /// The displayed values as numbers; NaN for values that are not numbers. A view, valid until the next call.
    #[wasm_bindgen(getter)]
    pub fn numbers(&self) -> Float64Array {
        // SAFETY: the view refers to memory that the lab owns; a page reads it before its next call, as documented above.
        unsafe { Float64Array::view(self.player.numbers()) }
    }

    /// What each readout shows now, as the page prints it.
    #[wasm_bindgen(getter, js_name = readoutTexts)]
    pub fn readout_texts(&self) -> Vec<String> {
        self.player.readout_texts()
    }

    /// Sets the force and the torque at the centre of mass of a body, six numbers in world axes.
    #[wasm_bindgen(js_name = applyForce)]
    pub fn apply_force(&mut self, body: usize, force: &[f64]) -> Result<(), JsValue> {
        let force =
            force.try_into().map_err(|_| call_error("wrong-length", "a force must have six numbers"))?;
        self.player.apply_force(body, force).map_err(|e| thrown(&e))
    }

    /// Moves a slider or selects an option.
    pub fn set(&mut self, label: &str, value: &Input) -> Result<(), JsValue> {
        let done = match (value.as_f64(), value.as_bool(), value.as_string()) {
            (Some(x), ..) => self.player.set(label, x),
            (_, Some(b), _) => self.player.set(label, labspec::Value::Boolean(b)),
            (.., Some(text)) => self.player.set(label, labspec::Value::String(text.as_str().into())),
            _ => return Err(Error::new("a control takes a number, a text, true or false").into()),
        };
        done.map_err(|e| thrown(&e))
    }

    /// Presses a button.
    pub fn press(&mut self, label: &str) -> Result<(), JsValue> {
        self.player.press(label).map_err(|e| thrown(&e))
    }

    /// Resets the lab; controls keep their values.
    pub fn reset(&mut self) {
        self.player.reset();
    }

    /// Performs one step.
    pub fn step(&mut self) -> Result<(), JsValue> {
        self.watched.start(self.player.data().fields());
        let done = self.player.step().map_err(|e| thrown(&e));
        self.watched.warns(self.player.data().fields());
        done
    }

    /// Plays to a time, s; returns the number of steps.
    #[wasm_bindgen(js_name = playTo)]
    pub fn play_to(&mut self, time: f64) -> Result<usize, JsValue> {
        self.player.play_to(time).map_err(|e| thrown(&e))
    }

    /// Plays at most `most` steps towards a time. `levels` are pairs: the place of a number, and a level; the call ends after a
    /// step in which a number crosses its level, or, with `contacts`, in which other geoms touch than before, or, with `warnings`, in
    /// which the engine warns.
    pub fn advance(
        &mut self,
        time: f64,
        most: usize,
        levels: &[f64],
        contacts: bool,
        warnings: bool,
    ) -> Result<usize, JsValue> {
        let mut before: Vec<bool> = Vec::with_capacity(levels.len() / 2);
        let over = |numbers: &dyn Fn(usize) -> f64, pair: &[f64]| match pair {
            [index, level] => numbers(*index as usize) > *level,
            _ => false,
        };
        let current = self.player.numbers();
        before.extend(
            levels.chunks(2).map(|pair| over(&|index| current.get(index).copied().unwrap_or(f64::NAN), pair)),
        );
        let watched = &mut self.watched;
        watched.start(self.player.data().fields());
        let done = self.player.play_while(time, most, |data, cells| {
            let number = |index: usize| cells.get(index).map_or(f64::NAN, labspec::run::Cell::number);
            let crossed = levels.chunks(2).zip(&before).any(|(pair, was)| over(&number, pair) != *was);
            let moved = contacts && watched.touches_otherwise(data.fields());
            let warned = warnings && watched.warns(data.fields());
            if crossed || moved || warned { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        done.map_err(|e| thrown(&e))
    }

    /// The poses of all geoms: a 4 x 4 matrix for each, in column-major order.
    pub fn poses(&mut self) -> Result<Float32Array, JsValue> {
        let scene = self.player.scene().map_err(|e| thrown(&e))?;
        data::write_poses(&scene.geom_xpos, &scene.geom_xmat, &mut self.poses);
        // SAFETY: the page copies it before its next call.
        Ok(unsafe { Float32Array::view(&self.poses) })
    }

    /// The pairs of geoms that touched in the last step, in sequence: the criterion at which `advance` stops.
    pub fn touching(&self) -> Vec<u32> {
        let pairs = touching_pairs(self.player.data().fields());
        pairs.into_iter().flat_map(|(a, b)| [a as u32, b as u32]).collect()
    }

    /// The time before the last step of `step` or `advance`, s; then for each warning of the engine how often it was raised since
    /// the data were reset, and the coordinate, degree of freedom or actuator that caused it last.
    pub fn warnings(&self) -> Vec<f64> {
        let all = self.player.data().fields().warning.iter();
        let each = all.flat_map(|w| [w.number as f64, w.lastinfo as f64]);
        std::iter::once(self.watched.before).chain(each).collect()
    }

    /// The contacts with their forces, see [`data::contacts`].
    pub fn contacts(&mut self) -> Result<Vec<f64>, JsValue> {
        let (model, scene) = self.player.model_and_scene().map_err(|e| thrown(&e))?;
        data::contacts(model, scene)
    }

    /// The current values of a field of the model or the data.
    pub fn field(&mut self, field: usize) -> Result<JsValue, JsValue> {
        let field = fields::by_index(field)?;
        let (model, scene) = self.player.model_and_scene().map_err(|e| thrown(&e))?;
        let view = labspec_core::view(model, scene, field).map_err(|e| error::refused(&e))?;
        Ok(fields::copied(view))
    }

    /// The names of all objects of a kind, in the order of their ids.
    pub fn names(&self, kind: &str) -> Result<Vec<String>, JsValue> {
        model::names(self.player.model(), kind)
    }

    /// A copy of the model with the changes of controls and programs.
    pub fn model(&self) -> model::RawModel {
        model::RawModel::from_model(self.player.model().clone())
    }

    /// What programs have asked of the page since the last call: `play`, `pause` or `toggle`.
    #[wasm_bindgen(js_name = takePlayback)]
    pub fn take_playback(&mut self) -> Option<String> {
        self.player.take_playback().map(|asked| asked.as_str().to_string())
    }

    /// The current value of a control; `null` if it does not exist.
    pub fn value(&self, label: &str) -> Result<JsValue, JsValue> {
        object(&self.player.value(label).map_or(Json::Null, value))
    }

    /// The fields that the programs of the lab read.
    pub fn reads(&self) -> Vec<String> {
        self.player.reads()
    }

    /// The fields that the programs of the lab write.
    pub fn writes(&self) -> Vec<String> {
        self.player.writes()
    }

    /// Performs `steps` steps, and returns a row for the start and for every step: time, then `numbers`. A view, valid until
    /// the next call. The recording ends early if the lab stops.
    pub fn record(&mut self, steps: usize) -> Result<Float64Array, JsValue> {
        self.rows.clear();
        let width = self.player.numbers().len() + 1;
        if steps.checked_mul(width).is_none_or(|size| size > MAX_RECORDED) {
            return Err(call_error(
                "too-long",
                &format!(
                    "{steps} steps of {width} numbers are too many to record; the limit is {MAX_RECORDED} numbers: record them in parts"
                ),
            ));
        }
        for step in 0..=steps {
            if step > 0 {
                if self.player.is_over() {
                    break;
                }
                self.player.step().map_err(|e| thrown(&e))?;
            }
            self.rows.push(self.player.time());
            self.rows.extend_from_slice(self.player.numbers());
        }
        // SAFETY: as for `numbers`.
        Ok(unsafe { Float64Array::view(&self.rows) })
    }

    /// The findings from opening the lab and from its runs.
    #[wasm_bindgen(getter)]
    pub fn findings(&self) -> Result<Findings, JsValue> {
        Ok(object(&self.player.findings().iter().map(finding).collect())?.unchecked_into())
    }

    /// The state of the lab.
    pub fn save(&self) -> State {
        State(self.player.save())
    }

    /// Restores a state of this lab.
    pub fn restore(&mut self, state: &State) -> Result<(), JsValue> {
        self.player.restore(&state.0).map_err(|e| thrown(&e))
    }
}

/// Only the checker reads Markdown.
#[cfg(feature = "checker")]
#[wasm_bindgen]
impl Lab {
    /// Opens a lab of a lesson by its address: `#2` is the second lab, `#quiz-id.1` that of a question.
    #[wasm_bindgen(js_name = ofLesson)]
    pub fn of_lesson(path: &str, text: &str, address: &str, models: &Models) -> Result<Lab, JsValue> {
        let models = PageModels::new(models)?;
        Player::of_lesson(path, text, address, models).map(Lab::from_player).map_err(|e| thrown(&e))
    }
}

/// Checks a lesson from its text. The extension of `path` determines its format: Markdown or JSON. Names in `neighbours` are
/// relative to that path, like files.
#[cfg(feature = "checker")]
#[wasm_bindgen]
pub fn check(
    path: &str,
    text: &str,
    models: &Models,
    neighbours: Option<Neighbours>,
) -> Result<Report, JsValue> {
    let mut checker = Checker::new(PageModels::new(models)?);
    if let Some(texts) = neighbours {
        checker = checker.neighbours(named(&texts)?);
    }
    let report = checker.check(path, text);
    let entries = report.entries().iter().map(|e| {
        json!({
            "owner": e.owner, "subject": e.subject.as_str(), "state": e.state.as_str(), "word": e.word, "remark": e.remark,
        })
    });
    let lesson = &report.checked.lesson;
    let editor = EditorText::whole(lesson.file.text());
    let findings = report.findings.iter().map(|f| assist::with_fixes(f, &lesson.file, Some(lesson), &editor));
    let whole = json!({
        "outcome": report.outcome().as_str(),
        "findings": findings.collect::<Vec<_>>(),
        "entries": entries.collect::<Vec<_>>(),
    });
    Ok(object(&whole)?.unchecked_into())
}

/// The maximum number of values of one recording.
const MAX_RECORDED: usize = 1 << 24;

/// Lessons and snapshots by their paths.
#[cfg(feature = "checker")]
pub(crate) fn named(texts: &JsValue) -> Result<BTreeMap<String, String>, JsValue> {
    let wrong =
        || JsValue::from(Error::new("`neighbours` is an object: paths, and lessons or snapshots as text"));
    let object: &Object = texts.dyn_ref().ok_or_else(wrong)?;
    let pair = |pair: JsValue| {
        let pair: Array = pair.dyn_into().ok()?;
        Some((pair.get(0).as_string()?, pair.get(1).as_string()?))
    };
    Object::entries(object).iter().map(pair).collect::<Option<_>>().ok_or_else(wrong)
}

/// A finding of the player, whose module has no `labspec-assist`.
pub(crate) fn finding(f: &Finding) -> Json {
    json!({
        "code": f.code, "severity": f.severity.as_str(), "file": &*f.path, "start": f.span.start, "end": f.span.end,
        "line": f.position.map(|p| p.line), "column": f.position.map(|p| p.column),
        "message": f.message, "why": f.why, "help": f.help,
    })
}

pub(crate) fn value(v: &labspec::Value) -> Json {
    match v {
        labspec::Value::Number(x) => json!(x),
        labspec::Value::Boolean(b) => json!(b),
        labspec::Value::String(text) => json!(text.to_string()),
        _ => Json::Null,
    }
}

pub(crate) fn object(json: &Json) -> Result<JsValue, JsValue> {
    JSON::parse(&json.to_string())
}
