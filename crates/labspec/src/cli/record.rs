//! `labspec record`: our engine's numbers in the layout of a recording of MuJoCo, for the same states.

use super::stdio::print_json;
use super::{Failure, ModelOptions, Outcome, interrupted, target};
use crate::report::{printable, printable_path};
use crate::run::MAX_STEPS;
use crate::source::read_text;
use labspec_core::reflect::{self, Object, View};
use labspec_core::{self as core, Data, Model, Warning};
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// Arguments of `record`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// MODEL.xml
    model: PathBuf,
    #[command(flatten)]
    models: ModelOptions,
    /// A recording whose states are used
    #[arg(long, value_name = "ORACLE.json")]
    states: PathBuf,
    /// Steps of the trajectory
    #[arg(long, value_name = "N", default_value_t = 100)]
    steps: usize,
    /// A row after every M steps
    #[arg(long, value_name = "M", default_value_t = 10)]
    every: usize,
    /// Solve the constraint problem to rounding
    #[arg(long)]
    tight: bool,
    /// Set an option of the model: timestep=0.001, "gravity=0 0 -1"
    #[arg(long, value_name = "K=V")]
    option: Vec<String>,
}

/// Largest recording that is read, in bytes.
const MAX_RECORDING: u64 = 64 << 20;
/// Most numbers that are written.
const MAX_NUMBERS: usize = 5_000_000;

/// What is recorded of each state besides the arrays that the recording names.
const STATE: [&str; 6] = ["qpos", "qvel", "act", "ctrl", "mocap_pos", "mocap_quat"];

pub(super) fn record(a: &Arguments) -> Result<Outcome, Failure> {
    let mut m = target::load_model(&a.model, &a.models)?;
    let mut scratch = Data::new(&m);
    for option in &a.option {
        set_option(&mut m, &mut scratch, option)?;
    }
    if a.tight {
        let opt = m.edit().opt;
        (*opt.tolerance, *opt.ls_tolerance) = (0.0, 1e-10);
        (*opt.iterations, *opt.ls_iterations) = (200, 100);
    }
    let text = read_text(&a.states, MAX_RECORDING, "a recording")?;
    let oracle: Value =
        serde_json::from_str(&text).map_err(|e| format!("{} is not JSON: {e}", printable_path(&a.states)))?;
    drop(text);
    let every = a.every.max(1);
    let rows = (a.steps / every).saturating_add(1);
    if a.steps > MAX_STEPS || rows.saturating_mul(m.nq + m.nv + m.na + 3) > MAX_NUMBERS {
        return Err(format!(
            "a trajectory of {} steps with a row after every {every} is too long; ask for fewer steps, or fewer rows with --every",
            a.steps
        ));
    }
    let mut d = Data::new(&m);

    let model = names(&oracle["model"], |name| field(&m, &d, Object::Model, name));
    let mut forward = Vec::new();
    let mut written = 0;
    for state in oracle["forward"].as_array().into_iter().flatten() {
        start(&m, &mut d)?;
        for name in STATE {
            set_array(&mut m, &mut d, name, &state[name])?;
        }
        core::forward(&m, &mut d)?;
        let mut row = names(state, |name| match name {
            "contact" => Some(contacts(&d)),
            "M" => core::full_m(&m, &d).ok().map(|m| numbers(&m)),
            _ => field(&m, &d, Object::Data, name),
        });
        for name in STATE {
            row.insert(name.into(), state[name].clone());
        }
        let row = Value::Object(row);
        written += size(&row);
        if written > MAX_NUMBERS {
            return Err(format!(
                "the states of {} ask for more than {MAX_NUMBERS} numbers; name fewer fields or fewer states",
                printable_path(&a.states)
            ));
        }
        forward.push(row);
        if interrupted() {
            break;
        }
    }

    start(&m, &mut d)?;
    let mut trajectory = Vec::new();
    for i in 0..=a.steps {
        if interrupted() {
            break;
        }
        if i % every == 0 {
            trajectory.push(json!({
                "time": d.time, "qpos": numbers(&d.qpos), "qvel": numbers(&d.qvel), "act": numbers(&d.act),
                "ncon": d.ncon, "nefc": d.nefc,
            }));
        }
        if i < a.steps {
            core::step(&m, &mut d)?;
        }
    }
    let warnings: Map<String, Value> = Warning::ALL
        .iter()
        .zip(&d.warning)
        .filter(|(_, s)| s.number > 0)
        .map(|(w, s)| (w.name().to_string(), json!(s.number)))
        .collect();
    let value = json!({
        "version": concat!("labspec ", env!("CARGO_PKG_VERSION")),
        "sizes": names(&oracle["sizes"], |name| reflect::size(&m, name).map(|n| json!(n))),
        "names": {}, "model": model, "forward": forward, "trajectory": trajectory, "warnings": warnings,
    });
    print_json(&value, false)?;
    Ok(Outcome::Clean)
}

/// How many values a recorded value holds.
fn size(value: &Value) -> usize {
    match value {
        Value::Array(items) => items.iter().map(size).sum(),
        Value::Object(entries) => entries.values().map(size).sum(),
        _ => 1,
    }
}

fn start(m: &Model, d: &mut Data) -> Result<(), core::Error> {
    match m.keys().next() {
        Some(key) => core::reset_data_keyframe(m, d, key),
        None => core::reset_data(m, d),
    }
}

/// The entries of a recorded object that we know.
fn names(recorded: &Value, value: impl Fn(&str) -> Option<Value>) -> Map<String, Value> {
    let keys = recorded.as_object().into_iter().flat_map(|o| o.keys());
    keys.filter_map(|k| Some((k.clone(), value(k)?))).collect()
}

fn field(m: &Model, d: &Data, object: Object, name: &str) -> Option<Value> {
    let f = reflect::field(object, name)?;
    let view = core::view(m, d, f).ok()?;
    // Arrays as lists, counts as numbers.
    Some(match view {
        View::Size(n) => json!(n),
        _ => numbers(&(0..view.len()).filter_map(|i| view.get(i)).collect::<Vec<_>>()),
    })
}

fn numbers(values: &[f64]) -> Value {
    values.iter().map(|&x| if x.is_finite() { json!(x) } else { Value::Null }).collect()
}

fn contacts(d: &Data) -> Value {
    let mut rows: Vec<_> = d.contact.iter().collect();
    rows.sort_by(|a, b| {
        let place = |c: &core::Contact| c.pos.map(|x| (x * 1e6).round());
        (a.geom1, a.geom2)
            .cmp(&(b.geom1, b.geom2))
            .then(place(a).partial_cmp(&place(b)).unwrap_or(std::cmp::Ordering::Equal))
    });
    rows.iter()
        .map(|c| {
            json!({
                "geom1": c.geom1, "geom2": c.geom2, "dist": c.dist, "pos": numbers(&c.pos), "frame": numbers(&c.frame),
                "friction": numbers(&c.friction), "dim": c.dim, "solref": numbers(&c.solref), "solimp": numbers(&c.solimp),
            })
        })
        .collect()
}

/// Writes a recorded array into the data.
fn set_array(m: &mut Model, d: &mut Data, name: &str, values: &Value) -> Result<(), Failure> {
    let Some(f) = reflect::field(Object::Data, name) else { return Ok(()) };
    let expected = core::length(m, d, f);
    let list = values.as_array().map_or(&[][..], Vec::as_slice);
    if list.len() != expected {
        return Err(format!(
            "the recording has {} numbers for {name}, the model {expected}: is it of another model?",
            list.len()
        ));
    }
    for (i, v) in list.iter().enumerate() {
        core::view_mut(m, d, f)?.set(i, v.as_f64().unwrap_or(f64::NAN));
    }
    Ok(())
}

fn set_option(m: &mut Model, d: &mut Data, text: &str) -> Result<(), Failure> {
    let (name, values) =
        text.split_once('=').ok_or_else(|| format!("--option {}: write NAME=VALUE", printable(text)))?;
    let f = reflect::field(Object::Option, name).ok_or_else(|| {
        format!("--option {}: model.opt has no field `{}`", printable(text), printable(name))
    })?;
    for (i, value) in values.split_whitespace().enumerate() {
        let x = value
            .parse::<f64>()
            .map_err(|_| format!("--option {}: `{}` is not a number", printable(text), printable(value)))?;
        if !core::view_mut(m, d, f)?.set(i, x) {
            return Err(format!("--option {}: too many numbers", printable(text)));
        }
    }
    Ok(())
}
