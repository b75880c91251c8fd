//! The dimension of every element of every field: the unit in the field's row of the table. Where the unit depends on the
//! element, the type of its joint, actuator or sensor decides.

use super::{elements, units};
use labspec_core::reflect::{Elem, FieldId, data, model};
use labspec_core::{
    self as core, Model, Obj, biastype, dyntype, gaintype, joint, reflect, trntype, wraptype,
};
use labspec_expr::dimension::{Dimension, Measure};

/// The maximum number of elements that are analysed one by one; the dimension of a larger part of a field is unknown.
const MAX_ELEMENTS: usize = 4096;

/// The maximum number of elements for which one unit is searched among several.
const MAX_UNIT_ELEMENTS: usize = 256;

/// Whether a motion is a translation or a rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MotionKind {
    Along,
    Turning,
    /// A component of a quaternion, which has no dimension itself.
    Number,
}

/// The dimension of a range of elements of a field, if it is the same for all of them.
pub(super) fn measure(m: &Model, f: FieldId, first: usize, count: Option<usize>) -> Measure {
    let shape = reflect::shape(m, f);
    let size = shape.iter().try_fold(1usize, |n, dim| n.checked_mul((*dim)?));
    let last = match (count, size) {
        (Some(count), _) => first.saturating_add(count),
        (None, Some(size)) => size,
        // The number of rows changes during a run; the unit of the field applies to each row.
        (None, None) => first + 1,
    };
    if last.saturating_sub(first) > MAX_ELEMENTS {
        return Measure::Unknown;
    }
    let mut all = (first..last).map(|index| element(m, f, &shape, index));
    let start = all.next().unwrap_or_default();
    all.fold(start, |common, next| if common == next { common } else { Measure::Unknown })
}

/// The unit of a range of elements: where the field's row has several, or none because the object decides, the one that is
/// certain for all of these elements. Empty if they have no unit.
pub(super) fn unit(m: &Model, f: FieldId, first: usize, count: Option<usize>) -> String {
    let declared = f.unit();
    let is_open = declared.contains(" or ") || declared.contains(", ");
    let of_objects = declared.is_empty() && [data::sensordata, data::ctrl].contains(&f);
    if !(is_open || of_objects) || count.is_some_and(|count| count > MAX_UNIT_ELEMENTS) {
        return declared.to_string();
    }
    let Measure::Dimension(dimension) = measure(m, f, first, count) else { return declared.to_string() };
    let parts = declared.split(" or ").flat_map(|part| part.split(", "));
    let mut same = parts.filter(|part| units::parse(part) == Some(dimension));
    match same.next() {
        Some(part) => part.to_string(),
        None if dimension.is_number() => String::new(),
        None => units::written(&dimension),
    }
}

/// The dimension of one element.
fn element(m: &Model, f: FieldId, shape: &[Option<usize>], index: usize) -> Measure {
    let info = f.info();
    if info.elem != Elem::F64 {
        return Measure::Dimension(Dimension::NUMBER);
    }
    // Negative values of these parameters have another meaning.
    if info.name.contains("solref") {
        return Measure::Unknown;
    }
    let dim = f.rows();
    match f {
        data::sensordata => return sensor(m, f, index),
        data::ctrl => return control(m, index),
        model::actuator_ctrlrange => return control(m, index / 2),
        _ => {}
    }
    if f.unit().is_empty() {
        let turned = ["quat", "mat", "axis", "xdir"].iter().any(|part| info.name.contains(part));
        return if turned { Measure::Dimension(Dimension::NUMBER) } else { Measure::Unknown };
    }
    let width: usize = shape.iter().skip(1).map(|d| d.unwrap_or(1)).product();
    let Some(unit) = part(f.unit(), index % width.max(1), width) else { return Measure::Unknown };
    let Some((along, turning)) = unit.split_once(" or ") else { return read(unit) };
    let motion = match dim {
        Some(dim @ (model::nq | model::nv | model::njnt)) => joint_motion(m, f, dim, index),
        // A keyframe is a row of coordinates.
        Some(model::nkey) => row_motion(m, f, index % width.max(1)),
        Some(model::nout | model::nactuator) => {
            elements::owner(m, f, index).and_then(|(_, i)| actuator_motion(m, i))
        }
        _ => None,
    };
    match motion {
        Some(MotionKind::Along) => read(along),
        Some(MotionKind::Turning) => read(turning),
        Some(MotionKind::Number) => Measure::Dimension(Dimension::NUMBER),
        None => Measure::Unknown,
    }
}

fn read(unit: &str) -> Measure {
    units::parse(unit).map_or(Measure::Unknown, Measure::Dimension)
}

/// The unit of one number in a row: `1, m, m` has one unit for each of three numbers; `N, N m` has one for
/// each half of six numbers.
fn part(unit: &str, index: usize, width: usize) -> Option<&str> {
    let parts: Vec<&str> = unit.split(", ").collect();
    let which = match (parts.len(), width) {
        (1, _) => 0,
        (n, w) if n == w => index,
        (2, 6) => index / 3,
        // An inertia has one number of the third unit, three of the second and six of the first.
        (3, 10) => [0, 0, 0, 0, 0, 0, 1, 1, 1, 2].get(index).copied()?,
        _ => return None,
    };
    parts.get(which).copied()
}

/// The motion of the joint to which an element belongs.
fn joint_motion(m: &Model, f: FieldId, dim: FieldId, index: usize) -> Option<MotionKind> {
    let (Obj::Joint, object) = elements::owner(m, f, index)? else { return None };
    let (first, _) = elements::row(m, f, Obj::Joint, object)?;
    motion(*m.jnt_type.get(object)?, index - first, dim)
}

/// The motion of a coordinate of a joint.
fn motion(ty: i32, offset: usize, dim: FieldId) -> Option<MotionKind> {
    Some(match (ty, dim) {
        (joint::SLIDE, _) => MotionKind::Along,
        (joint::HINGE, _) => MotionKind::Turning,
        // The limits of a ball joint apply to its angle.
        (joint::BALL, model::njnt) => MotionKind::Turning,
        (joint::FREE, model::nq | model::nv) if offset < 3 => MotionKind::Along,
        (joint::FREE | joint::BALL, model::nq) => MotionKind::Number,
        (joint::FREE | joint::BALL, model::nv) => MotionKind::Turning,
        _ => return None,
    })
}

/// The motion of a coordinate in a keyframe.
fn row_motion(m: &Model, f: FieldId, index: usize) -> Option<MotionKind> {
    let (starts, dim) = match f {
        model::key_qpos => (&m.jnt_qposadr, model::nq),
        model::key_qvel => (&m.jnt_dofadr, model::nv),
        _ => return None,
    };
    let (object, first) = starts.iter().enumerate().rev().find(|(_, first)| **first as usize <= index)?;
    motion(*m.jnt_type.get(object)?, index - *first as usize, dim)
}

/// The motion that an actuator causes, if its gear does not change units.
fn actuator_motion(m: &Model, actuator: usize) -> Option<MotionKind> {
    let out = usize::try_from(*m.actuator_outadr.get(actuator)?).ok()?;
    let gear = m.actuator_gear.get(6 * out..6 * out + 6)?;
    let target = usize::try_from(*m.actuator_trnid.get(2 * actuator)?).ok();
    match *m.actuator_trntype.get(actuator)? {
        trntype::JOINT | trntype::JOINTINPARENT if gear.first()?.abs() == 1.0 => {
            match *m.jnt_type.get(target?)? {
                joint::SLIDE => Some(MotionKind::Along),
                joint::HINGE => Some(MotionKind::Turning),
                _ => None,
            }
        }
        trntype::TENDON if gear.first()?.abs() == 1.0 => tendon_motion(m, target?),
        trntype::SLIDERCRANK => Some(MotionKind::Along),
        _ => None,
    }
}

/// The motion of a tendon: a spatial tendon has a length; a fixed tendon has one if all its coordinates are lengths.
fn tendon_motion(m: &Model, tendon: usize) -> Option<MotionKind> {
    let first = usize::try_from(*m.tendon_adr.get(tendon)?).ok()?;
    let count = usize::try_from(*m.tendon_num.get(tendon)?).ok()?;
    let along = |index: usize| {
        let kind = m.wrap_type.get(index).copied().unwrap_or(wraptype::PULLEY);
        let target = m.wrap_objid.get(index).and_then(|j| usize::try_from(*j).ok());
        kind != wraptype::JOINT || target.and_then(|j| m.jnt_type.get(j)) == Some(&joint::SLIDE)
    };
    (first..first + count).all(along).then_some(MotionKind::Along)
}

/// The dimension of a control: the force of a motor, or the target position or velocity of a servo.
fn control(m: &Model, address: usize) -> Measure {
    let object =
        (0..m.nactuator).find(|i| m.actuator_ctrladr.get(*i).is_some_and(|a| *a as usize == address));
    let Some(i) = object.filter(|i| m.actuator_ctrlnum.get(*i) == Some(&1)) else { return Measure::Unknown };
    let Some(motion) = actuator_motion(m, i) else { return Measure::Unknown };
    let prm = |list: &[f64], k: usize| list.get(10 * i + k).copied().unwrap_or(f64::NAN);
    let (gain, bias) = (prm(&m.actuator_gainprm, 0), [1, 2].map(|k| prm(&m.actuator_biasprm, k)));
    let is = |list: &[i32], kind: i32| list.get(i) == Some(&kind);
    let fixed = is(&m.actuator_gaintype, gaintype::FIXED) && is(&m.actuator_dyntype, dyntype::NONE);
    let affine = is(&m.actuator_biastype, biastype::AFFINE);
    let unit = match bias {
        _ if !fixed => return Measure::Unknown,
        _ if is(&m.actuator_biastype, biastype::NONE) && gain == 1.0 => ["N", "N m"],
        [position, _] if affine && gain != 0.0 && position == -gain => ["m", "rad"],
        [0.0, velocity] if affine && gain != 0.0 && velocity == -gain => ["m/s", "rad/s"],
        _ => return Measure::Unknown,
    };
    read(if motion == MotionKind::Along { unit[0] } else { unit[1] })
}

/// The dimension of a value of a sensor.
fn sensor(m: &Model, f: FieldId, index: usize) -> Measure {
    let Some((Obj::Sensor, s)) = elements::owner(m, f, index) else { return Measure::Unknown };
    let unit = core::sensor_unit(m, s);
    let Some((along, turning)) = unit.split_once(" or ") else { return read(unit) };
    let object = m.sensor_objid.get(s).and_then(|o| usize::try_from(*o).ok());
    let kind = m.sensor_objtype.get(s).copied();
    let motion = match object {
        Some(o) if kind == Some(Obj::Joint as i32) => {
            m.jnt_type.get(o).and_then(|ty| motion(*ty, 0, model::njnt))
        }
        Some(o) if kind == Some(Obj::Actuator as i32) => actuator_motion(m, o),
        _ => None,
    };
    match motion {
        Some(MotionKind::Along) => read(along),
        Some(MotionKind::Turning) => read(turning),
        _ => Measure::Unknown,
    }
}
