//! Every function, every field, every accessor by name and every sensor: a planned run gives the same value as a full one, to
//! the bit, on every model of the corpus and of our own. The expressions follow from the schema of the language, so that a new
//! row of a table is covered without a change here.

#![allow(clippy::unwrap_used)]

use crate::needs::needs;
use crate::support::{compile, for_each, models, workspace};
use labspec::bind::{Functions, ModelNames, Scope, World, include};
use labspec_core::reflect::FieldSet;
use labspec_core::{self as core, Data, Demand, Model, Plan};
use labspec_expr::{CollectionId, Compiler, Context, Entry, Globals, ObjectId, Param, Schema, Value};

/// Most elements of a field, and most objects of a kind, that are read.
const MOST: usize = 3;
const STEPS: usize = 4;

/// Every expression of a model.
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
            for name in some(names, *collection) {
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
                Param::Name(collection) => some(names, *collection).first().map(|name| format!("'{name}'")),
                Param::Lazy => None,
            };
            for left_out in 0..=info.optional {
                let given = &info.params[..info.params.len() - left_out];
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

fn some(names: &ModelNames<'_>, collection: CollectionId) -> Vec<String> {
    let plain = |name: &String| !name.is_empty() && !name.contains(['\'', '\\', '\n']);
    names.names(collection).into_iter().filter(plain).take(MOST).collect()
}

fn world(model: &Model, plan: Plan) -> World {
    let mut data = Data::planned(model, plan);
    let model = model.clone();
    for _ in 0..STEPS {
        core::step(&model, &mut data).unwrap();
    }
    World { model, data, key: None, own: Functions::new(), shown: Vec::new(), numbers: Vec::new() }
}

/// What an expression gives, as text with every bit.
fn shown(world: &mut World, text: &str, demand: Option<&mut Demand>) -> Option<String> {
    let mut globals = Globals::new();
    let program = {
        let names = ModelNames::new(&world.model, Scope::Measure);
        Compiler::new(&names, &mut globals).expression(text).program?
    };
    if let Some(demand) = demand {
        include(program.effects(), demand);
        return Some(String::new());
    }
    let mut context = Context::of(&globals);
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

/// How many expressions of a model were compared, and those that differ.
fn compare(model: &Model) -> (usize, Vec<String>) {
    let full = world(model, Plan::full());
    let (mut count, mut wrong) = (0, Vec::new());
    for text in expressions(model) {
        let mut demand = Demand { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
        let mut blank = full.clone();
        if shown(&mut blank, &text, Some(&mut demand)).is_none() {
            continue;
        }
        let mut planned = world(model, Plan::new(model, &demand));
        let Some(ours) = shown(&mut planned, &text, None) else { continue };
        let theirs = shown(&mut full.clone(), &text, None).unwrap_or_default();
        count += 1;
        if ours != theirs {
            wrong.push(format!("{text}: planned {ours}, full {theirs}"));
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
        // Models that name meshes are read elsewhere.
        if text.contains("file=") || text.contains("<include") {
            return (0, Vec::new());
        }
        compare(&compile(&text))
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
