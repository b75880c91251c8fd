//! Where objects are in the arrays of the data, so that data can be asked for them without the model.

use crate::kinds::joint;
use crate::model::Model;

/// Where objects are in the arrays of the data: first place and number.
#[derive(Debug, Default)]
pub(super) struct Addresses {
    pub(super) qpos: Vec<[usize; 2]>,
    pub(super) qvel: Vec<[usize; 2]>,
    pub(super) ctrl: Vec<[usize; 2]>,
    pub(super) output: Vec<usize>,
    pub(super) sensor: Vec<[usize; 2]>,
}

impl Addresses {
    pub(super) fn new(m: &Model) -> Addresses {
        let at = |x: i32| usize::try_from(x).unwrap_or(usize::MAX / 2);
        let joints = |adr: &[i32], size: fn(i32) -> usize| {
            adr.iter().zip(&m.jnt_type).map(|(&a, &kind)| [at(a), size(kind)]).collect()
        };
        let pairs = |adr: &[i32], n: &[i32]| {
            adr.iter().zip(n).map(|(&a, &n)| [at(a), usize::try_from(n).unwrap_or(0)]).collect()
        };
        Addresses {
            qpos: joints(&m.jnt_qposadr, joint::nq),
            qvel: joints(&m.jnt_dofadr, joint::nv),
            ctrl: pairs(&m.actuator_ctrladr, &m.actuator_ctrlnum),
            output: m.actuator_outadr.iter().map(|&a| at(a)).collect(),
            sensor: pairs(&m.sensor_adr, &m.sensor_dim),
        }
    }
}
