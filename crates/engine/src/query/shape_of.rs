//! The shapes of geoms and sites of a model, at their poses in the data.

use crate::geometry::{HeightField, Hull, Mesh, Shape};
use crate::kinds::geom;
use crate::math::*;
use crate::model::index::element_range;
use crate::model::{Fields, Model};

impl<'a> Shape<'a> {
    /// The shape of geom `g`.
    pub(crate) fn geom(m: &'a Model, d: &Fields, g: usize) -> Shape<'a> {
        let (size, pos, mat) =
            (rows::<3>(&m.geom_size)[g], rows::<3>(&d.geom_xpos)[g], rows::<9>(&d.geom_xmat)[g]);
        let mut shape = Shape::new(m.geom_type[g], size, pos, mat);
        if let Ok(id) = usize::try_from(m.geom_dataid[g]) {
            match shape.kind {
                geom::MESH => shape.mesh = Some(Mesh::from_model(m, id)),
                geom::HFIELD => shape.field = Some(HeightField::from_model(m, id)),
                _ => {}
            }
        }
        shape
    }

    /// The shape of site `s`.
    pub(crate) fn site(m: &'a Model, d: &Fields, s: usize) -> Shape<'a> {
        let (size, pos, mat) =
            (rows::<3>(&m.site_size)[s], rows::<3>(&d.site_xpos)[s], rows::<9>(&d.site_xmat)[s]);
        let mut shape = Shape::new(m.site_type[s], size, pos, mat);
        if let Ok(id) = usize::try_from(m.site_dataid[s]) {
            shape.mesh = Some(Mesh::from_model(m, id));
        }
        shape
    }
}

impl<'a> Mesh<'a> {
    /// Mesh `id` of a model.
    pub(crate) fn from_model(m: &'a Model, id: usize) -> Mesh<'a> {
        let range = |adr: &[i32], num: &[i32]| element_range(adr[id], num[id]);
        Mesh {
            vert: &rows::<3>(&m.mesh_vert)[range(&m.mesh_vertadr, &m.mesh_vertnum)],
            face: &m.mesh_face.as_chunks().0[range(&m.mesh_faceadr, &m.mesh_facenum)],
            hull: usize::try_from(m.mesh_graphadr[id])
                .ok()
                .and_then(|adr| Hull::from_graph(&m.mesh_graph[adr..])),
            hull_faces: m.mesh_sides.get(id),
        }
    }
}

impl<'a> HeightField<'a> {
    /// Height field `id` of a model.
    pub(crate) fn from_model(m: &'a Model, id: usize) -> HeightField<'a> {
        let (nrow, ncol) = (m.hfield_nrow[id].max(0) as usize, m.hfield_ncol[id].max(0) as usize);
        let first = m.hfield_adr[id].max(0) as usize;
        let data = &m.hfield_data[first..first + nrow * ncol];
        HeightField { size: rows::<4>(&m.hfield_size)[id], nrow, ncol, data }
    }
}
