//! `asset`: meshes, height fields and skins, from text, files and rules, numbered in the order of the text.

use crate::mjcf::gather::{filled, listed};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::hfield::HField;
use super::mesh::{self, AssetProblem, CompiledMesh, MeshBody, Raw};
use super::skin::{self, Bone, Skin};
use crate::kinds::geom;
use crate::math::{IDENTITY, norm};
use crate::mjcf::asset::mesh::build::{self, MeshOptions};
use crate::mjcf::classes::{Classes, Props};
use crate::mjcf::expand::AttachedModel;
use crate::mjcf::names::{NameTable, WORLD};
use crate::mjcf::rules::{self, Rule};
use crate::mjcf::spec::{BodySpec, PairSpec};
use crate::mjcf::text::diagnostic::{Diagnostics, shorten_name};
use crate::mjcf::text::load;
use crate::mjcf::text::tree::{ElementNode, ElementTree, name};
use crate::source::files::{Files, MAX_FILE};

/// Limit in bytes for all files, vertices and triangles of meshes, and samples of height fields together. Without it, a small
/// text could request any amount.
const MOST: usize = 256 << 20;
/// The bytes that a vertex, a triangle or a sample counts for.
const EACH: usize = 32;
/// The smallest limit for the corners of a hull: those of a tetrahedron.
const FEWEST_CORNERS: i32 = 4;

/// An asset with a name. The value is `None` if it could not be built; the error is already reported.
#[derive(Debug)]
pub(crate) struct Asset<T> {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    pub(crate) value: Option<T>,
}

/// All meshes, height fields and skins.
#[derive(Debug, Default)]
pub(crate) struct Assets {
    pub(crate) meshes: Vec<Asset<CompiledMesh>>,
    pub(crate) hfields: Vec<Asset<HField>>,
    pub(crate) skins: Vec<Asset<Skin>>,
    /// The default materials of meshes, by mesh.
    materials: Vec<Option<String>>,
    /// Ids by kind and name.
    ids: BTreeMap<(&'static str, String), usize>,
}

/// The inputs for reading assets.
struct AssetReader<'a> {
    parts: &'a [AttachedModel],
    files: &'a dyn Files,
    /// The remaining part of [`MOST`].
    left: usize,
    report: &'a mut Diagnostics,
}

impl Assets {
    /// Reads all sections.
    pub(crate) fn read(
        tree: &ElementTree,
        classes: &Classes,
        parts: &[AttachedModel],
        files: &dyn Files,
        report: &mut Diagnostics,
    ) -> Assets {
        let mut assets = Assets::default();
        let mut reader = AssetReader { parts, files, left: MOST, report };
        for (_, node) in tree.sections("asset").flat_map(|(index, _)| tree.children(index)) {
            if reader.report.is_full() {
                break;
            }
            let (name, span) = (name(node), node.span.clone());
            let id = match node.element.name {
                "mesh" => {
                    let p = classes.props(node, None);
                    let value = reader.mesh(node, &p);
                    assets.materials.push(p.text("material").map(str::to_string));
                    assets.meshes.push(Asset { name: name.clone(), span, value });
                    assets.meshes.len() - 1
                }
                "hfield" => {
                    let value = reader.hfield(node);
                    assets.hfields.push(Asset { name: name.clone(), span, value });
                    assets.hfields.len() - 1
                }
                _ => continue,
            };
            if name.is_empty() {
                let message = format!("{} has no name", node.describe());
                reader
                    .report
                    .error(rules::MISSING_ATTRIBUTE, node.span.clone(), message)
                    .why("nothing can refer to it")
                    .help("write `name=\"…\"`");
            }
            assets.ids.entry((node.element.name, name)).or_insert(id);
        }
        let sections = tree.sections("asset").chain(tree.sections("deformable"));
        for (index, node) in sections.flat_map(|(index, _)| tree.children(index)) {
            if node.element.name == "skin" && !reader.report.is_full() {
                let value = reader.skin(tree, index, node);
                assets.skins.push(Asset { name: name(node), span: node.span.clone(), value });
            }
        }
        assets
    }

    /// The id of an asset.
    fn id(&self, kind: &'static str, name: &str) -> Option<usize> {
        self.ids.get(&(kind, name.to_string())).copied()
    }

    /// A mesh and its id, if it could be built.
    pub(crate) fn mesh(&self, name: &str) -> Option<(i32, &CompiledMesh)> {
        let id = self.id("mesh", name)?;
        Some((id as i32, self.meshes.get(id)?.value.as_ref()?))
    }

    /// A height field and its id, if it could be built.
    pub(crate) fn hfield(&self, name: &str) -> Option<(i32, &HField)> {
        let id = self.id("hfield", name)?;
        Some((id as i32, self.hfields.get(id)?.value.as_ref()?))
    }

    /// The default material of a mesh.
    pub(crate) fn material(&self, mesh: &str) -> Option<&str> {
        self.materials.get(self.id("mesh", mesh)?)?.as_deref()
    }

    /// Checks that the bodies that skin files name as bones exist after `fusestatic`. Bodies that the text itself refers to are
    /// never fused.
    pub(crate) fn check_bones(&self, bodies: &[BodySpec], names: &NameTable, report: &mut Diagnostics) {
        let used: BTreeSet<&str> = filled(bodies.iter().map(|b| b.name.as_str()));
        for bone in self.skins.iter().filter_map(|a| a.value.as_ref()).flat_map(|s| &s.bones) {
            let Some(span) = bone.file.clone().filter(|_| !report.is_full()) else { continue };
            if names.find("body", &bone.body).is_none() {
                names.unknown("body", &bone.body, span, report);
            } else if bone.body != WORLD && !used.contains(bone.body.as_str()) {
                let message = format!("the bone {} has become part of its parent", shorten_name(&bone.body));
                report
                    .error(rules::SKIN, span, message)
                    .why("`fusestatic` removes bodies without joints unless the text refers to them")
                    .help("refer to the body in the text, or delete `fusestatic`");
            }
        }
    }

    /// Computes the hulls of the meshes that can collide, and of those of sites.
    pub(crate) fn hulls(&mut self, bodies: &[BodySpec], pairs: &[PairSpec], report: &mut Diagnostics) {
        let geoms: Vec<_> = listed(bodies.iter().flat_map(|b| &b.geoms));
        let touching = geoms.iter().filter(|g| g.contype != 0 || g.conaffinity != 0);
        let paired = pairs.iter().flat_map(|p| p.geoms).filter_map(|g| geoms.get(usize::try_from(g).ok()?));
        let of_geoms = touching.chain(paired).filter(|g| g.kind == geom::MESH).map(|g| g.data);
        let of_sites = bodies.iter().flat_map(|b| &b.sites).filter(|s| s.kind == geom::MESH).map(|s| s.data);
        for id in of_geoms.chain(of_sites) {
            let Some(asset) = usize::try_from(id).ok().and_then(|id| self.meshes.get_mut(id)) else {
                continue;
            };
            let Some(mesh) = asset.value.as_mut().filter(|m| m.hull.is_none()) else { continue };
            match build::hull(mesh) {
                Ok(hull) => mesh.hull = Some(hull),
                Err(problem) => {
                    report_problem(
                        problem,
                        rules::MESH,
                        &format!("mesh `{}`", asset.name),
                        asset.span.clone(),
                        report,
                    );
                    asset.value = None;
                }
            }
        }
    }
}

/// Reports a problem with an asset.
fn report_problem(
    problem: AssetProblem,
    code: &'static Rule,
    owner: &str,
    span: Range<usize>,
    report: &mut Diagnostics,
) {
    let mut d = report.error(code, span, format!("{owner} {}", problem.message));
    if !problem.why.is_empty() {
        d = d.why(problem.why);
    }
    d.help(problem.help);
}

impl AssetReader<'_> {
    fn mesh(&mut self, node: &ElementNode, p: &Props) -> Option<CompiledMesh> {
        let options = self.options(node, p)?;
        let made = self.raw(node, p)?.and_then(|(raw, surface)| {
            let body = if surface && !p.has("inertia") { MeshBody::Shell } else { options.body };
            build::mesh(raw, MeshOptions { body, ..options })
        });
        match made {
            Ok(mesh) => Some(mesh),
            Err(problem) => self.wrong(problem, rules::MESH, node, p),
        }
    }

    fn wrong<T>(
        &mut self,
        problem: AssetProblem,
        code: &'static Rule,
        node: &ElementNode,
        p: &Props,
    ) -> Option<T> {
        let span = p.span(problem.attribute).unwrap_or(node.span.clone());
        report_problem(problem, code, &node.describe(), span, self.report);
        None
    }

    fn options(&mut self, node: &ElementNode, p: &Props) -> Option<MeshOptions> {
        let refquat = p.reals("refquat", IDENTITY);
        let maxhullvert = p.int("maxhullvert").unwrap_or(-1);
        let problem = if quaternion_norm(refquat) < crate::math::MINVAL {
            AssetProblem::new(
                "refquat",
                "has a `refquat` of zero",
                "it does not describe a rotation",
                "write `1 0 0 0` for no rotation",
            )
        } else if maxhullvert != -1 && maxhullvert < FEWEST_CORNERS {
            AssetProblem::new(
                "maxhullvert",
                format!("has a hull of at most {maxhullvert} corners"),
                "the smallest solid has four corners",
                "write 4 or more, or -1 for no limit",
            )
        } else {
            return Some(MeshOptions {
                scale: p.reals("scale", [1.0; 3]),
                refpos: p.reals("refpos", [0.0; 3]),
                refquat,
                smooth: p.flag("smoothnormal", false),
                maxhullvert: usize::try_from(maxhullvert).ok(),
                body: match p.keyword("inertia") {
                    Some(0) => MeshBody::Convex,
                    Some(1) => MeshBody::Exact,
                    Some(3) => MeshBody::Shell,
                    _ => MeshBody::Legacy,
                },
            });
        };
        self.wrong(problem, rules::MESH, node, p)
    }

    /// The data of a mesh, and whether it is an open surface. `None` if its file cannot be read.
    fn raw(&mut self, node: &ElementNode, p: &Props) -> Option<Result<(Raw, bool), AssetProblem>> {
        let sources: Vec<&str> = listed(["builtin", "file", "vertex"].into_iter().filter(|a| p.has(a)));
        if let [_, second, ..] = sources[..] {
            return Some(Err(AssetProblem::new(
                second,
                format!("has {}", listed(sources.iter().map(|s| format!("`{s}`"))).join(" and ")),
                "each of them gives the shape of the mesh",
                "keep one of them",
            )));
        }
        let made = match (p.text("builtin"), p.text("file")) {
            (Some(rule), _) => mesh::builtin::make(rule, p.list("params").unwrap_or(&[])).and_then(|made| {
                if made.0.normal.is_empty() {
                    chunks::<3>(p, "normal")?;
                }
                texcoords(&chunks(p, "texcoord")?, made.0.vert.len())?;
                Ok(made)
            }),
            (_, Some(_)) => {
                let (path, bytes) = self.file(node, p)?;
                mesh::decode(&path, p.text("content_type").unwrap_or(""), &bytes).map(|raw| (raw, false))
            }
            _ => written(p).map(|raw| (raw, false)),
        };
        Some(made.and_then(|(raw, surface)| {
            let count = raw.vert.len() + raw.face.len() + raw.normal.len();
            self.take(EACH * count).map(|()| (raw, surface))
        }))
    }

    /// Subtracts bytes from the remaining limit.
    fn take(&mut self, bytes: usize) -> Result<(), AssetProblem> {
        match self.left.checked_sub(bytes) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(AssetProblem::new(
                "",
                "exceeds the size limit",
                "all meshes and height fields together are larger than a lesson can need",
                "simplify them",
            )),
        }
    }

    /// Reads the file of an asset and returns its path and its bytes.
    fn file(&mut self, node: &ElementNode, p: &Props) -> Option<(String, Vec<u8>)> {
        let AttachedModel { compiler, folder } = self.parts.get(node.model)?;
        let mut written = p.text("file")?.to_string();
        if compiler.strippath
            && let Some((_, name)) = written.rsplit_once(['/', '\\'])
        {
            written = name.to_string();
        }
        if !compiler.meshdir.is_empty() {
            written = format!("{}/{written}", compiler.meshdir);
        }
        let span = p.span("file").unwrap_or(node.span.clone());
        let (path, bytes) =
            load::read(self.files, &written, folder, MAX_FILE.min(self.left), &span, self.report)?;
        self.left -= bytes.len().min(self.left);
        Some((path, bytes))
    }

    fn hfield(&mut self, node: &ElementNode) -> Option<HField> {
        let p = Props::written_props(node);
        let samples = if p.has("file") && p.text("file").is_none() {
            Err(AssetProblem::new("file", "names no file", "", "write the name of a file, or remove `file`"))
        } else if p.text("file").is_some() {
            let (path, bytes) = self.file(node, &p)?;
            super::hfield::decode(&path, p.text("content_type").unwrap_or(""), &bytes)
        } else {
            let (nrow, ncol) = (p.int("nrow").unwrap_or(0), p.int("ncol").unwrap_or(0));
            super::hfield::written(nrow, ncol, p.list("elevation").unwrap_or(&[]))
        };
        let made = samples
            .and_then(|samples| HField::new(samples, p.list("size").unwrap_or(&[])))
            .and_then(|field| self.take(EACH / 2 * field.data.len()).map(|()| field));
        match made {
            Ok(field) => {
                if field.nrow < 2 || field.ncol < 2 {
                    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
                    let (rows, columns) = (count(field.nrow, "row"), count(field.ncol, "column"));
                    let message = format!("{} has {rows} and {columns}", node.describe());
                    self.report
                        .warning(rules::NO_EFFECT, node.span.clone(), message)
                        .why("the surface spans neighbouring rows and columns: without two of each there is no surface, and bodies fall through, in MuJoCo too")
                        .help("give it at least two rows and two columns, or use a plane");
                }
                Some(field)
            }
            Err(problem) => self.wrong(problem, rules::HFIELD, node, &p),
        }
    }
}

/// The largest group of a skin.
const MAX_GROUP: i32 = 5;

impl AssetReader<'_> {
    fn skin(&mut self, tree: &ElementTree, index: usize, node: &ElementNode) -> Option<Skin> {
        let p = Props::written_props(node);
        let group = p.int("group").unwrap_or(0);
        if !(0..=MAX_GROUP).contains(&group) {
            let problem =
                AssetProblem::new("group", format!("is in group {group}"), "", "groups of skins are 0 to 5");
            return self.wrong(problem, rules::VALUE, node, &p);
        }
        let bone_nodes: Vec<&ElementNode> = listed(tree.children(index).map(|(_, bone)| bone));
        let made = if p.text("file").is_some() {
            let (path, bytes) = self.file(node, &p)?;
            let written = ["vertex", "texcoord", "face"].into_iter().find(|a| p.has(a));
            if written.is_some() || !bone_nodes.is_empty() {
                Err(AssetProblem::new(
                    written.unwrap_or("file"),
                    "has both a file and inline data",
                    "the file contains vertices, triangles and bones",
                    "keep one of them",
                ))
            } else {
                skin::decode(&path, &bytes, &p.span("file").unwrap_or(node.span.clone()))
            }
        } else {
            let bones: Vec<Bone> = listed(bone_nodes.iter().filter_map(|bone| self.bone(bone)));
            if bones.len() < bone_nodes.len() {
                return None;
            }
            written(&p).map(|raw| Skin {
                vert: raw.vert,
                texcoord: raw.texcoord,
                face: raw.face,
                bones,
                ..Skin::default()
            })
        };
        let made = made.and_then(Skin::complete).and_then(|skin| {
            let carried: usize = skin.bones.iter().map(|b| b.vertid.len()).sum();
            let count = skin.vert.len() + skin.face.len() + carried;
            self.take(EACH * count).map(|()| skin)
        });
        match made {
            Ok(skin) => Some(Skin {
                material: p.text("material").map(str::to_string),
                rgba: p.reals("rgba", [0.5, 0.5, 0.5, 1.0]),
                inflate: p.real("inflate").unwrap_or(0.0),
                group,
                ..skin
            }),
            Err(problem) => self.wrong(problem, rules::SKIN, node, &p),
        }
    }

    /// Reads a bone. All its attributes are required.
    fn bone(&mut self, node: &ElementNode) -> Option<Bone> {
        let p = Props::written_props(node);
        let missing =
            ["body", "bindpos", "bindquat", "vertid", "vertweight"].into_iter().find(|a| match *a {
                "body" => p.text(a).is_none(),
                _ => !p.has(a),
            });
        if let Some(attribute) = missing {
            let message = format!("{} has no `{attribute}`", node.describe());
            self.report.error(rules::MISSING_ATTRIBUTE, node.span.clone(), message).help(format!(
                "write `{attribute}=\"…\"`: a bone is a body, its pose, and the vertices that it carries with their weights"
            ));
            return None;
        }
        Some(Bone {
            body: p.text("body")?.to_string(),
            bindpos: p.reals("bindpos", [0.0; 3]),
            bindquat: p.reals("bindquat", IDENTITY),
            vertid: p.ints("vertid").unwrap_or(&[]).to_vec(),
            vertweight: p.list("vertweight").unwrap_or(&[]).to_vec(),
            file: None,
        })
    }
}

fn quaternion_norm(q: [f64; 4]) -> f64 {
    norm([norm([q[0], q[1], q[2]]), q[3], 0.0])
}

/// A mesh whose data are in its attributes.
fn written(p: &Props) -> Result<Raw, AssetProblem> {
    let raw = Raw {
        vert: chunks(p, "vertex")?,
        normal: chunks(p, "normal")?,
        texcoord: chunks(p, "texcoord")?,
        face: p.ints("face").unwrap_or(&[]).as_chunks().0.to_vec(),
        ..Raw::default()
    };
    let count = p.ints("face").map_or(0, <[i32]>::len);
    if !count.is_multiple_of(3) {
        return Err(not_whole("face", count, 3));
    }
    texcoords(&raw.texcoord, raw.vert.len())?;
    Ok(raw)
}

/// Checks that there is a pair for each vertex, or none at all.
fn texcoords(pairs: &[[f64; 2]], vertices: usize) -> Result<(), AssetProblem> {
    if pairs.is_empty() || pairs.len() == vertices {
        return Ok(());
    }
    Err(AssetProblem::new(
        "texcoord",
        format!("has {} texture coordinates for {vertices} vertices", pairs.len()),
        "",
        "write a pair of numbers for each vertex",
    ))
}

/// Groups of `N` numbers, rounded to single precision as in files.
fn chunks<const N: usize>(p: &Props, name: &'static str) -> Result<Vec<[f64; N]>, AssetProblem> {
    let list = p.list(name).unwrap_or(&[]);
    match list.as_chunks() {
        (chunks, []) => Ok(listed(chunks.iter().map(|c| c.map(|x| f64::from(x as f32))))),
        _ => Err(not_whole(name, list.len(), N)),
    }
}

fn not_whole(name: &'static str, count: usize, group: usize) -> AssetProblem {
    AssetProblem::new(
        name,
        format!("has {count} numbers in `{name}`"),
        "",
        if group == 3 { "write three numbers for each" } else { "write two numbers for each" },
    )
}
