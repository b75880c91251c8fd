//! The formatter on real lessons: it changes only code, formatting again changes nothing, and all source texts have the same
//! meaning as before for random states of their models.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::javascript::snapshot;
use crate::needs::needs;
use crate::program::{folder, run_in};
use crate::support::{sorted_files, workspace};
use labspec::bind::scene::Models;
use labspec::bind::{ModelNames, Scope, World};
use labspec::format::{format, modernized};
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::source::SourceFile;
use labspec::spec::{CodeForm, Lesson};
use labspec_core::reflect::{Elem, Kind};
use labspec_core::{self as core, Data, Model, reflect};
use labspec_expr::{Compiler, Context, Globals, Program, Type, Value};
use std::path::{Path, PathBuf};

/// Our lessons, and those of the corpus if it exists, each with its models.
fn lessons() -> Vec<(PathBuf, ModelFolder)> {
    let (specs, corpus) = (workspace().join("specs"), workspace().join("../shared/corpus"));
    let mut all = Vec::new();
    let mut roots = vec![(specs, &["lessons"][..])];
    if needs("../shared/corpus") {
        roots.push((corpus, &["labs", "quizzes"]));
    }
    for (root, parts) in roots {
        let models = ModelFolder::open(&root.join("models")).unwrap();
        for part in parts {
            all.extend(sorted_files(&root.join(part)).into_iter().map(|path| (path, models.clone())));
        }
    }
    all
}

fn load(path: &Path, text: &str, models: &ModelFolder) -> Lesson {
    load_lesson(SourceFile::new(path.display().to_string(), text), models)
}

/// The file without its source texts, and without white space.
fn around(lesson: &Lesson) -> String {
    let labs = lesson.all_labs();
    let questions = lesson.quizzes.iter().flat_map(|q| q.numbered()).filter_map(|(_, q)| q.verify.as_ref());
    let claims = labs.iter().filter_map(|l| l.verify.as_ref()).chain(questions);
    let code = labs.iter().flat_map(|l| l.code()).chain(claims.flat_map(|v| v.code()));
    let mut spans: Vec<_> = code.map(|(_, text)| text.span()).collect();
    spans.sort_by_key(|s| std::cmp::Reverse(s.start));
    spans.dedup();
    let mut text = lesson.file.text().to_owned();
    spans.into_iter().for_each(|span| text.replace_range(span, ""));
    text.split_whitespace().collect()
}

#[test]
fn only_code_changes_and_only_once() {
    let (mut changed, mut total) = (0, 0);
    for (path, folder) in lessons() {
        let text = std::fs::read_to_string(&path).unwrap();
        let lesson = load(&path, &text, &folder);
        let mut models = Models::new(folder.clone());
        let plain = format(&lesson, None);
        let named = format(&lesson, Some(&mut models));
        for done in [&plain, &named] {
            let again = load(&path, &done.text, &folder);
            assert_eq!(around(&again), around(&lesson), "{}", path.display());
            let twice = format(&again, if done == &named { Some(&mut models) } else { None });
            assert_eq!((twice.changed, twice.laid_out), (0, 0), "{}", path.display());
            assert_eq!((twice.changed, &twice.text), (0, &done.text), "{}", path.display());
        }
        changed += named.changed;
        total += named.total;
    }
    println!("{changed} of {total} texts change");
    assert!(total > 30 && changed > 0);
}

/// A state of a model that no run reaches.
fn random_world(model: &Model, seed: u64) -> World {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut next = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let mut world = World {
        data: Data::planned(model, labspec_core::Plan::new(model, &labspec_core::AccessSet::ANY)),
        model: model.clone(),
        key: None,
        functions: labspec::Functions::new(),
        displayed: Vec::new(),
        numbers: Vec::new(),
        playback: None,
    };
    for f in reflect::fields() {
        let info = f.info();
        if info.elem == Elem::F64 && matches!(info.kind, Kind::State | Kind::Input) {
            let n = labspec_core::length(&world.model, &world.data, f);
            let mut view = labspec_core::view_mut(&mut world.model, &mut world.data, f).unwrap();
            for i in 0..n {
                view.set(i, next());
            }
        }
    }
    core::forward(&world.model, &mut world.data).unwrap();
    world
}

fn compile(text: &str, form: CodeForm, model: &Model, globals: &mut Globals) -> Program {
    let names = ModelNames::new(model, Scope::Lab);
    let mut compiler = Compiler::new(&names, globals).with_value(Some(Type::Number));
    let compiled = match form {
        CodeForm::Expression => compiler.expression(text),
        CodeForm::Statements => compiler.statements(text),
        CodeForm::Target => compiler.assignment(text),
    };
    compiled.program.unwrap_or_else(|| panic!("{text}: {:#?}", compiled.diagnostics))
}

/// The value, all fields and all variables after a run.
fn outcome(program: &Program, globals: &Globals, world: &World) -> (String, Vec<Vec<u64>>) {
    let (mut world, mut context) = (world.clone(), Context::for_globals(globals));
    for slot in 0..globals.len() as u32 {
        context.store(globals, slot, Value::Number(0.1 * f64::from(slot)));
    }
    let result = program.run(&mut world, &mut context, Some(&Value::Number(0.3)));
    let before: Vec<_> = (0..globals.len() as u32).map(|s| context.get(s).clone()).collect();
    let bits = |list: Vec<f64>| list.into_iter().map(f64::to_bits).collect();
    (format!("{result:?} {before:?}"), snapshot(&world).into_iter().map(bits).collect())
}

#[test]
fn names_and_layout_mean_the_same_on_random_states() {
    const STATES: u64 = 20;
    let (mut named_texts, mut runs) = (0, 0);
    for (path, folder) in lessons() {
        let text = std::fs::read_to_string(&path).unwrap();
        let lesson = load(&path, &text, &folder);
        let mut models = Models::new(folder.clone());
        let done = format(&lesson, Some(&mut models));
        let after = load(&path, &done.text, &folder);
        for (lab, new) in lesson.all_labs().into_iter().zip(after.all_labs()) {
            let Some(model) = models.model_of_lab(lab, &mut Vec::new()) else { continue };
            let worlds: Vec<World> = (0..STATES).map(|seed| random_world(&model, seed)).collect();
            let mut globals = Globals::new();
            for ((form, old), (_, new)) in lab.code().into_iter().zip(new.code()) {
                named_texts +=
                    usize::from(modernized(&old.value, form, &model, &mut globals.clone()).is_some());
                let a = compile(&old.value, form, &model, &mut globals);
                let b = compile(&new.value, form, &model, &mut globals);
                for world in &worlds {
                    let (x, y) = (outcome(&a, &globals, world), outcome(&b, &globals, world));
                    assert!(x == y, "{}: {} and {}", path.display(), old.value, new.value);
                    runs += 1;
                }
            }
        }
    }
    println!("{named_texts} texts get names; {runs} runs agree to the bit");
    assert!(runs > 0);
}

#[test]
fn the_command_changes_files_or_lists_the_changes() {
    let folder = folder();
    let lesson = folder.path().join("clean.md");
    let before = std::fs::read_to_string(&lesson).unwrap();
    let done = run_in(folder.path(), &["fmt", "--modernize", "--check", "clean.md"]);
    assert_eq!(
        (done.code, done.stdout.as_str()),
        (1, "clean.md: 5 of 14 texts and the layout of 2 blocks would change\n")
    );
    assert_eq!(std::fs::read_to_string(&lesson).unwrap(), before);
    assert_eq!(run_in(folder.path(), &["fmt", "clean.md"]).code, 0);
    let done = run_in(folder.path(), &["fmt", "--modernize", "clean.md"]);
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    let after = std::fs::read_to_string(&lesson).unwrap();
    assert!(after.contains("\"expr\": \"data.joint('light_free').qpos[2]\""), "{after}");
    assert_eq!(run_in(folder.path(), &["fmt", "--modernize", "--check", "clean.md"]).code, 0);
    assert_eq!(run_in(folder.path(), &["check", "clean.md"]).code, 0);
}
