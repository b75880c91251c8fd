//! Forces that a student applies to bodies, such as the spring with which a body is dragged.

use super::Player;
use crate::error::Error;

impl Player {
    /// Sets the force (N) and the torque (N m) at the centre of mass of a body, in world axes: its row of `xfrc_applied`. They act in
    /// every step until they are set again or the lab is reset.
    ///
    /// # Errors
    /// There is no such body or it is the world, a number is not finite, or the lab is frozen.
    pub fn apply_force(&mut self, body: usize, force: [f64; 6]) -> Result<(), Error> {
        if body == 0 || body >= self.model().nbody {
            return Err(Error::Call(format!(
                "no force can act on body {body}: it is the world or does not exist"
            )));
        }
        if force.iter().any(|x| !x.is_finite()) {
            return Err(Error::Call("a force consists of finite numbers".into()));
        }
        self.act(|session| {
            let inputs = session.world.data.edit();
            for (to, from) in inputs.xfrc_applied.iter_mut().skip(6 * body).zip(force) {
                *to = from;
            }
        })
    }
}
