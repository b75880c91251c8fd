//! Balances a pole on a cart: linearizes a step and computes a feedback gain from the Riccati equation.

use labspec_core::nalgebra::{FiniteDifferences, Transition, transition_fd};
use labspec_core::{Data, Error, Model, step};
use nalgebra::{DMatrix, DVector};

const CART: &str = "<mujoco><option timestep='0.01'/><worldbody>
  <body><joint name='x' type='slide' axis='1 0 0'/><geom size='0.1' mass='1'/>
   <body name='pole'><joint name='tilt' axis='0 1 0'/><geom size='0.05' pos='0 0 1' mass='0.2'/></body></body>
  </worldbody><actuator><motor name='push' joint='x'/></actuator></mujoco>";

pub(crate) fn main() -> Result<(), Error> {
    upright().map(|printed| print!("{printed}"))
}

/// The growth of the tilt in a step, and the tilt after 10 s with the feedback u = -K x, x = (x, tilt, their velocities).
pub(crate) fn upright() -> Result<String, Error> {
    let model = Model::from_xml(CART)?;
    let mut data = Data::new(&model);
    let Transition { a, b, .. } = transition_fd(&model, &data, &FiniteDifferences::default())?;
    let (mut cost, mut gain) = (DMatrix::identity(4, 4), DMatrix::zeros(1, 4));
    for _ in 0..2000 {
        let weighted = b.tr_mul(&cost);
        gain = &weighted * &a / (1.0 + (&weighted * &b)[0]);
        cost = DMatrix::identity(4, 4) + a.tr_mul(&cost) * (&a - &b * &gain);
    }
    data.set_joint_qpos("tilt", &[0.3])?;
    for _ in 0..1000 {
        let state = DVector::from_iterator(4, data.qpos.iter().chain(&data.qvel).copied());
        data.set_ctrl("push", (-&gain * state).as_slice())?;
        step(&model, &mut data)?;
    }
    let pole = data.body_pose("pole")?;
    Ok(format!(
        "A[3, 1] = {:.4}\ntilt {:.4} rad, x {:.4} m\n",
        a[(3, 1)],
        pole.rotation.angle(),
        pole.translation.x
    ))
}
