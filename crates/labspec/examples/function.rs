//! Adds a function to the language, and uses it in an expression and in a lab.

use labspec::{Engine, Error, Functions, Player};

const DROP: &str = "<mujoco><worldbody><geom type='plane' size='1 1 1'/>
  <body name='bob' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>";
const LAB: &str = r#"{"model": "drop",
  "plots": [{"traces": [{"label": "air pressure (Pa)", "expr": "pressure(data.qpos[2])"}]}]}"#;

pub(crate) fn main() -> Result<(), Error> {
    function().map(|printed| print!("{printed}"))
}

/// The air pressure at the height of the bob.
pub(crate) fn function() -> Result<String, Error> {
    let barometric = |x: &[f64]| match x {
        [height] if height.is_finite() => Ok(101_325.0 * (-height / 8434.5).exp()),
        _ => Err("a height is a finite number of metres".to_string()),
    };
    let functions = Functions::new().with("pressure", 1, "air pressure at a height", barometric)?;
    let mut engine = Engine::compile(DROP)?.with_functions(functions.clone());
    let above = engine.expression("pressure(0) - pressure(data.qpos[2])")?.number(&mut engine)?;
    let slip = engine.expression("presure(1)").err().map_or(String::new(), |e| e.to_string());
    let mut player = Player::of_lesson_with("lab.json", LAB, "#1", [("drop", DROP)], functions)?;
    player.play_to(0.2)?;
    Ok(format!("{above:.3} Pa less\n{slip}\nafter 0.2 s: {:.3} Pa\n", player.numbers()[0]))
}
