//! `labspec record`: our engine's numbers in the layout of a recording of MuJoCo, for the same states.

use super::common::{Failure, ModelOptions, Outcome, interrupted};
use super::stdio::print_json;
use super::target;
use labspec::report::{printable, printable_path, report, set_number, set_numbers};
use labspec::run::MAX_STEPS;
use labspec::source::read_text;
use labspec_core::reflect::{self, Object, View};
use labspec_core::{self as core, Data, Model, Warning};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Arguments of `record`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// MODEL.xml
    model: PathBuf,
    #[command(flatten)]
    models: ModelOptions,
    /// A recording with the states to use
    #[arg(long, value_name = "ORACLE.json")]
    states: PathBuf,
    /// Steps of the trajectory
    #[arg(long, value_name = "N", default_value_t = 100)]
    steps: usize,
    /// Write a row after every M steps
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
    let oracle = read_oracle(a)?;
    check_length(a, &m)?;
    let mut d = Data::new(&m);
    let model = names(&oracle["model"], |row, name| set_field(row, &m, &d, Object::Model, name));
    let forward = forward_rows(a, &oracle, &mut m, &mut d)?;
    let trajectory = trajectory_rows(a, &m, &mut d)?;
    let warnings: serde_json::Map<String, Value> = Warning::ALL
        .iter()
        .zip(&d.warning)
        .filter(|(_, s)| s.number > 0)
        .map(|(w, s)| (w.name().to_string(), json!(s.number)))
        .collect();
    let value = json!({
        "version": concat!("labspec ", env!("CARGO_PKG_VERSION")),
        "sizes": names(&oracle["sizes"], |row, name| reflect::size(&m, name).iter().for_each(|n| row[name] = json!(n))),
        "names": {}, "model": model, "forward": forward, "trajectory": trajectory, "warnings": warnings,
    });
    print_json(&report("record", value), false)?;
    Ok(Outcome::Clean)
}

/// Reads the recording of MuJoCo.
fn read_oracle(a: &Arguments) -> Result<Value, Failure> {
    let text = read_text(&a.states, MAX_RECORDING, "a recording")?;
    serde_json::from_str(&text).map_err(|e| format!("{} is not JSON: {e}", printable_path(&a.states)))
}

fn rows_every(a: &Arguments) -> usize {
    a.every.max(1)
}

/// # Errors
/// The trajectory has too many steps or numbers.
fn check_length(a: &Arguments, m: &Model) -> Result<(), Failure> {
    let every = rows_every(a);
    let rows = (a.steps / every).saturating_add(1);
    if a.steps > MAX_STEPS || rows.saturating_mul(m.nq + m.nv + m.na + 3) > MAX_NUMBERS {
        return Err(format!(
            "a trajectory of {} steps with a row after every {every} is too long; request fewer steps, or fewer rows with --every",
            a.steps
        ));
    }
    Ok(())
}

/// The arrays that the recording names, computed for each of its states.
fn forward_rows(a: &Arguments, oracle: &Value, m: &mut Model, d: &mut Data) -> Result<Vec<Value>, Failure> {
    let mut rows = Vec::new();
    let mut written = 0;
    for state in oracle["forward"].as_array().into_iter().flatten() {
        start(m, d)?;
        for name in STATE {
            set_array(m, d, name, &state[name])?;
        }
        core::forward(m, d)?;
        let row = names(state, |row, name| match name {
            "contact" => row[name] = contacts(d),
            // As it was recorded, not as a step may have changed it.
            _ if STATE.contains(&name) => set_list(row, name, &recorded(&state[name])),
            "M" => core::full_m(m, d).iter().for_each(|m| set_list(row, name, m)),
            _ => set_field(row, m, d, Object::Data, name),
        });
        written += size(&row);
        if written > MAX_NUMBERS {
            return Err(format!(
                "the states of {} request more than {MAX_NUMBERS} numbers; name fewer fields or fewer states",
                printable_path(&a.states)
            ));
        }
        rows.push(row);
        if interrupted() {
            break;
        }
    }
    Ok(rows)
}

/// The state of a run after every so many steps.
fn trajectory_rows(a: &Arguments, m: &Model, d: &mut Data) -> Result<Vec<Value>, Failure> {
    start(m, d)?;
    let mut rows = Vec::new();
    for i in 0..=a.steps {
        if interrupted() {
            break;
        }
        if i % rows_every(a) == 0 {
            let mut row = json!({});
            set_number(&mut row, "time", d.time);
            set_list(&mut row, "qpos", &d.qpos);
            set_list(&mut row, "qvel", &d.qvel);
            set_list(&mut row, "act", &d.act);
            row["ncon"] = json!(d.ncon);
            row["nefc"] = json!(d.nefc);
            rows.push(row);
        }
        if i < a.steps {
            core::step(m, d)?;
        }
    }
    Ok(rows)
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

/// An object with those entries of a recorded object that we know, which `set` writes.
fn names(recorded: &Value, set: impl Fn(&mut Value, &str)) -> Value {
    let mut row = json!({});
    let keys = recorded.as_object().into_iter().flat_map(|o| o.keys());
    keys.for_each(|k| set(&mut row, k));
    row
}

/// Arrays as lists, counts as numbers; nothing for a field that there is not.
fn set_field(row: &mut Value, m: &Model, d: &Data, object: Object, name: &str) {
    let Some(view) = reflect::field(object, name).and_then(|f| core::view(m, d, f).ok()) else { return };
    match view {
        View::Size(n) => row[name] = json!(n),
        _ => set_list(row, name, &(0..view.len()).filter_map(|i| view.get(i)).collect::<Vec<_>>()),
    }
}

fn set_list(row: &mut Value, name: &str, values: &[f64]) {
    set_numbers(row, name, &values.iter().copied().map(Some).collect::<Vec<_>>());
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
            let mut row = json!({"geom1": c.geom1, "geom2": c.geom2});
            set_number(&mut row, "dist", c.dist);
            set_list(&mut row, "pos", &c.pos);
            set_list(&mut row, "frame", &c.frame);
            set_list(&mut row, "friction", &c.friction);
            row["dim"] = json!(c.dim);
            set_list(&mut row, "solref", &c.solref);
            set_list(&mut row, "solimp", &c.solimp);
            row
        })
        .collect()
}

/// The numbers of a recorded array; NaN for what is none.
fn recorded(values: &Value) -> Vec<f64> {
    values.as_array().into_iter().flatten().map(|v| v.as_f64().unwrap_or(f64::NAN)).collect()
}

/// Writes a recorded array into the data.
fn set_array(m: &mut Model, d: &mut Data, name: &str, values: &Value) -> Result<(), Failure> {
    let Some(f) = reflect::field(Object::Data, name) else { return Ok(()) };
    let expected = core::length(m, d, f);
    let list = recorded(values);
    if list.len() != expected {
        return Err(format!(
            "the recording has {} numbers for {name}, but the model has {expected}: is it for another model?",
            list.len()
        ));
    }
    for (i, x) in list.into_iter().enumerate() {
        core::view_mut(m, d, f)?.set(i, x);
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
