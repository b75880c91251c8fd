//! The addresses of objects in the arrays of the data, so that data can be read by object without the model.

use crate::kinds::joint;
use crate::model::Model;
use crate::model::index::{element_range, object_index};

/// The addresses of objects in the arrays of the data: first index and number of elements.
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
        let joints = |adr: &[i32], size: fn(i32) -> usize| {
            adr.iter().zip(&m.jnt_type).map(|(&a, &kind)| [object_index(a), size(kind)]).collect()
        };
        let pairs = |adr: &[i32], n: &[i32]| {
            let range = |(&a, &n): (&i32, &i32)| element_range(a, n);
            adr.iter().zip(n).map(range).map(|range| [range.start, range.len()]).collect()
        };
        Addresses {
            qpos: joints(&m.jnt_qposadr, joint::nq),
            qvel: joints(&m.jnt_dofadr, joint::nv),
            ctrl: pairs(&m.actuator_ctrladr, &m.actuator_ctrlnum),
            output: m.actuator_outadr.iter().map(|&a| object_index(a)).collect(),
            sensor: pairs(&m.sensor_adr, &m.sensor_dim),
        }
    }
}
