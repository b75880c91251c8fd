//! Inertia of bodies: explicit, or computed from their geoms by the parallel axis theorem.

use crate::math::{
    IDENTITY, MINVAL, Quat, Vec3, add, add_scaled, inertia_about, quat_axis_angle, quat_mul, quat_normalize,
    quat_to_mat, sub,
};
use crate::mjcf::expand::AttachedModel;
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::settings::{CompilerSettings, InertiaFromGeom};
use crate::mjcf::spec::{BodySpec, GeomSpec, Inertia};
use crate::mjcf::text::diagnostic::Diagnostics;

const NONE: Inertia = Inertia { pos: [0.0; 3], quat: IDENTITY, mass: 0.0, moments: [0.0; 3] };

/// The inertia of every body. That of the world is zero.
pub(crate) fn bodies(list: &[BodySpec], parts: &[AttachedModel], report: &mut Diagnostics) -> Vec<Inertia> {
    let mut all = vec![NONE];
    for body in list.iter().skip(1) {
        let Some(AttachedModel { compiler, .. }) = parts.get(body.part) else { continue };
        let mut inertia = body_inertia(body, compiler);
        inertia.mass = inertia.mass.max(compiler.boundmass);
        inertia.moments = inertia.moments.map(|x| x.max(compiler.boundinertia));
        check_triangle(body, &mut inertia, compiler, report);
        all.push(inertia);
    }
    all
}

fn body_inertia(body: &BodySpec, compiler: &CompilerSettings) -> Inertia {
    let from_geoms = match compiler.inertiafromgeom {
        InertiaFromGeom::Never => None,
        InertiaFromGeom::Always => of_geoms(&body.geoms, compiler),
        InertiaFromGeom::Auto if body.inertial.is_some() => None,
        InertiaFromGeom::Auto => of_geoms(&body.geoms, compiler),
    };
    // Without mass, the inertial frame has no meaning. MuJoCo stores the pose of the body there, as written in the text. The
    // result is visible in `xipos`, so this code does the same.
    let massless = Inertia { pos: body.written.pos, quat: body.written.quat, ..NONE };
    from_geoms.or_else(|| body.inertial.clone()).unwrap_or(massless)
}

/// The combined inertia of the geoms that have mass, or `None` if there are none.
fn of_geoms(geoms: &[GeomSpec], compiler: &CompilerSettings) -> Option<Inertia> {
    let [lowest, highest] = compiler.inertiagrouprange;
    let massive: Vec<Inertia> =
        listed(
            geoms
                .iter()
                .filter(|g| g.mass > MINVAL && (lowest..=highest).contains(&g.group))
                .map(|g| Inertia { pos: g.pos, quat: g.quat, mass: g.mass, moments: g.moments }),
        );
    match massive.as_slice() {
        [] => None,
        // A single geom keeps its own frame. Its moments need not be sorted.
        [one] => Some(one.clone()),
        many => Some(combined(many)),
    }
}

/// The inertia of parts that are fixed to each other: the sum of their moments about the common centre of mass.
pub(crate) fn combined(parts: &[Inertia]) -> Inertia {
    let mass: f64 = parts.iter().map(|p| p.mass).sum();
    let moment = parts.iter().fold([0.0; 3], |sum, p| add_scaled(sum, p.pos, p.mass));
    let pos = moment.map(|x| x / mass);
    let about = |p: &Inertia| inertia_about(p.moments, &quat_to_mat(p.quat), sub(p.pos, pos), p.mass);
    let [xx, yy, zz, xy, xz, yz, ..] = parts.iter().fold([0.0; 10], |sum, p| add(sum, about(p)));
    let (moments, quat) = principal([xx, yy, zz, xy, xz, yz]);
    Inertia { pos, quat, mass, moments }
}

/// Principal moments, largest first, and the orientation of the principal axes, of a symmetric matrix given as `xx yy zz xy xz
/// yz`. Jacobi's method: the rotations are accumulated in a quaternion.
///
/// Each rotation takes the smaller of the two possible angles, and axes are sorted by quarter turns, so that of all equivalent
/// orientations the result is the one that MuJoCo stores.
pub(crate) fn principal(m: [f64; 6]) -> (Vec3, Quat) {
    principal_to(0.0, m)
}

/// Like [`principal`], but rotates only while an element off the diagonal is larger than `error`. If moments and product of two
/// axes differ by less than `2 error`, these axes do not rotate, so that rounding errors do not select them. Moments that differ
/// by less than `error` keep their order.
pub(crate) fn principal_to(error: f64, m: [f64; 6]) -> (Vec3, Quat) {
    const MAX_ROTATIONS: usize = 100;
    const EQUAL: f64 = 2.0;
    // The two axes of each off-diagonal element, and the axis of the rotation from the first to the second.
    const PLANES: [(usize, usize, Vec3); 3] =
        [(0, 1, [0.0, 0.0, 1.0]), (0, 2, [0.0, -1.0, 0.0]), (1, 2, [1.0, 0.0, 0.0])];

    let same = EQUAL * error;
    let mut quat = IDENTITY;
    let mut d = m;
    for _ in 0..MAX_ROTATIONS {
        d = in_frame(m, quat);
        let [xx, yy, zz, off @ ..] = d;
        let diagonal = [xx, yy, zz];
        let size = diagonal.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
        let (mut largest, mut plane) = (0.0_f64, 0);
        for (i, x) in off.iter().enumerate() {
            let (r, c, _) = PLANES[i];
            let equal = x.abs() <= same && (diagonal[r] - diagonal[c]).abs() <= same;
            if x.abs() > largest && !equal {
                (largest, plane) = (x.abs(), i);
            }
        }
        if largest <= error.max(f64::EPSILON * size) || largest.is_nan() {
            break;
        }
        let (r, c, axis) = PLANES[plane];
        let difference = diagonal[c] - diagonal[r];
        // For equal moments, the angle is exactly an eighth of a turn, so that rounding errors do not select its sign.
        let difference = if difference.abs() <= error { 0.0 } else { difference };
        let tau = difference / (2.0 * off[plane]);
        let root = libm::sqrt(1.0 + tau * tau);
        let tangent = if tau >= 0.0 { 1.0 / (tau + root) } else { -1.0 / (root - tau) };
        let turn = quat_axis_angle(axis, -libm::atan(tangent));
        let next = quat_normalize(quat_mul(quat, turn));
        if next == quat {
            break; // the angle is below the resolution of the quaternion
        }
        quat = next;
    }

    let mut moments = [d[0], d[1], d[2]];
    let quarter = std::f64::consts::FRAC_1_SQRT_2;
    for j in [0, 1, 0] {
        let tie = error.max(1e-12 * moments.iter().fold(0.0_f64, |s, x| s.max(x.abs())));
        if moments[j] + tie < moments[j + 1] {
            moments.swap(j, j + 1);
            let mut turn = [quarter, 0.0, 0.0, 0.0];
            turn[1 + (j + 2) % 3] = quarter;
            quat = quat_normalize(quat_mul(quat, turn));
        }
    }
    (moments, quat)
}

/// Rᵀ m R for the rotation matrix R of a quaternion.
fn in_frame(m: [f64; 6], quat: Quat) -> [f64; 6] {
    let [xx, yy, zz, xy, xz, yz] = m;
    let r = quat_to_mat(quat);
    let column = |i: usize| [r[i], r[3 + i], r[6 + i]];
    let form = |i: usize, j: usize| {
        let ([a, b, c], [x, y, z]) = (column(i), column(j));
        a * (xx * x + xy * y + xz * z) + b * (xy * x + yy * y + yz * z) + c * (xz * x + yz * y + zz * z)
    };
    [form(0, 0), form(1, 1), form(2, 2), form(0, 1), form(0, 2), form(1, 2)]
}

/// Checks that no moment exceeds the sum of the other two. No mass distribution has such an inertia.
fn check_triangle(
    body: &BodySpec,
    inertia: &mut Inertia,
    compiler: &CompilerSettings,
    report: &mut Diagnostics,
) {
    let [a, b, c] = inertia.moments;
    // Rounding errors in the computed moments of a flat body are not an error of the author.
    let slack = 1e-13 * (a + b + c);
    if a + b >= c - slack && a + c >= b - slack && b + c >= a - slack {
        return;
    }
    if compiler.balanceinertia {
        inertia.moments = [(a + b + c) / 3.0; 3];
        return;
    }
    report
        .error(
            rules::INERTIA,
            body.inertial_span.clone().unwrap_or(body.span.clone()),
            format!("the principal moments of inertia of {} are {a}, {b}, {c}", describe_body(body)),
        )
        .why("no moment can exceed the sum of the other two")
        .help("correct `diaginertia`, or write `<compiler balanceinertia=\"true\"/>` to replace them by their mean");
}

/// Checks that each moving body has mass and inertia: its own, or those of a body that is welded to it.
pub(crate) fn check_moving(
    list: &[BodySpec],
    weld: &[usize],
    inertias: &[Inertia],
    report: &mut Diagnostics,
) {
    let solid = |i: &Inertia| i.mass >= MINVAL && i.moments.iter().all(|&x| x >= MINVAL);
    let mut carries = vec![false; list.len()];
    for (&w, inertia) in weld.iter().zip(inertias) {
        if let Some(c) = carries.get_mut(w) {
            *c |= solid(inertia);
        }
    }
    for (i, body) in list.iter().enumerate().skip(1) {
        if body.joints.is_empty() || carries.get(i) == Some(&true) {
            continue;
        }
        let mass = inertias.get(i).map_or(0.0, |x| x.mass);
        let message = if mass < MINVAL {
            format!("{} can move but has no mass", describe_body(body))
        } else {
            format!("{} can move but has no inertia", describe_body(body))
        };
        report
            .error(rules::INERTIA, body.span.clone(), message)
            .why("a force on it would cause an infinite acceleration")
            .help("give it a geom with mass, or an `inertial` with `mass` and `diaginertia`");
    }
}

/// A description of a body for messages.
pub(crate) fn describe_body(body: &BodySpec) -> String {
    if body.name.is_empty() {
        "a body".to_string()
    } else {
        format!("body {}", crate::mjcf::text::diagnostic::shorten_name(&body.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_axes_rebuild_the_matrix() {
        for m in [
            [1.0, 1.1, 1.2, 0.1, 0.2, 0.05],
            [1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
            [2.0, 2.0, 3.0, 1.0, 0.0, 0.0],
            [1e-9, 2e-9, 2.5e-9, -4e-10, 1e-10, 3e-10],
        ] {
            let (moments, quat) = principal(m);
            assert!(moments[0] >= moments[1] * (1.0 - 1e-12) && moments[1] >= moments[2] * (1.0 - 1e-12));
            let back = inertia_about(moments, &quat_to_mat(quat), [0.0; 3], 1.0);
            for (x, y) in back.iter().zip(m) {
                assert!((x - y).abs() <= 4e-15 * m[2], "{m:?}: {back:?}");
            }
        }
    }

    #[test]
    fn axes_in_order_stay_as_they_are() {
        assert_eq!(principal([3.0, 2.0, 1.5, 0.0, 0.0, 0.0]), ([3.0, 2.0, 1.5], IDENTITY));
        assert_eq!(principal([0.0; 6]), ([0.0; 3], IDENTITY));
    }
}
