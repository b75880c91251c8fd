//! The constants of actuators that `mj_setConst` computes.

use super::row;
use crate::dynamics::mass;
use crate::kinds::{biastype, gaintype, trntype};
use crate::model::{Fields, Model};

/// Computes `jnt_actuatorid` and `tendon_actuatorid`: the actuator whose armature and damping act on a joint or tendon, -1 for
/// none and -2 for several.
pub fn reflected(m: &mut Model) {
    m.jnt_actuatorid.fill(-1);
    m.tendon_actuatorid.fill(-1);
    for i in 0..m.nactuator {
        let poly = &m.actuator_dampingpoly[2 * i..2 * i + 2];
        if m.actuator_armature[i] == 0.0 && m.actuator_damping[i] == 0.0 && poly == [0.0; 2] {
            continue;
        }
        let target = m.actuator_trnid[2 * i] as usize;
        let slot = match m.actuator_trntype[i] {
            trntype::JOINT | trntype::JOINTINPARENT => &mut m.jnt_actuatorid[target],
            trntype::TENDON => &mut m.tendon_actuatorid[target],
            _ => continue,
        };
        *slot = if *slot == -1 { i as i32 } else { -2 };
    }
}

/// Computes `actuator_length0` and `actuator_acc0` = |M⁻¹ moment|, with `d` in the default configuration.
pub fn at_default(m: &mut Model, d: &Fields) {
    m.actuator_length0.copy_from_slice(&d.actuator_length);
    let mut x = vec![0.0; m.nv];
    for o in 0..m.nout {
        x.fill(0.0);
        for entry in row(d, o) {
            x[d.moment_colind[entry] as usize] = d.actuator_moment[entry];
        }
        mass::solve(m, &d.qLD, &d.qLDiagInv, &mut x, 0..m.nv);
        m.actuator_acc0[o] = x.iter().map(|a| a * a).sum::<f64>().sqrt();
    }
}

/// Converts damping ratios ζ, which are stored as positive numbers in the place of -kv: kv = 2 ζ √(kp m), with the inertia m = Σ
/// M_ii/moment_i² that the servo moves in the default configuration.
pub fn critical_damping(m: &mut Model, d: &Fields) {
    for i in 0..m.nactuator {
        let kp = -m.actuator_biasprm[10 * i + 1];
        let servo = match m.actuator_gaintype[i] {
            gaintype::FIXED => m.actuator_biastype[i] == biastype::AFFINE,
            gaintype::SO3 => true,
            kind => kind == gaintype::PID,
        };
        let same = m.actuator_gaintype[i] == gaintype::PID || m.actuator_gainprm[10 * i] == kp;
        let ratio = m.actuator_biasprm[10 * i + 2];
        if !servo || !same || ratio <= 0.0 {
            continue;
        }
        let mass: f64 = row(d, m.actuator_outadr[i] as usize)
            .filter(|&entry| d.actuator_moment[entry].abs() > crate::math::MINVAL)
            .map(|entry| {
                m.dof_M0[d.moment_colind[entry] as usize]
                    / (d.actuator_moment[entry] * d.actuator_moment[entry])
            })
            .sum();
        m.actuator_biasprm[10 * i + 2] = -2.0 * ratio * (kp * mass).max(0.0).sqrt();
    }
}
