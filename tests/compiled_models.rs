//! Labs on models that were compiled before.

#![allow(clippy::unwrap_used)]

use crate::support::model_text;
use labspec::{Error, Models, Player};
use std::collections::BTreeMap;

const LAB: &str = r#"{
  "model": "ball_drop", "setup": "data.qpos[2] = ctx.height",
  "controls": [
    {"label": "height", "unit": "m", "param": "height", "min": 0.5, "max": 2, "step": 0.5, "value": 1, "reset": true},
    {"type": "button", "label": "Kick", "run": "data.qvel[2] = 2"}],
  "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 4}]
}"#;

fn bits(player: &Player) -> Vec<u64> {
    let d = player.data().fields();
    d.qpos.iter().chain(&d.qvel).chain(player.numbers()).map(|x| x.to_bits()).collect()
}

/// Models as a page ships them: compiled ahead.
struct Stored(BTreeMap<String, Vec<u8>>);

impl Models for Stored {
    fn text(&self, _: &str) -> Option<String> {
        None
    }

    fn compiled(&self, name: &str) -> Option<Vec<u8>> {
        self.0.get(name).cloned()
    }
}

#[test]
fn a_lab_on_a_compiled_model_has_the_same_bits() {
    let stored = labspec_core::Model::from_xml(&model_text("ball_drop")).unwrap().to_bytes();
    let of = |bytes: Vec<u8>| Player::of_lab(LAB, Stored([("ball_drop".to_string(), bytes)].into()));
    let text = BTreeMap::from([("ball_drop".to_string(), model_text("ball_drop"))]);
    let (mut a, mut b) = (Player::of_lab(LAB, text).unwrap(), of(stored.clone()).unwrap());
    for lab in [&mut a, &mut b] {
        lab.set("height", 1.5).unwrap();
        lab.play_to(1.0).unwrap();
    }
    assert_eq!(bits(&a), bits(&b));
    assert_eq!(a.findings(), b.findings());
    // Damaged bytes, and a name that has none, are findings at the name.
    let mut damaged = stored;
    damaged[100] ^= 1;
    let code = |e: Error| match e {
        Error::Findings(list) => list.iter().map(|f| (f.code, f.span.clone())).collect::<Vec<_>>(),
        other => panic!("{other}"),
    };
    let at = LAB.find("ball_drop").unwrap();
    assert_eq!(code(of(damaged).unwrap_err()), [("model-unreadable", at..at + 9)]);
    assert_eq!(code(of(Vec::new()).unwrap_err())[0].0, "model-unreadable");
    let missing = Player::of_lab(LAB, Stored(BTreeMap::new()));
    assert_eq!(code(missing.unwrap_err())[0].0, "unknown-model");
}
