//! The values of this engine for the states of a MuJoCo recording, in the same layout.

use super::number_fields::{NumberFields, Numbers};
use super::recorded_fields::{ForwardFields, TrajectoryFields};
use labspec::interrupt;
use labspec::report::{printable, printable_path};
use labspec::run::MAX_STEPS;
use labspec::source::read_text;
use labspec_core::reflect::{self, Object, View};
use labspec_core::{self as core, Data, Model, Warning};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// The options of the recording.
#[derive(clap::Args, Clone, Debug)]
pub struct RecordOptions {
    /// A recording with the states to use
    #[arg(long, value_name = "ORACLE.json")]
    pub states: PathBuf,
    /// Steps of the trajectory
    #[arg(long, value_name = "N", default_value_t = 100)]
    pub steps: usize,
    /// Write a row after every M steps
    #[arg(long, value_name = "M", default_value_t = 10)]
    pub every: usize,
    /// Solve the constraint problem to rounding
    #[arg(long)]
    pub tight: bool,
    /// Set an option of the model: timestep=0.001, "gravity=0 0 -1"
    #[arg(long, value_name = "K=V")]
    pub option: Vec<String>,
}

/// The numbers of this engine for the states of a recording of MuJoCo, in the layout of that recording. Keys below `sizes`, `model`,
/// `forward` and `trajectory` are MuJoCo's names.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct EngineRecording {
    /// The program that wrote it.
    pub version: &'static str,
    /// Sizes of the model that the recording names.
    #[schemars(with = "BTreeMap<String, usize>")]
    pub sizes: NumberFields,
    /// Always empty: names are the recording's.
    #[schemars(with = "BTreeMap<String, ()>", extend("additionalProperties" = false))]
    pub names: NumberFields,
    /// Fields of the model that the recording names.
    pub model: NumberFields,
    /// What the forward pass gives, for every state.
    #[schemars(with = "Vec<ForwardFields>")]
    pub forward: Vec<NumberFields>,
    /// A trajectory from the start.
    #[schemars(with = "Vec<TrajectoryFields>")]
    pub trajectory: Vec<NumberFields>,
    /// Warnings of the engine, by MuJoCo's name, with how often each was raised.
    #[schemars(with = "BTreeMap<String, NonZeroUsize>")]
    pub warnings: NumberFields,
}

/// The maximum size of a recording that is read, in bytes.
const MAX_RECORDING: u64 = 64 << 20;
/// The maximum number of values that are written.
const MAX_NUMBERS: usize = 5_000_000;

/// The arrays that are recorded for each state, in addition to those that the recording contains.
const STATE: [&str; 6] = ["qpos", "qvel", "act", "ctrl", "mocap_pos", "mocap_quat"];

/// Computes the values that a MuJoCo recording contains, for the same model.
///
/// # Errors
/// The recording cannot be read or is for another model, an option does not exist, or the result is too long.
pub fn record(mut m: Model, options: &RecordOptions) -> Result<EngineRecording, String> {
    let mut scratch = Data::new(&m);
    for option in &options.option {
        set_option(&mut m, &mut scratch, option)?;
    }
    if options.tight {
        let opt = m.edit().opt;
        (*opt.tolerance, *opt.ls_tolerance) = (0.0, 1e-10);
        (*opt.iterations, *opt.ls_iterations) = (200, 100);
    }
    let oracle = read_oracle(options)?;
    check_length(options, &m)?;
    let mut d = Data::new(&m);
    let model = known_fields(&oracle["model"], |name| field(&m, &d, Object::Model, name));
    let sizes = known_fields(&oracle["sizes"], |name| reflect::size(&m, name).map(Numbers::Count));
    let forward = forward_rows(options, &oracle, &mut m, &mut d)?;
    let trajectory = trajectory_rows(options, &m, &mut d)?;
    let warnings = Warning::ALL.iter().zip(&d.warning).filter(|(_, stat)| stat.number > 0);
    let warnings = warnings.map(|(w, stat)| (w.name().to_string(), Numbers::Count(stat.number)));
    Ok(EngineRecording {
        version: concat!("labspec ", env!("CARGO_PKG_VERSION")),
        sizes,
        names: NumberFields::default(),
        model,
        forward,
        trajectory,
        warnings: NumberFields(warnings.collect()),
    })
}

/// Reads the MuJoCo recording.
fn read_oracle(options: &RecordOptions) -> Result<Value, String> {
    let text = read_text(&options.states, MAX_RECORDING, "a recording")?;
    serde_json::from_str(&text).map_err(|e| format!("{} is not JSON: {e}", printable_path(&options.states)))
}

/// # Errors
/// The trajectory has too many steps or numbers.
fn check_length(options: &RecordOptions, m: &Model) -> Result<(), String> {
    let every = options.every.max(1);
    let rows = (options.steps / every).saturating_add(1);
    if options.steps > MAX_STEPS || rows.saturating_mul(m.nq + m.nv + m.na + 3) > MAX_NUMBERS {
        return Err(format!(
            "a trajectory of {} steps with a row after every {every} is too long; request fewer steps, or fewer rows with --every",
            options.steps
        ));
    }
    Ok(())
}

/// Computes the arrays that the recording contains for each of its states.
fn forward_rows(
    options: &RecordOptions,
    oracle: &Value,
    m: &mut Model,
    d: &mut Data,
) -> Result<Vec<NumberFields>, String> {
    let mut rows = Vec::new();
    let mut count = 0;
    for state in oracle["forward"].as_array().into_iter().flatten() {
        start(m, d)?;
        for name in STATE {
            set_array(m, d, name, &state[name])?;
        }
        core::forward(m, d)?;
        let row = known_fields(state, |name| match name {
            "contact" => Some(contacts(d)),
            // The recorded value, not one that a step may have changed.
            _ if STATE.contains(&name) => Some(Numbers::List(recorded(&state[name]))),
            "M" => core::full_m(m, d).ok().map(Numbers::List),
            _ => field(m, d, Object::Data, name),
        });
        count += row.count_values();
        if count > MAX_NUMBERS {
            return Err(format!(
                "the states of {} request more than {MAX_NUMBERS} numbers; name fewer fields or fewer states",
                printable_path(&options.states)
            ));
        }
        rows.push(row);
        if interrupt::requested() {
            break;
        }
    }
    Ok(rows)
}

/// The state of a run after every `every` steps.
fn trajectory_rows(options: &RecordOptions, m: &Model, d: &mut Data) -> Result<Vec<NumberFields>, String> {
    start(m, d)?;
    let mut rows = Vec::new();
    for i in 0..=options.steps {
        if interrupt::requested() {
            break;
        }
        if i % options.every.max(1) == 0 {
            rows.push(NumberFields::new([
                ("time", Numbers::One(d.time)),
                ("qpos", Numbers::List(d.qpos.to_vec())),
                ("qvel", Numbers::List(d.qvel.to_vec())),
                ("act", Numbers::List(d.act.to_vec())),
                ("ncon", Numbers::Count(d.ncon)),
                ("nefc", Numbers::Count(d.nefc)),
            ]));
        }
        if i < options.steps {
            core::step(m, d)?;
        }
    }
    Ok(rows)
}

fn start(m: &Model, d: &mut Data) -> Result<(), core::Error> {
    match m.keys().next() {
        Some(key) => core::reset_data_keyframe(m, d, key),
        None => core::reset_data(m, d),
    }
}

/// Those fields of a recorded object for which there are values.
fn known_fields(recorded: &Value, numbers: impl Fn(&str) -> Option<Numbers>) -> NumberFields {
    let names = recorded.as_object().into_iter().flat_map(|o| o.keys());
    NumberFields(names.filter_map(|name| Some((name.clone(), numbers(name)?))).collect())
}

/// Arrays as lists, counts as numbers; `None` if the field does not exist.
fn field(m: &Model, d: &Data, object: Object, name: &str) -> Option<Numbers> {
    Some(match core::view(m, d, reflect::field(object, name)?).ok()? {
        View::Size(n) => Numbers::Count(n),
        view => Numbers::List((0..view.len()).filter_map(|i| view.get(i)).collect()),
    })
}

/// The contacts, sorted by their geoms, then by their positions to a micrometre.
fn contacts(d: &Data) -> Numbers {
    let mut rows: Vec<_> = d.contact.iter().collect();
    rows.sort_by(|a, b| {
        let position = |c: &core::Contact| c.pos.map(|x| (x * 1e6).round());
        (a.geom1, a.geom2)
            .cmp(&(b.geom1, b.geom2))
            .then(position(a).partial_cmp(&position(b)).unwrap_or(std::cmp::Ordering::Equal))
    });
    let row = |c: &core::Contact| {
        NumberFields::new([
            ("geom1", Numbers::Count(c.geom1)),
            ("geom2", Numbers::Count(c.geom2)),
            ("dist", Numbers::One(c.dist)),
            ("pos", Numbers::List(c.pos.into())),
            ("frame", Numbers::List(c.frame.into())),
            ("friction", Numbers::List(c.friction.into())),
            ("dim", Numbers::Count(c.dim)),
            ("solref", Numbers::List(c.solref.into())),
            ("solimp", Numbers::List(c.solimp.into())),
        ])
    };
    Numbers::Objects(rows.into_iter().map(row).collect())
}

/// The values of a recorded array; NaN for entries that are not numbers.
fn recorded(values: &Value) -> Vec<f64> {
    values.as_array().into_iter().flatten().map(|v| v.as_f64().unwrap_or(f64::NAN)).collect()
}

/// Writes a recorded array into the data.
fn set_array(m: &mut Model, d: &mut Data, name: &str, values: &Value) -> Result<(), String> {
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

fn set_option(m: &mut Model, d: &mut Data, text: &str) -> Result<(), String> {
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
