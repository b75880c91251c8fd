//! Detects bodies that fall through a height field: the centre was above the surface and is below it by half of the
//! thickness of the body.

use super::bodies::{body_of, centre_in_frame, geom_name, may_meet};
use super::fault::{Fault, FaultEvidence, FaultKind};
use labspec_core::math::{Vec3, norm, rows, sub};
use labspec_core::{Fields, Model, geom, geom_thickness};

/// A geom above a height field.
pub(super) struct HeightFieldPair {
    geoms: [usize; 2],
    /// Its last position above the surface, in the frame of the field.
    above: Option<Vec3>,
    done: bool,
}

/// Geoms that may collide with a height field, at most `most` pairs.
pub(super) fn over(m: &Model, most: usize) -> Vec<HeightFieldPair> {
    let moves = |g: &usize| m.body_treeid.get(body_of(m, *g)).is_some_and(|&t| t >= 0);
    let fields: Vec<usize> = (0..m.ngeom).filter(|&p| m.geom_type.get(p) == Some(&geom::HFIELD)).collect();
    let pairs_of_field =
        |&p: &usize| (0..m.ngeom).filter(moves).filter(move |&g| may_meet(m, g, p)).map(move |g| [g, p]);
    let pairs = fields.iter().flat_map(pairs_of_field).filter(|[g, _]| geom_thickness(m, *g).is_finite());
    pairs.take(most).map(|geoms| HeightFieldPair { geoms, above: None, done: false }).collect()
}

impl HeightFieldPair {
    /// Call after bodies were moved from outside.
    pub(super) fn disturb(&mut self, m: &Model, d: &Fields) {
        let [g, p] = self.geoms;
        let place = centre_in_frame(&d.geom_xpos, &d.geom_xmat, g, p);
        self.above = place.filter(|place| surface(m, p, *place).is_some_and(|z| z <= place[2]));
    }

    /// Call after a step: detects a body that fell through.
    pub(super) fn observe(&mut self, m: &Model, d: &Fields) -> Option<Fault> {
        let [g, p] = self.geoms;
        if self.done {
            return None;
        }
        let place = centre_in_frame(&d.geom_xpos, &d.geom_xmat, g, p)?;
        let Some(surface) = surface(m, p, place) else {
            self.above = None;
            return None;
        };
        let depth = surface - place[2];
        if depth <= 0.0 {
            self.above = Some(place);
            return None;
        }
        let before = self.above?;
        if depth <= 0.5 * geom_thickness(m, g) {
            return None;
        }
        self.done = true;
        Some(fall_fault(m, d, self.geoms, norm(sub(place, before)), depth))
    }
}

/// The height of the surface of a field below a position in its frame; `None` beside the field.
fn surface(m: &Model, p: usize, place: Vec3) -> Option<f64> {
    let id = usize::try_from(*m.geom_dataid.get(p)?).ok()?;
    let [rx, ry, top, _] = *rows::<4>(&m.hfield_size).get(id)?;
    let count = |list: &[i32]| list.get(id).and_then(|n| usize::try_from(*n).ok());
    let (nrow, ncol, first) = (count(&m.hfield_nrow)?, count(&m.hfield_ncol)?, count(&m.hfield_adr)?);
    // The cell, and the position within it.
    let along = |x: f64, half: f64, n: usize| {
        let t = (x + half) / (2.0 * half) * n.checked_sub(1)? as f64;
        let cell = t.floor().clamp(0.0, n.saturating_sub(2) as f64);
        (n > 1 && (0.0..=(n - 1) as f64).contains(&t)).then_some((cell as usize, t - cell))
    };
    let ((c, s), (r, t)) = (along(place[0], rx, ncol)?, along(place[1], ry, nrow)?);
    let sample = |r: usize, c: usize| m.hfield_data.get(first + r * ncol + c).copied();
    let [a, b, c, d] = [sample(r, c)?, sample(r, c + 1)?, sample(r + 1, c)?, sample(r + 1, c + 1)?];
    Some(top * ((1.0 - t) * ((1.0 - s) * a + s * b) + t * ((1.0 - s) * c + s * d)))
}

fn fall_fault(m: &Model, d: &Fields, [g, p]: [usize; 2], travel: f64, depth: f64) -> Fault {
    let thick = geom_thickness(m, g);
    let cause = if travel > thick {
        "since it was last above the surface it moved farther than it is thick, so no step found a contact"
    } else {
        "the contact is too weak to hold it, so it is pressed below the surface"
    };
    Fault {
        kind: FaultKind::Tunnels,
        time: (d.time - m.opt.timestep).max(0.0),
        subject: format!("{} through {}", geom_name(m, g), geom_name(m, p)),
        cause: cause.into(),
        evidence: vec![
            FaultEvidence { name: "depth below the surface", value: depth, unit: "m" },
            FaultEvidence { name: "distance since it was above the surface", value: travel, unit: "m" },
            FaultEvidence { name: "own thickness", value: thick, unit: "m" },
        ],
        size: depth / thick,
        by_run: false,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;

    #[test]
    fn the_surface_is_between_its_samples() {
        let text = "<mujoco><asset><hfield name=\"h\" nrow=\"2\" ncol=\"3\" size=\"2 1 .5 .1\" elevation=\"0 0 1  0 .5 1\"/></asset>\
                    <worldbody><geom type=\"hfield\" hfield=\"h\"/></worldbody></mujoco>";
        let m = labspec_core::xml::compile(text).unwrap();
        let surface_at = |x: f64, y: f64| surface(&m, 0, [x, y, 9.0]);
        // Rows are in the order of y or reversed in the file; the result at the ends along x is the same.
        assert_eq!(
            (surface_at(-2.0, 0.0), surface_at(2.0, 0.3), surface_at(1.0, 0.0)),
            (Some(0.0), Some(0.5), Some(0.3125))
        );
        assert_eq!(
            (
                surface_at(0.0, 1.0).unwrap() + surface_at(0.0, -1.0).unwrap(),
                surface_at(2.1, 0.0),
                surface_at(0.0, -1.1)
            ),
            (0.25, None, None)
        );
    }
}
