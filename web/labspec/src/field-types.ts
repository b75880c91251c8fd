// Made by build.mjs from the table of fields of the engine.
import type { FieldView } from "./fields.js";

/** Fields of a model. */
export interface ModelFields {
  /** number of generalized coordinates */
  readonly nq: number;
  /** number of degrees of freedom */
  readonly nv: number;
  /** number of control inputs */
  readonly nu: number;
  /** number of actuators, each with one control by default */
  readonly nactuator: number;
  /** number of force outputs of all actuators */
  readonly nout: number;
  /** number of activation states */
  readonly na: number;
  /** number of bodies, the world included */
  readonly nbody: number;
  /** number of kinematic trees with at least one degree of freedom */
  readonly ntree: number;
  /** number of joints */
  readonly njnt: number;
  /** number of geoms */
  readonly ngeom: number;
  /** number of sites */
  readonly nsite: number;
  /** number of cameras */
  readonly ncam: number;
  /** number of lights */
  readonly nlight: number;
  /** number of meshes */
  readonly nmesh: number;
  /** number of vertices of all meshes */
  readonly nmeshvert: number;
  /** number of normals of all meshes */
  readonly nmeshnormal: number;
  /** number of texture coordinates of all meshes */
  readonly nmeshtexcoord: number;
  /** number of triangles of all meshes */
  readonly nmeshface: number;
  /** number of integers of all convex hulls */
  readonly nmeshgraph: number;
  /** number of skins */
  readonly nskin: number;
  /** number of vertices of all skins */
  readonly nskinvert: number;
  /** number of texture coordinates of all skins */
  readonly nskintexvert: number;
  /** number of triangles of all skins */
  readonly nskinface: number;
  /** number of bones of all skins */
  readonly nskinbone: number;
  /** number of vertices of all bones */
  readonly nskinbonevert: number;
  /** number of height fields */
  readonly nhfield: number;
  /** number of samples of all height fields */
  readonly nhfielddata: number;
  /** number of textures */
  readonly ntex: number;
  /** number of materials */
  readonly nmat: number;
  /** number of explicit contact pairs */
  readonly npair: number;
  /** number of excluded body pairs */
  readonly nexclude: number;
  /** number of equality constraints */
  readonly neq: number;
  /** number of tendons */
  readonly ntendon: number;
  /** number of objects on the paths of all tendons */
  readonly nwrap: number;
  /** number of non-zeros of the Jacobian of all tendons */
  readonly nJten: number;
  /** number of non-zeros of the moments of all actuators */
  readonly nJmom: number;
  /** number of sensors */
  readonly nsensor: number;
  /** number of sensor values */
  readonly nsensordata: number;
  /** number of custom lists of numbers */
  readonly nnumeric: number;
  /** number of numbers of all custom lists */
  readonly nnumericdata: number;
  /** number of custom texts */
  readonly ntext: number;
  /** number of custom tuples */
  readonly ntuple: number;
  /** number of elements of all custom tuples */
  readonly ntupledata: number;
  /** number of keyframes */
  readonly nkey: number;
  /** number of mocap bodies */
  readonly nmocap: number;
  /** number of values reserved for the user */
  readonly nuserdata: number;
  /** number of values in the history of delayed actuators and sensors */
  readonly nhistory: number;
  /** number of user values of each body */
  readonly nuser_body: number;
  /** number of user values of each joint */
  readonly nuser_jnt: number;
  /** number of user values of each geom */
  readonly nuser_geom: number;
  /** number of user values of each site */
  readonly nuser_site: number;
  /** number of user values of each camera */
  readonly nuser_cam: number;
  /** number of user values of each tendon */
  readonly nuser_tendon: number;
  /** number of user values of each actuator */
  readonly nuser_actuator: number;
  /** number of user values of each sensor */
  readonly nuser_sensor: number;
  /** number of non-zeros of the lower triangle of the mass matrix */
  readonly nC: number;
  /** number of non-zeros of the whole mass matrix */
  readonly nD: number;
  /** number of bodies with gravity compensation */
  readonly ngravcomp: number;
  /** coordinates of the default configuration, m or rad [nq] */
  get qpos0(): FieldView<Float64Array>;
  set qpos0(values: FieldView<Float64Array> | readonly number[]);
  /** coordinates at which joint springs are relaxed, m or rad [nq] */
  get qpos_spring(): FieldView<Float64Array>;
  set qpos_spring(values: FieldView<Float64Array> | readonly number[]);
  /** parent body [nbody] */
  readonly body_parentid: FieldView<Int32Array>;
  /** ancestor that is a child of the world [nbody] */
  readonly body_rootid: FieldView<Int32Array>;
  /** body that this body is welded to [nbody] */
  readonly body_weldid: FieldView<Int32Array>;
  /** index of the mocap pose, -1 if none [nbody] */
  readonly body_mocapid: FieldView<Int32Array>;
  /** number of joints of the body [nbody] */
  readonly body_jntnum: FieldView<Int32Array>;
  /** first joint of the body, -1 if none [nbody] */
  readonly body_jntadr: FieldView<Int32Array>;
  /** number of degrees of freedom of the body [nbody] */
  readonly body_dofnum: FieldView<Int32Array>;
  /** first degree of freedom of the body, -1 if none [nbody] */
  readonly body_dofadr: FieldView<Int32Array>;
  /** kinematic tree of the body, -1 if it cannot move [nbody] */
  readonly body_treeid: FieldView<Int32Array>;
  /** number of geoms of the body [nbody] */
  readonly body_geomnum: FieldView<Int32Array>;
  /** first geom of the body, -1 if none [nbody] */
  readonly body_geomadr: FieldView<Int32Array>;
  /** 1: diagonal mass matrix, 2: the same with slide joints only, 0: general [nbody] */
  readonly body_simple: FieldView<Int32Array>;
  /** inertial frame against body frame: 0 different, 1 the same, 3 the same orientation [nbody] */
  readonly body_sameframe: FieldView<Int32Array>;
  /** position in the parent's frame, m [nbody, 3] */
  get body_pos(): FieldView<Float64Array>;
  set body_pos(values: FieldView<Float64Array> | readonly number[]);
  /** orientation in the parent's frame [nbody, 4] */
  get body_quat(): FieldView<Float64Array>;
  set body_quat(values: FieldView<Float64Array> | readonly number[]);
  /** centre of mass in the body's frame, m [nbody, 3] */
  get body_ipos(): FieldView<Float64Array>;
  set body_ipos(values: FieldView<Float64Array> | readonly number[]);
  /** orientation of the principal axes of inertia in the body's frame [nbody, 4] */
  get body_iquat(): FieldView<Float64Array>;
  set body_iquat(values: FieldView<Float64Array> | readonly number[]);
  /** mass, kg [nbody] */
  get body_mass(): FieldView<Float64Array>;
  set body_mass(values: FieldView<Float64Array> | readonly number[]);
  /** mass of the body and all its descendants, kg [nbody] */
  readonly body_subtreemass: FieldView<Float64Array>;
  /** principal moments of inertia, kg m^2 [nbody, 3] */
  get body_inertia(): FieldView<Float64Array>;
  set body_inertia(values: FieldView<Float64Array> | readonly number[]);
  /** mean inverse inertia at qpos0: translation, rotation, 1/kg, 1/(kg m^2) [nbody, 2] */
  readonly body_invweight0: FieldView<Float64Array>;
  /** upward force against gravity, in weights of the body [nbody] */
  get body_gravcomp(): FieldView<Float64Array>;
  set body_gravcomp(values: FieldView<Float64Array> | readonly number[]);
  /** largest margin plus gap of the body's geoms, m [nbody] */
  readonly body_margin: FieldView<Float64Array>;
  /** contact types of all geoms of the body when it was compiled [nbody] */
  get body_contype(): FieldView<Int32Array>;
  set body_contype(values: FieldView<Int32Array> | readonly number[]);
  /** contact affinities of all geoms of the body when it was compiled [nbody] */
  get body_conaffinity(): FieldView<Int32Array>;
  set body_conaffinity(values: FieldView<Int32Array> | readonly number[]);
  /** user values [nbody, nuser_body] */
  get body_user(): FieldView<Float64Array>;
  set body_user(values: FieldView<Float64Array> | readonly number[]);
  /** 0 free, 1 ball, 2 slide, 3 hinge [njnt] */
  readonly jnt_type: FieldView<Int32Array>;
  /** first coordinate of the joint in qpos [njnt] */
  readonly jnt_qposadr: FieldView<Int32Array>;
  /** first degree of freedom of the joint in qvel [njnt] */
  readonly jnt_dofadr: FieldView<Int32Array>;
  /** body of the joint [njnt] */
  readonly jnt_bodyid: FieldView<Int32Array>;
  /** actuator that adds damping or armature to the joint, -1 if none [njnt] */
  readonly jnt_actuatorid: FieldView<Int32Array>;
  /** group, for visibility [njnt] */
  get jnt_group(): FieldView<Int32Array>;
  set jnt_group(values: FieldView<Int32Array> | readonly number[]);
  /** whether the joint has limits [njnt] */
  get jnt_limited(): FieldView<Uint8Array>;
  set jnt_limited(values: FieldView<Uint8Array> | readonly number[]);
  /** whether the total actuator force on the joint is limited [njnt] */
  get jnt_actfrclimited(): FieldView<Uint8Array>;
  set jnt_actfrclimited(values: FieldView<Uint8Array> | readonly number[]);
  /** whether gravity compensation acts as a force of actuators [njnt] */
  get jnt_actgravcomp(): FieldView<Uint8Array>;
  set jnt_actgravcomp(values: FieldView<Uint8Array> | readonly number[]);
  /** limit constraint: time constant and damping ratio (or -stiffness, -damping), s, 1 [njnt, 2] */
  get jnt_solref(): FieldView<Float64Array>;
  set jnt_solref(values: FieldView<Float64Array> | readonly number[]);
  /** limit constraint: impedance [njnt, 5] */
  get jnt_solimp(): FieldView<Float64Array>;
  set jnt_solimp(values: FieldView<Float64Array> | readonly number[]);
  /** anchor in the body's frame, m [njnt, 3] */
  get jnt_pos(): FieldView<Float64Array>;
  set jnt_pos(values: FieldView<Float64Array> | readonly number[]);
  /** axis in the body's frame [njnt, 3] */
  get jnt_axis(): FieldView<Float64Array>;
  set jnt_axis(values: FieldView<Float64Array> | readonly number[]);
  /** stiffness of the joint spring, N/m or N m/rad [njnt] */
  get jnt_stiffness(): FieldView<Float64Array>;
  set jnt_stiffness(values: FieldView<Float64Array> | readonly number[]);
  /** growth of the stiffness with displacement: linear, quadratic [njnt, 2] */
  get jnt_stiffnesspoly(): FieldView<Float64Array>;
  set jnt_stiffnesspoly(values: FieldView<Float64Array> | readonly number[]);
  /** lower and upper limit, m or rad [njnt, 2] */
  get jnt_range(): FieldView<Float64Array>;
  set jnt_range(values: FieldView<Float64Array> | readonly number[]);
  /** range of the total actuator force, N or N m [njnt, 2] */
  get jnt_actfrcrange(): FieldView<Float64Array>;
  set jnt_actfrcrange(values: FieldView<Float64Array> | readonly number[]);
  /** distance from the limit at which it becomes active, m or rad [njnt] */
  get jnt_margin(): FieldView<Float64Array>;
  set jnt_margin(values: FieldView<Float64Array> | readonly number[]);
  /** user values [njnt, nuser_jnt] */
  get jnt_user(): FieldView<Float64Array>;
  set jnt_user(values: FieldView<Float64Array> | readonly number[]);
  /** body of the degree of freedom [nv] */
  readonly dof_bodyid: FieldView<Int32Array>;
  /** joint of the degree of freedom [nv] */
  readonly dof_jntid: FieldView<Int32Array>;
  /** previous degree of freedom on the way to the root, -1 if none [nv] */
  readonly dof_parentid: FieldView<Int32Array>;
  /** kinematic tree of the degree of freedom [nv] */
  readonly dof_treeid: FieldView<Int32Array>;
  /** number of consecutive simple degrees of freedom from here [nv] */
  readonly dof_simplenum: FieldView<Int32Array>;
  /** friction loss: time constant and damping ratio (or -stiffness, -damping), s, 1 [nv, 2] */
  get dof_solref(): FieldView<Float64Array>;
  set dof_solref(values: FieldView<Float64Array> | readonly number[]);
  /** friction loss: impedance [nv, 5] */
  get dof_solimp(): FieldView<Float64Array>;
  set dof_solimp(values: FieldView<Float64Array> | readonly number[]);
  /** dry friction, N or N m [nv] */
  get dof_frictionloss(): FieldView<Float64Array>;
  set dof_frictionloss(values: FieldView<Float64Array> | readonly number[]);
  /** inertia added to the diagonal of the mass matrix, kg or kg m^2 [nv] */
  get dof_armature(): FieldView<Float64Array>;
  set dof_armature(values: FieldView<Float64Array> | readonly number[]);
  /** linear damping, N s/m or N m s/rad [nv] */
  get dof_damping(): FieldView<Float64Array>;
  set dof_damping(values: FieldView<Float64Array> | readonly number[]);
  /** growth of the damping with speed: linear, quadratic [nv, 2] */
  get dof_dampingpoly(): FieldView<Float64Array>;
  set dof_dampingpoly(values: FieldView<Float64Array> | readonly number[]);
  /** diagonal of the inverse inertia at qpos0, 1/kg or 1/(kg m^2) [nv] */
  readonly dof_invweight0: FieldView<Float64Array>;
  /** diagonal of the mass matrix at qpos0, kg or kg m^2 [nv] */
  readonly dof_M0: FieldView<Float64Array>;
  /** length that turns a velocity into that of a point: 1 for translations, 1 or m [nv] */
  readonly dof_length: FieldView<Float64Array>;
  /** first body of the tree [ntree] */
  readonly tree_bodyadr: FieldView<Int32Array>;
  /** number of bodies of the tree [ntree] */
  readonly tree_bodynum: FieldView<Int32Array>;
  /** first degree of freedom of the tree [ntree] */
  readonly tree_dofadr: FieldView<Int32Array>;
  /** number of degrees of freedom of the tree [ntree] */
  readonly tree_dofnum: FieldView<Int32Array>;
  /** whether the tree may sleep (mjtSleepPolicy) [ntree] */
  get tree_sleep_policy(): FieldView<Int32Array>;
  set tree_sleep_policy(values: FieldView<Int32Array> | readonly number[]);
  /** number of non-zeros of each row of the mass matrix [nv] */
  readonly M_rownnz: FieldView<Int32Array>;
  /** address of each row of the mass matrix [nv] */
  readonly M_rowadr: FieldView<Int32Array>;
  /** column of each non-zero of the mass matrix [nC] */
  readonly M_colind: FieldView<Int32Array>;
  /** number of non-zeros of each row, both triangles [nv] */
  readonly D_rownnz: FieldView<Int32Array>;
  /** address of each row, both triangles [nv] */
  readonly D_rowadr: FieldView<Int32Array>;
  /** place of the diagonal in each row [nv] */
  readonly D_diag: FieldView<Int32Array>;
  /** column of each non-zero, both triangles [nD] */
  readonly D_colind: FieldView<Int32Array>;
  /** 0 plane, 1 height field, 2 sphere, 3 capsule, 4 ellipsoid, 5 cylinder, 6 box, 7 mesh [ngeom] */
  readonly geom_type: FieldView<Int32Array>;
  /** bits of the contact types the geom is [ngeom] */
  get geom_contype(): FieldView<Int32Array>;
  set geom_contype(values: FieldView<Int32Array> | readonly number[]);
  /** bits of the contact types the geom accepts [ngeom] */
  get geom_conaffinity(): FieldView<Int32Array>;
  set geom_conaffinity(values: FieldView<Int32Array> | readonly number[]);
  /** dimension of the contact: 1 frictionless, 3 sliding, 4 and spinning, 6 and rolling friction [ngeom] */
  get geom_condim(): FieldView<Int32Array>;
  set geom_condim(values: FieldView<Int32Array> | readonly number[]);
  /** body of the geom [ngeom] */
  readonly geom_bodyid: FieldView<Int32Array>;
  /** mesh or height field of the geom, -1 if none [ngeom] */
  readonly geom_dataid: FieldView<Int32Array>;
  /** material, -1 if none [ngeom] */
  get geom_matid(): FieldView<Int32Array>;
  set geom_matid(values: FieldView<Int32Array> | readonly number[]);
  /** group, for visibility and inertia [ngeom] */
  get geom_group(): FieldView<Int32Array>;
  set geom_group(values: FieldView<Int32Array> | readonly number[]);
  /** the geom of higher priority decides the contact's parameters [ngeom] */
  get geom_priority(): FieldView<Int32Array>;
  set geom_priority(values: FieldView<Int32Array> | readonly number[]);
  /** geom frame: 0 its own, 1 the body's, 2 the inertial frame, 3 and 4 the same orientation [ngeom] */
  readonly geom_sameframe: FieldView<Int32Array>;
  /** weight in the mix of solref and solimp [ngeom] */
  get geom_solmix(): FieldView<Float64Array>;
  set geom_solmix(values: FieldView<Float64Array> | readonly number[]);
  /** contact: time constant and damping ratio (or -stiffness, -damping), s, 1 [ngeom, 2] */
  get geom_solref(): FieldView<Float64Array>;
  set geom_solref(values: FieldView<Float64Array> | readonly number[]);
  /** contact: impedance (d0, dwidth, width, midpoint, power) [ngeom, 5] */
  get geom_solimp(): FieldView<Float64Array>;
  set geom_solimp(values: FieldView<Float64Array> | readonly number[]);
  /** size: radius, or radius and half length, or three half lengths, m [ngeom, 3] */
  get geom_size(): FieldView<Float64Array>;
  set geom_size(values: FieldView<Float64Array> | readonly number[]);
  /** bounding box in the geom's frame: centre, half lengths, m [ngeom, 6] */
  get geom_aabb(): FieldView<Float64Array>;
  set geom_aabb(values: FieldView<Float64Array> | readonly number[]);
  /** radius of the bounding sphere, 0 for a plane, m [ngeom] */
  get geom_rbound(): FieldView<Float64Array>;
  set geom_rbound(values: FieldView<Float64Array> | readonly number[]);
  /** position in the body's frame, m [ngeom, 3] */
  get geom_pos(): FieldView<Float64Array>;
  set geom_pos(values: FieldView<Float64Array> | readonly number[]);
  /** orientation in the body's frame [ngeom, 4] */
  get geom_quat(): FieldView<Float64Array>;
  set geom_quat(values: FieldView<Float64Array> | readonly number[]);
  /** friction: sliding, spinning, rolling, 1, m, m [ngeom, 3] */
  get geom_friction(): FieldView<Float64Array>;
  set geom_friction(values: FieldView<Float64Array> | readonly number[]);
  /** distance at which a contact starts to push, m [ngeom] */
  get geom_margin(): FieldView<Float64Array>;
  set geom_margin(values: FieldView<Float64Array> | readonly number[]);
  /** further distance at which a contact is detected without pushing, m [ngeom] */
  get geom_gap(): FieldView<Float64Array>;
  set geom_gap(values: FieldView<Float64Array> | readonly number[]);
  /** velocity of the surface in the geom's frame: linear, angular, m/s, rad/s [ngeom, 6] */
  get geom_surfacevel(): FieldView<Float64Array>;
  set geom_surfacevel(values: FieldView<Float64Array> | readonly number[]);
  /** force with which contacts of the geom pull, N [ngeom] */
  get geom_adhesion(): FieldView<Float64Array>;
  set geom_adhesion(values: FieldView<Float64Array> | readonly number[]);
  /** fluid forces on an ellipsoid: switch, five coefficients, added mass, added inertia [ngeom, 12] */
  get geom_fluid(): FieldView<Float64Array>;
  set geom_fluid(values: FieldView<Float64Array> | readonly number[]);
  /** user values [ngeom, nuser_geom] */
  get geom_user(): FieldView<Float64Array>;
  set geom_user(values: FieldView<Float64Array> | readonly number[]);
  /** colour and opacity [ngeom, 4] */
  get geom_rgba(): FieldView<Float64Array>;
  set geom_rgba(values: FieldView<Float64Array> | readonly number[]);
  /** shape, as geom_type [nsite] */
  readonly site_type: FieldView<Int32Array>;
  /** body of the site [nsite] */
  readonly site_bodyid: FieldView<Int32Array>;
  /** mesh of the site, -1 if none [nsite] */
  readonly site_dataid: FieldView<Int32Array>;
  /** material, -1 if none [nsite] */
  get site_matid(): FieldView<Int32Array>;
  set site_matid(values: FieldView<Int32Array> | readonly number[]);
  /** group, for visibility [nsite] */
  get site_group(): FieldView<Int32Array>;
  set site_group(values: FieldView<Int32Array> | readonly number[]);
  /** site frame, as geom_sameframe [nsite] */
  readonly site_sameframe: FieldView<Int32Array>;
  /** size of the volume of touch sensors, and for drawing, m [nsite, 3] */
  get site_size(): FieldView<Float64Array>;
  set site_size(values: FieldView<Float64Array> | readonly number[]);
  /** position in the body's frame, m [nsite, 3] */
  get site_pos(): FieldView<Float64Array>;
  set site_pos(values: FieldView<Float64Array> | readonly number[]);
  /** orientation in the body's frame [nsite, 4] */
  get site_quat(): FieldView<Float64Array>;
  set site_quat(values: FieldView<Float64Array> | readonly number[]);
  /** user values [nsite, nuser_site] */
  get site_user(): FieldView<Float64Array>;
  set site_user(values: FieldView<Float64Array> | readonly number[]);
  /** colour and opacity [nsite, 4] */
  get site_rgba(): FieldView<Float64Array>;
  set site_rgba(values: FieldView<Float64Array> | readonly number[]);
  /** 0 fixed, 1 track, 2 trackcom, 3 targetbody, 4 targetbodycom [ncam] */
  readonly cam_mode: FieldView<Int32Array>;
  /** body of the camera [ncam] */
  readonly cam_bodyid: FieldView<Int32Array>;
  /** body that the camera looks at, -1 if none [ncam] */
  readonly cam_targetbodyid: FieldView<Int32Array>;
  /** position in the body's frame, m [ncam, 3] */
  get cam_pos(): FieldView<Float64Array>;
  set cam_pos(values: FieldView<Float64Array> | readonly number[]);
  /** orientation in the body's frame; the camera looks along -z [ncam, 4] */
  get cam_quat(): FieldView<Float64Array>;
  set cam_quat(values: FieldView<Float64Array> | readonly number[]);
  /** position relative to the subtree's centre of mass at qpos0, world axes, m [ncam, 3] */
  readonly cam_poscom0: FieldView<Float64Array>;
  /** position relative to the body at qpos0, world axes, m [ncam, 3] */
  readonly cam_pos0: FieldView<Float64Array>;
  /** orientation at qpos0, world [ncam, 9] */
  readonly cam_mat0: FieldView<Float64Array>;
  /** 0 perspective, 1 orthographic [ncam] */
  get cam_projection(): FieldView<Int32Array>;
  set cam_projection(values: FieldView<Int32Array> | readonly number[]);
  /** vertical field of view, degree or m [ncam] */
  get cam_fovy(): FieldView<Float64Array>;
  set cam_fovy(values: FieldView<Float64Array> | readonly number[]);
  /** distance between the eyes, m [ncam] */
  get cam_ipd(): FieldView<Float64Array>;
  set cam_ipd(values: FieldView<Float64Array> | readonly number[]);
  /** width and height of the image, pixel [ncam, 2] */
  get cam_resolution(): FieldView<Int32Array>;
  set cam_resolution(values: FieldView<Int32Array> | readonly number[]);
  /** bits of the images it makes [ncam] */
  get cam_output(): FieldView<Int32Array>;
  set cam_output(values: FieldView<Int32Array> | readonly number[]);
  /** width and height of the sensor, 0 when fovy decides, m [ncam, 2] */
  get cam_sensorsize(): FieldView<Float64Array>;
  set cam_sensorsize(values: FieldView<Float64Array> | readonly number[]);
  /** focal length, principal point, m [ncam, 4] */
  get cam_intrinsic(): FieldView<Float64Array>;
  set cam_intrinsic(values: FieldView<Float64Array> | readonly number[]);
  /** user values [ncam, nuser_cam] */
  get cam_user(): FieldView<Float64Array>;
  set cam_user(values: FieldView<Float64Array> | readonly number[]);
  /** as cam_mode [nlight] */
  readonly light_mode: FieldView<Int32Array>;
  /** body of the light [nlight] */
  readonly light_bodyid: FieldView<Int32Array>;
  /** body that the light points at, -1 if none [nlight] */
  readonly light_targetbodyid: FieldView<Int32Array>;
  /** 0 spot, 1 directional, 2 point, 3 image [nlight] */
  get light_type(): FieldView<Int32Array>;
  set light_type(values: FieldView<Int32Array> | readonly number[]);
  /** texture of an image light, -1 if none [nlight] */
  get light_texid(): FieldView<Int32Array>;
  set light_texid(values: FieldView<Int32Array> | readonly number[]);
  /** whether it casts shadows [nlight] */
  get light_castshadow(): FieldView<Uint8Array>;
  set light_castshadow(values: FieldView<Uint8Array> | readonly number[]);
  /** whether it is on [nlight] */
  get light_active(): FieldView<Uint8Array>;
  set light_active(values: FieldView<Uint8Array> | readonly number[]);
  /** radius, for soft shadows, m [nlight] */
  get light_bulbradius(): FieldView<Float64Array>;
  set light_bulbradius(values: FieldView<Float64Array> | readonly number[]);
  /** intensity, cd [nlight] */
  get light_intensity(): FieldView<Float64Array>;
  set light_intensity(values: FieldView<Float64Array> | readonly number[]);
  /** range, m [nlight] */
  get light_range(): FieldView<Float64Array>;
  set light_range(values: FieldView<Float64Array> | readonly number[]);
  /** position in the body's frame, m [nlight, 3] */
  get light_pos(): FieldView<Float64Array>;
  set light_pos(values: FieldView<Float64Array> | readonly number[]);
  /** direction in the body's frame [nlight, 3] */
  get light_dir(): FieldView<Float64Array>;
  set light_dir(values: FieldView<Float64Array> | readonly number[]);
  /** position relative to the subtree's centre of mass at qpos0, world axes, m [nlight, 3] */
  readonly light_poscom0: FieldView<Float64Array>;
  /** position relative to the body at qpos0, world axes, m [nlight, 3] */
  readonly light_pos0: FieldView<Float64Array>;
  /** direction at qpos0, world [nlight, 3] */
  readonly light_dir0: FieldView<Float64Array>;
  /** attenuation: constant, linear, quadratic [nlight, 3] */
  get light_attenuation(): FieldView<Float64Array>;
  set light_attenuation(values: FieldView<Float64Array> | readonly number[]);
  /** half angle of a spot light, degree [nlight] */
  get light_cutoff(): FieldView<Float64Array>;
  set light_cutoff(values: FieldView<Float64Array> | readonly number[]);
  /** softness of a spot light's edge [nlight] */
  get light_softness(): FieldView<Float64Array>;
  set light_softness(values: FieldView<Float64Array> | readonly number[]);
  /** how fast a spot light fades to its edge [nlight] */
  get light_exponent(): FieldView<Float64Array>;
  set light_exponent(values: FieldView<Float64Array> | readonly number[]);
  /** ambient colour [nlight, 3] */
  get light_ambient(): FieldView<Float64Array>;
  set light_ambient(values: FieldView<Float64Array> | readonly number[]);
  /** diffuse colour [nlight, 3] */
  get light_diffuse(): FieldView<Float64Array>;
  set light_diffuse(values: FieldView<Float64Array> | readonly number[]);
  /** specular colour [nlight, 3] */
  get light_specular(): FieldView<Float64Array>;
  set light_specular(values: FieldView<Float64Array> | readonly number[]);
  /** first vertex [nmesh] */
  readonly mesh_vertadr: FieldView<Int32Array>;
  /** number of vertices [nmesh] */
  readonly mesh_vertnum: FieldView<Int32Array>;
  /** first triangle [nmesh] */
  readonly mesh_faceadr: FieldView<Int32Array>;
  /** number of triangles [nmesh] */
  readonly mesh_facenum: FieldView<Int32Array>;
  /** first normal [nmesh] */
  readonly mesh_normaladr: FieldView<Int32Array>;
  /** number of normals [nmesh] */
  readonly mesh_normalnum: FieldView<Int32Array>;
  /** first texture coordinate, -1 if none [nmesh] */
  readonly mesh_texcoordadr: FieldView<Int32Array>;
  /** number of texture coordinates [nmesh] */
  readonly mesh_texcoordnum: FieldView<Int32Array>;
  /** address of the convex hull in mesh_graph, -1 if none [nmesh] */
  readonly mesh_graphadr: FieldView<Int32Array>;
  /** vertices, m [nmeshvert, 3] */
  get mesh_vert(): FieldView<Float64Array>;
  set mesh_vert(values: FieldView<Float64Array> | readonly number[]);
  /** normals [nmeshnormal, 3] */
  get mesh_normal(): FieldView<Float64Array>;
  set mesh_normal(values: FieldView<Float64Array> | readonly number[]);
  /** texture coordinates [nmeshtexcoord, 2] */
  get mesh_texcoord(): FieldView<Float64Array>;
  set mesh_texcoord(values: FieldView<Float64Array> | readonly number[]);
  /** vertices of each triangle [nmeshface, 3] */
  readonly mesh_face: FieldView<Int32Array>;
  /** normals of each triangle's corners [nmeshface, 3] */
  readonly mesh_facenormal: FieldView<Int32Array>;
  /** texture coordinates of each triangle's corners [nmeshface, 3] */
  readonly mesh_facetexcoord: FieldView<Int32Array>;
  /** convex hulls: numbers of vertices and faces, address and id of each vertex, neighbours (each list ends with -1), faces [nmeshgraph] */
  readonly mesh_graph: FieldView<Int32Array>;
  /** scale applied to the asset [nmesh, 3] */
  get mesh_scale(): FieldView<Float64Array>;
  set mesh_scale(values: FieldView<Float64Array> | readonly number[]);
  /** translation applied to the asset, m [nmesh, 3] */
  get mesh_pos(): FieldView<Float64Array>;
  set mesh_pos(values: FieldView<Float64Array> | readonly number[]);
  /** rotation applied to the asset [nmesh, 4] */
  get mesh_quat(): FieldView<Float64Array>;
  set mesh_quat(values: FieldView<Float64Array> | readonly number[]);
  /** material, -1 if none [nskin] */
  get skin_matid(): FieldView<Int32Array>;
  set skin_matid(values: FieldView<Int32Array> | readonly number[]);
  /** group, for visibility [nskin] */
  get skin_group(): FieldView<Int32Array>;
  set skin_group(values: FieldView<Int32Array> | readonly number[]);
  /** colour and opacity when there is no material [nskin, 4] */
  get skin_rgba(): FieldView<Float64Array>;
  set skin_rgba(values: FieldView<Float64Array> | readonly number[]);
  /** how far vertices are moved along their normals, m [nskin] */
  get skin_inflate(): FieldView<Float64Array>;
  set skin_inflate(values: FieldView<Float64Array> | readonly number[]);
  /** first vertex [nskin] */
  readonly skin_vertadr: FieldView<Int32Array>;
  /** number of vertices [nskin] */
  readonly skin_vertnum: FieldView<Int32Array>;
  /** first texture coordinate, -1 if none [nskin] */
  readonly skin_texcoordadr: FieldView<Int32Array>;
  /** first triangle [nskin] */
  readonly skin_faceadr: FieldView<Int32Array>;
  /** number of triangles [nskin] */
  readonly skin_facenum: FieldView<Int32Array>;
  /** first bone [nskin] */
  readonly skin_boneadr: FieldView<Int32Array>;
  /** number of bones [nskin] */
  readonly skin_bonenum: FieldView<Int32Array>;
  /** vertices, in the pose in which the bones are bound, m [nskinvert, 3] */
  get skin_vert(): FieldView<Float64Array>;
  set skin_vert(values: FieldView<Float64Array> | readonly number[]);
  /** texture coordinates [nskintexvert, 2] */
  get skin_texcoord(): FieldView<Float64Array>;
  set skin_texcoord(values: FieldView<Float64Array> | readonly number[]);
  /** vertices of each triangle, counted from the skin's first [nskinface, 3] */
  readonly skin_face: FieldView<Int32Array>;
  /** first vertex of the bone [nskinbone] */
  readonly skin_bonevertadr: FieldView<Int32Array>;
  /** number of vertices of the bone [nskinbone] */
  readonly skin_bonevertnum: FieldView<Int32Array>;
  /** position of the body when it was bound, world, m [nskinbone, 3] */
  get skin_bonebindpos(): FieldView<Float64Array>;
  set skin_bonebindpos(values: FieldView<Float64Array> | readonly number[]);
  /** orientation of the body when it was bound, world [nskinbone, 4] */
  get skin_bonebindquat(): FieldView<Float64Array>;
  set skin_bonebindquat(values: FieldView<Float64Array> | readonly number[]);
  /** body that is the bone [nskinbone] */
  readonly skin_bonebodyid: FieldView<Int32Array>;
  /** vertex, counted from the skin's first [nskinbonevert] */
  readonly skin_bonevertid: FieldView<Int32Array>;
  /** the bone's share of the vertex [nskinbonevert] */
  get skin_bonevertweight(): FieldView<Float64Array>;
  set skin_bonevertweight(values: FieldView<Float64Array> | readonly number[]);
  /** half lengths in x and y, height of the top, depth of the base, m [nhfield, 4] */
  get hfield_size(): FieldView<Float64Array>;
  set hfield_size(values: FieldView<Float64Array> | readonly number[]);
  /** number of rows (y) [nhfield] */
  readonly hfield_nrow: FieldView<Int32Array>;
  /** number of columns (x) [nhfield] */
  readonly hfield_ncol: FieldView<Int32Array>;
  /** first sample [nhfield] */
  readonly hfield_adr: FieldView<Int32Array>;
  /** elevation, from 0 to 1 [nhfielddata] */
  get hfield_data(): FieldView<Float64Array>;
  set hfield_data(values: FieldView<Float64Array> | readonly number[]);
  /** textures by role, -1 if none [nmat, 10] */
  get mat_texid(): FieldView<Int32Array>;
  set mat_texid(values: FieldView<Int32Array> | readonly number[]);
  /** whether the texture keeps its scale [nmat] */
  get mat_texuniform(): FieldView<Uint8Array>;
  set mat_texuniform(values: FieldView<Uint8Array> | readonly number[]);
  /** repetition of the texture [nmat, 2] */
  get mat_texrepeat(): FieldView<Float64Array>;
  set mat_texrepeat(values: FieldView<Float64Array> | readonly number[]);
  /** emission [nmat] */
  get mat_emission(): FieldView<Float64Array>;
  set mat_emission(values: FieldView<Float64Array> | readonly number[]);
  /** specular reflection [nmat] */
  get mat_specular(): FieldView<Float64Array>;
  set mat_specular(values: FieldView<Float64Array> | readonly number[]);
  /** shininess [nmat] */
  get mat_shininess(): FieldView<Float64Array>;
  set mat_shininess(values: FieldView<Float64Array> | readonly number[]);
  /** mirror reflection [nmat] */
  get mat_reflectance(): FieldView<Float64Array>;
  set mat_reflectance(values: FieldView<Float64Array> | readonly number[]);
  /** metallic [nmat] */
  get mat_metallic(): FieldView<Float64Array>;
  set mat_metallic(values: FieldView<Float64Array> | readonly number[]);
  /** roughness [nmat] */
  get mat_roughness(): FieldView<Float64Array>;
  set mat_roughness(values: FieldView<Float64Array> | readonly number[]);
  /** colour and opacity [nmat, 4] */
  get mat_rgba(): FieldView<Float64Array>;
  set mat_rgba(values: FieldView<Float64Array> | readonly number[]);
  /** dimension of the contact [npair] */
  get pair_dim(): FieldView<Int32Array>;
  set pair_dim(values: FieldView<Int32Array> | readonly number[]);
  /** first geom [npair] */
  readonly pair_geom1: FieldView<Int32Array>;
  /** second geom [npair] */
  readonly pair_geom2: FieldView<Int32Array>;
  /** first body times 65536 plus second body [npair] */
  readonly pair_signature: FieldView<Int32Array>;
  /** normal direction: time constant and damping ratio (or -stiffness, -damping), s, 1 [npair, 2] */
  get pair_solref(): FieldView<Float64Array>;
  set pair_solref(values: FieldView<Float64Array> | readonly number[]);
  /** the same for friction; 0 0 as the normal direction, s, 1 [npair, 2] */
  get pair_solreffriction(): FieldView<Float64Array>;
  set pair_solreffriction(values: FieldView<Float64Array> | readonly number[]);
  /** impedance [npair, 5] */
  get pair_solimp(): FieldView<Float64Array>;
  set pair_solimp(values: FieldView<Float64Array> | readonly number[]);
  /** distance at which the contact starts to push, m [npair] */
  get pair_margin(): FieldView<Float64Array>;
  set pair_margin(values: FieldView<Float64Array> | readonly number[]);
  /** further distance at which it is detected, m [npair] */
  get pair_gap(): FieldView<Float64Array>;
  set pair_gap(values: FieldView<Float64Array> | readonly number[]);
  /** force with which it pulls, N [npair] */
  get pair_adhesion(): FieldView<Float64Array>;
  set pair_adhesion(values: FieldView<Float64Array> | readonly number[]);
  /** friction: two sliding, spinning, two rolling, 1, 1, m, m, m [npair, 5] */
  get pair_friction(): FieldView<Float64Array>;
  set pair_friction(values: FieldView<Float64Array> | readonly number[]);
  /** first body times 65536 plus second body [nexclude] */
  readonly exclude_signature: FieldView<Int32Array>;
  /** 0 connect, 1 weld, 2 joint, 3 tendon [neq] */
  readonly eq_type: FieldView<Int32Array>;
  /** first object [neq] */
  readonly eq_obj1id: FieldView<Int32Array>;
  /** second object, -1 if none [neq] */
  readonly eq_obj2id: FieldView<Int32Array>;
  /** kind of both objects (mjtObj) [neq] */
  readonly eq_objtype: FieldView<Int32Array>;
  /** whether the constraint is active after a reset [neq] */
  get eq_active0(): FieldView<Uint8Array>;
  set eq_active0(values: FieldView<Uint8Array> | readonly number[]);
  /** time constant and damping ratio (or -stiffness, -damping), s, 1 [neq, 2] */
  get eq_solref(): FieldView<Float64Array>;
  set eq_solref(values: FieldView<Float64Array> | readonly number[]);
  /** impedance [neq, 5] */
  get eq_solimp(): FieldView<Float64Array>;
  set eq_solimp(values: FieldView<Float64Array> | readonly number[]);
  /** anchors, relative pose, or polynomial [neq, 11] */
  get eq_data(): FieldView<Float64Array>;
  set eq_data(values: FieldView<Float64Array> | readonly number[]);
  /** first object of the path [ntendon] */
  readonly tendon_adr: FieldView<Int32Array>;
  /** number of objects of the path [ntendon] */
  readonly tendon_num: FieldView<Int32Array>;
  /** material, -1 if none [ntendon] */
  get tendon_matid(): FieldView<Int32Array>;
  set tendon_matid(values: FieldView<Int32Array> | readonly number[]);
  /** actuator that adds damping or armature to the tendon, -1 if none [ntendon] */
  readonly tendon_actuatorid: FieldView<Int32Array>;
  /** group, for visibility [ntendon] */
  get tendon_group(): FieldView<Int32Array>;
  set tendon_group(values: FieldView<Int32Array> | readonly number[]);
  /** number of kinematic trees that the path touches [ntendon] */
  readonly tendon_treenum: FieldView<Int32Array>;
  /** the first two of them, -1 if none [ntendon, 2] */
  readonly tendon_treeid: FieldView<Int32Array>;
  /** number of non-zeros of the tendon's Jacobian [ntendon] */
  readonly ten_J_rownnz: FieldView<Int32Array>;
  /** their address [ntendon] */
  readonly ten_J_rowadr: FieldView<Int32Array>;
  /** degree of freedom of each non-zero [nJten] */
  readonly ten_J_colind: FieldView<Int32Array>;
  /** whether the length is limited [ntendon] */
  get tendon_limited(): FieldView<Uint8Array>;
  set tendon_limited(values: FieldView<Uint8Array> | readonly number[]);
  /** whether the total actuator force is limited [ntendon] */
  get tendon_actfrclimited(): FieldView<Uint8Array>;
  set tendon_actfrclimited(values: FieldView<Uint8Array> | readonly number[]);
  /** width, for drawing, m [ntendon] */
  get tendon_width(): FieldView<Float64Array>;
  set tendon_width(values: FieldView<Float64Array> | readonly number[]);
  /** limit: time constant and damping ratio (or -stiffness, -damping), s, 1 [ntendon, 2] */
  get tendon_solref_lim(): FieldView<Float64Array>;
  set tendon_solref_lim(values: FieldView<Float64Array> | readonly number[]);
  /** limit: impedance [ntendon, 5] */
  get tendon_solimp_lim(): FieldView<Float64Array>;
  set tendon_solimp_lim(values: FieldView<Float64Array> | readonly number[]);
  /** friction loss: time constant and damping ratio (or -stiffness, -damping), s, 1 [ntendon, 2] */
  get tendon_solref_fri(): FieldView<Float64Array>;
  set tendon_solref_fri(values: FieldView<Float64Array> | readonly number[]);
  /** friction loss: impedance [ntendon, 5] */
  get tendon_solimp_fri(): FieldView<Float64Array>;
  set tendon_solimp_fri(values: FieldView<Float64Array> | readonly number[]);
  /** lower and upper limit of the length, m [ntendon, 2] */
  get tendon_range(): FieldView<Float64Array>;
  set tendon_range(values: FieldView<Float64Array> | readonly number[]);
  /** range of the total actuator force, N [ntendon, 2] */
  get tendon_actfrcrange(): FieldView<Float64Array>;
  set tendon_actfrcrange(values: FieldView<Float64Array> | readonly number[]);
  /** distance from the limit at which it becomes active, m [ntendon] */
  get tendon_margin(): FieldView<Float64Array>;
  set tendon_margin(values: FieldView<Float64Array> | readonly number[]);
  /** stiffness, N/m [ntendon] */
  get tendon_stiffness(): FieldView<Float64Array>;
  set tendon_stiffness(values: FieldView<Float64Array> | readonly number[]);
  /** growth of the stiffness with displacement: linear, quadratic [ntendon, 2] */
  get tendon_stiffnesspoly(): FieldView<Float64Array>;
  set tendon_stiffnesspoly(values: FieldView<Float64Array> | readonly number[]);
  /** linear damping, N s/m [ntendon] */
  get tendon_damping(): FieldView<Float64Array>;
  set tendon_damping(values: FieldView<Float64Array> | readonly number[]);
  /** growth of the damping with speed: linear, quadratic [ntendon, 2] */
  get tendon_dampingpoly(): FieldView<Float64Array>;
  set tendon_dampingpoly(values: FieldView<Float64Array> | readonly number[]);
  /** inertia of the tendon's motion, kg [ntendon] */
  get tendon_armature(): FieldView<Float64Array>;
  set tendon_armature(values: FieldView<Float64Array> | readonly number[]);
  /** dry friction, N [ntendon] */
  get tendon_frictionloss(): FieldView<Float64Array>;
  set tendon_frictionloss(values: FieldView<Float64Array> | readonly number[]);
  /** lengths between which the spring is relaxed, m [ntendon, 2] */
  get tendon_lengthspring(): FieldView<Float64Array>;
  set tendon_lengthspring(values: FieldView<Float64Array> | readonly number[]);
  /** length at qpos0, m [ntendon] */
  readonly tendon_length0: FieldView<Float64Array>;
  /** inverse inertia at qpos0, 1/kg [ntendon] */
  readonly tendon_invweight0: FieldView<Float64Array>;
  /** user values [ntendon, nuser_tendon] */
  get tendon_user(): FieldView<Float64Array>;
  set tendon_user(values: FieldView<Float64Array> | readonly number[]);
  /** colour and opacity [ntendon, 4] */
  get tendon_rgba(): FieldView<Float64Array>;
  set tendon_rgba(values: FieldView<Float64Array> | readonly number[]);
  /** 1 joint, 2 pulley, 3 site, 4 sphere, 5 cylinder [nwrap] */
  readonly wrap_type: FieldView<Int32Array>;
  /** the joint, site or geom; -1 for a pulley [nwrap] */
  readonly wrap_objid: FieldView<Int32Array>;
  /** coefficient of a joint, divisor of a pulley, side site of a geom (-1 if none) [nwrap] */
  get wrap_prm(): FieldView<Float64Array>;
  set wrap_prm(values: FieldView<Float64Array> | readonly number[]);
  /** transmission: 0 joint, 1 jointinparent, 2 slider-crank, 3 tendon, 4 site, 5 body, 6 orientation [nactuator] */
  readonly actuator_trntype: FieldView<Int32Array>;
  /** dynamics: 0 none, 1 integrator, 2 filter, 3 filterexact, 4 muscle, 5 dcmotor, 6 pid [nactuator] */
  readonly actuator_dyntype: FieldView<Int32Array>;
  /** gain: 0 fixed, 1 affine, 2 muscle, 3 dcmotor, 4 orientation, 5 pid [nactuator] */
  readonly actuator_gaintype: FieldView<Int32Array>;
  /** bias: 0 none, 1 affine, 2 muscle, 3 dcmotor, 4 orientation [nactuator] */
  readonly actuator_biastype: FieldView<Int32Array>;
  /** first control [nactuator] */
  readonly actuator_ctrladr: FieldView<Int32Array>;
  /** number of controls [nactuator] */
  readonly actuator_ctrlnum: FieldView<Int32Array>;
  /** meaning of the controls, by gain type [nactuator] */
  readonly actuator_ctrlspec: FieldView<Int32Array>;
  /** first force output [nactuator] */
  readonly actuator_outadr: FieldView<Int32Array>;
  /** number of force outputs [nactuator] */
  readonly actuator_outnum: FieldView<Int32Array>;
  /** first activation, -1 if none [nactuator] */
  readonly actuator_actadr: FieldView<Int32Array>;
  /** number of activations [nactuator] */
  readonly actuator_actnum: FieldView<Int32Array>;
  /** the joint, tendon, site or body, and a second one, -1 if none [nactuator, 2] */
  readonly actuator_trnid: FieldView<Int32Array>;
  /** length of a slider-crank's rod, m [nactuator] */
  get actuator_cranklength(): FieldView<Float64Array>;
  set actuator_cranklength(values: FieldView<Float64Array> | readonly number[]);
  /** dynamics parameters [nactuator, 10] */
  get actuator_dynprm(): FieldView<Float64Array>;
  set actuator_dynprm(values: FieldView<Float64Array> | readonly number[]);
  /** gain parameters [nactuator, 10] */
  get actuator_gainprm(): FieldView<Float64Array>;
  set actuator_gainprm(values: FieldView<Float64Array> | readonly number[]);
  /** bias parameters [nactuator, 10] */
  get actuator_biasprm(): FieldView<Float64Array>;
  set actuator_biasprm(values: FieldView<Float64Array> | readonly number[]);
  /** whether the activation is clamped [nactuator] */
  get actuator_actlimited(): FieldView<Uint8Array>;
  set actuator_actlimited(values: FieldView<Uint8Array> | readonly number[]);
  /** range of the activation [nactuator, 2] */
  get actuator_actrange(): FieldView<Float64Array>;
  set actuator_actrange(values: FieldView<Float64Array> | readonly number[]);
  /** whether the force uses the next activation [nactuator] */
  get actuator_actearly(): FieldView<Uint8Array>;
  set actuator_actearly(values: FieldView<Uint8Array> | readonly number[]);
  /** number of samples kept for a delay, interpolation (0 hold, 1 linear, 2 cubic) [nactuator, 2] */
  readonly actuator_history: FieldView<Int32Array>;
  /** address in data.history, -1 if none [nactuator] */
  readonly actuator_historyadr: FieldView<Int32Array>;
  /** delay of the control, s [nactuator] */
  get actuator_delay(): FieldView<Float64Array>;
  set actuator_delay(values: FieldView<Float64Array> | readonly number[]);
  /** damping added to the joint or tendon, N s/m or N m s/rad [nactuator] */
  get actuator_damping(): FieldView<Float64Array>;
  set actuator_damping(values: FieldView<Float64Array> | readonly number[]);
  /** growth of the damping with speed: linear, quadratic [nactuator, 2] */
  get actuator_dampingpoly(): FieldView<Float64Array>;
  set actuator_dampingpoly(values: FieldView<Float64Array> | readonly number[]);
  /** inertia added to the joint or tendon, kg or kg m^2 [nactuator] */
  get actuator_armature(): FieldView<Float64Array>;
  set actuator_armature(values: FieldView<Float64Array> | readonly number[]);
  /** group, for visibility and opt.disableactuator [nactuator] */
  get actuator_group(): FieldView<Int32Array>;
  set actuator_group(values: FieldView<Int32Array> | readonly number[]);
  /** user values [nactuator, nuser_actuator] */
  get actuator_user(): FieldView<Float64Array>;
  set actuator_user(values: FieldView<Float64Array> | readonly number[]);
  /** whether the force is clamped [nactuator] */
  get actuator_forcelimited(): FieldView<Uint8Array>;
  set actuator_forcelimited(values: FieldView<Uint8Array> | readonly number[]);
  /** range of the force, N or N m [nactuator, 2] */
  get actuator_forcerange(): FieldView<Float64Array>;
  set actuator_forcerange(values: FieldView<Float64Array> | readonly number[]);
  /** whether the control is clamped [nu] */
  get actuator_ctrllimited(): FieldView<Uint8Array>;
  set actuator_ctrllimited(values: FieldView<Uint8Array> | readonly number[]);
  /** range of the control [nu, 2] */
  get actuator_ctrlrange(): FieldView<Float64Array>;
  set actuator_ctrlrange(values: FieldView<Float64Array> | readonly number[]);
  /** scale of length and force [nout, 6] */
  get actuator_gear(): FieldView<Float64Array>;
  set actuator_gear(values: FieldView<Float64Array> | readonly number[]);
  /** acceleration caused by a unit force at qpos0, m/s^2 or rad/s^2 [nout] */
  readonly actuator_acc0: FieldView<Float64Array>;
  /** length at qpos0, m or rad [nout] */
  readonly actuator_length0: FieldView<Float64Array>;
  /** range of lengths that the mechanism can reach, m or rad [nout, 2] */
  get actuator_lengthrange(): FieldView<Float64Array>;
  set actuator_lengthrange(values: FieldView<Float64Array> | readonly number[]);
  /** type (mjtSensor) [nsensor] */
  readonly sensor_type: FieldView<Int32Array>;
  /** 0 real, 1 positive, 2 axis, 3 quaternion [nsensor] */
  readonly sensor_datatype: FieldView<Int32Array>;
  /** 1 position, 2 velocity, 3 acceleration: the stage that computes it [nsensor] */
  readonly sensor_needstage: FieldView<Int32Array>;
  /** kind of the sensed object (mjtObj) [nsensor] */
  readonly sensor_objtype: FieldView<Int32Array>;
  /** the sensed object [nsensor] */
  readonly sensor_objid: FieldView<Int32Array>;
  /** kind of the reference object (mjtObj) [nsensor] */
  readonly sensor_reftype: FieldView<Int32Array>;
  /** the reference object, -1 for the world [nsensor] */
  readonly sensor_refid: FieldView<Int32Array>;
  /** parameters of contact and distance sensors [nsensor, 3] */
  readonly sensor_intprm: FieldView<Int32Array>;
  /** number of values [nsensor] */
  readonly sensor_dim: FieldView<Int32Array>;
  /** first value in sensordata [nsensor] */
  readonly sensor_adr: FieldView<Int32Array>;
  /** values are clamped to this magnitude, 0 for no limit [nsensor] */
  get sensor_cutoff(): FieldView<Float64Array>;
  set sensor_cutoff(values: FieldView<Float64Array> | readonly number[]);
  /** standard deviation, information only [nsensor] */
  get sensor_noise(): FieldView<Float64Array>;
  set sensor_noise(values: FieldView<Float64Array> | readonly number[]);
  /** number of samples kept for a delay, interpolation (0 hold, 1 linear, 2 cubic) [nsensor, 2] */
  readonly sensor_history: FieldView<Int32Array>;
  /** address in data.history, -1 if none [nsensor] */
  readonly sensor_historyadr: FieldView<Int32Array>;
  /** delay of the value, s [nsensor] */
  get sensor_delay(): FieldView<Float64Array>;
  set sensor_delay(values: FieldView<Float64Array> | readonly number[]);
  /** period and phase of the readings, 0 for every step, s [nsensor, 2] */
  get sensor_interval(): FieldView<Float64Array>;
  set sensor_interval(values: FieldView<Float64Array> | readonly number[]);
  /** user values [nsensor, nuser_sensor] */
  get sensor_user(): FieldView<Float64Array>;
  set sensor_user(values: FieldView<Float64Array> | readonly number[]);
  /** first number of the list [nnumeric] */
  readonly numeric_adr: FieldView<Int32Array>;
  /** length of the list [nnumeric] */
  readonly numeric_size: FieldView<Int32Array>;
  /** numbers of all lists [nnumericdata] */
  get numeric_data(): FieldView<Float64Array>;
  set numeric_data(values: FieldView<Float64Array> | readonly number[]);
  /** first element of the tuple [ntuple] */
  readonly tuple_adr: FieldView<Int32Array>;
  /** number of elements [ntuple] */
  readonly tuple_size: FieldView<Int32Array>;
  /** kind of each element (mjtObj) [ntupledata] */
  readonly tuple_objtype: FieldView<Int32Array>;
  /** id of each element [ntupledata] */
  readonly tuple_objid: FieldView<Int32Array>;
  /** parameter of each element [ntupledata] */
  get tuple_objprm(): FieldView<Float64Array>;
  set tuple_objprm(values: FieldView<Float64Array> | readonly number[]);
  /** time, s [nkey] */
  get key_time(): FieldView<Float64Array>;
  set key_time(values: FieldView<Float64Array> | readonly number[]);
  /** coordinates, m or rad [nkey, nq] */
  get key_qpos(): FieldView<Float64Array>;
  set key_qpos(values: FieldView<Float64Array> | readonly number[]);
  /** velocities, m/s or rad/s [nkey, nv] */
  get key_qvel(): FieldView<Float64Array>;
  set key_qvel(values: FieldView<Float64Array> | readonly number[]);
  /** activations [nkey, na] */
  get key_act(): FieldView<Float64Array>;
  set key_act(values: FieldView<Float64Array> | readonly number[]);
  /** mocap positions, m [nkey, nmocap, 3] */
  get key_mpos(): FieldView<Float64Array>;
  set key_mpos(values: FieldView<Float64Array> | readonly number[]);
  /** mocap orientations [nkey, nmocap, 4] */
  get key_mquat(): FieldView<Float64Array>;
  set key_mquat(values: FieldView<Float64Array> | readonly number[]);
  /** controls [nkey, nu] */
  get key_ctrl(): FieldView<Float64Array>;
  set key_ctrl(values: FieldView<Float64Array> | readonly number[]);
}

/** Options of the simulation. */
export interface OptionFields {
  /** length of a step, s */
  timestep: number;
  /** ratio of frictional to normal impedance */
  impratio: number;
  /** the solver stops when the scaled improvement falls below this */
  tolerance: number;
  /** the same for the line search, relative to `tolerance` */
  ls_tolerance: number;
  /** the same for the solver that removes slip */
  noslip_tolerance: number;
  /** the same for the distance of convex shapes, m */
  ccd_tolerance: number;
  /** a tree that is slower than this may sleep, m/s */
  sleep_tolerance: number;
  /** gravity, m/s^2 [3] */
  get gravity(): FieldView<Float64Array>;
  set gravity(values: FieldView<Float64Array> | readonly number[]);
  /** velocity of the medium, m/s [3] */
  get wind(): FieldView<Float64Array>;
  set wind(values: FieldView<Float64Array> | readonly number[]);
  /** magnetic flux [3] */
  get magnetic(): FieldView<Float64Array>;
  set magnetic(values: FieldView<Float64Array> | readonly number[]);
  /** density of the medium, kg/m^3 */
  density: number;
  /** viscosity of the medium, Pa s */
  viscosity: number;
  /** margin of all contacts when the override flag is set, m */
  o_margin: number;
  /** solref of all contacts when the override flag is set, s, 1 [2] */
  get o_solref(): FieldView<Float64Array>;
  set o_solref(values: FieldView<Float64Array> | readonly number[]);
  /** solimp of all contacts when the override flag is set [5] */
  get o_solimp(): FieldView<Float64Array>;
  set o_solimp(values: FieldView<Float64Array> | readonly number[]);
  /** friction of all contacts when the override flag is set [5] */
  get o_friction(): FieldView<Float64Array>;
  set o_friction(values: FieldView<Float64Array> | readonly number[]);
  /** 0 Euler, 1 RK4, 2 implicit, 3 implicitfast, 4 discrete */
  integrator: number;
  /** friction cone: 0 pyramidal, 1 elliptic */
  cone: number;
  /** 0 dense, 1 sparse, 2 auto; it changes no number */
  jacobian: number;
  /** 0 PGS, 1 CG, 2 Newton */
  solver: number;
  /** largest number of solver iterations */
  iterations: number;
  /** largest number of line-search evaluations */
  ls_iterations: number;
  /** largest number of iterations that remove slip */
  noslip_iterations: number;
  /** largest number of iterations for the distance of convex shapes */
  ccd_iterations: number;
  /** bits of what is switched off (mjtDisableBit) */
  disableflags: number;
  /** bits of what is switched on (mjtEnableBit) */
  enableflags: number;
  /** bits of the actuator groups that are switched off */
  disableactuator: number;
  /** starting points of contacts of signed distance fields */
  sdf_initpoints: number;
  /** iterations of contacts of signed distance fields */
  sdf_iterations: number;
}

/** Statistics of a model. */
export interface StatisticFields {
  /** mean diagonal of the mass matrix; scales the solver's tolerance, kg or kg m^2 */
  meaninertia: number;
  /** mean body mass, kg */
  meanmass: number;
  /** mean body size, m */
  meansize: number;
  /** spatial extent, m */
  extent: number;
  /** centre of the model, m [3] */
  get center(): FieldView<Float64Array>;
  set center(values: FieldView<Float64Array> | readonly number[]);
}

/** Fields of data. */
export interface DataFields {
  /** simulated time, s */
  time: number;
  /** generalized coordinates: free joint x y z qw qx qy qz, ball qw qx qy qz, slide and hinge one number, m or rad [nq] */
  get qpos(): FieldView<Float64Array>;
  set qpos(values: FieldView<Float64Array> | readonly number[]);
  /** velocities: a free joint's rotation is in the body's frame, m/s or rad/s [nv] */
  get qvel(): FieldView<Float64Array>;
  set qvel(values: FieldView<Float64Array> | readonly number[]);
  /** activations of actuators [na] */
  get act(): FieldView<Float64Array>;
  set act(values: FieldView<Float64Array> | readonly number[]);
  /** past controls of delayed actuators and past values of delayed sensors [nhistory] */
  get history(): FieldView<Float64Array>;
  set history(values: FieldView<Float64Array> | readonly number[]);
  /** acceleration of the last step, where the solver starts, m/s^2 or rad/s^2 [nv] */
  get qacc_warmstart(): FieldView<Float64Array>;
  set qacc_warmstart(values: FieldView<Float64Array> | readonly number[]);
  /** controls [nu] */
  get ctrl(): FieldView<Float64Array>;
  set ctrl(values: FieldView<Float64Array> | readonly number[]);
  /** applied generalized force, N or N m [nv] */
  get qfrc_applied(): FieldView<Float64Array>;
  set qfrc_applied(values: FieldView<Float64Array> | readonly number[]);
  /** force (3) then torque (3) applied at the centre of mass, world axes, N, N m [nbody, 6] */
  get xfrc_applied(): FieldView<Float64Array>;
  set xfrc_applied(values: FieldView<Float64Array> | readonly number[]);
  /** positions of mocap bodies, m [nmocap, 3] */
  get mocap_pos(): FieldView<Float64Array>;
  set mocap_pos(values: FieldView<Float64Array> | readonly number[]);
  /** orientations of mocap bodies [nmocap, 4] */
  get mocap_quat(): FieldView<Float64Array>;
  set mocap_quat(values: FieldView<Float64Array> | readonly number[]);
  /** whether each equality constraint is active [neq] */
  get eq_active(): FieldView<Uint8Array>;
  set eq_active(values: FieldView<Uint8Array> | readonly number[]);
  /** values of the user; the engine does not touch them [nuserdata] */
  get userdata(): FieldView<Float64Array>;
  set userdata(values: FieldView<Float64Array> | readonly number[]);
  /** -11 to -1 while the tree is awake, counting steps at rest; then the next of the trees that sleep with it [ntree] */
  get tree_asleep(): FieldView<Int32Array>;
  set tree_asleep(values: FieldView<Int32Array> | readonly number[]);
  /** number of detected contacts */
  readonly ncon: number;
  /** number of scalar constraints */
  readonly nefc: number;
  /** number of scalar constraints of equalities */
  readonly ne: number;
  /** number of scalar constraints of dry friction */
  readonly nf: number;
  /** number of scalar constraints of limits */
  readonly nl: number;
  /** number of independent sets of constraints */
  readonly nisland: number;
  /** number of trees that are awake */
  readonly ntree_awake: number;
  /** number of bodies that do not sleep */
  readonly nbody_awake: number;
  /** number of bodies whose parents do not sleep */
  readonly nparent_awake: number;
  /** number of degrees of freedom that are awake */
  readonly nv_awake: number;
  /** solver iterations of the last step, summed over islands */
  readonly solver_niter: number;
  /** whether the tree is awake [ntree] */
  readonly tree_awake: FieldView<Int32Array>;
  /** -1 the body cannot move, 0 it sleeps, 1 it is awake [nbody] */
  readonly body_awake: FieldView<Int32Array>;
  /** position of the body frame, world, m [nbody, 3] */
  readonly xpos: FieldView<Float64Array>;
  /** orientation of the body frame, world [nbody, 4] */
  readonly xquat: FieldView<Float64Array>;
  /** the same as a rotation matrix [nbody, 9] */
  readonly xmat: FieldView<Float64Array>;
  /** centre of mass, world, m [nbody, 3] */
  readonly xipos: FieldView<Float64Array>;
  /** orientation of the principal axes of inertia, world [nbody, 9] */
  readonly ximat: FieldView<Float64Array>;
  /** anchor of the joint, world, m [njnt, 3] */
  readonly xanchor: FieldView<Float64Array>;
  /** axis of the joint, world [njnt, 3] */
  readonly xaxis: FieldView<Float64Array>;
  /** position of the geom, world, m [ngeom, 3] */
  readonly geom_xpos: FieldView<Float64Array>;
  /** orientation of the geom, world [ngeom, 9] */
  readonly geom_xmat: FieldView<Float64Array>;
  /** position of the site, world, m [nsite, 3] */
  readonly site_xpos: FieldView<Float64Array>;
  /** orientation of the site, world [nsite, 9] */
  readonly site_xmat: FieldView<Float64Array>;
  /** position of the camera, world, m [ncam, 3] */
  readonly cam_xpos: FieldView<Float64Array>;
  /** orientation of the camera, world [ncam, 9] */
  readonly cam_xmat: FieldView<Float64Array>;
  /** position of the light, world, m [nlight, 3] */
  readonly light_xpos: FieldView<Float64Array>;
  /** direction of the light, world [nlight, 3] */
  readonly light_xdir: FieldView<Float64Array>;
  /** centre of mass of the body and its descendants, world, m [nbody, 3] */
  readonly subtree_com: FieldView<Float64Array>;
  /** motion axis of the degree of freedom, about the tree's centre of mass [nv, 6] */
  readonly cdof: FieldView<Float64Array>;
  /** inertia about the tree's centre of mass: xx yy zz xy xz yz, m d, m, kg m^2, kg m, kg [nbody, 10] */
  readonly cinert: FieldView<Float64Array>;
  /** length of the tendon, m [ntendon] */
  readonly ten_length: FieldView<Float64Array>;
  /** Jacobian of the tendon's length [nJten] */
  readonly ten_J: FieldView<Float64Array>;
  /** first point of the tendon's path in wrap_xpos [ntendon] */
  readonly ten_wrapadr: FieldView<Int32Array>;
  /** number of points of the path [ntendon] */
  readonly ten_wrapnum: FieldView<Int32Array>;
  /** what the point lies on: a geom, -1 a site, -2 a pulley [nwrap, 2] */
  readonly wrap_obj: FieldView<Int32Array>;
  /** points of all paths, world, m [nwrap, 6] */
  readonly wrap_xpos: FieldView<Float64Array>;
  /** length of the actuator, m or rad [nout] */
  readonly actuator_length: FieldView<Float64Array>;
  /** number of non-zeros of the actuator's moment [nout] */
  readonly moment_rownnz: FieldView<Int32Array>;
  /** their address [nout] */
  readonly moment_rowadr: FieldView<Int32Array>;
  /** degree of freedom of each non-zero [nJmom] */
  readonly moment_colind: FieldView<Int32Array>;
  /** moment arms: derivative of the length with respect to each degree of freedom [nJmom] */
  readonly actuator_moment: FieldView<Float64Array>;
  /** composite inertia of the subtree, kg m^2, kg m, kg [nbody, 10] */
  readonly crb: FieldView<Float64Array>;
  /** mass matrix, lower triangle by rows, kg m^2, kg m, kg [nC] */
  readonly M: FieldView<Float64Array>;
  /** factorization M = L' D L [nC] */
  readonly qLD: FieldView<Float64Array>;
  /** 1/D [nv] */
  readonly qLDiagInv: FieldView<Float64Array>;
  /** velocity of the tendon, m/s [ntendon] */
  readonly ten_velocity: FieldView<Float64Array>;
  /** velocity of the actuator, m/s or rad/s [nout] */
  readonly actuator_velocity: FieldView<Float64Array>;
  /** velocity of the body about the tree's centre of mass, rad/s, m/s [nbody, 6] */
  readonly cvel: FieldView<Float64Array>;
  /** time derivative of cdof [nv, 6] */
  readonly cdof_dot: FieldView<Float64Array>;
  /** force of springs, N or N m [nv] */
  readonly qfrc_spring: FieldView<Float64Array>;
  /** force of dampers, N or N m [nv] */
  readonly qfrc_damper: FieldView<Float64Array>;
  /** force of gravity compensation, N or N m [nv] */
  readonly qfrc_gravcomp: FieldView<Float64Array>;
  /** force of the medium, N or N m [nv] */
  readonly qfrc_fluid: FieldView<Float64Array>;
  /** force of adhesive contacts, N or N m [nv] */
  readonly qfrc_adhesion: FieldView<Float64Array>;
  /** sum of passive forces, N or N m [nv] */
  readonly qfrc_passive: FieldView<Float64Array>;
  /** gravity, Coriolis and centrifugal force (with the sign of M a + bias = force), N or N m [nv] */
  readonly qfrc_bias: FieldView<Float64Array>;
  /** force of the actuator, N or N m [nout] */
  readonly actuator_force: FieldView<Float64Array>;
  /** time derivative of act, 1/s [na] */
  readonly act_dot: FieldView<Float64Array>;
  /** force of the actuators, N or N m [nv] */
  readonly qfrc_actuator: FieldView<Float64Array>;
  /** all forces but those of constraints, N or N m [nv] */
  readonly qfrc_smooth: FieldView<Float64Array>;
  /** acceleration without constraints, m/s^2 or rad/s^2 [nv] */
  readonly qacc_smooth: FieldView<Float64Array>;
  /** force of constraints, N or N m [nv] */
  readonly qfrc_constraint: FieldView<Float64Array>;
  /** acceleration, m/s^2 or rad/s^2 [nv] */
  readonly qacc: FieldView<Float64Array>;
  /** type of the constraint (mjtConstraint) [nefc] */
  readonly efc_type: FieldView<Int32Array>;
  /** the equality, degree of freedom, joint, tendon or contact of the row [nefc] */
  readonly efc_id: FieldView<Int32Array>;
  /** violation (negative when violated), m or rad [nefc] */
  readonly efc_pos: FieldView<Float64Array>;
  /** violation at which the constraint starts to act, m or rad [nefc] */
  readonly efc_margin: FieldView<Float64Array>;
  /** largest force of dry friction, N or N m [nefc] */
  readonly efc_frictionloss: FieldView<Float64Array>;
  /** approximate diagonal of J M^-1 J', 1/kg [nefc] */
  readonly efc_diagA: FieldView<Float64Array>;
  /** stiffness, damping, impedance and its derivative, 1/s^2, 1/s, 1, 1/m [nefc, 4] */
  readonly efc_KBIP: FieldView<Float64Array>;
  /** 1/R, kg [nefc] */
  readonly efc_D: FieldView<Float64Array>;
  /** regularization, 1/kg [nefc] */
  readonly efc_R: FieldView<Float64Array>;
  /** velocity along the constraint, J v, m/s or rad/s [nefc] */
  readonly efc_vel: FieldView<Float64Array>;
  /** reference acceleration, m/s^2 or rad/s^2 [nefc] */
  readonly efc_aref: FieldView<Float64Array>;
  /** difference between the acceleration without constraints and the reference, m/s^2 or rad/s^2 [nefc] */
  readonly efc_b: FieldView<Float64Array>;
  /** force of the constraint, N or N m [nefc] */
  readonly efc_force: FieldView<Float64Array>;
  /** 0 satisfied, 1 quadratic, 2 and 3 dry friction at its largest, 4 sliding (mjtConstraintState) [nefc] */
  readonly efc_state: FieldView<Int32Array>;
  /** velocity of the centre of mass of the body and its descendants, world, m/s [nbody, 3] */
  readonly subtree_linvel: FieldView<Float64Array>;
  /** angular momentum of the body and its descendants about their centre of mass, kg m^2/s [nbody, 3] */
  readonly subtree_angmom: FieldView<Float64Array>;
  /** acceleration of the body about the tree's centre of mass, against free fall, rad/s^2, m/s^2 [nbody, 6] */
  readonly cacc: FieldView<Float64Array>;
  /** torque and force from the parent, about the tree's centre of mass, N m, N [nbody, 6] */
  readonly cfrc_int: FieldView<Float64Array>;
  /** torque and force from outside, about the tree's centre of mass, N m, N [nbody, 6] */
  readonly cfrc_ext: FieldView<Float64Array>;
  /** force that causes qacc (inverse dynamics), N or N m [nv] */
  readonly qfrc_inverse: FieldView<Float64Array>;
  /** sensor values [nsensordata] */
  readonly sensordata: FieldView<Float64Array>;
  /** potential, kinetic; computed when the energy flag is on, J [2] */
  readonly energy: FieldView<Float64Array>;
}
