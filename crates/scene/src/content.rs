//! The solids of a scene: geoms and tendons, then what is drawn over them.

use crate::View;
use crate::eye::{Eye, pose};
use crate::mesh::Triangles;
use crate::overlay::push_overlays;
use crate::palette::{self, Color};
use crate::shape::{Placed, Shape};
use labspec_core::math::{
    Vec3, add, add_scaled, dot, mat_mul_vec, mat_t_mul_vec, norm, normalize, rows, scale, sub,
};
use labspec_core::{Data, Full, Model, geom};
use std::collections::BTreeMap;
use std::sync::Arc;

/// How a surface answers light, as MuJoCo's materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Material {
    pub(crate) emission: f64,
    pub(crate) specular: f64,
    pub(crate) shininess: f64,
    pub(crate) reflectance: f64,
    /// A texture of the model, and where its coordinates come from.
    pub(crate) texture: Option<(usize, Coordinates)>,
    pub(crate) repeat: [f64; 2],
}

/// Where texture coordinates come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coordinates {
    /// The mesh.
    Mesh,
    /// The faces of a box, or of what is inside it.
    Box,
    /// The point of a plane without end, m.
    Endless,
    /// The direction of the point in the shape of size 1.
    Cube,
    /// The direction of the point in m.
    CubeOfMetres,
}

/// MuJoCo's material of a geom that names none.
pub(crate) const PLAIN: Material = Material {
    emission: 0.0,
    specular: 0.5,
    shininess: 0.5,
    reflectance: 0.0,
    texture: None,
    repeat: [1.0; 2],
};

/// What a surface shows besides its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Pattern {
    /// The lines of a floor.
    pub(crate) grid: bool,
    /// Eight parts in turn light and dark.
    pub(crate) checker: bool,
    /// Whether it becomes transparent far away.
    pub(crate) fading: bool,
    /// Whether it mirrors the scene.
    pub(crate) mirror: bool,
}

/// A solid with its look.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    pub(crate) placed: Placed,
    pub(crate) color: Color,
    pub(crate) material: Material,
    pub(crate) pattern: Pattern,
    pub(crate) casts_shadow: bool,
}

/// What a picture shows.
pub(crate) struct Content {
    /// Geoms, tendons, transparent sites.
    pub(crate) solids: Vec<Solid>,
    /// What is drawn over them, and faintly through them.
    pub(crate) overlays: Vec<Solid>,
    /// The distance of the lines of a floor, m.
    pub(crate) grid_cell: f64,
    /// Where a floor without end begins to fade, and where it ends, m.
    pub(crate) fading: [f64; 2],
}

impl Content {
    /// `None`: the surfaces of meshes and height fields have too many triangles.
    pub(crate) fn new(m: &Model, d: &Data<Full>, view: &View, eye: &Eye) -> Option<Content> {
        let reach = plane_reach(m, eye);
        let mut content = Content {
            solids: Vec::new(),
            overlays: Vec::new(),
            grid_cell: grid_cell(m),
            fading: [0.15 * reach, 0.8 * reach],
        };
        push_geoms(m, d, eye, &mut content.solids)?;
        push_tendons(m, d, &mut content.solids);
        push_overlays(m, d, view, eye, &mut content);
        Some(content)
    }
}

/// Groups that are visible: 0 to 2, as in MuJoCo.
const LAST_GROUP: i32 = 2;

pub(crate) fn is_visible(groups: &[i32], id: usize) -> bool {
    groups.get(id).is_some_and(|group| *group <= LAST_GROUP)
}

/// The shape and the scale of a geom or a site that is neither a plane nor made of triangles.
pub(crate) fn primitive(kind: i32, [a, b, c]: Vec3) -> (Shape, Vec3) {
    match kind {
        geom::SPHERE => (Shape::Ball, [a; 3]),
        geom::CAPSULE => (Shape::Capsule(b), [a; 3]),
        geom::ELLIPSOID => (Shape::Ball, [a, b, c]),
        geom::CYLINDER => (Shape::Cylinder, [a, a, b]),
        _ => (Shape::Box, [a, b, c]),
    }
}

/// MuJoCo's colour of what sets none.
const NO_COLOR: Color = [0.5, 0.5, 0.5, 1.0];

/// The colour of an element with its own colour and perhaps a material. Its own wins where it is not MuJoCo's default. `None`: neither
/// sets one.
fn color_of(m: &Model, colors: &[f64], id: usize, material: Option<usize>) -> Option<Color> {
    let given = rows::<4>(colors).get(id).copied().unwrap_or(NO_COLOR);
    let of_material = || rows::<4>(&m.mat_rgba).get(material?).copied();
    if given == NO_COLOR { of_material() } else { Some(given) }
}

/// `mat_texid` has a column for each role of a texture (`mjtTextureRole`): the one of colours.
const ROLES: usize = 10;
const COLOR_ROLE: usize = 1;

/// The material of an element of this type and size; a plane without end has no size that a texture could cover.
fn material_of(m: &Model, id: Option<usize>, kind: i32, size: Vec3, is_endless: bool) -> Material {
    let Some(id) = id.filter(|id| *id < m.mat_emission.len()) else { return PLAIN };
    let number = |list: &[f64]| list.get(id).copied().unwrap_or(0.0);
    let plain = Material {
        emission: number(&m.mat_emission),
        specular: number(&m.mat_specular),
        shininess: number(&m.mat_shininess),
        reflectance: number(&m.mat_reflectance),
        ..PLAIN
    };
    let texture = m.mat_texid.get(ROLES * id + COLOR_ROLE).and_then(|t| usize::try_from(*t).ok());
    let Some((texture, declared)) = texture.and_then(|t| Some((t, m.textures.get(t)?))) else { return plain };
    let is_uniform = m.mat_texuniform.get(id).copied().unwrap_or(false);
    let coordinates = match (declared.kind, kind) {
        (0, geom::MESH | geom::HFIELD) => Coordinates::Mesh,
        (0, _) if is_endless => Coordinates::Endless,
        (0, _) => Coordinates::Box,
        _ if is_uniform => Coordinates::CubeOfMetres,
        _ => Coordinates::Cube,
    };
    // MuJoCo multiplies by half sizes: `texrepeat` is for two metres.
    let repeat = rows::<2>(&m.mat_texrepeat).get(id).copied().unwrap_or([1.0; 2]);
    let factor = |i: usize| if is_uniform && !is_endless { size[i] } else { 1.0 };
    Material {
        texture: Some((texture, coordinates)),
        repeat: [repeat[0] * factor(0), repeat[1] * factor(1)],
        ..plain
    }
}

fn id_of(list: &[i32], id: usize) -> Option<usize> {
    list.get(id).and_then(|i| usize::try_from(*i).ok())
}

fn vector(list: &[f64], id: usize) -> Vec3 {
    rows::<3>(list).get(id).copied().unwrap_or([0.0; 3])
}

/// How far a plane without end is drawn, m.
fn plane_reach(m: &Model, eye: &Eye) -> f64 {
    (12.0 * m.stat.extent).max(25.0 * eye.position[2].abs())
}

/// The distance of the lines of a floor: 1, 2 or 5 times a power of ten, m.
fn grid_cell(m: &Model) -> f64 {
    let about = m.stat.extent.max(1e-6) / 12.0;
    let power = libm::pow(10.0, libm::log10(about).floor());
    let digit = about / power;
    power
        * [(1.5, 1.0), (3.5, 2.0), (7.5, 5.0)]
            .iter()
            .find(|(most, _)| digit < *most)
            .map_or(10.0, |(_, n)| *n)
}

/// A plane; one without a size reaches to the horizon, and its middle follows the eye.
fn plane_solid(m: &Model, id: usize, (origin, rotation): (Vec3, [f64; 9]), eye: &Eye) -> Solid {
    let size = vector(&m.geom_size, id);
    let is_endless = size[0] <= 0.0 || size[1] <= 0.0;
    let mat = id_of(&m.geom_matid, id);
    let material = material_of(m, mat, geom::PLANE, size, is_endless);
    let reach = plane_reach(m, eye);
    let seen = mat_t_mul_vec(&rotation, sub(eye.position, origin));
    // Lines and textures are drawn in the frame of the square, which therefore moves by whole cells.
    let snapped = |i: usize| {
        let step = match material.texture {
            None => 10.0 * grid_cell(m),
            Some(_) => 2.0 / material.repeat[i].max(1e-3),
        };
        if size[i] > 0.0 { 0.0 } else { (seen[i] / step).round() * step }
    };
    let middle = [snapped(0), snapped(1), 0.0];
    let side = |i: usize| if size[i] > 0.0 { size[i] } else { reach };
    Solid {
        placed: Placed {
            shape: Shape::Plane,
            position: add(origin, mat_mul_vec(&rotation, middle)),
            rotation,
            scale: [side(0), side(1), 1.0],
        },
        color: color_of(m, &m.geom_rgba, id, mat).unwrap_or(palette::FLOOR),
        material,
        pattern: Pattern { grid: material.texture.is_none(), fading: is_endless, ..Pattern::default() },
        casts_shadow: false,
    }
}

/// Whether the eye sees the reflecting side of a plane or a box, which then is a mirror: the upper face of a box.
fn is_mirror(solid: &Solid, eye: &Eye) -> bool {
    let Placed { shape, position, rotation, scale, .. } = &solid.placed;
    let height = match shape {
        Shape::Plane => 0.0,
        Shape::Box => scale[2],
        _ => return false,
    };
    let normal = mat_mul_vec(rotation, [0.0, 0.0, 1.0]);
    let point = add_scaled(*position, normal, height);
    solid.material.reflectance > 0.0 && solid.color[3] >= 1.0 && dot(sub(eye.position, point), normal) > 0.0
}

/// The most triangles of all surfaces: 200 MB.
const MAX_TRIANGLES: usize = 1 << 20;

/// The surfaces of meshes and height fields. Geoms of the same one share it.
struct Surfaces {
    built: BTreeMap<(i32, usize), Arc<Triangles>>,
    /// Triangles that still may be built.
    left: usize,
}

impl Surfaces {
    /// The surface of a mesh or a height field. `None`: it has too many triangles.
    fn get(&mut self, m: &Model, kind: i32, id: usize) -> Option<Arc<Triangles>> {
        if let Some(built) = self.built.get(&(kind, id)) {
            return Some(built.clone());
        }
        let of = if kind == geom::MESH { Triangles::of_mesh } else { Triangles::of_height_field };
        let surface = Arc::new(of(m, id));
        self.left = self.left.checked_sub(surface.count())?;
        self.built.insert((kind, id), surface.clone());
        Some(surface)
    }
}

/// `None`: the surfaces have too many triangles.
fn push_geoms(m: &Model, d: &Data<Full>, eye: &Eye, solids: &mut Vec<Solid>) -> Option<()> {
    let mut surfaces = Surfaces { built: BTreeMap::new(), left: MAX_TRIANGLES };
    let mut has_mirror = false;
    for (id, kind) in m.geom_type.iter().copied().enumerate() {
        let Some(place) = pose(&d.geom_xpos, &d.geom_xmat, id).filter(|_| is_visible(&m.geom_group, id))
        else {
            continue;
        };
        let data = id_of(&m.geom_dataid, id);
        let (shape, scale) = match (kind, data) {
            (geom::MESH | geom::HFIELD, Some(data)) => (Shape::Mesh(surfaces.get(m, kind, data)?), [1.0; 3]),
            _ => primitive(kind, vector(&m.geom_size, id)),
        };
        let mut solid = match kind {
            geom::PLANE => plane_solid(m, id, place, eye),
            _ => geom_solid(m, id, (shape, scale), place),
        };
        if solid.color[3] <= 0.0 {
            continue;
        }
        // As in MuJoCo, the first one is the mirror of the scene.
        solid.pattern.mirror = !has_mirror && is_mirror(&solid, eye);
        has_mirror |= solid.pattern.mirror;
        solids.push(solid);
    }
    Some(())
}

/// The solid of a geom that is no plane.
fn geom_solid(
    m: &Model,
    id: usize,
    (shape, scale): (Shape, Vec3),
    (position, rotation): (Vec3, [f64; 9]),
) -> Solid {
    let kind = m.geom_type.get(id).copied().unwrap_or(geom::SPHERE);
    let size = vector(&m.geom_size, id);
    let mat = id_of(&m.geom_matid, id);
    let color = color_of(m, &m.geom_rgba, id, mat).unwrap_or(palette::GEOM);
    Solid {
        placed: Placed { shape, position, rotation, scale },
        color,
        material: material_of(m, mat, kind, size, false),
        pattern: Pattern::default(),
        casts_shadow: color[3] >= 1.0,
    }
}

/// A site, as a solid.
pub(crate) fn site_solid(m: &Model, d: &Data<Full>, id: usize) -> Option<Solid> {
    let (position, rotation) =
        pose(&d.site_xpos, &d.site_xmat, id).filter(|_| is_visible(&m.site_group, id))?;
    let kind = m.site_type.get(id).copied()?;
    let size = vector(&m.site_size, id);
    let mat = id_of(&m.site_matid, id);
    let (shape, scale) = primitive(kind, size);
    Some(Solid {
        placed: Placed { shape, position, rotation, scale },
        color: color_of(m, &m.site_rgba, id, mat).unwrap_or(NO_COLOR),
        material: material_of(m, mat, kind, size, false),
        pattern: Pattern::default(),
        casts_shadow: false,
    })
}

/// A rotation whose axis z points along a vector.
pub(crate) fn rotation_to_z(along: Vec3) -> [f64; 9] {
    let z = normalize(along).0;
    // The axis that is most across it.
    let across = if z[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let x = normalize(sub(across, scale(z, dot(across, z)))).0;
    let y = labspec_core::math::cross(z, x);
    [x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]]
}

/// A capsule between two points.
pub(crate) fn capsule_between(from: Vec3, to: Vec3, radius: f64) -> Option<Placed> {
    let along = sub(to, from);
    let length = norm(along);
    (length > 0.0 && length.is_finite()).then(|| Placed {
        shape: Shape::Capsule(length / 2.0),
        position: add_scaled(from, along, 0.5),
        rotation: rotation_to_z(along),
        scale: [radius; 3],
    })
}

/// `wrap_obj` of a pulley.
const PULLEY: i32 = -2;
/// Pieces of an arc around a geom.
const ARC_PIECES: usize = 12;

/// Points of the shortest arc from `a` to `b` around a geom: a great circle of a sphere, a helix of a cylinder.
fn wrap_arc(m: &Model, d: &Data<Full>, id: usize, a: Vec3, b: Vec3) -> Vec<Vec3> {
    let Some((center, rotation)) = pose(&d.geom_xpos, &d.geom_xmat, id) else { return vec![a, b] };
    let is_sphere = m.geom_type.get(id) == Some(&geom::SPHERE);
    let split = |p: Vec3| {
        let [x, y, z] = mat_t_mul_vec(&rotation, sub(p, center));
        if is_sphere { ([x, y, z], 0.0) } else { ([x, y, 0.0], z) }
    };
    let ((p, h), (q, k)) = (split(a), split(b));
    let (r, s) = (norm(p), norm(q));
    let angle = libm::acos((dot(p, q) / (r * s)).clamp(-1.0, 1.0));
    let sine = libm::sin(angle);
    if sine.is_nan() || sine <= 1e-6 {
        return vec![a, b];
    }
    let point = |i: usize| {
        let t = i as f64 / ARC_PIECES as f64;
        let (u, v) = (libm::sin((1.0 - t) * angle) / sine / r, libm::sin(t * angle) / sine / s);
        let radial = scale(add(scale(p, u), scale(q, v)), r + t * (s - r));
        add(center, mat_mul_vec(&rotation, add(radial, [0.0, 0.0, h + t * (k - h)])))
    };
    (0..=ARC_PIECES).map(point).collect()
}

fn push_tendons(m: &Model, d: &Data<Full>, solids: &mut Vec<Solid>) {
    // Each row of the fields holds two points.
    let on = |i: usize| d.wrap_obj.get(i).copied().unwrap_or(PULLEY);
    for (id, (first, count)) in d.ten_wrapadr.iter().zip(&d.ten_wrapnum).enumerate() {
        let radius = m.tendon_width.get(id).copied().unwrap_or(0.0);
        let color = rows::<4>(&m.tendon_rgba).get(id).copied().unwrap_or(NO_COLOR);
        let (Ok(first), Ok(count)) = (usize::try_from(*first), usize::try_from(*count)) else { continue };
        if color[3] <= 0.0 || radius <= 0.0 {
            continue;
        }
        for i in first..(first + count).saturating_sub(1) {
            let (from, to) = (on(i), on(i + 1));
            if from == PULLEY || to == PULLEY {
                continue;
            }
            let [a, b] = [vector(&d.wrap_xpos, i), vector(&d.wrap_xpos, i + 1)];
            let path = match usize::try_from(from) {
                Ok(geom) if from == to => wrap_arc(m, d, geom, a, b),
                _ => vec![a, b],
            };
            for placed in path.windows(2).filter_map(|pair| capsule_between(pair[0], pair[1], radius)) {
                let casts_shadow = color[3] >= 1.0;
                solids.push(Solid {
                    placed,
                    color,
                    material: PLAIN,
                    pattern: Pattern::default(),
                    casts_shadow,
                });
            }
        }
    }
}
