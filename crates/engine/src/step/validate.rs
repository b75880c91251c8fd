//! Validates that the engine can safely use the integers of a model as indexes. Required for models that were not compiled here.
//!
//! Ids refer to existing objects, lists are within their arrays, parents precede their children, and objects of each type have
//! what the type requires. Parameters are not checked, because no value of them causes a panic.

use crate::dynamics::walk;
use crate::geometry::Hull;
use crate::kinds::{dyntype, eqtype, gaintype, geom, joint, trntype, wraptype};
use crate::model::index::{element_range, object_index};
use crate::model::reflect::{self, FieldId, Object, View, model};
use crate::model::{Model, Obj};
use crate::sensor;

/// A field, the size that is the upper limit of its numbers, and their smallest valid value.
const IDS: [(FieldId, FieldId, i32); 32] = [
    (model::body_parentid, model::nbody, 0),
    (model::body_rootid, model::nbody, 0),
    (model::body_weldid, model::nbody, 0),
    (model::body_mocapid, model::nmocap, -1),
    (model::body_treeid, model::ntree, -1),
    (model::jnt_bodyid, model::nbody, 0),
    (model::jnt_actuatorid, model::nactuator, -2),
    (model::dof_bodyid, model::nbody, 0),
    (model::dof_jntid, model::njnt, 0),
    (model::dof_parentid, model::nv, -1),
    (model::dof_treeid, model::ntree, 0),
    (model::M_colind, model::nv, 0),
    (model::D_colind, model::nv, 0),
    (model::geom_bodyid, model::nbody, 0),
    (model::geom_matid, model::nmat, -1),
    (model::site_bodyid, model::nbody, 0),
    (model::site_dataid, model::nmesh, -1),
    (model::cam_bodyid, model::nbody, 0),
    (model::cam_targetbodyid, model::nbody, -1),
    (model::light_bodyid, model::nbody, 0),
    (model::light_targetbodyid, model::nbody, -1),
    (model::mesh_face, model::nmeshvert, 0),
    (model::skin_bonebodyid, model::nbody, 0),
    (model::pair_geom1, model::ngeom, 0),
    (model::pair_geom2, model::ngeom, 0),
    (model::tendon_actuatorid, model::nactuator, -2),
    (model::tendon_treeid, model::ntree, -1),
    (model::ten_J_colind, model::nv, 0),
    (model::jnt_qposadr, model::nq, 0),
    (model::jnt_dofadr, model::nv, 0),
    (model::actuator_historyadr, model::nhistory, -1),
    (model::sensor_historyadr, model::nhistory, -1),
];

/// The addresses of lists, their lengths, and the size of the array that contains them.
const SPANS: [(FieldId, FieldId, FieldId); 17] = [
    (model::body_jntadr, model::body_jntnum, model::njnt),
    (model::body_dofadr, model::body_dofnum, model::nv),
    (model::body_geomadr, model::body_geomnum, model::ngeom),
    (model::tree_bodyadr, model::tree_bodynum, model::nbody),
    (model::tree_dofadr, model::tree_dofnum, model::nv),
    (model::M_rowadr, model::M_rownnz, model::nC),
    (model::D_rowadr, model::D_rownnz, model::nD),
    (model::mesh_vertadr, model::mesh_vertnum, model::nmeshvert),
    (model::mesh_faceadr, model::mesh_facenum, model::nmeshface),
    (model::tendon_adr, model::tendon_num, model::nwrap),
    (model::ten_J_rowadr, model::ten_J_rownnz, model::nJten),
    (model::actuator_ctrladr, model::actuator_ctrlnum, model::nu),
    (model::actuator_outadr, model::actuator_outnum, model::nout),
    (model::actuator_actadr, model::actuator_actnum, model::na),
    (model::sensor_adr, model::sensor_dim, model::nsensordata),
    (model::numeric_adr, model::numeric_size, model::nnumericdata),
    (model::tuple_adr, model::tuple_size, model::ntupledata),
];

/// Limit for the sizes of arrays of the data that have no array of the same length in the model.
const MOST: usize = 1 << 24;

fn list(m: &Model, field: FieldId) -> &[i32] {
    match reflect::view_model(m, field) {
        View::I32(list) => list,
        _ => &[],
    }
}

fn size(m: &Model, field: FieldId) -> usize {
    match reflect::view_model(m, field) {
        View::Size(n) => n,
        _ => 0,
    }
}

fn within(id: i32, count: usize) -> bool {
    usize::try_from(id).is_ok_and(|id| id < count)
}

/// The number of objects of a kind, or `None` for a kind that is never referenced.
fn count(m: &Model, kind: i32) -> Option<usize> {
    let kinds = [
        (Obj::Body, m.nbody),
        (Obj::XBody, m.nbody),
        (Obj::Joint, m.njnt),
        (Obj::Dof, m.nv),
        (Obj::Geom, m.ngeom),
        (Obj::Site, m.nsite),
        (Obj::Camera, m.ncam),
        (Obj::Tendon, m.ntendon),
        (Obj::Actuator, m.nactuator),
        (Obj::Sensor, m.nsensor),
        (Obj::Mesh, m.nmesh),
    ];
    kinds.into_iter().find(|(k, _)| *k as i32 == kind).map(|(_, n)| n)
}

/// The part of the model that is invalid, or `None` if the model is valid.
pub fn validate(m: &Model) -> Option<&'static str> {
    let sizes = [
        m.nuserdata,
        m.nsensordata,
        m.nhistory,
        m.nJmom,
        m.nJten,
        m.nC,
        m.nD,
        m.nq,
        m.nv,
        m.nu,
        m.na,
        m.nout,
    ];
    let of_data = reflect::fields().filter(|f| f.info().object == Object::Data);
    let total_length = of_data.fold(0, |sum: usize, f| sum.saturating_add(reflect::length(m, f)));
    let ids = IDS.iter().all(|&(field, count, low)| {
        let end = size(m, count);
        list(m, field).iter().all(|&x| x >= low && (x < 0 || within(x, end)))
    });
    let spans = SPANS.iter().all(|&(adr, num, count)| {
        let end = size(m, count) as i64;
        let pairs = list(m, adr).iter().zip(list(m, num));
        pairs
            .map(|(&a, &n)| (i64::from(a), i64::from(n)))
            .all(|(a, n)| a >= -1 && n >= 0 && (a >= 0 || n == 0) && a.max(0) + n <= end)
    });
    let checks = [
        (
            "sizes",
            m.nbody > 0
                && m.nmocap <= m.nbody
                && sizes.iter().all(|&n| n <= MOST)
                && total_length <= 4 * MOST,
        ),
        ("ids", ids),
        ("lists", spans),
    ];
    let failed = checks.into_iter().find(|(_, good)| !good).map(|(name, _)| name);
    // The following checks use indexes that the previous checks have validated.
    failed.or_else(|| {
        let names =
            m.names.lists().flatten().all(|name| name.len() < 1 << 20) && m.names.body.len() == m.nbody;
        let checks: [(&'static str, Check); 5] = [
            ("trees", trees),
            ("shapes", shapes),
            ("equalities and tendons", ties),
            ("actuators", |m| (0..m.nactuator).all(|i| actuator(m, i))),
            ("sensors", |m| (0..m.nsensor).all(|s| measures(m, s))),
        ];
        let failed = checks.into_iter().find(|(_, check)| !check(m)).map(|(name, _)| name);
        failed.or((!names || m.mesh_sides.len() > m.nmesh).then_some("names"))
    })
}

/// Whether a part of a model is valid.
type Check = fn(&Model) -> bool;

/// Checks that parents precede their children, joints are consecutive, and rows of M end with the diagonal.
fn trees(m: &Model) -> bool {
    let before = |list: &[i32], from: usize| list.iter().enumerate().skip(from).all(|(i, &p)| p < i as i32);
    let (mut q, mut v) = (0, 0);
    let joints =
        m.jnt_type.iter().zip(m.jnt_qposadr.iter().zip(&m.jnt_dofadr)).all(|(&kind, (&address, &dof))| {
            let good =
                (joint::FREE..=joint::HINGE).contains(&kind) && address as usize == q && dof as usize == v;
            (q, v) = (q + joint::nq(kind), v + joint::nv(kind));
            good
        });
    // Each degree of freedom follows the previous one of its body. The first of a body follows the last one of its ancestors.
    let paths = (0..m.nv).all(|k| match m.dof_bodyid[k] as usize {
        b if k as i32 > m.body_dofadr[b] => m.dof_parentid[k] == k as i32 - 1,
        b => m.dof_parentid[k] == last_before(m, b),
    });
    let mut next = 0;
    let in_order = (0..m.ntree).all(|t| {
        let first = m.tree_dofadr[t];
        let good = first == next && m.tree_dofnum[t] > 0;
        next = first + m.tree_dofnum[t];
        good && (first..next).all(|k| m.dof_treeid[k as usize] == t as i32)
            && (0..m.tree_bodynum[t]).all(|b| m.body_treeid[(m.tree_bodyadr[t] + b) as usize] == t as i32)
    });
    let simple = m.dof_simplenum.iter().enumerate().all(|(k, &n)| n >= 0 && k + n as usize <= m.nv);
    joints
        && (q, v) == (m.nq, m.nv)
        && m.body_parentid.first() == Some(&0)
        && before(&m.body_parentid, 1)
        && before(&m.dof_parentid, 0)
        && (0..m.nbody).all(|b| has_joints_in_order(m, b))
        && paths
        && (0..m.nv).all(|k| has_rows_of_path(m, k))
        && in_order
        && next as usize == m.nv
        && simple
        // The row of a simple degree of freedom contains only the diagonal.
        && (0..m.nv).all(|k| m.dof_simplenum[k] == 0 || m.M_rownnz[k] == 1)
}

/// Checks that a degree of freedom belongs to its joint, that its row of M ends with it, and that its row of D contains it.
fn has_rows_of_path(m: &Model, k: usize) -> bool {
    let j = m.dof_jntid[k] as usize;
    let first = m.jnt_dofadr[j] as usize;
    let columns = &m.M_colind[element_range(m.M_rowadr[k], m.M_rownnz[k])];
    let whole = &m.D_colind[element_range(m.D_rowadr[k], m.D_rownnz[k])];
    (first..first + joint::nv(m.jnt_type[j])).contains(&k)
        && m.dof_bodyid[k] == m.jnt_bodyid[j]
        && columns.last() == Some(&(k as i32))
        && columns.is_sorted_by(|a, b| a < b)
        && whole.is_sorted_by(|a, b| a < b)
        && usize::try_from(m.D_diag[k]).ok().and_then(|address| whole.get(address)) == Some(&(k as i32))
        // The row contains the path to the root, except if M is diagonal.
        && (m.dof_simplenum[k] > 0 || walk::upward(m, k as i32).eq(columns.iter().rev().map(|&c| c as usize)))
}

/// Checks that a body owns its joints, and that its degrees of freedom are those of its joints.
fn has_joints_in_order(m: &Model, b: usize) -> bool {
    let joints = element_range(m.body_jntadr[b], m.body_jntnum[b]);
    let dofs: usize = joints.clone().map(|j| joint::nv(m.jnt_type[j])).sum();
    joints.clone().all(|j| m.jnt_bodyid[j] as usize == b)
        && dofs == m.body_dofnum[b] as usize
        && (dofs == 0 || m.body_dofadr[b] == m.jnt_dofadr[joints.start])
        && m.body_rootid[b] <= b as i32
        && m.body_weldid[b] <= b as i32
        // A body with joints is not welded to another one. A body without joints has no degree of freedom.
        && (if dofs == 0 { m.body_dofadr[b] == -1 } else { m.body_weldid[b] == b as i32 })
}

/// The last degree of freedom of the ancestors of a body, or -1 if there is none.
fn last_before(m: &Model, b: usize) -> i32 {
    let mut up = b;
    while up > 0 {
        // Parents precede their children.
        up = object_index(m.body_parentid[up]).min(up - 1);
        if m.body_dofnum[up] > 0 {
            return m.body_dofadr[up] + m.body_dofnum[up] - 1;
        }
    }
    -1
}

/// Checks that meshes and height fields have their vertices and samples.
fn shapes(m: &Model) -> bool {
    let geoms = m.geom_type.iter().zip(&m.geom_dataid).all(|(&kind, &id)| match kind {
        geom::MESH => within(id, m.nmesh),
        geom::HFIELD => within(id, m.nhfield),
        _ => id >= -1 && (id < 0 || within(id, m.nmesh.max(m.nhfield))),
    });
    let fields = (0..m.nhfield).all(|h| {
        let [rows, columns, first] = [m.hfield_nrow[h], m.hfield_ncol[h], m.hfield_adr[h]].map(i64::from);
        rows >= 2 && columns >= 2 && first >= 0 && first + rows * columns <= m.nhfielddata as i64
    });
    let meshes = (0..m.nmesh).all(|id| {
        let corners = m.mesh_vertnum[id];
        let faces = element_range(m.mesh_faceadr[id], m.mesh_facenum[id]);
        let in_range = m.mesh_face.as_chunks::<3>().0[faces].iter().flatten().all(|&v| v < corners);
        let Ok(address) = usize::try_from(m.mesh_graphadr[id]) else { return corners > 0 && in_range };
        let Some(hull) = m.mesh_graph.get(address..).and_then(Hull::from_graph) else { return false };
        let n = hull.vertex.len();
        in_range
            && hull.vertex.iter().chain(hull.face.iter().flatten()).all(|&v| v >= 0 && v < corners)
            && hull.first_edge.iter().all(|&e| within(e, hull.edges.len()))
            && hull.edges.iter().all(|&e| e == -1 || within(e, n))
    });
    geoms && fields && meshes
}

/// Checks the objects of equality constraints and tendons.
fn ties(m: &Model) -> bool {
    let equality = |e: usize| {
        let [first, second] = [m.eq_obj1id[e], m.eq_obj2id[e]];
        let (n, alone) = match m.eq_type[e] {
            eqtype::CONNECT | eqtype::WELD => (count(m, m.eq_objtype[e]).unwrap_or(0), false),
            eqtype::JOINT => (m.njnt, true),
            eqtype::TENDON => (m.ntendon, true),
            _ => return false,
        };
        let scalar = |j: i32| {
            let kind = usize::try_from(j).ok().and_then(|j| m.jnt_type.get(j));
            matches!(kind, Some(&(joint::SLIDE | joint::HINGE)))
        };
        let joints = m.eq_type[e] != eqtype::JOINT || scalar(first) && (second < 0 || scalar(second));
        within(first, n) && (within(second, n) || alone && second == -1) && joints
    };
    // A branch runs from site to site, with at most one geom between two sites.
    let branch = |kinds: &[i32]| {
        let is_site = |kind: &i32| *kind == wraptype::SITE;
        kinds.len() > 1
            && [kinds.first(), kinds.last()].iter().all(|end| end.is_some_and(is_site))
            && kinds.windows(2).all(|two| two.iter().any(is_site))
            && kinds.iter().all(|k| matches!(*k, wraptype::SITE | wraptype::SPHERE | wraptype::CYLINDER))
    };
    // A path may begin with a pulley: no branch is before it.
    let branches = |kinds: &[i32]| {
        let first = usize::from(kinds.first() == Some(&wraptype::PULLEY));
        kinds.split(|&kind| kind == wraptype::PULLEY).skip(first).all(branch)
    };
    let tendon = |t: usize| {
        let path = element_range(m.tendon_adr[t], m.tendon_num[t]);
        let fixed = m.wrap_type.get(path.start) == Some(&wraptype::JOINT);
        !path.is_empty()
            && path.clone().all(|w| (m.wrap_type[w] == wraptype::JOINT) == fixed)
            && (fixed || branches(&m.wrap_type[path]))
    };
    let wrap = |w: usize| match m.wrap_type[w] {
        wraptype::JOINT => {
            let kind = usize::try_from(m.wrap_objid[w]).ok().and_then(|j| m.jnt_type.get(j));
            matches!(kind, Some(&(joint::SLIDE | joint::HINGE)))
        }
        wraptype::SITE => within(m.wrap_objid[w], m.nsite),
        kind if kind > wraptype::SITE => {
            let side = m.wrap_prm[w];
            within(m.wrap_objid[w], m.ngeom) && (side < 0.0 || side < m.nsite as f64)
        }
        _ => true,
    };
    let rows = (0..m.ntendon).all(|t| {
        m.ten_J_colind[element_range(m.ten_J_rowadr[t], m.ten_J_rownnz[t])].is_sorted_by(|a, b| a < b)
    });
    (0..m.neq).all(equality) && (0..m.ntendon).all(tendon) && (0..m.nwrap).all(wrap) && rows
}

/// Checks the target of an actuator, and its numbers of inputs, outputs and states.
fn actuator(m: &Model, i: usize) -> bool {
    let [first, second] = [m.actuator_trnid[2 * i], m.actuator_trnid[2 * i + 1]];
    let (outputs, controls) = (m.actuator_outnum[i], m.actuator_ctrlnum[i]);
    let is_joint_type =
        |kind: i32| usize::try_from(first).ok().and_then(|j| m.jnt_type.get(j)) == Some(&kind);
    let (target, width) = match m.actuator_trntype[i] {
        trntype::JOINT | trntype::JOINTINPARENT => (within(first, m.njnt), 1),
        trntype::TENDON => (within(first, m.ntendon), 1),
        trntype::SITE => (within(first, m.nsite) && (second == -1 || within(second, m.nsite)), 1),
        trntype::SLIDERCRANK => (within(first, m.nsite) && within(second, m.nsite), 1),
        trntype::SO3 if second >= 0 => (within(first, m.nsite) && within(second, m.nsite), 3),
        trntype::SO3 => (is_joint_type(joint::BALL), 3),
        trntype::BODY => (within(first, m.nbody), 1),
        _ => (false, 1),
    };
    let orientation = m.actuator_gaintype[i] == gaintype::SO3;
    let states = m.actuator_actnum[i];
    let driven = match m.actuator_dyntype[i] {
        dyntype::NONE => states == 0,
        dyntype::INTEGRATOR => states >= 1 && states <= controls,
        dyntype::FILTER | dyntype::FILTEREXACT | dyntype::MUSCLE => states >= 1 && controls >= 1,
        _ => true,
    };
    target
        && outputs == width
        && (orientation == (width == 3))
        && (!orientation || controls == 4 || controls == 3)
        && (orientation || controls <= 4)
        && driven
        && buffer(m, m.actuator_history[2 * i], m.actuator_historyadr[i], controls)
}

/// Checks the object of a sensor, and the number of its values.
fn measures(m: &Model, s: usize) -> bool {
    let object = |kind: i32, id: i32| match count(m, kind) {
        Some(n) => within(id, n) || id == -1,
        None => id <= 0,
    };
    let dim = m.sensor_dim[s];
    object(m.sensor_objtype[s], m.sensor_objid[s])
        && object(m.sensor_reftype[s], m.sensor_refid[s])
        && sensor::fits(m, s)
        && buffer(m, m.sensor_history[2 * s], m.sensor_historyadr[s], dim)
}

/// Checks the length of a buffer of past values.
fn buffer(m: &Model, samples: i32, adr: i32, dim: i32) -> bool {
    let Ok(n) = usize::try_from(samples) else { return false };
    let (Ok(address), Ok(dim)) = (usize::try_from(adr), usize::try_from(dim)) else { return n == 0 };
    n == 0
        || n < MOST
            && dim < MOST
            && address.saturating_add(crate::forces::history::size(n, dim)) <= m.nhistory
}
