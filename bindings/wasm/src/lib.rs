//! Labs and checks of lessons for pages: what [`labspec::Player`] and [`labspec::Checker`] do, under the names of JavaScript.
//!
//! Nothing is evaluated as JavaScript. Mistakes are thrown as an `Error` whose `findings` tell what is wrong and where. Numbers of traces
//! are seen where they lie in the module's memory: a view is good until the next call into the module.

mod data;
mod error;
mod expression;
mod fields;
mod files;
mod model;

use error::{call_error, thrown};
use files::PageModels;
#[cfg(feature = "checker")]
use js_sys::{Array, Object};
use js_sys::{Error, Float32Array, Float64Array, JSON};
#[cfg(feature = "checker")]
use labspec::Checker;
use labspec::Player;
use labspec::finding::Finding;
use labspec::player::{ControlKind, DisplayedIn, Saved};
use serde_json::{Value as Json, json};
#[cfg(feature = "checker")]
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
/** Models by their names: MJCF; and files that they name, by path. */
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
    /// Rows of the last recording: time, then every number that is shown.
    rows: Vec<f64>,
    /// Poses of geoms, as they were asked for last.
    poses: Vec<f32>,
    /// Pairs of geoms that touched after the last step of [`Lab::advance`].
    touching: Vec<(usize, usize)>,
}

/// A state to which a lab can go back.
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
        Lab { player, rows: Vec::new(), poses: Vec::new(), touching: Vec::new() }
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

    /// The traces of the plots, then the readouts: the order of `numbers`.
    #[wasm_bindgen(getter, js_name = "shown")]
    pub fn displayed(&self) -> Result<ShownList, JsValue> {
        let one = |s: &labspec::player::DisplayedValue| match s.place {
            DisplayedIn::Plot(plot) => json!({"label": s.label, "unit": s.unit, "plot": plot}),
            DisplayedIn::Readout(digits) => json!({"label": s.label, "unit": s.unit, "digits": digits}),
        };
        Ok(object(&self.player.displayed().iter().map(one).collect())?.unchecked_into())
    }

    /// Time, s.
    #[wasm_bindgen(getter)]
    pub fn time(&self) -> f64 {
        self.player.time()
    }

    /// Timestep, s.
    #[wasm_bindgen(getter)]
    pub fn timestep(&self) -> f64 {
        self.player.timestep()
    }

    /// Whether the lab has stopped for good.
    #[wasm_bindgen(getter, js_name = isOver)]
    pub fn is_over(&self) -> bool {
        self.player.is_over()
    }

    /// What is shown now, as numbers; NaN for what is none. A view: good until the next call.
    #[wasm_bindgen(getter)]
    pub fn numbers(&self) -> Float64Array {
        // SAFETY: the view is of memory that the lab owns; a page reads it before it calls again, as is said above.
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
        let force = force.try_into().map_err(|_| call_error("wrong-length", "a force has six numbers"))?;
        self.player.apply_force(body, force).map_err(|e| thrown(&e))
    }

    /// Moves a slider or chooses from a select.
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

    /// Back to the start; controls stay where they are.
    pub fn reset(&mut self) {
        self.player.reset();
    }

    /// One step.
    pub fn step(&mut self) -> Result<(), JsValue> {
        self.player.step().map_err(|e| thrown(&e))
    }

    /// Plays to a time, s; returns the number of steps.
    #[wasm_bindgen(js_name = playTo)]
    pub fn play_to(&mut self, time: f64) -> Result<usize, JsValue> {
        self.player.play_to(time).map_err(|e| thrown(&e))
    }

    /// Plays at most `most` steps towards a time. `levels` are pairs: the place of a number, and a level; the call ends after a
    /// step in which a number crosses its level, or, with `contacts`, in which other geoms touch than before.
    pub fn advance(
        &mut self,
        time: f64,
        most: usize,
        levels: &[f64],
        contacts: bool,
    ) -> Result<usize, JsValue> {
        let mut before: Vec<bool> = Vec::with_capacity(levels.len() / 2);
        let over = |numbers: &dyn Fn(usize) -> f64, pair: &[f64]| match pair {
            [at, level] => numbers(*at as usize) > *level,
            _ => false,
        };
        let now = self.player.numbers();
        before
            .extend(levels.chunks(2).map(|pair| over(&|at| now.get(at).copied().unwrap_or(f64::NAN), pair)));
        let touching = &mut self.touching;
        let done = self.player.play_while(time, most, |data, cells| {
            let number = |at: usize| cells.get(at).map_or(f64::NAN, labspec::run::Cell::number);
            let crossed = levels.chunks(2).zip(&before).any(|(pair, was)| over(&number, pair) != *was);
            let moved = contacts && changed(touching, data.fields());
            if crossed || moved { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        done.map_err(|e| thrown(&e))
    }

    /// The poses of all geoms: for each a matrix of 4 x 4, column after column.
    pub fn poses(&mut self) -> Result<Float32Array, JsValue> {
        let scene = self.player.scene().map_err(|e| thrown(&e))?;
        data::write_poses(&scene.geom_xpos, &scene.geom_xmat, &mut self.poses);
        // SAFETY: the page copies it before it calls again.
        Ok(unsafe { Float32Array::view(&self.poses) })
    }

    /// The pairs of geoms that touched in the last step, one after the other: what `advance` stops at.
    pub fn touching(&self) -> Vec<u32> {
        let pairs = touching_pairs(self.player.data().fields());
        pairs.into_iter().flat_map(|(a, b)| [a as u32, b as u32]).collect()
    }

    /// The contacts with their forces: see [`data::contacts`].
    pub fn contacts(&mut self) -> Result<Vec<f64>, JsValue> {
        let (model, scene) = self.player.model_and_scene().map_err(|e| thrown(&e))?;
        data::contacts(model, scene)
    }

    /// The numbers of a field of the model or the data, as they are now.
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

    /// The model as controls and programs left it, as one of its own.
    pub fn model(&self) -> model::RawModel {
        model::RawModel::from_model(self.player.model().clone())
    }

    /// The current value of a control; `null` where there is none.
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

    /// Makes so many steps, and gives a row for the start and for every step: time, then `numbers`. A view, good until the next
    /// call; it ends early when the lab does.
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

    /// What was found when the lab was opened, and what broke since.
    #[wasm_bindgen(getter)]
    pub fn findings(&self) -> Result<Findings, JsValue> {
        Ok(object(&self.player.findings().iter().map(finding).collect())?.unchecked_into())
    }

    /// The state of the lab.
    pub fn save(&self) -> State {
        State(self.player.save())
    }

    /// Goes back to a state of this lab.
    pub fn restore(&mut self, state: &State) -> Result<(), JsValue> {
        self.player.restore(&state.0).map_err(|e| thrown(&e))
    }
}

/// Reading Markdown is the checker's.
#[cfg(feature = "checker")]
#[wasm_bindgen]
impl Lab {
    /// Opens a lab of a lesson by its address: `#2` is the second one, `#quiz-id.1` that of a question.
    #[wasm_bindgen(js_name = ofLesson)]
    pub fn of_lesson(path: &str, text: &str, address: &str, models: &Models) -> Result<Lab, JsValue> {
        let models = PageModels::new(models)?;
        Player::of_lesson(path, text, address, models).map(Lab::from_player).map_err(|e| thrown(&e))
    }
}

/// Checks a lesson from its text. `path` says by its ending what it is: Markdown, or JSON. What it names in `neighbours` is found
/// from that path, as files would be.
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
        let wrong = "`neighbours` is an object: paths, and lessons or snapshots as text";
        checker = checker.neighbours(named(&texts, wrong)?);
    }
    let report = checker.check(path, text);
    let entries = report.entries().iter().map(
        |e| json!({"owner": e.owner, "subject": e.subject.as_str(), "word": e.word, "remark": e.remark}),
    );
    let whole = json!({
        "outcome": report.outcome().as_str(),
        "findings": report.findings.iter().map(finding).collect::<Vec<_>>(),
        "entries": entries.collect::<Vec<_>>(),
    });
    Ok(object(&whole)?.unchecked_into())
}

/// Numbers of one recording.
const MAX_RECORDED: usize = 1 << 24;

/// The pairs of geoms that touched in the last step.
fn touching_pairs(fields: &labspec_core::Fields) -> Vec<(usize, usize)> {
    let pairs = fields.contact.iter().filter(|c| c.exclude == 0).map(|c| (c.geom1, c.geom2));
    let mut pairs: Vec<(usize, usize)> = pairs.collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Takes the pairs of geoms that touch now; whether they are others.
fn changed(touching: &mut Vec<(usize, usize)>, fields: &labspec_core::Fields) -> bool {
    let now = touching_pairs(fields);
    let other = now != *touching;
    *touching = now;
    other
}

/// Texts by their names from an object of JavaScript; `expected` says what it is when it is none.
#[cfg(feature = "checker")]
fn named(texts: &JsValue, expected: &str) -> Result<BTreeMap<String, String>, JsValue> {
    let wrong = || JsValue::from(Error::new(expected));
    let object: &Object = texts.dyn_ref().ok_or_else(wrong)?;
    let pair = |pair: JsValue| {
        let pair: Array = pair.dyn_into().ok()?;
        Some((pair.get(0).as_string()?, pair.get(1).as_string()?))
    };
    Object::entries(object).iter().map(pair).collect::<Option<_>>().ok_or_else(wrong)
}

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
