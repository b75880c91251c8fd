//! Geoms, sites, cameras, lights, materials and custom data to the arrays of the model.

use crate::mjcf::arrays::{flat, ints};
use crate::mjcf::gather::{filled, listed};
use crate::mjcf::spec::{
    CameraSpec, GeomSpec, LightSpec, List, MaterialSpec, NumericSpec, SiteSpec, TupleSpec,
};
use crate::model::Model;
use std::collections::BTreeMap;

/// What the functions of this file fill in.
pub(crate) struct Scene {
    pub(crate) materials: Vec<MaterialSpec>,
    pub(crate) textures: Vec<String>,
    pub(crate) numerics: Vec<NumericSpec>,
    /// Name and text.
    pub(crate) texts: Vec<(String, String)>,
    pub(crate) tuples: Vec<TupleSpec>,
}

/// Numbers that MuJoCo keeps as 32-bit floats have no more precision here.
pub(crate) fn single<const N: usize>(x: [f64; N]) -> [f64; N] {
    x.map(|x| f64::from(x as f32))
}

/// The places of names in a list.
pub(crate) struct Places<'n>(BTreeMap<&'n str, usize>);

impl<'n> Places<'n> {
    /// Of two objects with one name, the first counts.
    pub(crate) fn of(names: impl DoubleEndedIterator<Item = &'n String> + ExactSizeIterator) -> Places<'n> {
        Places(filled(names.enumerate().rev().map(|(i, name)| (name.as_str(), i))))
    }

    /// The place of a name, -1 when it is not there.
    pub(crate) fn find(&self, name: Option<&String>) -> i32 {
        name.and_then(|name| self.0.get(name.as_str())).map_or(-1, |&i| i as i32)
    }
}

/// User values of one object, as many as all have.
fn padded(list: &List, width: usize) -> impl Iterator<Item = f64> + '_ {
    list.numbers.iter().copied().chain(std::iter::repeat(0.0)).take(width)
}

/// The sizes that these objects add to the model.
pub(crate) fn count(m: &mut Model, scene: &Scene) {
    (m.nmat, m.ntex) = (scene.materials.len(), scene.textures.len());
    (m.nnumeric, m.ntuple, m.ntext) = (scene.numerics.len(), scene.tuples.len(), scene.texts.len());
    m.nnumericdata = scene.numerics.iter().map(|n| n.data.len()).sum();
    m.ntupledata = scene.tuples.iter().map(|t| t.elements.len()).sum();
}

pub(crate) fn geoms(m: &mut Model, geoms: &[(usize, &GeomSpec)], scene: &Scene) {
    let materials = Places::of(scene.materials.iter().map(|m| &m.name));
    m.geom_type = ints(geoms, |(_, g)| g.kind);
    m.geom_contype = ints(geoms, |(_, g)| g.contype);
    m.geom_conaffinity = ints(geoms, |(_, g)| g.conaffinity);
    m.geom_condim = ints(geoms, |(_, g)| g.condim);
    m.geom_bodyid = ints(geoms, |&(b, _)| b as i32);
    m.geom_dataid = ints(geoms, |(_, g)| g.data);
    m.geom_matid = ints(geoms, |(_, g)| materials.find(g.material.as_ref()));
    m.geom_group = ints(geoms, |(_, g)| g.group);
    m.geom_priority = ints(geoms, |(_, g)| g.priority);
    m.geom_solmix = flat(geoms, |(_, g)| [g.solmix]);
    m.geom_solref = flat(geoms, |(_, g)| g.solref);
    m.geom_solimp = flat(geoms, |(_, g)| g.solimp);
    m.geom_size = flat(geoms, |(_, g)| g.size);
    m.geom_aabb = flat(geoms, |(_, g)| g.aabb);
    m.geom_rbound = flat(geoms, |(_, g)| [g.rbound]);
    m.geom_pos = flat(geoms, |(_, g)| g.pos);
    m.geom_quat = flat(geoms, |(_, g)| g.quat);
    m.geom_friction = flat(geoms, |(_, g)| g.friction);
    m.geom_margin = flat(geoms, |(_, g)| [g.margin]);
    m.geom_gap = flat(geoms, |(_, g)| [g.gap]);
    m.geom_surfacevel = flat(geoms, |(_, g)| g.surfacevel);
    m.geom_adhesion = flat(geoms, |(_, g)| [g.adhesion]);
    m.geom_fluid = flat(geoms, |(_, g)| g.fluid);
    m.geom_user = listed(geoms.iter().flat_map(|(_, g)| padded(&g.user, m.nuser_geom)));
    m.geom_rgba = flat(geoms, |(_, g)| single(g.rgba));
}

pub(crate) fn sites(m: &mut Model, sites: &[(usize, &SiteSpec)], scene: &Scene) {
    let materials = Places::of(scene.materials.iter().map(|m| &m.name));
    m.site_type = ints(sites, |(_, s)| s.kind);
    m.site_dataid = ints(sites, |(_, s)| s.data);
    m.site_bodyid = ints(sites, |&(b, _)| b as i32);
    m.site_matid = ints(sites, |(_, s)| materials.find(s.material.as_ref()));
    m.site_group = ints(sites, |(_, s)| s.group);
    m.site_size = flat(sites, |(_, s)| s.size);
    m.site_pos = flat(sites, |(_, s)| s.pos);
    m.site_quat = flat(sites, |(_, s)| s.quat);
    m.site_user = listed(sites.iter().flat_map(|(_, s)| padded(&s.user, m.nuser_site)));
    m.site_rgba = flat(sites, |(_, s)| single(s.rgba));
}

/// `bodies` are the names of all bodies.
pub(crate) fn cameras(m: &mut Model, cameras: &[(usize, &CameraSpec)], bodies: &[String]) {
    let places = Places::of(bodies.iter());
    m.cam_mode = ints(cameras, |(_, c)| c.mode);
    m.cam_bodyid = ints(cameras, |&(b, _)| b as i32);
    m.cam_targetbodyid = ints(cameras, |(_, c)| places.find(c.target.as_ref()));
    m.cam_pos = flat(cameras, |(_, c)| c.pos);
    m.cam_quat = flat(cameras, |(_, c)| c.quat);
    m.cam_projection = ints(cameras, |(_, c)| c.projection);
    m.cam_fovy = flat(cameras, |(_, c)| [c.fovy]);
    m.cam_ipd = flat(cameras, |(_, c)| [c.ipd]);
    m.cam_resolution = listed(cameras.iter().flat_map(|(_, c)| c.resolution));
    m.cam_output = ints(cameras, |(_, c)| c.output);
    m.cam_sensorsize = flat(cameras, |(_, c)| single(c.sensorsize));
    m.cam_intrinsic = flat(cameras, |(_, c)| single(c.intrinsic));
    m.cam_user = listed(cameras.iter().flat_map(|(_, c)| padded(&c.user, m.nuser_cam)));
}

/// `bodies` and `textures` are the names of all bodies and textures.
pub(crate) fn lights(m: &mut Model, lights: &[(usize, &LightSpec)], bodies: &[String], textures: &[String]) {
    let (places, textures) = (Places::of(bodies.iter()), Places::of(textures.iter()));
    m.light_mode = ints(lights, |(_, l)| l.mode);
    m.light_bodyid = ints(lights, |&(b, _)| b as i32);
    m.light_targetbodyid = ints(lights, |(_, l)| places.find(l.target.as_ref()));
    m.light_type = ints(lights, |(_, l)| l.kind);
    m.light_texid = ints(lights, |(_, l)| textures.find(l.texture.as_ref()));
    m.light_castshadow = listed(lights.iter().map(|(_, l)| l.castshadow));
    m.light_active = listed(lights.iter().map(|(_, l)| l.active));
    m.light_pos = flat(lights, |(_, l)| l.pos);
    m.light_dir = flat(lights, |(_, l)| l.dir);
    let number = |i: usize| flat(lights, |(_, l)| single([l.numbers[i]]));
    let triple = |i: usize| flat(lights, |(_, l)| single(l.triples[i]));
    (m.light_bulbradius, m.light_intensity, m.light_range) = (number(0), number(1), number(2));
    (m.light_cutoff, m.light_softness, m.light_exponent) = (number(3), number(4), number(5));
    (m.light_attenuation, m.light_ambient) = (triple(0), triple(1));
    (m.light_diffuse, m.light_specular) = (triple(2), triple(3));
}

pub(crate) fn materials(m: &mut Model, scene: &Scene) {
    let list = &scene.materials;
    let places = Places::of(scene.textures.iter());
    let textures = list.iter().flat_map(|material| &material.textures);
    m.mat_texid = listed(textures.map(|name| places.find(name.as_ref())));
    m.mat_texuniform = listed(list.iter().map(|x| x.texuniform));
    m.mat_texrepeat = flat(list, |x| single(x.texrepeat));
    let number = |i: usize| flat(list, |x| single([x.numbers[i]]));
    (m.mat_emission, m.mat_specular, m.mat_shininess) = (number(0), number(1), number(2));
    (m.mat_reflectance, m.mat_metallic, m.mat_roughness) = (number(3), number(4), number(5));
    m.mat_rgba = flat(list, |x| single(x.rgba));
    m.names.material = listed(list.iter().map(|x| x.name.clone()));
    m.names.texture.clone_from(&scene.textures);
}

pub(crate) fn custom(m: &mut Model, scene: &Scene) {
    let addresses = |lengths: &mut dyn Iterator<Item = usize>| -> (Vec<i32>, Vec<i32>) {
        let mut next = 0;
        let mut place = |n: usize| {
            next += n as i32;
            (next - n as i32, n as i32)
        };
        lengths.map(&mut place).unzip()
    };
    (m.numeric_adr, m.numeric_size) = addresses(&mut scene.numerics.iter().map(|n| n.data.len()));
    m.numeric_data = listed(scene.numerics.iter().flat_map(|n| &n.data).copied());
    (m.tuple_adr, m.tuple_size) = addresses(&mut scene.tuples.iter().map(|t| t.elements.len()));
    let elements = || scene.tuples.iter().flat_map(|t| &t.elements);
    m.tuple_objtype = listed(elements().map(|e| e.0));
    m.tuple_objid = listed(elements().map(|e| e.1));
    m.tuple_objprm = listed(elements().map(|e| e.2));
    m.names.numeric = listed(scene.numerics.iter().map(|n| n.name.clone()));
    m.names.text = listed(scene.texts.iter().map(|(name, _)| name.clone()));
    m.names.tuple = listed(scene.tuples.iter().map(|t| t.name.clone()));
    m.texts = listed(scene.texts.iter().map(|(_, text)| text.clone()));
}
