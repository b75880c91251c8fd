//! The colour that a ray sees. Colours are linear inside, sRGB outside: the formulas of `web/elements/src/view/programs.ts`.

use crate::content::{Content, Coordinates, Solid};
use crate::eye::{Eye, Ray};
use crate::image::Images;
use crate::light::{Lights, smoothstep};
use crate::palette;
use crate::shape::{Hit, Shape};
use crate::texture::{self, Place};
use labspec_core::Model;
use labspec_core::math::{Vec3, add, add_scaled, dot, mat_t_mul_vec, norm, scale, sub};
use std::cell::Cell;

/// Everything that a ray can meet.
pub(crate) struct Scene<'s> {
    pub(crate) m: &'s Model,
    pub(crate) content: Content,
    /// The indices of all solids, for rays of which no pixel is known.
    pub(crate) all: Vec<u32>,
    pub(crate) lights: Lights,
    pub(crate) eye: Eye,
    pub(crate) images: &'s Images,
    /// The shortest distance at which something is seen, m.
    pub(crate) near: f64,
    /// Tests whether a ray meets a shape, up to now.
    pub(crate) tests: Cell<usize>,
}

/// A colour in sRGB, times its opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Visible {
    pub(crate) rgb: Vec3,
    pub(crate) opacity: f64,
}

/// Nothing.
const CLEAR: Visible = Visible { rgb: [0.0; 3], opacity: 0.0 };

impl Visible {
    /// This colour with another one behind it.
    pub(crate) fn over(self, behind: Visible) -> Visible {
        let rest = 1.0 - self.opacity;
        Visible { rgb: add_scaled(self.rgb, behind.rgb, rest), opacity: self.opacity + rest * behind.opacity }
    }

    fn faint(self, share: f64) -> Visible {
        Visible { rgb: scale(self.rgb, share), opacity: self.opacity * share }
    }
}

/// sRGB to linear, a polynomial that is right to a thousandth.
fn linear(c: Vec3) -> Vec3 {
    c.map(|c| c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878))
}

/// Linear to sRGB; what is brighter than 0.75 approaches 1.
fn display(c: Vec3) -> Vec3 {
    let one = |c: f64| {
        let soft = if c >= 0.75 { 0.75 + 0.25 * (1.0 - libm::exp(4.0 * (0.75 - c))) } else { c };
        (1.055 * libm::pow(soft.max(0.0), 1.0 / 2.4) - 0.055).max(0.0)
    };
    c.map(one)
}

/// More surfaces than anybody sees through.
const MOST_LAYERS: usize = 16;

impl Scene<'_> {
    /// What a ray from the eye sees, among the solids that its pixel can show.
    pub(crate) fn visible(&self, ray: &Ray, solids: &[u32], overlays: &[u32]) -> Visible {
        self.count_tests(overlays.len());
        let (surfaces, depth) = self.surfaces(ray, solids, true);
        let drawn = overlays.iter().filter_map(|i| self.content.overlays.get(*i as usize));
        let hits = drawn.filter_map(|solid| Some((solid.placed.hit(ray, self.near, f64::INFINITY)?, solid)));
        let nearest = hits.min_by(|a, b| a.0.distance.total_cmp(&b.0.distance));
        let scene = match &nearest {
            None => surfaces,
            Some((hit, solid)) => {
                let overlay = self.shade(hit, solid, ray, false);
                let is_in_front = hit.distance <= depth;
                if is_in_front {
                    overlay.over(surfaces)
                } else {
                    overlay.faint(palette::HIDDEN).over(surfaces)
                }
            }
        };
        scene.over(self.sky(ray))
    }

    fn count_tests(&self, more: usize) {
        self.tests.set(self.tests.get().saturating_add(more));
    }

    /// What a ray sees of surfaces, and the distance of the first one that is not transparent.
    fn surfaces(&self, ray: &Ray, solids: &[u32], may_mirror: bool) -> (Visible, f64) {
        let (mut visible, mut from, mut opaque) = (CLEAR, self.near, f64::INFINITY);
        for _ in 0..MOST_LAYERS {
            self.count_tests(solids.len());
            let all = solids.iter().filter_map(|i| self.content.solids.get(*i as usize));
            let mut nearest: Option<(Hit, &Solid)> = None;
            for solid in all {
                let to = nearest.as_ref().map_or(f64::INFINITY, |(hit, _)| hit.distance);
                if let Some(hit) = solid.placed.hit(ray, from, to) {
                    nearest = Some((hit, solid));
                }
            }
            let Some((hit, solid)) = nearest else { break };
            // Behind a plane that can be seen through, overlays are faint as well.
            if opaque.is_infinite() && (solid.color[3] >= 1.0 || matches!(solid.placed.shape, Shape::Plane)) {
                opaque = hit.distance;
            }
            visible = visible.over(self.shade(&hit, solid, ray, may_mirror));
            if visible.opacity > 0.999 {
                break;
            }
            from = hit.distance * (1.0 + 1e-12) + 1e-9 * self.near;
        }
        (visible, opaque)
    }

    /// The colour of a solid where a ray meets it.
    fn shade(&self, hit: &Hit, solid: &Solid, ray: &Ray, may_mirror: bool) -> Visible {
        let [r, g, b, mut opacity] = solid.color;
        let mut base = linear([r, g, b]);
        if let Some((id, from)) = solid.material.texture {
            let [r, g, b, alpha] = self.texture_at((id, from), hit, solid, ray);
            let color = linear([r, g, b]);
            base = [0, 1, 2].map(|i| base[i] * color[i]);
            opacity *= alpha;
        }
        let is_plane = matches!(solid.placed.shape, Shape::Plane);
        if solid.pattern.grid {
            base = self.with_grid(base, hit, solid, ray);
        }
        if solid.pattern.checker && hit.unit.iter().filter(|x| **x > 0.0).count() % 2 == 0 {
            base = [0.01; 3];
        }
        if solid.pattern.fading {
            let [near, far] = self.content.fading;
            let distance = norm(sub(ray.point(hit.distance), self.eye.position));
            opacity *= 1.0 - smoothstep(near, far, distance);
        }
        let is_behind = is_plane && dot(hit.normal, ray.direction) > 0.0;
        if is_behind {
            opacity *= 0.35;
        }
        let normal = if is_behind { scale(hit.normal, -1.0) } else { hit.normal };
        let material = &solid.material;
        self.count_tests(self.lights.shadow_tests());
        let arriving = self.lights.arriving(hit, normal, ray, material.shininess);
        let glossy = 0.5 * material.specular * if solid.pattern.grid { 0.15 } else { 1.0 };
        let shade = [0, 1, 2]
            .map(|i| base[i] * (arriving.diffuse[i] + material.emission) + arriving.gloss[i] * glossy);
        let mut rgb = display(shade);
        // Of a box, the upper face is the mirror.
        if solid.pattern.mirror && may_mirror && (is_plane || hit.unit[2] > 0.999_999) {
            let away = add_scaled(ray.direction, normal, -2.0 * dot(ray.direction, normal));
            let from = add_scaled(ray.point(hit.distance), normal, 1e-3 * self.near);
            let (mirrored, _) = self.surfaces(&Ray { from, direction: away }, &self.all, false);
            rgb = [0, 1, 2].map(|i| (rgb[i] + material.reflectance * mirrored.rgb[i]).min(1.0));
        }
        Visible { rgb: scale(rgb.map(|c| c.min(1.0)), opacity), opacity }
    }

    /// The colour and the opacity of a texture at a point of a solid.
    fn texture_at(&self, (id, from): (usize, Coordinates), hit: &Hit, solid: &Solid, ray: &Ray) -> [f64; 4] {
        let repeat = solid.material.repeat;
        let place = place_at(from, hit, repeat);
        let Some(image) = self.images.get(id) else {
            let [r, g, b] = self.m.textures.get(id).map_or([1.0; 3], |t| texture::color(t, place));
            return [r, g, b, 1.0];
        };
        // The texture's pixels from this pixel to the next one, to the right and upwards.
        let pixels = self.eye.pixel_derivatives(ray, hit.normal, ray.point(hit.distance)).map(|by| {
            let by = mat_t_mul_vec(&solid.placed.rotation, by);
            let in_unit = [0, 1, 2].map(|i| by[i] / solid.placed.scale[i]);
            let next = Hit { local: add(hit.local, by), unit: add(hit.unit, in_unit), ..*hit };
            image.distance(place, place_at(from, &next, repeat))
        });
        image.color(place, pixels[0].max(pixels[1]))
    }

    /// The colour of a floor with its lines.
    fn with_grid(&self, base: Vec3, hit: &Hit, solid: &Solid, ray: &Ray) -> Vec3 {
        let dark = 0.3 * base[0] + 0.6 * base[1] + 0.1 * base[2] <= 0.2;
        let line_color = if dark { [0.55, 0.6, 0.65] } else { [0.1, 0.13, 0.16] };
        // How far the point moves on the plane from a pixel to the next one, to the right and upwards.
        let moves = self.eye.pixel_derivatives(ray, hit.normal, ray.point(hit.distance));
        let [across, up] = moves.map(|v| mat_t_mul_vec(&solid.placed.rotation, v));
        let cell = self.content.grid_cell;
        let line = |cell: f64, width: f64| {
            let at = |i: usize| {
                let x = hit.local[i] / cell;
                let d = ((across[i].abs() + up[i].abs()) / cell).max(1e-12);
                let from_line = ((x - 0.5) - (x - 0.5).floor() - 0.5).abs();
                (1.0 - smoothstep(d * width, d * (width + 1.0), from_line)) * (1.0 - smoothstep(0.1, 0.5, d))
            };
            at(0).max(at(1))
        };
        let share = (0.45 * line(cell, 0.3)).max(line(5.0 * cell, 0.5)) * palette::GRID;
        [0, 1, 2].map(|i| base[i] + share * (line_color[i] - base[i]))
    }

    /// The sky box, or the background of the page.
    fn sky(&self, ray: &Ray) -> Visible {
        let [r, g, b, _] = palette::BACKGROUND;
        let mut textures = self.m.textures.iter().enumerate();
        let Some((id, sky)) = textures.find(|(_, t)| t.kind == texture::SKY_KIND) else {
            return Visible { rgb: [r, g, b], opacity: 1.0 };
        };
        let [x, y, z] = ray.direction;
        let place = Place::cube([x, z, -y]);
        let rgb = match self.images.get(id).map(|image| image.color(place, 1.0)) {
            Some([r, g, b, _]) => [r, g, b],
            None => texture::color(sky, place),
        };
        Visible { rgb, opacity: 1.0 }
    }
}

/// The place of a texture at a point of a solid.
fn place_at(from: Coordinates, hit: &Hit, [a, b]: [f64; 2]) -> Place {
    let [x, y, _] = hit.local;
    match from {
        Coordinates::Mesh => Place::flat([hit.uv[0] * a, hit.uv[1] * b]),
        // A tile of a plane without end has its middle at the origin.
        Coordinates::Endless => Place::flat([0.5 + 0.5 * x * a, 0.5 - 0.5 * y * b]),
        Coordinates::Box => {
            let [u, v] = box_coordinates(hit.unit);
            Place::flat([u * a, v * b])
        }
        Coordinates::Cube => Place::cube(hit.unit),
        Coordinates::CubeOfMetres => Place::cube(hit.local),
    }
}

/// To the right and downwards on each face of a box, seen from outside with z upwards.
fn box_coordinates([x, y, z]: Vec3) -> [f64; 2] {
    let is_side = |c: f64| c.abs() > 0.9999 && z.abs() < 0.9999;
    let [p, q] = if is_side(y) {
        [-x * y.signum(), z]
    } else if is_side(x) {
        [y * x.signum(), z]
    } else {
        [x, y * (z + 1e-6).signum()]
    };
    [0.5 + 0.5 * p, 0.5 - 0.5 * q]
}
