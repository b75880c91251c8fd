//! The one table of fields: every field of `Model`, its options and statistics, and `Data`.
//!
//! Each row is declared once: name, Rust type, shape, kind, the stage that computes it, unit and one line
//! of documentation. From it come the structs (`model.rs`, `data.rs`), the reflection that the language
//! binds to (`reflect.rs`) and the reference pages. A field that is not here does not exist.
//!
//! Names and layouts are MuJoCo's: arrays are flat and row-major, quaternions are `w x y z`, angles are
//! radians, everything is SI. Spatial vectors list the angular part first.
//!
//! The tables are macros that hand all rows to another macro, so that each use reads the same rows.

/// Sizes and constant arrays of [`crate::Model`].
macro_rules! model_fields {
    ($apply:ident) => { $apply! {
        // Sizes.
        nq: usize, [], Structure, Compile, "", "number of generalized coordinates";
        nv: usize, [], Structure, Compile, "", "number of degrees of freedom";
        nu: usize, [], Structure, Compile, "", "number of control inputs";
        na: usize, [], Structure, Compile, "", "number of activation states";
        nbody: usize, [], Structure, Compile, "", "number of bodies, the world included";
        ntree: usize, [], Structure, Compile, "", "number of kinematic trees with at least one degree of freedom";
        njnt: usize, [], Structure, Compile, "", "number of joints";
        ngeom: usize, [], Structure, Compile, "", "number of geoms";
        nsite: usize, [], Structure, Compile, "", "number of sites";
        ncam: usize, [], Structure, Compile, "", "number of cameras";
        nlight: usize, [], Structure, Compile, "", "number of lights";
        nmocap: usize, [], Structure, Compile, "", "number of mocap bodies";
        npair: usize, [], Structure, Compile, "", "number of explicit contact pairs";
        nexclude: usize, [], Structure, Compile, "", "number of excluded body pairs";
        neq: usize, [], Structure, Compile, "", "number of equality constraints";
        ntendon: usize, [], Structure, Compile, "", "number of tendons";
        nsensor: usize, [], Structure, Compile, "", "number of sensors";
        nsensordata: usize, [], Structure, Compile, "", "number of sensor values";
        nkey: usize, [], Structure, Compile, "", "number of keyframes";
        nC: usize, [], Structure, Compile, "", "number of non-zeros of the lower triangle of the mass matrix";

        // Reference configuration.
        qpos0: Vec<f64>, [nq], Constant, Compile, "m or rad", "coordinates of the default configuration";
        qpos_spring: Vec<f64>, [nq], Constant, Compile, "m or rad", "coordinates at which joint springs are relaxed";

        // Bodies.
        body_parentid: Vec<i32>, [nbody], Structure, Compile, "", "parent body";
        body_rootid: Vec<i32>, [nbody], Structure, Compile, "", "ancestor that is a child of the world";
        body_weldid: Vec<i32>, [nbody], Structure, Compile, "", "body that this body is welded to";
        body_mocapid: Vec<i32>, [nbody], Structure, Compile, "", "index of the mocap pose, -1 if none";
        body_jntnum: Vec<i32>, [nbody], Structure, Compile, "", "number of joints of the body";
        body_jntadr: Vec<i32>, [nbody], Structure, Compile, "", "first joint of the body, -1 if none";
        body_dofnum: Vec<i32>, [nbody], Structure, Compile, "", "number of degrees of freedom of the body";
        body_dofadr: Vec<i32>, [nbody], Structure, Compile, "", "first degree of freedom of the body, -1 if none";
        body_treeid: Vec<i32>, [nbody], Structure, Compile, "", "kinematic tree of the body, -1 if it cannot move";
        body_geomnum: Vec<i32>, [nbody], Structure, Compile, "", "number of geoms of the body";
        body_geomadr: Vec<i32>, [nbody], Structure, Compile, "", "first geom of the body, -1 if none";
        body_simple: Vec<i32>, [nbody], Structure, SetConst, "", "1: diagonal mass matrix, 2: the same with slide joints only, 0: general";
        body_sameframe: Vec<i32>, [nbody], Structure, SetConst, "", "inertial frame against body frame: 0 different, 1 the same, 3 the same orientation";
        body_pos: Vec<f64>, [nbody, 3], Constant, Compile, "m", "position in the parent's frame";
        body_quat: Vec<f64>, [nbody, 4], Constant, Compile, "", "orientation in the parent's frame";
        body_ipos: Vec<f64>, [nbody, 3], Inertial, Compile, "m", "centre of mass in the body's frame";
        body_iquat: Vec<f64>, [nbody, 4], Inertial, Compile, "", "orientation of the principal axes of inertia in the body's frame";
        body_mass: Vec<f64>, [nbody], Inertial, Compile, "kg", "mass";
        body_subtreemass: Vec<f64>, [nbody], Derived, SetConst, "kg", "mass of the body and all its descendants";
        body_inertia: Vec<f64>, [nbody, 3], Inertial, Compile, "kg m^2", "principal moments of inertia";
        body_invweight0: Vec<f64>, [nbody, 2], Derived, SetConst, "1/kg, 1/(kg m^2)", "mean inverse inertia at qpos0: translation, rotation";

        // Joints.
        jnt_type: Vec<i32>, [njnt], Structure, Compile, "", "0 free, 1 ball, 2 slide, 3 hinge";
        jnt_qposadr: Vec<i32>, [njnt], Structure, Compile, "", "first coordinate of the joint in qpos";
        jnt_dofadr: Vec<i32>, [njnt], Structure, Compile, "", "first degree of freedom of the joint in qvel";
        jnt_bodyid: Vec<i32>, [njnt], Structure, Compile, "", "body of the joint";
        jnt_limited: Vec<bool>, [njnt], Constant, Compile, "", "whether the joint has limits";
        jnt_solref: Vec<f64>, [njnt, 2], Constant, Compile, "s, 1", "limit constraint: time constant and damping ratio (or -stiffness, -damping)";
        jnt_solimp: Vec<f64>, [njnt, 5], Constant, Compile, "", "limit constraint: impedance";
        jnt_pos: Vec<f64>, [njnt, 3], Constant, Compile, "m", "anchor in the body's frame";
        jnt_axis: Vec<f64>, [njnt, 3], Constant, Compile, "", "axis in the body's frame";
        jnt_stiffness: Vec<f64>, [njnt], Constant, Compile, "N/m or N m/rad", "stiffness of the joint spring";
        jnt_range: Vec<f64>, [njnt, 2], Constant, Compile, "m or rad", "lower and upper limit";
        jnt_margin: Vec<f64>, [njnt], Constant, Compile, "m or rad", "distance from the limit at which it becomes active";

        // Degrees of freedom.
        dof_bodyid: Vec<i32>, [nv], Structure, Compile, "", "body of the degree of freedom";
        dof_jntid: Vec<i32>, [nv], Structure, Compile, "", "joint of the degree of freedom";
        dof_parentid: Vec<i32>, [nv], Structure, Compile, "", "previous degree of freedom on the way to the root, -1 if none";
        dof_treeid: Vec<i32>, [nv], Structure, Compile, "", "kinematic tree of the degree of freedom";
        dof_simplenum: Vec<i32>, [nv], Structure, SetConst, "", "number of consecutive simple degrees of freedom from here";
        dof_armature: Vec<f64>, [nv], Inertial, Compile, "kg or kg m^2", "inertia added to the diagonal of the mass matrix";
        dof_damping: Vec<f64>, [nv], Constant, Compile, "N s/m or N m s/rad", "linear damping";
        dof_invweight0: Vec<f64>, [nv], Derived, SetConst, "1/kg or 1/(kg m^2)", "diagonal of the inverse inertia at qpos0";
        dof_M0: Vec<f64>, [nv], Derived, SetConst, "kg or kg m^2", "diagonal of the mass matrix at qpos0";

        // Kinematic trees: their degrees of freedom are contiguous.
        tree_dofadr: Vec<i32>, [ntree], Structure, SetConst, "", "first degree of freedom of the tree";
        tree_dofnum: Vec<i32>, [ntree], Structure, SetConst, "", "number of degrees of freedom of the tree";

        // Pattern of the mass matrix: lower triangle by rows, ancestors first, the diagonal last.
        M_rownnz: Vec<i32>, [nv], Structure, Compile, "", "number of non-zeros of each row of the mass matrix";
        M_rowadr: Vec<i32>, [nv], Structure, Compile, "", "address of each row of the mass matrix";
        M_colind: Vec<i32>, [nC], Structure, Compile, "", "column of each non-zero of the mass matrix";

        // Geoms.
        geom_type: Vec<i32>, [ngeom], Structure, Compile, "", "0 plane, 2 sphere";
        geom_contype: Vec<i32>, [ngeom], Constant, Compile, "", "bits of the contact types the geom is";
        geom_conaffinity: Vec<i32>, [ngeom], Constant, Compile, "", "bits of the contact types the geom accepts";
        geom_condim: Vec<i32>, [ngeom], Constant, Compile, "", "dimension of the contact: 1 frictionless, 3 sliding friction";
        geom_bodyid: Vec<i32>, [ngeom], Structure, Compile, "", "body of the geom";
        geom_group: Vec<i32>, [ngeom], Constant, Compile, "", "group, for visibility and inertia";
        geom_priority: Vec<i32>, [ngeom], Constant, Compile, "", "the geom of higher priority decides the contact's parameters";
        geom_sameframe: Vec<i32>, [ngeom], Structure, SetConst, "", "geom frame: 0 its own, 1 the body's, 2 the inertial frame, 3 and 4 the same orientation";
        geom_solmix: Vec<f64>, [ngeom], Constant, Compile, "", "weight in the mix of solref and solimp";
        geom_solref: Vec<f64>, [ngeom, 2], Constant, Compile, "s, 1", "contact: time constant and damping ratio (or -stiffness, -damping)";
        geom_solimp: Vec<f64>, [ngeom, 5], Constant, Compile, "", "contact: impedance (d0, dwidth, width, midpoint, power)";
        geom_size: Vec<f64>, [ngeom, 3], Constant, Compile, "m", "size; a sphere's radius is the first number";
        geom_rbound: Vec<f64>, [ngeom], Constant, Compile, "m", "radius of the bounding sphere, 0 for a plane";
        geom_pos: Vec<f64>, [ngeom, 3], Constant, Compile, "m", "position in the body's frame";
        geom_quat: Vec<f64>, [ngeom, 4], Constant, Compile, "", "orientation in the body's frame";
        geom_friction: Vec<f64>, [ngeom, 3], Constant, Compile, "1, m, m", "friction: sliding, spinning, rolling";
        geom_margin: Vec<f64>, [ngeom], Constant, Compile, "m", "distance at which a contact starts to push";
        geom_gap: Vec<f64>, [ngeom], Constant, Compile, "m", "further distance at which a contact is detected without pushing";
        geom_rgba: Vec<f64>, [ngeom, 4], Constant, Compile, "", "colour and opacity";

        // Sites.
        site_bodyid: Vec<i32>, [nsite], Structure, Compile, "", "body of the site";
        site_sameframe: Vec<i32>, [nsite], Structure, SetConst, "", "site frame, as geom_sameframe";
        site_size: Vec<f64>, [nsite, 3], Constant, Compile, "m", "size, for drawing";
        site_pos: Vec<f64>, [nsite, 3], Constant, Compile, "m", "position in the body's frame";
        site_quat: Vec<f64>, [nsite, 4], Constant, Compile, "", "orientation in the body's frame";

        // Tendons, actuators and equality constraints: declared, empty until the compiler accepts them.
        tendon_length0: Vec<f64>, [ntendon], Derived, SetConst, "m", "length at qpos0";
        tendon_invweight0: Vec<f64>, [ntendon], Derived, SetConst, "1/kg", "inverse inertia at qpos0";
        tendon_range: Vec<f64>, [ntendon, 2], Constant, Compile, "m", "lower and upper limit of the length";
        actuator_gear: Vec<f64>, [nu, 6], Constant, Compile, "", "scale of length and force";
        actuator_length0: Vec<f64>, [nu], Derived, SetConst, "m or rad", "length at qpos0";
        actuator_acc0: Vec<f64>, [nu], Derived, SetConst, "m/s^2 or rad/s^2", "acceleration caused by a unit force at qpos0";
        actuator_gainprm: Vec<f64>, [nu, 10], Constant, Compile, "", "gain parameters";
        actuator_biasprm: Vec<f64>, [nu, 10], Constant, Compile, "", "bias parameters";
        actuator_ctrlrange: Vec<f64>, [nu, 2], Constant, Compile, "", "range of the control";
        actuator_forcerange: Vec<f64>, [nu, 2], Constant, Compile, "N or N m", "range of the force";
        eq_data: Vec<f64>, [neq, 11], Constant, Compile, "", "parameters of the equality constraint";

        // Sensors.
        sensor_type: Vec<i32>, [nsensor], Structure, Compile, "", "type (mjtSensor)";
        sensor_objtype: Vec<i32>, [nsensor], Structure, Compile, "", "kind of the sensed object (mjtObj)";
        sensor_objid: Vec<i32>, [nsensor], Structure, Compile, "", "the sensed object";
        sensor_dim: Vec<i32>, [nsensor], Structure, Compile, "", "number of values";
        sensor_adr: Vec<i32>, [nsensor], Structure, Compile, "", "first value in sensordata";
        sensor_cutoff: Vec<f64>, [nsensor], Constant, Compile, "", "values are clamped to this magnitude, 0 for no limit";
        sensor_noise: Vec<f64>, [nsensor], Constant, Compile, "", "standard deviation, information only";

        // Keyframes.
        key_time: Vec<f64>, [nkey], Constant, Compile, "s", "time";
        key_qpos: Vec<f64>, [nkey, nq], Constant, Compile, "m or rad", "coordinates";
        key_qvel: Vec<f64>, [nkey, nv], Constant, Compile, "m/s or rad/s", "velocities";
        key_act: Vec<f64>, [nkey, na], Constant, Compile, "", "activations";
        key_mpos: Vec<f64>, [nkey, nmocap, 3], Constant, Compile, "m", "mocap positions";
        key_mquat: Vec<f64>, [nkey, nmocap, 4], Constant, Compile, "", "mocap orientations";
        key_ctrl: Vec<f64>, [nkey, nu], Constant, Compile, "", "controls";
    } };
}

/// `model.opt`: the options of the simulation.
macro_rules! option_fields {
    ($apply:ident) => { $apply! {
        timestep: f64, [], Constant, Compile, "s", "length of a step";
        impratio: f64, [], Constant, Compile, "", "ratio of frictional to normal impedance";
        tolerance: f64, [], Constant, Compile, "", "the solver stops when the scaled improvement falls below this";
        ls_tolerance: f64, [], Constant, Compile, "", "the same for the line search, relative to `tolerance`";
        gravity: [f64; 3], [3], Constant, Compile, "m/s^2", "gravity";
        o_margin: f64, [], Constant, Compile, "m", "margin of all contacts when the override flag is set";
        o_solref: [f64; 2], [2], Constant, Compile, "s, 1", "solref of all contacts when the override flag is set";
        o_solimp: [f64; 5], [5], Constant, Compile, "", "solimp of all contacts when the override flag is set";
        o_friction: [f64; 5], [5], Constant, Compile, "", "friction of all contacts when the override flag is set";
        integrator: i32, [], Constant, Compile, "", "0 Euler, 1 RK4";
        cone: i32, [], Constant, Compile, "", "friction cone: 0 pyramidal";
        solver: i32, [], Constant, Compile, "", "2 Newton";
        iterations: i32, [], Constant, Compile, "", "largest number of solver iterations";
        ls_iterations: i32, [], Constant, Compile, "", "largest number of line-search evaluations";
        disableflags: i32, [], Constant, Compile, "", "bits of what is switched off (mjtDisableBit)";
        enableflags: i32, [], Constant, Compile, "", "bits of what is switched on (mjtEnableBit)";
    } };
}

/// `model.stat`: statistics of the model at `qpos0`.
macro_rules! statistic_fields {
    ($apply:ident) => { $apply! {
        meaninertia: f64, [], Constant, SetConst, "kg or kg m^2", "mean diagonal of the mass matrix; scales the solver's tolerance";
        meanmass: f64, [], Constant, SetConst, "kg", "mean body mass";
        meansize: f64, [], Constant, SetConst, "m", "mean body size";
        extent: f64, [], Constant, SetConst, "m", "spatial extent";
        center: [f64; 3], [3], Constant, SetConst, "m", "centre of the model";
    } };
}

/// State, inputs and results of [`crate::Data`].
macro_rules! data_fields {
    ($apply:ident) => { $apply! {
        time: f64, [], State, User, "s", "simulated time";
        qpos: Vec<f64>, [nq], State, User, "m or rad", "generalized coordinates: free joint x y z qw qx qy qz, ball qw qx qy qz, slide and hinge one number";
        qvel: Vec<f64>, [nv], State, User, "m/s or rad/s", "velocities: a free joint's rotation is in the body's frame";
        act: Vec<f64>, [na], State, User, "", "activations of actuators";
        qacc_warmstart: Vec<f64>, [nv], State, User, "m/s^2 or rad/s^2", "acceleration of the last step, where the solver starts";
        ctrl: Vec<f64>, [nu], Input, User, "", "controls";
        qfrc_applied: Vec<f64>, [nv], Input, User, "N or N m", "applied generalized force";
        xfrc_applied: Vec<f64>, [nbody, 6], Input, User, "N, N m", "force (3) then torque (3) applied at the centre of mass, world axes";
        mocap_pos: Vec<f64>, [nmocap, 3], Input, User, "m", "positions of mocap bodies";
        mocap_quat: Vec<f64>, [nmocap, 4], Input, User, "", "orientations of mocap bodies";

        // Counts.
        ncon: usize, [], Derived, Collision, "", "number of detected contacts";
        nefc: usize, [], Derived, Constraint, "", "number of scalar constraints";
        nisland: usize, [], Derived, Constraint, "", "number of independent sets of constraints";
        solver_niter: usize, [], Derived, Solve, "", "solver iterations of the last step, summed over islands";

        // Position.
        xpos: Vec<f64>, [nbody, 3], Derived, Kinematics, "m", "position of the body frame, world";
        xquat: Vec<f64>, [nbody, 4], Derived, Kinematics, "", "orientation of the body frame, world";
        xmat: Vec<f64>, [nbody, 9], Derived, Kinematics, "", "the same as a rotation matrix";
        xipos: Vec<f64>, [nbody, 3], Derived, Kinematics, "m", "centre of mass, world";
        ximat: Vec<f64>, [nbody, 9], Derived, Kinematics, "", "orientation of the principal axes of inertia, world";
        xanchor: Vec<f64>, [njnt, 3], Derived, Kinematics, "m", "anchor of the joint, world";
        xaxis: Vec<f64>, [njnt, 3], Derived, Kinematics, "", "axis of the joint, world";
        geom_xpos: Vec<f64>, [ngeom, 3], Derived, GeomPoses, "m", "position of the geom, world";
        geom_xmat: Vec<f64>, [ngeom, 9], Derived, GeomPoses, "", "orientation of the geom, world";
        site_xpos: Vec<f64>, [nsite, 3], Derived, SitePoses, "m", "position of the site, world";
        site_xmat: Vec<f64>, [nsite, 9], Derived, SitePoses, "", "orientation of the site, world";
        subtree_com: Vec<f64>, [nbody, 3], Derived, ComPos, "m", "centre of mass of the body and its descendants, world";
        cdof: Vec<f64>, [nv, 6], Derived, ComPos, "", "motion axis of the degree of freedom, about the tree's centre of mass";
        cinert: Vec<f64>, [nbody, 10], Derived, ComPos, "kg m^2, kg m, kg", "inertia about the tree's centre of mass: xx yy zz xy xz yz, m d, m";
        crb: Vec<f64>, [nbody, 10], Derived, MassMatrix, "kg m^2, kg m, kg", "composite inertia of the subtree";
        M: Vec<f64>, [nC], Derived, MassMatrix, "kg m^2, kg m, kg", "mass matrix, lower triangle by rows";
        qLD: Vec<f64>, [nC], Derived, Factor, "", "factorization M = L' D L";
        qLDiagInv: Vec<f64>, [nv], Derived, Factor, "", "1/D";

        // Velocity.
        cvel: Vec<f64>, [nbody, 6], Derived, ComVel, "rad/s, m/s", "velocity of the body about the tree's centre of mass";
        cdof_dot: Vec<f64>, [nv, 6], Derived, ComVel, "", "time derivative of cdof";
        qfrc_spring: Vec<f64>, [nv], Derived, Passive, "N or N m", "force of joint springs";
        qfrc_damper: Vec<f64>, [nv], Derived, Passive, "N or N m", "force of joint dampers";
        qfrc_passive: Vec<f64>, [nv], Derived, Passive, "N or N m", "sum of passive forces";
        qfrc_bias: Vec<f64>, [nv], Derived, Bias, "N or N m", "gravity, Coriolis and centrifugal force (with the sign of M a + bias = force)";

        // Force and acceleration.
        ten_length: Vec<f64>, [ntendon], Derived, Kinematics, "m", "length of the tendon";
        ten_velocity: Vec<f64>, [ntendon], Derived, ComVel, "m/s", "velocity of the tendon";
        actuator_length: Vec<f64>, [nu], Derived, Kinematics, "m or rad", "length of the actuator";
        actuator_velocity: Vec<f64>, [nu], Derived, ComVel, "m/s or rad/s", "velocity of the actuator";
        actuator_force: Vec<f64>, [nu], Derived, Acceleration, "N or N m", "force of the actuator";
        act_dot: Vec<f64>, [na], Derived, Acceleration, "1/s", "time derivative of act";
        qfrc_actuator: Vec<f64>, [nv], Derived, Acceleration, "N or N m", "force of the actuators";
        qfrc_smooth: Vec<f64>, [nv], Derived, Acceleration, "N or N m", "all forces but those of constraints";
        qacc_smooth: Vec<f64>, [nv], Derived, Acceleration, "m/s^2 or rad/s^2", "acceleration without constraints";
        qfrc_constraint: Vec<f64>, [nv], Derived, Solve, "N or N m", "force of constraints";
        qacc: Vec<f64>, [nv], Derived, Solve, "m/s^2 or rad/s^2", "acceleration";

        // Constraints: as many rows as there are now (`nefc`).
        efc_type: Vec<i32>, [nefc], Derived, Constraint, "", "type of the constraint (mjtConstraint)";
        efc_id: Vec<i32>, [nefc], Derived, Constraint, "", "the joint or contact that the row belongs to";
        efc_pos: Vec<f64>, [nefc], Derived, Constraint, "m or rad", "violation (negative when violated)";
        efc_margin: Vec<f64>, [nefc], Derived, Constraint, "m or rad", "violation at which the constraint starts to act";
        efc_diagA: Vec<f64>, [nefc], Derived, Constraint, "1/kg", "approximate diagonal of J M^-1 J'";
        efc_KBIP: Vec<f64>, [nefc, 4], Derived, Constraint, "1/s^2, 1/s, 1, 1/m", "stiffness, damping, impedance and its derivative";
        efc_D: Vec<f64>, [nefc], Derived, Constraint, "kg", "1/R";
        efc_R: Vec<f64>, [nefc], Derived, Constraint, "1/kg", "regularization";
        efc_vel: Vec<f64>, [nefc], Derived, Reference, "m/s or rad/s", "velocity along the constraint, J v";
        efc_aref: Vec<f64>, [nefc], Derived, Reference, "m/s^2 or rad/s^2", "reference acceleration";
        efc_force: Vec<f64>, [nefc], Derived, Solve, "N or N m", "force of the constraint";

        // Read-outs.
        sensordata: Vec<f64>, [nsensordata], Derived, Sensors, "", "sensor values";
        energy: [f64; 2], [2], Derived, Energy, "J", "potential, kinetic; computed when the energy flag is on";
    } };
}

pub(crate) use {data_fields, model_fields, option_fields, statistic_fields};
