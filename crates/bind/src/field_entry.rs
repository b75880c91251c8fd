//! The language's view of a field of the engine's table: its name, its kind, the stage that computes it, and the
//! objects that it belongs to.

use super::elements;
use super::handle::KINDS;
use labspec_core::Obj;
use labspec_core::reflect::{self, FieldId, Kind, Object, Stage, model};
use labspec_expr::{Elem, Field, FieldKey, FieldKind};

/// The name of a field in a named object: without the prefix for the kind of object.
pub(super) fn short_name(name: &str) -> &str {
    const PREFIXES: [&str; 22] = [
        "body_",
        "jnt_",
        "dof_",
        "geom_",
        "site_",
        "cam_",
        "light_",
        "mesh_",
        "hfield_",
        "tex_",
        "mat_",
        "pair_",
        "exclude_",
        "eq_",
        "tendon_",
        "ten_",
        "actuator_",
        "sensor_",
        "numeric_",
        "text_",
        "tuple_",
        "key_",
    ];
    PREFIXES.iter().find_map(|p| name.strip_prefix(p)).unwrap_or(name)
}

/// The form of a field for one named object: `data.joint('…').qpos`, or `None` if the field has no rows for one kind of object.
pub fn named_field(f: FieldId) -> Option<String> {
    let (object, name, dim) = (f.info().object, f.info().name, f.rows()?);
    let holder = match object {
        Object::Model => "model",
        Object::Data => "data",
        _ => return None,
    };
    let (kind, _) = KINDS.iter().find(|(kind, _)| elements::has_rows(*kind, dim))?;
    Some(format!("{holder}.{}('…').{}", noun(*kind), member_name(object, name, *kind)))
}

/// The name of a field in a named object: the short name, unless an earlier field has it (`dof_solref` of a joint).
pub(super) fn member_name(object: Object, name: &'static str, kind: Obj) -> &'static str {
    if name == "sensordata" {
        return "data";
    }
    let short = short_name(name);
    let has = |f: &FieldId| f.rows().is_some_and(|dim| elements::has_rows(kind, dim));
    let all = reflect::fields().filter(|f| f.info().object == object && short_name(f.info().name) == short);
    let first = all.filter(has).map(|f| f.info().name).next();
    if first.is_none_or(|f| f == name) { short } else { name }
}

pub(super) fn noun(kind: Obj) -> &'static str {
    KINDS.iter().find(|(k, _)| *k == kind).map_or("object", |(_, noun)| noun)
}

pub(super) fn field(
    f: FieldId,
    path: String,
    first: usize,
    shape: Vec<Option<usize>>,
    owner: String,
) -> Field {
    let info = f.info();
    let kind = match info.kind {
        Kind::Structure => FieldKind::Structure,
        Kind::State => FieldKind::State,
        Kind::Input => FieldKind::Input,
        Kind::Constant => FieldKind::Constant,
        Kind::Inertial => FieldKind::Inertial,
        Kind::Derived => FieldKind::Derived { by: stage_phrase(info.stage).into() },
    };
    Field {
        key: FieldKey(f.index() as u32),
        path,
        first,
        shape,
        kind,
        elem: match info.elem {
            reflect::Elem::F64 => Elem::Double,
            reflect::Elem::I32 | reflect::Elem::Size => Elem::Int,
            reflect::Elem::Bool => Elem::Byte,
        },
        unit: f.unit().into(),
        doc: f.doc().into(),
        owner,
    }
}

/// What computes a field, as a phrase after "computed by".
fn stage_phrase(stage: Stage) -> &'static str {
    match stage {
        Stage::Compile => "the model compiler",
        Stage::SetConst => "mj_setConst",
        Stage::User => "nothing",
        Stage::Kinematics
        | Stage::Orientations
        | Stage::GeomPoses
        | Stage::SitePoses
        | Stage::CameraPoses => "forward kinematics, inside mj_step and mj_forward",
        Stage::ComPos | Stage::ComVel => "the centre-of-mass stage, inside mj_step and mj_forward",
        Stage::MassMatrix | Stage::Factor => "the mass-matrix stage, inside mj_step and mj_forward",
        Stage::Tendon | Stage::TendonVel => "the tendon stage, inside mj_step and mj_forward",
        Stage::Transmission | Stage::ActuatorVel | Stage::Actuation => {
            "the actuation stage, inside mj_step and mj_forward"
        }
        Stage::Collision => "collision detection, inside mj_step and mj_forward",
        Stage::Constraint | Stage::Reference => "the constraint stage, inside mj_step and mj_forward",
        Stage::Passive => "the passive-force stage, inside mj_step and mj_forward",
        Stage::Bias => "recursive Newton–Euler, inside mj_step and mj_forward",
        Stage::Acceleration => "the acceleration stage, inside mj_step and mj_forward",
        Stage::Solve => "the constraint solver, inside mj_step and mj_forward",
        Stage::SubtreeVel => "mj_subtreeVel, which mj_step and mj_forward call when a sensor needs it",
        Stage::RnePost => "mj_rnePostConstraint, which mj_step and mj_forward call when a sensor needs it",
        Stage::Inverse => "mj_inverse",
        Stage::Sleep => "the sleep stage, inside mj_step and mj_forward",
        Stage::Sensors => "the sensor stage, inside mj_step and mj_forward",
        Stage::Energy => "the energy stage, inside mj_step and mj_forward",
    }
}

/// The objects that determine the size of a field, as a phrase.
pub(super) fn owner(f: FieldId, shape: &[Option<usize>]) -> String {
    let (Some(rows), Some(Some(count))) = (f.rows(), shape.first()) else { return String::new() };
    let things = match rows {
        model::nq => "coordinates (nq)",
        model::nv => "degrees of freedom (nv)",
        model::nu => "controls (nu)",
        model::na => "activations (na)",
        model::nbody => "bodies (nbody, the world is body 0)",
        model::njnt => "joints (njnt)",
        model::ngeom => "geoms (ngeom)",
        model::nsite => "sites (nsite)",
        model::nmocap => "mocap bodies (nmocap)",
        model::nkey => "keyframes (nkey)",
        model::ncam => "cameras (ncam)",
        model::nlight => "lights (nlight)",
        model::nactuator => "actuators (nactuator)",
        model::nout => "force outputs of actuators (nout)",
        model::nmesh => "meshes (nmesh)",
        model::nwrap => "objects on tendon paths (nwrap)",
        model::npair => "contact pairs (npair)",
        model::nsensor => "sensors (nsensor)",
        model::nsensordata => "sensor values (nsensordata)",
        model::ntendon => "tendons (ntendon)",
        model::neq => "equality constraints (neq)",
        _ => return String::new(),
    };
    let each: usize = shape.iter().skip(1).map(|d| d.unwrap_or(1)).product();
    let width = if shape.len() > 1 { format!(" with {each} numbers each") } else { String::new() };
    format!("the model has {count} {things}{width}")
}
