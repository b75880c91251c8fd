//! Ids of objects by element, and the properties of objects that references need.

use super::names::{NameTable, WORLD};
use super::spec::{BodySpec, SensorObjects};
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::{ElementNode, ElementTree};
use crate::model::Obj;
use std::collections::BTreeMap;

/// Ids of elements, by the index of the element in the tree.
pub(crate) struct Ids {
    by_node: Vec<Option<i32>>,
    /// Type of each joint, and whether it has limits.
    joints: Vec<(i32, bool)>,
    /// Type of each geom.
    geoms: Vec<i32>,
    /// Number of outputs of each actuator.
    outputs: Vec<i32>,
    cameras: BTreeMap<String, usize>,
    /// Number of pixels of each camera.
    pixels: Vec<usize>,
    /// The cameras with a zero in their resolution, and those with a negative number.
    blind: Vec<i32>,
    negative: Vec<i32>,
}

impl Ids {
    /// Numbers joints, geoms and sites body by body, and tendons and actuators in the order of the text.
    pub(crate) fn number(tree: &ElementTree, bodies: &[BodySpec]) -> Ids {
        let mut ids = Ids {
            by_node: vec![None; tree.nodes.len()],
            joints: Vec::new(),
            geoms: Vec::new(),
            outputs: Vec::new(),
            cameras: BTreeMap::new(),
            pixels: Vec::new(),
            blind: Vec::new(),
            negative: Vec::new(),
        };
        let mut sites = 0;
        for (i, body) in bodies.iter().enumerate() {
            ids.set(body.node, i);
            for j in &body.joints {
                ids.set(j.node, ids.joints.len());
                ids.joints.push((j.kind, j.limited));
            }
            for g in &body.geoms {
                ids.set(g.node, ids.geoms.len());
                ids.geoms.push(g.kind);
            }
            for s in &body.sites {
                ids.set(s.node, sites);
                sites += 1;
            }
        }
        for (i, camera) in bodies.iter().flat_map(|b| &b.cameras).enumerate() {
            ids.cameras.insert(camera.name.clone(), i);
            ids.pixels.push(camera.resolution.iter().map(|&n| n.max(0) as usize).product());
            if camera.resolution.contains(&0) {
                ids.blind.push(i as i32);
            }
            if camera.resolution.iter().any(|&n| n < 0) {
                ids.negative.push(i as i32);
            }
        }
        for section in ["tendon", "actuator"] {
            let nodes = tree.sections(section).flat_map(|(index, _)| tree.children(index));
            for (i, (index, node)) in nodes.enumerate() {
                ids.set(index, i);
                if section == "actuator" {
                    ids.outputs.push(if node.element.name == "orientation" { 3 } else { 1 });
                }
            }
        }
        ids
    }

    fn set(&mut self, node: usize, id: usize) {
        if let Some(slot) = self.by_node.get_mut(node) {
            *slot = Some(id as i32);
        }
    }

    /// The id of the object of this kind and name.
    pub(crate) fn find(&self, kind: &str, name: &str, names: &NameTable) -> Option<i32> {
        match kind {
            "body" if name == WORLD => Some(0),
            "camera" => self.cameras.get(name).map(|&id| id as i32),
            _ => self.by_node.get(names.find(kind, name)?).copied().flatten(),
        }
    }

    /// Type of a joint, and whether it has limits.
    pub(crate) fn joint(&self, id: i32) -> Option<(i32, bool)> {
        self.joints.get(usize::try_from(id).ok()?).copied()
    }

    /// Number of outputs of an actuator: one, or three torques, one about each axis.
    pub(crate) fn outputs(&self, id: i32) -> i32 {
        usize::try_from(id).ok().and_then(|id| self.outputs.get(id)).copied().unwrap_or(1)
    }

    /// Number of rays of a sensor: the number of pixels of a camera, or one for other objects.
    pub(crate) fn pixels(&self, objects: &SensorObjects) -> usize {
        match usize::try_from(objects.objid) {
            Ok(id) if objects.objtype == Obj::Camera as i32 => self.pixels.get(id).copied().unwrap_or(1),
            _ => 1,
        }
    }

    /// Whether a camera has no pixels.
    pub(crate) fn has_no_pixels(&self, camera: i32) -> bool {
        self.blind.contains(&camera)
    }

    /// Whether a camera has a negative number of pixels.
    pub(crate) fn is_negative(&self, camera: i32) -> bool {
        self.negative.contains(&camera)
    }

    /// Type of a geom.
    pub(crate) fn geom(&self, id: i32) -> Option<i32> {
        self.geoms.get(usize::try_from(id).ok()?).copied()
    }
}

/// The kind of objects of a type (mjtObj), as used in the table of names.
pub(crate) fn keyword(objtype: i32) -> &'static str {
    match objtype {
        t if t == Obj::Geom as i32 => "geom",
        t if t == Obj::Site as i32 => "site",
        t if t == Obj::Camera as i32 => "camera",
        _ => "body",
    }
}

/// Resolves references to objects.
#[derive(Clone, Copy)]
pub(crate) struct References<'a> {
    pub(crate) names: &'a NameTable<'a>,
    pub(crate) ids: &'a Ids,
}

impl References<'_> {
    /// The object that an attribute names. A name that does not exist is reported by the check of references.
    pub(crate) fn optional(&self, kind: &str, node: &ElementNode, attribute: &str) -> Option<i32> {
        self.ids.find(kind, node.text(attribute)?, self.names)
    }

    /// Like [`References::optional`], for an attribute that is required.
    pub(crate) fn required(
        &self,
        kind: &str,
        node: &ElementNode,
        attribute: &str,
        report: &mut Diagnostics,
    ) -> Option<i32> {
        if node.text(attribute).is_none() {
            let message = format!("{} has no `{attribute}`", node.describe());
            report
                .error(rules::MISSING_ATTRIBUTE, node.span.clone(), message)
                .help(format!("write `{attribute}=\"…\"` with the name of a {kind}"));
        }
        self.optional(kind, node, attribute)
    }
}
