//! The values of the integers of a model: kinds of joints, geoms and actuators, and bits of options, with MuJoCo's numbers; and
//! the values of MJCF keywords.

/// Values of `opt.integrator`.
pub mod integrator {
    /// Semi-implicit Euler method, implicit in joint damping.
    pub const EULER: i32 = 0;
    /// Runge–Kutta method of fourth order.
    pub const RK4: i32 = 1;
    /// Implicit in velocity.
    pub const IMPLICIT: i32 = 2;
    /// Implicit in velocity, without the derivatives of Coriolis forces.
    pub const IMPLICITFAST: i32 = 3;
    /// Solves one constraint problem with the metric of the end of the step.
    pub const DISCRETE: i32 = 4;

    // The following integrators are extensions. MuJoCo does not have them.

    /// Runge–Kutta method of fourth order that has this order for rotations in space too.
    pub const RKMK4: i32 = 104;
    /// Like [`RKMK4`], of eighth order.
    pub const RKMK8: i32 = 108;
    /// Collocation at the Gauss points, of sixth order. Symmetric in time, for motions that conserve energy.
    pub const GAUSS: i32 = 106;
    /// Extrapolation, with as many substeps as an error at the level of rounding requires. For reference solutions.
    pub const ADAPTIVE: i32 = 100;

    /// Whether a step computes the forces more than once.
    pub fn many_stages(kind: i32) -> bool {
        matches!(kind, RK4 | RKMK4 | RKMK8 | GAUSS | ADAPTIVE)
    }
}

/// Values of `opt.solver`.
pub mod solver {
    /// Projected Gauss–Seidel method, on the dual problem.
    pub const PGS: i32 = 0;
    /// Conjugate gradient method.
    pub const CG: i32 = 1;
    /// Newton's method.
    pub const NEWTON: i32 = 2;
}

/// Values of `opt.cone` (mjtCone).
pub mod cone {
    /// A pyramid: two rows for each direction of friction.
    pub const PYRAMIDAL: i32 = 0;
    /// An elliptic cone: one row for the normal, and one for each direction of friction.
    pub const ELLIPTIC: i32 = 1;
}

/// Values of `opt.jacobian` (mjtJacobian).
pub mod jacobian {
    /// All entries are stored.
    pub const DENSE: i32 = 0;
    /// Only entries of degrees of freedom that a row depends on are stored.
    pub const SPARSE: i32 = 1;
    /// Dense if there are few degrees of freedom.
    pub const AUTO: i32 = 2;
}

/// Bits of `opt.disableflags` (mjtDisableBit).
#[allow(missing_docs)] // each is named after the part that it disables
pub mod disable {
    pub const CONSTRAINT: i32 = 1;
    pub const EQUALITY: i32 = 1 << 1;
    pub const FRICTIONLOSS: i32 = 1 << 2;
    pub const LIMIT: i32 = 1 << 3;
    pub const CONTACT: i32 = 1 << 4;
    pub const SPRING: i32 = 1 << 5;
    pub const DAMPER: i32 = 1 << 6;
    pub const GRAVITY: i32 = 1 << 7;
    pub const CLAMPCTRL: i32 = 1 << 8;
    pub const WARMSTART: i32 = 1 << 9;
    pub const FILTERPARENT: i32 = 1 << 10;
    pub const ACTUATION: i32 = 1 << 11;
    pub const REFSAFE: i32 = 1 << 12;
    pub const SENSOR: i32 = 1 << 13;
    pub const MIDPHASE: i32 = 1 << 14;
    pub const EULERDAMP: i32 = 1 << 15;
    pub const AUTORESET: i32 = 1 << 16;
    pub const NATIVECCD: i32 = 1 << 17;
    pub const ISLAND: i32 = 1 << 18;
    pub const MULTICCD: i32 = 1 << 19;
}

/// Bits of `opt.enableflags` (mjtEnableBit).
#[allow(missing_docs)] // each is named after the part that it enables
pub mod enable {
    pub const OVERRIDE: i32 = 1;
    pub const ENERGY: i32 = 1 << 1;
    pub const FWDINV: i32 = 1 << 2;
    pub const INVDISCRETE: i32 = 1 << 3;
    pub const SLEEP: i32 = 1 << 4;
    pub const DIAGEXACT: i32 = 1 << 5;
    pub const IPC: i32 = 1 << 6;
}

/// Values of `jnt_type`.
#[allow(missing_docs)] // the joint types
pub mod joint {
    pub const FREE: i32 = 0;
    pub const BALL: i32 = 1;
    pub const SLIDE: i32 = 2;
    pub const HINGE: i32 = 3;

    /// Number of coordinates of a joint of this type.
    pub fn nq(kind: i32) -> usize {
        match kind {
            FREE => 7,
            BALL => 4,
            _ => 1,
        }
    }

    /// Number of degrees of freedom of a joint of this type.
    pub fn nv(kind: i32) -> usize {
        match kind {
            FREE => 6,
            BALL => 3,
            _ => 1,
        }
    }
}

/// Values of `geom_type`.
#[allow(missing_docs)] // the geom types
pub mod geom {
    pub const PLANE: i32 = 0;
    pub const HFIELD: i32 = 1;
    pub const SPHERE: i32 = 2;
    pub const CAPSULE: i32 = 3;
    pub const ELLIPSOID: i32 = 4;
    pub const CYLINDER: i32 = 5;
    pub const BOX: i32 = 6;
    pub const MESH: i32 = 7;
}

/// Values of `wrap_type`: the kind of an object on a tendon's path.
#[allow(missing_docs)] // the kinds of path objects
pub mod wraptype {
    pub const JOINT: i32 = 1;
    pub const PULLEY: i32 = 2;
    pub const SITE: i32 = 3;
    pub const SPHERE: i32 = 4;
    pub const CYLINDER: i32 = 5;
}

/// Values of `actuator_trntype`.
#[allow(missing_docs)] // the transmissions
pub mod trntype {
    pub const JOINT: i32 = 0;
    pub const JOINTINPARENT: i32 = 1;
    pub const SLIDERCRANK: i32 = 2;
    pub const TENDON: i32 = 3;
    pub const SITE: i32 = 4;
    pub const BODY: i32 = 5;
    pub const SO3: i32 = 6;
}

/// Values of `actuator_dyntype`.
#[allow(missing_docs)] // the activation dynamics
pub mod dyntype {
    pub const NONE: i32 = 0;
    pub const INTEGRATOR: i32 = 1;
    pub const FILTER: i32 = 2;
    pub const FILTEREXACT: i32 = 3;
    pub const MUSCLE: i32 = 4;
    pub const DCMOTOR: i32 = 5;
    pub const PID: i32 = 6;
}

/// Values of `actuator_gaintype`.
#[allow(missing_docs)] // the gains
pub mod gaintype {
    pub const FIXED: i32 = 0;
    pub const AFFINE: i32 = 1;
    pub const MUSCLE: i32 = 2;
    pub const DCMOTOR: i32 = 3;
    pub const SO3: i32 = 4;
    pub const PID: i32 = 5;
}

/// Values of `actuator_biastype`.
#[allow(missing_docs)] // the biases
pub mod biastype {
    pub const NONE: i32 = 0;
    pub const AFFINE: i32 = 1;
    pub const MUSCLE: i32 = 2;
    pub const DCMOTOR: i32 = 3;
    pub const SO3: i32 = 4;
}

/// Values of `eq_type`.
#[allow(missing_docs)] // the equality constraints
pub mod eqtype {
    pub const CONNECT: i32 = 0;
    pub const WELD: i32 = 1;
    pub const JOINT: i32 = 2;
    pub const TENDON: i32 = 3;
}

/// Values of `cam_mode` and `light_mode` (mjtCamLight): how a camera or light moves.
pub mod camlight {
    /// Fixed to the body.
    pub const FIXED: i32 = 0;
    /// Position follows the body, orientation is that at `qpos0`.
    pub const TRACK: i32 = 1;
    /// Position follows the centre of mass of the body's subtree, orientation is that at `qpos0`.
    pub const TRACKCOM: i32 = 2;
    /// Fixed to the body, turned towards the target body.
    pub const TARGETBODY: i32 = 3;
    /// Fixed to the body, turned towards the centre of mass of the target's subtree.
    pub const TARGETBODYCOM: i32 = 4;
}

/// Values of `cam_projection` (mjtProjection).
pub mod projection {
    /// Lines of sight meet in the camera.
    pub const PERSPECTIVE: i32 = 0;
    /// Lines of sight are parallel.
    pub const ORTHOGRAPHIC: i32 = 1;
}

/// Values of `light_type` (mjtLightType).
pub mod lighttype {
    /// A cone of light.
    pub const SPOT: i32 = 0;
    /// Parallel light.
    pub const DIRECTIONAL: i32 = 1;
    /// Light in all directions.
    pub const POINT: i32 = 2;
    /// Light from a picture of the surroundings.
    pub const IMAGE: i32 = 3;
}

/// How a delayed sensor or actuator interpolates its past values, the second number of `sensor_history` and `actuator_history`.
pub mod interpolation {
    /// The value of the last sample (zero-order hold).
    pub const HOLD: i32 = 0;
    /// Linear interpolation between two samples.
    pub const LINEAR: i32 = 1;
    /// Cubic interpolation with the slopes of the samples.
    pub const CUBIC: i32 = 2;
}

/// Values of `body_simple`: whether the mass matrix of a body is diagonal in every configuration.
pub mod simple {
    /// Not diagonal.
    pub const NO: i32 = 0;
    /// Diagonal, and the body may turn.
    pub const DIAGONAL: i32 = 1;
    /// Diagonal, and the body only slides.
    pub const SLIDING: i32 = 2;
}

/// Values of a contact's `exclude`: the reason why it has no rows.
pub(crate) mod exclude {
    /// It has rows.
    pub(crate) const NO: u8 = 0;
    /// It is in the gap.
    pub(crate) const IN_GAP: u8 = 1;
    /// No degree of freedom affects its distance.
    pub(crate) const NO_DOFS: u8 = 3;
}

/// Values of MJCF keywords with an automatic choice (`limited`, `align`, `inertiafromgeom`).
pub mod choice {
    /// Chosen: no.
    pub const FALSE: i32 = 0;
    /// Chosen: yes.
    pub const TRUE: i32 = 1;
    /// Other attributes determine the choice.
    pub const AUTO: i32 = 2;
}

/// Values of `compiler/angle`.
pub mod angle {
    /// Angles are in radians.
    pub const RADIAN: i32 = 0;
    /// Angles are in degrees.
    pub const DEGREE: i32 = 1;
}
