//! Sensors: what they read, resolved to ids.

use super::defaults::Props;
use super::diagnostic::{Report, code, shown};
use super::ids::Ids;
use super::names::NameTable;
use super::read_body::name;
use super::settings::checked;
use super::spec::SensorSpec;
use super::tree::{Node, Tree};
use crate::{Obj, joint};

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
            let id = ids.find("joint", node.text("joint")?, names)?;
            check_joint(row, node, ids.joint(id)?.0, report);
            (Obj::Joint as i32, id)
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
    let name = node.text("objname")?;
    let id = ids.find(kind, name, names);
    if id.is_none() && names.find(kind, name).is_none() {
        let span = node.attribute("objname").map_or(node.span.clone(), |a| a.span.clone());
        names.unknown(kind, name, span, report);
    }
    Some((objtype, id?))
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
