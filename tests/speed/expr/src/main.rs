//! The speed of the language and of other evaluators, in one table. To run it in this folder: `cargo run --release --
//! ../../../docs/measured/speed-language.md`. The labs are those of `../shared/corpus`.

use fasteval::{Compiler as _, Evaler};
use labspec::bind::scene::Models;
use labspec::bind::{ModelNames, Programs, Scope, World};
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::run::{Session, Start};
use labspec::source::SourceFile;
use labspec::spec::Lab;
use labspec_core::{AccessSet, Data, Model, Plan, xml};
use labspec_expr::{Compiler, Context, FieldKey, FunctionId, Globals, Heap, Host, Program, Recording, Value};
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

const ERROR: &str = "1000 * (data.qpos[2] - (1 - 0.5 * 9.81 * data.time * data.time))";
const OTHERS: &str = "1000.0 * (q - (1.0 - 0.5 * 9.81 * t * t))";
const MODEL: &str =
    "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>";
/// The number of samples of a column.
const SAMPLES: usize = 4096;

/// The time of one of `times` calls, ns: the best of 25 rounds, which reduces the effect of other programs on the machine.
fn time(times: usize, mut call: impl FnMut(usize)) -> f64 {
    let round = |_| {
        let clock = Instant::now();
        (0..times).for_each(&mut call);
        clock.elapsed().as_secs_f64() * 1e9 / times as f64
    };
    (0..25).map(round).fold(f64::INFINITY, f64::min)
}

/// A minimal host with two fields.
struct Small {
    time: f64,
    qpos: [f64; 7],
    keys: [FieldKey; 2],
    model: u64,
}

impl Host for Small {
    fn identity(&self) -> u64 {
        self.model
    }
    fn get(&self, field: FieldKey, index: usize) -> Option<f64> {
        if field == self.keys[0] { Some(self.time) } else { self.qpos.get(index).copied() }
    }
    fn set(&mut self, _: FieldKey, _: usize, _: f64) -> Result<(), String> {
        Ok(())
    }
    fn len(&self, _: FieldKey) -> usize {
        7
    }
    fn call(&mut self, _: &mut Heap, _: FunctionId, _: &[Value]) -> Result<Value, String> {
        Ok(Value::Undefined)
    }
}

fn program(model: &Model, text: &str) -> Program {
    let names = ModelNames::new(model, Scope::Lab);
    let mut globals = Globals::new();
    Compiler::new(&names, &mut globals).expression(text).program.expect("the expression is right")
}

/// The time of the error expression with each evaluator: name and ns.
fn error_expression() -> Vec<(&'static str, f64)> {
    let model = xml::compile(MODEL).expect("the model is right");
    let program = program(&model, ERROR);
    let n = 200_000;
    let at = |i: usize| (1.0 - 1e-6 * i as f64, 1e-5 * i as f64);
    let mut rows = Vec::new();

    rows.push((
        "native Rust",
        time(n, |i| {
            let (q, t) = black_box(at(i));
            black_box(1000.0 * (q - (1.0 - 0.5 * 9.81 * t * t)));
        }),
    ));

    let reads = &program.effects().reads;
    let key = |name: &str| {
        let field = labspec_core::reflect::field(labspec_core::reflect::Object::Data, name).expect("a field");
        FieldKey(field.index() as u32)
    };
    let keys = [key("time"), key("qpos")];
    assert_eq!(reads.len(), 2);

    let mut recording = Recording::new();
    let columnar = recording.columns(&program).expect("the first").expect("it computes with numbers");
    let data = Data::planned(&model, Plan::full());
    let mut world = World {
        data,
        model: model.clone(),
        key: None,
        functions: labspec::Functions::new(),
        displayed: Vec::new(),
        numbers: Vec::new(),
        playback: None,
    };
    for i in 0..SAMPLES {
        let (q, t) = at(i);
        world.set(keys[1], 2, q).and_then(|()| world.set(keys[0], 0, t)).expect("both may be set");
        recording.sample(&world).expect("its own model");
    }
    let (mut scratch, mut out) = (Vec::new(), vec![0.0; SAMPLES]);
    let whole = time(200, |_| {
        columnar.evaluate_into(black_box(&recording), &mut scratch, &mut out).expect("its own recording");
        black_box(&out);
    });
    rows.push(("columnar, per sample", whole / SAMPLES as f64));

    let mut small = Small { time: 0.0, qpos: [0.0; 7], keys, model: model.identity() };
    let mut context = Context::new();
    rows.push((
        "by row, a host of two fields",
        time(n, |i| {
            (small.qpos[2], small.time) = at(i);
            let _ = black_box(program.run(&mut small, &mut context, None));
        }),
    ));
    rows.push((
        "by row, in the engine",
        time(n, |_| {
            let _ = black_box(program.run(black_box(&mut world), &mut context, None));
        }),
    ));

    // Formulas cannot read an array whose length changes at run time.
    let load = self::program(&model, "data.efc_force[0]");
    let mut context = Context::new();
    rows.push((
        "one load, through the machine",
        time(n, |i| {
            small.qpos[0] = at(i).0;
            let _ = black_box(load.run(&mut small, &mut context, None));
        }),
    ));

    let parser = fasteval::Parser::new();
    let mut slab = fasteval::Slab::new();
    let compiled =
        parser.parse(OTHERS, &mut slab.ps).expect("right").from(&slab.ps).compile(&slab.ps, &mut slab.cs);
    rows.push((
        "fasteval 0.2, compiled",
        time(n, |i| {
            let (q, t) = at(i);
            let mut names = |name: &str, _: Vec<f64>| match name {
                "q" => Some(q),
                "t" => Some(t),
                _ => None,
            };
            black_box(compiled.eval(&slab, &mut names).expect("right"));
        }),
    ));

    let mut engine = rhai::Engine::new_raw();
    engine.register_global_module(rhai::packages::Package::as_shared_module(
        &rhai::packages::StandardPackage::new(),
    ));
    let tree = engine.compile_expression(OTHERS).expect("right");
    let mut scope = rhai::Scope::new();
    scope.push("q", 0.0f64).push("t", 0.0f64);
    rows.push((
        "rhai 1",
        time(n / 10, |i| {
            let (q, t) = at(i);
            scope.set_value("q", q).set_value("t", t);
            black_box(engine.eval_ast_with_scope::<f64>(&mut scope, &tree).expect("right"));
        }),
    ));

    let tree = evalexpr::build_operator_tree(OTHERS).expect("right");
    let mut names = evalexpr::HashMapContext::new();
    rows.push((
        "evalexpr 11.3.1",
        time(n / 10, |i| {
            use evalexpr::ContextWithMutableVariables;
            let (q, t) = at(i);
            names.set_value("q".into(), evalexpr::Value::Float(q)).expect("right");
            names.set_value("t".into(), evalexpr::Value::Float(t)).expect("right");
            black_box(tree.eval_float_with_context(&names).expect("right"));
        }),
    ));
    rows
}

/// All labs of the corpus, each with its model.
fn corpus() -> Vec<(String, Lab, Arc<Model>)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/corpus");
    let Ok(folder) = ModelFolder::open(&root.join("models")) else { return Vec::new() };
    let mut labs = Vec::new();
    for part in ["labs", "quizzes"] {
        let mut files: Vec<_> =
            std::fs::read_dir(root.join(part)).into_iter().flatten().flatten().map(|e| e.path()).collect();
        files.sort();
        for file in files {
            let Ok(source) = SourceFile::read(&file) else { continue };
            let lesson = load_lesson(source, &folder);
            let models = Models::new(folder.clone());
            for lab in lesson.all_labs() {
                if let Some(model) = models.model_of_lab(lab, &mut Vec::new()) {
                    let title = if lab.title().is_empty() { "(without a title)" } else { lab.title() };
                    labs.push((title.to_owned(), lab.clone(), model));
                }
            }
        }
    }
    labs
}

fn main() {
    let mut page = String::from(
        "# Speed of the language\n\nMeasured by `cargo run --release -- ../../../docs/measured/speed-language.md` in `tests/speed/expr`: the minimum of 25 rounds.\n\n## The error of a free fall\n\n",
    );
    let _ = write!(page, "    {ERROR}\n\n| evaluator | ns | relative to native |\n|---|---:|---:|\n");
    let rows = error_expression();
    let native = rows[0].1;
    for (name, ns) in &rows {
        let _ = writeln!(page, "| {name} | {ns:.1} | {:.1} |", ns / native);
    }
    page.push_str("\n*Columnar* evaluates over recorded samples, as for the traces of a run. *By row* is one run of the program, the cost of a\ncontroller. The other evaluators are compiled once and receive their variables for every evaluation, as labspec does.\n");

    let labs = corpus();
    let longest = labs
        .iter()
        .filter_map(|(title, lab, model)| Some((lab.controller.as_ref()?.value.clone(), title, lab, model)))
        .max_by_key(|(text, ..)| text.len());
    if let Some((text, title, lab, model)) = longest {
        let programs = Programs::compile(lab, model, &mut Vec::new());
        let plan = Some(Plan::new(model, &AccessSet::ANY));
        let mut session = Session::start(&programs, model, Start { plan, ..Start::of_lab(lab) });
        (0..lab.controls.len()).for_each(|i| session.press(i));
        (0..200).for_each(|_| session.step());
        let controller = programs.controller.as_ref().expect("it has one");
        let ns = time(50_000, |_| {
            let _ = black_box(controller.program.run(&mut session.world, &mut session.context, None));
        });
        let _ = write!(
            page,
            "\n## The longest controller in the corpus\n\n{title}: {ns:.0} ns per call.\n\n    {text}\n"
        );
    }

    if !labs.is_empty() {
        page.push_str("\n## Compiling\n\nTime to compile all programs of a lab, from text to program, including every check:\n\n| lab | texts | µs |\n|---|---:|---:|\n");
        for (title, lab, model) in &labs {
            let texts = Programs::compile(lab, model, &mut Vec::new()).bound().count();
            if texts == 0 {
                continue;
            }
            let ns = time(20, |_| {
                black_box(Programs::compile(lab, model, &mut Vec::new()));
            });
            let _ = writeln!(page, "| {title} | {texts} | {:.0} |", ns / 1000.0);
        }
    }
    match std::env::args().nth(1) {
        Some(path) => std::fs::write(&path, page).expect("the page can be written"),
        None => print!("{page}"),
    }
}
