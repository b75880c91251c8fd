//! All source texts of the lessons have the same meaning as in JavaScript. Each is run here and in node, on states that a lab
//! passes through. The values, all fields and all `ctx` variables afterwards have the same bits.
//!
//! Functions of the simulation are recorded here and replayed there (`language.js`), because only the language is compared.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::support::{model_text, sorted_files, workspace};
use labspec::bind::scene::Models;
use labspec::bind::{ControlProgram, ModelNames, Programs, Scope, World};
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::run::{Session, Start};
use labspec::source::SourceFile;
use labspec::spec::{ControlKind, Lab};
use labspec_core::reflect::{self, Elem, Object};
use labspec_core::{AccessSet, Model, Plan};
use labspec_expr::{Context, Entry, FieldKey, FunctionId, Globals, Heap, Host, Program, Schema, Value};
use serde_json::{Map, Value as Json, json};
use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// All fields as numbers, in the order of the table.
pub(crate) type Snapshot = Vec<Vec<f64>>;

pub(crate) fn snapshot(world: &World) -> Snapshot {
    let numbers = |f| {
        let view = labspec_core::view(&world.model, &world.data, f).unwrap();
        (0..view.len()).map(|i| view.get(i).unwrap()).collect()
    };
    reflect::fields().map(numbers).collect()
}

fn path(f: reflect::FieldId) -> String {
    let info = f.info();
    let holder = match info.object {
        Object::Model => "model",
        Object::Option => "model.opt",
        Object::Statistic => "model.stat",
        Object::Data => "data",
    };
    format!("{holder}.{}", info.name)
}

fn number(x: f64) -> Json {
    if x.is_finite() { json!(x) } else { json!({"$": Value::Number(x).to_string()}) }
}

fn numbers(list: &[f64]) -> Json {
    list.iter().map(|x| number(*x)).collect()
}

fn value(heap: &Heap, v: &Value) -> Json {
    match v {
        Value::Undefined => json!({"$": "undefined"}),
        Value::Null => Json::Null,
        Value::Number(x) => number(*x),
        Value::Boolean(b) => json!(b),
        Value::String(s) => json!(&**s),
        Value::Record(_) => {
            let names = ["potential", "kinetic", "total"];
            names.iter().filter_map(|k| Some((k.to_string(), value(heap, &heap.get(v, k)?)))).collect()
        }
        list => match heap.to_numbers(list) {
            Some(list) => numbers(&list),
            None => json!({"$": "undefined"}),
        },
    }
}

fn state(world: &World) -> Json {
    let field = |(f, values): (reflect::FieldId, Vec<f64>)| {
        let elem = match f.info().elem {
            Elem::F64 => "F64",
            Elem::I32 => "I32",
            Elem::Bool => "Bool",
            Elem::Size => "Size",
        };
        let entry = json!({"type": elem, "scalar": f.info().shape.is_empty(), "values": numbers(&values)});
        (path(f), entry)
    };
    reflect::fields().zip(snapshot(world)).map(field).collect()
}

/// The fields that differ.
fn changes(before: &Snapshot, after: &Snapshot) -> Json {
    let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let changed = reflect::fields().zip(before.iter().zip(after)).filter(|(_, (a, b))| bits(a) != bits(b));
    changed.map(|(f, (_, now))| (path(f), numbers(now))).collect()
}

/// Named objects with their members: a number, or a field with its first element and count.
fn objects(names: &ModelNames<'_>) -> Json {
    let mut all = Map::new();
    for side in ["model", "data"] {
        let Some(Entry::Object(root)) = names.root(side) else { continue };
        for noun in names.member_names(root) {
            let Some(Entry::Collection(collection)) = names.member(root, &noun) else { continue };
            let mut list = Map::new();
            for name in names.names(collection) {
                let object = names.lookup(collection, &name).unwrap();
                let member = |m: String| match names.member(object, &m)? {
                    Entry::Constant(v) => Some((m, value(&Heap::default(), &v))),
                    Entry::Field(f) => {
                        let field = path(reflect::FieldId::new(f.key.0 as usize).unwrap());
                        Some((m, json!([field, f.first, f.len()])))
                    }
                    _ => None,
                };
                list.insert(name, names.member_names(object).into_iter().filter_map(member).collect());
            }
            all.insert(format!("{side}.{noun}"), list.into());
        }
    }
    all.into()
}

/// A world that records calls of functions, their results and their effects.
struct Recorder<'w> {
    world: &'w mut World,
    names: &'w ModelNames<'w>,
    start: Snapshot,
    calls: Vec<Json>,
}

/// The functions that `language.js` computes itself.
const COMPUTED: [&str; 8] =
    ["lib.bodyPos", "lib.sitePos", "lib.bodyId", "lib.jointId", "lib.qpos", "lib.norm", "lib.deg", "lib.rad"];

impl Host for Recorder<'_> {
    fn identity(&self) -> u64 {
        Host::identity(self.world)
    }

    fn get(&self, field: FieldKey, index: usize) -> Option<f64> {
        self.world.get(field, index)
    }

    fn set(&mut self, field: FieldKey, index: usize, value: f64) -> Result<(), String> {
        self.world.set(field, index, value)
    }

    fn len(&self, field: FieldKey) -> usize {
        self.world.len(field)
    }

    fn call(&mut self, heap: &mut Heap, function: FunctionId, args: &[Value]) -> Result<Value, String> {
        let result = self.world.call(heap, function, args)?;
        let name = self.names.function(function).name;
        if !COMPUTED.contains(&name.as_str()) {
            let after = changes(&self.start, &snapshot(self.world));
            self.calls.push(json!({"name": name, "result": value(heap, &result), "after": after}));
        }
        Ok(result)
    }
}

/// The requests to node for one lab.
#[derive(Default)]
struct LabRequests {
    states: Vec<Json>,
    jobs: Vec<Json>,
}

impl LabRequests {
    /// Adds a source text with one state; the session is not changed.
    fn add(&mut self, session: &Session<'_>, globals: &Globals, at: &Job<'_>, given: Option<Value>) {
        let (mut world, mut context) = (session.world.clone(), session.context.clone());
        let names = ModelNames::new(&session.world.model, Scope::Lab);
        let start = snapshot(&world);
        let ctx = variables(globals, &context);
        let mut host = Recorder { world: &mut world, names: &names, start: start.clone(), calls: Vec::new() };
        let result = at.program.run(&mut host, &mut context, given.as_ref());
        let calls = host.calls;
        let gives = result.ok().map(|v| value(&context.heap, &v));
        self.jobs.push(json!({
            "text": at.text, "kind": at.kind, "value": given.map_or(json!({"$": "undefined"}), |v| value(&Heap::default(), &v)),
            "state": self.states.len() - 1, "ctx": ctx, "calls": calls, "gives": gives,
            "after": changes(&start, &snapshot(&world)), "kept": variables(globals, &context),
        }));
    }

    fn run_in_node(&self, objects: Json) -> Vec<String> {
        let script = workspace().join("tests/language.js");
        let started = Command::new("node").arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut child = started.unwrap();
        let input = json!({"states": self.states, "objects": objects, "jobs": self.jobs}).to_string();
        child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success());
        String::from_utf8(output.stdout).unwrap().lines().map(String::from).collect()
    }
}

fn variables(globals: &Globals, context: &Context) -> Json {
    let variable = |slot: u32| match context.get(slot) {
        Value::Undefined => None,
        v => Some((globals.name(slot).to_string(), value(&context.heap, v))),
    };
    (0..globals.len() as u32).filter_map(variable).collect()
}

struct Job<'p> {
    text: &'p str,
    kind: &'static str,
    program: &'p Program,
    /// The values of its control.
    given: Vec<Value>,
}

/// All source texts of a lab.
fn texts<'p>(lab: &Lab, programs: &'p Programs) -> Vec<Job<'p>> {
    let mut jobs = Vec::new();
    for bound in programs.setup.iter().chain(&programs.controller) {
        jobs.push(Job {
            text: &bound.text.value,
            kind: "statements",
            program: &bound.program,
            given: Vec::new(),
        });
    }
    for ((_, control), written) in programs.controls.iter().zip(&lab.controls) {
        match (control, &written.kind) {
            (ControlProgram::Press(Some(bound)), _) => {
                jobs.push(Job {
                    text: &bound.text.value,
                    kind: "statements",
                    program: &bound.program,
                    given: Vec::new(),
                });
            }
            (
                ControlProgram::Change(value, action),
                ControlKind::Slider { action: w, .. } | ControlKind::Select { action: w, .. },
            ) => {
                let Some(bound) = &action.run else { continue };
                let mut given = vec![value.clone()];
                if let ControlKind::Slider { min, max, .. } = &written.kind {
                    given.extend([Value::Number(min.value), Value::Number(max.value)]);
                }
                let kind = if w.set.is_some() { "target" } else { "statements" };
                jobs.push(Job { text: &bound.text.value, kind, program: &bound.program, given });
            }
            _ => {}
        }
    }
    for bound in programs.probes.iter().filter_map(|p| p.bound.as_ref()) {
        jobs.push(Job { text: &bound.text.value, kind: "value", program: &bound.program, given: Vec::new() });
    }
    jobs
}

/// The numbers of source texts and comparisons.
#[derive(Default)]
struct Count {
    labs: usize,
    texts: usize,
    distinct: BTreeSet<String>,
    compared: usize,
}

/// Compares all source texts of a lab on four states that it passes through.
fn compare(name: &str, lab: &Lab, model: &Model, count: &mut Count) {
    let mut findings = Vec::new();
    let programs = Programs::compile(lab, model, &mut findings);
    assert!(
        findings.iter().all(|f| f.severity != labspec::finding::Severity::Error),
        "{name}: {findings:#?}"
    );
    assert!(programs.probes.iter().all(|p| p.bound.is_some()), "{name}");
    let jobs = texts(lab, &programs);
    let plan = Some(Plan::new(model, &AccessSet::ANY));
    let mut session = Session::start(&programs, model, Start { plan, ..Start::of_lab(lab) });
    let mut work = LabRequests::default();
    for phase in 0..4 {
        match phase {
            1 => (0..60).for_each(|_| session.step()),
            2 => {
                for (i, control) in lab.controls.iter().enumerate() {
                    if let ControlKind::Slider { max, .. } = &control.kind {
                        session.set_control(i, Value::Number(max.value));
                    }
                }
                (0..200).for_each(|_| session.step());
            }
            3 => {
                (0..lab.controls.len()).for_each(|i| session.press(i));
                (0..30).for_each(|_| session.step());
            }
            _ => {}
        }
        work.states.push(state(&session.world));
        for job in &jobs {
            let given: Vec<Option<Value>> =
                if job.given.is_empty() { vec![None] } else { job.given.iter().cloned().map(Some).collect() };
            for value in given {
                work.add(&session, &programs.globals, job, value);
            }
        }
    }
    let names = ModelNames::new(model, Scope::Lab);
    let found = work.run_in_node(objects(&names));
    assert!(found.len() >= work.jobs.len(), "{name}: {found:#?}");
    let wrong: Vec<String> = found
        .iter()
        .zip(&work.jobs)
        .filter(|(line, _)| !line.is_empty())
        .map(|(line, job)| format!("{}: {line}", job["text"]))
        .collect();
    assert!(wrong.is_empty(), "{name}: {wrong:#?}");
    count.labs += 1;
    count.texts += jobs.len();
    count.distinct.extend(jobs.iter().map(|j| j.text.to_string()));
    count.compared += work.jobs.len();
}

/// Compares all labs of some lessons.
fn compare_lessons(lessons: &[PathBuf], models: &Path) {
    let folder = ModelFolder::open(models).unwrap();
    let mut count = Count::default();
    for path in lessons {
        let text = std::fs::read_to_string(path).unwrap();
        let lesson = load_lesson(SourceFile::new(path.display().to_string(), text), &folder);
        let models = Models::new(folder.clone());
        for lab in lesson.all_labs() {
            let name = format!("{} {}", path.display(), lab.title());
            let Some(model) = models.model_of_lab(lab, &mut Vec::new()) else {
                panic!("{name} has no model")
            };
            compare(&name, lab, &model, &mut count);
        }
    }
    println!(
        "{} labs, {} texts, {} of them distinct, {} runs: all as in JavaScript, to the bit",
        count.labs,
        count.texts,
        count.distinct.len(),
        count.compared
    );
}

#[test]
fn the_corpus_behaves_as_in_javascript() {
    let corpus = workspace().join("../shared/corpus");
    if !needs("../shared/corpus") || !needs("node") {
        return;
    }
    let lessons = [sorted_files(&corpus.join("labs")), sorted_files(&corpus.join("quizzes"))].concat();
    compare_lessons(&lessons, &corpus.join("models"));
}

#[test]
fn our_lessons_behave_as_in_javascript() {
    if !needs("node") {
        return;
    }
    compare_lessons(&sorted_files(&workspace().join("specs/lessons")), &workspace().join("specs/models"));
}

/// Constructs of real labs that these lessons do not contain: names, loops, closures, arrays as values.
#[test]
fn a_lab_with_every_construct_behaves_as_in_javascript() {
    if !needs("node") {
        return;
    }
    let lab = json!({
        "xml": model_text("ball_drop"),
        "setup": "ctx.x = [1, 2, 3]; const v = data.qvel; v[2] = -0.5; data.joint('light_free').qvel[2] = v[2] / 3; data.xfrc_applied.fill(0)",
        "controller": "const s = (x) => { x = Math.min(Math.max(x, 0), 1); return x * x * (3 - 2 * x); }; data.qfrc_applied[2] = s(data.time) / 7; for (let i = 0; i < 3; i++) ctx['q' + i] = data.qpos[i] + (ctx['q' + i] || 0); ctx.peak = Math.max(ctx.peak || 0, data.qpos[2])",
        "controls": [
            {"label": "g", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "value": -9.81},
            {"label": "solver", "apply": "model.opt.iterations = value / 3; for (let g = 0; g < model.ngeom; g++) model.geom_solref[2 * g] = 0.02 + value / 1000; ctx.v = ~~(value / 2)", "min": 1, "max": 60, "value": 50},
            {"label": "mass", "apply": "model.body_mass[model.body('heavy').id] = value; mj.mj_setConst(model, data)", "min": 1, "max": 3, "value": 2},
            {"type": "button", "label": "kick", "run": "data.qvel.set([0.1, 0.2], 6); ((a, b) => { ctx.sum = a + b; })(1, ctx.sum ?? 0.1)"},
            {"type": "button", "label": "kinds", "run": "let i = 0; for (const x of [true, null, '3', -2.7, [2], undefined]) { data.qfrc_applied[i++] = x; model.geom_conaffinity[i % 2] = x; } ctx.kept = data.qfrc_applied.slice(0, 6); ctx.whole = [...model.geom_conaffinity]; data.qfrc_applied.fill(0); model.geom_conaffinity[0] = 2 ** 31; model.geom_conaffinity[0]++; model.geom_conaffinity[1] ^= 2.5; ctx.sign = -(model.geom_contype[0] = ctx.kept[3]); model.opt.iterations = '50'; const [a, b = 7] = ctx.kept; ctx.parts = [a, b]"}
        ],
        "plots": [{"traces": [
            {"label": "a", "expr": "[...data.qpos].reduce((a, x) => a + x * x, 0)"},
            {"label": "b", "expr": "Math.hypot(...data.body('heavy').xpos) % 0.3"},
            {"label": "c", "expr": "1000 * (data.qpos[2] - (1 - 0.5 * 9.81 * data.time * data.time))"},
            {"label": "d", "expr": "data.qpos.slice(2, 5).map((x) => x ** 2)[0]"},
            {"label": "e", "expr": "data.efc_force[0] + data.qpos[data.ncon + 99]"}
        ]}],
        "readouts": [
            {"label": "f", "expr": "data.qpos[2] > 0.5 ? 'above' : `at ${data.qpos[2].toFixed(3)}`"},
            {"label": "g", "expr": "ctx.nothing ?? data.ncon > 0"},
            {"label": "h", "expr": "ctx['q' + 1] + ctx.q2"},
            {"label": "i", "expr": "lib.bodyPos('light')[2] + lib.norm(data.qvel) + lib.deg(data.qpos[7])"}
        ]
    });
    let lesson = load_lesson(SourceFile::new("lab.json", lab.to_string()), &ModelFolder::unknown());
    let lab = lesson.all_labs()[0];
    let model = labspec_core::xml::compile(&lab.xml.as_ref().unwrap().value).unwrap();
    compare("everything", lab, &model, &mut Count::default());
}
