//! The specification of a model, read from the XML: bodies with their joints, geoms and sites, in tree order, with defaults
//! applied, angles in radians, and the span of every object.

use std::ops::Range;
use std::rc::Rc;

use super::classes::Props;
use crate::math::{Quat, Vec3};
use crate::mjcf::body::frame::Pose;

/// A body and its members. The first body of a model is the world.
#[derive(Debug)]
pub(crate) struct BodySpec {
    /// The index of the element; for the world, that of the root.
    pub(crate) node: usize,
    /// The model that contains the body.
    pub(crate) part: usize,
    pub(crate) span: Range<usize>,
    pub(crate) name: String,
    /// Index of the parent body, always smaller than that of the body. The world is its own parent.
    pub(crate) parent: usize,
    pub(crate) pos: Vec3,
    pub(crate) quat: Quat,
    /// The pose as written, relative to the innermost frame.
    pub(crate) written: Pose,
    pub(crate) mocap: bool,
    /// Whether the body may be treated as simple, with a diagonal mass matrix.
    pub(crate) simple: bool,
    /// Upward force, as a multiple of the body's weight.
    pub(crate) gravcomp: f64,
    /// Sleep policy of the tree: 0 auto, 1 never, 2 allowed, 3 asleep at the start.
    pub(crate) sleep: i32,
    pub(crate) user: NumberList,
    pub(crate) inertial: Option<Inertia>,
    /// The span of the inertia.
    pub(crate) inertial_span: Option<Range<usize>>,
    pub(crate) joints: Vec<JointSpec>,
    pub(crate) geoms: Vec<GeomSpec>,
    pub(crate) sites: Vec<SiteSpec>,
    pub(crate) cameras: Vec<CameraSpec>,
    pub(crate) lights: Vec<LightSpec>,
}

/// Mass, centre of mass and principal moments of inertia.
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
    /// For a free joint, whether the body frame is aligned with the inertial frame: 0 no, 1 yes, 2 according to `compiler`.
    pub(crate) align: i32,
    pub(crate) limited: bool,
    pub(crate) range: [f64; 2],
    pub(crate) margin: f64,
    /// Linear coefficient, and the coefficients of the polynomial in the displacement.
    pub(crate) stiffness: [f64; 3],
    /// Linear coefficient, and the coefficients of the polynomial in the speed.
    pub(crate) damping: [f64; 3],
    /// Time constant and damping ratio, from which stiffness and damping are computed.
    pub(crate) springdamper: Option<[f64; 2]>,
    pub(crate) frictionloss: f64,
    pub(crate) solref_friction: [f64; 2],
    pub(crate) solimp_friction: [f64; 5],
    /// Whether the force of actuators is limited, and its range.
    pub(crate) actfrclimited: bool,
    pub(crate) actfrcrange: [f64; 2],
    /// Whether gravity compensation counts as an actuator force.
    pub(crate) actgravcomp: bool,
    pub(crate) group: i32,
    pub(crate) user: NumberList,
    pub(crate) armature: f64,
    /// Coordinate in the configuration of the text.
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
    /// Centre and half lengths of the bounding box, m.
    pub(crate) aabb: [f64; 6],
    /// Id of the mesh or height field, -1 if none.
    pub(crate) data: i32,
    /// `geom_fluid`.
    pub(crate) fluid: [f64; 12],
    /// Name of the material.
    pub(crate) material: Option<String>,
    pub(crate) surfacevel: [f64; 6],
    pub(crate) adhesion: f64,
    pub(crate) user: NumberList,
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
    /// One of [`crate::geom`].
    pub(crate) kind: i32,
    /// Id of the mesh, -1 if none.
    pub(crate) data: i32,
    pub(crate) size: Vec3,
    pub(crate) pos: Vec3,
    pub(crate) quat: Quat,
    /// Name of the material.
    pub(crate) material: Option<String>,
    pub(crate) group: i32,
    pub(crate) rgba: [f64; 4],
    pub(crate) user: NumberList,
}

/// A camera.
#[derive(Debug)]
pub(crate) struct CameraSpec {
    pub(crate) name: String,
    pub(crate) mode: i32,
    /// Name of the targeted body.
    pub(crate) target: Option<String>,
    pub(crate) pos: Vec3,
    pub(crate) quat: Quat,
    pub(crate) projection: i32,
    pub(crate) fovy: f64,
    pub(crate) ipd: f64,
    pub(crate) resolution: [i32; 2],
    pub(crate) output: i32,
    pub(crate) sensorsize: [f64; 2],
    pub(crate) intrinsic: [f64; 4],
    pub(crate) user: NumberList,
}

/// A light.
#[derive(Debug)]
pub(crate) struct LightSpec {
    pub(crate) name: String,
    pub(crate) mode: i32,
    /// Name of the targeted body.
    pub(crate) target: Option<String>,
    pub(crate) texture: Option<String>,
    /// Span of the name of the texture.
    pub(crate) span: Range<usize>,
    pub(crate) kind: i32,
    pub(crate) castshadow: bool,
    pub(crate) active: bool,
    pub(crate) pos: Vec3,
    pub(crate) dir: Vec3,
    /// bulbradius, intensity, range, cutoff, softness, exponent
    pub(crate) numbers: [f64; 6],
    /// attenuation, ambient, diffuse, specular
    pub(crate) triples: [Vec3; 4],
}

/// A material.
#[derive(Debug)]
pub(crate) struct MaterialSpec {
    pub(crate) name: String,
    /// Names of its textures, by role.
    pub(crate) textures: [Option<String>; 10],
    pub(crate) texuniform: bool,
    pub(crate) texrepeat: [f64; 2],
    /// emission, specular, shininess, reflectance, metallic, roughness
    pub(crate) numbers: [f64; 6],
    pub(crate) rgba: [f64; 4],
}

/// Custom numbers.
#[derive(Debug)]
pub(crate) struct NumericSpec {
    pub(crate) name: String,
    pub(crate) data: Vec<f64>,
}

/// A custom tuple: kind, id and parameter of each element.
#[derive(Debug)]
pub(crate) struct TupleSpec {
    pub(crate) name: String,
    pub(crate) elements: Vec<(i32, i32, f64)>,
}

/// A sensor, with its objects resolved to ids.
#[derive(Debug)]
pub(crate) struct SensorSpec {
    pub(crate) name: String,
    /// mjtSensor
    pub(crate) kind: i32,
    pub(crate) objects: SensorObjects,
    pub(crate) intprm: [i32; 3],
    /// Number of values.
    pub(crate) dim: i32,
    /// mjtDataType
    pub(crate) datatype: i32,
    /// mjtStage
    pub(crate) needstage: i32,
    pub(crate) cutoff: f64,
    pub(crate) noise: f64,
    pub(crate) timing: SensorTiming,
    pub(crate) user: NumberList,
}

/// The objects that a sensor is attached to: kinds (mjtObj, 0 for none) and ids (-1 for none).
#[derive(Clone, Copy, Debug)]
pub(crate) struct SensorObjects {
    pub(crate) objtype: i32,
    pub(crate) objid: i32,
    pub(crate) reftype: i32,
    pub(crate) refid: i32,
}

impl SensorObjects {
    /// One object.
    pub(crate) fn for_object(objtype: i32, objid: i32) -> SensorObjects {
        SensorObjects { objtype, objid, reftype: 0, refid: -1 }
    }

    /// Adds a reference object.
    pub(crate) fn with_reference(self, reftype: i32, refid: i32) -> SensorObjects {
        SensorObjects { reftype, refid, ..self }
    }
}

impl Default for SensorObjects {
    fn default() -> Self {
        SensorObjects::for_object(0, -1)
    }
}

/// The times at which a sensor is evaluated, and the delay of its values.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SensorTiming {
    /// Number of stored samples.
    pub(crate) nsample: i32,
    /// 0 hold, 1 linear, 2 cubic.
    pub(crate) interp: i32,
    /// s
    pub(crate) delay: f64,
    /// Period and phase, s.
    pub(crate) interval: [f64; 2],
}

impl SensorSpec {
    /// Length of the buffer of past values.
    pub(crate) fn history(&self) -> usize {
        crate::forces::history::size(self.timing.nsample.max(0) as usize, self.dim as usize)
    }
}

/// A list of numbers of any length, with its span.
#[derive(Debug, Default)]
pub(crate) struct NumberList {
    pub(crate) numbers: Rc<Vec<f64>>,
    pub(crate) span: Range<usize>,
}

impl NumberList {
    /// The numbers of an attribute; empty if it is absent.
    pub(crate) fn read(p: &Props, name: &str) -> NumberList {
        NumberList { numbers: p.shared(name), span: p.span(name).unwrap_or(0..0) }
    }
}

/// A tendon.
#[derive(Debug)]
pub(crate) struct TendonSpec {
    pub(crate) span: Range<usize>,
    pub(crate) name: String,
    pub(crate) path: Vec<WrapSpec>,
    pub(crate) group: i32,
    pub(crate) limited: bool,
    pub(crate) range: [f64; 2],
    pub(crate) actfrclimited: bool,
    pub(crate) actfrcrange: [f64; 2],
    pub(crate) margin: f64,
    /// Linear coefficient, and the coefficients of the polynomial in the displacement.
    pub(crate) stiffness: [f64; 3],
    /// Linear coefficient, and the coefficients of the polynomial in the speed.
    pub(crate) damping: [f64; 3],
    pub(crate) armature: f64,
    pub(crate) frictionloss: f64,
    /// Range of lengths in which the spring is relaxed; -1 -1: the length at `qpos_spring`.
    pub(crate) springlength: [f64; 2],
    pub(crate) solref_limit: [f64; 2],
    pub(crate) solimp_limit: [f64; 5],
    pub(crate) solref_friction: [f64; 2],
    pub(crate) solimp_friction: [f64; 5],
    pub(crate) width: f64,
    pub(crate) rgba: [f64; 4],
    pub(crate) user: NumberList,
}

/// An object on a tendon's path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WrapSpec {
    /// One of [`crate::wraptype`].
    pub(crate) kind: i32,
    /// -1 for a pulley.
    pub(crate) id: i32,
    /// Coefficient of a joint, divisor of a pulley, side site of a geom.
    pub(crate) prm: f64,
}

/// An equality constraint.
#[derive(Debug)]
pub(crate) struct EqualitySpec {
    pub(crate) name: String,
    /// One of [`crate::eqtype`].
    pub(crate) kind: i32,
    /// mjtObj
    pub(crate) objtype: i32,
    pub(crate) obj1: i32,
    /// -1 for none.
    pub(crate) obj2: i32,
    pub(crate) active: bool,
    pub(crate) solref: [f64; 2],
    pub(crate) solimp: [f64; 5],
    pub(crate) data: [f64; 11],
}

/// A pair of geoms that is tested for contact, independent of their contact bits.
#[derive(Debug)]
pub(crate) struct PairSpec {
    pub(crate) name: String,
    pub(crate) geoms: [i32; 2],
    pub(crate) bodies: [i32; 2],
    /// Signature: both bodies in one number.
    pub(crate) signature: i32,
    pub(crate) condim: i32,
    pub(crate) friction: [f64; 5],
    pub(crate) solref: [f64; 2],
    /// 0 0: the same as `solref`.
    pub(crate) solreffriction: [f64; 2],
    pub(crate) solimp: [f64; 5],
    pub(crate) margin: f64,
    pub(crate) gap: f64,
    pub(crate) adhesion: f64,
}

/// Two bodies that cannot have contacts.
#[derive(Debug)]
pub(crate) struct ExcludeSpec {
    pub(crate) name: String,
    /// The smaller id first.
    pub(crate) bodies: [i32; 2],
    pub(crate) signature: i32,
}

/// A range with a flag, a [`choice`](crate::kinds::choice): limited, unlimited, or limited if the range is given.
#[derive(Clone, Debug)]
pub(crate) struct RangeSpec {
    pub(crate) flag: i32,
    pub(crate) range: [f64; 2],
}

/// The target of an actuator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TransmissionSpec {
    /// One of [`crate::trntype`].
    pub(crate) kind: i32,
    /// The object, and the reference or slider site; -1 for none.
    pub(crate) id: [i32; 2],
}

/// An actuator, or the defaults of a class for actuators. Elements of all names write the same fields, one after the
/// other: a `motor` in a class with a `position` keeps the parameters of the servo that a motor does not use.
#[derive(Clone, Debug)]
pub(crate) struct ActuatorSpec {
    pub(crate) span: Range<usize>,
    /// The tag of the element, and its name if it has one.
    pub(crate) described: String,
    pub(crate) name: String,
    /// One of [`crate::gaintype`], [`crate::biastype`], [`crate::dyntype`], each with its parameters.
    pub(crate) gaintype: i32,
    pub(crate) gainprm: [f64; 10],
    pub(crate) biastype: i32,
    pub(crate) biasprm: [f64; 10],
    pub(crate) dyntype: i32,
    pub(crate) dynprm: [f64; 10],
    /// Number of activations; a negative number means as many as the dynamics require.
    pub(crate) actdim: i32,
    pub(crate) actearly: bool,
    /// Meaning of the controls; 0 for the default of the gain type.
    pub(crate) ctrlspec: i32,
    pub(crate) ctrl: RangeSpec,
    /// Ranges of the velocity setpoint and of the feedforward.
    pub(crate) velrange: [f64; 2],
    pub(crate) ffrange: [f64; 2],
    pub(crate) force: RangeSpec,
    pub(crate) act: RangeSpec,
    /// If positive, the range of controls or activations is the range of the target, scaled about its centre by this factor.
    pub(crate) inheritrange: f64,
    pub(crate) gear: [f64; 6],
    pub(crate) cranklength: f64,
    pub(crate) lengthrange: [f64; 2],
    /// Linear coefficient, and the coefficients of the polynomial in the speed.
    pub(crate) damping: [f64; 3],
    pub(crate) armature: f64,
    pub(crate) group: i32,
    /// Number of stored samples, interpolation between them, and the delay of the control, s.
    pub(crate) nsample: i32,
    pub(crate) interp: i32,
    pub(crate) delay: f64,
    pub(crate) user: Rc<Vec<f64>>,
    pub(crate) user_span: Range<usize>,
    /// `None` in a class, and if it is invalid.
    pub(crate) transmission: Option<TransmissionSpec>,
}

/// A keyframe as written. Missing values are those of the reference configuration.
#[derive(Debug)]
pub(crate) struct KeySpec {
    pub(crate) name: String,
    pub(crate) time: f64,
    pub(crate) qpos: Option<Vec<f64>>,
    pub(crate) qvel: Option<Vec<f64>>,
    pub(crate) act: Option<Vec<f64>>,
    pub(crate) ctrl: Option<Vec<f64>>,
    pub(crate) mpos: Option<Vec<f64>>,
    pub(crate) mquat: Option<Vec<f64>>,
}

/// MuJoCo's defaults: time constant and damping ratio of a soft constraint, and its impedance.
pub(crate) const SOLREF: [f64; 2] = [0.02, 1.0];
pub(crate) const SOLIMP: [f64; 5] = [0.9, 0.95, 0.001, 0.5, 2.0];
