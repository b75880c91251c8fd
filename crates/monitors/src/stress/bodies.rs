//! Geoms, bodies and joints of a model: which geoms can collide, how thick they are, and their names in messages.

use labspec_core::math::{Vec3, mat_t_mul_vec, quat_to_mat, rows, sub};
use labspec_core::{Model, can_collide, geom, geom_half_extents, geom_thickness, joint};

/// The smallest extent of a body, m: of a box along its axes around all its geoms that can collide. Infinite where a geom
/// is infinite.
pub(super) fn body_thickness(m: &Model, body: usize) -> f64 {
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    let bits = |list: &[i32], g: usize| list.get(g).copied().unwrap_or(0);
    for g in (0..m.ngeom).filter(|&g| body_of(m, g) == body) {
        let paired = m.pair_geom1.iter().chain(&m.pair_geom2).any(|&x| x == g as i32);
        if bits(&m.geom_contype, g) == 0 && bits(&m.geom_conaffinity, g) == 0 && !paired {
            continue;
        }
        if geom_thickness(m, g).is_infinite() {
            return f64::INFINITY;
        }
        let axes = quat_to_mat(rows::<4>(&m.geom_quat).get(g).copied().unwrap_or([1.0, 0.0, 0.0, 0.0]));
        let centre = rows::<3>(&m.geom_pos).get(g).copied().unwrap_or_default();
        let half = geom_half_extents(m, g);
        for k in 0..3 {
            // A sphere has the same width along every axis.
            let reach = match m.geom_type.get(g) {
                Some(&geom::SPHERE) => half[0],
                _ => (0..3).map(|i| axes[3 * k + i].abs() * half[i]).sum(),
            };
            ends[k] = [ends[k][0].min(centre[k] - reach), ends[k][1].max(centre[k] + reach)];
        }
    }
    ends.iter().map(|[low, high]| high - low).filter(|x| *x >= 0.0).fold(f64::INFINITY, f64::min)
}

/// The name of a body; its index if it has none.
pub fn body_name(m: &Model, body: usize) -> String {
    match m.names.body.get(body) {
        _ if body == 0 => "the world".into(),
        Some(name) if !name.is_empty() => format!("\"{name}\""),
        _ => format!("body {body}"),
    }
}

/// The name of a geom, or else of its body.
pub fn geom_name(m: &Model, g: usize) -> String {
    match m.names.geom.get(g) {
        Some(name) if !name.is_empty() => format!("\"{name}\""),
        _ => body_name(m, body_of(m, g)),
    }
}

/// A geom with the word: `geom "ball"`, or its number and its body.
pub fn geom_label(m: &Model, g: usize) -> String {
    if let Some(name) = m.names.geom.get(g).filter(|name| !name.is_empty()) {
        return format!("geom \"{name}\"");
    }
    let body = body_of(m, g);
    match m.names.body.get(body).filter(|name| body > 0 && !name.is_empty()) {
        Some(name) => format!("geom {g} of body \"{name}\""),
        None => format!("geom {g}"),
    }
}

/// The joint of a degree of freedom, in words.
pub fn joint_of_dof(m: &Model, dof: usize) -> String {
    joint_name(m, &m.jnt_dofadr, joint::nv, dof)
}

/// The joint of a coordinate, in words.
pub fn joint_of_place(m: &Model, i: usize) -> String {
    joint_name(m, &m.jnt_qposadr, joint::nq, i)
}

/// The joint that contains the index `i`, where `start` and `width` are the first index and the number of each joint.
fn joint_name(m: &Model, start: &[i32], width: fn(i32) -> usize, i: usize) -> String {
    let holds = |j: &usize| {
        let first = start.get(*j).map_or(0, |&a| a as usize);
        (first..first + width(m.jnt_type.get(*j).copied().unwrap_or(joint::HINGE))).contains(&i)
    };
    let Some(j) = (0..m.njnt).find(holds) else { return format!("degree of freedom {i}") };
    let body = || body_name(m, m.jnt_bodyid.get(j).map_or(0, |&b| b as usize));
    match m.names.joint.get(j) {
        Some(name) if !name.is_empty() => format!("joint \"{name}\""),
        _ => format!("the joint of {}", body()),
    }
}

/// The body of a geom.
pub fn body_of(m: &Model, g: usize) -> usize {
    m.geom_bodyid.get(g).map_or(0, |&b| b as usize)
}

/// Pairs of geoms in which the second, which is finite, may stop the first. Returns at most `most` pairs, and whether there
/// are more.
pub fn pairs(m: &Model, most: usize) -> (Vec<[usize; 2]>, bool) {
    let mut list = Vec::new();
    let moves = |g: &usize| m.body_treeid.get(body_of(m, *g)).is_some_and(|&t| t >= 0);
    let (first, last): (Vec<usize>, Vec<usize>) = (0..m.ngeom).partition(moves);
    for g in first.into_iter().chain(last) {
        for p in 0..m.ngeom {
            if g != p
                && geom_thickness(m, p).is_finite()
                && geom_thickness(m, g).is_finite()
                && may_meet(m, g, p)
            {
                if list.len() == most {
                    return (list, true);
                }
                list.push([g, p]);
            }
        }
    }
    (list, false)
}

/// Whether the engine tests two geoms for contacts: their bodies move relative to each other, are not parent and child, and
/// neither their bits nor an exclusion separates them.
pub(super) fn may_meet(m: &Model, g: usize, p: usize) -> bool {
    let weld = |g: usize| m.body_weldid.get(body_of(m, g)).map_or(0, |&w| w as usize);
    let above = |w: usize| {
        let parent = m.body_parentid.get(w).map_or(0, |&b| b as usize);
        m.body_weldid.get(parent).map_or(0, |&w| w as usize)
    };
    let [a, b] = [weld(g), weld(p)];
    let moves = |w: usize| {
        m.body_treeid.get(w).is_some_and(|&t| t >= 0) || m.body_mocapid.get(w).is_some_and(|&i| i >= 0)
    };
    let bodies = [body_of(m, g), body_of(m, p)].map(|b| b as i32);
    let excluded = m.exclude_bodies.iter().any(|two| *two == bodies || [two[1], two[0]] == bodies);
    let kin = a != 0 && b != 0 && (above(a) == b || above(b) == a);
    let both = [g as i32, p as i32];
    let paired = m.pair_geom1.iter().zip(&m.pair_geom2).any(|(&x, &y)| [x, y] == both || [y, x] == both);
    a != b && (moves(a) || moves(b)) && (paired || !excluded && !kin && can_collide(m, g, p).unwrap_or(false))
}

/// The centre of a geom in the frame of another one, m.
pub(super) fn centre_in_frame(xpos: &[f64], xmat: &[f64], g: usize, p: usize) -> Option<Vec3> {
    let centre_of = |g: usize| rows::<3>(xpos).get(g).copied();
    let axes = rows::<9>(xmat).get(p)?;
    Some(mat_t_mul_vec(axes, sub(centre_of(g)?, centre_of(p)?)))
}
