//! The MJCF of random scenes.

use super::{
    ACTUATORS, Actuator, EQUALITY_KINDS, INTEGRATORS, Joint, SENSORS, SOLVERS, Scene, Tendon, Triple,
};
use std::fmt::Write;

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
