//! The table of sensors. For each type: its name in MJCF, what it senses, the kind of its values, the stage in which
//! they are available, the results that it needs, and the function that reads it.
//!
//! The compiler, the evaluation, the plan and the schema are generated from this table. Order and numbers are those
//! of mjtSensor; the meaning follows MuJoCo's XML reference, chapter "sensor".

use super::SensorScratch;
use super::contact_sensor;
use super::frame_sensor;
use super::measure;
use super::pair;
use super::rays;
use crate::model::stage::Stage;
use crate::model::{Fields, Model};

/// What a sensor senses. It determines the attributes in MJCF.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorTarget {
    /// No particular object.
    Nothing,
    /// A site.
    Site,
    /// A site, or every pixel of a camera, with a list of data fields.
    Ray,
    /// A site in the image of a camera.
    SiteInImage,
    /// A slide or hinge joint.
    ScalarJoint,
    /// A ball joint.
    BallJoint,
    /// A joint with limits.
    LimitedJoint,
    /// A tendon.
    Tendon,
    /// A tendon with limits.
    LimitedTendon,
    /// An actuator.
    Actuator,
    /// The frame of a body, geom, site or camera.
    Frame,
    /// The frame of a body, geom, site or camera, optionally relative to another frame.
    RelativeFrame,
    /// The frame of a body, geom, site or camera, and the volume of a site.
    FrameInSite,
    /// A body with its descendants.
    Subtree,
    /// Two objects, each a geom or a body with all its geoms.
    Pair,
    /// Contacts, filtered by geom, body, subtree or site, with a list of data fields.
    Contacts,
    /// Defined by the user.
    User,
    /// The vertices of a mesh, as taxels. Not supported.
    Tactile,
    /// Defined by a plugin. Not supported.
    Plugin,
}

/// The kind of the values of a sensor, which determines the effect of a cutoff (mjtDataType).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Datatype {
    /// Any number: clamped on both sides.
    Real,
    /// Zero or positive; a negative value means that nothing was measured. Clamped from above.
    Positive,
    /// A unit vector: cannot be clamped.
    Axis,
    /// A unit quaternion: cannot be clamped.
    Quaternion,
}

/// The stage in which the values of a sensor are available (mjtStage).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // positions; velocities; accelerations and forces are available
pub enum SensorStage {
    Position = 1,
    Velocity = 2,
    Acceleration = 3,
}

/// Reads a sensor. Arguments: model, data, scratch (in `With`), index of the sensor, its values.
#[derive(Clone, Copy, Debug)]
pub(super) enum Read {
    Of(fn(&Model, &mut Fields, usize, &mut [f64])),
    With(fn(&Model, &mut Fields, &mut SensorScratch, usize, &mut [f64])),
}

/// A row of the table.
#[derive(Debug)]
pub struct SensorKind {
    /// The element in MJCF.
    pub name: &'static str,
    /// What it senses.
    pub senses: SensorTarget,
    /// Number of values; 0 if the sensed object or parameters of the sensor determine it.
    pub dim: i32,
    /// The kind of the values.
    pub datatype: Datatype,
    /// The stage in which they are available.
    pub when: SensorStage,
    /// Their unit. For joints and actuators: that of a slide, then that of a hinge. Empty if it depends on more.
    pub unit: &'static str,
    /// The stages whose results they are computed from, besides the poses of the sensed objects.
    pub(super) needs: &'static [Stage],
    pub(super) read: Read,
}

macro_rules! kinds {
    ($($id:ident $name:literal $senses:ident $dim:literal $datatype:ident $unit:literal $when:ident [$($needs:ident)*] $how:ident $read:expr;)*) => {
        #[allow(non_camel_case_types, clippy::upper_case_acronyms, dead_code)] // the names of the constants
        enum Number { $($id),* }
        /// Types of sensors, values of `sensor_type` (mjtSensor).
        #[allow(missing_docs, dead_code)] // named as in MJCF; some are not used here
        pub mod kind {
            use super::Number;
            $(pub(crate) const $id: i32 = Number::$id as i32;)*
        }
        /// All kinds of sensors, by their number.
        pub static KINDS: [SensorKind; [$($name),*].len()] = [$(SensorKind {
            name: $name,
            senses: SensorTarget::$senses,
            dim: $dim,
            datatype: Datatype::$datatype,
            unit: $unit,
            when: SensorStage::$when,
            needs: &[$(Stage::$needs),*],
            read: Read::$how($read),
        }),*];
    };
}
kinds! {
    TOUCH "touch" Site 1 Positive "N" Acceleration [] Of contact_sensor::touch;
    ACCELEROMETER "accelerometer" Site 3 Real "m/s^2" Acceleration [RnePost] Of frame_sensor::accelerometer;
    VELOCIMETER "velocimeter" Site 3 Real "m/s" Velocity [ComVel] Of frame_sensor::velocimeter;
    GYRO "gyro" Site 3 Real "rad/s" Velocity [ComVel] Of frame_sensor::gyro;
    FORCE "force" Site 3 Real "N" Acceleration [RnePost] Of frame_sensor::force;
    TORQUE "torque" Site 3 Real "N m" Acceleration [RnePost] Of frame_sensor::torque;
    MAGNETOMETER "magnetometer" Site 3 Real "" Position [] Of frame_sensor::magnetometer;
    RANGEFINDER "rangefinder" Ray 0 Real "" Position [GeomPoses] Of rays::rangefinder;
    CAMPROJECTION "camprojection" SiteInImage 2 Real "" Position [] Of rays::camera_projection;
    JOINTPOS "jointpos" ScalarJoint 1 Real "m or rad" Position [] Of measure::joint_position;
    JOINTVEL "jointvel" ScalarJoint 1 Real "m/s or rad/s" Velocity [] Of measure::joint_velocity;
    TENDONPOS "tendonpos" Tendon 1 Real "m" Position [Tendon] Of measure::tendon_length;
    TENDONVEL "tendonvel" Tendon 1 Real "m/s" Velocity [TendonVel] Of measure::tendon_velocity;
    ACTUATORPOS "actuatorpos" Actuator 0 Real "m or rad" Position [Transmission] Of measure::actuator_length;
    ACTUATORVEL "actuatorvel" Actuator 0 Real "m/s or rad/s" Velocity [ActuatorVel] Of measure::actuator_velocity;
    ACTUATORFRC "actuatorfrc" Actuator 0 Real "N or N m" Acceleration [Actuation] Of measure::actuator_force;
    JOINTACTFRC "jointactuatorfrc" ScalarJoint 1 Real "N or N m" Acceleration [Actuation] Of measure::joint_actuator_force;
    TENDONACTFRC "tendonactuatorfrc" Tendon 1 Real "N" Acceleration [Actuation] Of measure::tendon_actuator_force;
    BALLQUAT "ballquat" BallJoint 4 Quaternion "1" Position [] Of measure::ball_orientation;
    BALLANGVEL "ballangvel" BallJoint 3 Real "rad/s" Velocity [] Of measure::ball_velocity;
    JOINTLIMITPOS "jointlimitpos" LimitedJoint 1 Real "m or rad" Position [] Of measure::joint_limit_distance;
    JOINTLIMITVEL "jointlimitvel" LimitedJoint 1 Real "m/s or rad/s" Velocity [] Of measure::joint_limit_velocity;
    JOINTLIMITFRC "jointlimitfrc" LimitedJoint 1 Real "N or N m" Acceleration [] Of measure::joint_limit_force;
    TENDONLIMITPOS "tendonlimitpos" LimitedTendon 1 Real "m" Position [] Of measure::tendon_limit_distance;
    TENDONLIMITVEL "tendonlimitvel" LimitedTendon 1 Real "m/s" Velocity [] Of measure::tendon_limit_velocity;
    TENDONLIMITFRC "tendonlimitfrc" LimitedTendon 1 Real "N" Acceleration [] Of measure::tendon_limit_force;
    FRAMEPOS "framepos" RelativeFrame 3 Real "m" Position [] Of frame_sensor::position;
    FRAMEQUAT "framequat" RelativeFrame 4 Quaternion "1" Position [] Of frame_sensor::orientation;
    FRAMEXAXIS "framexaxis" RelativeFrame 3 Axis "1" Position [] Of frame_sensor::axis::<0>;
    FRAMEYAXIS "frameyaxis" RelativeFrame 3 Axis "1" Position [] Of frame_sensor::axis::<1>;
    FRAMEZAXIS "framezaxis" RelativeFrame 3 Axis "1" Position [] Of frame_sensor::axis::<2>;
    FRAMELINVEL "framelinvel" RelativeFrame 3 Real "m/s" Velocity [ComVel] Of frame_sensor::linear_velocity;
    FRAMEANGVEL "frameangvel" RelativeFrame 3 Real "rad/s" Velocity [ComVel] Of frame_sensor::angular_velocity;
    FRAMELINACC "framelinacc" Frame 3 Real "m/s^2" Acceleration [RnePost] Of frame_sensor::linear_acceleration;
    FRAMEANGACC "frameangacc" Frame 3 Real "rad/s^2" Acceleration [RnePost] Of frame_sensor::angular_acceleration;
    SUBTREECOM "subtreecom" Subtree 3 Real "m" Position [ComPos] Of measure::subtree_com;
    SUBTREELINVEL "subtreelinvel" Subtree 3 Real "m/s" Velocity [SubtreeVel] Of measure::subtree_velocity;
    SUBTREEANGMOM "subtreeangmom" Subtree 3 Real "kg m^2/s" Velocity [SubtreeVel] Of measure::subtree_angular_momentum;
    INSIDESITE "insidesite" FrameInSite 1 Positive "1" Position [] Of frame_sensor::inside_site;
    GEOMDIST "distance" Pair 1 Real "m" Position [GeomPoses] With pair::distance;
    GEOMNORMAL "normal" Pair 3 Axis "1" Position [GeomPoses] With pair::normal;
    GEOMFROMTO "fromto" Pair 6 Real "m" Position [GeomPoses] With pair::from_to;
    CONTACT "contact" Contacts 0 Real "" Acceleration [] With contact_sensor::contacts;
    E_POTENTIAL "e_potential" Nothing 1 Real "J" Position [Kinematics Tendon] Of measure::potential_energy;
    E_KINETIC "e_kinetic" Nothing 1 Real "J" Position [MassMatrix] Of measure::kinetic_energy;
    CLOCK "clock" Nothing 1 Real "s" Position [] Of measure::clock;
    TACTILE "tactile" Tactile 0 Real "" Acceleration [] Of measure::no_measurement;
    PLUGIN "plugin" Plugin 0 Real "" Acceleration [] Of measure::no_measurement;
    USER "user" User 0 Real "" Acceleration [] Of measure::no_measurement;
}

/// The row of sensor `s`. An unknown type counts as a user sensor, for which nothing is measured: its values are zero.
pub fn for_sensor(m: &Model, s: usize) -> &'static SensorKind {
    let number = usize::try_from(m.sensor_type[s]).unwrap_or(usize::MAX);
    KINDS.get(number).unwrap_or(&KINDS[Number::USER as usize])
}

#[cfg(test)]
mod tests {
    use super::{KINDS, kind};

    #[test]
    fn numbers_are_those_of_mujoco() {
        assert_eq!(KINDS.len(), 49);
        for (name, number) in [("touch", 0), ("jointpos", 9), ("framepos", 26), ("contact", 42), ("user", 48)]
        {
            assert_eq!(KINDS[number].name, name);
        }
        assert_eq!((kind::SUBTREECOM, kind::CLOCK, kind::TACTILE), (35, 45, 46));
    }
}
