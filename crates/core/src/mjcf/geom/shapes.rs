//! Geom types: the sizes they need, their volume, surface, inertia and bounds. A new type needs a row here and a
//! keyword in the schema.
//!
//! Inertias are principal moments for unit mass, about the centre. The formulas are those of any table of moments of inertia.

use std::f64::consts::PI;

use crate::kinds::geom;
use crate::math::{MINVAL, Vec3, norm};

/// An element of the `size` of a shape.
#[derive(Debug)]
pub(crate) struct SizeElement {
    /// Its description in messages.
    pub(crate) name: &'static str,
    /// Whether zero is valid.
    pub(crate) zero: bool,
}

/// The properties of a geom type.
#[derive(Debug)]
pub(crate) struct GeomTypeProperties {
    /// MuJoCo's number (mjtGeom).
    pub(crate) kind: i32,
    /// Its keyword.
    pub(crate) name: &'static str,
    /// The elements of `size` that it requires.
    pub(crate) sizes: &'static [SizeElement],
    /// An example for `size`.
    pub(crate) example: &'static str,
    /// Whether it is allowed only in bodies that cannot move.
    pub(crate) only_static: bool,
    /// The index in `size` of the half length that `fromto` specifies.
    pub(crate) length: Option<usize>,
    /// Volume, m^3; zero for a shape without volume.
    pub(crate) volume: fn(Vec3) -> f64,
    /// Surface area, m^2.
    pub(crate) surface: fn(Vec3) -> f64,
    /// Moments of the solid, m^2.
    pub(crate) inertia: fn(Vec3) -> Vec3,
    /// Moments of the shell, m^2.
    pub(crate) shell: fn(Vec3) -> Vec3,
    /// Half lengths of the bounding box, m.
    pub(crate) half: fn(Vec3) -> Vec3,
    /// Radius of the bounding sphere, m; zero if there is none.
    pub(crate) rbound: fn(Vec3) -> f64,
}

const RADIUS: SizeElement = SizeElement { name: "radius", zero: false };
const HALF_LENGTH: SizeElement = SizeElement { name: "half length", zero: false };

const CUBOID: GeomTypeProperties = GeomTypeProperties {
    kind: geom::BOX,
    name: "box",
    sizes: &[
        SizeElement { name: "half length in x", zero: false },
        SizeElement { name: "half length in y", zero: false },
        SizeElement { name: "half length in z", zero: false },
    ],
    example: "0.1 0.2 0.3",
    only_static: false,
    length: Some(2),
    volume: |[a, b, c]| 8.0 * a * b * c,
    surface: |[a, b, c]| 8.0 * (a * b + b * c + c * a),
    inertia: |[a, b, c]| [(b * b + c * c) / 3.0, (a * a + c * c) / 3.0, (a * a + b * b) / 3.0],
    shell: |[a, b, c]| {
        // Two faces perpendicular to each axis, with masses proportional to their areas.
        let (x, y, z) = (b * c, a * c, a * b);
        let (aa, bb, cc, all) = (a * a, b * b, c * c, x + y + z);
        [
            (x * (bb + cc) / 3.0 + y * (bb + cc / 3.0) + z * (cc + bb / 3.0)) / all,
            (x * (aa + cc / 3.0) + y * (aa + cc) / 3.0 + z * (cc + aa / 3.0)) / all,
            (x * (aa + bb / 3.0) + y * (bb + aa / 3.0) + z * (aa + bb) / 3.0) / all,
        ]
    },
    half: |size| size,
    rbound: norm,
};

const SHAPES: &[GeomTypeProperties] = &[
    GeomTypeProperties {
        kind: geom::PLANE,
        name: "plane",
        sizes: &[
            SizeElement { name: "half length in x", zero: true },
            SizeElement { name: "half length in y", zero: true },
            SizeElement { name: "spacing of the drawn grid", zero: false },
        ],
        example: "1 1 0.1",
        only_static: true,
        length: None,
        volume: |_| 0.0,
        surface: |_| 0.0,
        inertia: |_| [0.0; 3],
        shell: |_| [0.0; 3],
        half: |_| [1e10, 1e10, 5e9],
        rbound: |_| 0.0,
    },
    // Its sizes are those of a box of about the same volume. Its bounds are computed from the height field.
    GeomTypeProperties { kind: geom::HFIELD, name: "height field", sizes: &[], length: None, ..CUBOID },
    GeomTypeProperties {
        kind: geom::SPHERE,
        name: "sphere",
        sizes: &[RADIUS],
        example: "0.1",
        only_static: false,
        length: None,
        volume: |[r, ..]| 4.0 * PI * r * r * r / 3.0,
        surface: |[r, ..]| 4.0 * PI * r * r,
        inertia: |[r, ..]| [2.0 * r * r / 5.0; 3],
        shell: |[r, ..]| [2.0 * r * r / 3.0; 3],
        half: |[r, ..]| [r; 3],
        rbound: |[r, ..]| r,
    },
    GeomTypeProperties {
        kind: geom::CAPSULE,
        name: "capsule",
        sizes: &[RADIUS, HALF_LENGTH],
        example: "0.1 0.5",
        only_static: false,
        length: Some(1),
        volume: |[r, h, _]| PI * (r * r * 2.0 * h + 4.0 * r * r * r / 3.0),
        surface: |[r, h, _]| 4.0 * PI * r * r + 2.0 * PI * r * 2.0 * h,
        inertia: |[r, h, _]| {
            let (length, ends) = (2.0 * h, 4.0 * r / (4.0 * r + 6.0 * h));
            let middle = 1.0 - ends;
            // The centres of mass of the hemispheres are 3/8 r beyond the ends of the cylinder.
            let ball = 2.0 * r * r / 5.0;
            let across = middle * (3.0 * r * r + length * length) / 12.0
                + ends * (ball + length * (3.0 * r + 2.0 * length) / 8.0);
            [across, across, middle * r * r / 2.0 + ends * ball]
        },
        shell: |[r, h, _]| {
            let (length, ends) = (2.0 * h, 2.0 * r / (2.0 * r + 2.0 * h));
            let middle = 1.0 - ends;
            let ball = 2.0 * r * r / 3.0;
            let across = middle * (6.0 * r * r + length * length) / 12.0
                + ends * (ball + length * (length + 2.0 * r) / 4.0);
            [across, across, middle * r * r + ends * ball]
        },
        half: |[r, h, _]| [r, r, h + r],
        rbound: |[r, h, _]| r + h,
    },
    GeomTypeProperties {
        kind: geom::ELLIPSOID,
        name: "ellipsoid",
        sizes: &[
            SizeElement { name: "half axis in x", zero: false },
            SizeElement { name: "half axis in y", zero: false },
            SizeElement { name: "half axis in z", zero: false },
        ],
        example: "0.1 0.2 0.3",
        only_static: false,
        length: Some(2),
        volume: |[a, b, c]| 4.0 * PI * a * b * c / 3.0,
        surface: ellipsoid_surface,
        inertia: |[a, b, c]| [(b * b + c * c) / 5.0, (a * a + c * c) / 5.0, (a * a + b * b) / 5.0],
        shell: ellipsoid_shell,
        half: |size| size,
        rbound: |[a, b, c]| a.max(b).max(c),
    },
    GeomTypeProperties {
        kind: geom::CYLINDER,
        name: "cylinder",
        sizes: &[RADIUS, HALF_LENGTH],
        example: "0.1 0.5",
        only_static: false,
        length: Some(1),
        volume: |[r, h, _]| PI * r * r * 2.0 * h,
        surface: |[r, h, _]| 2.0 * PI * r * (r + 2.0 * h),
        inertia: |[r, h, _]| {
            let across = (3.0 * r * r + 4.0 * h * h) / 12.0;
            [across, across, r * r / 2.0]
        },
        shell: |[r, h, _]| {
            let ends = r / (r + 2.0 * h);
            let side = 1.0 - ends;
            let across = side * (6.0 * r * r + 4.0 * h * h) / 12.0 + ends * (r * r / 4.0 + h * h);
            [across, across, side * r * r + ends * r * r / 2.0]
        },
        half: |[r, h, _]| [r, r, h],
        rbound: |[r, h, _]| libm::sqrt(r * r + h * h),
    },
    CUBOID,
    // The other properties are those of the individual mesh.
    GeomTypeProperties { kind: geom::MESH, name: "mesh", sizes: &[], length: None, ..CUBOID },
];

/// The shape of a geom type, or `None` if the schema refuses the type.
pub(crate) fn for_kind(kind: i32) -> Option<&'static GeomTypeProperties> {
    SHAPES.iter().find(|s| s.kind == kind)
}

/// Thomsen's formula. Its relative error is about one percent. MuJoCo uses it too.
fn ellipsoid_surface([a, b, c]: Vec3) -> f64 {
    const P: f64 = 1.6075;
    let [a, b, c] = [a, b, c].map(|x| libm::pow(x, P));
    4.0 * PI * libm::pow((a * b + a * c + b * c) / 3.0, 1.0 / P)
}

/// The moments of the layer between the ellipsoid and one that is larger by a micrometre.
fn ellipsoid_shell(inner: Vec3) -> Vec3 {
    let outer = inner.map(|x| x + 1e-6);
    let volume = |[a, b, c]: Vec3| 4.0 * PI * a * b * c / 3.0;
    let (v0, v1) = (volume(inner), volume(outer));
    let moment =
        |[_, b, c]: Vec3, [_, y, z]: Vec3| (v1 * (y * y + z * z) - v0 * (b * b + c * c)) / (5.0 * (v1 - v0));
    let turned = |[a, b, c]: Vec3, by: usize| [[a, b, c], [b, c, a], [c, a, b]][by % 3];
    std::array::from_fn(|i| moment(turned(inner, i), turned(outer, i)))
}

/// `geom_fluid` of a geom with the ellipsoid model of fluid forces: a flag, five coefficients, the added mass and the added
/// moments of inertia, for a fluid density of one (Lamb 1932, *Hydrodynamics*, art. 114).
pub(crate) fn fluid(half: Vec3, coefficients: [f64; 5]) -> [f64; 12] {
    let [a, b, c] = half;
    let kappa = [added_mass([a, b, c]), added_mass([b, c, a]), added_mass([c, a, b])];
    let volume = 4.0 / 3.0 * PI * a * b * c;
    let mass = kappa.map(|k| volume * k / (2.0 - k).max(MINVAL));
    let moment = |i: usize, j: usize| {
        let (square, difference) =
            (half[i] * half[i] + half[j] * half[j], half[i] * half[i] - half[j] * half[j]);
        let denominator = (2.0 * difference + square * (kappa[i] - kappa[j])).abs();
        volume / 5.0 * difference * difference * (kappa[j] - kappa[i]).abs() / denominator.max(MINVAL)
    };
    let mut all = [0.0; 12];
    all[0] = 1.0;
    all[1..6].copy_from_slice(&coefficients);
    all[6..9].copy_from_slice(&mass);
    all[9..].copy_from_slice(&[moment(1, 2), moment(0, 2), moment(0, 1)]);
    all
}

/// Lamb's α for the first half axis: abc ∫ dλ / sqrt((a² + λ)³ (b² + λ) (c² + λ)), λ from 0 to infinity.
///
/// Substitution λ = s x³ / (1 - x)², then Gauss–Kronrod quadrature with 15 points on x from 0 to 1 (Piessens et al. 1983,
/// *QUADPACK*). Points and weights have eight decimals, which reproduces MuJoCo's results.
fn added_mass([a, b, c]: Vec3) -> f64 {
    const POINTS: [f64; 8] =
        [0.5, 0.60389248, 0.70292258, 0.79304362, 0.87076559, 0.93243221, 0.97455396, 0.99572769];
    const WEIGHTS: [f64; 8] =
        [0.10474107, 0.10221647, 0.09517529, 0.08450236, 0.07032663, 0.05239501, 0.03154605, 0.01146766];
    let scale = libm::pow(a * a * a * b * c, 0.4);
    let integrand = |x: f64| {
        let rest = 1.0 - x;
        let lambda = scale * x * x * x / (rest * rest);
        let [p, q, r] = [a, b, c].map(|s| 1.0 + lambda / (s * s));
        scale * x * x * (3.0 - x) / (rest * rest * rest * p * libm::sqrt(p * q * r))
    };
    let values: [f64; 8] = std::array::from_fn(|i| match i {
        0 => integrand(POINTS[0]),
        _ => integrand(POINTS[i]) + integrand(1.0 - POINTS[i]),
    });
    let sum: f64 = (0..8).map(|i| WEIGHTS[i] * values[i]).sum();
    sum / (a * a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: &[f64], expected: &[f64], tolerance: f64) {
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).abs() <= tolerance * b.abs(), "{found:?}, not {expected:?}");
        }
    }

    /// Mass and moments for a density of 1000, computed by MuJoCo 3.14.0: solid, then shell.
    #[test]
    fn inertias_are_those_of_mujoco() {
        let cases: [(i32, Vec3, [f64; 4], [f64; 4]); 5] = [
            (
                geom::SPHERE,
                [0.1, 0.0, 0.0],
                [4.188790204786391, 0.01675516081914557, 0.01675516081914557, 0.01675516081914557],
                [125.66370614359174, 0.8377580409572783, 0.8377580409572783, 0.8377580409572783],
            ),
            (
                geom::CAPSULE,
                [0.1, 0.3, 0.0],
                [23.038346126325152, 1.1006046263076243, 1.1006046263076243, 0.11100294042683936],
                [502.65482457436696, 29.112091923265417, 29.112091923265417, 4.607669225265031],
            ),
            (
                geom::ELLIPSOID,
                [0.1, 0.2, 0.3],
                [25.132741228718345, 0.653451271946677, 0.5026548245743669, 0.25132741228718347],
                [489.7193333371731, 18.075174882542342, 14.068366576335393, 8.102680936804973],
            ),
            (
                geom::CYLINDER,
                [0.1, 0.3, 0.0],
                [18.84955592153876, 0.6126105674500096, 0.6126105674500096, 0.0942477796076938],
                [439.82297150257097, 19.006635554218246, 19.006635554218246, 4.084070449666731],
            ),
            (
                geom::BOX,
                [0.1, 0.2, 0.3],
                [48.00000000000001, 2.0800000000000005, 1.6000000000000003, 0.8000000000000003],
                [880.0, 54.13333333333334, 42.13333333333334, 24.266666666666673],
            ),
        ];
        for (kind, size, solid, shell) in cases {
            let shape = for_kind(kind).unwrap();
            for (amount, moments, expected, tolerance) in [
                (shape.volume, shape.inertia, solid, 1e-15),
                // The layer of an ellipsoid is a small difference of large numbers.
                (shape.surface, shape.shell, shell, 2e-11),
            ] {
                let mass = 1000.0 * amount(size);
                let [x, y, z] = moments(size).map(|i| i * mass);
                close(&[mass, x, y, z], &expected, 4.0 * tolerance);
            }
        }
    }

    #[test]
    fn added_masses_are_those_of_mujoco() {
        close(
            &fluid([0.1, 0.2, 0.3], [0.0; 5])[6..],
            &[
                0.03421892335102304,
                0.009161969686093343,
                0.004656001295402555,
                3.914190145187043e-05,
                0.0003559983762595036,
                9.632561918504682e-05,
            ],
            1e-13,
        );
        close(
            &fluid([0.1, 0.1, 0.4], [0.0; 5])[6..],
            &[
                0.014405432431269162,
                0.014405432431269162,
                0.001366504876116645,
                0.0003463275046479919,
                0.0003463275046479919,
                0.0,
            ],
            1e-13,
        );
    }

    /// A thin shell is the difference of two solids.
    #[test]
    fn shells_are_the_limit_of_solids() {
        for shape in SHAPES.iter().filter(|s| !s.only_static && s.kind != geom::ELLIPSOID) {
            let (size, e) = ([0.13, 0.21, 0.34], 1e-5);
            // Only the radius of a capsule grows.
            let grown = match shape.kind {
                geom::CAPSULE => [size[0] + e, size[1], 0.0],
                _ => size.map(|x| x + e),
            };
            let (v0, v1) = ((shape.volume)(size), (shape.volume)(grown));
            let (i0, i1) = ((shape.inertia)(size), (shape.inertia)(grown));
            let skin: Vec3 = std::array::from_fn(|i| (v1 * i1[i] - v0 * i0[i]) / (v1 - v0));
            close(&skin, &(shape.shell)(size), 1e-3);
            close(&[(v1 - v0) / e], &[(shape.surface)(size)], 1e-3);
        }
    }
}
