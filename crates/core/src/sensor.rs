//! Sensors, by the stage at which what they measure is known.

use crate::math::*;
use crate::reflect::Stage;
use crate::{Data, Model, Obj};

/// Types of sensors (mjtSensor).
pub mod kind {
    /// Position of a slide or hinge joint.
    pub const JOINTPOS: i32 = 9;
    /// Velocity of a slide or hinge joint.
    pub const JOINTVEL: i32 = 10;
    /// Orientation of a ball joint.
    pub const BALLQUAT: i32 = 18;
    /// Position of an object's frame, world.
    pub const FRAMEPOS: i32 = 26;
    /// Orientation of an object's frame, world.
    pub const FRAMEQUAT: i32 = 27;
    /// Simulated time.
    pub const CLOCK: i32 = 45;
}

/// Sensors of the position stage.
pub(crate) fn position_stage(m: &Model, d: &mut Data) {
    for s in 0..m.nsensor {
        let id = m.sensor_objid[s].max(0) as usize;
        let adr = m.sensor_adr[s] as usize;
        match m.sensor_type[s] {
            kind::JOINTPOS => d.sensordata[adr] = d.qpos[m.jnt_qposadr[id] as usize],
            kind::BALLQUAT => {
                let q = &d.qpos[m.jnt_qposadr[id] as usize..][..4];
                let q = quat_normalize([q[0], q[1], q[2], q[3]]);
                d.sensordata[adr..adr + 4].copy_from_slice(&q);
            }
            kind::FRAMEPOS => {
                let p = object_pos(d, m.sensor_objtype[s], id);
                d.sensordata[adr..adr + 3].copy_from_slice(&p);
            }
            kind::FRAMEQUAT => {
                let q = object_quat(m, d, m.sensor_objtype[s], id);
                d.sensordata[adr..adr + 4].copy_from_slice(&q);
            }
            kind::CLOCK => d.sensordata[adr] = d.time,
            _ => continue,
        }
        cutoff(m, d, s);
    }
}

/// Sensors of the velocity stage.
pub(crate) fn velocity_stage(m: &Model, d: &mut Data) {
    for s in 0..m.nsensor {
        if m.sensor_type[s] == kind::JOINTVEL {
            let id = m.sensor_objid[s].max(0) as usize;
            d.sensordata[m.sensor_adr[s] as usize] = d.qvel[m.jnt_dofadr[id] as usize];
            cutoff(m, d, s);
        }
    }
}

/// Sensors of the acceleration stage.
pub(crate) fn acceleration_stage(_m: &Model, _d: &mut Data) {}

/// Whether some sensor of the model uses the results of a stage.
pub(crate) fn needs(_m: &Model, _stage: Stage) -> bool {
    false
}

/// Clamps real values to ± cutoff. Quaternions are not clamped.
fn cutoff(m: &Model, d: &mut Data, s: usize) {
    let c = m.sensor_cutoff[s];
    if c <= 0.0 || matches!(m.sensor_type[s], kind::BALLQUAT | kind::FRAMEQUAT) {
        return;
    }
    let adr = m.sensor_adr[s] as usize;
    for x in &mut d.sensordata[adr..adr + m.sensor_dim[s] as usize] {
        *x = x.clamp(-c, c);
    }
}

fn object_pos(d: &Data, objtype: i32, id: usize) -> Vec3 {
    let from = match objtype {
        t if t == Obj::Body as i32 => &d.xipos,
        t if t == Obj::Geom as i32 => &d.geom_xpos,
        t if t == Obj::Site as i32 => &d.site_xpos,
        _ => &d.xpos,
    };
    rows::<3>(from)[id]
}

fn object_quat(m: &Model, d: &Data, objtype: i32, id: usize) -> Quat {
    let xquat = rows::<4>(&d.xquat);
    let (body, local) = match objtype {
        t if t == Obj::Body as i32 => (id, rows::<4>(&m.body_iquat)[id]),
        t if t == Obj::Geom as i32 => (m.geom_bodyid[id] as usize, rows::<4>(&m.geom_quat)[id]),
        t if t == Obj::Site as i32 => (m.site_bodyid[id] as usize, rows::<4>(&m.site_quat)[id]),
        _ => return xquat[id],
    };
    quat_mul(xquat[body], local)
}
