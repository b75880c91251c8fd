//! Which objects sleep: those of sleeping trees, and what acts on or measures nothing else.

use super::{awake, some};
use crate::sensor::kind;
use crate::{Data, Model, Obj, eqtype, trntype};

/// `tree_awake`, `body_awake` and the counts, from `tree_asleep`.
pub(super) fn update(m: &Model, d: &mut Data) {
    for (awake, asleep) in d.tree_awake.iter_mut().zip(&d.tree_asleep) {
        *awake = i32::from(*asleep < 0);
    }
    (d.nbody_awake, d.nparent_awake) = (0, 0);
    for b in 0..m.nbody {
        d.body_awake[b] = match usize::try_from(m.body_treeid[b]) {
            Ok(tree) if d.tree_awake[tree] == 0 => awake::NO,
            Ok(_) => awake::YES,
            // What is placed from outside may move at any time.
            Err(_) if m.body_mocapid[m.body_rootid[b] as usize] >= 0 => awake::YES,
            Err(_) => awake::STATIC,
        };
        let parent = d.body_awake[m.body_parentid[b] as usize];
        d.nbody_awake += usize::from(d.body_awake[b] != awake::NO);
        d.nparent_awake += usize::from(b > 0 && parent != awake::NO);
    }
    let of_awake = |&&tree: &&i32| d.tree_awake[tree as usize] != 0;
    d.nv_awake = m.dof_treeid.iter().filter(of_awake).count();
    d.ntree_awake = d.tree_awake.iter().filter(|&&a| a != 0).count();
}

/// Whether what actuator `i` acts on sleeps.
pub(crate) fn actuator_sleeps(m: &Model, d: &Data, i: usize) -> bool {
    some(m, d) && actuator(m, d, i) == awake::NO
}

/// Whether a tree sleeps.
pub(crate) fn tree_sleeps(m: &Model, d: &Data, tree: usize) -> bool {
    some(m, d) && d.tree_awake[tree] == 0
}

/// Whether a body sleeps.
pub(crate) fn body_sleeps(m: &Model, d: &Data, b: usize) -> bool {
    some(m, d) && d.body_awake[b] == awake::NO
}

/// Whether the trees on the path of tendon `t` sleep.
pub(crate) fn tendon_sleeps(m: &Model, d: &Data, t: usize) -> bool {
    some(m, d) && tendon(m, d, t) == awake::NO
}

/// Whether neither of two geoms is on a body that is awake: nothing new can come of them.
#[inline(always)]
pub(crate) fn pair_sleeps(m: &Model, d: &Data, geom1: usize, geom2: usize) -> bool {
    let is_awake = |geom: usize| d.body_awake[m.geom_bodyid[geom] as usize] == awake::YES;
    some(m, d) && !is_awake(geom1) && !is_awake(geom2)
}

/// Whether neither side of equality `e` is awake: it does not act.
pub(crate) fn equality_sleeps(m: &Model, d: &Data, e: usize) -> bool {
    let kind = match m.eq_type[e] {
        eqtype::JOINT => Obj::Joint as i32,
        eqtype::TENDON => Obj::Tendon as i32,
        _ => m.eq_objtype[e],
    };
    let is_awake = |id: i32| {
        let state = usize::try_from(id).ok().and_then(|id| of_object(m, d, kind, id));
        state == Some(awake::YES)
    };
    some(m, d) && !is_awake(m.eq_obj1id[e]) && !is_awake(m.eq_obj2id[e])
}

/// Whether all that sensor `s` measures sleeps or cannot move: its values stay as they are.
pub(crate) fn sensor_sleeps(m: &Model, d: &Data, s: usize) -> bool {
    if !some(m, d) {
        return false;
    }
    let types = [m.sensor_objtype[s], m.sensor_reftype[s]];
    let [object, reference] = [(types[0], m.sensor_objid[s]), (types[1], m.sensor_refid[s])]
        .map(|(kind, id)| usize::try_from(id).ok().and_then(|id| of_object(m, d, kind, id)));
    match m.sensor_type[s] {
        kind::USER | kind::RANGEFINDER => false,
        kind::CONTACT if types.contains(&(Obj::Site as i32)) => false,
        _ => match (object, reference) {
            (None, None) => false,
            (Some(one), None) | (None, Some(one)) => one == awake::NO,
            (Some(a), Some(b)) => a != awake::YES && b != awake::YES,
        },
    }
}

/// The state of an object, `None` where there is none.
fn of_object(m: &Model, d: &Data, kind: i32, id: usize) -> Option<i32> {
    let body = |list: &[i32]| list.get(id).map(|&b| d.body_awake[b as usize]);
    match kind {
        k if k == Obj::Body as i32 || k == Obj::XBody as i32 => d.body_awake.get(id).copied(),
        k if k == Obj::Joint as i32 => body(&m.jnt_bodyid),
        k if k == Obj::Geom as i32 => body(&m.geom_bodyid),
        k if k == Obj::Site as i32 => body(&m.site_bodyid),
        k if k == Obj::Camera as i32 => body(&m.cam_bodyid),
        k if k == Obj::Tendon as i32 => Some(tendon(m, d, id)),
        k if k == Obj::Actuator as i32 => Some(actuator(m, d, id)),
        _ => None,
    }
}

/// The state of a tendon: asleep when all trees on its path are.
fn tendon(m: &Model, d: &Data, t: usize) -> i32 {
    let is_awake = |tree: i32| usize::try_from(tree).is_ok_and(|tree| d.tree_awake[tree] != 0);
    let [first, second] = [m.tendon_treeid[2 * t], m.tendon_treeid[2 * t + 1]];
    match m.tendon_treenum[t] {
        0 => awake::STATIC,
        1 => i32::from(is_awake(first)),
        2 => i32::from(is_awake(first) || is_awake(second)),
        _ => awake::YES,
    }
}

/// The state of what an actuator acts on.
fn actuator(m: &Model, d: &Data, i: usize) -> i32 {
    let [id, reference] = [m.actuator_trnid[2 * i], m.actuator_trnid[2 * i + 1]];
    let body = |list: &[i32], id: i32| d.body_awake[list[id.max(0) as usize] as usize];
    let one_of_sites = || {
        let moves = |id: i32| body(&m.site_bodyid, id) == awake::YES;
        i32::from(moves(id) || moves(reference))
    };
    match m.actuator_trntype[i] {
        trntype::SLIDERCRANK => one_of_sites(),
        trntype::SO3 if reference >= 0 => one_of_sites(),
        trntype::TENDON => tendon(m, d, id.max(0) as usize),
        trntype::SITE => body(&m.site_bodyid, id),
        trntype::BODY => d.body_awake[id.max(0) as usize],
        _ => body(&m.jnt_bodyid, id),
    }
}
