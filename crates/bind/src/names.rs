//! What names mean: the language's [`Schema`] over the engine's field table and one model.

use super::Functions;
use super::elements;
use super::enums::ENUMS;
use super::functions::{self, OBJECTS, Place, TABLE};
use super::handle::{self, KINDS, Side, Thing};
use super::measures;
use super::shown::{LABELS, Shown};
use super::words::WORDS;
use labspec_core::reflect::{self, FieldId, Kind, Object, Stage, data, model, option};
use labspec_core::{Model, Obj};
use labspec_expr::dimension::Measure;
use labspec_expr::{
    CollectionId, Elem, Entry, Field, FieldKey, FieldKind, FunctionId, FunctionInfo, HostTerms, ObjectId,
    ResultDimension, Role, Schema, Value,
};

/// Where a program stands: decides which functions exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// In a lab: what the page knows.
    Lab,
    /// In a measure of `verify`: also aggregates over a run.
    Measure,
    /// In what `verify` claims of several runs: what takes their numbers together, and nothing else.
    Claim,
}

/// The names of a model, for the compiler of the language.
#[derive(Clone, Copy, Debug)]
pub struct ModelNames<'m> {
    /// The model.
    pub model: &'m Model,
    /// Where the program stands.
    pub scope: Scope,
    /// Functions of the embedding program, if it has any.
    own: Option<&'m Functions>,
    /// What is shown under labels, where something is.
    shown: Option<&'m Shown>,
}

/// Whether a name at the start of an expression has a meaning, whatever the model.
pub(crate) fn is_taken(name: &str) -> bool {
    ["model", "data", "mj_setConst"].contains(&name)
        || OBJECTS.contains(&name)
        || TABLE.iter().any(|f| f.object.is_empty() && f.name == name)
}

impl<'m> ModelNames<'m> {
    /// The names of a model.
    pub fn new(model: &'m Model, scope: Scope) -> ModelNames<'m> {
        ModelNames { model, scope, own: None, shown: None }
    }

    /// The same with functions of the embedding program.
    pub fn with(self, own: &'m Functions) -> ModelNames<'m> {
        ModelNames { own: Some(own), ..self }
    }

    /// The same with what is shown under labels.
    pub fn showing(self, shown: &'m Shown) -> ModelNames<'m> {
        ModelNames { shown: Some(shown), ..self }
    }
}

impl ModelNames<'_> {
    fn functions(&self) -> impl Iterator<Item = (usize, &'static functions::Function)> {
        let scope = self.scope;
        TABLE.iter().copied().enumerate().filter(move |(_, f)| match f.place {
            Place::Everywhere => scope != Scope::Claim,
            Place::Measures => scope == Scope::Measure || (scope == Scope::Claim && f.name == "abs"),
            Place::Claims => scope == Scope::Claim,
        })
    }

    /// A function by its holder and name.
    fn function_of(&self, object: &str, name: &str) -> Option<Entry> {
        let found = self.functions().find(|(_, f)| f.object == object && f.name == name);
        found.map(|(i, _)| Entry::Function(FunctionId(i as u32)))
    }

    /// A whole field.
    fn whole(&self, f: FieldId, path: String) -> Field {
        let shape = reflect::shape(self.model, f);
        let owner = owner(f, &shape);
        field(f, path, 0, shape, owner)
    }

    /// The fields of one object, with the name that they have there.
    fn rows(
        &self,
        side: Side,
        kind: Obj,
        index: usize,
    ) -> impl Iterator<Item = (String, FieldId, usize, usize)> + '_ {
        let objects = match side {
            Side::Model => Object::Model,
            Side::Data => Object::Data,
        };
        reflect::fields().filter(move |f| f.info().object == objects).filter_map(move |f| {
            let (first, count) = elements::row(self.model, f, kind, index)?;
            Some((short_name(f.info().name).to_string(), f, first, count))
        })
    }

    fn named_member(&self, side: Side, kind: Obj, index: usize, name: &str) -> Option<Entry> {
        match name {
            "id" => return Some(Entry::Constant(Value::Number(index as f64))),
            "name" => {
                return Some(Entry::Constant(Value::String(
                    self.model.names.of(kind).get(index)?.as_str().into(),
                )));
            }
            _ => {}
        }
        // `data.sensor("x").data`, as in MuJoCo's bindings.
        let wanted = if kind == Obj::Sensor && name == "data" { "sensordata" } else { name };
        let (_, f, first, count) =
            self.rows(side, kind, index).find(|(short, f, ..)| short == wanted || f.info().name == wanted)?;
        let holder = self.describe(handle::encode(Thing::Named(side, kind, index)));
        let path = format!("{}.{name}", self.path(side, kind, index));
        Some(Entry::Field(field(f, path, first, vec![Some(count)], format!("{holder} has {count} of these"))))
    }

    /// How an author writes an object: `data.joint("hinge")`.
    fn path(&self, side: Side, kind: Obj, index: usize) -> String {
        let holder = if side == Side::Data { "data" } else { "model" };
        let name = self.model.names.of(kind).get(index).map_or("", String::as_str);
        format!("{holder}.{}(\"{name}\")", noun(kind))
    }

    fn struct_fields(object: Object) -> impl Iterator<Item = FieldId> {
        reflect::fields().filter(move |f| f.info().object == object)
    }
}

/// The name of a field in a named object: without the prefix that says what it belongs to.
fn short_name(name: &str) -> &str {
    const PREFIXES: [&str; 22] = [
        "body_",
        "jnt_",
        "dof_",
        "geom_",
        "site_",
        "cam_",
        "light_",
        "mesh_",
        "hfield_",
        "tex_",
        "mat_",
        "pair_",
        "exclude_",
        "eq_",
        "tendon_",
        "ten_",
        "actuator_",
        "sensor_",
        "numeric_",
        "text_",
        "tuple_",
        "key_",
    ];
    PREFIXES.iter().find_map(|p| name.strip_prefix(p)).unwrap_or(name)
}

/// How a field of the table is written for one object that has a name: `data.joint('…').qpos`; `None` when it has no
/// rows of one kind of object.
pub fn named_field(f: FieldId) -> Option<String> {
    let (object, name, dim) = (f.info().object, f.info().name, f.rows()?);
    let holder = match object {
        Object::Model => "model",
        Object::Data => "data",
        _ => return None,
    };
    let (kind, _) = KINDS.iter().find(|(kind, _)| elements::has_rows(*kind, dim))?;
    Some(format!("{holder}.{}('…').{}", noun(*kind), member_name(object, name, *kind)))
}

/// What a field is called in a named object: in short, unless that means a field before it (`dof_solref` of a joint).
fn member_name(object: Object, name: &'static str, kind: Obj) -> &'static str {
    if name == "sensordata" {
        return "data";
    }
    let short = short_name(name);
    let has = |f: &FieldId| f.rows().is_some_and(|dim| elements::has_rows(kind, dim));
    let all = reflect::fields().filter(|f| f.info().object == object && short_name(f.info().name) == short);
    let first = all.filter(has).map(|f| f.info().name).next();
    if first.is_none_or(|f| f == name) { short } else { name }
}

fn noun(kind: Obj) -> &'static str {
    KINDS.iter().find(|(k, _)| *k == kind).map_or("object", |(_, noun)| noun)
}

fn field(f: FieldId, path: String, first: usize, shape: Vec<Option<usize>>, owner: String) -> Field {
    let info = f.info();
    let kind = match info.kind {
        Kind::Structure => FieldKind::Structure,
        Kind::State => FieldKind::State,
        Kind::Input => FieldKind::Input,
        Kind::Constant => FieldKind::Constant,
        Kind::Inertial => FieldKind::Inertial,
        Kind::Derived => FieldKind::Derived { by: stage_phrase(info.stage).into() },
    };
    Field {
        key: FieldKey(f.index() as u32),
        path,
        first,
        shape,
        kind,
        elem: match info.elem {
            reflect::Elem::F64 => Elem::Double,
            reflect::Elem::I32 | reflect::Elem::Size => Elem::Int,
            reflect::Elem::Bool => Elem::Byte,
        },
        unit: f.unit().into(),
        doc: f.doc().into(),
        owner,
    }
}

/// What computes a field, as the object of "computed by".
fn stage_phrase(stage: Stage) -> &'static str {
    match stage {
        Stage::Compile => "the model compiler",
        Stage::SetConst => "mj_setConst",
        Stage::User => "nothing",
        Stage::Kinematics
        | Stage::Orientations
        | Stage::GeomPoses
        | Stage::SitePoses
        | Stage::CameraPoses => "forward kinematics, inside mj_step and mj_forward",
        Stage::ComPos | Stage::ComVel => "the centre-of-mass stage, inside mj_step and mj_forward",
        Stage::MassMatrix | Stage::Factor => "the mass-matrix stage, inside mj_step and mj_forward",
        Stage::Tendon | Stage::TendonVel => "the tendon stage, inside mj_step and mj_forward",
        Stage::Transmission | Stage::ActuatorVel | Stage::Actuation => {
            "the actuation stage, inside mj_step and mj_forward"
        }
        Stage::Collision => "collision detection, inside mj_step and mj_forward",
        Stage::Constraint | Stage::Reference => "the constraint stage, inside mj_step and mj_forward",
        Stage::Passive => "the passive-force stage, inside mj_step and mj_forward",
        Stage::Bias => "recursive Newton–Euler, inside mj_step and mj_forward",
        Stage::Acceleration => "the acceleration stage, inside mj_step and mj_forward",
        Stage::Solve => "the constraint solver, inside mj_step and mj_forward",
        Stage::SubtreeVel => "mj_subtreeVel, which mj_step and mj_forward call when a sensor needs it",
        Stage::RnePost => "mj_rnePostConstraint, which mj_step and mj_forward call when a sensor needs it",
        Stage::Inverse => "mj_inverse",
        Stage::Sleep => "the sleep stage, inside mj_step and mj_forward",
        Stage::Sensors => "the sensor stage, inside mj_step and mj_forward",
        Stage::Energy => "the energy stage, inside mj_step and mj_forward",
    }
}

/// Whose index it is, in a sentence.
fn owner(f: FieldId, shape: &[Option<usize>]) -> String {
    let (Some(rows), Some(Some(count))) = (f.rows(), shape.first()) else { return String::new() };
    let things = match rows {
        model::nq => "coordinates (nq)",
        model::nv => "degrees of freedom (nv)",
        model::nu => "controls (nu)",
        model::na => "activations (na)",
        model::nbody => "bodies (nbody, the world is body 0)",
        model::njnt => "joints (njnt)",
        model::ngeom => "geoms (ngeom)",
        model::nsite => "sites (nsite)",
        model::nmocap => "mocap bodies (nmocap)",
        model::nkey => "keyframes (nkey)",
        model::ncam => "cameras (ncam)",
        model::nlight => "lights (nlight)",
        model::nactuator => "actuators (nactuator)",
        model::nout => "force outputs of actuators (nout)",
        model::nmesh => "meshes (nmesh)",
        model::nwrap => "objects on tendon paths (nwrap)",
        model::npair => "contact pairs (npair)",
        model::nsensor => "sensors (nsensor)",
        model::nsensordata => "sensor values (nsensordata)",
        model::ntendon => "tendons (ntendon)",
        model::neq => "equality constraints (neq)",
        _ => return String::new(),
    };
    let each: usize = shape.iter().skip(1).map(|d| d.unwrap_or(1)).product();
    let width = if shape.len() > 1 { format!(" with {each} numbers each") } else { String::new() };
    format!("the model has {count} {things}{width}")
}

impl Schema for ModelNames<'_> {
    fn identity(&self) -> u64 {
        self.model.identity()
    }

    fn root(&self, name: &str) -> Option<Entry> {
        match name {
            "model" => Some(Entry::Object(handle::encode(Thing::Struct(Object::Model)))),
            "data" => Some(Entry::Object(handle::encode(Thing::Struct(Object::Data)))),
            // The shorthand of the lab format.
            "mj_setConst" => self.function_of("mj", name),
            _ => match OBJECTS.iter().position(|o| *o == name) {
                Some(i) => Some(Entry::Object(handle::encode(Thing::Functions(i)))),
                None => self.function_of("", name).or_else(|| {
                    let own = self.own?.find(name)?;
                    Some(Entry::Function(FunctionId((TABLE.len() + own) as u32)))
                }),
            },
        }
    }

    fn root_names(&self) -> Vec<String> {
        let own = self.functions().filter(|(_, f)| f.object.is_empty()).map(|(_, f)| f.name);
        ["model", "data"]
            .into_iter()
            .chain(OBJECTS)
            .chain(["mj_setConst"])
            .chain(own)
            .chain(self.own.into_iter().flat_map(Functions::names))
            .map(String::from)
            .collect()
    }

    fn member(&self, object: ObjectId, name: &str) -> Option<Entry> {
        match handle::decode(object)? {
            Thing::Struct(of) => {
                if of == Object::Model {
                    match name {
                        "opt" => return Some(Entry::Object(handle::encode(Thing::Struct(Object::Option)))),
                        "stat" => {
                            return Some(Entry::Object(handle::encode(Thing::Struct(Object::Statistic))));
                        }
                        _ => {}
                    }
                }
                let side = match of {
                    Object::Model => Some(Side::Model),
                    Object::Data => Some(Side::Data),
                    _ => None,
                };
                // A field of the name comes first, as in `data.contact`.
                if let (Some(side), Some(kind), None) =
                    (side, handle::kind_of(name), reflect::field(of, name))
                {
                    return Some(Entry::Collection(handle::collection(side, kind)));
                }
                let f = reflect::field(of, name)?;
                Some(Entry::Field(self.whole(f, format!("{}.{name}", self.describe(object)))))
            }
            Thing::Functions(i) => {
                let holder = OBJECTS.get(i)?;
                match (*holder, name) {
                    ("sim", "time") => Some(Entry::Field(self.whole(data::time, "sim.time".into()))),
                    ("sim", "timestep") => {
                        Some(Entry::Field(self.whole(option::timestep, "sim.timestep".into())))
                    }
                    ("mj", _) if name.starts_with("mjt") => {
                        let i = ENUMS.iter().position(|(n, _)| *n == name)?;
                        Some(Entry::Object(handle::encode(Thing::Enum(i))))
                    }
                    _ => self.function_of(holder, name),
                }
            }
            Thing::Enum(i) => {
                let (_, members) = ENUMS.get(i)?;
                let j = members.iter().position(|(n, _)| *n == name)?;
                Some(Entry::Object(handle::encode(Thing::Member(i, j))))
            }
            Thing::Member(i, j) => {
                let (_, number) = ENUMS.get(i)?.1.get(j)?;
                (name == "value").then_some(Entry::Constant(Value::Number(*number as f64)))
            }
            Thing::Named(side, kind, index) => self.named_member(side, kind, index, name),
        }
    }

    fn member_names(&self, object: ObjectId) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        match handle::decode(object) {
            Some(Thing::Struct(of)) => {
                names.extend(Self::struct_fields(of).map(|f| f.info().name.to_string()));
                if of == Object::Model {
                    names.extend(["opt".into(), "stat".into()]);
                }
                if matches!(of, Object::Model | Object::Data) {
                    names.extend(KINDS.iter().map(|(_, noun)| noun.to_string()));
                }
            }
            Some(Thing::Functions(i)) => {
                let holder = OBJECTS.get(i).copied().unwrap_or("");
                names.extend(
                    self.functions().filter(|(_, f)| f.object == holder).map(|(_, f)| f.name.to_string()),
                );
                if holder == "sim" {
                    names.extend(["time".into(), "timestep".into()]);
                }
            }
            Some(Thing::Enum(i)) => {
                let members = ENUMS.get(i).map_or(&[][..], |(_, members)| members);
                names.extend(members.iter().map(|(n, _)| n.to_string()));
            }
            Some(Thing::Member(..)) => names.push("value".into()),
            Some(Thing::Named(side, kind, index)) => {
                names.extend(["id".into(), "name".into()]);
                names.extend(self.rows(side, kind, index).map(|(short, ..)| short));
            }
            None => {}
        }
        names
    }

    fn describe(&self, object: ObjectId) -> String {
        match handle::decode(object) {
            Some(Thing::Struct(Object::Model)) => "model".into(),
            Some(Thing::Struct(Object::Option)) => "model.opt".into(),
            Some(Thing::Struct(Object::Statistic)) => "model.stat".into(),
            Some(Thing::Struct(Object::Data)) => "data".into(),
            Some(Thing::Functions(i)) => OBJECTS.get(i).copied().unwrap_or("").into(),
            Some(Thing::Enum(i)) => format!("mj.{}", ENUMS.get(i).map_or("", |(n, _)| n)),
            Some(Thing::Member(i, j)) => {
                let (holder, members) = ENUMS.get(i).copied().unwrap_or(("", &[]));
                format!("mj.{holder}.{}", members.get(j).map_or("", |(n, _)| n))
            }
            Some(Thing::Named(_, kind, index)) => {
                let name = self.model.names.of(kind).get(index).map_or("", String::as_str);
                format!("the {} \"{name}\"", noun(kind))
            }
            None => String::new(),
        }
    }

    fn lookup(&self, collection: CollectionId, name: &str) -> Option<ObjectId> {
        if collection == LABELS {
            return self.shown?.find(name);
        }
        let (side, kind, _) = handle::of_collection(collection)?;
        self.model.names.id(kind, name).map(|i| handle::encode(Thing::Named(side, kind, i)))
    }

    fn names(&self, collection: CollectionId) -> Vec<String> {
        if collection == LABELS {
            return self.shown.map_or(Vec::new(), |shown| shown.labels().to_vec());
        }
        let Some((_, kind, _)) = handle::of_collection(collection) else { return Vec::new() };
        self.model.names.of(kind).iter().filter(|n| !n.is_empty()).cloned().collect()
    }

    fn noun(&self, collection: CollectionId) -> &str {
        if collection == LABELS {
            return "readout or trace";
        }
        handle::of_collection(collection).map_or("object", |(_, _, noun)| noun)
    }

    fn element_help(&self, FieldKey(f): FieldKey, index: usize) -> Option<String> {
        elements::help(self.model, FieldId::new(f as usize)?, index)
    }

    fn gives(&self, FunctionId(f): FunctionId, first: Option<f64>) -> ResultDimension {
        let label = || self.shown?.measure(handle::index_of(first?));
        match TABLE.get(f as usize) {
            Some(row) if row.name == "shown" => {
                label().map_or(ResultDimension::Unknown, ResultDimension::This)
            }
            _ => self.function(FunctionId(f)).gives,
        }
    }

    fn measure(&self, FieldKey(f): FieldKey, first: usize, count: Option<usize>) -> Measure {
        FieldId::new(f as usize)
            .map_or(Measure::Unknown, |field| measures::measure(self.model, field, first, count))
    }

    fn role(&self, FieldKey(f): FieldKey, index: usize) -> Role {
        FieldId::new(f as usize).map_or(Role::default(), |field| elements::role(self.model, field, index))
    }

    fn named_element(&self, FieldKey(f): FieldKey, index: usize) -> Option<String> {
        let field = FieldId::new(f as usize)?;
        let side = match field.info().object {
            Object::Model => Side::Model,
            Object::Data => Side::Data,
            _ => return None,
        };
        let (kind, object) = elements::owner(self.model, field, index)?;
        let (first, _) = elements::row(self.model, field, kind, object)?;
        // A name that needs escapes is not worth it.
        let plain = |n: &&String| !n.is_empty() && !n.contains(['\'', '\\']) && !n.contains(char::is_control);
        let name = self.model.names.of(kind).get(object).filter(plain)?;
        let short = member_name(field.info().object, field.info().name, kind);
        let holder = if side == Side::Data { "data" } else { "model" };
        // In single quotes, which need no escapes in the JSON of a lab.
        Some(format!("{holder}.{}('{name}').{short}[{}]", noun(kind), index - first))
    }

    fn result_field(&self, FunctionId(i): FunctionId, object: ObjectId) -> Option<Field> {
        let (f, kind) = TABLE.get(i as usize)?.gives?;
        let Some(Thing::Named(_, of, index)) = handle::decode(object) else { return None };
        let (first, count) = elements::row(self.model, f, kind, index).filter(|_| of == kind)?;
        let path = format!("{}.{}", self.path(Side::Data, kind, index), short_name(f.info().name));
        Some(field(f, path, first, vec![Some(count)], format!("a position has {count} of these")))
    }

    fn function(&self, FunctionId(i): FunctionId) -> FunctionInfo {
        let at = i as usize;
        let own = || self.own?.info(at.checked_sub(TABLE.len())?);
        functions::INFO.get(at).cloned().or_else(own).unwrap_or_else(functions::none)
    }

    fn hint(&self, object: ObjectId, name: &str) -> Option<String> {
        let here = match handle::decode(object)? {
            Thing::Struct(of) => of,
            Thing::Functions(_) if name.starts_with("mj_") => {
                return Some(format!("`{name}` is a function of MuJoCo that labspec does not offer yet"));
            }
            _ => return None,
        };
        let elsewhere = [Object::Model, Object::Option, Object::Data, Object::Statistic]
            .into_iter()
            .find(|&of| of != here && reflect::field(of, name).is_some())?;
        let holder = self.describe(handle::encode(Thing::Struct(elsewhere)));
        Some(format!("`{name}` belongs to {holder}: write `{holder}.{name}`"))
    }

    fn host_terms(&self) -> &'static HostTerms {
        &WORDS
    }

    fn refresh(&self) -> Option<String> {
        Some("mj.mj_forward(model, data)".into())
    }
}
