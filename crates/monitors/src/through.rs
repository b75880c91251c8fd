//! Tunnelling: detects a body that passed through another one because its steps were too long.
//!
//! A contact is found where two bodies overlap at the start of a step. A body that moves by more than the thickness of a
//! wall in one step may be in front of it in one step and behind it in the next, or so deep inside it that the contact
//! pushes it out on the wrong side. The monitor reports a geom whose centre crosses a middle plane of a wall, inside the
//! outline of the wall, in a step whose displacement is a considerable part of the wall's thickness. Solid bodies cannot
//! move there.
//!
//! The poses of the last two steps are compared only while a geom is fast relative to the thinnest wall and near a wall.

use super::sunk::{GeomSize, size};
use labspec_core::math::rows;
use labspec_core::reflect::Stage;
use labspec_core::{Data, Fields, Model, Scope, may_touch};

/// A displacement per step above this fraction of the thickness is fast: after a few such steps the contact pushes in the
/// wrong direction.
const FAST_DISPLACEMENT: f64 = 0.1;
/// Number of steps between two measurements of the speeds while no geom is both fast and near a wall.
const STEPS_PER_MEASUREMENT: u32 = 10;
/// Factor for the increase of the speed between two measurements, in the estimate of the distance that counts as near.
const MARGIN: f64 = 2.0;

/// A body that passed through another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Through {
    /// Time at which the step began, s.
    pub time: f64,
    /// The geom that passed, and the geom that it passed through.
    pub geoms: [usize; 2],
    /// Displacement relative to the other geom in the step, m.
    pub moved: f64,
    /// Thickness of the other geom, m.
    pub thickness: f64,
}

/// Monitors tunnelling by the poses of the previous step, which are stored while they are needed.
#[derive(Clone, Debug)]
pub struct TunnellingMonitor {
    /// Geoms that can make contacts, and the sizes of all geoms.
    geoms: Vec<usize>,
    sizes: Vec<GeomSize>,
    thinnest: f64,
    pos: Vec<f64>,
    mat: Vec<f64>,
    /// Displacement of each geom in the last step, including its rotation, m.
    moved: Vec<f64>,
    is_stored: bool,
    left: u32,
}

/// Starts monitoring the geoms of a model. No geom is monitored if there are no collisions or the plan does not compute
/// geom poses.
pub fn watch<S: Scope>(m: &Model, d: &Data<S>) -> TunnellingMonitor {
    let plan = d.plan();
    let has_poses = plan.keeps(Stage::Collision) && plan.keeps(Stage::GeomPoses);
    let touches = |g: &usize| m.geom_contype[*g] != 0 || m.geom_conaffinity[*g] != 0;
    let geoms: Vec<usize> = (0..m.ngeom).filter(touches).filter(|_| has_poses).collect();
    let sizes: Vec<GeomSize> = (0..m.ngeom).map(|g| size(m, g)).collect();
    let thinnest = geoms.iter().map(|&g| sizes[g].thickness).fold(f64::INFINITY, f64::min);
    let poses = |n: usize| vec![0.0; n * m.ngeom];
    TunnellingMonitor {
        geoms,
        sizes,
        thinnest,
        pos: poses(3),
        mat: poses(9),
        moved: poses(1),
        is_stored: false,
        left: 0,
    }
}

/// Resets the monitor after the state was changed from outside.
pub fn restart(w: &mut TunnellingMonitor) {
    (w.is_stored, w.left) = (false, 0);
}

/// Call after each step.
#[inline]
pub fn observe<S: Scope>(w: &mut TunnellingMonitor, m: &Model, d: &Data<S>) -> Option<Through> {
    if w.left > 0 {
        w.left -= 1;
        return None;
    }
    pass(w, m, d.fields())
}

/// Stores the poses. If the previous poses are stored, checks the geoms that moved for tunnelling.
#[inline(never)]
fn pass(w: &mut TunnellingMonitor, m: &Model, f: &Fields) -> Option<Through> {
    if w.geoms.len() < 2 || f.geom_xpos.len() != w.pos.len() || f.geom_xmat.len() != w.mat.len() {
        w.left = u32::MAX;
        return None;
    }
    let mut found = None;
    let mut awake = !w.is_stored;
    if w.is_stored {
        let fastest = measure(w, f);
        if fastest > 0.5 * FAST_DISPLACEMENT * w.thinnest {
            (awake, found) = walls(w, m, f);
        }
    }
    w.is_stored = awake;
    if awake {
        w.pos.copy_from_slice(&f.geom_xpos);
        w.mat.copy_from_slice(&f.geom_xmat);
    } else {
        w.left = STEPS_PER_MEASUREMENT;
    }
    found
}

/// Computes the displacement of each geom; returns the largest.
fn measure(w: &mut TunnellingMonitor, f: &Fields) -> f64 {
    let far = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    let mut most: f64 = 0.0;
    for &g in &w.geoms {
        let radius = if w.sizes[g].length.is_finite() { 0.5 * w.sizes[g].length } else { 0.0 };
        let turned = far(&w.mat[9 * g..9 * g + 9], &f.geom_xmat[9 * g..9 * g + 9]);
        w.moved[g] = far(&w.pos[3 * g..3 * g + 3], &f.geom_xpos[3 * g..3 * g + 3]) + radius * turned;
        most = most.max(w.moved[g]);
    }
    most
}

/// For every pair of a wall and a geom that is fast relative to it: whether it is near, and whether it passed through.
fn walls(w: &TunnellingMonitor, m: &Model, f: &Fields) -> (bool, Option<Through>) {
    let (current, mut near) = (rows::<3>(&f.geom_xpos), false);
    for &wall in w.geoms.iter().filter(|&&g| w.sizes[g].thickness.is_finite()) {
        let GeomSize { thickness, length } = w.sizes[wall];
        for &g in w.geoms.iter().filter(|&&g| g != wall && w.sizes[g].thickness.is_finite()) {
            let moved = w.moved[g] + w.moved[wall];
            if moved <= 0.5 * FAST_DISPLACEMENT * thickness {
                continue;
            }
            let gap =
                [0, 1, 2].map(|k| current[g][k] - current[wall][k]).map(|x| x * x).iter().sum::<f64>().sqrt();
            let soon = moved * (1.0 + MARGIN * f64::from(STEPS_PER_MEASUREMENT));
            if gap > 0.5 * (length + w.sizes[g].length) + soon || !may_touch(m, g, wall).unwrap_or(false) {
                continue;
            }
            near = true;
            if let Some(moved) = passed(w, m, f, g, wall) {
                let time = (f.time - m.opt.timestep).max(0.0);
                return (true, Some(Through { time, geoms: [g, wall], moved, thickness }));
            }
        }
    }
    (near, None)
}

/// Displacement of the centre of a geom in the frame of a wall, m, if it crossed a middle plane of the wall inside its
/// outline.
fn passed(w: &TunnellingMonitor, m: &Model, f: &Fields, g: usize, wall: usize) -> Option<f64> {
    let before = within(&w.pos, &w.mat, g, wall)?;
    let after = within(&f.geom_xpos, &f.geom_xmat, g, wall)?;
    let aabb = rows::<6>(&m.geom_aabb).get(wall)?;
    let [before, after] = [before, after].map(|x| [0, 1, 2].map(|k| x[k] - aabb[k]));
    let half = [aabb[3], aabb[4], aabb[5]];
    let crossed = (0..3).any(|k| {
        let part = before[k] / (before[k] - after[k]);
        let coordinate = |j: usize| before[j] + part * (after[j] - before[j]);
        // Without a crossing, `part` is outside 0..=1 or NaN. A vibration about the plane is not a crossing.
        let far = (before[k] - after[k]).abs() > 2.0 * FAST_DISPLACEMENT * half[k];
        far && (0.0..=1.0).contains(&part) && (0..3).all(|j| j == k || coordinate(j).abs() < half[j])
    });
    let length = [0, 1, 2].map(|k| after[k] - before[k]).map(|x| x * x).iter().sum::<f64>().sqrt();
    crossed.then_some(length)
}

/// The centre of a geom in the frame of another one.
fn within(pos: &[f64], mat: &[f64], g: usize, wall: usize) -> Option<[f64; 3]> {
    let (pos, mat) = (rows::<3>(pos), rows::<9>(mat).get(wall)?);
    let away = [0, 1, 2].map(|k| pos[g][k] - pos[wall][k]);
    Some([0, 1, 2].map(|k| mat[k] * away[0] + mat[3 + k] * away[1] + mat[6 + k] * away[2]))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use labspec_core::{step, xml};

    fn run(wall: &str, ball: &str, speed: f64) -> Option<Through> {
        let text = format!(
            "<mujoco><worldbody>{wall}<body name=\"ball\" pos=\"0 0 .15\"><freejoint/><geom {ball} mass=\".1\"/></body></worldbody></mujoco>"
        );
        let m = xml::compile(&text).unwrap();
        let mut d = Data::new(&m);
        let dof = m.nv - 6;
        d.edit().qvel[dof + 2] = -speed;
        let mut w = watch(&m, &d);
        (0..500).find_map(|_| {
            step(&m, &mut d).unwrap();
            observe(&mut w, &m, &d)
        })
    }

    #[test]
    fn boxes_that_pass_through_each_other_are_reported() {
        let cube = |z: f64| {
            format!(
                "<body pos=\"0 0 {z}\"><freejoint/><geom type=\"box\" size=\".1 .1 .1\" mass=\"1\"/></body>"
            )
        };
        let text = format!(
            "<mujoco><option timestep=\".1\"/><worldbody><geom type=\"plane\" size=\"1 1 1\"/>{}</worldbody></mujoco>",
            [cube(0.1), cube(0.3), cube(0.5)].concat()
        );
        let m = xml::compile(&text).unwrap();
        let mut d = Data::new(&m);
        let mut w = watch(&m, &d);
        let found = (0..20).find_map(|_| {
            step(&m, &mut d).unwrap();
            observe(&mut w, &m, &d)
        });
        assert!(d.qpos[16] < d.qpos[9], "the third box is below the second one");
        assert!(found.is_some_and(|f| f.moved > 0.2 && f.geoms.contains(&3)), "{found:?}");
    }

    const PLATE: &str = "<geom type=\"box\" size=\"1 1 .0005\"/>";

    #[test]
    fn a_ball_that_passes_a_plate_is_reported() {
        for (radius, speeds) in [(0.01, vec![1.0, 3.0, 10.0, 100.0]), (0.1, vec![30.0, 100.0, 300.0])] {
            for speed in speeds {
                let found = run(PLATE, &format!("size=\"{radius}\""), speed).unwrap();
                assert_eq!((found.geoms, found.thickness), ([1, 0], 0.001), "{speed} m/s");
                assert!(found.moved > 0.1e-3 && found.moved > 0.9e-3 * speed, "{speed} m/s: {found:?}");
            }
        }
        for speed in [0.0, 0.1, 1.0, 3.0, 10.0] {
            assert_eq!(run(PLATE, "size=\".1\"", speed), None, "{speed} m/s");
        }
    }

    #[test]
    fn permitted_passages_are_not_reported() {
        // Collision bits that do not match, a hole, and a body that passes beside the plate.
        assert_eq!(run(PLATE, "size=\".01\" contype=\"2\" conaffinity=\"2\"", 10.0), None);
        let hole = "<geom type=\"box\" pos=\".6 0 0\" size=\".5 1 .0005\"/><geom type=\"box\" pos=\"-.6 0 0\" size=\".5 1 .0005\"/>";
        assert_eq!(run(hole, "size=\".01\"", 10.0), None);
        assert_eq!(run("<geom type=\"box\" pos=\"2 0 0\" size=\"1 1 .0005\"/>", "size=\".01\"", 10.0), None);
        // A rotating card.
        let card = "<body pos=\"0 .5 .1\"><joint axis=\"1 0 0\"/><geom type=\"box\" size=\".1 .3 .0005\" mass=\"1\"/></body>";
        assert_eq!(run(card, "size=\".01\" pos=\"0 1.5 0\"", 0.0), None);
    }
}
