//! The meanings of names: the language's [`Schema`] over the engine's field table and one model.

use super::Functions;
use super::displayed::{DisplayedLabels, LABELS};
use super::elements;
use super::enums::ENUMS;
use super::field_entry::{field, member_name, noun, owner, short_name};
use super::functions::{self, FunctionPlace, OBJECTS, TABLE};
use super::handle::{self, FieldOwner, HandleTarget, KINDS};
use super::host_terms::HOST_TERMS;
use super::measures;
use labspec_core::reflect::{self, FieldId, Object, data, option};
use labspec_core::{Model, Obj};
use labspec_expr::dimension::Measure;
use labspec_expr::{
    CollectionId, Entry, Field, FieldKey, FunctionId, FunctionInfo, HostTerms, ObjectId, ResultDimension,
    Role, Schema, Value,
};
use labspec_finding::ranked;

/// The context of a program, which decides which functions exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// In a lab: the functions of the page.
    Lab,
    /// In a measure of `verify`: also aggregates over a run.
    Measure,
    /// In a claim of `verify` about several runs: only functions that combine their numbers.
    Claim,
}

/// The names of a model, for the compiler of the language.
#[derive(Clone, Copy, Debug)]
pub struct ModelNames<'m> {
    /// The model.
    pub model: &'m Model,
    /// The context of the program.
    pub scope: Scope,
    /// Functions of the embedding program, if there are any.
    functions: Option<&'m Functions>,
    /// Displayed labels, if there are any.
    displayed: Option<&'m DisplayedLabels>,
}

/// The largest distance of a misspelt name from the intended one, in tenths of an edit.
const SLIP: usize = 21;

impl ModelNames<'_> {
    /// The advice for a field of joints that is read of a body: the joints of the body. `index` is what follows the field.
    fn joint_hint(&self, body: usize, name: &str, index: Option<usize>) -> Option<String> {
        if !["qpos", "qvel", "qacc", "damping", "stiffness", "range"].contains(&name) {
            return None;
        }
        let object = if name.starts_with('q') { "data" } else { "model" };
        let is_of_body = |owner: &i32| usize::try_from(*owner) == Ok(body);
        let Some(joint) = self.model.jnt_bodyid.iter().position(is_of_body) else {
            return Some(format!("joints have `{name}`, and this body has none: it is fixed to its parent"));
        };
        let index = index.unwrap_or(0);
        let named = self.model.names.joint.get(joint).filter(|joint| !joint.is_empty());
        if let Some(joint) = named {
            return Some(format!("joints have `{name}`: write `{object}.joint('{joint}').{name}[{index}]`"));
        }
        let naming =
            format!("give the joint of this body a name, and write `{object}.joint('NAME').{name}[{index}]`");
        let first = match name {
            "qpos" => self.model.jnt_qposadr.get(joint),
            "qvel" | "qacc" => self.model.jnt_dofadr.get(joint),
            _ => None,
        };
        Some(match first.and_then(|first| usize::try_from(*first).ok()) {
            Some(first) => {
                format!("joints have `{name}`: write `data.{name}[{}]`, or {naming}", first + index)
            }
            None => format!("joints have `{name}`: {naming}"),
        })
    }
}

impl<'m> ModelNames<'m> {
    /// Creates the names of a model.
    pub fn new(model: &'m Model, scope: Scope) -> ModelNames<'m> {
        ModelNames { model, scope, functions: None, displayed: None }
    }

    /// Adds functions of the embedding program.
    pub fn with(self, functions: &'m Functions) -> ModelNames<'m> {
        ModelNames { functions: Some(functions), ..self }
    }

    /// Adds displayed labels.
    pub fn showing(self, displayed: &'m DisplayedLabels) -> ModelNames<'m> {
        ModelNames { displayed: Some(displayed), ..self }
    }
}

/// Whether programs of a scope see a function.
fn is_visible(f: &functions::Function, scope: Scope) -> bool {
    match f.place {
        FunctionPlace::Everywhere => scope != Scope::Claim,
        FunctionPlace::Measures => scope == Scope::Measure || (scope == Scope::Claim && f.name == "abs"),
        FunctionPlace::Claims => scope == Scope::Claim,
    }
}

impl ModelNames<'_> {
    fn functions(&self) -> impl Iterator<Item = (usize, &'static functions::Function)> {
        let scope = self.scope;
        TABLE.iter().copied().enumerate().filter(move |(_, f)| is_visible(f, scope))
    }

    /// Finds a function by its object and its name.
    fn function_of(&self, object: &str, name: &str) -> Option<Entry> {
        let found = functions::named(object, name).find(|(_, f)| is_visible(f, self.scope));
        found.map(|(i, _)| Entry::Function(FunctionId(i as u32)))
    }

    /// A whole field.
    fn whole(&self, f: FieldId, path: String) -> Field {
        let shape = reflect::shape(self.model, f);
        let owner = owner(f, &shape);
        field(f, path, 0, shape, owner)
    }

    /// The fields of one object, with their names in the object.
    fn rows(
        &self,
        side: FieldOwner,
        kind: Obj,
        index: usize,
    ) -> impl Iterator<Item = (String, FieldId, usize, usize)> + '_ {
        let objects = match side {
            FieldOwner::Model => Object::Model,
            FieldOwner::Data => Object::Data,
        };
        reflect::fields().filter(move |f| f.info().object == objects).filter_map(move |f| {
            let (first, count) = elements::row(self.model, f, kind, index)?;
            Some((short_name(f.info().name).to_string(), f, first, count))
        })
    }

    fn named_member(&self, side: FieldOwner, kind: Obj, index: usize, name: &str) -> Option<Entry> {
        match name {
            "id" => return Some(Entry::Constant(Value::Number(index as f64))),
            "name" => {
                return Some(Entry::Constant(Value::String(
                    self.model.names.of_kind(kind).get(index)?.as_str().into(),
                )));
            }
            _ => {}
        }
        // `data.sensor("x").data`, as in MuJoCo's bindings.
        let full_name = if kind == Obj::Sensor && name == "data" { "sensordata" } else { name };
        let (_, f, first, count) = self
            .rows(side, kind, index)
            .find(|(short, f, ..)| short == full_name || f.info().name == full_name)?;
        let holder = self.describe(handle::encode(HandleTarget::Named(side, kind, index)));
        let path = format!("{}.{name}", self.path(side, kind, index));
        Some(Entry::Field(field(f, path, first, vec![Some(count)], format!("{holder} has {count} of these"))))
    }

    /// An object as an author writes it: `data.joint("hinge")`.
    fn path(&self, side: FieldOwner, kind: Obj, index: usize) -> String {
        let holder = if side == FieldOwner::Data { "data" } else { "model" };
        let name = self.model.names.of_kind(kind).get(index).map_or("", String::as_str);
        format!("{holder}.{}(\"{name}\")", noun(kind))
    }

    fn struct_fields(object: Object) -> impl Iterator<Item = FieldId> {
        reflect::fields().filter(move |f| f.info().object == object)
    }
}

impl Schema for ModelNames<'_> {
    fn identity(&self) -> u64 {
        self.model.identity()
    }

    fn root(&self, name: &str) -> Option<Entry> {
        match name {
            "model" => Some(Entry::Object(handle::encode(HandleTarget::Struct(Object::Model)))),
            "data" => Some(Entry::Object(handle::encode(HandleTarget::Struct(Object::Data)))),
            // The short form that the lab format allows.
            "mj_setConst" => self.function_of("mj", name),
            _ => match OBJECTS.iter().position(|o| *o == name) {
                Some(i) => Some(Entry::Object(handle::encode(HandleTarget::Functions(i)))),
                None => self.function_of("", name).or_else(|| {
                    let function = self.functions?.find(name)?;
                    Some(Entry::Function(FunctionId((TABLE.len() + function) as u32)))
                }),
            },
        }
    }

    fn root_names(&self) -> Vec<String> {
        let names_here = self.functions().filter(|(_, f)| f.object.is_empty()).map(|(_, f)| f.name);
        ["model", "data"]
            .into_iter()
            .chain(OBJECTS)
            .chain(["mj_setConst"])
            .chain(names_here)
            .chain(self.functions.into_iter().flat_map(Functions::names))
            .map(String::from)
            .collect()
    }

    fn member(&self, object: ObjectId, name: &str) -> Option<Entry> {
        match handle::decode(object)? {
            HandleTarget::Struct(owner) => {
                if owner == Object::Model {
                    match name {
                        "opt" => {
                            return Some(Entry::Object(handle::encode(HandleTarget::Struct(Object::Option))));
                        }
                        "stat" => {
                            return Some(Entry::Object(handle::encode(HandleTarget::Struct(
                                Object::Statistic,
                            ))));
                        }
                        _ => {}
                    }
                }
                let side = match owner {
                    Object::Model => Some(FieldOwner::Model),
                    Object::Data => Some(FieldOwner::Data),
                    _ => None,
                };
                // A field with this name takes precedence, as in `data.contact`.
                if let (Some(side), Some(kind), None) =
                    (side, handle::kind_of(name), reflect::field(owner, name))
                {
                    return Some(Entry::Collection(handle::collection(side, kind)));
                }
                let f = reflect::field(owner, name)?;
                Some(Entry::Field(self.whole(f, format!("{}.{name}", self.describe(object)))))
            }
            HandleTarget::Functions(i) => {
                let holder = OBJECTS.get(i)?;
                match (*holder, name) {
                    ("sim", "time") => Some(Entry::Field(self.whole(data::time, "sim.time".into()))),
                    ("sim", "timestep") => {
                        Some(Entry::Field(self.whole(option::timestep, "sim.timestep".into())))
                    }
                    ("mj", _) if name.starts_with("mjt") => {
                        let i = ENUMS.iter().position(|(n, _)| *n == name)?;
                        Some(Entry::Object(handle::encode(HandleTarget::Enum(i))))
                    }
                    _ => self.function_of(holder, name),
                }
            }
            HandleTarget::Enum(i) => {
                let (_, members) = ENUMS.get(i)?;
                let j = members.iter().position(|(n, _)| *n == name)?;
                Some(Entry::Object(handle::encode(HandleTarget::Member(i, j))))
            }
            HandleTarget::Member(i, j) => {
                let (_, number) = ENUMS.get(i)?.1.get(j)?;
                (name == "value").then_some(Entry::Constant(Value::Number(*number as f64)))
            }
            HandleTarget::Named(side, kind, index) => self.named_member(side, kind, index, name),
        }
    }

    fn member_names(&self, object: ObjectId) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        match handle::decode(object) {
            Some(HandleTarget::Struct(owner)) => {
                names.extend(Self::struct_fields(owner).map(|f| f.info().name.to_string()));
                if owner == Object::Model {
                    names.extend(["opt".into(), "stat".into()]);
                }
                if matches!(owner, Object::Model | Object::Data) {
                    names.extend(KINDS.iter().map(|(_, noun)| noun.to_string()));
                }
            }
            Some(HandleTarget::Functions(i)) => {
                let holder = OBJECTS.get(i).copied().unwrap_or("");
                names.extend(
                    self.functions().filter(|(_, f)| f.object == holder).map(|(_, f)| f.name.to_string()),
                );
                if holder == "sim" {
                    names.extend(["time".into(), "timestep".into()]);
                }
            }
            Some(HandleTarget::Enum(i)) => {
                let members = ENUMS.get(i).map_or(&[][..], |(_, members)| members);
                names.extend(members.iter().map(|(n, _)| n.to_string()));
            }
            Some(HandleTarget::Member(..)) => names.push("value".into()),
            Some(HandleTarget::Named(side, kind, index)) => {
                names.extend(["id".into(), "name".into()]);
                names.extend(self.rows(side, kind, index).map(|(short, ..)| short));
            }
            None => {}
        }
        names
    }

    fn describe(&self, object: ObjectId) -> String {
        match handle::decode(object) {
            Some(HandleTarget::Struct(Object::Model)) => "model".into(),
            Some(HandleTarget::Struct(Object::Option)) => "model.opt".into(),
            Some(HandleTarget::Struct(Object::Statistic)) => "model.stat".into(),
            Some(HandleTarget::Struct(Object::Data)) => "data".into(),
            Some(HandleTarget::Functions(i)) => OBJECTS.get(i).copied().unwrap_or("").into(),
            Some(HandleTarget::Enum(i)) => format!("mj.{}", ENUMS.get(i).map_or("", |(n, _)| n)),
            Some(HandleTarget::Member(i, j)) => {
                let (holder, members) = ENUMS.get(i).copied().unwrap_or(("", &[]));
                format!("mj.{holder}.{}", members.get(j).map_or("", |(n, _)| n))
            }
            Some(HandleTarget::Named(_, kind, index)) => {
                let name = self.model.names.of_kind(kind).get(index).map_or("", String::as_str);
                format!("the {} \"{name}\"", noun(kind))
            }
            None => String::new(),
        }
    }

    fn lookup(&self, collection: CollectionId, name: &str) -> Option<ObjectId> {
        if collection == LABELS {
            return self.displayed?.find(name);
        }
        let (side, kind, _) = handle::of_collection(collection)?;
        self.model.names.id(kind, name).map(|i| handle::encode(HandleTarget::Named(side, kind, i)))
    }

    fn names(&self, collection: CollectionId) -> Vec<String> {
        if collection == LABELS {
            return self.displayed.map_or(Vec::new(), |displayed| displayed.labels().to_vec());
        }
        let Some((_, kind, _)) = handle::of_collection(collection) else { return Vec::new() };
        self.model.names.of_kind(kind).iter().filter(|n| !n.is_empty()).cloned().collect()
    }

    fn noun(&self, collection: CollectionId) -> &str {
        if collection == LABELS {
            return "readout or trace";
        }
        handle::of_collection(collection).map_or("object", |(_, _, noun)| noun)
    }

    fn element_help(&self, FieldKey(f): FieldKey, index: usize) -> Option<String> {
        let field = FieldId::new(f as usize)?;
        elements::help(self.model, field, index, &measures::unit(self.model, field, index, Some(1)))
    }

    fn unit(&self, field: &Field, element: Option<usize>) -> String {
        let Some(f) = FieldId::new(field.key.0 as usize) else { return field.unit.clone() };
        match element {
            Some(i) => measures::unit(self.model, f, field.first + i, Some(1)),
            None => measures::unit(self.model, f, field.first, field.len()),
        }
    }

    fn gives(&self, FunctionId(f): FunctionId, first: Option<f64>) -> ResultDimension {
        let label = || self.displayed?.measure(handle::index_of(first?));
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

    fn is_continuous(&self, FieldKey(f): FieldKey, _: usize) -> bool {
        FieldId::new(f as usize).is_some_and(elements::is_continuous)
    }

    fn entries_contain(&self, FunctionId(f): FunctionId) -> Option<&'static str> {
        functions::entries_contain(f)
    }

    fn role(&self, FieldKey(f): FieldKey, index: usize) -> Role {
        FieldId::new(f as usize).map_or(Role::default(), |field| elements::role(self.model, field, index))
    }

    fn named_element(&self, FieldKey(f): FieldKey, index: usize) -> Option<String> {
        let field = FieldId::new(f as usize)?;
        let side = match field.info().object {
            Object::Model => FieldOwner::Model,
            Object::Data => FieldOwner::Data,
            _ => return None,
        };
        let (kind, object) = elements::owner(self.model, field, index)?;
        let (first, _) = elements::row(self.model, field, kind, object)?;
        // A name that needs escapes is not used.
        let plain = |n: &&String| !n.is_empty() && !n.contains(['\'', '\\']) && !n.contains(char::is_control);
        let name = self.model.names.of_kind(kind).get(object).filter(plain)?;
        let short = member_name(field.info().object, field.info().name, kind);
        let holder = if side == FieldOwner::Data { "data" } else { "model" };
        // Single quotes need no escapes in the JSON of a lab.
        Some(format!("{holder}.{}('{name}').{short}[{}]", noun(kind), index - first))
    }

    fn result_field(&self, FunctionId(i): FunctionId, object: ObjectId) -> Option<Field> {
        let (f, kind) = TABLE.get(i as usize)?.gives?;
        let Some(HandleTarget::Named(_, owner, index)) = handle::decode(object) else { return None };
        let (first, count) = elements::row(self.model, f, kind, index).filter(|_| owner == kind)?;
        let path = format!("{}.{}", self.path(FieldOwner::Data, kind, index), short_name(f.info().name));
        Some(field(f, path, first, vec![Some(count)], format!("a position has {count} of these")))
    }

    fn function(&self, FunctionId(i): FunctionId) -> FunctionInfo {
        let index = i as usize;
        let embedded = || self.functions?.info(index.checked_sub(TABLE.len())?);
        functions::INFO.get(index).cloned().or_else(embedded).unwrap_or_else(functions::none)
    }

    fn hint(&self, object: ObjectId, name: &str, index: Option<usize>) -> Option<String> {
        let here = match handle::decode(object)? {
            HandleTarget::Struct(owner) => owner,
            HandleTarget::Named(_, Obj::Body, body) => return self.joint_hint(body, name, index),
            HandleTarget::Functions(_) if name.starts_with("mj_") => {
                // A misspelt name of a function that exists.
                let names = self.member_names(object);
                if ranked(name, names.iter().map(String::as_str)).is_some_and(|(cost, _)| cost <= SLIP) {
                    return None;
                }
                return Some(format!("`{name}` is a function of MuJoCo that labspec does not offer yet"));
            }
            _ => return None,
        };
        let elsewhere = [Object::Model, Object::Option, Object::Data, Object::Statistic]
            .into_iter()
            .find(|&owner| owner != here && reflect::field(owner, name).is_some())?;
        let holder = self.describe(handle::encode(HandleTarget::Struct(elsewhere)));
        Some(format!("`{name}` belongs to {holder}: write `{holder}.{name}`"))
    }

    fn host_terms(&self) -> &'static HostTerms {
        &HOST_TERMS
    }

    fn refresh(&self) -> Option<String> {
        Some("mj.mj_forward(model, data)".into())
    }
}
