//! Labs and checks of lessons for pages: what [`labspec::Player`] and [`labspec::Checker`] do, under the names of JavaScript.
//!
//! Nothing is evaluated as JavaScript. Mistakes are thrown as an `Error` whose `findings` tell what is wrong and where. Numbers of traces
//! are seen where they lie in the module's memory: a view is good until the next call into the module.

use js_sys::{Array, Error, Float64Array, JSON, Object, Reflect};
use labspec::finding::Finding;
use labspec::player::{ControlKind, DisplayedIn, Saved};
use labspec::{Checker, Player};
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
/** Models by their names: MJCF. */
export type Models = Record<string, string>;

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
}

/// A state to which a lab can go back.
#[wasm_bindgen]
pub struct State(Saved);

#[wasm_bindgen]
impl Lab {
    /// Opens a lab from its JSON.
    #[wasm_bindgen(constructor)]
    pub fn new(json: &str, models: &Models) -> Result<Lab, JsValue> {
        let player = Player::of_lab(json, named(models, MODELS)?).map_err(|e| thrown(&e))?;
        Ok(Lab { player, rows: Vec::new() })
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

    /// Makes so many steps, and gives a row for the start and for every step: time, then `numbers`. A view, good until the next
    /// call; it ends early when the lab does.
    pub fn record(&mut self, steps: usize) -> Result<Float64Array, JsValue> {
        self.rows.clear();
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

/// Checks a lesson from its text. `path` says by its ending what it is: Markdown, or JSON. What it names in `neighbours` is found
/// from that path, as files would be.
#[wasm_bindgen]
pub fn check(
    path: &str,
    text: &str,
    models: &Models,
    neighbours: Option<Neighbours>,
) -> Result<Report, JsValue> {
    let mut checker = Checker::new(named(models, MODELS)?);
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

/// What is said where models are given in another form.
const MODELS: &str = "`models` is an object: names, and MJCF as text";

/// Texts by their names from an object of JavaScript; `expected` says what it is when it is none.
fn named(texts: &JsValue, expected: &str) -> Result<BTreeMap<String, String>, JsValue> {
    let wrong = || JsValue::from(Error::new(expected));
    let object: &Object = texts.dyn_ref().ok_or_else(wrong)?;
    let pair = |pair: JsValue| {
        let pair: Array = pair.dyn_into().ok()?;
        Some((pair.get(0).as_string()?, pair.get(1).as_string()?))
    };
    Object::entries(object).iter().map(pair).collect::<Option<_>>().ok_or_else(wrong)
}

fn finding(f: &Finding) -> Json {
    json!({
        "code": f.code, "severity": f.severity.as_str(), "file": &*f.path, "start": f.span.start, "end": f.span.end,
        "line": f.position.map(|p| p.line), "column": f.position.map(|p| p.column),
        "message": f.message, "why": f.why, "help": f.help,
    })
}

fn value(v: &labspec::Value) -> Json {
    match v {
        labspec::Value::Number(x) => json!(x),
        labspec::Value::Boolean(b) => json!(b),
        labspec::Value::String(text) => json!(text.to_string()),
        _ => Json::Null,
    }
}

fn object(json: &Json) -> Result<JsValue, JsValue> {
    JSON::parse(&json.to_string())
}

/// An error of JavaScript, with the findings behind it.
fn thrown(e: &labspec::Error) -> JsValue {
    let error = Error::new(&e.to_string());
    let findings: Json = e.findings().iter().map(finding).collect();
    if let Ok(findings) = object(&findings) {
        let _ = Reflect::set(&error, &"findings".into(), &findings);
    }
    error.into()
}
