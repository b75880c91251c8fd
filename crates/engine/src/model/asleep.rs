//! Which objects sleep: those of sleeping trees, and objects that act on or measure only sleeping trees. Every stage uses these
//! functions. The stage that puts trees to sleep is `step/sleep`.

use super::stage::Stage;
use crate::kinds::{enable, eqtype, trntype};
use crate::model::index::object_index;
use crate::model::{Fields, Model, Obj};

/// Values of `tree_sleep_policy`.
pub mod policy {
    /// The compiler chose: the tree never sleeps.
    pub const AUTO_NEVER: i32 = 1;
    /// The compiler chose: the tree may sleep.
    pub const AUTO_ALLOWED: i32 = 2;
    /// The first of the three policies that an author can select: never, allowed, asleep at the start.
    pub const NEVER: i32 = 3;
    /// Asleep at the start.
    pub const INIT: i32 = 5;
}

/// Values of `body_awake` (mjtSleepState).
pub(crate) mod awake {
    pub(crate) const STATIC: i32 = -1;
    pub(crate) const NO: i32 = 0;
    pub(crate) const YES: i32 = 1;
}

/// Whether trees may sleep.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn on(m: &Model, d: &Fields) -> bool {
    d.plan.keeps(Stage::Sleep) && m.opt.enabled(enable::SLEEP)
}

/// Whether at least one tree sleeps.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn some(m: &Model, d: &Fields) -> bool {
    d.ntree_awake < m.ntree
}

/// Whether the target of actuator `i` sleeps.
pub(crate) fn actuator(m: &Model, d: &Fields, i: usize) -> bool {
    some(m, d) && actuator_state(m, d, i) == awake::NO
}

/// Whether a tree sleeps.
pub(crate) fn tree(m: &Model, d: &Fields, tree: usize) -> bool {
    some(m, d) && d.tree_awake[tree] == 0
}

/// Whether a body sleeps.
pub(crate) fn body(m: &Model, d: &Fields, b: usize) -> bool {
    some(m, d) && d.body_awake[b] == awake::NO
}

/// Whether the trees on the path of tendon `t` sleep.
pub(crate) fn tendon(m: &Model, d: &Fields, t: usize) -> bool {
    some(m, d) && tendon_state(m, d, t) == awake::NO
}

/// Whether neither geom is on an awake body. Such a pair needs no collision test.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn pair(m: &Model, d: &Fields, geom1: usize, geom2: usize) -> bool {
    let is_awake = |geom: usize| d.body_awake[m.geom_bodyid[geom] as usize] == awake::YES;
    some(m, d) && !is_awake(geom1) && !is_awake(geom2)
}

/// Whether neither side of equality `e` is awake. Such a constraint does not act.
pub(crate) fn equality(m: &Model, d: &Fields, e: usize) -> bool {
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

/// The state of an object, or `None` if there is no such object.
pub(crate) fn of_object(m: &Model, d: &Fields, kind: i32, id: usize) -> Option<i32> {
    let body = |list: &[i32]| list.get(id).map(|&b| d.body_awake[b as usize]);
    match kind {
        k if k == Obj::Body as i32 || k == Obj::XBody as i32 => d.body_awake.get(id).copied(),
        k if k == Obj::Joint as i32 => body(&m.jnt_bodyid),
        k if k == Obj::Geom as i32 => body(&m.geom_bodyid),
        k if k == Obj::Site as i32 => body(&m.site_bodyid),
        k if k == Obj::Camera as i32 => body(&m.cam_bodyid),
        k if k == Obj::Tendon as i32 => Some(tendon_state(m, d, id)),
        k if k == Obj::Actuator as i32 => Some(actuator_state(m, d, id)),
        _ => None,
    }
}

/// The state of a tendon. It is asleep if all trees on its path are.
#[inline(never)] // few scenes use sleep; the same applies to `actuator_state`
fn tendon_state(m: &Model, d: &Fields, t: usize) -> i32 {
    let is_awake = |tree: i32| usize::try_from(tree).is_ok_and(|tree| d.tree_awake[tree] != 0);
    let [first, second] = [m.tendon_treeid[2 * t], m.tendon_treeid[2 * t + 1]];
    match m.tendon_treenum[t] {
        0 => awake::STATIC,
        1 => i32::from(is_awake(first)),
        2 => i32::from(is_awake(first) || is_awake(second)),
        _ => awake::YES,
    }
}

/// The state of the target of an actuator.
#[inline(never)]
fn actuator_state(m: &Model, d: &Fields, i: usize) -> i32 {
    let [id, reference] = [m.actuator_trnid[2 * i], m.actuator_trnid[2 * i + 1]];
    let body = |list: &[i32], id: i32| d.body_awake[list[object_index(id)] as usize];
    let one_of_sites = || {
        let moves = |id: i32| body(&m.site_bodyid, id) == awake::YES;
        i32::from(moves(id) || moves(reference))
    };
    match m.actuator_trntype[i] {
        trntype::SLIDERCRANK => one_of_sites(),
        trntype::SO3 if reference >= 0 => one_of_sites(),
        trntype::TENDON => tendon_state(m, d, object_index(id)),
        trntype::SITE => body(&m.site_bodyid, id),
        trntype::BODY => d.body_awake[object_index(id)],
        _ => body(&m.jnt_bodyid, id),
    }
}
