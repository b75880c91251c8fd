//! The one table of functions that programs may call: signature, effects, documentation, and what they do.

use super::World;
use super::handle::{self, Side};
use labspec_core::reflect::{self, FieldId, Kind, Object, Stage};
use labspec_core::{self as core, Obj};
use labspec_expr::{FieldKey, FunctionId, FunctionInfo, Heap, Param, Touch, Type, Value};

/// The objects that hold functions.
pub(super) const OBJECTS: [&str; 3] = ["mj", "sim", "lib"];

/// Where a function may be called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// In labs and in measures.
    Everywhere,
    /// In the measures of `verify` only: no page knows it.
    Measures,
}

/// What a parameter takes, before it is known which model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arg {
    Model,
    Data,
    Number,
    /// The name of an object of this kind.
    Name(Obj),
    /// A sub-program of an aggregate.
    Lazy,
}

/// What a function touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Touches {
    Nothing,
    /// The derived fields of the data.
    Derived,
    /// The state and inputs.
    State,
    /// The coordinates.
    Coordinates,
    /// Contacts and their forces.
    Contacts,
}

/// A row of the table.
pub(super) struct Function {
    /// The object that holds it; empty for a function by its own name.
    pub(super) object: &'static str,
    pub(super) name: &'static str,
    pub(super) args: &'static [Arg],
    pub(super) optional: usize,
    pub(super) returns: Type,
    pub(super) reads: Touches,
    pub(super) writes: &'static [Touches],
    pub(super) place: Place,
    pub(super) aggregate: bool,
    pub(super) doc: &'static str,
    pub(super) run: fn(&mut World, &mut Heap, &[Value]) -> Result<Value, String>,
}

/// Of no function: what the rows below do not say.
pub(super) const ROW: Function = Function {
    object: "",
    name: "",
    args: &[],
    optional: 0,
    returns: Type::Number,
    reads: Touches::Nothing,
    writes: &[],
    place: Place::Everywhere,
    aggregate: false,
    doc: "",
    run: |_, _, _| NOTHING,
};

/// A function of `mj` that takes the model and the data.
const ENGINE: Function =
    Function { object: "mj", args: &[Arg::Model, Arg::Data], returns: Type::Void, ..ROW };
/// A function over all samples of a run; what it makes of them is in [`crate::verify`].
const OVER_RUN: Function = Function { args: &[Arg::Lazy], place: Place::Measures, aggregate: true, ..ROW };

/// All functions. Their place in this list is their id.
pub(super) static TABLE: &[Function] = &[
    Function {
        name: "mj_setConst",
        writes: &[Touches::Coordinates, Touches::Derived],
        doc: "recomputes the constants that follow from masses, inertias and poses; puts qpos back to the start",
        run: |w, _, _| {
            core::set_const(&mut w.model, &mut w.data);
            NOTHING
        },
        ..ENGINE
    },
    Function {
        name: "mj_forward",
        writes: &[Touches::Derived],
        doc: "computes every derived field from the state, without advancing time",
        run: |w, _, _| {
            core::forward(&w.model, &mut w.data);
            NOTHING
        },
        ..ENGINE
    },
    Function {
        name: "mj_step",
        writes: &[Touches::State, Touches::Derived],
        doc: "advances the simulation by one step",
        run: |w, _, _| {
            core::step(&w.model, &mut w.data);
            NOTHING
        },
        ..ENGINE
    },
    Function {
        name: "mj_resetData",
        writes: &[Touches::State, Touches::Derived],
        doc: "puts the data back to the default configuration",
        run: |w, _, _| {
            core::reset_data(&w.model, &mut w.data);
            NOTHING
        },
        ..ENGINE
    },
    Function {
        name: "mj_resetDataKeyframe",
        args: &[Arg::Model, Arg::Data, Arg::Number],
        writes: &[Touches::State, Touches::Derived],
        doc: "puts the data back to a keyframe, counted from 0",
        run: |w, _, args| {
            let key = args.first().map_or(0.0, Value::to_number);
            if !(key >= 0.0 && key < w.model.nkey as f64) {
                return Err(format!("there is no keyframe {key}: the model has {}", w.model.nkey));
            }
            core::reset_data_keyframe(&w.model, &mut w.data, key as usize);
            NOTHING
        },
        ..ENGINE
    },
    Function {
        object: "lib",
        name: "bodyId",
        args: &[Arg::Name(Obj::Body)],
        doc: "index of a body",
        run: |_, _, args| index(args).map(|i| Value::Number(i as f64)),
        ..ROW
    },
    Function {
        object: "lib",
        name: "jointId",
        args: &[Arg::Name(Obj::Joint)],
        doc: "index of a joint",
        run: |_, _, args| index(args).map(|i| Value::Number(i as f64)),
        ..ROW
    },
    Function {
        object: "lib",
        name: "qpos",
        args: &[Arg::Name(Obj::Joint)],
        reads: Touches::State,
        doc: "first coordinate of a joint",
        run: |w, _, args| {
            let q = w.model.jnt_qposadr.get(index(args)?).map_or(0, |&a| a as usize);
            Ok(w.data.qpos.get(q).map_or(Value::Undefined, |&x| Value::Number(x)))
        },
        ..ROW
    },
    Function {
        object: "lib",
        name: "normalForce",
        args: &[Arg::Name(Obj::Geom)],
        optional: 1,
        reads: Touches::Contacts,
        doc: "normal force in N, summed over all contacts, or over those of one geom",
        run: |w, _, args| {
            let geom = if args.is_empty() { None } else { Some(index(args)?) };
            let touching = |c: &&core::Contact| geom.is_none_or(|g| c.geom1 == g || c.geom2 == g);
            let forces =
                w.data.contact.iter().filter(touching).map(|c| core::contact_force(&w.model, &w.data, c)[0]);
            // JavaScript's reduce starts from 0, not from -0.
            Ok(Value::Number(forces.fold(0.0, |sum, f| sum + f)))
        },
        ..ROW
    },
    Function {
        object: "lib",
        name: "deg",
        args: &[Arg::Number],
        doc: "radians to degrees",
        run: |_, _, args| number(args).map(|x| Value::Number(x * 180.0 / std::f64::consts::PI)),
        ..ROW
    },
    Function {
        object: "lib",
        name: "rad",
        args: &[Arg::Number],
        doc: "degrees to radians",
        run: |_, _, args| number(args).map(|x| Value::Number(x * std::f64::consts::PI / 180.0)),
        ..ROW
    },
    Function {
        name: "contact",
        args: &[Arg::Name(Obj::Geom), Arg::Name(Obj::Geom)],
        optional: 1,
        returns: Type::Boolean,
        reads: Touches::Contacts,
        place: Place::Measures,
        doc: "whether two geoms are in contact, or whether one touches anything",
        run: |w, _, args| {
            let (a, b) = (index(args)?, args.get(1).map(|v| handle::index_of(v.to_number())));
            let touch = |c: &core::Contact| {
                let pair = [c.geom1, c.geom2];
                pair.contains(&a) && b.is_none_or(|b| b != a && pair.contains(&b))
            };
            Ok(Value::Boolean(w.data.contact.iter().any(touch)))
        },
        ..ROW
    },
    Function {
        name: "abs",
        args: &[Arg::Number],
        place: Place::Measures,
        doc: "magnitude",
        run: |_, _, args| number(args).map(|x| Value::Number(x.abs())),
        ..ROW
    },
    Function {
        name: "first",
        doc: "time in s of the first sample at which a condition holds; NaN if it never does",
        ..OVER_RUN
    },
    Function {
        name: "at",
        args: &[Arg::Lazy, Arg::Lazy],
        doc: "at(condition, x): x at the first sample at which the condition holds; NaN if it never does",
        ..OVER_RUN
    },
    Function {
        name: "before",
        args: &[Arg::Lazy, Arg::Lazy],
        doc: "before(condition, x): x at the sample just before the condition first holds; NaN if there is none",
        ..OVER_RUN
    },
    Function { name: "initial", doc: "value at the first sample", ..OVER_RUN },
    Function { name: "final", doc: "value at the last sample", ..OVER_RUN },
    Function { name: "min", doc: "smallest value over the run", ..OVER_RUN },
    Function { name: "max", doc: "largest value over the run", ..OVER_RUN },
];

/// The result of a function that gives nothing back.
const NOTHING: Result<Value, String> = Ok(Value::Undefined);

/// The first argument, the name of an object, as its index.
fn index(args: &[Value]) -> Result<usize, String> {
    args.first().map(|v| handle::index_of(v.to_number())).ok_or_else(|| "a name is missing".into())
}

fn number(args: &[Value]) -> Result<f64, String> {
    args.first().map(Value::to_number).ok_or_else(|| "a number is missing".into())
}

/// Signature and effects in the words of the language.
pub(super) fn info(f: &Function) -> FunctionInfo {
    let param = |arg: &Arg| match arg {
        Arg::Model => Param::Object(handle::encode(handle::Thing::Struct(Object::Model))),
        Arg::Data => Param::Object(handle::encode(handle::Thing::Struct(Object::Data))),
        Arg::Number => Param::Number,
        Arg::Name(kind) => Param::Name(handle::collection(Side::Data, *kind)),
        Arg::Lazy => Param::Lazy,
    };
    FunctionInfo {
        name: path(f),
        params: f.args.iter().map(param).collect(),
        optional: f.optional,
        implied: f.name == "mj_setConst",
        returns: f.returns,
        members: Vec::new(),
        length: None,
        aggregate: f.aggregate,
        reads: touch(&[f.reads]),
        writes: touch(f.writes),
        doc: f.doc.to_string(),
    }
}

/// How an author writes it.
fn path(f: &Function) -> String {
    if f.object.is_empty() { f.name.to_string() } else { format!("{}.{}", f.object, f.name) }
}

fn touch(touches: &[Touches]) -> Touch {
    let is = |f: &FieldId, t: &Touches| {
        let i = f.info();
        match t {
            Touches::Nothing => false,
            Touches::Derived => i.kind == Kind::Derived,
            Touches::State => i.object == Object::Data && matches!(i.kind, Kind::State | Kind::Input),
            Touches::Coordinates => i.object == Object::Data && i.name == "qpos",
            Touches::Contacts => i.stage == Stage::Collision || i.name == "efc_force",
        }
    };
    let fields: Vec<FieldKey> = reflect::fields()
        .filter(|f| touches.iter().any(|t| is(f, t)))
        .map(|f| FieldKey(u32::from(f.0)))
        .collect();
    if fields.is_empty() { Touch::Nothing } else { Touch::Fields(fields) }
}

/// The name of a function, without what holds it.
pub(crate) fn name(FunctionId(f): FunctionId) -> Option<&'static str> {
    TABLE.get(f as usize).map(|f| f.name)
}

/// A function as the reference shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionDoc {
    /// Name and parameters.
    pub signature: String,
    /// One line.
    pub doc: &'static str,
    /// Only in the measures of `verify`.
    pub measure: bool,
}

/// Every function, in the order of the table.
pub fn reference() -> Vec<FunctionDoc> {
    let word = |arg: &Arg| match arg {
        Arg::Model => "model",
        Arg::Data => "data",
        Arg::Number => "x",
        Arg::Name(_) => "name",
        Arg::Lazy => "expression",
    };
    let one = |f: &Function| {
        let args: Vec<_> = f.args.iter().map(word).collect();
        FunctionDoc {
            signature: format!("{}({})", path(f), args.join(", ")),
            doc: f.doc,
            measure: f.place == Place::Measures,
        }
    };
    TABLE.iter().map(one).collect()
}
