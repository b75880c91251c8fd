//! Opens a lab, changes its controls and plays it.

use labspec::{Error, Player};

const LAB: &str = r#"{
  "model": "drop",
  "controls": [{"label": "gravity", "unit": "m/s^2", "set": "model.opt.gravity[2]",
                "min": -20, "max": -1, "step": 0.1, "value": -9.8, "reset": true}],
  "plots": [{"ylabel": "height (m)", "traces": [{"label": "bob", "expr": "data.body('bob').xpos[2]"}]}]
}"#;
const DROP: &str = "<mujoco><worldbody><geom type='plane' size='1 1 1'/>
  <body name='bob' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>";

pub(crate) fn main() -> Result<(), Error> {
    lab().map(|printed| print!("{printed}"))
}

/// The height of a bob after 0.2 s, with the gravity of the lab and with less gravity.
pub(crate) fn lab() -> Result<String, Error> {
    let mut player = Player::of_lab(LAB, [("drop", DROP)])?;
    player.play_to(0.2)?;
    let (bob, saved) = (player.displayed()[0].clone(), player.save());
    let as_it_stands = player.numbers()[0];
    player.set("gravity", -1.6)?;
    player.play_to(0.2)?;
    let displayed =
        format!("{}: {as_it_stands:.4} {}, on the moon {:.4}\n", bob.label, bob.unit, player.numbers()[0]);
    player.restore(&saved)?;
    Ok(format!("{displayed}restored: {:.4}, {} findings\n", player.numbers()[0], player.findings().len()))
}
