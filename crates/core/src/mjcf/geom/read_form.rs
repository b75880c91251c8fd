//! The form of a geom: a primitive shape, a mesh, a primitive shape that replaces a mesh, or a height field.

use super::shapes::{self, GeomTypeProperties};
use crate::kinds::geom;
use crate::math::{Vec3, norm};
use crate::mjcf::body::frame::Pose;
use crate::mjcf::classes::Props;
use crate::mjcf::context::Context;
use crate::mjcf::rules;
use crate::mjcf::text::tree::ElementNode;

/// The properties that depend on the form of a geom.
#[derive(Debug)]
pub(crate) struct GeomForm {
    pub(crate) size: Vec3,
    /// Id of the mesh or height field, -1 if none.
    pub(crate) data: i32,
    /// Pose of the geom's frame relative to the frame that the author specifies. The frame of a mesh is aligned with its
    /// principal axes.
    pub(crate) mesh_pose: Pose,
    /// Centre and half lengths of the bounding box.
    pub(crate) aabb: [f64; 6],
    /// Radius of the bounding sphere.
    pub(crate) rbound: f64,
    /// Volume or area.
    pub(crate) amount: f64,
    /// Principal moments for a unit mass.
    pub(crate) moments: Vec3,
}

impl GeomForm {
    /// A primitive shape of these sizes.
    pub(crate) fn primitive(shape: &GeomTypeProperties, size: Vec3, shell: bool) -> GeomForm {
        let (amount, moments) =
            if shell { (shape.surface, shape.shell) } else { (shape.volume, shape.inertia) };
        let [x, y, z] = (shape.half)(size);
        // A solid is centred in its frame; a plane fills the space below it.
        let middle = if shape.kind == geom::PLANE { -z } else { 0.0 };
        GeomForm {
            size,
            data: -1,
            mesh_pose: Pose::NONE,
            aabb: [0.0, 0.0, middle, x, y, z],
            rbound: (shape.rbound)(size),
            amount: amount(size),
            moments: moments(size),
        }
    }
}

/// The form of a geom with a mesh or a height field. `None` if there is none, or if an error was reported.
pub(crate) fn of_asset(
    cx: &mut Context,
    p: &Props,
    node: &ElementNode,
    shape: &GeomTypeProperties,
) -> Option<GeomForm> {
    let shell = p.flag("shellinertia", false);
    if shape.kind == geom::HFIELD {
        let (data, field) = cx.assets.hfield(p.text("hfield")?)?;
        let form = GeomForm::primitive(shape, field.geom_size(), shell);
        return Some(GeomForm { data, aabb: field.aabb(), rbound: field.rbound(), ..form });
    }
    let (data, mesh) = cx.assets.mesh(p.text("mesh")?)?;
    if shape.kind == geom::MESH {
        let mesh_pose = Pose { pos: mesh.pos, quat: mesh.quat };
        let size = mesh.reach();
        let (aabb, rbound, amount, moments) = (mesh.aabb(), norm(size), mesh.amount, mesh.moments());
        return Some(GeomForm { size, data, mesh_pose, aabb, rbound, amount, moments });
    }
    let bounding = cx.parts.get(node.model).is_some_and(|part| part.compiler.fitaabb);
    let scale = p.real("fitscale").unwrap_or(1.0);
    match mesh.fit(shape.kind, bounding) {
        Some((pos, size)) => {
            let form = GeomForm::primitive(shape, size.map(|x| x * scale), shell);
            Some(GeomForm { data, mesh_pose: Pose { pos, quat: mesh.quat }, ..form })
        }
        None => {
            let message = format!("{} is a {} with a `mesh`", node.describe(), shape.name);
            cx.report
                .error(rules::GEOM, p.span("mesh").unwrap_or(node.span.clone()), message)
                .why("a shape that replaces a mesh must have a volume")
                .help("write `type=\"mesh\"` for the mesh itself, or `type=\"box\"` for a box instead");
            None
        }
    }
}

/// Reports attributes that are inconsistent with a mesh or a height field. Returns whether the geom or site has a form.
pub(crate) fn check_form(cx: &mut Context, p: &Props, node: &ElementNode, kind: i32) -> bool {
    let needs = match kind {
        geom::MESH => Some("mesh"),
        geom::HFIELD => Some("hfield"),
        _ => None,
    };
    let owner = node.describe();
    let span = |name: &str| p.span(name).unwrap_or(node.span.clone());
    if let Some(asset) = needs.filter(|asset| p.text(asset).is_none()) {
        cx.report
            .error(rules::GEOM, span("type"), format!("{owner} has no `{asset}`"))
            .why(format!("the asset that `{asset}` names defines its shape"))
            .help(format!("write `{asset}=\"…\"` with its name in `asset`"));
        return false;
    }
    let what = |kind: i32| shapes::for_kind(kind).map_or("shape", |s| s.name);
    if p.text("hfield").is_some() && kind != geom::HFIELD {
        let message = format!("{owner} is a {} with an `hfield`", what(kind));
        cx.report
            .error(rules::GEOM, span("hfield"), message)
            .help("write `type=\"hfield\"` for a height field, or delete `hfield`");
    } else if p.text("mesh").is_some() && p.has("fromto") {
        cx.report
            .error(rules::CONFLICT, span("fromto"), format!("{owner} has both `mesh` and `fromto`"))
            .why("the mesh defines its position and size")
            .help("remove one of them");
    } else if kind == geom::MESH && p.flag("shellinertia", false) {
        cx.report
            .error(rules::CONFLICT, span("shellinertia"), format!("{owner} is a mesh with `shellinertia`"))
            .why("a mesh has the same inertia everywhere")
            .help("write `inertia=\"shell\"` in the mesh");
    } else {
        return true;
    }
    false
}
