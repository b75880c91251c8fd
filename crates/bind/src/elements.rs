//! Which part of a field belongs to which object of the model, and what its elements are. Named access, the help for an element
//! and the replacement of numeric indexes all use this module.

use crate::rules::QUATERNION_AS_ANGLE;
use labspec_core::reflect::{self, FieldId, data, model};
use labspec_core::{Model, Obj, joint};
use labspec_expr::{AngleAdvice, FieldKey, Role};

/// The first element and the number of elements of a field that belong to one object, or `None` if the field has no rows
/// for this kind of object.
pub(super) fn row(m: &Model, f: FieldId, kind: Obj, index: usize) -> Option<(usize, usize)> {
    let shape = reflect::shape(m, f);
    let width: usize = shape.iter().skip(1).try_fold(1usize, |n, d| n.checked_mul((*d)?))?;
    let (first, count) = span(m, kind, f.rows()?, index)?;
    Some((first.checked_mul(width)?, count.checked_mul(width)?))
}

/// The first row and the number of rows of one object along a dimension.
fn span(m: &Model, kind: Obj, dim: FieldId, index: usize) -> Option<(usize, usize)> {
    let value_of = |v: &[i32]| v.get(index).and_then(|&x| usize::try_from(x).ok());
    let one = |field: FieldId| (dim == field).then_some((index, 1));
    match (kind, dim) {
        (Obj::Joint, model::nq) => Some((value_of(&m.jnt_qposadr)?, joint::nq(*m.jnt_type.get(index)?))),
        (Obj::Joint, model::nv) => Some((value_of(&m.jnt_dofadr)?, joint::nv(*m.jnt_type.get(index)?))),
        (Obj::Sensor, model::nsensordata) => Some((value_of(&m.sensor_adr)?, value_of(&m.sensor_dim)?)),
        (Obj::Actuator, model::nu) => Some((value_of(&m.actuator_ctrladr)?, value_of(&m.actuator_ctrlnum)?)),
        (Obj::Actuator, model::nout) => Some((value_of(&m.actuator_outadr)?, value_of(&m.actuator_outnum)?)),
        (Obj::Actuator, model::na) => Some((value_of(&m.actuator_actadr)?, value_of(&m.actuator_actnum)?)),
        (Obj::Numeric, model::nnumericdata) => Some((value_of(&m.numeric_adr)?, value_of(&m.numeric_size)?)),
        (Obj::Tuple, model::ntupledata) => Some((value_of(&m.tuple_adr)?, value_of(&m.tuple_size)?)),
        (kind, _) => one(size_of(kind)?),
    }
}

/// Whether a dimension has rows for objects of a kind.
pub(super) fn has_rows(kind: Obj, dim: FieldId) -> bool {
    let parts: &[FieldId] = match kind {
        Obj::Joint => &[model::nq, model::nv],
        Obj::Sensor => &[model::nsensordata],
        Obj::Actuator => &[model::nu, model::nout, model::na],
        Obj::Numeric => &[model::nnumericdata],
        Obj::Tuple => &[model::ntupledata],
        _ => &[],
    };
    size_of(kind) == Some(dim) || parts.contains(&dim)
}

/// The size that counts the objects of a kind.
fn size_of(kind: Obj) -> Option<FieldId> {
    Some(match kind {
        Obj::Body => model::nbody,
        Obj::Joint => model::njnt,
        Obj::Geom => model::ngeom,
        Obj::Site => model::nsite,
        Obj::Camera => model::ncam,
        Obj::Light => model::nlight,
        Obj::Mesh => model::nmesh,
        Obj::Skin => model::nskin,
        Obj::HField => model::nhfield,
        Obj::Texture => model::ntex,
        Obj::Material => model::nmat,
        Obj::Pair => model::npair,
        Obj::Exclude => model::nexclude,
        Obj::Equality => model::neq,
        Obj::Tendon => model::ntendon,
        Obj::Actuator => model::nactuator,
        Obj::Sensor => model::nsensor,
        Obj::Numeric => model::nnumeric,
        Obj::Text => model::ntext,
        Obj::Tuple => model::ntuple,
        Obj::Key => model::nkey,
        _ => return None,
    })
}

/// The object to which an element of a field belongs.
pub(super) fn owner(m: &Model, f: FieldId, index: usize) -> Option<(Obj, usize)> {
    let dim = f.rows()?;
    let kinds = super::handle::KINDS.iter().map(|(kind, _)| *kind);
    for kind in kinds.filter(|kind| has_rows(*kind, dim)) {
        let count = m.names.of_kind(kind).len();
        let holds =
            |i: &usize| row(m, f, kind, *i).is_some_and(|(first, n)| (first..first + n).contains(&index));
        if let Some(i) = (0..count).find(holds) {
            return Some((kind, i));
        }
    }
    None
}

/// The object of the model to which a range of elements of a field belongs, or `None` if they belong to
/// several objects or to none.
pub fn element_owner(m: &Model, FieldKey(f): FieldKey, first: usize, count: usize) -> Option<(Obj, usize)> {
    let field = FieldId::new(f as usize)?;
    let (kind, object) = owner(m, field, first)?;
    let (start, length) = row(m, field, kind, object)?;
    (first + count.max(1) <= start + length).then_some((kind, object))
}

/// The axis of the world along which an element of a field is measured.
#[derive(Clone, Copy, Debug)]
pub struct ElementAxis {
    /// 0 to 2: x, y, z.
    pub index: usize,
    /// Whether the elements beside it are measured along the other axes.
    pub of_three: bool,
}

/// The axis of the world along which an element of a field is measured: a coordinate or a velocity of a free joint or of a slide,
/// or a position in the world frame. `None` if it is measured along no axis.
pub fn element_axis(m: &Model, field: FieldId, index: usize) -> Option<ElementAxis> {
    let of_three = |offset: usize| Some(ElementAxis { index: offset, of_three: true }).filter(|_| offset < 3);
    if [data::xpos, data::xipos, data::geom_xpos, data::site_xpos, data::cam_xpos, data::subtree_com]
        .contains(&field)
    {
        return of_three(index % 3);
    }
    if ![data::qpos, data::qvel, data::qacc].contains(&field) {
        return None;
    }
    let (Obj::Joint, joint) = owner(m, field, index)? else { return None };
    let (first, _) = row(m, field, Obj::Joint, joint)?;
    match *m.jnt_type.get(joint)? {
        joint::FREE => of_three(index - first),
        joint::SLIDE => Some(ElementAxis { index: slide_axis(m, joint)?, of_three: false }),
        _ => None,
    }
}

/// The axis of the world along which a slide moves, if nothing turns its body.
fn slide_axis(m: &Model, joint: usize) -> Option<usize> {
    /// The sine of the largest angle between the slide and the axis.
    const ALIGNED: f64 = 1e-6;
    let mut axis = *m.jnt_axis.get(3 * joint..3 * joint + 3)?.first_chunk::<3>()?;
    let first_body = usize::try_from(*m.jnt_bodyid.get(joint)?).ok()?;
    let mut body = first_body;
    while body != 0 {
        let turned = (0..m.njnt).any(|j| {
            m.jnt_bodyid.get(j).and_then(|b| usize::try_from(*b).ok()) == Some(body)
                && m.jnt_type.get(j) != Some(&joint::SLIDE)
                && (body != first_body || j < joint)
        });
        if turned {
            return None;
        }
        axis =
            labspec_core::math::rotate(axis, *m.body_quat.get(4 * body..4 * body + 4)?.first_chunk::<4>()?);
        body = usize::try_from(*m.body_parentid.get(body)?).ok()?;
    }
    let off = |i: usize| axis.iter().enumerate().all(|(k, x)| k == i || x.abs() < ALIGNED);
    (0..3).find(|i| off(*i))
}

/// The description of an element, for messages: `joint "ball" (free): z position, m`.
pub fn describe_element(m: &Model, field: FieldId, index: usize) -> Option<String> {
    help(m, field, index, "")
}

/// The description of an element with its unit: `joint "light_free" (free): z position, m`.
pub(super) fn help(m: &Model, f: FieldId, index: usize, unit: &str) -> Option<String> {
    let (kind, object) = owner(m, f, index)?;
    let (first, count) = row(m, f, kind, object)?;
    let noun = super::handle::KINDS.iter().find(|(k, _)| *k == kind).map_or("object", |(_, noun)| noun);
    let name = m.names.of_kind(kind).get(object).map_or("", String::as_str);
    let name = if name.is_empty() { format!("{object}") } else { name.to_owned() };
    let offset = index - first;
    let info = f.info();
    if kind == Obj::Joint {
        let ty = *m.jnt_type.get(object)?;
        let what = match f.rows()? {
            model::nq => coordinate(ty, offset),
            model::nv => rate(ty, offset),
            _ => None,
        };
        if let Some((what, unit)) = what {
            let per = match f {
                data::qvel => format!("{}/s", unit),
                data::qacc | data::qacc_smooth | data::qacc_warmstart => format!("{}/s^2", unit),
                _ if info.name.starts_with("qfrc") => if unit == "m" { "N" } else { "N m" }.to_owned(),
                data::qpos | model::qpos0 | model::qpos_spring => unit.to_owned(),
                _ => String::new(),
            };
            let unit = if per.is_empty() { String::new() } else { format!(", {per}") };
            return Some(format!("{noun} {name} ({}): {what}{unit}", joint_word(ty)));
        }
    }
    let part = match count {
        1 => String::new(),
        3 => format!(" {}", ["x", "y", "z"].get(offset)?),
        4 if info.name.contains("quat") => format!(" quaternion {}", ["w", "x", "y", "z"].get(offset)?),
        _ => format!(" number {offset}"),
    };
    let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
    Some(format!("{noun} {name}:{part} of {}{unit}", f.doc()))
}

fn joint_word(ty: i32) -> &'static str {
    match ty {
        joint::FREE => "free",
        joint::BALL => "ball",
        joint::SLIDE => "slide",
        _ => "hinge",
    }
}

/// The description and the unit of a coordinate of a joint.
fn coordinate(ty: i32, offset: usize) -> Option<(&'static str, &'static str)> {
    const QUATERNION: [&str; 4] =
        ["quaternion w (cosine of half the angle)", "quaternion x", "quaternion y", "quaternion z"];
    Some(match (ty, offset) {
        (joint::FREE, 0..=2) => (["x position", "y position", "z position"].get(offset)?, "m"),
        (joint::FREE, _) => (QUATERNION.get(offset - 3)?, ""),
        (joint::BALL, _) => (QUATERNION.get(offset)?, ""),
        (joint::SLIDE, _) => ("position", "m"),
        _ => ("angle", "rad"),
    })
}

/// The description of a degree of freedom of a joint, and the unit of its coordinate.
fn rate(ty: i32, offset: usize) -> Option<(&'static str, &'static str)> {
    const ROTATIONS: [&str; 3] =
        ["turning about its own x", "turning about its own y", "turning about its own z"];
    Some(match (ty, offset) {
        (joint::FREE, 0..=2) => (["along x", "along y", "along z"].get(offset)?, "m"),
        (joint::FREE, _) => (ROTATIONS.get(offset - 3)?, "rad"),
        (joint::BALL, _) => (ROTATIONS.get(offset)?, "rad"),
        (joint::SLIDE, _) => ("along its axis", "m"),
        _ => ("about its axis", "rad"),
    })
}

/// A component of a quaternion is not an angle.
const QUATERNION: AngleAdvice = AngleAdvice {
    rule: QUATERNION_AS_ANGLE,
    what: "a component of a quaternion",
    why: "it is one of four numbers that give the orientation together",
    help: "write the whole angle as `2 * Math.acos(w)`, with w the first of the four numbers",
};

/// An element of a rotation matrix is not an angle.
const MATRIX: AngleAdvice = AngleAdvice {
    rule: QUATERNION_AS_ANGLE,
    what: "an element of a rotation matrix",
    why: "it is the cosine of the angle between an axis of the object and an axis of the world",
    help: "write `Math.acos(…)` of it for that angle, or `Math.atan2` of two elements for a rotation about an axis",
};

/// The code of sensors that measure a quaternion, in `sensor_datatype`.
const QUATERNION_SENSOR: i32 = 3;

/// Whether the elements of a field change in small steps during a run, so that they rarely equal a number exactly.
pub(super) fn is_continuous(f: FieldId) -> bool {
    let fields = [
        data::time,
        data::qpos,
        data::qvel,
        data::qacc,
        data::act,
        data::xpos,
        data::xipos,
        data::geom_xpos,
        data::site_xpos,
        data::subtree_com,
        data::cvel,
    ];
    fields.contains(&f)
}

/// The role of an element: an angle, a component of a quaternion, an element of a rotation matrix, or none of them.
pub(super) fn role(m: &Model, f: FieldId, index: usize) -> Role {
    let width = reflect::shape(m, f).get(1).copied().flatten();
    let name = f.info().name;
    match f {
        data::qpos => coordinate_role(m, index),
        // A spring may be wound by more than a turn, so that its angle is not compared with degrees.
        model::qpos0 | model::qpos_spring | model::key_qpos => match width {
            Some(0) => Role::Other,
            Some(width) => no_angle(coordinate_role(m, index % width)),
            None => no_angle(coordinate_role(m, index)),
        },
        data::sensordata => match owner(m, f, index) {
            Some((Obj::Sensor, s)) if m.sensor_datatype.get(s) == Some(&QUATERNION_SENSOR) => {
                Role::NoAngle(&QUATERNION)
            }
            _ => Role::Other,
        },
        _ if name.contains("quat") && shape_ends_with(m, f, 4) => Role::NoAngle(&QUATERNION),
        _ if name.contains("mat") && shape_ends_with(m, f, 9) => Role::NoAngle(&MATRIX),
        _ => Role::Other,
    }
}

/// Whether each row of a field has this many numbers.
fn shape_ends_with(m: &Model, f: FieldId, width: usize) -> bool {
    let shape = reflect::shape(m, f);
    shape.len() > 1 && shape.last() == Some(&Some(width))
}

/// The same role without that of an angle.
fn no_angle(role: Role) -> Role {
    if role == Role::Angle { Role::Other } else { role }
}

/// The role of a coordinate of a joint.
fn coordinate_role(m: &Model, index: usize) -> Role {
    let Some((Obj::Joint, object)) = owner(m, data::qpos, index) else { return Role::Other };
    let Some((first, _)) = row(m, data::qpos, Obj::Joint, object) else { return Role::Other };
    match m.jnt_type.get(object) {
        Some(&joint::HINGE) => Role::Angle,
        Some(&joint::FREE) if index - first >= 3 => Role::NoAngle(&QUATERNION),
        Some(&joint::BALL) => Role::NoAngle(&QUATERNION),
        _ => Role::Other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::handle::KINDS;
    use crate::{ModelNames, Scope};
    use labspec_core::reflect::Object;
    use labspec_core::{Data, xml};
    use labspec_expr::{Compiler, Globals};
    use std::path::Path;

    /// Every field with rows for one kind of object can be read by the name of each object that has a row. The named field
    /// contains exactly the elements of that object, and together the named fields cover the whole field.
    #[test]
    fn every_field_of_every_object_has_a_name() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs/models/zoo");
        let mut kinds = std::collections::BTreeSet::new();
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let Some(Ok(m)) = path.is_file().then(|| xml::compile_file(&path)) else { continue };
            let d = Data::new(&m);
            let names = ModelNames::new(&m, Scope::Lab);
            for f in reflect::fields() {
                let info = f.info();
                let Some(dim) = f.rows() else { continue };
                let Some((kind, noun)) = KINDS.iter().find(|(kind, _)| has_rows(*kind, dim)) else {
                    continue;
                };
                let holder = if info.object == Object::Data { "data" } else { "model" };
                let objects = m.names.of_kind(*kind);
                let mut covered = 0;
                for (i, name) in objects.iter().enumerate() {
                    let Some((first, count)) = row(&m, f, *kind, i) else { continue };
                    covered += count;
                    if name.is_empty() || count == 0 || objects.iter().filter(|n| *n == name).count() > 1 {
                        continue;
                    }
                    let short = crate::named_field(f).unwrap();
                    let member = short.rsplit('.').next().unwrap();
                    let text = format!("{holder}.{noun}('{name}').{member}[{}]", count - 1);
                    let mut globals = Globals::new();
                    let compiled = Compiler::new(&names, &mut globals).expression(&text);
                    let program =
                        compiled.program.unwrap_or_else(|| panic!("{text}: {:#?}", compiled.diagnostics));
                    let reads = &program.effects().reads;
                    assert_eq!(
                        (reads[0].field.0, reads[0].first),
                        (f.index() as u32, first + count - 1),
                        "{text}"
                    );
                    kinds.insert(*noun);
                }
                let whole = labspec_core::view(&m, &d, f).unwrap().len();
                assert!(covered == whole || objects.is_empty(), "{} of {}", info.name, path.display());
            }
        }
        println!("{kinds:?}");
        assert!(kinds.len() >= 16, "{kinds:?}");
    }

    #[test]
    fn help_describes_elements() {
        let xml = std::fs::read_to_string(
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/models/ball_drop.xml"),
        );
        let m = xml::compile(&xml.unwrap()).unwrap();
        let names = ModelNames::new(&m, Scope::Lab);
        let help = |source: &str| {
            let mut globals = Globals::new();
            let mut compiler = Compiler::new(&names, &mut globals).explaining();
            let help = compiler.expression(source).help;
            let whole = help.into_iter().find(|(span, _)| span.end - span.start == source.len());
            whole.and_then(|(_, h)| h.lines.first().cloned()).unwrap_or_default()
        };
        for (source, line) in [
            ("data.qpos[9]", "joint light_free (free): z position, m"),
            ("data.qvel[8]", "joint light_free (free): along z, m/s"),
            ("data.qpos[10]", "joint light_free (free): quaternion w (cosine of half the angle)"),
            ("data.joint('heavy_free').qpos[2]", "joint heavy_free (free): z position, m"),
            ("data.xpos[5]", "body heavy: z of position of the body frame, world, m"),
        ] {
            assert_eq!(help(source), line, "{source}");
        }
    }
}
