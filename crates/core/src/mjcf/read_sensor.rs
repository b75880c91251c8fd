//! Sensors: what they read, resolved to ids.

use super::defaults::Props;
use super::diagnostic::{Report, code, shown};
use super::names::NameTable;
use super::read_body::name;
use super::settings::checked;
use super::spec::{BodySpec, SensorSpec};
use super::tree::{Node, Tree};
use crate::{Obj, joint};

/// Ids of elements by their place in the tree.
pub(crate) struct Ids {
    by_node: Vec<Option<usize>>,
    /// Type of each joint.
    joint_kinds: Vec<i32>,
}

impl Ids {
    /// Numbers joints, geoms and sites body by body.
    pub(crate) fn number(tree: &Tree, bodies: &[BodySpec]) -> Ids {
        let mut ids = Ids { by_node: vec![None; tree.nodes.len()], joint_kinds: Vec::new() };
        let (mut geoms, mut sites) = (0, 0);
        for (i, body) in bodies.iter().enumerate() {
            ids.set(body.node, i);
            for j in &body.joints {
                ids.set(j.node, ids.joint_kinds.len());
                ids.joint_kinds.push(j.kind);
            }
            for g in &body.geoms {
                ids.set(g.node, geoms);
                geoms += 1;
            }
            for s in &body.sites {
                ids.set(s.node, sites);
                sites += 1;
            }
        }
        ids
    }

    fn set(&mut self, node: usize, id: usize) {
        if let Some(slot) = self.by_node.get_mut(node) {
            *slot = Some(id);
        }
    }

    /// The id of an object by its name; reported when there is none.
    fn find(
        &self,
        kind: &str,
        node: &Node,
        attribute: &str,
        names: &NameTable,
        report: &mut Report,
    ) -> Option<usize> {
        let name = node.text(attribute)?;
        match names.find(kind, name) {
            Some(found) => self.by_node.get(found).copied().flatten(),
            None => {
                let span = node.attribute(attribute).map_or(node.span.clone(), |a| a.span.clone());
                names.unknown(kind, name, span, report);
                None
            }
        }
    }
}

/// A sensor that is supported: its keyword, MuJoCo's number (mjtSensor), what it reads, how many values.
struct Row {
    name: &'static str,
    kind: i32,
    senses: Senses,
    dim: i32,
}

enum Senses {
    /// A slide or hinge joint.
    ScalarJoint,
    /// A ball joint.
    BallJoint,
    /// The frame of a body, geom or site.
    Frame,
    Nothing,
}

const SENSORS: [Row; 6] = [
    Row { name: "jointpos", kind: 9, senses: Senses::ScalarJoint, dim: 1 },
    Row { name: "jointvel", kind: 10, senses: Senses::ScalarJoint, dim: 1 },
    Row { name: "ballquat", kind: 18, senses: Senses::BallJoint, dim: 4 },
    Row { name: "framepos", kind: 26, senses: Senses::Frame, dim: 3 },
    Row { name: "framequat", kind: 27, senses: Senses::Frame, dim: 4 },
    Row { name: "clock", kind: 45, senses: Senses::Nothing, dim: 1 },
];

/// All sensors in the order of the text.
pub(crate) fn sensors(tree: &Tree, names: &NameTable, ids: &Ids, report: &mut Report) -> Vec<SensorSpec> {
    let mut list = Vec::new();
    for (section, _) in tree.sections("sensor") {
        for (_, node) in tree.children(section) {
            if report.is_full() {
                return list;
            }
            if let Some(row) = SENSORS.iter().find(|r| r.name == node.element.name) {
                list.extend(sensor(row, node, names, ids, report));
            }
        }
    }
    list
}

fn sensor(row: &Row, node: &Node, names: &NameTable, ids: &Ids, report: &mut Report) -> Option<SensorSpec> {
    let p = Props::own(node);
    let owner = node.shown();
    let cutoff = checked(&p, "cutoff", &owner, |x| x >= 0.0, "zero or more", report).unwrap_or(0.0);
    let noise = checked(&p, "noise", &owner, |x| x >= 0.0, "zero or more", report).unwrap_or(0.0);
    if cutoff > 0.0 && row.dim == 4 {
        report
            .error(code::SENSOR, p.span("cutoff").unwrap_or(0..0), format!("{owner} has a cutoff"))
            .why("clamping the numbers of a quaternion would leave no rotation")
            .help("remove `cutoff`");
    }
    let (objtype, objid) = match row.senses {
        Senses::Nothing => (0, -1),
        Senses::Frame => frame(&p, node, names, ids, report)?,
        Senses::ScalarJoint | Senses::BallJoint => {
            required(node, "joint", report)?;
            // A name that does not exist is reported by the check of references.
            let id = node.text("joint").and_then(|name| names.find("joint", name));
            let id = id.and_then(|n| ids.by_node.get(n).copied().flatten())?;
            check_joint(row, node, ids.joint_kinds.get(id).copied()?, report);
            (Obj::Joint as i32, id as i32)
        }
    };
    Some(SensorSpec { name: name(node), kind: row.kind, objtype, objid, dim: row.dim, cutoff, noise })
}

/// The object of a frame sensor.
fn frame(p: &Props, node: &Node, names: &NameTable, ids: &Ids, report: &mut Report) -> Option<(i32, i32)> {
    required(node, "objtype", report)?;
    required(node, "objname", report)?;
    let objtype = p.word("objtype")?;
    let kind = match objtype {
        t if t == Obj::Geom as i32 => "geom",
        t if t == Obj::Site as i32 => "site",
        _ => "body",
    };
    Some((objtype, ids.find(kind, node, "objname", names, report)? as i32))
}

fn required(node: &Node, attribute: &str, report: &mut Report) -> Option<()> {
    if node.attribute(attribute).is_some() {
        return Some(());
    }
    report
        .error(code::MISSING_ATTRIBUTE, node.span.clone(), format!("{} has no `{attribute}`", node.shown()))
        .why("it says what the sensor reads");
    None
}

fn check_joint(row: &Row, node: &Node, kind: i32, report: &mut Report) {
    let (fits, needs) = match row.senses {
        Senses::BallJoint => (kind == joint::BALL, "a ball joint"),
        _ => (matches!(kind, joint::SLIDE | joint::HINGE), "a slide or hinge joint"),
    };
    if fits {
        return;
    }
    let is = ["free", "ball", "slide", "hinge"].get(kind as usize).copied().unwrap_or("");
    let span = node.attribute("joint").map_or(node.span.clone(), |a| a.span.clone());
    let joint = shown(node.text("joint").unwrap_or(""));
    report
        .error(code::SENSOR, span, format!("`{}` reads joint {joint}, a {is} joint", row.name))
        .help(format!("it needs {needs}; `framepos` and `framequat` read the pose of any body"));
}
