//! Geom types: the sizes they need, their volume, inertia and bounding sphere. A new type is a row here, and
//! a keyword in the schema.

use std::f64::consts::PI;

use crate::math::Vec3;
use crate::model::geom;

/// A size number of a shape.
#[derive(Debug)]
pub(crate) struct Size {
    /// What it is, in a message.
    pub(crate) name: &'static str,
    /// Whether zero is allowed.
    pub(crate) zero: bool,
}

/// What the compiler knows about a geom type.
#[derive(Debug)]
pub(crate) struct Shape {
    /// MuJoCo's number (mjtGeom).
    pub(crate) kind: i32,
    /// Its keyword.
    pub(crate) name: &'static str,
    /// The numbers of `size` that it needs.
    pub(crate) sizes: &'static [Size],
    /// How to write `size`.
    pub(crate) example: &'static str,
    /// Whether it may stand only in bodies that cannot move.
    pub(crate) only_static: bool,
    /// Volume, m^3; zero for what has no inside.
    pub(crate) volume: fn(Vec3) -> f64,
    /// Principal moments for a unit mass, m^2.
    pub(crate) inertia: fn(Vec3) -> Vec3,
    /// Radius of the bounding sphere, m; zero when there is none.
    pub(crate) rbound: fn(Vec3) -> f64,
}

const SHAPES: &[Shape] = &[
    Shape {
        kind: geom::PLANE,
        name: "plane",
        sizes: &[
            Size { name: "half length in x", zero: true },
            Size { name: "half length in y", zero: true },
            Size { name: "spacing of the drawn grid", zero: false },
        ],
        example: "1 1 0.1",
        only_static: true,
        volume: |_| 0.0,
        inertia: |_| [0.0; 3],
        rbound: |_| 0.0,
    },
    Shape {
        kind: geom::SPHERE,
        name: "sphere",
        sizes: &[Size { name: "radius", zero: false }],
        example: "0.1",
        only_static: false,
        volume: |[r, ..]| 4.0 * PI * r * r * r / 3.0,
        inertia: |[r, ..]| [2.0 * r * r / 5.0; 3],
        rbound: |[r, ..]| r,
    },
];

/// The shape of a geom type; `None` when the schema refuses the type.
pub(crate) fn of(kind: i32) -> Option<&'static Shape> {
    SHAPES.iter().find(|s| s.kind == kind)
}
