//! Writes geoms, sites, cameras, lights, materials and custom data to the arrays of the model.

use crate::mjcf::arrays::{flat, padded};
use crate::mjcf::gather::{filled, listed};
use crate::mjcf::spec::{CameraSpec, GeomSpec, LightSpec, MaterialSpec, NumericSpec, SiteSpec, TupleSpec};
use crate::model::Model;
use crate::model::texture::Texture;
use std::collections::BTreeMap;

/// The inputs of the functions of this file.
pub(crate) struct SceneFields {
    pub(crate) materials: Vec<MaterialSpec>,
    /// Names and declarations of textures.
    pub(crate) textures: Vec<(String, Texture)>,
    pub(crate) numerics: Vec<NumericSpec>,
    /// Pairs of a name and a text.
    pub(crate) texts: Vec<(String, String)>,
    pub(crate) tuples: Vec<TupleSpec>,
}

/// Rounds numbers to single precision, for fields that MuJoCo stores as 32-bit floats.
pub(crate) fn single<const N: usize>(x: [f64; N]) -> [f64; N] {
    x.map(|x| f64::from(x as f32))
}

/// The indexes of names in a list.
pub(crate) struct NameIndexes<'n>(BTreeMap<&'n str, usize>);

impl<'n> NameIndexes<'n> {
    /// Builds the map. If two objects have the same name, the first one is used.
    pub(crate) fn from_names(
        names: impl DoubleEndedIterator<Item = &'n String> + ExactSizeIterator,
    ) -> NameIndexes<'n> {
        NameIndexes(filled(names.enumerate().rev().map(|(i, name)| (name.as_str(), i))))
    }

    /// The index of a name, or -1 if it is absent.
    pub(crate) fn find(&self, name: Option<&String>) -> i32 {
        name.and_then(|name| self.0.get(name.as_str())).map_or(-1, |&i| i as i32)
    }
}

/// Sets the sizes of the model for these objects.
pub(crate) fn count(m: &mut Model, scene: &SceneFields) {
    (m.nmat, m.ntex) = (scene.materials.len(), scene.textures.len());
    (m.nnumeric, m.ntuple, m.ntext) = (scene.numerics.len(), scene.tuples.len(), scene.texts.len());
    m.nnumericdata = scene.numerics.iter().map(|n| n.data.len()).sum();
    m.ntupledata = scene.tuples.iter().map(|t| t.elements.len()).sum();
}

pub(crate) fn geoms(m: &mut Model, geoms: &[(usize, &GeomSpec)], scene: &SceneFields) {
    let materials = NameIndexes::from_names(scene.materials.iter().map(|m| &m.name));
    flat(&mut m.geom_type, geoms, |(_, g)| [g.kind]);
    flat(&mut m.geom_contype, geoms, |(_, g)| [g.contype]);
    flat(&mut m.geom_conaffinity, geoms, |(_, g)| [g.conaffinity]);
    flat(&mut m.geom_condim, geoms, |(_, g)| [g.condim]);
    flat(&mut m.geom_bodyid, geoms, |&(b, _)| [b as i32]);
    flat(&mut m.geom_dataid, geoms, |(_, g)| [g.data]);
    flat(&mut m.geom_matid, geoms, |(_, g)| [materials.find(g.material.as_ref())]);
    flat(&mut m.geom_group, geoms, |(_, g)| [g.group]);
    flat(&mut m.geom_priority, geoms, |(_, g)| [g.priority]);
    flat(&mut m.geom_solmix, geoms, |(_, g)| [g.solmix]);
    flat(&mut m.geom_solref, geoms, |(_, g)| g.solref);
    flat(&mut m.geom_solimp, geoms, |(_, g)| g.solimp);
    flat(&mut m.geom_size, geoms, |(_, g)| g.size);
    flat(&mut m.geom_aabb, geoms, |(_, g)| g.aabb);
    flat(&mut m.geom_rbound, geoms, |(_, g)| [g.rbound]);
    flat(&mut m.geom_pos, geoms, |(_, g)| g.pos);
    flat(&mut m.geom_quat, geoms, |(_, g)| g.quat);
    flat(&mut m.geom_friction, geoms, |(_, g)| g.friction);
    flat(&mut m.geom_margin, geoms, |(_, g)| [g.margin]);
    flat(&mut m.geom_gap, geoms, |(_, g)| [g.gap]);
    flat(&mut m.geom_surfacevel, geoms, |(_, g)| g.surfacevel);
    flat(&mut m.geom_adhesion, geoms, |(_, g)| [g.adhesion]);
    flat(&mut m.geom_fluid, geoms, |(_, g)| g.fluid);
    padded(&mut m.geom_user, geoms.iter().map(|(_, g)| &g.user), m.nuser_geom);
    flat(&mut m.geom_rgba, geoms, |(_, g)| single(g.rgba));
}

pub(crate) fn sites(m: &mut Model, sites: &[(usize, &SiteSpec)], scene: &SceneFields) {
    let materials = NameIndexes::from_names(scene.materials.iter().map(|m| &m.name));
    flat(&mut m.site_type, sites, |(_, s)| [s.kind]);
    flat(&mut m.site_dataid, sites, |(_, s)| [s.data]);
    flat(&mut m.site_bodyid, sites, |&(b, _)| [b as i32]);
    flat(&mut m.site_matid, sites, |(_, s)| [materials.find(s.material.as_ref())]);
    flat(&mut m.site_group, sites, |(_, s)| [s.group]);
    flat(&mut m.site_size, sites, |(_, s)| s.size);
    flat(&mut m.site_pos, sites, |(_, s)| s.pos);
    flat(&mut m.site_quat, sites, |(_, s)| s.quat);
    padded(&mut m.site_user, sites.iter().map(|(_, s)| &s.user), m.nuser_site);
    flat(&mut m.site_rgba, sites, |(_, s)| single(s.rgba));
}

/// `bodies` are the names of all bodies.
pub(crate) fn cameras(m: &mut Model, cameras: &[(usize, &CameraSpec)], bodies: &[String]) {
    let places = NameIndexes::from_names(bodies.iter());
    flat(&mut m.cam_mode, cameras, |(_, c)| [c.mode]);
    flat(&mut m.cam_bodyid, cameras, |&(b, _)| [b as i32]);
    flat(&mut m.cam_targetbodyid, cameras, |(_, c)| [places.find(c.target.as_ref())]);
    flat(&mut m.cam_pos, cameras, |(_, c)| c.pos);
    flat(&mut m.cam_quat, cameras, |(_, c)| c.quat);
    flat(&mut m.cam_projection, cameras, |(_, c)| [c.projection]);
    flat(&mut m.cam_fovy, cameras, |(_, c)| [c.fovy]);
    flat(&mut m.cam_ipd, cameras, |(_, c)| [c.ipd]);
    flat(&mut m.cam_resolution, cameras, |(_, c)| c.resolution);
    flat(&mut m.cam_output, cameras, |(_, c)| [c.output]);
    flat(&mut m.cam_sensorsize, cameras, |(_, c)| single(c.sensorsize));
    flat(&mut m.cam_intrinsic, cameras, |(_, c)| single(c.intrinsic));
    padded(&mut m.cam_user, cameras.iter().map(|(_, c)| &c.user), m.nuser_cam);
}

/// `bodies` are the names of all bodies, and `textures` all textures.
pub(crate) fn lights(
    m: &mut Model,
    lights: &[(usize, &LightSpec)],
    bodies: &[String],
    textures: &[(String, Texture)],
) {
    let (places, textures) = (
        NameIndexes::from_names(bodies.iter()),
        NameIndexes::from_names(textures.iter().map(|(name, _)| name)),
    );
    flat(&mut m.light_mode, lights, |(_, l)| [l.mode]);
    flat(&mut m.light_bodyid, lights, |&(b, _)| [b as i32]);
    flat(&mut m.light_targetbodyid, lights, |(_, l)| [places.find(l.target.as_ref())]);
    flat(&mut m.light_type, lights, |(_, l)| [l.kind]);
    flat(&mut m.light_texid, lights, |(_, l)| [textures.find(l.texture.as_ref())]);
    flat(&mut m.light_castshadow, lights, |(_, l)| [l.castshadow]);
    flat(&mut m.light_active, lights, |(_, l)| [l.active]);
    flat(&mut m.light_pos, lights, |(_, l)| l.pos);
    flat(&mut m.light_dir, lights, |(_, l)| l.dir);
    let numbers = [
        &mut m.light_bulbradius,
        &mut m.light_intensity,
        &mut m.light_range,
        &mut m.light_cutoff,
        &mut m.light_softness,
        &mut m.light_exponent,
    ];
    for (i, array) in numbers.into_iter().enumerate() {
        flat(array, lights, |(_, l)| single([l.numbers[i]]));
    }
    let triples =
        [&mut m.light_attenuation, &mut m.light_ambient, &mut m.light_diffuse, &mut m.light_specular];
    for (i, array) in triples.into_iter().enumerate() {
        flat(array, lights, |(_, l)| single(l.triples[i]));
    }
}

pub(crate) fn materials(m: &mut Model, scene: &SceneFields) {
    let list = &scene.materials;
    let places = NameIndexes::from_names(scene.textures.iter().map(|(name, _)| name));
    let textures = list.iter().flat_map(|material| &material.textures);
    flat(&mut m.mat_texid, textures, |name| [places.find(name.as_ref())]);
    flat(&mut m.mat_texuniform, list, |x| [x.texuniform]);
    flat(&mut m.mat_texrepeat, list, |x| single(x.texrepeat));
    let numbers = [
        &mut m.mat_emission,
        &mut m.mat_specular,
        &mut m.mat_shininess,
        &mut m.mat_reflectance,
        &mut m.mat_metallic,
        &mut m.mat_roughness,
    ];
    for (i, array) in numbers.into_iter().enumerate() {
        flat(array, list, |x| single([x.numbers[i]]));
    }
    flat(&mut m.mat_rgba, list, |x| single(x.rgba));
    m.names.material = listed(list.iter().map(|x| x.name.clone()));
    (m.names.texture, m.textures) = scene.textures.iter().cloned().unzip();
}

pub(crate) fn custom(m: &mut Model, scene: &SceneFields) {
    let addresses = |lengths: &mut dyn Iterator<Item = usize>| -> (Vec<i32>, Vec<i32>) {
        let mut next = 0;
        let mut place = |n: usize| {
            next += n as i32;
            (next - n as i32, n as i32)
        };
        lengths.map(&mut place).unzip()
    };
    (m.numeric_adr, m.numeric_size) = addresses(&mut scene.numerics.iter().map(|n| n.data.len()));
    flat(&mut m.numeric_data, scene.numerics.iter().flat_map(|n| &n.data), |&x| [x]);
    (m.tuple_adr, m.tuple_size) = addresses(&mut scene.tuples.iter().map(|t| t.elements.len()));
    let elements = || scene.tuples.iter().flat_map(|t| &t.elements);
    flat(&mut m.tuple_objtype, elements(), |e| [e.0]);
    flat(&mut m.tuple_objid, elements(), |e| [e.1]);
    flat(&mut m.tuple_objprm, elements(), |e| [e.2]);
    m.names.numeric = listed(scene.numerics.iter().map(|n| n.name.clone()));
    m.names.text = listed(scene.texts.iter().map(|(name, _)| name.clone()));
    m.names.tuple = listed(scene.tuples.iter().map(|t| t.name.clone()));
    m.texts = listed(scene.texts.iter().map(|(_, text)| text.clone()));
}
