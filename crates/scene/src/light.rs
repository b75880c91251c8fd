//! The lights of a scene, and what arrives at a surface.

use crate::content::Solid;
use crate::eye::{Eye, Ray};
use crate::palette;
use crate::shape::{Hit, Placed};
use labspec_core::math::{Vec3, add, add_scaled, dot, norm, normalize, rows, scale, sub};
use labspec_core::{Data, Full, Model};

/// `mjtLightType`.
const SPOT: i32 = 0;
const DIRECTIONAL: i32 = 1;
const POINT: i32 = 2;
/// Lights that are drawn; the first is the headlight.
const MAX_LIGHTS: usize = 8;

#[derive(Clone, Copy, Debug)]
struct Light {
    /// The position, or the opposite of the direction of a directional light.
    position: Vec3,
    is_directional: bool,
    direction: Vec3,
    /// Cosine of the cutoff of a spot light.
    cutoff: Option<f64>,
    exponent: f64,
    diffuse: Vec3,
    specular: Vec3,
    attenuation: Vec3,
    casts_shadow: bool,
}

/// The lights of a picture.
pub(crate) struct Lights {
    lights: Vec<Light>,
    /// The light that casts shadows.
    shadow: Option<usize>,
    /// Light from above and from below.
    sky: Vec3,
    ground: Vec3,
    /// What casts shadows.
    casters: Vec<Caster>,
    /// How far from a surface a ray to a light begins, m.
    shadow_bias: f64,
}

/// A solid that casts a shadow, with a ball around it.
struct Caster {
    placed: Placed,
    center: Vec3,
    radius: f64,
}

impl Caster {
    /// A caster for a solid that casts shadows.
    fn new(solid: &Solid) -> Option<Caster> {
        let (center, radius) = solid.placed.bound();
        solid.casts_shadow.then(|| Caster { placed: solid.placed.clone(), center, radius })
    }

    /// Whether it is on a ray between two distances.
    fn blocks(&self, ray: &Ray, from: f64, to: f64) -> bool {
        let away = sub(self.center, ray.from);
        let along = dot(away, ray.direction);
        let is_near = along > -self.radius && dot(away, away) - along * along <= self.radius * self.radius;
        is_near && self.placed.hit(ray, from, to).is_some()
    }
}

/// What arrives at a point of a surface and leaves it towards the eye.
pub(crate) struct Arriving {
    pub(crate) diffuse: Vec3,
    pub(crate) gloss: Vec3,
}

fn directional(direction: Vec3, diffuse: Vec3, specular: f64, casts_shadow: bool) -> Light {
    Light {
        position: scale(direction, -1.0),
        is_directional: true,
        direction,
        cutoff: None,
        exponent: 0.0,
        diffuse,
        specular: [specular; 3],
        attenuation: [1.0, 0.0, 0.0],
        casts_shadow,
    }
}

/// The light of a model that has none.
fn sun() -> Light {
    directional(normalize([-0.35, 0.45, -1.0]).0, [0.72, 0.7, 0.66], 0.5, true)
}

fn light_of(m: &Model, d: &Data<Full>, id: usize) -> Option<Light> {
    let kind = m.light_type.get(id).copied().filter(|kind| *kind <= POINT)?;
    let row = |list: &[f64]| rows::<3>(list).get(id).copied();
    let number = |list: &[f64]| list.get(id).copied().unwrap_or(0.0);
    let direction = normalize(row(&d.light_xdir)?).0;
    let is_directional = kind == DIRECTIONAL;
    let cutoff = libm::cos(number(&m.light_cutoff).to_radians());
    m.light_active.get(id).copied().unwrap_or(false).then_some(Light {
        position: if is_directional { scale(direction, -1.0) } else { row(&d.light_xpos)? },
        is_directional,
        direction,
        cutoff: (kind == SPOT).then_some(cutoff),
        exponent: number(&m.light_exponent),
        diffuse: row(&m.light_diffuse)?,
        specular: row(&m.light_specular)?,
        attenuation: row(&m.light_attenuation)?,
        casts_shadow: m.light_castshadow.get(id).copied().unwrap_or(false) && kind != POINT,
    })
}

/// From 0 below `low` to 1 above `high`.
pub(crate) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

impl Light {
    /// The direction to the light, its distance and its strength at a point.
    fn at(&self, point: Vec3) -> (Vec3, f64, f64) {
        if self.is_directional {
            let (l, _) = normalize(self.position);
            return (l, f64::INFINITY, 1.0);
        }
        let away = sub(self.position, point);
        let range = norm(away);
        let l = scale(away, 1.0 / range);
        let [constant, linear, quadratic] = self.attenuation;
        let strength = 1.0 / (constant + linear * range + quadratic * range * range).max(1e-6);
        let Some(cutoff) = self.cutoff else { return (l, range, strength) };
        let c = -dot(l, self.direction);
        let edge = smoothstep(cutoff, cutoff + 0.15 * (1.0 - cutoff), c);
        (l, range, strength * edge * libm::pow(c.max(0.0), 0.25 * self.exponent))
    }
}

impl Lights {
    pub(crate) fn new(m: &Model, d: &Data<Full>, eye: &Eye, solids: &[Solid], has_shadows: bool) -> Lights {
        let mut given: Vec<Light> = (0..m.light_type.len()).filter_map(|id| light_of(m, d, id)).collect();
        let active = |id: &usize| light_of(m, d, *id).is_some();
        let of_model = rows::<3>(&m.light_ambient).iter().enumerate().filter(|(id, _)| active(id));
        let ambient = of_model.fold([0.0; 3], |sum, (_, light)| add(sum, *light));
        if given.is_empty() {
            given.push(sun());
        }
        // MuJoCo's headlight, a little weaker than there where other light comes from above.
        let mut lights = vec![directional(eye.forward, [0.3; 3], 0.25, false)];
        lights.extend(given.into_iter().take(MAX_LIGHTS - 1));
        let shadow = lights.iter().position(|light| light.casts_shadow).filter(|_| has_shadows);
        Lights {
            lights,
            casters: if shadow.is_some() {
                solids.iter().filter_map(Caster::new).collect()
            } else {
                Vec::new()
            },
            shadow,
            sky: add(palette::SKY, ambient),
            ground: add(palette::GROUND, ambient),
            shadow_bias: 1e-5 * m.stat.extent.max(1e-6),
        }
    }

    /// The work for the shadow at a point, in tests whether a ray meets a shape: most solids that cast shadows are excluded by the ball
    /// around them, in an eighth of the time.
    pub(crate) fn shadow_tests(&self) -> usize {
        self.casters.len().div_ceil(8)
    }

    /// The light at a point whose normal faces the eye.
    pub(crate) fn arriving(&self, hit: &Hit, normal: Vec3, ray: &Ray, shininess: f64) -> Arriving {
        let point = ray.point(hit.distance);
        let to_eye = scale(ray.direction, -1.0);
        let up = 0.5 * normal[2] + 0.5;
        let mut diffuse = add(scale(self.ground, 1.0 - up), scale(self.sky, up));
        let mut gloss = [0.0; 3];
        let exponent = (128.0 * shininess).max(1.0);
        for (i, light) in self.lights.iter().enumerate() {
            let (l, range, strength) = light.at(point);
            let facing = dot(normal, l);
            if facing <= 0.0 || strength <= 0.0 {
                continue;
            }
            let from = Ray { from: add_scaled(point, normal, self.shadow_bias), direction: l };
            if self.shadow == Some(i)
                && self.casters.iter().any(|caster| caster.blocks(&from, self.shadow_bias, range))
            {
                continue;
            }
            diffuse = add_scaled(diffuse, light.diffuse, facing * strength);
            let half = normalize(add(l, to_eye)).0;
            let share = strength * libm::pow(dot(normal, half).max(0.0), exponent);
            gloss = add_scaled(gloss, light.specular, share);
        }
        Arriving { diffuse, gloss }
    }
}
