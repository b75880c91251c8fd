//! Writes meshes, height fields and skins to the arrays of the model.

use super::mesh::{CompiledMesh, ConvexHull};
use super::read_asset::Assets;
use super::skin::{Bone, Skin};
use crate::geometry::{self, HullFaces};
use crate::math::Vec3;
use crate::mjcf::arrays::flat;
use crate::mjcf::gather::listed;
use crate::mjcf::scene::fill_scene::{NameIndexes, single as single_each};
use crate::model::Model;

/// Rounds numbers to single precision, for fields that MuJoCo stores as 32-bit floats.
fn single(list: &[Vec3]) -> impl Iterator<Item = f64> + '_ {
    list.as_flattened().iter().map(|&x| f64::from(x as f32))
}

/// The addresses of consecutive groups, from their lengths.
fn addresses(counts: impl Iterator<Item = usize>) -> Vec<i32> {
    listed(counts.scan(0, |next, n| {
        *next += n;
        Some((*next - n) as i32)
    }))
}

/// Sets the sizes of the model for these objects.
pub(crate) fn count(m: &mut Model, assets: &Assets) {
    let meshes = || assets.meshes.iter().filter_map(|a| a.value.as_ref());
    (m.nmesh, m.nhfield) = (assets.meshes.len(), assets.hfields.len());
    m.nmeshvert = meshes().map(|x| x.shape.vert.len()).sum();
    m.nmeshnormal = meshes().map(|x| x.shape.normal.len()).sum();
    m.nmeshtexcoord = meshes().map(|x| x.shape.texcoord.len()).sum();
    m.nmeshface = meshes().map(|x| x.shape.face.len()).sum();
    m.nmeshgraph = meshes().map(graph_len).sum();
    m.nhfielddata = assets.hfields.iter().filter_map(|a| a.value.as_ref()).map(|x| x.data.len()).sum();
    let skins = || assets.skins.iter().filter_map(|a| a.value.as_ref());
    m.nskin = assets.skins.len();
    m.nskinvert = skins().map(|s| s.vert.len()).sum();
    m.nskintexvert = skins().map(|s| s.texcoord.len()).sum();
    m.nskinface = skins().map(|s| s.face.len()).sum();
    m.nskinbone = skins().map(|s| s.bones.len()).sum();
    m.nskinbonevert = skins().flat_map(|s| &s.bones).map(|b| b.vertid.len()).sum();
}

fn graph_len(mesh: &CompiledMesh) -> usize {
    mesh.hull.as_ref().map_or(0, |h| 2 + 3 * h.vertex.len() + 6 * h.face.len())
}

pub(crate) fn meshes(m: &mut Model, assets: &Assets) {
    let list: Vec<&CompiledMesh> = listed(assets.meshes.iter().filter_map(|a| a.value.as_ref()));
    let counts = |count: fn(&CompiledMesh) -> usize| -> Vec<usize> { listed(list.iter().map(|x| count(x))) };
    let numbers =
        |counts: &[usize]| (addresses(counts.iter().copied()), listed(counts.iter().map(|&n| n as i32)));
    (m.mesh_vertadr, m.mesh_vertnum) = numbers(&counts(|x| x.shape.vert.len()));
    (m.mesh_normaladr, m.mesh_normalnum) = numbers(&counts(|x| x.shape.normal.len()));
    (m.mesh_faceadr, m.mesh_facenum) = numbers(&counts(|x| x.shape.face.len()));
    (m.mesh_texcoordadr, m.mesh_texcoordnum) = numbers(&counts(|x| x.shape.texcoord.len()));
    let graphs = counts(graph_len);
    m.mesh_graphadr = addresses(graphs.iter().copied());
    // The address of an empty list is -1.
    for (address, n) in m.mesh_texcoordadr.iter_mut().zip(&m.mesh_texcoordnum) {
        *address = if *n == 0 { -1 } else { *address };
    }
    for (address, n) in m.mesh_graphadr.iter_mut().zip(graphs) {
        *address = if n == 0 { -1 } else { *address };
    }
    m.mesh_vert = listed(list.iter().flat_map(|x| single(&x.shape.vert)));
    m.mesh_normal = listed(list.iter().flat_map(|x| single(&x.shape.normal)));
    m.mesh_texcoord = listed(list.iter().flat_map(|x| x.shape.texcoord.as_flattened()).copied());
    m.mesh_face = listed(list.iter().flat_map(|x| x.shape.face.as_flattened()).copied());
    m.mesh_facenormal = listed(list.iter().flat_map(|x| x.shape.facenormal.as_flattened()).copied());
    // A mesh without texture coordinates has zeros.
    m.mesh_facetexcoord = listed(list.iter().flat_map(|x| {
        let texture_corners = x.shape.facetexcoord.as_flattened().iter().copied();
        texture_corners.chain(std::iter::repeat(0)).take(3 * x.shape.face.len())
    }));
    m.mesh_graph = listed(list.iter().filter_map(|x| x.hull.as_ref()).flat_map(|h| h.graph()));
    m.mesh_sides = listed(list.iter().map(|x| {
        // The faces are computed from the vertices before these are rounded to single precision.
        let graph = x.hull.as_ref().map_or(Vec::new(), ConvexHull::graph);
        geometry::Hull::from_graph(&graph)
            .map_or_else(HullFaces::default, |hull| HullFaces::from_hull(&x.shape.vert, &hull))
    }));
    flat(&mut m.mesh_scale, &list, |x| x.options.scale);
    flat(&mut m.mesh_pos, &list, |x| x.pos);
    flat(&mut m.mesh_quat, &list, |x| x.quat);
    m.names.mesh = listed(assets.meshes.iter().map(|a| a.name.clone()));
}

pub(crate) fn hfields(m: &mut Model, assets: &Assets) {
    let list: Vec<_> = listed(assets.hfields.iter().filter_map(|a| a.value.as_ref()));
    flat(&mut m.hfield_size, &list, |x| x.size);
    flat(&mut m.hfield_nrow, &list, |x| [x.nrow as i32]);
    flat(&mut m.hfield_ncol, &list, |x| [x.ncol as i32]);
    m.hfield_adr = addresses(list.iter().map(|x| x.data.len()));
    m.hfield_data = listed(list.iter().flat_map(|x| &x.data).copied());
    m.names.hfield = listed(assets.hfields.iter().map(|a| a.name.clone()));
}

/// Writes the skins. The names of bodies and materials must be written before.
pub(crate) fn skins(m: &mut Model, assets: &Assets) {
    let list: Vec<&Skin> = listed(assets.skins.iter().filter_map(|a| a.value.as_ref()));
    let bones: Vec<&Bone> = listed(list.iter().flat_map(|s| &s.bones));
    let materials = NameIndexes::from_names(m.names.material.iter());
    let bodies = NameIndexes::from_names(m.names.body.iter());
    flat(&mut m.skin_matid, &list, |s| [materials.find(s.material.as_ref())]);
    flat(&mut m.skin_group, &list, |s| [s.group]);
    flat(&mut m.skin_rgba, &list, |s| single_each(s.rgba));
    flat(&mut m.skin_inflate, &list, |s| single_each([s.inflate]));
    m.skin_vertadr = addresses(list.iter().map(|s| s.vert.len()));
    flat(&mut m.skin_vertnum, &list, |s| [s.vert.len() as i32]);
    m.skin_texcoordadr = addresses(list.iter().map(|s| s.texcoord.len()));
    for (address, s) in m.skin_texcoordadr.iter_mut().zip(&list) {
        *address = if s.texcoord.is_empty() { -1 } else { *address };
    }
    m.skin_faceadr = addresses(list.iter().map(|s| s.face.len()));
    flat(&mut m.skin_facenum, &list, |s| [s.face.len() as i32]);
    m.skin_boneadr = addresses(list.iter().map(|s| s.bones.len()));
    flat(&mut m.skin_bonenum, &list, |s| [s.bones.len() as i32]);
    m.skin_vert = listed(list.iter().flat_map(|s| single(&s.vert)));
    m.skin_texcoord =
        listed(list.iter().flat_map(|s| s.texcoord.as_flattened()).map(|&x| f64::from(x as f32)));
    m.skin_face = listed(list.iter().flat_map(|s| s.face.as_flattened()).copied());
    m.skin_bonevertadr = addresses(bones.iter().map(|b| b.vertid.len()));
    flat(&mut m.skin_bonevertnum, &bones, |b| [b.vertid.len() as i32]);
    flat(&mut m.skin_bonebindpos, &bones, |b| single_each(b.bindpos));
    flat(&mut m.skin_bonebindquat, &bones, |b| single_each(b.bindquat));
    flat(&mut m.skin_bonebodyid, &bones, |b| [bodies.find(Some(&b.body))]);
    m.skin_bonevertid = listed(bones.iter().flat_map(|b| &b.vertid).copied());
    m.skin_bonevertweight = listed(bones.iter().flat_map(|b| &b.vertweight).map(|&x| f64::from(x as f32)));
    m.names.skin = listed(assets.skins.iter().map(|a| a.name.clone()));
}
