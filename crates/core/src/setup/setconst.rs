//! `mj_setConst`: constants of the model that are computed from other parameters, in the default configuration.

use crate::constraint::ends;
use crate::dynamics::kinematics::sameframe;
use crate::dynamics::{self, camera, com, mass, tree_algorithms, walk};
use crate::forces::{tendon, transmission};
use crate::kinds::{geom, joint, simple};
use crate::math::*;
use crate::model::plan::PlanTable;
use crate::model::{Fields, Model};
use crate::step::reset;
use crate::step::workspace::{StepScratch, Workspace};

/// Recomputes the constants that depend on masses, inertias and poses (`mj_setConst`).
///
/// Uses `d` as workspace, with a visible effect: on return, `qpos` is the configuration `qpos_spring` (normally `qpos0`), the
/// position fields are those of that configuration, and `qvel`, `time`, `act` and `ctrl` are unchanged. A call during a
/// simulation therefore moves bodies back to their initial positions and keeps their velocities.
pub(crate) fn set_const(m: &mut Model, d: &mut Fields, s: &mut StepScratch) {
    let plan = std::mem::replace(&mut d.plan, PlanTable::full());
    let solves = (m.nbody + m.njnt + m.ntendon) * (6 * m.nC / m.ntree.max(1) + 100);
    let pass = d.meter.half;
    d.meter.add(8 * pass + solves as u64);
    subtree_mass(m);
    mark_coincident_frames(m);
    trees(m);
    transmission::reflected(m);
    m.ngravcomp = m.body_gravcomp.iter().filter(|&&c| c > 0.0).count();

    d.qpos.copy_from_slice(&m.qpos0);
    positions(m, d, s);
    let all = 0..m.nv;
    mass::composite_inertia(m, d, &mut s.dynamics.path, std::slice::from_ref(&all));
    for i in 0..m.nv {
        m.dof_M0[i] = d.M[(m.M_rowadr[i] + m.M_rownnz[i] - 1) as usize];
    }
    tendon::armature(m, d);
    d.qLD.copy_from_slice(&d.M);
    mass::factor(m, &mut d.qLD, &mut d.qLDiagInv, 0..m.nv);
    inverse_weights(m, d);
    tendon::at_default(m, d);
    transmission::transmissions(m, d, &mut s.forces);
    transmission::at_default(m, d);
    transmission::critical_damping(m, d);
    ends::set_const(m, d);
    camera::set_const(m, d);
    statistics(m, d);

    d.qpos.copy_from_slice(&m.qpos_spring);
    positions(m, d, s);
    tendon::at_rest(m, d);
    reset::set_plan(m, d, s, plan);
}

/// Like [`set_const`], for a model that has no data yet.
pub(crate) fn set_const0(m: &mut Model) {
    let Workspace { fields: mut d, scratch: mut s } = Workspace::unplanned(m);
    set_const(m, &mut d, &mut s);
}

fn positions(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    tree_algorithms::load(m, &mut s.dynamics);
    dynamics::kinematics(m, d, &mut s.dynamics);
    com::com_pos(m, d);
    tendon::tendons(m, d);
}

fn subtree_mass(m: &mut Model) {
    m.body_subtreemass.copy_from_slice(&m.body_mass);
    for i in (1..m.nbody).rev() {
        let parent = m.body_parentid[i] as usize;
        m.body_subtreemass[parent] += m.body_subtreemass[i];
    }
}

/// Sets the addresses of the bodies and degrees of freedom of each tree.
fn trees(m: &mut Model) {
    m.tree_bodynum.fill(0);
    m.tree_dofnum.fill(0);
    for b in (0..m.nbody).rev().filter(|&b| m.body_treeid[b] >= 0) {
        let t = m.body_treeid[b] as usize;
        m.tree_bodyadr[t] = b as i32;
        m.tree_bodynum[t] += 1;
    }
    for k in (0..m.nv).rev() {
        let t = m.dof_treeid[k] as usize;
        m.tree_dofadr[t] = k as i32;
        m.tree_dofnum[t] += 1;
    }
}

/// Sets which inertial frames, geoms and sites coincide with the frame of their body. Their poses are then copied.
fn mark_coincident_frames(m: &mut Model) {
    let (ipos, iquat) = (rows::<3>(&m.body_ipos), rows::<4>(&m.body_iquat));
    for b in 0..m.nbody {
        m.body_sameframe[b] = match (same(ipos[b], [0.0; 3]), same_rotation(iquat[b], IDENTITY)) {
            (true, true) => sameframe::BODY,
            (false, true) => sameframe::BODYROT,
            _ => sameframe::NONE,
        };
    }
    let relation = |b: usize, pos: Vec3, quat: Quat| {
        if same_rotation(quat, IDENTITY) {
            if same(pos, [0.0; 3]) { sameframe::BODY } else { sameframe::BODYROT }
        } else if same_rotation(quat, iquat[b]) {
            if same(pos, ipos[b]) { sameframe::INERTIA } else { sameframe::INERTIAROT }
        } else {
            sameframe::NONE
        }
    };
    let (pos, quat) = (rows::<3>(&m.geom_pos), rows::<4>(&m.geom_quat));
    for g in 0..m.ngeom {
        m.geom_sameframe[g] = relation(m.geom_bodyid[g] as usize, pos[g], quat[g]);
    }
    let (pos, quat) = (rows::<3>(&m.site_pos), rows::<4>(&m.site_quat));
    for s in 0..m.nsite {
        m.site_sameframe[s] = relation(m.site_bodyid[s] as usize, pos[s], quat[s]);
    }
}

/// Frames whose numbers all differ by less than this count as equal (measured on MuJoCo 3.14.0).
const SAME: f64 = 1e-6;

fn same<const N: usize>(a: [f64; N], b: [f64; N]) -> bool {
    a.iter().zip(b).all(|(x, y)| (x - y).abs() < SAME)
}

/// q and -q are the same rotation.
fn same_rotation(a: Quat, b: Quat) -> bool {
    same(a, b) || same(a, scale(b, -1.0))
}

/// `body_invweight0` and `dof_invweight0`: the mean acceleration that a unit force causes.
///
/// For a body, the mean diagonal of J M⁻¹ Jᵀ at its centre of mass, for translation and for rotation. For a degree of freedom,
/// the diagonal of M⁻¹, averaged over each group of degrees of freedom of a joint.
fn inverse_weights(m: &mut Model, d: &Fields) {
    let cdof = rows::<6>(&d.cdof);
    let (xipos, com) = (rows::<3>(&d.xipos), rows::<3>(&d.subtree_com));
    let mut x = vec![0.0; m.nv];
    let mut row = vec![0.0; m.nv];
    // Trees are not coupled: each solve is restricted to one tree.
    let tree = |m: &Model, dof: usize| {
        let t = m.dof_treeid[dof] as usize;
        let first = m.tree_dofadr[t] as usize;
        first..first + m.tree_dofnum[t] as usize
    };
    for b in 0..m.nbody {
        let last = walk::last_dof(m, b);
        if last < 0 || b == 0 {
            rows_mut::<2>(&mut m.body_invweight0)[b] = [0.0; 2];
            continue;
        }
        if m.body_simple[b] == simple::SLIDING {
            rows_mut::<2>(&mut m.body_invweight0)[b] = [1.0 / m.body_mass[b].max(MINVAL), 0.0];
            continue;
        }
        let dofs = tree(m, last as usize);
        let arm = sub(xipos[b], com[m.body_rootid[b] as usize]);
        let mut diag = [0.0; 6];
        for (axis, out) in diag.iter_mut().enumerate() {
            row[dofs.clone()].fill(0.0);
            for k in walk::upward(m, last) {
                let c = &cdof[k];
                let v = add(linear(c), cross(angular(c), arm));
                row[k] = if axis < 3 { v[axis] } else { c[axis - 3] };
            }
            x[dofs.clone()].copy_from_slice(&row[dofs.clone()]);
            mass::solve(m, &d.qLD, &d.qLDiagInv, &mut x, dofs.clone());
            *out = dot_slice(&row[dofs.clone()], &x[dofs.clone()]);
        }
        let mean = |i: usize| (diag[i] + diag[i + 1] + diag[i + 2]) / 3.0;
        rows_mut::<2>(&mut m.body_invweight0)[b] = [mean(0), mean(3)];
    }

    for j in 0..m.njnt {
        let (first, n) = (m.jnt_dofadr[j] as usize, joint::nv(m.jnt_type[j]));
        for k in first..first + n {
            let dofs = tree(m, k);
            x[dofs.clone()].fill(0.0);
            x[k] = 1.0;
            mass::solve(m, &d.qLD, &d.qLDiagInv, &mut x, dofs);
            m.dof_invweight0[k] = x[k];
        }
        for group in m.dof_invweight0[first..first + n].chunks_mut(3) {
            let mean = group.iter().sum::<f64>() / group.len() as f64;
            group.fill(mean);
        }
        if m.body_simple[m.jnt_bodyid[j] as usize] == simple::SLIDING {
            m.dof_invweight0[first] = 1.0 / m.body_mass[m.jnt_bodyid[j] as usize].max(MINVAL);
        }
    }
}

/// `stat`: means over bodies, and a box around all objects with a position.
fn statistics(m: &mut Model, d: &Fields) {
    let bodies = (m.nbody - 1) as f64;
    m.stat.meanmass = if m.nbody > 1 { m.body_mass.iter().skip(1).sum::<f64>() / bodies } else { 1.0 };
    m.stat.meaninertia = if m.nv > 0 { mass::trace(m, &d.M, 0..m.nv) / m.nv as f64 } else { 1.0 };
    let sizes = body_sizes(m, d);
    m.stat.meansize = if m.nbody > 1 { sizes.iter().skip(1).sum::<f64>() / bodies } else { 0.2 };
    for (k, length) in m.dof_length.iter_mut().enumerate() {
        // The first three degrees of freedom of a free joint, and that of a slide, already have the unit of a length.
        let j = m.dof_jntid[k] as usize;
        let moves = match m.jnt_type[j] {
            joint::FREE => k < m.jnt_dofadr[j] as usize + 3,
            kind => kind == joint::SLIDE,
        };
        *length = if moves { 1.0 } else { sizes[m.dof_bodyid[k] as usize] };
    }

    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    let mut include = |p: Vec3, r: f64| {
        for i in 0..3 {
            low[i] = low[i].min(p[i] - r);
            high[i] = high[i].max(p[i] + r);
        }
    };
    for b in 1..m.nbody {
        include(rows::<3>(&d.xpos)[b], 0.0);
        include(rows::<3>(&d.xipos)[b], 0.0);
    }
    for j in 0..m.njnt {
        include(rows::<3>(&d.xanchor)[j], 0.0);
    }
    for s in 0..m.nsite {
        include(rows::<3>(&d.site_xpos)[s], 0.0);
    }
    for g in 0..m.ngeom {
        include(rows::<3>(&d.geom_xpos)[g], reach(m, g));
    }
    let side = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    m.stat.center =
        if low[0].is_finite() { std::array::from_fn(|i| 0.5 * (low[i] + high[i])) } else { [0.0; 3] };
    m.stat.extent = if side > 0.0 { side.max(2.0 * m.stat.meansize) } else { 2.0 };
}

/// The largest distance from the centre of a geom to its surface, m. A plane, which is infinite, counts as a tenth of its
/// rendered size.
fn reach(m: &Model, g: usize) -> f64 {
    let [x, y, _] = rows::<3>(&m.geom_size)[g];
    match m.geom_type[g] {
        geom::PLANE if x > 0.0 || y > 0.0 => 0.1 * x.max(y),
        geom::PLANE => 0.01,
        _ => m.geom_rbound[g],
    }
}

/// For each body, the largest distance from its centre of mass to its geoms and to the joints to its parent and children, m.
fn body_sizes(m: &Model, d: &Fields) -> Vec<f64> {
    let xipos = rows::<3>(&d.xipos);
    // A body without geoms and joints counts as a point.
    let mut size = vec![1e-5f64; m.nbody];
    for j in 0..m.njnt {
        let b = m.jnt_bodyid[j] as usize;
        for b in [b, m.body_parentid[b] as usize] {
            size[b] = size[b].max(norm(sub(rows::<3>(&d.xanchor)[j], xipos[b])));
        }
    }
    for g in 0..m.ngeom {
        let b = m.geom_bodyid[g] as usize;
        if m.geom_rbound[g] > 0.0 {
            size[b] = size[b].max(norm(sub(rows::<3>(&d.geom_xpos)[g], xipos[b])) + m.geom_rbound[g]);
        }
    }
    size
}

#[cfg(test)]
mod tests {
    use crate::mjcf::compile;

    /// Scenes, with the values of MuJoCo 3.14.0 for extent, height of the centre, meansize and meanmass.
    #[test]
    fn statistics_are_those_of_mujoco() {
        let ball = "<body pos='0 0 1'><freejoint/><geom size='.1'/></body>";
        let mass = 4.188790204786391;
        let cases = [
            (String::new(), [2.0, 0.0, 0.2, 1.0]),
            ("<geom size='.05'/>".into(), [0.4, 0.0, 0.2, 1.0]),
            ("<geom size='.5'/>".into(), [1.0, 0.0, 0.2, 1.0]),
            ("<geom type='plane' size='1 0 1'/>".into(), [0.4, 0.0, 0.2, 1.0]),
            ("<site pos='1 0 0'/>".into(), [2.0, 0.0, 0.2, 1.0]),
            (ball.into(), [0.2, 1.0, 0.1, mass]),
            (format!("<geom type='plane' size='1 2 3'/>{ball}"), [1.3, 0.45, 0.1, mass]),
            (format!("<geom type='plane' size='0 0 3'/>{ball}"), [1.11, 0.545, 0.1, mass]),
            (format!("<geom type='plane' size='1 1 1' pos='5 0 0'/>{ball}"), [5.2, 0.5, 0.1, mass]),
            (format!("<site size='1' pos='0 0 1'/>{ball}"), [0.2, 1.0, 0.1, mass]),
            (format!("<body pos='0 0 1'/>{ball}"), [1.1, 1.45, 0.050005, mass / 2.0]),
            (
                "<body pos='0 0 1'><joint pos='0 0 .5'/><geom size='.1' pos='.3 0 0'/></body>".into(),
                [1.16619037896906, 1.2, 0.58309518948453, mass],
            ),
        ];
        for (scene, expected) in cases {
            let m = compile(&format!("<mujoco><worldbody>{scene}</worldbody></mujoco>")).unwrap();
            let found = [m.stat.extent, m.stat.center[2], m.stat.meansize, m.stat.meanmass];
            for (a, b) in found.iter().zip(expected) {
                assert!((a - b).abs() < 1e-12 * (1.0 + b), "{scene}: {found:?}, not {expected:?}");
            }
        }
    }
}
