//! A controller that would change nothing is not run. All numbers, and the counted work, equal those of a run in which it runs
//! before each step, for any events in between.

#![allow(clippy::unwrap_used)]

use crate::support::{compile, model_text};
use labspec::Value;
use labspec::bind::Programs;
use labspec::lint::{ModelFolder, load_lesson};
use labspec::run::{Session, Start, is_steady};
use labspec::source::SourceFile;
use proptest::collection::vec;
use proptest::prelude::*;
use serde_json::json;

/// Controllers, and whether each may be skipped.
const CONTROLLERS: [(&str, bool); 10] = [
    ("data.qfrc_applied[2] = ctx.push", true),
    ("data.qfrc_applied[2] = ctx.push * ctx.kicks - 1 / (ctx.other || 3); data.qfrc_applied[8] = 0.2", true),
    ("data.qfrc_applied[2] = ctx.push > 1 ? model.opt.timestep * 100 : -model.body_mass[1]", true),
    ("if (ctx.push > 0) data.qfrc_applied[8] = data.qfrc_applied[2]", true),
    ("model.opt.gravity[2] = -9 - ctx.push", true),
    ("data.qfrc_applied[2] = data.qfrc_applied[2] + 0.01", false),
    ("data.qfrc_applied[2] = Math.sin(data.time) * ctx.push", false),
    ("ctx.count = (ctx.count || 0) + 1; data.qfrc_applied[2] = ctx.count * 0.001", false),
    ("data.qfrc_applied[2] = data.qpos[2]", false),
    ("data.qfrc_applied[2] = 0.3; mj.mj_forward(model, data)", false),
];

/// An event before a step.
#[derive(Clone, Debug)]
enum Event {
    Slide(f64),
    Kick,
    Reset,
    StartOver,
    Sample,
    Force(f64),
    Mass(f64),
    Timestep(f64),
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        (-2.0..2.0).prop_map(Event::Slide),
        Just(Event::Kick),
        Just(Event::Reset),
        Just(Event::StartOver),
        Just(Event::Sample),
        (-1.0..1.0).prop_map(Event::Force),
        (0.5..2.0).prop_map(Event::Mass),
        (0.001..0.004).prop_map(Event::Timestep),
    ]
}

fn apply(event: &Event, session: &mut Session<'_>) {
    let world = &mut session.world;
    match event {
        Event::Slide(x) => session.set_control(0, Value::Number(*x)),
        Event::Kick => session.press(1),
        Event::Reset => session.reset(),
        Event::StartOver => session.start_over(),
        Event::Sample => drop(session.sample()),
        Event::Force(x) => world.data.edit().qfrc_applied[2] = *x,
        Event::Mass(x) => world.model.edit().body_mass[1] = *x,
        Event::Timestep(x) => *world.model.edit().opt.timestep = *x,
    }
}

fn bits(session: &Session<'_>) -> Vec<u64> {
    let d = session.world.data.fields();
    let forces = d.qfrc_applied.iter().chain(&session.world.model.opt.gravity);
    let all = d.qpos.iter().chain(&d.qvel).chain(forces);
    all.chain([&d.time]).map(|x| x.to_bits()).chain([session.spent()]).collect()
}

fn programs(controller: &str) -> (Programs, labspec_core::Model) {
    let lab = json!({
        "xml": model_text("ball_drop"), "setup": "ctx.kicks = 0; data.qfrc_applied[2] = 0.5", "controller": controller,
        "controls": [{"label": "push", "param": "push", "min": -2, "max": 2, "value": 0.5},
            {"type": "button", "label": "Kick", "run": "ctx.kicks = ctx.kicks + 1; data.qfrc_applied[2] = 3"}],
        "plots": [{"traces": [{"label": "other", "expr": "ctx.other = data.qpos[2]"}, {"label": "height", "expr": "data.qpos[2]"}]}]
    });
    let lesson = load_lesson(SourceFile::new("lab.json", lab.to_string()), &ModelFolder::unknown());
    let lab = lesson.all_labs()[0];
    let model = compile(&lab.xml.as_ref().unwrap().value);
    (Programs::compile(lab, &model, &mut Vec::new()), model)
}

#[test]
fn skipped_controllers_follow_from_their_effects() {
    for (text, steady) in CONTROLLERS {
        let (programs, _) = programs(text);
        assert_eq!(is_steady(&programs.controller.as_ref().unwrap().program), steady, "{text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

    #[test]
    fn skipping_a_steady_controller_changes_no_number(
        which in 0..CONTROLLERS.len(),
        events in vec((0usize..40, event()), 0..8),
    ) {
        let (programs, model) = programs(CONTROLLERS[which].0);
        let mut without = programs.clone();
        let controller = without.controller.take().unwrap();
        let mut skipping = Session::start(&programs, &model, Start::default());
        let mut always = Session::start(&without, &model, Start::default());
        for step in 0..40 {
            for (_, event) in events.iter().filter(|(when, _)| *when == step) {
                apply(event, &mut skipping);
                apply(event, &mut always);
            }
            controller.program.run(&mut always.world, &mut always.context, None).unwrap();
            always.step();
            skipping.step();
            prop_assert_eq!(bits(&skipping), bits(&always), "{} after step {}", CONTROLLERS[which].0, step);
        }
    }
}
