//! Sensors: `sensordata`, computed in each stage for the sensors whose inputs are then available.
//!
//! All properties of a type of sensor are in one `table`. The functions that read sensors are in the other files,
//! grouped by their inputs. The meaning of each sensor follows MuJoCo's XML reference, chapter "sensor".

pub mod body_force;
mod contact_sensor;
mod data_layout;
mod frame_sensor;
mod measure;
mod needs_search;
mod pair;
mod rays;
mod table;
mod tension;
mod timing;

pub use data_layout::{CONTACT_DATA, RAY_DATA, size as data_size};
pub use needs_search::searched_pair;
pub(crate) use timing::{record, reset};

use contact_sensor::ContactMatch;
use table::Read;
pub use table::{Datatype, KINDS, SensorKind, SensorStage, SensorTarget, for_sensor, kind};

use crate::geometry::Narrow;
use crate::kinds::{disable, joint};
use crate::model::sensed::Values;
use crate::model::stage::Stage;
use crate::model::{Fields, Model, Obj, asleep};
use std::ops::Range;

/// Scratch memory of sensors, allocated once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorScratch {
    /// Contacts that pass the filter of a sensor.
    matches: Vec<ContactMatch>,
    /// Scratch for distances.
    pub narrow: Narrow,
    /// Centres (m, world frame) and radii (m) of the bounding spheres of the geoms of a body.
    bounds: Vec<([f64; 3], f64)>,
}

/// The unit of the values of a sensor, as in its row of the table. `m or rad` means m for a slide and rad for a
/// hinge. Empty if there is no unit, or if it is not known.
pub fn unit(m: &Model, s: usize) -> &'static str {
    let kind = m.sensor_type.get(s).and_then(|&t| KINDS.get(usize::try_from(t).ok()?));
    kind.map_or("", |k| k.unit)
}

/// The range of the values of a sensor in `sensordata`.
pub fn places(m: &Model, s: usize) -> Range<usize> {
    let first = m.sensor_adr[s] as usize;
    first..first + m.sensor_dim[s] as usize
}

/// Whether any value of a sensor is read.
pub fn is_read(m: &Model, s: usize, sensed: Values) -> bool {
    sensed.some(places(m, s))
}

/// Evaluates the sensors of a stage that are read. While sensors are disabled, their values do not change.
pub fn evaluate(m: &Model, d: &mut Fields, w: &mut SensorScratch, when: SensorStage) {
    if m.opt.disabled(disable::SENSOR) || d.meter.over() {
        return;
    }
    for (s, &stage) in m.sensor_needstage.iter().enumerate() {
        if stage == when as i32 {
            show(m, d, w, s);
        }
    }
}

/// Writes the values of sensor `s`, if it is read: past values, or the current measurement. If everything that it
/// measures sleeps, the values do not change.
#[inline(never)] // most sensors belong to another stage
fn show(m: &Model, d: &mut Fields, w: &mut SensorScratch, s: usize) {
    if (d.plan.every_sensor || is_read(m, s, d.plan.sensed)) && !sleeps(m, d, s) {
        // `sensordata` is taken out because reading a sensor needs the data mutably; this allocates nothing.
        let mut values = std::mem::take(&mut d.sensordata);
        let out = &mut values[places(m, s)];
        if !timing::past(m, d, s, out) {
            read(m, d, w, s, out);
        }
        d.sensordata = values;
    }
}

/// Whether everything that sensor `s` measures sleeps or cannot move, so that its values do not change.
fn sleeps(m: &Model, d: &Fields, s: usize) -> bool {
    if !asleep::some(m, d) {
        return false;
    }
    let types = [m.sensor_objtype[s], m.sensor_reftype[s]];
    let [object, reference] = [(types[0], m.sensor_objid[s]), (types[1], m.sensor_refid[s])]
        .map(|(kind, id)| usize::try_from(id).ok().and_then(|id| asleep::of_object(m, d, kind, id)));
    match m.sensor_type[s] {
        kind::USER | kind::RANGEFINDER => false,
        kind::CONTACT if types.contains(&(Obj::Site as i32)) => false,
        _ => match (object, reference) {
            (None, None) => false,
            (Some(one), None) | (None, Some(one)) => one == asleep::awake::NO,
            (Some(a), Some(b)) => a != asleep::awake::YES && b != asleep::awake::YES,
        },
    }
}

/// Measures the current values of sensor `s` and applies its cutoff. The cutoff of `fromto` applies to the distance,
/// not to the points; contact sensors have no cutoff.
fn read(m: &Model, d: &mut Fields, w: &mut SensorScratch, s: usize, out: &mut [f64]) {
    match for_sensor(m, s).read {
        Read::Of(read) => read(m, d, s, out),
        Read::With(read) => read(m, d, w, s, out),
    }
    let cutoff = m.sensor_cutoff[s];
    if cutoff <= 0.0 || matches!(m.sensor_type[s], kind::GEOMFROMTO | kind::CONTACT) {
        return;
    }
    let lowest = match m.sensor_datatype[s] {
        t if t == Datatype::Real as i32 => -cutoff,
        t if t == Datatype::Positive as i32 => f64::NEG_INFINITY,
        _ => return,
    };
    for x in out {
        *x = x.max(lowest).min(cutoff);
    }
}

/// Whether the objects of sensor `s` exist and are of the kind that its type needs.
pub(crate) fn fits(m: &Model, s: usize) -> bool {
    let within = |id: i32, n: usize| usize::try_from(id).is_ok_and(|id| id < n);
    let (kind, id) = (m.sensor_objtype[s], m.sensor_objid[s]);
    let (other, reference) = (m.sensor_reftype[s], m.sensor_refid[s]);
    let joint = usize::try_from(id).ok().and_then(|j| m.jnt_type.get(j)).copied();
    let solid = |kind: i32, id: i32| match kind {
        k if k == Obj::Body as i32 => within(id, m.nbody),
        k if k == Obj::Geom as i32 => within(id, m.ngeom),
        _ => false,
    };
    // The object of a contact filter must exist or be unspecified.
    let takes_part = |kind: i32, id: i32| match kind {
        k if k == Obj::XBody as i32 => within(id, m.nbody),
        k if k == Obj::Site as i32 => within(id, m.nsite),
        0 => true,
        _ => solid(kind, id),
    };
    match for_sensor(m, s).senses {
        SensorTarget::Site => within(id, m.nsite),
        SensorTarget::SiteInImage => within(id, m.nsite) && within(reference, m.ncam),
        SensorTarget::Ray if kind == Obj::Camera as i32 => within(id, m.ncam),
        SensorTarget::Ray => within(id, m.nsite),
        SensorTarget::ScalarJoint => matches!(joint, Some(joint::SLIDE | joint::HINGE)),
        SensorTarget::BallJoint => joint == Some(joint::BALL),
        SensorTarget::LimitedJoint => joint.is_some(),
        SensorTarget::Tendon | SensorTarget::LimitedTendon => within(id, m.ntendon),
        SensorTarget::Actuator => {
            within(id, m.nactuator) && m.actuator_outnum[id as usize] == m.sensor_dim[s]
        }
        SensorTarget::Subtree => within(id, m.nbody),
        SensorTarget::Pair => solid(kind, id) && solid(other, reference),
        SensorTarget::FrameInSite => within(reference, m.nsite),
        SensorTarget::Contacts => takes_part(kind, id) && takes_part(other, reference),
        _ => true,
    }
}

/// Whether any sensor of the model uses the results of a stage.
pub(crate) fn needs(m: &Model, stage: Stage) -> bool {
    needs_of(m, stage, |_| true)
}

/// Whether any of the selected sensors uses the results of a stage.
pub(crate) fn needs_of(m: &Model, stage: Stage, among: impl Fn(usize) -> bool) -> bool {
    (0..m.nsensor).filter(|&s| among(s)).any(|s| {
        for_sensor(m, s).needs.contains(&stage)
            || poses(stage, m.sensor_objtype[s])
            || poses(stage, m.sensor_reftype[s])
            || m.sensor_type[s] == kind::USER && must_run_for_user_sensors(stage, m.sensor_needstage[s])
    })
}

/// Whether a stage computes the frames of a type of object.
fn poses(stage: Stage, objtype: i32) -> bool {
    let kinds: &[Obj] = match stage {
        Stage::Kinematics => &[Obj::Body, Obj::XBody],
        Stage::GeomPoses => &[Obj::Geom],
        Stage::SitePoses => &[Obj::Site],
        Stage::CameraPoses => &[Obj::Camera],
        _ => &[],
    };
    kinds.iter().any(|&k| k as i32 == objtype)
}

/// Whether a stage must run for user sensors, which may read all results that are available in their stage.
fn must_run_for_user_sensors(stage: Stage, needstage: i32) -> bool {
    match stage {
        Stage::SubtreeVel => needstage == SensorStage::Velocity as i32,
        Stage::RnePost => needstage == SensorStage::Acceleration as i32,
        _ => false,
    }
}

/// Whether any sensor measures the potential energy, and therefore computes it while the energy flag is off.
pub(crate) fn measures_potential(m: &Model) -> bool {
    m.sensor_type.contains(&kind::E_POTENTIAL)
}

/// Whether any sensor measures an energy.
pub(crate) fn measures_energy(m: &Model) -> bool {
    measures_potential(m) || m.sensor_type.contains(&kind::E_KINETIC)
}

/// Copies N numbers to the values of a sensor.
fn put<const N: usize>(out: &mut [f64], value: [f64; N]) {
    if let Some(to) = out.first_chunk_mut::<N>() {
        *to = value;
    }
}
