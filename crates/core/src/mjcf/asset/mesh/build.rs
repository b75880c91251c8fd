//! Converts mesh data to a mesh in its own frame: reference frame and scale, centre of mass, principal axes.

use super::bulk;
use super::bulk::Mass;
use super::bulk::MeshBody;
use super::normals;
use crate::math::{IDENTITY, MINVAL, Quat, Vec3, mat_t_mul_vec, quat_normalize, quat_to_mat, sub};
use crate::mjcf::asset::mesh::{AssetProblem, CompiledMesh, ConvexHull, Flat, Raw, triangle};
use crate::mjcf::body::inertia::principal_to;
use crate::mjcf::gather::listed;
use labspec_finding::order;

/// The accuracy of the principal axes, and the relative difference above which moments count as different, as a fraction of the
/// largest element of the inertia. Measured on MuJoCo 3.14.0 with rotated boxes whose sides differ slightly.
const AXES: f64 = 1e-7;

/// The parameters of a mesh asset, besides its data.
#[derive(Clone, Debug)]
pub(crate) struct MeshOptions {
    pub(crate) scale: Vec3,
    /// The reference frame, in which the mesh is expressed.
    pub(crate) refpos: Vec3,
    pub(crate) refquat: Quat,
    pub(crate) smooth: bool,
    pub(crate) maxhullvert: Option<usize>,
    pub(crate) body: MeshBody,
}

impl MeshOptions {
    /// Whether the scale mirrors the mesh.
    fn mirrors(&self) -> bool {
        self.scale.iter().product::<f64>() < 0.0
    }
}

/// Builds a mesh. Computes its convex hull only if the mesh itself depends on it; other code calls [`hull`].
pub(crate) fn mesh(mut raw: Raw, options: MeshOptions) -> Result<CompiledMesh, AssetProblem> {
    check_faces(&raw, options.body)?;
    let written = raw.vert.clone();
    let mut own_hull = None;
    if raw.face.is_empty() || options.body == MeshBody::Convex {
        own_hull = Some(unscaled_hull(&written, &options)?);
    }
    if let Some(hull) = own_hull.as_ref().filter(|_| raw.face.is_empty()) {
        raw.face.clone_from(&hull.face);
    }
    if raw.normal.is_empty() {
        raw.normal = normals::of_vertices(&raw.vert, &raw.face, options.smooth);
        raw.facenormal.clear();
    }
    if raw.facenormal.is_empty() {
        raw.facenormal.clone_from(&raw.face);
    }
    if raw.facetexcoord.is_empty() && !raw.texcoord.is_empty() {
        raw.facetexcoord.clone_from(&raw.face);
    }
    place(&mut raw, &options);
    if options.mirrors() {
        let lists = [&mut raw.face, &mut raw.facenormal, &mut raw.facetexcoord].into_iter();
        lists.chain(own_hull.as_mut().map(|h| &mut h.face)).flatten().for_each(|f| f.swap(1, 2));
    }
    let solid = own_hull.as_ref().filter(|_| options.body == MeshBody::Convex).map_or(&raw.face, |h| &h.face);
    let Mass { amount, centre, inertia } = mass(&raw.vert, &raw.face, solid, options.body)?;
    let largest = inertia.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
    let (moments, quat) = principal_to(AXES * largest, inertia);
    let [a, b, c] = moments;
    let most = a.max(b).max(c);
    if c.min(b).min(a) <= 0.0 || !most.is_finite() || a + b + c - 2.0 * most < -1e-6 * most - 1e-9 {
        return Err(AssetProblem::new(
            "inertia",
            format!("has the principal moments {a}, {b}, {c} for a density of one, which no body has"),
            "its triangles do not enclose a volume, or have different orientations",
            "repair the mesh, or write `inertia=\"convex\"` for the inertia of its convex hull",
        ));
    }
    let edge = |i: f64| 0.5 * libm::sqrt((6.0 * i / amount).max(0.0));
    let half = [edge(b + c - a), edge(a + c - b), edge(a + b - c)];

    let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let axes = quat_to_mat(quat);
    for v in &mut raw.vert {
        *v = mat_t_mul_vec(&axes, sub(*v, centre));
        (lower, upper) =
            (std::array::from_fn(|i| lower[i].min(v[i])), std::array::from_fn(|i| upper[i].max(v[i])));
    }
    raw.normal.iter_mut().for_each(|n| *n = mat_t_mul_vec(&axes, *n));
    Ok(CompiledMesh {
        shape: raw,
        written,
        hull: own_hull,
        options,
        pos: centre,
        quat,
        amount,
        half,
        lower,
        upper,
    })
}

/// The convex hull of a mesh.
pub(crate) fn hull(mesh: &CompiledMesh) -> Result<ConvexHull, AssetProblem> {
    let mut hull = unscaled_hull(&mesh.written, &mesh.options)?;
    if mesh.options.mirrors() {
        hull.face.iter_mut().for_each(|f| f.swap(1, 2));
    }
    Ok(hull)
}

/// The convex hull of the vertices before scaling.
fn unscaled_hull(written: &[Vec3], options: &MeshOptions) -> Result<ConvexHull, AssetProblem> {
    ConvexHull::from_points(written, options.maxhullvert).map_err(|flat| {
        let (what, help) = match flat {
            Flat::Point => ("has all its vertices in one place", "write a small sphere instead"),
            Flat::Line => ("has all its vertices on a line", "write a thin capsule instead"),
            Flat::Plane => (
                "has all its vertices in a plane",
                "write a thin box instead; a mesh without contacts (`contype=\"0\" conaffinity=\"0\"`) may be flat with `inertia=\"shell\"`",
            ),
            Flat::Endless => ("has a convex hull that is too hard to find", "use fewer vertices"),
        };
        AssetProblem::new("", what, "the convex hull of a mesh makes the contacts, so it must have a volume", help)
    })
}

/// Checks that the data suffice for a mesh.
fn check_faces(raw: &Raw, body: MeshBody) -> Result<(), AssetProblem> {
    let count = raw.vert.len();
    if count < 4 {
        return Err(AssetProblem::new(
            "vertex",
            format!("has {count} vertices"),
            "the smallest solid has four corners",
            "write at least four vertices",
        ));
    }
    if let Some(i) = raw.vert.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
        return Err(AssetProblem::new(
            "vertex",
            format!("has vertex {i} at a position that is not finite"),
            "",
            "write finite numbers",
        ));
    }
    for (i, face) in raw.face.iter().enumerate() {
        if let Some(&v) = face.iter().find(|&&v| usize::try_from(v).map_or(true, |v| v >= count)) {
            return Err(AssetProblem::new(
                "face",
                format!(
                    "has vertex {v} in triangle {i}, but its {count} vertices are numbered 0 to {}",
                    count - 1
                ),
                "",
                "number vertices from 0 in the order of `vertex`",
            ));
        }
    }
    if body == MeshBody::Exact { check_orientation(raw) } else { Ok(()) }
}

/// Checks that neighbouring triangles have the same orientation: the two traverse their common edge in opposite directions.
fn check_orientation(raw: &Raw) -> Result<(), AssetProblem> {
    let corner = |v: i32| raw.vert.get(v as usize).copied().unwrap_or_default();
    let solid = |f: &&[i32; 3]| triangle(f.map(corner)).0 > libm::sqrt(MINVAL);
    let mut edges: Vec<(i32, i32)> =
        listed(raw.face.iter().filter(solid).flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]));
    order::sort_by(&mut edges, Ord::cmp);
    match edges.windows(2).find(|pair| pair[0] == pair[1]) {
        None => Ok(()),
        Some(pair) => Err(AssetProblem::new(
            "face",
            format!(
                "has triangles with opposite orientations at the edge of vertices {} and {}",
                pair[0].0, pair[0].1
            ),
            "an exact inertia needs the outer side of each triangle",
            "order the corners of every triangle counterclockwise as seen from outside, or write `inertia=\"legacy\"`",
        )),
    }
}

/// Transforms vertices and normals to the reference frame and scales them.
fn place(raw: &mut Raw, options: &MeshOptions) {
    let MeshOptions { scale, refpos, refquat, .. } = options;
    let turn = quat_to_mat(quat_normalize(*refquat));
    for v in &mut raw.vert {
        *v = sub(*v, *refpos);
        if *refquat != IDENTITY {
            *v = mat_t_mul_vec(&turn, *v);
        }
        *v = std::array::from_fn(|i| v[i] * scale[i]);
    }
    // A normal transforms like the area element that it belongs to: it is scaled along each axis by the product of the other two
    // scales.
    let [x, y, z] = *scale;
    let area = [y * z, x * z, x * y].map(|a| if options.mirrors() { -a } else { a });
    for n in &mut raw.normal {
        let turned = mat_t_mul_vec(&turn, *n);
        *n = normals::unit(std::array::from_fn(|i| turned[i] * area[i]));
    }
}

/// The mass properties of the body that a mesh represents.
fn mass(vert: &[Vec3], face: &[[i32; 3]], solid: &[[i32; 3]], body: MeshBody) -> Result<Mass, AssetProblem> {
    let triangles = |faces| bulk::triangles(vert, faces);
    let (area, middle) = bulk::surface(triangles(face));
    if area < MINVAL || !area.is_finite() {
        return Err(AssetProblem::new(
            "",
            format!("has triangles with a total area of {area:.1e} square metres"),
            "such a small or large surface cannot have a mass",
            "check `scale`: the mesh is in metres, and no axis may be scaled by zero",
        ));
    }
    let solid = if body == MeshBody::Shell { face } else { solid };
    let (amount, centre) = bulk::volume_and_centre(triangles(solid), body, middle);
    if amount < 0.0 {
        return Err(AssetProblem::new(
            "face",
            "is inside out: its triangles enclose a negative volume",
            "an exact inertia needs the outer side of each triangle",
            "order the corners of every triangle counterclockwise as seen from outside, or write `inertia=\"legacy\"`",
        ));
    }
    if amount < MINVAL || !amount.is_finite() {
        return Err(AssetProblem::new(
            "",
            format!("encloses {amount:.1e} cubic metres"),
            "a body without volume has no mass",
            "check `scale`: the mesh is in metres; for an open or flat surface write `inertia=\"shell\"`",
        ));
    }
    Ok(bulk::inertia_about(triangles(solid), body, centre))
}
