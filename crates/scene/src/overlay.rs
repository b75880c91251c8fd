//! What is drawn over a scene: sites, frames, joints, centres of mass, cameras, contacts, forces, the path of a point.

use crate::View;
use crate::content::{Content, Material, PLAIN, Pattern, Solid, capsule_between, rotation_to_z, site_solid};
use crate::eye::{Eye, pose};
use crate::palette::{self, Color};
use crate::shape::{Placed, Shape};
use labspec_core::math::{Vec3, add, add_scaled, column, mat_mul_vec, norm, normalize, rows, scale};
use labspec_core::{Data, Full, Model, contact_force, geom, joint};

/// Bright in every light.
const BRIGHT: Material = Material { emission: 0.35, specular: 0.2, ..PLAIN };
const UPRIGHT: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// Lengths of overlays: about the size of a geom, m.
fn overlay_size(m: &Model) -> f64 {
    let is_measured = |id: usize| {
        let kind = m.geom_type.get(id).copied().unwrap_or(geom::PLANE);
        kind != geom::PLANE && kind != geom::HFIELD && m.geom_bodyid.get(id) != Some(&0)
    };
    let sizes = rows::<3>(&m.geom_size).iter().enumerate().filter(|(id, _)| is_measured(*id));
    let (sum, count) = sizes.fold((0.0, 0.0), |(sum, count), (_, size)| (sum + norm(*size), count + 1.0));
    let extent = m.stat.extent;
    let mean: f64 = if count > 0.0 { sum / count } else { extent / 10.0 };
    mean.max(0.03 * extent).min(0.12 * extent)
}

/// A list of overlays that grows.
struct Overlay<'o> {
    list: &'o mut Vec<Solid>,
    eye: &'o Eye,
    size: f64,
}

impl Overlay<'_> {
    fn solid(&mut self, shape: Shape, position: Vec3, rotation: [f64; 9], scale: Vec3, color: Color) {
        let placed = Placed { shape, position, rotation, scale };
        self.push(placed, color, Pattern::default());
    }

    fn push(&mut self, placed: Placed, color: Color, pattern: Pattern) {
        if placed.position.iter().all(|x| x.is_finite()) {
            self.list.push(Solid { placed, color, material: BRIGHT, pattern, casts_shadow: false });
        }
    }

    /// An arrow of this radius; its head shrinks with a short arrow.
    fn arrow(&mut self, from: Vec3, along: Vec3, radius: f64, color: Color) {
        let total = norm(along);
        if total.is_nan() || total <= 1e-9 || total.is_infinite() {
            return;
        }
        let (rotation, z) = (rotation_to_z(along), normalize(along).0);
        let (head, thickness) = ((5.0 * radius).min(0.6 * total), radius.min(0.25 * total));
        let shaft = total - head;
        let middle = add_scaled(from, z, shaft / 2.0);
        self.solid(Shape::Cylinder, middle, rotation, [thickness, thickness, shaft / 2.0], color);
        let wide = 2.2 * thickness;
        self.solid(Shape::Cone, add_scaled(from, z, shaft), rotation, [wide, wide, head], color);
    }

    /// A line that is as wide as lines are at the depth of its middle.
    fn line(&mut self, from: Vec3, to: Vec3, color: Color) {
        let depth =
            self.eye.depth(add_scaled(from, [to[0] - from[0], to[1] - from[1], to[2] - from[2]], 0.5));
        let radius = 0.5 * palette::LINE_WIDTH * self.eye.pixel_at(depth);
        if radius > 0.0
            && let Some(placed) = capsule_between(from, to, radius)
        {
            self.push(placed, color, Pattern::default());
        }
    }
}

pub(crate) fn push_overlays(m: &Model, d: &Data<Full>, view: &View, eye: &Eye, content: &mut Content) {
    let show = &view.overlays;
    if show.sites {
        for solid in (0..m.site_type.len()).filter_map(|id| site_solid(m, d, id)) {
            match solid.color[3] {
                a if a >= 1.0 => content.overlays.push(solid),
                a if a > 0.0 => content.solids.push(solid),
                _ => {}
            }
        }
    }
    let mut overlay = Overlay { list: &mut content.overlays, eye, size: overlay_size(m) };
    if show.frames {
        push_frames(d, &mut overlay);
    }
    if show.joints {
        push_joints(m, d, &mut overlay);
    }
    if show.com {
        push_centres(m, d, &mut overlay);
    }
    if show.cameras {
        push_cameras(m, d, &mut overlay);
    }
    push_contacts(m, d, view, &mut overlay);
    push_trail(&view.trail, &mut overlay);
}

fn push_frames(d: &Data<Full>, overlay: &mut Overlay<'_>) {
    let size = overlay.size;
    for (origin, rotation) in (1..rows::<3>(&d.xpos).len()).filter_map(|body| pose(&d.xpos, &d.xmat, body)) {
        for (axis, color) in palette::AXES.into_iter().enumerate() {
            overlay.arrow(origin, scale(column(&rotation, axis), 1.3 * size), 0.035 * size, color);
        }
    }
}

/// A hinge is a drum with an arrow along its axis, a slide a block with an arrow, a ball joint a ball, a free joint a cube.
fn push_joints(m: &Model, d: &Data<Full>, overlay: &mut Overlay<'_>) {
    let (size, color) = (overlay.size, palette::JOINT);
    let s = 0.16 * size;
    for (id, kind) in m.jnt_type.iter().copied().enumerate() {
        let (Some(anchor), Some(axis)) = (rows::<3>(&d.xanchor).get(id), rows::<3>(&d.xaxis).get(id)) else {
            continue;
        };
        let along = rotation_to_z(*axis);
        match kind {
            joint::BALL => overlay.solid(Shape::Ball, *anchor, UPRIGHT, [1.3 * s; 3], color),
            joint::FREE => {
                let body = m.jnt_bodyid.get(id).and_then(|b| usize::try_from(*b).ok()).unwrap_or(0);
                let rotation = rows::<9>(&d.xmat).get(body).copied().unwrap_or(UPRIGHT);
                overlay.solid(Shape::Box, *anchor, rotation, [s; 3], color);
            }
            _ => {
                let (shape, size_of) = match kind {
                    joint::HINGE => (Shape::Cylinder, [s, s, 1.8 * s]),
                    _ => (Shape::Box, [0.8 * s, 0.8 * s, 1.8 * s]),
                };
                overlay.solid(shape, *anchor, along, size_of, color);
                overlay.arrow(*anchor, scale(*axis, 1.6 * size), 0.06 * size, color);
            }
        }
    }
}

/// A checkered ball at the centre of mass of every body, a larger one at that of a tree of several bodies.
fn push_centres(m: &Model, d: &Data<Full>, overlay: &mut Overlay<'_>) {
    let size = overlay.size;
    let mut ball = |center: Option<&Vec3>, radius: f64| {
        let Some(center) = center else { return };
        let placed = Placed { shape: Shape::Ball, position: *center, rotation: UPRIGHT, scale: [radius; 3] };
        overlay.push(placed, palette::COM, Pattern { checker: true, ..Pattern::default() });
    };
    for (body, (mass, tree)) in m.body_mass.iter().zip(&m.body_subtreemass).enumerate().skip(1) {
        if *mass > 0.0 {
            ball(rows::<3>(&d.xipos).get(body), 0.18 * size);
        }
        if m.body_parentid.get(body) == Some(&0) && tree > mass {
            ball(rows::<3>(&d.subtree_com).get(body), 0.28 * size);
        }
    }
}

/// A camera is a small box, with the outline of its picture in front of it.
fn push_cameras(m: &Model, d: &Data<Full>, overlay: &mut Overlay<'_>) {
    let (size, color) = (overlay.size, palette::CAMERA);
    for (id, fovy) in m.cam_fovy.iter().copied().enumerate() {
        let Some((position, rotation)) = pose(&d.cam_xpos, &d.cam_xmat, id) else { continue };
        let is_orthographic = m.cam_projection.get(id) == Some(&1);
        let depth = 1.5 * size;
        let height = if is_orthographic { fovy / 2.0 } else { depth * libm::tan(fovy.to_radians() / 2.0) };
        let width = 4.0 / 3.0 * height;
        let corner =
            |x: f64, y: f64, z: f64| add(position, mat_mul_vec(&rotation, [x * width, y * height, -z]));
        let loop_ = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        for (i, [x, y]) in loop_.into_iter().enumerate() {
            let [u, v] = loop_[(i + 1) % 4];
            overlay.line(corner(x, y, depth), corner(u, v, depth), color);
            overlay.line(
                if is_orthographic { corner(x, y, 0.0) } else { position },
                corner(x, y, depth),
                color,
            );
        }
        overlay.line(corner(-0.3, 1.15, depth), corner(0.0, 1.5, depth), color);
        overlay.line(corner(0.0, 1.5, depth), corner(0.3, 1.15, depth), color);
        overlay.solid(Shape::Box, position, rotation, [0.12 * size, 0.12 * size, 0.18 * size], color);
    }
}

/// The contacts as discs, and their forces on the second geom as arrows.
fn push_contacts(m: &Model, d: &Data<Full>, view: &View, overlay: &mut Overlay<'_>) {
    let size = overlay.size;
    for contact in d.contact.iter().filter(|c| c.exclude == 0) {
        let axes = rows::<3>(&contact.frame);
        if view.overlays.contacts
            && let Some(normal) = axes.first()
        {
            let disc = [0.16 * size, 0.16 * size, 0.02 * size];
            overlay.solid(Shape::Cylinder, contact.pos, rotation_to_z(*normal), disc, palette::CONTACT);
        }
        if view.overlays.forces
            && let Ok(force) = contact_force(m, d, contact)
        {
            let components = if contact.dim > 1 { 3 } else { 1 };
            let along = axes.iter().zip(&force).take(components);
            let world = along.fold([0.0; 3], |sum, (axis, f)| add_scaled(sum, *axis, *f));
            overlay.arrow(contact.pos, scale(world, view.force_scale), 0.055 * size, palette::FORCE);
        }
    }
}

/// A path, whose oldest part is faint.
fn push_trail(trail: &[Vec3], overlay: &mut Overlay<'_>) {
    let [r, g, b, _] = palette::TRAIL;
    for (i, pair) in trail.windows(2).enumerate() {
        let opacity = 0.15 + 0.85 * (i + 1) as f64 / trail.len() as f64;
        overlay.line(pair[0], pair[1], [r, g, b, opacity]);
    }
}
