//! The one table of fields: every field of `Model`, its options and statistics, and `Fields`.
//!
//! Each row is declared once: name, Rust type, shape, kind, the stage that computes it, unit and one line
//! of documentation. From it come the structs (`model.rs`, `data.rs`), the reflection that the language
//! binds to (`reflect/`) and the reference pages. A field that is not here does not exist. The file is longer than others, as it is
//! one table: a line for each field.
//!
//! Names and layouts are MuJoCo's: arrays are flat and row-major, quaternions are `w x y z`, angles are
//! radians, everything is SI. Spatial vectors list the angular part first.
//!
//! The tables are macros that hand all rows to another macro, so that each use reads the same rows.

/// Sizes and constant arrays of [`Model`](crate::model::Model).
#[macro_export]
macro_rules! model_fields {
    ($apply:ident) => { $apply! {
        // Sizes.
        nq: usize, [], Structure, Compile, "", "number of generalized coordinates";
        nv: usize, [], Structure, Compile, "", "number of degrees of freedom";
        nu: usize, [], Structure, Compile, "", "number of control inputs";
        nactuator: usize, [], Structure, Compile, "", "number of actuators, each with one control by default";
        nout: usize, [], Structure, Compile, "", "number of force outputs of all actuators";
        na: usize, [], Structure, Compile, "", "number of activation states";
        nbody: usize, [], Structure, Compile, "", "number of bodies, the world included";
        ntree: usize, [], Structure, Compile, "", "number of kinematic trees with at least one degree of freedom";
        njnt: usize, [], Structure, Compile, "", "number of joints";
        ngeom: usize, [], Structure, Compile, "", "number of geoms";
        nsite: usize, [], Structure, Compile, "", "number of sites";
        ncam: usize, [], Structure, Compile, "", "number of cameras";
        nlight: usize, [], Structure, Compile, "", "number of lights";
        nmesh: usize, [], Structure, Compile, "", "number of meshes";
        nmeshvert: usize, [], Structure, Compile, "", "number of vertices of all meshes";
        nmeshnormal: usize, [], Structure, Compile, "", "number of normals of all meshes";
        nmeshtexcoord: usize, [], Structure, Compile, "", "number of texture coordinates of all meshes";
        nmeshface: usize, [], Structure, Compile, "", "number of triangles of all meshes";
        nmeshgraph: usize, [], Structure, Compile, "", "number of integers of all convex hulls";
        nskin: usize, [], Structure, Compile, "", "number of skins";
        nskinvert: usize, [], Structure, Compile, "", "number of vertices of all skins";
        nskintexvert: usize, [], Structure, Compile, "", "number of texture coordinates of all skins";
        nskinface: usize, [], Structure, Compile, "", "number of triangles of all skins";
        nskinbone: usize, [], Structure, Compile, "", "number of bones of all skins";
        nskinbonevert: usize, [], Structure, Compile, "", "number of vertices of all bones";
        nhfield: usize, [], Structure, Compile, "", "number of height fields";
        nhfielddata: usize, [], Structure, Compile, "", "number of samples of all height fields";
        ntex: usize, [], Structure, Compile, "", "number of textures";
        nmat: usize, [], Structure, Compile, "", "number of materials";
        npair: usize, [], Structure, Compile, "", "number of explicit contact pairs";
        nexclude: usize, [], Structure, Compile, "", "number of excluded body pairs";
        neq: usize, [], Structure, Compile, "", "number of equality constraints";
        ntendon: usize, [], Structure, Compile, "", "number of tendons";
        nwrap: usize, [], Structure, Compile, "", "number of objects on the paths of all tendons";
        nJten: usize, [], Structure, SetConst, "", "number of non-zeros of the Jacobian of all tendons";
        nJmom: usize, [], Structure, SetConst, "", "number of non-zeros of the moments of all actuators";
        nsensor: usize, [], Structure, Compile, "", "number of sensors";
        nsensordata: usize, [], Structure, Compile, "", "number of sensor values";
        nnumeric: usize, [], Structure, Compile, "", "number of custom lists of numbers";
        nnumericdata: usize, [], Structure, Compile, "", "number of numbers of all custom lists";
        ntext: usize, [], Structure, Compile, "", "number of custom texts";
        ntuple: usize, [], Structure, Compile, "", "number of custom tuples";
        ntupledata: usize, [], Structure, Compile, "", "number of elements of all custom tuples";
        nkey: usize, [], Structure, Compile, "", "number of keyframes";
        nmocap: usize, [], Structure, Compile, "", "number of mocap bodies";
        nuserdata: usize, [], Structure, Compile, "", "number of values reserved for the user";
        nhistory: usize, [], Structure, Compile, "", "number of values in the history of delayed actuators and sensors";
        nuser_body: usize, [], Structure, Compile, "", "number of user values of each body";
        nuser_jnt: usize, [], Structure, Compile, "", "number of user values of each joint";
        nuser_geom: usize, [], Structure, Compile, "", "number of user values of each geom";
        nuser_site: usize, [], Structure, Compile, "", "number of user values of each site";
        nuser_cam: usize, [], Structure, Compile, "", "number of user values of each camera";
        nuser_tendon: usize, [], Structure, Compile, "", "number of user values of each tendon";
        nuser_actuator: usize, [], Structure, Compile, "", "number of user values of each actuator";
        nuser_sensor: usize, [], Structure, Compile, "", "number of user values of each sensor";
        nC: usize, [], Structure, Compile, "", "number of non-zeros of the lower triangle of the mass matrix";
        nD: usize, [], Structure, Compile, "", "number of non-zeros of the whole mass matrix";
        ngravcomp: usize, [], Structure, SetConst, "", "number of bodies with gravity compensation";

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
        body_gravcomp: Vec<f64>, [nbody], Inertial, Compile, "", "upward force against gravity, in weights of the body";
        body_margin: Vec<f64>, [nbody], Derived, Compile, "m", "largest margin plus gap of the body's geoms";
        body_contype: Vec<i32>, [nbody], Constant, Compile, "", "contact types of all geoms of the body when it was compiled";
        body_conaffinity: Vec<i32>, [nbody], Constant, Compile, "", "contact affinities of all geoms of the body when it was compiled";
        body_user: Vec<f64>, [nbody, nuser_body], Constant, Compile, "", "user values";

        // Joints.
        jnt_type: Vec<i32>, [njnt], Structure, Compile, "", "0 free, 1 ball, 2 slide, 3 hinge";
        jnt_qposadr: Vec<i32>, [njnt], Structure, Compile, "", "first coordinate of the joint in qpos";
        jnt_dofadr: Vec<i32>, [njnt], Structure, Compile, "", "first degree of freedom of the joint in qvel";
        jnt_bodyid: Vec<i32>, [njnt], Structure, Compile, "", "body of the joint";
        jnt_actuatorid: Vec<i32>, [njnt], Structure, SetConst, "", "actuator that adds damping or armature to the joint, -1 if none";
        jnt_group: Vec<i32>, [njnt], Constant, Compile, "", "group, for visibility";
        jnt_limited: Vec<bool>, [njnt], Constant, Compile, "", "whether the joint has limits";
        jnt_actfrclimited: Vec<bool>, [njnt], Constant, Compile, "", "whether the total actuator force on the joint is limited";
        jnt_actgravcomp: Vec<bool>, [njnt], Constant, Compile, "", "whether gravity compensation acts as a force of actuators";
        jnt_solref: Vec<f64>, [njnt, 2], Constant, Compile, "s, 1", "limit constraint: time constant and damping ratio (or -stiffness, -damping)";
        jnt_solimp: Vec<f64>, [njnt, 5], Constant, Compile, "", "limit constraint: impedance";
        jnt_pos: Vec<f64>, [njnt, 3], Constant, Compile, "m", "anchor in the body's frame";
        jnt_axis: Vec<f64>, [njnt, 3], Constant, Compile, "", "axis in the body's frame";
        jnt_stiffness: Vec<f64>, [njnt], Constant, Compile, "N/m or N m/rad", "stiffness of the joint spring";
        jnt_stiffnesspoly: Vec<f64>, [njnt, 2], Constant, Compile, "", "growth of the stiffness with displacement: linear, quadratic";
        jnt_range: Vec<f64>, [njnt, 2], Constant, Compile, "m or rad", "lower and upper limit";
        jnt_actfrcrange: Vec<f64>, [njnt, 2], Constant, Compile, "N or N m", "range of the total actuator force";
        jnt_margin: Vec<f64>, [njnt], Constant, Compile, "m or rad", "distance from the limit at which it becomes active";
        jnt_user: Vec<f64>, [njnt, nuser_jnt], Constant, Compile, "", "user values";

        // Degrees of freedom.
        dof_bodyid: Vec<i32>, [nv], Structure, Compile, "", "body of the degree of freedom";
        dof_jntid: Vec<i32>, [nv], Structure, Compile, "", "joint of the degree of freedom";
        dof_parentid: Vec<i32>, [nv], Structure, Compile, "", "previous degree of freedom on the way to the root, -1 if none";
        dof_treeid: Vec<i32>, [nv], Structure, Compile, "", "kinematic tree of the degree of freedom";
        dof_simplenum: Vec<i32>, [nv], Structure, SetConst, "", "number of consecutive simple degrees of freedom from here";
        dof_solref: Vec<f64>, [nv, 2], Constant, Compile, "s, 1", "friction loss: time constant and damping ratio (or -stiffness, -damping)";
        dof_solimp: Vec<f64>, [nv, 5], Constant, Compile, "", "friction loss: impedance";
        dof_frictionloss: Vec<f64>, [nv], Constant, Compile, "N or N m", "dry friction";
        dof_armature: Vec<f64>, [nv], Inertial, Compile, "kg or kg m^2", "inertia added to the diagonal of the mass matrix";
        dof_damping: Vec<f64>, [nv], Constant, Compile, "N s/m or N m s/rad", "linear damping";
        dof_dampingpoly: Vec<f64>, [nv, 2], Constant, Compile, "", "growth of the damping with speed: linear, quadratic";
        dof_invweight0: Vec<f64>, [nv], Derived, SetConst, "1/kg or 1/(kg m^2)", "diagonal of the inverse inertia at qpos0";
        dof_M0: Vec<f64>, [nv], Derived, SetConst, "kg or kg m^2", "diagonal of the mass matrix at qpos0";
        dof_length: Vec<f64>, [nv], Derived, SetConst, "1 or m", "length that turns a velocity into that of a point: 1 for translations";

        // Kinematic trees: their bodies and degrees of freedom are contiguous.
        tree_bodyadr: Vec<i32>, [ntree], Structure, SetConst, "", "first body of the tree";
        tree_bodynum: Vec<i32>, [ntree], Structure, SetConst, "", "number of bodies of the tree";
        tree_dofadr: Vec<i32>, [ntree], Structure, SetConst, "", "first degree of freedom of the tree";
        tree_dofnum: Vec<i32>, [ntree], Structure, SetConst, "", "number of degrees of freedom of the tree";
        tree_sleep_policy: Vec<i32>, [ntree], Constant, Compile, "", "whether the tree may sleep (mjtSleepPolicy)";

        // Pattern of the mass matrix: lower triangle by rows, ancestors first, the diagonal last; then all of it.
        M_rownnz: Vec<i32>, [nv], Structure, Compile, "", "number of non-zeros of each row of the mass matrix";
        M_rowadr: Vec<i32>, [nv], Structure, Compile, "", "address of each row of the mass matrix";
        M_colind: Vec<i32>, [nC], Structure, Compile, "", "column of each non-zero of the mass matrix";
        D_rownnz: Vec<i32>, [nv], Structure, Compile, "", "number of non-zeros of each row, both triangles";
        D_rowadr: Vec<i32>, [nv], Structure, Compile, "", "address of each row, both triangles";
        D_diag: Vec<i32>, [nv], Structure, Compile, "", "place of the diagonal in each row";
        D_colind: Vec<i32>, [nD], Structure, Compile, "", "column of each non-zero, both triangles";

        // Geoms.
        geom_type: Vec<i32>, [ngeom], Structure, Compile, "", "0 plane, 1 height field, 2 sphere, 3 capsule, 4 ellipsoid, 5 cylinder, 6 box, 7 mesh";
        geom_contype: Vec<i32>, [ngeom], Constant, Compile, "", "bits of the contact types the geom is";
        geom_conaffinity: Vec<i32>, [ngeom], Constant, Compile, "", "bits of the contact types the geom accepts";
        geom_condim: Vec<i32>, [ngeom], Constant, Compile, "", "dimension of the contact: 1 frictionless, 3 sliding, 4 and spinning, 6 and rolling friction";
        geom_bodyid: Vec<i32>, [ngeom], Structure, Compile, "", "body of the geom";
        geom_dataid: Vec<i32>, [ngeom], Structure, Compile, "", "mesh or height field of the geom, -1 if none";
        geom_matid: Vec<i32>, [ngeom], Constant, Compile, "", "material, -1 if none";
        geom_group: Vec<i32>, [ngeom], Constant, Compile, "", "group, for visibility and inertia";
        geom_priority: Vec<i32>, [ngeom], Constant, Compile, "", "the geom of higher priority decides the contact's parameters";
        geom_sameframe: Vec<i32>, [ngeom], Structure, SetConst, "", "geom frame: 0 its own, 1 the body's, 2 the inertial frame, 3 and 4 the same orientation";
        geom_solmix: Vec<f64>, [ngeom], Constant, Compile, "", "weight in the mix of solref and solimp";
        geom_solref: Vec<f64>, [ngeom, 2], Constant, Compile, "s, 1", "contact: time constant and damping ratio (or -stiffness, -damping)";
        geom_solimp: Vec<f64>, [ngeom, 5], Constant, Compile, "", "contact: impedance (d0, dwidth, width, midpoint, power)";
        geom_size: Vec<f64>, [ngeom, 3], Constant, Compile, "m", "size: radius, or radius and half length, or three half lengths";
        geom_aabb: Vec<f64>, [ngeom, 6], Constant, Compile, "m", "bounding box in the geom's frame: centre, half lengths";
        geom_rbound: Vec<f64>, [ngeom], Constant, Compile, "m", "radius of the bounding sphere, 0 for a plane";
        geom_pos: Vec<f64>, [ngeom, 3], Constant, Compile, "m", "position in the body's frame";
        geom_quat: Vec<f64>, [ngeom, 4], Constant, Compile, "", "orientation in the body's frame";
        geom_friction: Vec<f64>, [ngeom, 3], Constant, Compile, "1, m, m", "friction: sliding, spinning, rolling";
        geom_margin: Vec<f64>, [ngeom], Constant, Compile, "m", "distance at which a contact starts to push";
        geom_gap: Vec<f64>, [ngeom], Constant, Compile, "m", "further distance at which a contact is detected without pushing";
        geom_surfacevel: Vec<f64>, [ngeom, 6], Constant, Compile, "m/s, rad/s", "velocity of the surface in the geom's frame: linear, angular";
        geom_adhesion: Vec<f64>, [ngeom], Constant, Compile, "N", "force with which contacts of the geom pull";
        geom_fluid: Vec<f64>, [ngeom, 12], Constant, Compile, "", "fluid forces on an ellipsoid: switch, five coefficients, added mass, added inertia";
        geom_user: Vec<f64>, [ngeom, nuser_geom], Constant, Compile, "", "user values";
        geom_rgba: Vec<f64>, [ngeom, 4], Constant, Compile, "", "colour and opacity";

        // Sites.
        site_type: Vec<i32>, [nsite], Structure, Compile, "", "shape, as geom_type";
        site_bodyid: Vec<i32>, [nsite], Structure, Compile, "", "body of the site";
        site_dataid: Vec<i32>, [nsite], Structure, Compile, "", "mesh of the site, -1 if none";
        site_matid: Vec<i32>, [nsite], Constant, Compile, "", "material, -1 if none";
        site_group: Vec<i32>, [nsite], Constant, Compile, "", "group, for visibility";
        site_sameframe: Vec<i32>, [nsite], Structure, SetConst, "", "site frame, as geom_sameframe";
        site_size: Vec<f64>, [nsite, 3], Constant, Compile, "m", "size of the volume of touch sensors, and for drawing";
        site_pos: Vec<f64>, [nsite, 3], Constant, Compile, "m", "position in the body's frame";
        site_quat: Vec<f64>, [nsite, 4], Constant, Compile, "", "orientation in the body's frame";
        site_user: Vec<f64>, [nsite, nuser_site], Constant, Compile, "", "user values";
        site_rgba: Vec<f64>, [nsite, 4], Constant, Compile, "", "colour and opacity";

        // Cameras.
        cam_mode: Vec<i32>, [ncam], Structure, Compile, "", "0 fixed, 1 track, 2 trackcom, 3 targetbody, 4 targetbodycom";
        cam_bodyid: Vec<i32>, [ncam], Structure, Compile, "", "body of the camera";
        cam_targetbodyid: Vec<i32>, [ncam], Structure, Compile, "", "body that the camera looks at, -1 if none";
        cam_pos: Vec<f64>, [ncam, 3], Constant, Compile, "m", "position in the body's frame";
        cam_quat: Vec<f64>, [ncam, 4], Constant, Compile, "", "orientation in the body's frame; the camera looks along -z";
        cam_poscom0: Vec<f64>, [ncam, 3], Derived, SetConst, "m", "position relative to the subtree's centre of mass at qpos0, world axes";
        cam_pos0: Vec<f64>, [ncam, 3], Derived, SetConst, "m", "position relative to the body at qpos0, world axes";
        cam_mat0: Vec<f64>, [ncam, 9], Derived, SetConst, "", "orientation at qpos0, world";
        cam_projection: Vec<i32>, [ncam], Constant, Compile, "", "0 perspective, 1 orthographic";
        cam_fovy: Vec<f64>, [ncam], Constant, Compile, "degree or m", "vertical field of view";
        cam_ipd: Vec<f64>, [ncam], Constant, Compile, "m", "distance between the eyes";
        cam_resolution: Vec<i32>, [ncam, 2], Constant, Compile, "pixel", "width and height of the image";
        cam_output: Vec<i32>, [ncam], Constant, Compile, "", "bits of the images it makes";
        cam_sensorsize: Vec<f64>, [ncam, 2], Constant, Compile, "m", "width and height of the sensor, 0 when fovy decides";
        cam_intrinsic: Vec<f64>, [ncam, 4], Constant, Compile, "m", "focal length, principal point";
        cam_user: Vec<f64>, [ncam, nuser_cam], Constant, Compile, "", "user values";

        // Lights.
        light_mode: Vec<i32>, [nlight], Structure, Compile, "", "as cam_mode";
        light_bodyid: Vec<i32>, [nlight], Structure, Compile, "", "body of the light";
        light_targetbodyid: Vec<i32>, [nlight], Structure, Compile, "", "body that the light points at, -1 if none";
        light_type: Vec<i32>, [nlight], Constant, Compile, "", "0 spot, 1 directional, 2 point, 3 image";
        light_texid: Vec<i32>, [nlight], Constant, Compile, "", "texture of an image light, -1 if none";
        light_castshadow: Vec<bool>, [nlight], Constant, Compile, "", "whether it casts shadows";
        light_active: Vec<bool>, [nlight], Constant, Compile, "", "whether it is on";
        light_bulbradius: Vec<f64>, [nlight], Constant, Compile, "m", "radius, for soft shadows";
        light_intensity: Vec<f64>, [nlight], Constant, Compile, "cd", "intensity";
        light_range: Vec<f64>, [nlight], Constant, Compile, "m", "range";
        light_pos: Vec<f64>, [nlight, 3], Constant, Compile, "m", "position in the body's frame";
        light_dir: Vec<f64>, [nlight, 3], Constant, Compile, "", "direction in the body's frame";
        light_poscom0: Vec<f64>, [nlight, 3], Derived, SetConst, "m", "position relative to the subtree's centre of mass at qpos0, world axes";
        light_pos0: Vec<f64>, [nlight, 3], Derived, SetConst, "m", "position relative to the body at qpos0, world axes";
        light_dir0: Vec<f64>, [nlight, 3], Derived, SetConst, "", "direction at qpos0, world";
        light_attenuation: Vec<f64>, [nlight, 3], Constant, Compile, "", "attenuation: constant, linear, quadratic";
        light_cutoff: Vec<f64>, [nlight], Constant, Compile, "degree", "half angle of a spot light";
        light_softness: Vec<f64>, [nlight], Constant, Compile, "", "softness of a spot light's edge";
        light_exponent: Vec<f64>, [nlight], Constant, Compile, "", "how fast a spot light fades to its edge";
        light_ambient: Vec<f64>, [nlight, 3], Constant, Compile, "", "ambient colour";
        light_diffuse: Vec<f64>, [nlight, 3], Constant, Compile, "", "diffuse colour";
        light_specular: Vec<f64>, [nlight, 3], Constant, Compile, "", "specular colour";

        // Meshes, in the frame of their principal axes. Vertices have the precision of 32-bit floats.
        mesh_vertadr: Vec<i32>, [nmesh], Structure, Compile, "", "first vertex";
        mesh_vertnum: Vec<i32>, [nmesh], Structure, Compile, "", "number of vertices";
        mesh_faceadr: Vec<i32>, [nmesh], Structure, Compile, "", "first triangle";
        mesh_facenum: Vec<i32>, [nmesh], Structure, Compile, "", "number of triangles";
        mesh_normaladr: Vec<i32>, [nmesh], Structure, Compile, "", "first normal";
        mesh_normalnum: Vec<i32>, [nmesh], Structure, Compile, "", "number of normals";
        mesh_texcoordadr: Vec<i32>, [nmesh], Structure, Compile, "", "first texture coordinate, -1 if none";
        mesh_texcoordnum: Vec<i32>, [nmesh], Structure, Compile, "", "number of texture coordinates";
        mesh_graphadr: Vec<i32>, [nmesh], Structure, Compile, "", "address of the convex hull in mesh_graph, -1 if none";
        mesh_vert: Vec<f64>, [nmeshvert, 3], Constant, Compile, "m", "vertices";
        mesh_normal: Vec<f64>, [nmeshnormal, 3], Constant, Compile, "", "normals";
        mesh_texcoord: Vec<f64>, [nmeshtexcoord, 2], Constant, Compile, "", "texture coordinates";
        mesh_face: Vec<i32>, [nmeshface, 3], Structure, Compile, "", "vertices of each triangle";
        mesh_facenormal: Vec<i32>, [nmeshface, 3], Structure, Compile, "", "normals of each triangle's corners";
        mesh_facetexcoord: Vec<i32>, [nmeshface, 3], Structure, Compile, "", "texture coordinates of each triangle's corners";
        mesh_graph: Vec<i32>, [nmeshgraph], Structure, Compile, "", "convex hulls: numbers of vertices and faces, address and id of each vertex, neighbours (each list ends with -1), faces";
        mesh_scale: Vec<f64>, [nmesh, 3], Constant, Compile, "", "scale applied to the asset";
        mesh_pos: Vec<f64>, [nmesh, 3], Constant, Compile, "m", "translation applied to the asset";
        mesh_quat: Vec<f64>, [nmesh, 4], Constant, Compile, "", "rotation applied to the asset";

        // Skins: surfaces that bodies carry, for those who draw them. Numbers have the precision of 32-bit floats.
        skin_matid: Vec<i32>, [nskin], Constant, Compile, "", "material, -1 if none";
        skin_group: Vec<i32>, [nskin], Constant, Compile, "", "group, for visibility";
        skin_rgba: Vec<f64>, [nskin, 4], Constant, Compile, "", "colour and opacity when there is no material";
        skin_inflate: Vec<f64>, [nskin], Constant, Compile, "m", "how far vertices are moved along their normals";
        skin_vertadr: Vec<i32>, [nskin], Structure, Compile, "", "first vertex";
        skin_vertnum: Vec<i32>, [nskin], Structure, Compile, "", "number of vertices";
        skin_texcoordadr: Vec<i32>, [nskin], Structure, Compile, "", "first texture coordinate, -1 if none";
        skin_faceadr: Vec<i32>, [nskin], Structure, Compile, "", "first triangle";
        skin_facenum: Vec<i32>, [nskin], Structure, Compile, "", "number of triangles";
        skin_boneadr: Vec<i32>, [nskin], Structure, Compile, "", "first bone";
        skin_bonenum: Vec<i32>, [nskin], Structure, Compile, "", "number of bones";
        skin_vert: Vec<f64>, [nskinvert, 3], Constant, Compile, "m", "vertices, in the pose in which the bones are bound";
        skin_texcoord: Vec<f64>, [nskintexvert, 2], Constant, Compile, "", "texture coordinates";
        skin_face: Vec<i32>, [nskinface, 3], Structure, Compile, "", "vertices of each triangle, counted from the skin's first";
        skin_bonevertadr: Vec<i32>, [nskinbone], Structure, Compile, "", "first vertex of the bone";
        skin_bonevertnum: Vec<i32>, [nskinbone], Structure, Compile, "", "number of vertices of the bone";
        skin_bonebindpos: Vec<f64>, [nskinbone, 3], Constant, Compile, "m", "position of the body when it was bound, world";
        skin_bonebindquat: Vec<f64>, [nskinbone, 4], Constant, Compile, "", "orientation of the body when it was bound, world";
        skin_bonebodyid: Vec<i32>, [nskinbone], Structure, Compile, "", "body that is the bone";
        skin_bonevertid: Vec<i32>, [nskinbonevert], Structure, Compile, "", "vertex, counted from the skin's first";
        skin_bonevertweight: Vec<f64>, [nskinbonevert], Constant, Compile, "", "the bone's share of the vertex";

        // Height fields.
        hfield_size: Vec<f64>, [nhfield, 4], Constant, Compile, "m", "half lengths in x and y, height of the top, depth of the base";
        hfield_nrow: Vec<i32>, [nhfield], Structure, Compile, "", "number of rows (y)";
        hfield_ncol: Vec<i32>, [nhfield], Structure, Compile, "", "number of columns (x)";
        hfield_adr: Vec<i32>, [nhfield], Structure, Compile, "", "first sample";
        hfield_data: Vec<f64>, [nhfielddata], Constant, Compile, "", "elevation, from 0 to 1";

        // Materials.
        mat_texid: Vec<i32>, [nmat, 10], Constant, Compile, "", "textures by role, -1 if none";
        mat_texuniform: Vec<bool>, [nmat], Constant, Compile, "", "whether the texture keeps its scale";
        mat_texrepeat: Vec<f64>, [nmat, 2], Constant, Compile, "", "repetition of the texture";
        mat_emission: Vec<f64>, [nmat], Constant, Compile, "", "emission";
        mat_specular: Vec<f64>, [nmat], Constant, Compile, "", "specular reflection";
        mat_shininess: Vec<f64>, [nmat], Constant, Compile, "", "shininess";
        mat_reflectance: Vec<f64>, [nmat], Constant, Compile, "", "mirror reflection";
        mat_metallic: Vec<f64>, [nmat], Constant, Compile, "", "metallic";
        mat_roughness: Vec<f64>, [nmat], Constant, Compile, "", "roughness";
        mat_rgba: Vec<f64>, [nmat, 4], Constant, Compile, "", "colour and opacity";

        // Contact pairs and exclusions.
        pair_dim: Vec<i32>, [npair], Constant, Compile, "", "dimension of the contact";
        pair_geom1: Vec<i32>, [npair], Structure, Compile, "", "first geom";
        pair_geom2: Vec<i32>, [npair], Structure, Compile, "", "second geom";
        pair_signature: Vec<i32>, [npair], Structure, Compile, "", "first body times 65536 plus second body";
        pair_solref: Vec<f64>, [npair, 2], Constant, Compile, "s, 1", "normal direction: time constant and damping ratio (or -stiffness, -damping)";
        pair_solreffriction: Vec<f64>, [npair, 2], Constant, Compile, "s, 1", "the same for friction; 0 0 as the normal direction";
        pair_solimp: Vec<f64>, [npair, 5], Constant, Compile, "", "impedance";
        pair_margin: Vec<f64>, [npair], Constant, Compile, "m", "distance at which the contact starts to push";
        pair_gap: Vec<f64>, [npair], Constant, Compile, "m", "further distance at which it is detected";
        pair_adhesion: Vec<f64>, [npair], Constant, Compile, "N", "force with which it pulls";
        pair_friction: Vec<f64>, [npair, 5], Constant, Compile, "1, 1, m, m, m", "friction: two sliding, spinning, two rolling";
        exclude_signature: Vec<i32>, [nexclude], Structure, Compile, "", "first body times 65536 plus second body";

        // Equality constraints.
        eq_type: Vec<i32>, [neq], Structure, Compile, "", "0 connect, 1 weld, 2 joint, 3 tendon";
        eq_obj1id: Vec<i32>, [neq], Structure, Compile, "", "first object";
        eq_obj2id: Vec<i32>, [neq], Structure, Compile, "", "second object, -1 if none";
        eq_objtype: Vec<i32>, [neq], Structure, Compile, "", "kind of both objects (mjtObj)";
        eq_active0: Vec<bool>, [neq], Constant, Compile, "", "whether the constraint is active after a reset";
        eq_solref: Vec<f64>, [neq, 2], Constant, Compile, "s, 1", "time constant and damping ratio (or -stiffness, -damping)";
        eq_solimp: Vec<f64>, [neq, 5], Constant, Compile, "", "impedance";
        eq_data: Vec<f64>, [neq, 11], Constant, Compile, "", "anchors, relative pose, or polynomial";

        // Tendons, and the objects on their paths.
        tendon_adr: Vec<i32>, [ntendon], Structure, Compile, "", "first object of the path";
        tendon_num: Vec<i32>, [ntendon], Structure, Compile, "", "number of objects of the path";
        tendon_matid: Vec<i32>, [ntendon], Constant, Compile, "", "material, -1 if none";
        tendon_actuatorid: Vec<i32>, [ntendon], Structure, SetConst, "", "actuator that adds damping or armature to the tendon, -1 if none";
        tendon_group: Vec<i32>, [ntendon], Constant, Compile, "", "group, for visibility";
        tendon_treenum: Vec<i32>, [ntendon], Structure, SetConst, "", "number of kinematic trees that the path touches";
        tendon_treeid: Vec<i32>, [ntendon, 2], Structure, SetConst, "", "the first two of them, -1 if none";
        ten_J_rownnz: Vec<i32>, [ntendon], Structure, SetConst, "", "number of non-zeros of the tendon's Jacobian";
        ten_J_rowadr: Vec<i32>, [ntendon], Structure, SetConst, "", "their address";
        ten_J_colind: Vec<i32>, [nJten], Structure, SetConst, "", "degree of freedom of each non-zero";
        tendon_limited: Vec<bool>, [ntendon], Constant, Compile, "", "whether the length is limited";
        tendon_actfrclimited: Vec<bool>, [ntendon], Constant, Compile, "", "whether the total actuator force is limited";
        tendon_width: Vec<f64>, [ntendon], Constant, Compile, "m", "width, for drawing";
        tendon_solref_lim: Vec<f64>, [ntendon, 2], Constant, Compile, "s, 1", "limit: time constant and damping ratio (or -stiffness, -damping)";
        tendon_solimp_lim: Vec<f64>, [ntendon, 5], Constant, Compile, "", "limit: impedance";
        tendon_solref_fri: Vec<f64>, [ntendon, 2], Constant, Compile, "s, 1", "friction loss: time constant and damping ratio (or -stiffness, -damping)";
        tendon_solimp_fri: Vec<f64>, [ntendon, 5], Constant, Compile, "", "friction loss: impedance";
        tendon_range: Vec<f64>, [ntendon, 2], Constant, Compile, "m", "lower and upper limit of the length";
        tendon_actfrcrange: Vec<f64>, [ntendon, 2], Constant, Compile, "N", "range of the total actuator force";
        tendon_margin: Vec<f64>, [ntendon], Constant, Compile, "m", "distance from the limit at which it becomes active";
        tendon_stiffness: Vec<f64>, [ntendon], Constant, Compile, "N/m", "stiffness";
        tendon_stiffnesspoly: Vec<f64>, [ntendon, 2], Constant, Compile, "", "growth of the stiffness with displacement: linear, quadratic";
        tendon_damping: Vec<f64>, [ntendon], Constant, Compile, "N s/m", "linear damping";
        tendon_dampingpoly: Vec<f64>, [ntendon, 2], Constant, Compile, "", "growth of the damping with speed: linear, quadratic";
        tendon_armature: Vec<f64>, [ntendon], Inertial, Compile, "kg", "inertia of the tendon's motion";
        tendon_frictionloss: Vec<f64>, [ntendon], Constant, Compile, "N", "dry friction";
        tendon_lengthspring: Vec<f64>, [ntendon, 2], Constant, SetConst, "m", "lengths between which the spring is relaxed";
        tendon_length0: Vec<f64>, [ntendon], Derived, SetConst, "m", "length at qpos0";
        tendon_invweight0: Vec<f64>, [ntendon], Derived, SetConst, "1/kg", "inverse inertia at qpos0";
        tendon_user: Vec<f64>, [ntendon, nuser_tendon], Constant, Compile, "", "user values";
        tendon_rgba: Vec<f64>, [ntendon, 4], Constant, Compile, "", "colour and opacity";
        wrap_type: Vec<i32>, [nwrap], Structure, Compile, "", "1 joint, 2 pulley, 3 site, 4 sphere, 5 cylinder";
        wrap_objid: Vec<i32>, [nwrap], Structure, Compile, "", "the joint, site or geom; -1 for a pulley";
        wrap_prm: Vec<f64>, [nwrap], Constant, Compile, "", "coefficient of a joint, divisor of a pulley, side site of a geom (-1 if none)";

        // Actuators: each has controls, activations and force outputs.
        actuator_trntype: Vec<i32>, [nactuator], Structure, Compile, "", "transmission: 0 joint, 1 jointinparent, 2 slider-crank, 3 tendon, 4 site, 5 body, 6 orientation";
        actuator_dyntype: Vec<i32>, [nactuator], Structure, Compile, "", "dynamics: 0 none, 1 integrator, 2 filter, 3 filterexact, 4 muscle, 5 dcmotor, 6 pid";
        actuator_gaintype: Vec<i32>, [nactuator], Structure, Compile, "", "gain: 0 fixed, 1 affine, 2 muscle, 3 dcmotor, 4 orientation, 5 pid";
        actuator_biastype: Vec<i32>, [nactuator], Structure, Compile, "", "bias: 0 none, 1 affine, 2 muscle, 3 dcmotor, 4 orientation";
        actuator_ctrladr: Vec<i32>, [nactuator], Structure, Compile, "", "first control";
        actuator_ctrlnum: Vec<i32>, [nactuator], Structure, Compile, "", "number of controls";
        actuator_ctrlspec: Vec<i32>, [nactuator], Structure, Compile, "", "meaning of the controls, by gain type";
        actuator_outadr: Vec<i32>, [nactuator], Structure, Compile, "", "first force output";
        actuator_outnum: Vec<i32>, [nactuator], Structure, Compile, "", "number of force outputs";
        actuator_actadr: Vec<i32>, [nactuator], Structure, Compile, "", "first activation, -1 if none";
        actuator_actnum: Vec<i32>, [nactuator], Structure, Compile, "", "number of activations";
        actuator_trnid: Vec<i32>, [nactuator, 2], Structure, Compile, "", "the joint, tendon, site or body, and a second one, -1 if none";
        actuator_cranklength: Vec<f64>, [nactuator], Constant, Compile, "m", "length of a slider-crank's rod";
        actuator_dynprm: Vec<f64>, [nactuator, 10], Constant, Compile, "", "dynamics parameters";
        actuator_gainprm: Vec<f64>, [nactuator, 10], Constant, Compile, "", "gain parameters";
        actuator_biasprm: Vec<f64>, [nactuator, 10], Constant, Compile, "", "bias parameters";
        actuator_actlimited: Vec<bool>, [nactuator], Constant, Compile, "", "whether the activation is clamped";
        actuator_actrange: Vec<f64>, [nactuator, 2], Constant, Compile, "", "range of the activation";
        actuator_actearly: Vec<bool>, [nactuator], Constant, Compile, "", "whether the force uses the next activation";
        actuator_history: Vec<i32>, [nactuator, 2], Structure, Compile, "", "number of samples kept for a delay, interpolation (0 hold, 1 linear, 2 cubic)";
        actuator_historyadr: Vec<i32>, [nactuator], Structure, Compile, "", "address in data.history, -1 if none";
        actuator_delay: Vec<f64>, [nactuator], Constant, Compile, "s", "delay of the control";
        actuator_damping: Vec<f64>, [nactuator], Constant, Compile, "N s/m or N m s/rad", "damping added to the joint or tendon";
        actuator_dampingpoly: Vec<f64>, [nactuator, 2], Constant, Compile, "", "growth of the damping with speed: linear, quadratic";
        actuator_armature: Vec<f64>, [nactuator], Inertial, Compile, "kg or kg m^2", "inertia added to the joint or tendon";
        actuator_group: Vec<i32>, [nactuator], Constant, Compile, "", "group, for visibility and opt.disableactuator";
        actuator_user: Vec<f64>, [nactuator, nuser_actuator], Constant, Compile, "", "user values";
        actuator_forcelimited: Vec<bool>, [nactuator], Constant, Compile, "", "whether the force is clamped";
        actuator_forcerange: Vec<f64>, [nactuator, 2], Constant, Compile, "N or N m", "range of the force";
        actuator_ctrllimited: Vec<bool>, [nu], Constant, Compile, "", "whether the control is clamped";
        actuator_ctrlrange: Vec<f64>, [nu, 2], Constant, Compile, "", "range of the control";
        actuator_gear: Vec<f64>, [nout, 6], Constant, Compile, "", "scale of length and force";
        actuator_acc0: Vec<f64>, [nout], Derived, SetConst, "m/s^2 or rad/s^2", "acceleration caused by a unit force at qpos0";
        actuator_length0: Vec<f64>, [nout], Derived, SetConst, "m or rad", "length at qpos0";
        actuator_lengthrange: Vec<f64>, [nout, 2], Constant, Compile, "m or rad", "range of lengths that the mechanism can reach";

        // Sensors.
        sensor_type: Vec<i32>, [nsensor], Structure, Compile, "", "type (mjtSensor)";
        sensor_datatype: Vec<i32>, [nsensor], Structure, Compile, "", "0 real, 1 positive, 2 axis, 3 quaternion";
        sensor_needstage: Vec<i32>, [nsensor], Structure, Compile, "", "1 position, 2 velocity, 3 acceleration: the stage that computes it";
        sensor_objtype: Vec<i32>, [nsensor], Structure, Compile, "", "kind of the sensed object (mjtObj)";
        sensor_objid: Vec<i32>, [nsensor], Structure, Compile, "", "the sensed object";
        sensor_reftype: Vec<i32>, [nsensor], Structure, Compile, "", "kind of the reference object (mjtObj)";
        sensor_refid: Vec<i32>, [nsensor], Structure, Compile, "", "the reference object, -1 for the world";
        sensor_intprm: Vec<i32>, [nsensor, 3], Structure, Compile, "", "parameters of contact and distance sensors";
        sensor_dim: Vec<i32>, [nsensor], Structure, Compile, "", "number of values";
        sensor_adr: Vec<i32>, [nsensor], Structure, Compile, "", "first value in sensordata";
        sensor_cutoff: Vec<f64>, [nsensor], Constant, Compile, "", "values are clamped to this magnitude, 0 for no limit";
        sensor_noise: Vec<f64>, [nsensor], Constant, Compile, "", "standard deviation, information only";
        sensor_history: Vec<i32>, [nsensor, 2], Structure, Compile, "", "number of samples kept for a delay, interpolation (0 hold, 1 linear, 2 cubic)";
        sensor_historyadr: Vec<i32>, [nsensor], Structure, Compile, "", "address in data.history, -1 if none";
        sensor_delay: Vec<f64>, [nsensor], Constant, Compile, "s", "delay of the value";
        sensor_interval: Vec<f64>, [nsensor, 2], Constant, Compile, "s", "period and phase of the readings, 0 for every step";
        sensor_user: Vec<f64>, [nsensor, nuser_sensor], Constant, Compile, "", "user values";

        // Custom data.
        numeric_adr: Vec<i32>, [nnumeric], Structure, Compile, "", "first number of the list";
        numeric_size: Vec<i32>, [nnumeric], Structure, Compile, "", "length of the list";
        numeric_data: Vec<f64>, [nnumericdata], Constant, Compile, "", "numbers of all lists";
        tuple_adr: Vec<i32>, [ntuple], Structure, Compile, "", "first element of the tuple";
        tuple_size: Vec<i32>, [ntuple], Structure, Compile, "", "number of elements";
        tuple_objtype: Vec<i32>, [ntupledata], Structure, Compile, "", "kind of each element (mjtObj)";
        tuple_objid: Vec<i32>, [ntupledata], Structure, Compile, "", "id of each element";
        tuple_objprm: Vec<f64>, [ntupledata], Constant, Compile, "", "parameter of each element";

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
#[macro_export]
macro_rules! option_fields {
    ($apply:ident) => { $apply! {
        timestep: f64, [], Constant, Compile, "s", "length of a step";
        impratio: f64, [], Constant, Compile, "", "ratio of frictional to normal impedance";
        tolerance: f64, [], Constant, Compile, "", "the solver stops when the scaled improvement falls below this";
        ls_tolerance: f64, [], Constant, Compile, "", "the same for the line search, relative to `tolerance`";
        noslip_tolerance: f64, [], Constant, Compile, "", "the same for the solver that removes slip";
        ccd_tolerance: f64, [], Constant, Compile, "m", "the same for the distance of convex shapes";
        sleep_tolerance: f64, [], Constant, Compile, "m/s", "a tree that is slower than this may sleep";
        gravity: [f64; 3], [3], Constant, Compile, "m/s^2", "gravity";
        wind: [f64; 3], [3], Constant, Compile, "m/s", "velocity of the medium";
        magnetic: [f64; 3], [3], Constant, Compile, "", "magnetic flux";
        density: f64, [], Constant, Compile, "kg/m^3", "density of the medium";
        viscosity: f64, [], Constant, Compile, "Pa s", "viscosity of the medium";
        o_margin: f64, [], Constant, Compile, "m", "margin of all contacts when the override flag is set";
        o_solref: [f64; 2], [2], Constant, Compile, "s, 1", "solref of all contacts when the override flag is set";
        o_solimp: [f64; 5], [5], Constant, Compile, "", "solimp of all contacts when the override flag is set";
        o_friction: [f64; 5], [5], Constant, Compile, "", "friction of all contacts when the override flag is set";
        integrator: i32, [], Constant, Compile, "", "0 Euler, 1 RK4, 2 implicit, 3 implicitfast, 4 discrete";
        cone: i32, [], Constant, Compile, "", "friction cone: 0 pyramidal, 1 elliptic";
        jacobian: i32, [], Constant, Compile, "", "0 dense, 1 sparse, 2 auto; it changes no number";
        solver: i32, [], Constant, Compile, "", "0 PGS, 1 CG, 2 Newton";
        iterations: i32, [], Constant, Compile, "", "largest number of solver iterations";
        ls_iterations: i32, [], Constant, Compile, "", "largest number of line-search evaluations";
        noslip_iterations: i32, [], Constant, Compile, "", "largest number of iterations that remove slip";
        ccd_iterations: i32, [], Constant, Compile, "", "largest number of iterations for the distance of convex shapes";
        disableflags: i32, [], Constant, Compile, "", "bits of what is switched off (mjtDisableBit)";
        enableflags: i32, [], Constant, Compile, "", "bits of what is switched on (mjtEnableBit)";
        disableactuator: i32, [], Constant, Compile, "", "bits of the actuator groups that are switched off";
        sdf_initpoints: i32, [], Constant, Compile, "", "starting points of contacts of signed distance fields";
        sdf_iterations: i32, [], Constant, Compile, "", "iterations of contacts of signed distance fields";
    } };
}

/// `model.stat`: statistics of the model at `qpos0`.
#[macro_export]
macro_rules! statistic_fields {
    ($apply:ident) => { $apply! {
        meaninertia: f64, [], Constant, SetConst, "kg or kg m^2", "mean diagonal of the mass matrix; scales the solver's tolerance";
        meanmass: f64, [], Constant, SetConst, "kg", "mean body mass";
        meansize: f64, [], Constant, SetConst, "m", "mean body size";
        extent: f64, [], Constant, SetConst, "m", "spatial extent";
        center: [f64; 3], [3], Constant, SetConst, "m", "centre of the model";
    } };
}

/// State, inputs and results of [`Fields`](crate::model::Fields).
#[macro_export]
macro_rules! data_fields {
    ($apply:ident) => { $apply! {
        time: f64, [], State, User, "s", "simulated time";
        qpos: Vec<f64>, [nq], State, User, "m or rad", "generalized coordinates: free joint x y z qw qx qy qz, ball qw qx qy qz, slide and hinge one number";
        qvel: Vec<f64>, [nv], State, User, "m/s or rad/s", "velocities: a free joint's rotation is in the body's frame";
        act: Vec<f64>, [na], State, User, "", "activations of actuators";
        history: Vec<f64>, [nhistory], State, User, "", "past controls of delayed actuators and past values of delayed sensors";
        qacc_warmstart: Vec<f64>, [nv], State, User, "m/s^2 or rad/s^2", "acceleration of the last step, where the solver starts";
        ctrl: Vec<f64>, [nu], Input, User, "", "controls";
        qfrc_applied: Vec<f64>, [nv], Input, User, "N or N m", "applied generalized force";
        xfrc_applied: Vec<f64>, [nbody, 6], Input, User, "N, N m", "force (3) then torque (3) applied at the centre of mass, world axes";
        mocap_pos: Vec<f64>, [nmocap, 3], Input, User, "m", "positions of mocap bodies";
        mocap_quat: Vec<f64>, [nmocap, 4], Input, User, "", "orientations of mocap bodies";
        eq_active: Vec<bool>, [neq], Input, User, "", "whether each equality constraint is active";
        userdata: Vec<f64>, [nuserdata], Input, User, "", "values of the user; the engine does not touch them";

        tree_asleep: Vec<i32>, [ntree], State, User, "", "-11 to -1 while the tree is awake, counting steps at rest; then the next of the trees that sleep with it";

        // Counts.
        ncon: usize, [], Derived, Collision, "", "number of detected contacts";
        nefc: usize, [], Derived, Constraint, "", "number of scalar constraints";
        ne: usize, [], Derived, Constraint, "", "number of scalar constraints of equalities";
        nf: usize, [], Derived, Constraint, "", "number of scalar constraints of dry friction";
        nl: usize, [], Derived, Constraint, "", "number of scalar constraints of limits";
        nisland: usize, [], Derived, Constraint, "", "number of independent sets of constraints";
        ntree_awake: usize, [], Derived, Sleep, "", "number of trees that are awake";
        nbody_awake: usize, [], Derived, Sleep, "", "number of bodies that do not sleep";
        nparent_awake: usize, [], Derived, Sleep, "", "number of bodies whose parents do not sleep";
        nv_awake: usize, [], Derived, Sleep, "", "number of degrees of freedom that are awake";
        solver_niter: usize, [], Derived, Solve, "", "solver iterations of the last step, summed over islands";

        // Sleep.
        tree_awake: Vec<i32>, [ntree], Derived, Sleep, "", "whether the tree is awake";
        body_awake: Vec<i32>, [nbody], Derived, Sleep, "", "-1 the body cannot move, 0 it sleeps, 1 it is awake";

        // Position.
        xpos: Vec<f64>, [nbody, 3], Derived, Kinematics, "m", "position of the body frame, world";
        xquat: Vec<f64>, [nbody, 4], Derived, Orientations, "", "orientation of the body frame, world";
        xmat: Vec<f64>, [nbody, 9], Derived, Kinematics, "", "the same as a rotation matrix";
        xipos: Vec<f64>, [nbody, 3], Derived, Kinematics, "m", "centre of mass, world";
        ximat: Vec<f64>, [nbody, 9], Derived, Kinematics, "", "orientation of the principal axes of inertia, world";
        xanchor: Vec<f64>, [njnt, 3], Derived, Kinematics, "m", "anchor of the joint, world";
        xaxis: Vec<f64>, [njnt, 3], Derived, Kinematics, "", "axis of the joint, world";
        geom_xpos: Vec<f64>, [ngeom, 3], Derived, GeomPoses, "m", "position of the geom, world";
        geom_xmat: Vec<f64>, [ngeom, 9], Derived, GeomPoses, "", "orientation of the geom, world";
        site_xpos: Vec<f64>, [nsite, 3], Derived, SitePoses, "m", "position of the site, world";
        site_xmat: Vec<f64>, [nsite, 9], Derived, SitePoses, "", "orientation of the site, world";
        cam_xpos: Vec<f64>, [ncam, 3], Derived, CameraPoses, "m", "position of the camera, world";
        cam_xmat: Vec<f64>, [ncam, 9], Derived, CameraPoses, "", "orientation of the camera, world";
        light_xpos: Vec<f64>, [nlight, 3], Derived, CameraPoses, "m", "position of the light, world";
        light_xdir: Vec<f64>, [nlight, 3], Derived, CameraPoses, "", "direction of the light, world";
        subtree_com: Vec<f64>, [nbody, 3], Derived, ComPos, "m", "centre of mass of the body and its descendants, world";
        cdof: Vec<f64>, [nv, 6], Derived, ComPos, "", "motion axis of the degree of freedom, about the tree's centre of mass";
        cinert: Vec<f64>, [nbody, 10], Derived, ComPos, "kg m^2, kg m, kg", "inertia about the tree's centre of mass: xx yy zz xy xz yz, m d, m";
        ten_length: Vec<f64>, [ntendon], Derived, Tendon, "m", "length of the tendon";
        ten_J: Vec<f64>, [nJten], Derived, Tendon, "", "Jacobian of the tendon's length";
        ten_wrapadr: Vec<i32>, [ntendon], Derived, Tendon, "", "first point of the tendon's path in wrap_xpos";
        ten_wrapnum: Vec<i32>, [ntendon], Derived, Tendon, "", "number of points of the path";
        wrap_obj: Vec<i32>, [nwrap, 2], Derived, Tendon, "", "what the point lies on: a geom, -1 a site, -2 a pulley";
        wrap_xpos: Vec<f64>, [nwrap, 6], Derived, Tendon, "m", "points of all paths, world";
        actuator_length: Vec<f64>, [nout], Derived, Transmission, "m or rad", "length of the actuator";
        moment_rownnz: Vec<i32>, [nout], Derived, Transmission, "", "number of non-zeros of the actuator's moment";
        moment_rowadr: Vec<i32>, [nout], Derived, Transmission, "", "their address";
        moment_colind: Vec<i32>, [nJmom], Derived, Transmission, "", "degree of freedom of each non-zero";
        actuator_moment: Vec<f64>, [nJmom], Derived, Transmission, "", "moment arms: derivative of the length with respect to each degree of freedom";
        crb: Vec<f64>, [nbody, 10], Derived, MassMatrix, "kg m^2, kg m, kg", "composite inertia of the subtree";
        M: Vec<f64>, [nC], Derived, MassMatrix, "kg m^2, kg m, kg", "mass matrix, lower triangle by rows";
        qLD: Vec<f64>, [nC], Derived, Factor, "", "factorization M = L' D L";
        qLDiagInv: Vec<f64>, [nv], Derived, Factor, "", "1/D";

        // Velocity.
        ten_velocity: Vec<f64>, [ntendon], Derived, TendonVel, "m/s", "velocity of the tendon";
        actuator_velocity: Vec<f64>, [nout], Derived, ActuatorVel, "m/s or rad/s", "velocity of the actuator";
        cvel: Vec<f64>, [nbody, 6], Derived, ComVel, "rad/s, m/s", "velocity of the body about the tree's centre of mass";
        cdof_dot: Vec<f64>, [nv, 6], Derived, ComVel, "", "time derivative of cdof";
        qfrc_spring: Vec<f64>, [nv], Derived, Passive, "N or N m", "force of springs";
        qfrc_damper: Vec<f64>, [nv], Derived, Passive, "N or N m", "force of dampers";
        qfrc_gravcomp: Vec<f64>, [nv], Derived, Passive, "N or N m", "force of gravity compensation";
        qfrc_fluid: Vec<f64>, [nv], Derived, Passive, "N or N m", "force of the medium";
        qfrc_adhesion: Vec<f64>, [nv], Derived, Passive, "N or N m", "force of adhesive contacts";
        qfrc_passive: Vec<f64>, [nv], Derived, Passive, "N or N m", "sum of passive forces";
        qfrc_bias: Vec<f64>, [nv], Derived, Bias, "N or N m", "gravity, Coriolis and centrifugal force (with the sign of M a + bias = force)";

        // Force and acceleration.
        actuator_force: Vec<f64>, [nout], Derived, Actuation, "N or N m", "force of the actuator";
        act_dot: Vec<f64>, [na], Derived, Actuation, "1/s", "time derivative of act";
        qfrc_actuator: Vec<f64>, [nv], Derived, Actuation, "N or N m", "force of the actuators";
        qfrc_smooth: Vec<f64>, [nv], Derived, Acceleration, "N or N m", "all forces but those of constraints";
        qacc_smooth: Vec<f64>, [nv], Derived, Acceleration, "m/s^2 or rad/s^2", "acceleration without constraints";
        qfrc_constraint: Vec<f64>, [nv], Derived, Solve, "N or N m", "force of constraints";
        qacc: Vec<f64>, [nv], Derived, Solve, "m/s^2 or rad/s^2", "acceleration";

        // Constraints: as many rows as there are now (`nefc`).
        efc_type: Vec<i32>, [nefc], Derived, Constraint, "", "type of the constraint (mjtConstraint)";
        efc_id: Vec<i32>, [nefc], Derived, Constraint, "", "the equality, degree of freedom, joint, tendon or contact of the row";
        efc_pos: Vec<f64>, [nefc], Derived, Constraint, "m or rad", "violation (negative when violated)";
        efc_margin: Vec<f64>, [nefc], Derived, Constraint, "m or rad", "violation at which the constraint starts to act";
        efc_frictionloss: Vec<f64>, [nefc], Derived, Constraint, "N or N m", "largest force of dry friction";
        efc_diagA: Vec<f64>, [nefc], Derived, Constraint, "1/kg", "approximate diagonal of J M^-1 J'";
        efc_KBIP: Vec<f64>, [nefc, 4], Derived, Constraint, "1/s^2, 1/s, 1, 1/m", "stiffness, damping, impedance and its derivative";
        efc_D: Vec<f64>, [nefc], Derived, Constraint, "kg", "1/R";
        efc_R: Vec<f64>, [nefc], Derived, Constraint, "1/kg", "regularization";
        efc_vel: Vec<f64>, [nefc], Derived, Reference, "m/s or rad/s", "velocity along the constraint, J v";
        efc_aref: Vec<f64>, [nefc], Derived, Reference, "m/s^2 or rad/s^2", "reference acceleration";
        efc_b: Vec<f64>, [nefc], Derived, Solve, "m/s^2 or rad/s^2", "difference between the acceleration without constraints and the reference";
        efc_force: Vec<f64>, [nefc], Derived, Solve, "N or N m", "force of the constraint";
        efc_state: Vec<i32>, [nefc], Derived, Solve, "", "0 satisfied, 1 quadratic, 2 and 3 dry friction at its largest, 4 sliding (mjtConstraintState)";

        // After the solver, computed when a sensor needs them or on request.
        subtree_linvel: Vec<f64>, [nbody, 3], Derived, SubtreeVel, "m/s", "velocity of the centre of mass of the body and its descendants, world";
        subtree_angmom: Vec<f64>, [nbody, 3], Derived, SubtreeVel, "kg m^2/s", "angular momentum of the body and its descendants about their centre of mass";
        cacc: Vec<f64>, [nbody, 6], Derived, RnePost, "rad/s^2, m/s^2", "acceleration of the body about the tree's centre of mass, against free fall";
        cfrc_int: Vec<f64>, [nbody, 6], Derived, RnePost, "N m, N", "torque and force from the parent, about the tree's centre of mass";
        cfrc_ext: Vec<f64>, [nbody, 6], Derived, RnePost, "N m, N", "torque and force from outside, about the tree's centre of mass";
        qfrc_inverse: Vec<f64>, [nv], Derived, Inverse, "N or N m", "force that causes qacc (inverse dynamics)";

        // Read-outs.
        sensordata: Vec<f64>, [nsensordata], Derived, Sensors, "", "sensor values";
        energy: [f64; 2], [2], Derived, Energy, "J", "potential, kinetic; computed when the energy flag is on";
    } };
}

pub use {data_fields, model_fields, option_fields, statistic_fields};
