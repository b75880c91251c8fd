//! The stages of a step. The field table names the stage that computes each field; plans list the stages that run.

/// The stage that computes a field, in the order in which `mj_forward` runs them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Stage {
    /// The MJCF compiler.
    Compile,
    /// `mj_setConst`.
    SetConst,
    /// Written by the user or the integrator.
    User,
    /// Poses of bodies and joints.
    Kinematics,
    /// Orientations of bodies as quaternions.
    Orientations,
    /// Poses of geoms.
    GeomPoses,
    /// Poses of sites.
    SitePoses,
    /// Centres of mass, inertias and motion axes.
    ComPos,
    /// Poses of cameras and lights.
    CameraPoses,
    /// Lengths and Jacobians of tendons.
    Tendon,
    /// Mass matrix by composite rigid bodies.
    MassMatrix,
    /// Factorization of the mass matrix.
    Factor,
    /// Contacts.
    Collision,
    /// Constraint rows.
    Constraint,
    /// Lengths and moment arms of actuators.
    Transmission,
    /// Velocities of tendons.
    TendonVel,
    /// Velocities of actuators.
    ActuatorVel,
    /// Velocities of bodies.
    ComVel,
    /// Springs, dampers, gravity compensation, fluid.
    Passive,
    /// Reference accelerations of the constraints.
    Reference,
    /// Gravity, Coriolis and centrifugal force.
    Bias,
    /// Forces of actuators.
    Actuation,
    /// Unconstrained acceleration.
    Acceleration,
    /// Constraint forces.
    Solve,
    /// Momentum of subtrees.
    SubtreeVel,
    /// Accelerations of bodies and the forces between them.
    RnePost,
    /// Sensor values.
    Sensors,
    /// Potential and kinetic energy.
    Energy,
    /// Inverse dynamics.
    Inverse,
    /// Which trees sleep.
    Sleep,
}
