//! Random scenes for property tests: trees of bodies with every type of joint, spheres, limits, springs, and other elements.

use proptest::collection::vec;
use proptest::prelude::*;
use std::fmt::Write;

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

impl Scene {
    /// The scene as MJCF.
    pub(crate) fn xml(&self) -> String {
        self.write(true)
    }

    /// Only the trees, without contacts, limits and damping; the energy is computed.
    #[allow(dead_code)] // one of the two users of this file does not need it
    pub(crate) fn conservative(&self) -> String {
        self.undamped().write(false)
    }

    /// Only the trees, with springs and dampers, so that forces are smooth.
    #[allow(dead_code)] // as above
    pub(crate) fn smooth(&self) -> String {
        self.write(false)
    }

    /// Only the trees, each floating freely without gravity.
    #[allow(dead_code)] // as above
    pub(crate) fn floating(&self) -> String {
        let mut scene = self.undamped();
        scene.bodies.iter_mut().for_each(|b| b.free = true);
        scene.write(false).replace("<option", "<option gravity=\"0 0 0\"")
    }

    fn undamped(&self) -> Scene {
        let mut scene = self.clone();
        scene.bodies.iter_mut().flat_map(|b| &mut b.joints).for_each(|j| j.damping = 0.0);
        scene
    }

    /// Writes the scene with all elements, or without constraints.
    fn write(&self, constraints: bool) -> String {
        let mut text = String::from("<mujoco><option");
        if constraints {
            let _ = write!(text, " integrator=\"{}\"", INTEGRATORS[self.integrator]);
            let cone = if self.ties.cone { "elliptic" } else { "pyramidal" };
            let noslip = if self.ties.noslip { 3 } else { 0 };
            let solver = SOLVERS[self.ties.solver];
            let _ = write!(text, " cone='{cone}' solver='{solver}' noslip_iterations='{noslip}'");
        }
        if self.density > 0.0 && constraints {
            let _ = write!(text, " density=\"{}\" viscosity=\"0.01\" wind=\"0.5 0 0\"", self.density);
        }
        text.push('>');
        let on = |on: bool| if on { "enable" } else { "disable" };
        let (energy, sleep) = (on(self.energy || !constraints), on(self.ties.sleep && constraints));
        let _ = write!(text, "<flag energy='{energy}' sleep='{sleep}'/>");
        text.push_str("</option><worldbody>");
        if self.floor && constraints {
            text.push_str("<geom type=\"plane\" size=\"1 1 1\" pos=\"0 0 -0.1\"/>");
        }
        if self.mocap {
            text.push_str(
                "<body name=\"hand\" mocap=\"true\" pos=\"0.1 0 -0.3\"><geom size=\"0.1\"/></body>",
            );
        }
        text.push_str("<site name=\"anchor\" pos=\"0 0 0.5\"/>");
        // The joints with one coordinate.
        let mut scalars = Vec::new();
        for i in (0..self.bodies.len()).filter(|&i| self.parent(i).is_none()) {
            self.body(i, constraints, &mut text, &mut scalars);
        }
        text.push_str("</worldbody>");
        if constraints {
            text.push_str("<tendon>");
            for (i, tendon) in self.tendons.iter().enumerate() {
                tendon.write(&format!("t{i}"), self.bodies.len(), &scalars, &mut text);
            }
            text.push_str("</tendon><actuator>");
            let joints = scalars.iter().map(|j| (format!("joint='{j}'"), true));
            // A tendon that wraps geoms or has no inertia gets no actuator inertia.
            let tendons = self.tendons.iter().enumerate().map(|(i, t)| {
                let takes = t.armature != 0.0 || t.fixed && scalars.len() > 1;
                (format!("tendon='t{i}'"), takes)
            });
            let on: Vec<(String, bool)> = joints.chain(tendons).collect();
            self.actuators.iter().for_each(|a| a.write(&on, &mut text));
            text.push_str("</actuator><equality>");
            self.ties.list.iter().for_each(|&tie| self.equality(tie, &scalars, &mut text));
            text.push_str("</equality>");
        }
        text.push_str("<sensor>");
        self.sensors.iter().for_each(|&i| text.push_str(SENSORS[i]));
        text.push_str("</sensor>");
        text.push_str("</mujoco>");
        text
    }

    fn equality(&self, (kind, one, two): (usize, usize, usize), scalars: &[String], text: &mut String) {
        let (bodies, tendons) = (self.bodies.len(), self.tendons.len());
        let [b1, b2] = [one % bodies, two % bodies];
        let _ = match EQUALITY_KINDS[kind] {
            "weld" if b1 != b2 => write!(text, "<weld body1='b{b1}' body2='b{b2}'/>"),
            "connect" if b1 != b2 => write!(text, "<connect body1='b{b1}' body2='b{b2}' anchor='0 0 0.1'/>"),
            "joint" if !scalars.is_empty() => {
                write!(text, "<joint joint1='{}' polycoef='0.1 1 0 0 0'/>", scalars[one % scalars.len()])
            }
            // Not with sleeping trees, because the engine does not support this.
            "tendon" if tendons > 0 && !self.ties.sleep => {
                write!(text, "<tendon tendon1='t{}'/>", one % tendons)
            }
            _ => Ok(()),
        };
    }

    /// The parent of body `i`, or `None` for the world.
    fn parent(&self, i: usize) -> Option<usize> {
        let parent = self.bodies[i].parent;
        (i > 0 && parent % 2 == 1).then(|| parent / 2 % i)
    }

    fn body(&self, i: usize, constraints: bool, text: &mut String, scalars: &mut Vec<String>) {
        let b = &self.bodies[i];
        let place = |(x, y, z): Triple| format!("{x} {y} {z}");
        let _ = write!(text, "<body name=\"b{i}\" pos=\"{}\" euler=\"{}\"", place(b.pos), place(b.euler));
        if b.gravcomp != 0.0 && constraints {
            let _ = write!(text, " gravcomp=\"{}\"", b.gravcomp);
        }
        text.push('>');
        if self.parent(i).is_none() && b.free {
            text.push_str("<freejoint/>");
        } else {
            let mut turns = false;
            for (k, joint) in b.joints.iter().enumerate() {
                // A ball joint has all rotations, so no other joint of the body may rotate.
                let joint =
                    if turns && joint.kind != 1 { &Joint { kind: 1, ..joint.clone() } } else { joint };
                turns |= joint.kind == 0 || (joint.kind == 2 && b.joints.iter().any(|j| j.kind == 0));
                let name = format!("j{i}_{k}");
                joint.write(&name, constraints, self.ties.frictionloss, text);
                if joint.kind % 3 != 0 {
                    scalars.push(name);
                }
            }
        }
        for (k, (pos, radius, mass)) in b.spheres.iter().enumerate() {
            let name = if k == 0 { format!(" name=\"g{i}\"") } else { String::new() };
            let _ = write!(text, "<geom{name} pos=\"{}\" size=\"{radius}\" mass=\"{mass}\"", place(*pos));
            match &b.material {
                _ if !constraints => text.push_str(" contype=\"0\" conaffinity=\"0\""),
                Some((time, damping, friction, slides, margin, gap)) => {
                    let condim = if *slides { self.ties.condim.max(3) } else { 1 };
                    let _ = write!(
                        text,
                        " solref=\"{time} {damping}\" friction=\"{friction}\" condim=\"{condim}\" margin=\"{margin}\" gap=\"{gap}\""
                    );
                }
                None => {}
            }
            text.push_str("/>");
        }
        let _ = write!(text, "<site name=\"s{i}\" pos=\"0 0 0.1\"/>");
        for child in (i + 1..self.bodies.len()).filter(|&c| self.parent(c) == Some(i)) {
            self.body(child, constraints, text, scalars);
        }
        text.push_str("</body>");
    }
}

impl Tendon {
    fn write(&self, name: &str, bodies: usize, scalars: &[String], text: &mut String) {
        let (k, growth) = self.stiffness;
        let laws = format!(
            "name=\"{name}\" stiffness=\"{k} {growth}\" damping=\"{} {growth}\" springlength=\"0.1 0.4\"",
            self.damping
        );
        if let (true, [first, .., last]) = (self.fixed, scalars) {
            let _ = write!(text, "<fixed {laws} armature=\"{}\">", self.armature);
            for (joint, coefficient) in [(first, 1.0), (last, -0.5)] {
                let _ = write!(text, "<joint joint=\"{joint}\" coef=\"{coefficient}\"/>");
            }
            text.push_str("</fixed>");
            return;
        }
        // A tendon with inertia is straight and ends at one body, because inertia that couples branches of a tree is not
        // supported, and the remaining matrix might not be positive definite.
        let wraps = self.armature == 0.0;
        let path = if wraps { &self.path[..] } else { &self.path[..1] };
        let armature = if wraps { String::new() } else { format!(" armature=\"{}\"", self.armature) };
        let _ = write!(text, "<spatial {laws}{armature}>");
        for (leg, &(site, around, pulley)) in path.iter().enumerate() {
            // From the anchor to a body, or from one body to the next.
            if pulley || leg == 0 {
                if pulley {
                    text.push_str("<pulley divisor=\"2\"/>");
                }
                text.push_str("<site site=\"anchor\"/>");
            }
            if let (true, Some(body)) = (wraps, around) {
                let _ = write!(text, "<geom geom=\"g{}\" sidesite=\"s{}\"/>", body % bodies, site % bodies);
            }
            let _ = write!(text, "<site site=\"s{}\"/><site site=\"anchor\"/>", site % bodies);
        }
        text.push_str("</spatial>");
    }
}

impl Actuator {
    fn write(&self, on: &[(String, bool)], text: &mut String) {
        if on.is_empty() {
            return;
        }
        let (target, takes_inertia) = &on[self.on % on.len()];
        let armature = if *takes_inertia { self.armature } else { 0.0 };
        let _ = write!(text, "<{} {target}", ACTUATORS[self.kind]);
        if let Some(most) = self.most {
            let _ = write!(text, " forcerange='-{most} {most}'");
        }
        let _ = write!(text, " damping='{}' armature='{armature}'/>", self.damping);
    }
}

impl Joint {
    fn write(&self, name: &str, constraints: bool, frictionloss: f64, text: &mut String) {
        let kind = ["ball", "slide", "hinge"][usize::from(self.kind % 3)];
        let (x, y, z) = self.axis;
        let (px, py, pz) = self.pos;
        let _ = write!(
            text,
            "<joint name=\"{name}\" type=\"{kind}\" pos=\"{px} {py} {pz}\" armature=\"{}\"",
            self.armature
        );
        let _ = write!(text, " stiffness=\"{} {}\"", self.stiffness, self.growth.0);
        if constraints && frictionloss > 0.0 {
            let _ = write!(text, " frictionloss='{frictionloss}'");
        }
        if constraints && self.damping > 0.0 {
            let _ = write!(text, " damping=\"{} {}\"", self.damping, self.growth.1);
        }
        if kind != "ball" {
            let _ = write!(text, " axis=\"{x} {y} {z}\"");
        }
        if let Some(half) = self.range.filter(|_| constraints) {
            // Angles are in degrees.
            let (low, high) = match kind {
                "ball" => (0.0, half.to_degrees()),
                "slide" => (-half, half),
                _ => (-half.to_degrees(), half.to_degrees()),
            };
            let _ = write!(text, " range=\"{low} {high}\"");
        }
        text.push_str("/>");
    }
}
