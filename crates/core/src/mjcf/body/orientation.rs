//! The five forms of an orientation, converted to unit quaternions (XML reference, "Frame orientations").

use crate::math::{
    IDENTITY, Mat3, Quat, Vec3, add_scaled, cross, dot, norm, normalize, quat_axis_angle, quat_mul,
    quat_normalize,
};
use crate::mjcf::classes::Props;
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::schema::{ALTERNATIVES, is_form};
use crate::mjcf::settings::CompilerSettings;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::{ElementNode, ElementTree};

/// The length below which a vector has no direction.
const SHORTEST: f64 = 1e-14;

/// The orientation of an element, or the identity if none is given.
pub(crate) fn read(
    p: &Props,
    compiler: &CompilerSettings,
    node: &ElementNode,
    report: &mut Diagnostics,
) -> Quat {
    let form = ALTERNATIVES.into_iter().find(|name| p.has(name)).unwrap_or("quat");
    let Some(given) = p.list(form) else { return IDENTITY };
    let result = match (form, given) {
        ("quat", &[w, x, y, z]) => quaternion([w, x, y, z]),
        ("euler", &[a, b, c]) => Ok(euler([a, b, c], compiler)),
        ("axisangle", &[x, y, z, angle]) => {
            direction([x, y, z], "the axis").map(|axis| quat_axis_angle(axis, compiler.angle(angle)))
        }
        ("xyaxes", &[a, b, c, d, e, f]) => xyaxes([a, b, c], [d, e, f]),
        ("zaxis", &[x, y, z]) => direction([x, y, z], "the z axis").map(z_to),
        _ => return IDENTITY, // of another length, already reported
    };
    result.map(quat_normalize).unwrap_or_else(|what| {
        let span = p.span(form).unwrap_or(node.span.clone());
        report
            .error(rules::ORIENTATION, span, format!("`{form}` of {}: {what}", node.describe()))
            .why("it does not describe a rotation");
        IDENTITY
    })
}

/// Reports elements that specify their orientation more than once.
pub(crate) fn check_forms(tree: &ElementTree, report: &mut Diagnostics) {
    for node in &tree.nodes {
        let forms = node.attributes.iter().filter(|a| is_form(a.attr.name));
        let names: Vec<_> = listed(forms.map(|a| (a.attr.name, a.span.clone())));
        // `composite` and `flexcomp` do not occur here, because refused elements are not in the tree.
        let [(first, _), (second, span), ..] = names.as_slice() else { continue };
        let message = format!("{} has both `{first}` and `{second}`", node.describe());
        report.error(rules::CONFLICT, span.clone(), message).help(
            match *first == "fullinertia" || *second == "fullinertia" {
                true => "remove the other one: `fullinertia` finds its own axes",
                false => "remove one of them: an orientation is given once",
            },
        );
    }
}

/// The unit vector of a direction, or the reason why there is none.
fn direction(v: Vec3, what: &str) -> Result<Vec3, String> {
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    // Scaled first, so that the length of a very large vector does not overflow.
    let scaled = v.map(|x| if largest > 1e100 { x / largest } else { x });
    if norm(scaled) < SHORTEST {
        return Err(format!("{what} has no length"));
    }
    Ok(normalize(scaled).0)
}

fn quaternion(q: Quat) -> Result<Quat, String> {
    let largest = q.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if largest < 1e-15 {
        return Err("the quaternion is zero".into());
    }
    Ok(if largest > 1e100 { q.map(|x| x / largest) } else { q })
}

/// The product of rotations about three axes in sequence.
pub(crate) fn euler(angles: Vec3, compiler: &CompilerSettings) -> Quat {
    let mut q = IDENTITY;
    for (angle, (axis, fixed)) in angles.into_iter().zip(compiler.eulerseq) {
        let mut unit = [0.0; 3];
        if let Some(x) = unit.get_mut(axis) {
            *x = 1.0;
        }
        let turn = quat_axis_angle(unit, compiler.angle(angle));
        q = if fixed { quat_mul(turn, q) } else { quat_mul(q, turn) };
    }
    q
}

/// The frame whose x axis is `x`, and whose y axis is the component of `y` perpendicular to it.
fn xyaxes(x: Vec3, y: Vec3) -> Result<Quat, String> {
    let x = direction(x, "the x axis")?;
    let y = direction(y, "the y axis")?;
    let y = direction(add_scaled(y, x, -dot(x, y)), "the part of the y axis at right angles to the x axis")?;
    let z = cross(x, y);
    Ok(from_matrix(&[x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]]))
}

/// The smallest rotation that maps the z axis to the unit vector `v`.
pub(crate) fn z_to(v: Vec3) -> Quat {
    let z = [0.0, 0.0, 1.0];
    let axis = cross(z, v);
    let sine = norm(axis);
    // v is parallel to z: the rotation is by 0 or π about x.
    let (axis, sine) = if sine < SHORTEST { ([1.0, 0.0, 0.0], 0.0) } else { (normalize(axis).0, sine) };
    quat_axis_angle(axis, libm::atan2(sine, v[2]))
}

/// The quaternion of a rotation matrix, computed from its largest component (Shepperd 1978).
pub(crate) fn from_matrix(m: &Mat3) -> Quat {
    let [xx, xy, xz, yx, yy, yz, zx, zy, zz] = *m;
    let quat = if xx + yy + zz > 0.0 {
        let w = 0.5 * libm::sqrt(1.0 + xx + yy + zz);
        let s = 0.25 / w;
        [w, s * (zy - yz), s * (xz - zx), s * (yx - xy)]
    } else if xx > yy && xx > zz {
        let x = 0.5 * libm::sqrt(1.0 + xx - yy - zz);
        let s = 0.25 / x;
        [s * (zy - yz), x, s * (yx + xy), s * (xz + zx)]
    } else if yy > zz {
        let y = 0.5 * libm::sqrt(1.0 - xx + yy - zz);
        let s = 0.25 / y;
        [s * (xz - zx), s * (yx + xy), y, s * (zy + yz)]
    } else {
        let z = 0.5 * libm::sqrt(1.0 - xx - yy + zz);
        let s = 0.25 / z;
        [s * (yx - xy), s * (xz + zx), s * (zy + yz), z]
    };
    quat_normalize(quat)
}
