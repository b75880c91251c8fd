//! Every function, every field, every accessor by name and every sensor: a planned run gives the same bits as a full one, on
//! every model of the corpus and of our own. The expressions are generated from the schema of the language, so that new rows of
//! a table are covered automatically.

#![allow(clippy::unwrap_used)]

use crate::needs::needs;
use crate::population::{minimum, sample};
use crate::support::{compile, for_each, models, workspace};
use labspec::bind::{Functions, ModelNames, Scope, World, include};
use labspec_core::reflect::{self, FieldSet, Object};
use labspec_core::{self as core, AccessSet, Data, Model, Plan};
use labspec_expr::{CollectionId, Compiler, Context, Entry, Globals, ObjectId, Param, Schema, Value};

/// The maximum number of elements of a field, and of objects of a kind, that are read.
const MOST: usize = 3;
const STEPS: usize = 4;

/// All expressions of a model.
fn expressions(model: &Model) -> Vec<String> {
    let names = ModelNames::new(model, Scope::Measure);
    let mut all = Vec::new();
    for root in names.root_names() {
        match names.root(&root) {
            Some(Entry::Object(object)) => members(&names, &root, object, 2, &mut all),
            Some(entry) => one(&names, &root, &entry, 2, &mut all),
            None => {}
        }
    }
    all
}

fn members(names: &ModelNames<'_>, path: &str, object: ObjectId, depth: usize, all: &mut Vec<String>) {
    for name in names.member_names(object) {
        if let Some(entry) = names.member(object, &name) {
            one(names, &format!("{path}.{name}"), &entry, depth, all);
        }
    }
}

fn one(names: &ModelNames<'_>, path: &str, entry: &Entry, depth: usize, all: &mut Vec<String>) {
    match entry {
        Entry::Field(field) => {
            let count: usize = field.shape.iter().map(|n| n.unwrap_or(1)).product();
            if field.shape.is_empty() {
                all.push(path.to_string());
            }
            let places = [0, count / 2, count.saturating_sub(1)];
            all.extend(places.iter().take(count.min(MOST)).map(|i| format!("{path}[{i}]")));
        }
        Entry::Collection(collection) if depth > 0 => {
            for name in member_names(names, *collection) {
                if let Some(object) = names.lookup(*collection, &name) {
                    members(names, &format!("{path}('{name}')"), object, depth - 1, all);
                }
            }
        }
        Entry::Function(function) => {
            let info = names.function(*function);
            if info.aggregate {
                return;
            }
            let argument = |param: &Param| match param {
                Param::Number | Param::Angle => Some("1".to_string()),
                Param::Text => Some("'x'".to_string()),
                Param::Boolean => Some("true".to_string()),
                Param::Numbers => Some("[1, 2, 3]".to_string()),
                Param::Any => Some("{}".to_string()),
                Param::Object(_) => None,
                Param::Name(collection) => {
                    member_names(names, *collection).first().map(|name| format!("'{name}'"))
                }
                Param::Lazy => None,
            };
            for omitted in 0..=info.optional {
                let given = &info.params[..info.params.len() - omitted];
                let objects = |param: &Param| match param {
                    Param::Object(id) => ["model", "data"]
                        .into_iter()
                        .find(|root| names.root(root) == Some(Entry::Object(*id)))
                        .map(String::from),
                    other => argument(other),
                };
                let args: Option<Vec<String>> = given.iter().map(objects).collect();
                all.extend(args.map(|args| format!("{path}({})", args.join(", "))));
            }
        }
        _ => {}
    }
}

fn member_names(names: &ModelNames<'_>, collection: CollectionId) -> Vec<String> {
    let plain = |name: &String| !name.is_empty() && !name.contains(['\'', '\\', '\n']);
    names.names(collection).into_iter().filter(plain).take(MOST).collect()
}

/// A write during a run: a field, an element of it and its new value.
type Change = (Object, &'static str, usize, f64);

/// Writes of a control, a button, a keyframe or a program of a lab, each of which affects which stages a plan keeps.
const CHANGES: [Change; 16] = [
    (Object::Option, "integrator", 0, 1.0),
    (Object::Option, "integrator", 0, 3.0),
    (Object::Option, "integrator", 0, 4.0),
    (Object::Option, "timestep", 0, 0.001),
    (Object::Option, "cone", 0, 1.0),
    (Object::Option, "solver", 0, 1.0),
    (Object::Option, "disableflags", 0, (core::disable::CONTACT | core::disable::ACTUATION) as f64),
    (Object::Option, "enableflags", 0, core::enable::ENERGY as f64),
    (Object::Option, "density", 0, 3.0),
    (Object::Model, "dof_damping", 0, 0.7),
    (Object::Model, "dof_frictionloss", 0, 0.2),
    (Object::Model, "geom_contype", 0, 0.0),
    (Object::Model, "geom_pos", 2, 0.4),
    (Object::Model, "jnt_axis", 0, 0.6),
    (Object::Data, "ctrl", 0, 0.8),
    (Object::Data, "eq_active", 0, 0.0),
];

/// Whether a model has the element of a change.
fn has(model: &Model, (object, name, element, _): Change) -> bool {
    let (field, data) = (reflect::field(object, name).unwrap(), Data::new(model));
    core::length(model, &data, field) > element
}

fn world(model: &Model, plan: Plan, change: Option<Change>) -> World {
    let mut data = Data::planned(model, plan);
    let mut model = model.clone();
    for step in 0..STEPS {
        if let Some((object, name, element, value)) = change.filter(|_| step == STEPS / 2) {
            let field = reflect::field(object, name).unwrap();
            assert!(core::view_mut(&mut model, &mut data, field).unwrap().set(element, value), "{name}");
        }
        core::step(&model, &mut data).unwrap();
    }
    World {
        model,
        data,
        key: None,
        functions: Functions::new(),
        displayed: Vec::new(),
        numbers: Vec::new(),
        playback: None,
    }
}

/// The value of an expression as text with all bits.
fn evaluate(world: &mut World, text: &str, access: Option<&mut AccessSet>) -> Option<String> {
    let mut globals = Globals::new();
    let program = {
        let names = ModelNames::new(&world.model, Scope::Measure);
        Compiler::new(&names, &mut globals).expression(text).program?
    };
    if let Some(access) = access {
        include(program.effects(), access);
        return Some(String::new());
    }
    let mut context = Context::for_globals(&globals);
    Some(match program.run(world, &mut context, None) {
        Ok(value) => bits(&context, &value),
        Err(error) => format!("throws: {error}"),
    })
}

fn bits(context: &Context, value: &Value) -> String {
    match value {
        Value::Number(x) => format!("{:016x}", x.to_bits()),
        other => match context.heap.to_numbers(other) {
            Some(numbers) => numbers.iter().map(|x| format!("{:016x} ", x.to_bits())).collect(),
            None => context.heap.text(other),
        },
    }
}

/// Compares the expressions of a model after a declared or undeclared change; returns their number, and those that differ.
fn compare(model: &Model, change: Option<Change>, announced: bool) -> (usize, Vec<String>) {
    let full = world(model, Plan::full(), change);
    let (mut count, mut wrong) = (0, Vec::new());
    for text in expressions(model) {
        let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
        let mut blank = full.clone();
        if evaluate(&mut blank, &text, Some(&mut access)).is_none() {
            continue;
        }
        if let Some((object, name, ..)) = change.filter(|_| announced) {
            access.writes.insert(reflect::field(object, name).unwrap());
        }
        let mut planned = world(model, Plan::new(model, &access), change);
        let Some(by_plan) = evaluate(&mut planned, &text, None) else { continue };
        let by_full = evaluate(&mut full.clone(), &text, None).unwrap_or_default();
        count += 1;
        if by_plan != by_full {
            wrong.push(format!("{text}: planned {by_plan}, full {by_full}"));
        }
    }
    (count, wrong)
}

#[test]
fn planned_equals_full_for_everything_that_can_be_read() {
    let mut files = Vec::new();
    let corpus = needs("../shared/corpus/models").then(|| workspace().join("../shared/corpus/models"));
    for folder in [workspace().join("specs/models")].into_iter().chain(corpus) {
        files.extend(models(&folder).into_iter().map(|name| folder.join(name + ".xml")));
    }
    let done = for_each(files.len(), |i| {
        let text = std::fs::read_to_string(&files[i]).unwrap();
        // Models with mesh files are tested elsewhere.
        if text.contains("file=") || text.contains("<include") {
            return (0, Vec::new());
        }
        compare(&compile(&text), None, false)
    });
    let count: usize = done.iter().map(|(n, _)| n).sum();
    let wrong: Vec<String> = done
        .into_iter()
        .zip(&files)
        .flat_map(|((_, wrong), file)| wrong.into_iter().map(move |w| format!("{}: {w}", file.display())))
        .collect();
    assert!(wrong.is_empty(), "{} of {count}:\n{}", wrong.len(), wrong.join("\n"));
    assert!(count > 2000, "{count}");
}

/// One of this many cases is in a sample.
const STEP: usize = 5;

/// Labs of twenty kinds (`tests/speed/kinds.py`) with a write that affects which stages their plans keep: declared, so that the
/// plan considers the value as variable from the start, and undeclared.
#[test]
fn planned_equals_full_whatever_is_switched() {
    let folder = workspace().join("tests/speed/kinds");
    let mut cases = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let lab: serde_json::Value =
            serde_json::from_str(&std::fs::read_to_string(entry.unwrap().path()).unwrap()).unwrap();
        let model = compile(lab["xml"].as_str().unwrap());
        let title = lab["title"].as_str().unwrap().to_string();
        let changes = CHANGES.into_iter().filter(|c| has(&model, *c)).flat_map(|c| [(c, true), (c, false)]);
        cases.extend(changes.map(|(c, announced)| (title.clone(), model.clone(), c, announced)));
    }
    assert!(cases.len() > 20 * 16, "{}", cases.len());
    let cases = sample(cases, STEP);
    let done = for_each(cases.len(), |i| {
        let (title, model, change, announced) = &cases[i];
        let (count, wrong) = compare(model, Some(*change), *announced);
        let label = if *announced { "announced" } else { "not announced" };
        (count, wrong.into_iter().map(|w| format!("{title}, {} {label}: {w}", change.1)).collect::<Vec<_>>())
    });
    let wrong: Vec<&String> = done.iter().flat_map(|(_, wrong)| wrong).collect();
    let count: usize = done.iter().map(|(n, _)| n).sum();
    assert!(
        wrong.is_empty(),
        "{} of {count}:\n{}",
        wrong.len(),
        wrong.iter().take(20).map(|w| w.as_str()).collect::<Vec<_>>().join("\n")
    );
    assert!(count > minimum(20_000, STEP), "{count}");
}
