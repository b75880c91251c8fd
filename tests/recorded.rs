//! Comparison of a model with its recording (`golden/recording.py`): compiled constants, forward passes and a trajectory for
//! each integrator, all with constraints disabled on both sides.
//!
//! Differences of computed fields are absolute for numbers up to 1 and relative above, scaled by the largest recorded number of
//! the field, because a force of 1e4 N cannot be accurate to 1e-10 N. Differences of constants are relative to their field.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::recorded_forward::forward;
use crate::support::{compile_unconstrained, numbers};
use labspec_core::reflect::{self, FieldId, Object};
use labspec_core::xml::Finding;
use labspec_core::{self as core, Data, Model, Obj, Scope, Warning};
use serde_json::{Map, Value};
use std::fmt;
use std::path::Path;

/// The tolerance of the compiler, which performs only a few products and one diagonalization.
const COMPILED: f64 = 1e-12;
/// A value that is zero on one side may be a rounding error on the other.
const COMPILED_ZERO: f64 = 1e-16;
/// The tolerance of values that the library stores in single precision.
const SINGLE: f64 = 1e-6;
/// The tolerance after two hundred steps.
const TRAJECTORY: f64 = 1e-9;

/// The integrators by number.
pub(crate) const INTEGRATORS: [&str; 5] = ["Euler", "RK4", "implicit", "implicitfast", "discrete"];

/// The aspects that are compared: trajectories start from the default or first keyframe, and from a state
/// in which everything moves.
pub(crate) const ASPECTS: [&str; 12] = [
    "compile",
    "forward",
    "Euler",
    "RK4",
    "implicit",
    "implicitfast",
    "discrete",
    "Euler, moving",
    "RK4, moving",
    "implicit, moving",
    "implicitfast, moving",
    "discrete, moving",
];

/// A number that differs.
#[derive(Clone, Debug)]
pub(crate) struct Difference {
    /// `state 3`, `step 40`; empty for constants.
    pub(crate) place: String,
    pub(crate) field: String,
    pub(crate) index: usize,
    pub(crate) computed: f64,
    pub(crate) recorded: f64,
    pub(crate) scaled: f64,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Difference { place, field, index, computed, recorded, scaled } = self;
        let comma = if place.is_empty() { "" } else { ", " };
        write!(f, "{place}{comma}{field}[{index}]: ours {computed:?}, theirs {recorded:?} ({scaled:.1e})")
    }
}

/// The result for one aspect of a model.
#[derive(Clone, Debug)]
pub(crate) enum Verdict {
    /// Within the tolerance, with the largest difference.
    Same(f64),
    /// The difference exceeds the tolerance, but not the difference of the library from itself when its start moves by 1e-14
    /// (for one forward pass, when its coordinates change in the last bit): our difference, and the library's own.
    Sensitive(f64, f64),
    /// The library itself fails, with this message.
    Refused(String),
    /// Numbers outside the tolerance, the worst one of each field.
    Differs(Vec<Difference>),
}

impl Verdict {
    pub(crate) fn from_differences(differences: Vec<Difference>, worst: f64) -> Verdict {
        if differences.is_empty() { Verdict::Same(worst) } else { Verdict::Differs(differences) }
    }
}

/// The word in a table.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Verdict::Same(_) => f.write_str("ok"),
            Verdict::Sensitive(..) => f.write_str("sensitive"),
            Verdict::Refused(_) => f.write_str("refused there"),
            Verdict::Differs(list) => {
                let mut fields: Vec<&str> = list.iter().map(|d| d.field.as_str()).collect();
                fields.dedup();
                write!(f, "differs: {}", fields[0])?;
                if fields.len() > 1 { write!(f, " and {} more", fields.len() - 1) } else { Ok(()) }
            }
        }
    }
}

/// The result for a model: a verdict for each aspect, or the reason why it does not load.
pub(crate) type Outcome = Result<Vec<Verdict>, String>;

/// Loads a model and compares it with its recording.
pub(crate) fn compare_with_recording(model: &Path, recording: &Value) -> Outcome {
    let m = compile_unconstrained(model).map_err(|list| reason(&list))?;
    let mut verdicts = vec![compiled(&m, &recording["compiled"]), forward(&m, &recording["forward"])];
    for (path, state) in [("calm", 0), ("trajectories", 1)] {
        for (i, name) in INTEGRATORS.iter().enumerate() {
            let mut m = m.clone();
            *m.edit().opt.integrator = i as i32;
            let start = &recording["forward"][state]["state"];
            verdicts.push(trajectory(&m, start, &recording[path][name], TRAJECTORY));
        }
    }
    Ok(verdicts)
}

/// The first finding of the compiler, on one line.
fn reason(list: &[Finding]) -> String {
    list.first().map_or(String::new(), |d| format!("{}: {}", d.code, d.message))
}

fn compiled(m: &Model, recording: &Value) -> Verdict {
    let d = Data::new(m);
    let mut found = Vec::new();
    let mut worst: f64 = 0.0;
    let parts = [
        ("model", Object::Model, COMPILED),
        ("opt", Object::Option, COMPILED),
        ("stat", Object::Statistic, COMPILED),
        ("single", Object::Model, SINGLE),
    ];
    assert!(objects(&recording["model"]).next().is_some(), "no constant is recorded");
    for (part, object, tolerance) in parts {
        for (field, values) in objects(&recording[part]) {
            let id = named(object, field);
            let (computed, recorded_values) = (list(m, &d, id), numbers(values));
            let [computed, recorded_values] =
                [computed, recorded_values].map(|list| without_order(field, list));
            let scale = largest(&recorded_values).max(COMPILED_ZERO / tolerance);
            worst = worst.max(note(&mut found, "", field, &computed, &recorded_values, scale, tolerance));
        }
    }
    for (kind, recorded_values) in recording["names"].as_object().into_iter().flatten() {
        let recorded_values: Vec<&str> =
            recorded_values.as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        let computed = obj(kind).map_or(&[][..], |o| m.names.of_kind(o));
        if let Some(index) = (0..computed.len().max(recorded_values.len()))
            .find(|&i| computed.get(i).map(String::as_str) != recorded_values.get(i).copied())
        {
            let field = format!(
                "names of {kind} ({:?}, theirs {:?})",
                computed.get(index),
                recorded_values.get(index)
            );
            let number = f64::NAN;
            found.push(Difference {
                place: String::new(),
                field,
                index,
                computed: number,
                recorded: number,
                scaled: number,
            });
        }
    }
    Verdict::from_differences(found, worst)
}

/// The library lists hulls in another order, and splits flat faces with more than three corners differently, so only
/// their vertices are compared.
fn without_order(field: &str, list: Vec<f64>) -> Vec<f64> {
    let mut vertices: Vec<f64> = Vec::new();
    match field {
        "mesh_face" | "mesh_facenormal" => vertices = list,
        "mesh_graph" => {
            // Numbers of vertices and triangles, addresses, vertices, lists of neighbours, triangles.
            let mut rest = list.as_slice();
            while let [n, f, after @ ..] = rest {
                let (n, f) = (*n as usize, *f as usize);
                vertices.extend(after.iter().skip(n).take(n));
                rest = after.get(3 * n + 6 * f..).unwrap_or(&[]);
            }
        }
        _ => return list,
    }
    vertices.sort_by(f64::total_cmp);
    vertices.dedup();
    vertices
}

/// The kind of object with this name in MuJoCo.
fn obj(kind: &str) -> Option<Obj> {
    Some(match kind {
        "body" => Obj::Body,
        "joint" => Obj::Joint,
        "geom" => Obj::Geom,
        "site" => Obj::Site,
        "camera" => Obj::Camera,
        "light" => Obj::Light,
        "mesh" => Obj::Mesh,
        "skin" => Obj::Skin,
        "hfield" => Obj::HField,
        "texture" => Obj::Texture,
        "material" => Obj::Material,
        "pair" => Obj::Pair,
        "exclude" => Obj::Exclude,
        "equality" => Obj::Equality,
        "tendon" => Obj::Tendon,
        "actuator" => Obj::Actuator,
        "sensor" => Obj::Sensor,
        "numeric" => Obj::Numeric,
        "text" => Obj::Text,
        "tuple" => Obj::Tuple,
        "key" => Obj::Key,
        _ => return None,
    })
}

/// How far our run may be outside the spread of sixteen runs of the library. If our run had the same distribution, it would be
/// the farthest in one case of seventeen, and twice as far very rarely. This applies only if the library differs from itself by
/// more than the tolerance.
const SPREAD: f64 = 2.0;

/// Follows a recorded trajectory from its start.
pub(crate) fn trajectory(m: &Model, start: &Value, recording: &Value, tolerance: f64) -> Verdict {
    if let Some(message) = recording["refused"].as_str() {
        return Verdict::Refused(message.into());
    }
    let mut d = Data::new(m);
    set(m, &mut d, start);
    let every = recording["every"].as_u64().unwrap_or(1);
    let spread = numbers(&recording["spread"]);
    let mut worst: f64 = 0.0;
    assert!(recording["rows"].as_array().is_some_and(|list| !list.is_empty()), "no step is recorded");
    for (k, row) in recording["rows"].as_array().into_iter().flatten().enumerate() {
        (0..every).for_each(|_| core::step(m, &mut d).unwrap());
        let place = format!("step {}", every * (k as u64 + 1));
        let mut found = Vec::new();
        let mut difference: f64 = 0.0;
        for (field, values) in objects(row) {
            let id = named(Object::Data, field);
            let (computed, recorded_values) = (list(m, &d, id), numbers(values));
            let scale = largest(&recorded_values).max(1.0);
            difference = difference.max(note(
                &mut found,
                &place,
                field,
                &computed,
                &recorded_values,
                scale,
                tolerance,
            ));
        }
        if !found.is_empty() {
            // Later differences follow from the first one.
            return if difference <= SPREAD * spread[k] {
                Verdict::Sensitive(difference, spread[k])
            } else {
                Verdict::Differs(found)
            };
        }
        worst = worst.max(difference);
    }
    Verdict::from_differences(warnings(&d, &recording["warnings"]), worst)
}

/// Warnings with a different count.
fn warnings(d: &Data, recording: &Value) -> Vec<Difference> {
    let count = |w: Warning| {
        let mut named =
            objects(recording).filter(|(name, _)| name.to_lowercase() == format!("mjwarn_{}", w.name()));
        named.find_map(|(_, n)| n.as_f64()).unwrap_or(0.0)
    };
    let mut found = Vec::new();
    for (w, stat) in Warning::ALL.into_iter().zip(&d.warning) {
        let (computed, recorded_values) = ([stat.number as f64], [count(w)]);
        note(&mut found, "the end", &format!("warning {}", w.name()), &computed, &recorded_values, 1.0, 0.0);
    }
    found
}

/// Sets the data to a recorded state.
pub(crate) fn set(m: &Model, d: &mut Data, state: &Value) {
    start(m, d);
    // Only data are written, but reflection requires both.
    let mut m = m.clone();
    for (field, values) in objects(state) {
        let id = named(Object::Data, field);
        for (i, x) in numbers(values).into_iter().enumerate() {
            // A model that was compiled to other sizes is reported elsewhere.
            core::view_mut(&mut m, d, id).unwrap().set(i, x);
        }
    }
}

/// Sets the first keyframe, or the default configuration.
pub(crate) fn start(m: &Model, d: &mut Data) {
    match m.keys().next() {
        Some(key) => core::reset_data_keyframe(m, d, key).unwrap(),
        None => core::reset_data(m, d).unwrap(),
    }
}

/// The field of a recording. A field that we do not have is a failure, because it would otherwise not be compared.
pub(crate) fn named(object: Object, name: &str) -> FieldId {
    reflect::field(object, name)
        .unwrap_or_else(|| panic!("the recording has `{name}`, which is no field here"))
}

/// All numbers of a field.
pub(crate) fn list<S: Scope>(m: &Model, d: &Data<S>, field: FieldId) -> Vec<f64> {
    let view = core::view(m, d, field).unwrap();
    (0..view.len()).filter_map(|i| view.get(i)).collect()
}

/// The members of an object; empty if the value is not an object.
pub(crate) fn objects(value: &Value) -> impl Iterator<Item = (&String, &Value)> {
    value.as_object().into_iter().flat_map(Map::iter)
}

pub(crate) fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |s, x| s.max(x.abs()))
}

/// The index of the largest difference, and that difference divided by `scale`; infinite if the lengths
/// differ or a number is NaN.
pub(crate) fn worst(computed: &[f64], recorded: &[f64], scale: f64) -> (usize, f64) {
    if computed.len() != recorded.len() {
        return (computed.len().min(recorded.len()), f64::INFINITY);
    }
    let mut at = (0, 0.0);
    for (i, (a, b)) in computed.iter().zip(recorded).enumerate() {
        let scaled = ((a - b) / scale).abs();
        let scaled = if scaled.is_nan() && !(a.is_nan() && b.is_nan()) { f64::INFINITY } else { scaled };
        if scaled > at.1 {
            at = (i, scaled);
        }
    }
    at
}

/// Adds the worst difference of a field if it exceeds the tolerance, and returns it.
pub(crate) fn note(
    found: &mut Vec<Difference>,
    place: &str,
    field: &str,
    computed: &[f64],
    recorded_values: &[f64],
    scale: f64,
    tolerance: f64,
) -> f64 {
    let (index, scaled) = worst(computed, recorded_values, scale);
    if scaled > tolerance {
        let number = |list: &[f64]| list.get(index).copied().unwrap_or(f64::NAN);
        let (place, field) = (place.to_string(), field.to_string());
        found.push(Difference {
            place,
            field,
            index,
            computed: number(computed),
            recorded: number(recorded_values),
            scaled,
        });
    }
    scaled
}
