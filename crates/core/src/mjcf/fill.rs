//! Writes specifications to the arrays of [`Model`].

use super::arrays::{flat, padded};
use super::gather::listed;
use super::layout::{Dof, SparsityPattern, TreeLayout, WholePattern};
use super::spec::{
    ActuatorSpec, BodySpec, EqualitySpec, ExcludeSpec, GeomSpec, Inertia, JointSpec, KeySpec, PairSpec,
    SOLIMP, SOLREF, SensorSpec, SiteSpec, TendonSpec,
};
use crate::kinds::joint;
use crate::math::{IDENTITY, MINVAL, quat_normalize, rows_mut};
use crate::mjcf::actuator::fill_actuator::{self, ActuatorCounts};
use crate::mjcf::asset::fill_asset;
use crate::mjcf::asset::read_asset::Assets;
use crate::mjcf::constraint::fill_constraint;
use crate::mjcf::scene::fill_scene;
use crate::mjcf::tendon::fill_tendon;
use crate::model::{Model, Names, reflect};

/// The sizes that a keyframe depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sizes {
    pub(crate) nq: usize,
    pub(crate) nv: usize,
    pub(crate) nmocap: usize,
    pub(crate) na: usize,
    pub(crate) nu: usize,
}

/// The number of user values per object of each kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Users {
    pub(crate) body: usize,
    pub(crate) joint: usize,
    pub(crate) tendon: usize,
    pub(crate) sensor: usize,
    pub(crate) geom: usize,
    pub(crate) site: usize,
    pub(crate) camera: usize,
    pub(crate) actuator: usize,
    /// The number of user values of the model itself.
    pub(crate) data: usize,
}

/// The inputs from which a model is filled.
pub(crate) struct Parts<'a> {
    pub(crate) bodies: &'a [BodySpec],
    pub(crate) inertias: &'a [Inertia],
    pub(crate) layout: &'a TreeLayout,
    pub(crate) simple: &'a [i32],
    pub(crate) pattern: SparsityPattern,
    pub(crate) whole: WholePattern,
    pub(crate) tendons: &'a [TendonSpec],
    pub(crate) actuators: &'a [ActuatorSpec],
    pub(crate) counts: ActuatorCounts,
    pub(crate) equalities: &'a [EqualitySpec],
    pub(crate) pairs: &'a [PairSpec],
    pub(crate) excludes: &'a [ExcludeSpec],
    pub(crate) users: Users,
    pub(crate) scene: &'a fill_scene::SceneFields,
    pub(crate) assets: &'a Assets,
    pub(crate) sensors: &'a [SensorSpec],
    pub(crate) keys: &'a [KeySpec],
}

/// Joints, geoms and sites in the order of their ids, each with its body.
struct Members<'a> {
    joints: Vec<(usize, &'a JointSpec)>,
    geoms: Vec<(usize, &'a GeomSpec)>,
    sites: Vec<(usize, &'a SiteSpec)>,
}

/// Fills the model, except options, statistics and the fields that `mj_setConst` computes.
pub(crate) fn fill_arrays(m: &mut Model, parts: Parts) {
    let list = parts.bodies;
    let members = Members {
        joints: members(list, |b| &b.joints),
        geoms: members(list, |b| &b.geoms),
        sites: members(list, |b| &b.sites),
    };
    set_sizes(m, &parts, &members);
    reflect::allocate_model(m);
    // Computed by `mj_setConst`.
    m.jnt_actuatorid.fill(-1);
    m.tendon_actuatorid.fill(-1);
    m.names = names(std::mem::take(&mut m.names.model), &parts, &members);

    let Parts { layout, simple, scene, assets, .. } = parts;
    bodies(m, list, parts.inertias, layout, simple);
    joints(m, list, &members.joints);
    dofs(m, &members.joints, &layout.dofs, simple);
    let SparsityPattern { rownnz, rowadr, colind } = parts.pattern;
    (m.M_rownnz, m.M_rowadr, m.M_colind) = (rownnz, rowadr, colind);
    let SparsityPattern { rownnz, rowadr, colind } = parts.whole.pattern;
    (m.D_rownnz, m.D_rowadr, m.D_colind, m.D_diag) = (rownnz, rowadr, colind, parts.whole.diag);
    fill_scene::geoms(m, &members.geoms, scene);
    bodies_from_geoms(m);
    fill_scene::sites(m, &members.sites, scene);
    let body_names: Vec<String> = listed(list.iter().map(|b| b.name.clone()));
    fill_scene::cameras(m, &self::members(list, |b| &b.cameras), &body_names);
    fill_scene::lights(m, &self::members(list, |b| &b.lights), &body_names, &scene.textures);
    fill_tendon::tendons(m, parts.tendons);
    fill_actuator::actuators(m, parts.actuators);
    fill_constraint::equalities(m, parts.equalities);
    fill_constraint::contacts(m, parts.pairs, parts.excludes);
    fill_sensors(m, parts.sensors);
    fill_keys(m, list, parts.keys);
    fill_asset::meshes(m, assets);
    fill_asset::hfields(m, assets);
    fill_scene::materials(m, scene);
    fill_asset::skins(m, assets);
    fill_scene::custom(m, scene);
}

/// Sets the sizes of all arrays.
fn set_sizes(m: &mut Model, parts: &Parts, members: &Members) {
    let Parts { bodies: list, layout, sensors, counts, users, .. } = parts;
    m.nq = layout.nq;
    m.nv = layout.dofs.len();
    m.nbody = list.len();
    m.ntree = layout.ntree;
    m.njnt = members.joints.len();
    m.ngeom = members.geoms.len();
    m.nsite = members.sites.len();
    m.ncam = list.iter().map(|b| b.cameras.len()).sum();
    m.nlight = list.iter().map(|b| b.lights.len()).sum();
    m.nmocap = layout.nmocap;
    m.nsensor = sensors.len();
    m.nsensordata = sensors.iter().map(|s| s.dim as usize).sum();
    m.nhistory += sensors.iter().map(SensorSpec::history).sum::<usize>();
    m.nkey = parts.keys.len();
    m.nC = parts.pattern.colind.len();
    m.nD = parts.whole.pattern.colind.len();
    fill_tendon::count(m, parts.tendons);
    m.nactuator = parts.actuators.len();
    (m.nu, m.nout, m.na) = (counts.nu, counts.nout, counts.na);
    m.nhistory += counts.nhistory;
    (m.neq, m.npair, m.nexclude) = (parts.equalities.len(), parts.pairs.len(), parts.excludes.len());
    (m.nuser_body, m.nuser_jnt, m.nuser_tendon) = (users.body, users.joint, users.tendon);
    (m.nuser_geom, m.nuser_site, m.nuser_cam) = (users.geom, users.site, users.camera);
    (m.nuser_sensor, m.nuser_actuator, m.nuserdata) = (users.sensor, users.actuator, users.data);
    fill_scene::count(m, parts.scene);
    fill_asset::count(m, parts.assets);
}

/// The names of all objects except assets and custom data, whose names are set together with their fields.
fn names(model: String, parts: &Parts, members: &Members) -> Names {
    let Parts { bodies: list, .. } = parts;
    let names = |list: &mut dyn Iterator<Item = &String>| list.cloned().collect::<Vec<String>>();
    Names {
        model,
        body: names(&mut list.iter().map(|b| &b.name)),
        joint: names(&mut members.joints.iter().map(|(_, j)| &j.name)),
        geom: names(&mut members.geoms.iter().map(|(_, g)| &g.name)),
        site: names(&mut members.sites.iter().map(|(_, s)| &s.name)),
        camera: names(&mut list.iter().flat_map(|b| &b.cameras).map(|c| &c.name)),
        light: names(&mut list.iter().flat_map(|b| &b.lights).map(|l| &l.name)),
        pair: names(&mut parts.pairs.iter().map(|p| &p.name)),
        exclude: names(&mut parts.excludes.iter().map(|e| &e.name)),
        equality: names(&mut parts.equalities.iter().map(|e| &e.name)),
        tendon: names(&mut parts.tendons.iter().map(|t| &t.name)),
        actuator: names(&mut parts.actuators.iter().map(|a| &a.name)),
        sensor: names(&mut parts.sensors.iter().map(|s| &s.name)),
        key: names(&mut parts.keys.iter().map(|k| &k.name)),
        ..Names::default()
    }
}

/// The members of all bodies in the order of their ids, each with its body.
fn members<T>(list: &[BodySpec], list_of: impl Fn(&BodySpec) -> &Vec<T>) -> Vec<(usize, &T)> {
    listed(list.iter().enumerate().flat_map(|(i, b)| list_of(b).iter().map(move |x| (i, x))))
}

/// The address and the count of the members of each body. The address is -1 if there are none.
fn addresses(list: &[BodySpec], count: impl Fn(&BodySpec) -> usize) -> (Vec<i32>, Vec<i32>) {
    let mut next = 0;
    let mut address = |b| {
        let n = count(b);
        let first = if n == 0 { -1 } else { next as i32 };
        next += n;
        (first, n as i32)
    };
    list.iter().map(&mut address).unzip()
}

fn bodies(m: &mut Model, list: &[BodySpec], inertias: &[Inertia], layout: &TreeLayout, simple: &[i32]) {
    flat(&mut m.body_parentid, list, |b| [b.parent as i32]);
    flat(&mut m.body_rootid, &layout.root, |&i| [i as i32]);
    flat(&mut m.body_weldid, &layout.weld, |&i| [i as i32]);
    m.body_mocapid = layout.mocap.clone();
    m.body_treeid = layout.body_tree.clone();
    (m.body_jntadr, m.body_jntnum) = addresses(list, |b| b.joints.len());
    (m.body_geomadr, m.body_geomnum) = addresses(list, |b| b.geoms.len());
    flat(&mut m.body_dofnum, &layout.body_dofs, |&(_, n)| [n as i32]);
    flat(&mut m.body_dofadr, &layout.body_dofs, |&(address, n)| [if n == 0 { -1 } else { address as i32 }]);
    m.body_simple = simple.to_vec();
    flat(&mut m.body_pos, list, |b| b.pos);
    flat(&mut m.body_quat, list, |b| b.quat);
    flat(&mut m.body_ipos, inertias, |i| i.pos);
    flat(&mut m.body_iquat, inertias, |i| i.quat);
    flat(&mut m.body_mass, inertias, |i| [i.mass]);
    flat(&mut m.body_inertia, inertias, |i| i.moments);
    flat(&mut m.body_gravcomp, list, |b| [b.gravcomp]);
    padded(&mut m.body_user, list.iter().map(|b| &b.user), m.nuser_body);
}

fn joints(m: &mut Model, list: &[BodySpec], joints: &[(usize, &JointSpec)]) {
    let (mut qpos, mut dof) = (0, 0);
    m.jnt_qposadr.clear();
    m.jnt_dofadr.clear();
    m.qpos0.clear();
    m.qpos_spring.clear();
    for &(body, j) in joints {
        m.jnt_qposadr.push(qpos as i32);
        m.jnt_dofadr.push(dof as i32);
        qpos += joint::nq(j.kind);
        dof += joint::nv(j.kind);
        match (j.kind, list.get(body)) {
            (joint::FREE, Some(b)) => {
                for q in [&mut m.qpos0, &mut m.qpos_spring] {
                    q.extend(b.pos);
                    q.extend(b.quat);
                }
            }
            (joint::BALL, _) => {
                m.qpos0.extend(IDENTITY);
                m.qpos_spring.extend(IDENTITY);
            }
            _ => {
                m.qpos0.push(j.reference);
                m.qpos_spring.push(j.springref);
            }
        }
    }
    flat(&mut m.jnt_type, joints, |(_, j)| [j.kind]);
    flat(&mut m.jnt_bodyid, joints, |&(b, _)| [b as i32]);
    flat(&mut m.jnt_limited, joints, |(_, j)| [j.limited]);
    flat(&mut m.jnt_solref, joints, |(_, j)| j.solref);
    flat(&mut m.jnt_solimp, joints, |(_, j)| j.solimp);
    flat(&mut m.jnt_pos, joints, |(_, j)| j.pos);
    flat(&mut m.jnt_axis, joints, |(_, j)| j.axis);
    flat(&mut m.jnt_group, joints, |(_, j)| [j.group]);
    flat(&mut m.jnt_actfrclimited, joints, |(_, j)| [j.actfrclimited]);
    flat(&mut m.jnt_actfrcrange, joints, |(_, j)| j.actfrcrange);
    flat(&mut m.jnt_actgravcomp, joints, |(_, j)| [j.actgravcomp]);
    flat(&mut m.jnt_stiffness, joints, |(_, j)| [j.stiffness[0]]);
    flat(&mut m.jnt_stiffnesspoly, joints, |(_, j)| [j.stiffness[1], j.stiffness[2]]);
    padded(&mut m.jnt_user, joints.iter().map(|(_, j)| &j.user), m.nuser_jnt);
    flat(&mut m.jnt_range, joints, |(_, j)| j.range);
    flat(&mut m.jnt_margin, joints, |(_, j)| [j.margin]);
}

fn dofs(m: &mut Model, joints: &[(usize, &JointSpec)], dofs: &[Dof], simple: &[i32]) {
    flat(&mut m.dof_bodyid, dofs, |d| [d.body as i32]);
    flat(&mut m.dof_jntid, dofs, |d| [d.joint as i32]);
    flat(&mut m.dof_parentid, dofs, |d| [d.parent.map_or(-1, |p| p as i32)]);
    flat(&mut m.dof_treeid, dofs, |d| [d.tree as i32]);
    let of_joint = |d: &Dof| joints.get(d.joint).map(|&(_, j)| j);
    flat(&mut m.dof_armature, dofs, |d| [of_joint(d).map_or(0.0, |j| j.armature)]);
    flat(&mut m.dof_frictionloss, dofs, |d| [of_joint(d).map_or(0.0, |j| j.frictionloss)]);
    flat(&mut m.dof_solref, dofs, |d| of_joint(d).map_or(SOLREF, |j| j.solref_friction));
    flat(&mut m.dof_solimp, dofs, |d| of_joint(d).map_or(SOLIMP, |j| j.solimp_friction));
    let damping = |d: &Dof| of_joint(d).map_or([0.0; 3], |j| j.damping);
    flat(&mut m.dof_damping, dofs, |d| [damping(d)[0]]);
    flat(&mut m.dof_dampingpoly, dofs, |d| [damping(d)[1], damping(d)[2]]);
    // Counted from the end: a simple degree of freedom continues the sequence that follows it.
    let mut run = 0;
    flat(&mut m.dof_simplenum, dofs.iter().rev(), |d| {
        run = if simple.get(d.body).is_some_and(|&s| s != 0) { run + 1 } else { 0 };
        [run]
    });
    m.dof_simplenum.reverse();
}

/// The contact bits of a body are the union of those of its geoms, and its margin is the largest margin of a geom.
fn bodies_from_geoms(m: &mut Model) {
    m.visual_geoms.clear();
    for (g, &b) in m.geom_bodyid.iter().enumerate() {
        let b = b as usize;
        m.body_contype[b] |= m.geom_contype[g];
        m.body_conaffinity[b] |= m.geom_conaffinity[g];
        m.body_margin[b] = m.body_margin[b].max(m.geom_margin[g] + m.geom_gap[g]);
        if m.geom_contype[g] == 0 && m.geom_conaffinity[g] == 0 {
            m.visual_geoms.push(g as i32);
        }
    }
}

fn fill_sensors(m: &mut Model, sensors: &[SensorSpec]) {
    let (mut next, mut history) = (0, m.nhistory - sensors.iter().map(SensorSpec::history).sum::<usize>());
    m.sensor_adr.clear();
    m.sensor_historyadr.clear();
    for s in sensors {
        m.sensor_adr.push(next);
        next += s.dim;
        m.sensor_historyadr.push(if s.history() == 0 { -1 } else { history as i32 });
        history += s.history();
    }
    flat(&mut m.sensor_type, sensors, |s| [s.kind]);
    flat(&mut m.sensor_datatype, sensors, |s| [s.datatype]);
    flat(&mut m.sensor_needstage, sensors, |s| [s.needstage]);
    flat(&mut m.sensor_objtype, sensors, |s| [s.objects.objtype]);
    flat(&mut m.sensor_objid, sensors, |s| [s.objects.objid]);
    flat(&mut m.sensor_reftype, sensors, |s| [s.objects.reftype]);
    flat(&mut m.sensor_refid, sensors, |s| [s.objects.refid]);
    flat(&mut m.sensor_intprm, sensors, |s| s.intprm);
    flat(&mut m.sensor_dim, sensors, |s| [s.dim]);
    flat(&mut m.sensor_cutoff, sensors, |s| [s.cutoff]);
    flat(&mut m.sensor_noise, sensors, |s| [s.noise]);
    flat(&mut m.sensor_history, sensors, |s| [s.timing.nsample, s.timing.interp]);
    flat(&mut m.sensor_delay, sensors, |s| [s.timing.delay]);
    flat(&mut m.sensor_interval, sensors, |s| s.timing.interval);
    padded(&mut m.sensor_user, sensors.iter().map(|s| &s.user), m.nuser_sensor);
}

/// Fills the keyframes. Missing values are those of the reference configuration; quaternions are normalized.
fn fill_keys(m: &mut Model, bodies: &[BodySpec], keys: &[KeySpec]) {
    let mocap: Vec<&BodySpec> = listed(bodies.iter().filter(|b| b.mocap));
    let (mut mpos0, mut mquat0) = (Vec::new(), Vec::new());
    flat(&mut mpos0, &mocap, |b| b.pos);
    flat(&mut mquat0, &mocap, |b| b.quat);
    flat(&mut m.key_time, keys, |k| [k.time]);
    let key_values = |given: fn(&KeySpec) -> &Option<Vec<f64>>, rest: &[f64]| -> Vec<f64> {
        listed(keys.iter().flat_map(|k| given(k).as_deref().unwrap_or(rest)).copied())
    };
    m.key_qpos = key_values(|k| &k.qpos, &m.qpos0);
    m.key_qvel = key_values(|k| &k.qvel, &vec![0.0; m.nv]);
    m.key_act = key_values(|k| &k.act, &vec![0.0; m.na]);
    m.key_ctrl = key_values(|k| &k.ctrl, &vec![0.0; m.nu]);
    m.key_mpos = key_values(|k| &k.mpos, &mpos0);
    m.key_mquat = key_values(|k| &k.mquat, &mquat0);

    for q in rows_mut::<4>(&mut m.key_mquat) {
        // A zero quaternion is not changed here. It is normalized when the mocap body is placed.
        if q.iter().any(|x| x.abs() > MINVAL) {
            *q = quat_normalize(*q);
        }
    }
    let quats: Vec<usize> =
        listed(m.jnt_type.iter().zip(&m.jnt_qposadr).filter_map(|(&kind, &adr)| match kind {
            joint::FREE => Some(adr as usize + 3),
            joint::BALL => Some(adr as usize),
            _ => None,
        }));
    let nq = m.nq;
    for key in m.key_qpos.chunks_exact_mut(nq.max(1)) {
        for &start in &quats {
            if let Some(q) = key.get_mut(start..start + 4).and_then(|q| <&mut [f64; 4]>::try_from(q).ok()) {
                *q = quat_normalize(*q);
            }
        }
    }
}

/// Stiffness and damping of joints that are given by a time constant t and a damping ratio r. With the inertia I of the joint
/// in the default configuration, k = I/(t² r²) and b = 2 I/t.
pub(crate) fn spring_dampers(m: &mut Model, bodies: &[BodySpec]) {
    let joints = bodies.iter().flat_map(|b| &b.joints);
    for (j, [time, ratio]) in joints.enumerate().filter_map(|(j, spec)| Some((j, spec.springdamper?))) {
        let first = m.jnt_dofadr[j] as usize;
        let dofs = first..first + joint::nv(m.jnt_type[j]);
        let inertia = dofs.len() as f64 / m.dof_invweight0[dofs.clone()].iter().sum::<f64>().max(MINVAL);
        m.jnt_stiffness[j] = inertia / (time * time * ratio * ratio).max(MINVAL);
        m.dof_damping[dofs].fill(2.0 * inertia / time.max(MINVAL));
    }
}
