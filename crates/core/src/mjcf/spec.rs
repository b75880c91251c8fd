//! What the XML says, in our own terms: bodies with their joints, geoms and sites, in tree order, defaults
//! applied, angles in radians, every object with its place in the text.

use std::ops::Range;

use crate::math::{Quat, Vec3};

/// A body and what it holds. The first body of a model is the world.
#[derive(Debug)]
pub(crate) struct BodySpec {
    /// The element; the root for the world.
    pub(crate) node: usize,
    pub(crate) span: Range<usize>,
    pub(crate) name: String,
    /// Index of the parent body, always smaller than the body's own. The world is its own parent.
    pub(crate) parent: usize,
    pub(crate) childclass: Option<usize>,
    pub(crate) pos: Vec3,
    pub(crate) quat: Quat,
    pub(crate) mocap: bool,
    /// Whether the simple form of its mass matrix may be used.
    pub(crate) simple: bool,
    pub(crate) inertial: Option<Inertia>,
    /// Where the inertia is written.
    pub(crate) inertial_span: Option<Range<usize>>,
    pub(crate) joints: Vec<JointSpec>,
    pub(crate) geoms: Vec<GeomSpec>,
    pub(crate) sites: Vec<SiteSpec>,
    /// Names of cameras.
    pub(crate) cameras: Vec<String>,
    /// Names of lights.
    pub(crate) lights: Vec<String>,
}

/// Mass, centre of mass and principal moments.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Inertia {
    /// Centre of mass in the body's frame, m.
    pub(crate) pos: Vec3,
    /// Orientation of the principal axes in the body's frame.
    pub(crate) quat: Quat,
    /// kg
    pub(crate) mass: f64,
    /// kg m^2
    pub(crate) moments: Vec3,
}

#[derive(Debug)]
pub(crate) struct JointSpec {
    pub(crate) node: usize,
    pub(crate) span: Range<usize>,
    pub(crate) name: String,
    /// One of [`crate::joint`].
    pub(crate) kind: i32,
    pub(crate) pos: Vec3,
    pub(crate) axis: Vec3,
    pub(crate) limited: bool,
    pub(crate) range: [f64; 2],
    pub(crate) margin: f64,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    pub(crate) armature: f64,
    /// Coordinate of the configuration as written.
    pub(crate) reference: f64,
    /// Coordinate at which the spring is relaxed.
    pub(crate) springref: f64,
    pub(crate) solref: [f64; 2],
    pub(crate) solimp: [f64; 5],
}

#[derive(Debug)]
pub(crate) struct GeomSpec {
    pub(crate) node: usize,
    pub(crate) span: Range<usize>,
    pub(crate) name: String,
    /// One of [`crate::geom`].
    pub(crate) kind: i32,
    pub(crate) size: Vec3,
    pub(crate) pos: Vec3,
    pub(crate) quat: Quat,
    /// kg
    pub(crate) mass: f64,
    /// Principal moments in the geom's frame, kg m^2.
    pub(crate) moments: Vec3,
    /// Radius of the bounding sphere, m.
    pub(crate) rbound: f64,
    pub(crate) only_static: bool,
    pub(crate) contype: i32,
    pub(crate) conaffinity: i32,
    pub(crate) condim: i32,
    pub(crate) priority: i32,
    pub(crate) group: i32,
    pub(crate) friction: [f64; 3],
    pub(crate) solmix: f64,
    pub(crate) solref: [f64; 2],
    pub(crate) solimp: [f64; 5],
    pub(crate) margin: f64,
    pub(crate) gap: f64,
    pub(crate) rgba: [f64; 4],
}

#[derive(Debug)]
pub(crate) struct SiteSpec {
    pub(crate) node: usize,
    pub(crate) name: String,
    pub(crate) size: Vec3,
    pub(crate) pos: Vec3,
    pub(crate) quat: Quat,
}

/// A sensor, its object resolved.
#[derive(Debug)]
pub(crate) struct SensorSpec {
    pub(crate) name: String,
    /// mjtSensor
    pub(crate) kind: i32,
    /// mjtObj, 0 when it senses nothing in particular.
    pub(crate) objtype: i32,
    /// Id of the object, -1 for none.
    pub(crate) objid: i32,
    /// Number of values.
    pub(crate) dim: i32,
    pub(crate) cutoff: f64,
    pub(crate) noise: f64,
}

/// A keyframe as written; what is not given is taken from the reference configuration.
#[derive(Debug)]
pub(crate) struct KeySpec {
    pub(crate) name: String,
    pub(crate) time: f64,
    pub(crate) qpos: Option<Vec<f64>>,
    pub(crate) qvel: Option<Vec<f64>>,
    pub(crate) mpos: Option<Vec<f64>>,
    pub(crate) mquat: Option<Vec<f64>>,
}

/// The relative time constant and damping ratio of a soft constraint, and its impedance: MuJoCo's defaults.
pub(crate) const SOLREF: [f64; 2] = [0.02, 1.0];
pub(crate) const SOLIMP: [f64; 5] = [0.9, 0.95, 0.001, 0.5, 2.0];
