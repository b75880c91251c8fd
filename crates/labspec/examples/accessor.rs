//! Compiles a model and an expression that reads it, and evaluates the expression.

use labspec::{Engine, Error};

pub(crate) fn main() -> Result<(), Error> {
    accessor().map(|printed| print!("{printed}"))
}

/// A bob falls to the floor: its initial height, and its height at rest.
pub(crate) fn accessor() -> Result<String, Error> {
    let mut engine = Engine::compile(
        "<mujoco><worldbody><geom type='plane' size='1 1 1'/>
         <body name='bob' pos='0 0 1'><freejoint name='fall'/><geom size='0.1'/></body></worldbody></mujoco>",
    )?;
    let height = engine.expression("data.joint('fall').qpos[2]")?;
    engine.statements("data.joint('fall').qvel[2] = -1")?.run(&mut engine)?;
    let start = height.number(&mut engine)?;
    (0..1000).try_for_each(|_| engine.step())?;
    let typo = engine.expression("data.joint('fal').qpos[2]").err().map_or(String::new(), |e| e.to_string());
    Ok(format!("{start} m, then {:.3} m\n{typo}\n", height.number(&mut engine)?))
}
