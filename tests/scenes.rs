//! Random scenes for property tests: trees of bodies with every type of joint, spheres, limits, springs, and other elements.

use proptest::collection::vec;
use proptest::prelude::*;

// With its path, because two crates include this file.
#[path = "scenes_text.rs"]
mod text;

/// Three numbers in a cube around zero.
type Triple = (f64, f64, f64);

/// Sensors that any scene may have; together they need the results of all stages.
pub(crate) const SENSORS: [&str; 22] = [
    "<clock/>",
    "<framepos objtype='body' objname='b0'/>",
    "<framequat objtype='geom' objname='g0'/>",
    "<framepos objtype='site' objname='s0' reftype='geom' refname='g0'/>",
    "<framelinvel objtype='xbody' objname='b0'/>",
    "<velocimeter site='s0'/>",
    "<gyro site='s0' cutoff='0.5'/>",
    "<accelerometer site='s0'/>",
    "<framelinacc objtype='geom' objname='g0'/>",
    "<force site='s0'/>",
    "<torque site='s0'/>",
    "<magnetometer site='s0'/>",
    "<subtreecom body='b0'/>",
    "<subtreelinvel body='world'/>",
    "<subtreeangmom body='b0'/>",
    "<touch site='s0'/>",
    "<contact data='found force pos normal' num='3' reduce='maxforce'/>",
    "<contact subtree1='b0' data='force torque' reduce='netforce'/>",
    "<rangefinder site='s0'/>",
    "<e_potential/>",
    "<e_kinetic/>",
    "<user dim='1'/>",
];

/// A joint other than a free joint.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    /// 0 ball, 1 slide, 2 hinge.
    kind: u8,
    axis: Triple,
    pos: Triple,
    damping: f64,
    stiffness: f64,
    armature: f64,
    /// The growth of stiffness and damping.
    growth: (f64, f64),
    /// Half the width of the limits, rad or m.
    range: Option<f64>,
}

/// A body with its spheres.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    /// The index of its parent among the bodies before it; the world if the number is even.
    parent: usize,
    /// Whether it has a free joint, if its parent is the world.
    free: bool,
    joints: Vec<Joint>,
    pos: Triple,
    euler: Triple,
    /// The position, radius and mass of each sphere.
    spheres: Vec<(Triple, f64, f64)>,
    gravcomp: f64,
    /// solref, friction, condim, margin, gap.
    material: Option<(f64, f64, f64, bool, f64, f64)>,
}

/// A tendon.
#[derive(Clone, Debug)]
pub(crate) struct Tendon {
    /// Whether it is a fixed tendon, if there are suitable joints.
    fixed: bool,
    /// The bodies whose sites it passes, the sphere that it wraps before each, and whether a pulley precedes it.
    path: Vec<(usize, Option<usize>, bool)>,
    stiffness: (f64, f64),
    damping: f64,
    armature: f64,
}

/// Actuators that any joint with one coordinate, and any tendon, may have.
const ACTUATORS: [&str; 8] = [
    "motor gear='2'",
    "position kp='30' kv='2'",
    "velocity kv='3'",
    "damper kv='2' ctrlrange='0 1'",
    "intvelocity kp='20' actrange='-1 1'",
    "position kp='10' timeconst='0.05'",
    "general gaintype='affine' gainprm='3 -1 -0.5' biastype='affine' biasprm='0.2 -4 -1'",
    "muscle ctrlrange='0 1' lengthrange='-1 1' force='5'",
];
/// `Euler` in three of seven cases.
const INTEGRATORS: [&str; 7] = ["Euler", "Euler", "Euler", "RK4", "implicit", "implicitfast", "discrete"];

/// An actuator.
#[derive(Clone, Debug)]
pub(crate) struct Actuator {
    /// The index in `ACTUATORS`, and the target.
    kind: usize,
    on: usize,
    /// The largest force.
    most: Option<f64>,
    /// The damping and inertia that it adds to its target.
    damping: f64,
    armature: f64,
}

/// Equality constraints, and the settings of the solver.
#[derive(Clone, Debug, Default)]
struct Equalities {
    /// Indexes in `EQUALITY_KINDS`, each with two objects to tie.
    list: Vec<(usize, usize, usize)>,
    frictionloss: f64,
    cone: bool,
    condim: usize,
    /// The index in `SOLVERS`.
    solver: usize,
    noslip: bool,
    sleep: bool,
}

/// Equality constraints: of two bodies, or of two joints.
const EQUALITY_KINDS: [&str; 4] = ["weld", "connect", "joint", "tendon"];
const SOLVERS: [&str; 4] = ["Newton", "Newton", "CG", "PGS"];

/// A scene.
#[derive(Clone)]
pub(crate) struct Scene {
    bodies: Vec<Body>,
    tendons: Vec<Tendon>,
    actuators: Vec<Actuator>,
    ties: Equalities,
    /// The density of the medium, kg/m^3.
    density: f64,
    floor: bool,
    mocap: bool,
    /// Indexes in `SENSORS`.
    pub(crate) sensors: Vec<usize>,
    energy: bool,
    /// The index in `INTEGRATORS`.
    integrator: usize,
}

fn triple(size: f64) -> impl Strategy<Value = Triple> {
    (-size..size, -size..size, -size..size)
}

/// Zero in half of the cases.
fn sometimes(size: f64) -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 0.0..size]
}

fn joint() -> impl Strategy<Value = Joint> {
    let axis = triple(1.0).prop_map(|(x, y, z)| (x, y, z + 2.0));
    let pos = prop_oneof![Just((0.0, 0.0, 0.0)), triple(0.1)];
    let range = prop::option::of(0.05..0.6);
    let growth = (sometimes(0.5), sometimes(0.2));
    (0u8..3, axis, pos, sometimes(0.5), sometimes(5.0), sometimes(0.05), growth, range).prop_map(
        |(kind, axis, pos, damping, stiffness, armature, growth, range)| Joint {
            kind,
            axis,
            pos,
            damping,
            stiffness,
            armature,
            growth,
            range,
        },
    )
}

fn body() -> impl Strategy<Value = Body> {
    let spheres = prop_oneof![
        Just(vec![((0.0, 0.0, 0.0), 0.05, 1.0)]),
        vec((triple(0.15), 0.02..0.08, 0.1..2.0), 1..3)
    ];
    let material =
        prop::option::of((0.005..0.05, 0.1..1.5, 0.0..1.0, any::<bool>(), sometimes(0.01), sometimes(0.01)));
    let euler = prop_oneof![Just((0.0, 0.0, 0.0)), triple(90.0)];
    let place = (triple(0.2), euler);
    let gravcomp = prop_oneof![3 => Just(0.0), 1 => 0.1..1.5];
    (any::<prop::sample::Index>(), any::<bool>(), vec(joint(), 0..3), place, spheres, gravcomp, material)
        .prop_map(|(parent, free, joints, (pos, euler), spheres, gravcomp, material)| Body {
            parent: parent.index(1000),
            free,
            joints,
            pos,
            euler,
            spheres,
            gravcomp,
            material,
        })
}

fn tendon() -> impl Strategy<Value = Tendon> {
    let stop = (0usize..1000, prop::option::of(0usize..1000), prop::bool::weighted(0.2));
    (any::<bool>(), vec(stop, 2..5), (sometimes(20.0), sometimes(5.0)), sometimes(2.0), sometimes(0.2))
        .prop_map(|(fixed, path, stiffness, damping, armature)| Tendon {
            fixed,
            path,
            stiffness,
            damping,
            armature,
        })
}

fn actuator() -> impl Strategy<Value = Actuator> {
    let most = prop::option::of(0.05..2.0);
    (0..ACTUATORS.len(), 0usize..1000, most, sometimes(0.5), sometimes(0.05))
        .prop_map(|(kind, on, most, damping, armature)| Actuator { kind, on, most, damping, armature })
}

/// Scenes with one to five bodies.
pub(crate) fn scene() -> impl Strategy<Value = Scene> {
    let density = prop_oneof![3 => Just(0.0), 1 => 0.1..20.0];
    let sensors = prop_oneof![Just(vec![]), vec(0..SENSORS.len(), 1..4)];
    let actuators = prop_oneof![Just(vec![]), vec(actuator(), 1..4)];
    let parts = (vec(body(), 1..6), vec(tendon(), 0..3), actuators);
    (parts, density, sensors, 0..INTEGRATORS.len(), any::<(bool, bool, bool)>()).prop_map(
        |((bodies, tendons, actuators), density, sensors, integrator, (floor, mocap, energy))| Scene {
            bodies,
            tendons,
            actuators,
            ties: Equalities::default(),
            density,
            floor,
            mocap,
            sensors,
            energy,
            integrator,
        },
    )
}

/// The same with equality constraints and dry friction, cones, all solvers, and sleeping trees.
#[allow(dead_code)] // one of the two users of this file does not need it
pub(crate) fn constrained_scene() -> impl Strategy<Value = Scene> {
    let list = vec((0..EQUALITY_KINDS.len(), 0usize..1000, 0usize..1000), 0..3);
    let condim = prop_oneof![2 => Just(0usize), 1 => Just(4), 1 => Just(6)];
    let ties = (
        list,
        sometimes(0.5),
        any::<bool>(),
        condim,
        0..SOLVERS.len(),
        any::<bool>(),
        prop::bool::weighted(0.2),
    )
        .prop_map(|(list, frictionloss, cone, condim, solver, noslip, sleep)| Equalities {
            list,
            frictionloss,
            cone,
            condim,
            solver,
            noslip,
            sleep,
        });
    (scene(), prop_oneof![1 => Just(Equalities::default()), 2 => ties])
        .prop_map(|(scene, ties)| Scene { ties, ..scene })
}

/// A failing test prints the model, so that it can be loaded.
impl std::fmt::Debug for Scene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.xml())
    }
}
