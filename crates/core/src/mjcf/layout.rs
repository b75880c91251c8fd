//! Ids and addresses: which bodies are welded together, kinematic trees, the ancestors of each degree of freedom, and
//! the sparsity pattern of the mass matrix.

use super::spec::{BodySpec, Inertia};
use crate::kinds::{joint, simple};
use crate::math::{Quat, Vec3};
use crate::mjcf::body::inertia::describe_body;
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Diagnostics;

/// Limit for the entries of the mass matrix. A long chain with many branches exceeds it.
const MAX_MATRIX: usize = 20_000_000;

/// The structure of the trees, by body and by degree of freedom.
#[derive(Debug, Default)]
pub(crate) struct TreeLayout {
    pub(crate) root: Vec<usize>,
    pub(crate) weld: Vec<usize>,
    /// Kinematic tree of the body, -1 if it cannot move.
    pub(crate) body_tree: Vec<i32>,
    pub(crate) mocap: Vec<i32>,
    pub(crate) nmocap: usize,
    /// Body, joint, parent and tree of each degree of freedom.
    pub(crate) dofs: Vec<Dof>,
    /// The first degree of freedom of each body, and their number.
    pub(crate) body_dofs: Vec<(usize, usize)>,
    pub(crate) ntree: usize,
    pub(crate) nq: usize,
}

/// A degree of freedom.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dof {
    pub(crate) body: usize,
    pub(crate) joint: usize,
    pub(crate) parent: Option<usize>,
    pub(crate) tree: usize,
}

/// Assigns all ids and addresses. The parent of a body precedes it.
pub(crate) fn number(bodies: &[BodySpec]) -> TreeLayout {
    let mut l = TreeLayout::default();
    // The last degree of freedom on the path from the root to each body, including those of the body.
    let mut last: Vec<Option<usize>> = Vec::with_capacity(bodies.len());
    let mut joints = 0;
    for (i, body) in bodies.iter().enumerate() {
        let parent_root = l.root.get(body.parent).copied().unwrap_or(0);
        l.root.push(if parent_root == 0 { i } else { parent_root });
        let fixed = body.joints.is_empty() && !body.mocap;
        let parent_weld = l.weld.get(body.parent).copied().unwrap_or(0);
        l.weld.push(if fixed && i > 0 { parent_weld } else { i });
        l.mocap.push(if body.mocap { l.nmocap as i32 } else { -1 });
        l.nmocap += usize::from(body.mocap);

        let mut chain = last.get(body.parent).copied().flatten();
        let first = l.dofs.len();
        for j in &body.joints {
            for _ in 0..joint::nv(j.kind) {
                let tree = match chain.and_then(|c| l.dofs.get(c)) {
                    Some(parent) => parent.tree,
                    None => {
                        l.ntree += 1;
                        l.ntree - 1
                    }
                };
                l.dofs.push(Dof { body: i, joint: joints, parent: chain, tree });
                chain = Some(l.dofs.len() - 1);
            }
            l.nq += joint::nq(j.kind);
            joints += 1;
        }
        l.body_dofs.push((first, l.dofs.len() - first));
        l.body_tree.push(chain.and_then(|c| l.dofs.get(c)).map_or(-1, |d| d.tree as i32));
        last.push(chain);
    }
    l
}

/// Reports models beyond the limits, and invalid joints and mocap bodies.
pub(crate) fn check_sizes(bodies: &[BodySpec], layout: &TreeLayout, report: &mut Diagnostics) {
    within_limits(bodies, layout, report);
    for (i, body) in bodies.iter().enumerate().skip(1) {
        check_joints(body, report);
        if body.mocap && (body.parent != 0 || !body.joints.is_empty()) {
            let what = if body.parent == 0 { "has joints" } else { "is not a child of the world" };
            report
                .error(
                    rules::MOCAP,
                    body.span.clone(),
                    format!("{} is a mocap body, but {what}", describe_body(body)),
                )
                .why("a mocap body is moved from outside: `data.mocap_pos` is its position in the world")
                .help("make it a child of `worldbody` without joints");
        }
        let moves = layout.body_tree.get(i).is_some_and(|&t| t >= 0);
        for g in body.geoms.iter().filter(|g| g.only_static && moves) {
            report
                .error(
                    rules::GEOM,
                    g.span.clone(),
                    format!("a plane is in {}, which can move", describe_body(body)),
                )
                .why("a plane is infinite and has no mass")
                .help("put it into `worldbody`, or use another shape");
        }
    }
}

/// Checks the limits for geoms and degrees of freedom. Collision detection tests pairs of geoms, and every degree of freedom is
/// coupled with all its ancestors, so that a very large model would take much memory and hours without a message.
fn within_limits(bodies: &[BodySpec], layout: &TreeLayout, report: &mut Diagnostics) {
    let geoms: usize = bodies.iter().map(|b| b.geoms.len()).sum();
    let mut depth: Vec<usize> = Vec::with_capacity(layout.dofs.len());
    for dof in &layout.dofs {
        depth.push(1 + dof.parent.and_then(|p| depth.get(p)).unwrap_or(&0));
    }
    let counts = [
        (layout.dofs.len(), super::MAX_DOFS, "degrees of freedom"),
        (depth.iter().sum(), super::MAX_MASS, "pairs of degrees of freedom that move each other"),
        (geoms, super::MAX_GEOMS, "geoms"),
    ];
    for (n, most, what) in counts {
        if n > most {
            report
                .error(rules::LIMIT, 0..0, format!("the model has {n} {what}; the limit is {most}"))
                .why("larger scenes would need minutes for one step")
                .help("remove what the lesson does not need");
        }
    }
}

fn check_joints(body: &BodySpec, report: &mut Diagnostics) {
    let mut dofs = 0;
    let mut after_ball = false;
    for j in &body.joints {
        let rotates = matches!(j.kind, joint::BALL | joint::HINGE);
        if j.kind == joint::FREE && body.parent != 0 {
            report
                .error(
                    rules::JOINT,
                    j.span.clone(),
                    format!("a free joint is in {}, which is not a child of the world", describe_body(body)),
                )
                .why("a free joint gives the pose in the world, whatever the parent does")
                .help("move the body to `worldbody`, or use ball and slide joints");
        }
        if after_ball && rotates {
            report
                .error(
                    rules::JOINT,
                    j.span.clone(),
                    format!("a rotation follows the ball joint of {}", describe_body(body)),
                )
                .why("a ball joint already rotates about every axis")
                .help("remove the joint, or put it into another body");
        }
        after_ball |= j.kind == joint::BALL;
        let before = dofs;
        dofs += joint::nv(j.kind);
        if before <= 6 && dofs > 6 {
            report
                .error(
                    rules::JOINT,
                    j.span.clone(),
                    format!("with this joint, {} has more than 6 degrees of freedom", describe_body(body)),
                )
                .why("a rigid body has six: three translations and three rotations")
                .help("remove a joint; a free joint must be the only one");
        }
    }
}

/// Frames whose numbers all differ by less than this count as equal (measured on the library).
const SAME_FRAME: f64 = 1e-6;
/// A component of a unit axis smaller than this counts as zero (measured on the library).
const SAME_AXIS: f64 = 1e-14;

fn is_origin(pos: Vec3) -> bool {
    pos.iter().all(|x| x.abs() < SAME_FRAME)
}

/// Whether q is the identity rotation; q and -q are the same rotation.
fn is_identity([w, x, y, z]: Quat) -> bool {
    (w.abs() - 1.0).abs() < SAME_FRAME && is_origin([x, y, z])
}

/// For each body, whether its mass matrix is diagonal in every configuration. Then its rows of the sparsity pattern contain the
/// diagonal only.
pub(crate) fn find_simple_bodies(bodies: &[BodySpec], inertias: &[Inertia]) -> Vec<i32> {
    let mut leaf = vec![true; bodies.len()];
    for body in bodies.iter().skip(1) {
        if let Some(l) = leaf.get_mut(body.parent) {
            *l = false;
        }
    }
    // The world, or a body that is fixed directly to it.
    let base = |i: usize| i == 0 || bodies.get(i).is_some_and(|b| b.parent == 0 && b.joints.is_empty());
    let kind = |(i, (body, inertia)): (usize, (&BodySpec, &Inertia))| {
        if i == 0 {
            return simple::DIAGONAL; // by convention
        }
        let centred = is_origin(inertia.pos) && is_identity(inertia.quat);
        if !body.simple || !centred || !base(body.parent) || leaf.get(i) != Some(&true) {
            return simple::NO;
        }
        let mut turned = false;
        for j in &body.joints {
            let along_one_axis = j.axis.iter().filter(|x| x.abs() > SAME_AXIS).count() == 1;
            if turned || !is_origin(j.pos) || !along_one_axis {
                return simple::NO;
            }
            turned = j.kind != joint::SLIDE;
        }
        if turned || body.joints.is_empty() { simple::DIAGONAL } else { simple::SLIDING }
    };
    listed(bodies.iter().zip(inertias).enumerate().map(kind))
}

/// The sparsity pattern of the lower triangle of the mass matrix, row by row.
#[derive(Debug, Default)]
pub(crate) struct SparsityPattern {
    pub(crate) rownnz: Vec<i32>,
    pub(crate) rowadr: Vec<i32>,
    pub(crate) colind: Vec<i32>,
}

/// Row i contains the degrees of freedom on the path from the root to i, ascending, i last; for a simple body, only i itself.
/// `None`, with an error in the report, if the pattern is too large.
pub(crate) fn pattern(
    layout: &TreeLayout,
    simple: &[i32],
    report: &mut Diagnostics,
) -> Option<SparsityPattern> {
    let mut p = SparsityPattern::default();
    for (i, dof) in layout.dofs.iter().enumerate() {
        let start = p.colind.len();
        p.rowadr.push(start as i32);
        p.colind.push(i as i32);
        let mut up = if simple.get(dof.body).is_some_and(|&s| s != simple::NO) { None } else { dof.parent };
        while let Some(j) = up {
            p.colind.push(j as i32);
            up = layout.dofs.get(j).and_then(|d| d.parent);
        }
        if let Some(row) = p.colind.get_mut(start..) {
            row.reverse();
        }
        p.rownnz.push((p.colind.len() - start) as i32);
        if p.colind.len() > MAX_MATRIX {
            report.error(rules::LIMIT, 0..0, format!("the mass matrix has more than {MAX_MATRIX} entries"));
            return None;
        }
    }
    Some(p)
}

/// The sparsity pattern of derivatives with respect to velocities: both triangles of the matrix that couples every degree of
/// freedom with its ancestors, also for simple bodies. A row contains the ancestors, then its own degree of freedom, then all
/// descendants, ascending.
#[derive(Debug, Default)]
pub(crate) struct WholePattern {
    pub(crate) pattern: SparsityPattern,
    /// Index of the diagonal in each row.
    pub(crate) diag: Vec<i32>,
}

/// The pattern for a model. `None`, with an error in the report, if it is too large.
pub(crate) fn whole_pattern(layout: &TreeLayout, report: &mut Diagnostics) -> Option<WholePattern> {
    let dofs = &layout.dofs;
    let up = |i: usize| std::iter::successors(dofs.get(i).and_then(|d| d.parent), |&j| dofs.get(j)?.parent);
    let mut w = WholePattern::default();
    let mut below = vec![0; dofs.len()];
    for (i, place) in (0..dofs.len()).map(|i| (i, up(i).count())) {
        w.diag.push(place as i32);
        up(i).for_each(|j| below[j] += 1);
    }
    let p = &mut w.pattern;
    for i in 0..dofs.len() {
        let start = p.colind.len();
        p.rowadr.push(start as i32);
        p.colind.extend(up(i).map(|j| j as i32));
        if let Some(row) = p.colind.get_mut(start..) {
            row.reverse();
        }
        // Degrees of freedom are numbered depth first, so that the descendants of one follow it directly.
        p.colind.extend((i..=i + below[i]).map(|k| k as i32));
        p.rownnz.push((p.colind.len() - start) as i32);
        if p.colind.len() > MAX_MATRIX {
            report.error(rules::LIMIT, 0..0, format!("the mass matrix has more than {MAX_MATRIX} entries"));
            return None;
        }
    }
    Some(w)
}
