//! Contact bits that are changed during a run: the behaviour of MuJoCo, recorded by `tests/golden/switched.py`.

use labspec_core::reflect::{FieldSet, Object, field};
use labspec_core::xml::compile;
use labspec_core::{self as core, AccessSet, Data, Model, Plan, Planned};

/// The final height of the box, with a given plan.
fn height(m: &Model, mut d: Data<Planned>, writes: &[(&str, usize, f64)]) -> f64 {
    let mut m = m.clone();
    for step in 0..1000 {
        for &(name, index, value) in writes.iter().filter(|_| step == 50) {
            let written = field(Object::Model, name).unwrap();
            // Fields that the engine computes cannot be written, and have no effect in MuJoCo.
            if let Ok(mut view) = core::view_mut(&mut m, &mut d, written) {
                assert!(view.set(index, value), "{name}");
            }
        }
        core::step(&m, &mut d).unwrap();
    }
    d.fields().qpos[2]
}

#[test]
fn switched_flags_act_as_in_the_library() {
    let text = include_str!("../../../../tests/golden/switched.txt");
    let mut wrong = Vec::new();
    for line in text.lines() {
        let parts: Vec<&str> = line.split(" | ").collect();
        let [name, writes, recorded, xml] = parts[..] else { unreachable!("{line}") };
        let recorded: f64 = recorded.parse().unwrap();
        let write = |words: &'static str| {
            let words: Vec<&str> = words.split_whitespace().collect();
            let [field, index, value] = words[..] else { unreachable!("{line}") };
            (field, index.parse().unwrap(), value.parse().unwrap())
        };
        let writes: Vec<_> = writes.split("; ").filter(|w| !w.is_empty()).map(write).collect();
        let m = compile(xml).unwrap();
        let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
        access.reads.insert(field(Object::Data, "qpos").unwrap());
        let announced = AccessSet { writes: FieldSet::ALL, ..access };
        let plans = [
            Plan::full(),
            Plan::new(&m, &access),
            Plan::new(&m, &announced),
            Plan::for_any_value(&m, &announced),
        ];
        let heights = plans.map(|plan| height(&m, Data::planned(&m, plan), &writes));
        assert!(heights.iter().all(|x| x.to_bits() == heights[0].to_bits()), "{name}: {heights:?}");
        // For a box that falls, a tolerance of 1e-3 m is far less than the distance of one step.
        if (heights[0] - recorded).abs() > 1e-3 {
            wrong.push(format!("{name}: {} m, theirs {recorded}", heights[0]));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
