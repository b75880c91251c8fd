//! Shapes of geoms: bounding radius and inertia per kilogram, computed by compiling a model of the geom; and the geom that
//! carries the mass of a body.

use labspec_core::math::{Mat3, mat_mul, norm, quat_to_mat, rows, sub};
use labspec_core::{Model, geom};

/// Relative tolerance between the moments of a body and those of the shape of its geom.
const MOMENT_TOLERANCE: f64 = 1e-6;

/// The properties of a shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShapeProperties {
    /// Radius of the bounding sphere, m.
    pub(super) radius: f64,
    /// Inertia tensor per kilogram in the frame of the geom, m².
    tensor: Mat3,
}

/// The shapes that are defined by sizes: the type, its name in MJCF, and the number of sizes.
const KINDS: [(i32, &str, usize); 5] = [
    (geom::SPHERE, "sphere", 1),
    (geom::CAPSULE, "capsule", 2),
    (geom::ELLIPSOID, "ellipsoid", 3),
    (geom::CYLINDER, "cylinder", 2),
    (geom::BOX, "box", 3),
];

/// The shape of a geom; `None` for planes, height fields and meshes, and for invalid sizes.
pub(super) fn shape_of_geom(m: &Model, g: usize) -> Option<ShapeProperties> {
    let kind = m.geom_type.get(g)?;
    let (_, word, sizes) = KINDS.iter().find(|(k, ..)| k == kind)?;
    let size = rows::<3>(&m.geom_size).get(g)?;
    let size: Vec<String> = size.iter().take(*sizes).map(|x| format!("{x:?}")).collect();
    let xml = format!(
        "<mujoco><worldbody><body><geom type='{word}' size='{}' mass='1'/></body></worldbody></mujoco>",
        size.join(" ")
    );
    let alone = Model::from_xml(&xml).ok()?;
    let tensor =
        tensor(*rows::<3>(&alone.body_inertia).get(1)?, &quat_to_mat(*rows::<4>(&alone.body_iquat).get(1)?));
    Some(ShapeProperties { radius: *alone.geom_rbound.first()?, tensor })
}

/// R diag Rᵀ.
fn tensor(diagonal: [f64; 3], r: &Mat3) -> Mat3 {
    let [a, b, c] = diagonal;
    rotated(&[a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c], r)
}

/// R M Rᵀ.
fn rotated(m: &Mat3, r: &Mat3) -> Mat3 {
    mat_mul(&mat_mul(r, m), &transposed(r))
}

fn transposed([a, b, c, d, e, f, g, h, i]: &Mat3) -> Mat3 {
    [*a, *d, *g, *b, *e, *h, *c, *f, *i]
}

/// The rotation from the frame of a geom to the principal axes of its body.
pub(super) fn to_axes(m: &Model, g: usize, body: usize) -> Option<Mat3> {
    let of_geom = quat_to_mat(*rows::<4>(&m.geom_quat).get(g)?);
    let of_axes = quat_to_mat(*rows::<4>(&m.body_iquat).get(body)?);
    Some(mat_mul(&transposed(&of_axes), &of_geom))
}

/// Principal moments per kilogram of the shape of a geom, in the order of the principal axes of its body; `None` where the
/// axes differ.
pub(super) fn moments(m: &Model, g: usize, body: usize) -> Option<[f64; 3]> {
    let [a, ab, ac, _, b, bc, _, _, c] = rotated(&shape_of_geom(m, g)?.tensor, &to_axes(m, g, body)?);
    let off_axis = ab.abs().max(ac.abs()).max(bc.abs());
    (off_axis <= MOMENT_TOLERANCE * (a + b + c)).then_some([a, b, c])
}

/// The body whose mass is entirely that of this geom.
pub(super) fn body_of_geom_mass(m: &Model, g: usize) -> Option<usize> {
    let body = *m.geom_bodyid.get(g)? as usize;
    if body == 0 {
        return None;
    }
    let (mass, inertia) = (*m.body_mass.get(body)?, rows::<3>(&m.body_inertia).get(body)?);
    let [place, centre] = [rows::<3>(&m.geom_pos).get(g)?, rows::<3>(&m.body_ipos).get(body)?];
    let close = |(a, b): (&f64, f64)| (a - mass * b).abs() <= MOMENT_TOLERANCE * a.abs();
    let here = norm(sub(*place, *centre)) <= MOMENT_TOLERANCE * m.geom_rbound.get(g)?;
    let moments = moments(m, g, body)?;
    (mass > 0.0 && here && inertia.iter().zip(moments).all(close)).then_some(body)
}
