//! `Fields`: the state, the inputs and everything computed from them, as stages read and write it. The struct comes from the
//! field table.

use super::define;
use super::fields::data_fields;
use super::meter::Meter;
use super::plan::PlanTable;

macro_rules! define_data {
    ($($rows:tt)*) => { define! {
        #[derive(Default)]
        /// State, inputs and results of a simulation, field by field as MuJoCo's `mjData`: what `labspec_core::Data` shows.
        #[allow(non_snake_case)] // MuJoCo's names: M, qLD
        Fields {
            /// Detected contacts of the last position stage.
            pub contact: Vec<Contact>,
            /// Warnings since the last reset, by [`Warning`].
            pub warning: [WarningStat; Warning::COUNT],
            /// Which stages run; see `set_plan`.
            pub plan: PlanTable,
            /// What was done.
            pub meter: Meter,
            /// Controls as they act: delayed and clamped.
            pub(crate) acting: Vec<f64>,
        }
        $($rows)*
    } };
}
data_fields!(define_data);

/// A detected contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contact {
    /// Distance of the nearest points, m; negative is penetration.
    pub dist: f64,
    /// Midpoint between the two surfaces, m, world.
    pub pos: [f64; 3],
    /// Rows: the normal from geom 1 to geom 2 and two tangents, world.
    pub frame: [f64; 9],
    /// Distance at which the contact starts to push, m.
    pub includemargin: f64,
    /// Friction: two sliding, spinning, two rolling.
    pub friction: [f64; 5],
    /// Time constant and damping ratio, or -stiffness and -damping.
    pub solref: [f64; 2],
    /// The same for friction; zero when friction uses `solref`.
    pub solreffriction: [f64; 2],
    /// Impedance.
    pub solimp: [f64; 5],
    /// Force with which the contact pulls, N.
    pub adhesion: f64,
    /// Regularized friction coefficient of the cone.
    pub mu: f64,
    /// Dimension of the contact space: 1, 3, 4 or 6.
    pub dim: usize,
    /// The geom with the smaller type.
    pub geom1: usize,
    /// The other geom.
    pub geom2: usize,
    /// Why it has no rows: 0 it has, 1 it is in the gap, 3 no degree of freedom opens or closes it.
    pub exclude: u8,
    /// First row in the constraint arrays, `None` when not included.
    pub efc_address: Option<usize>,
}

/// Warnings of the simulation, in MuJoCo's order (mjtWarning).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // `name` is what MuJoCo calls each
pub enum Warning {
    Inertia,
    ContactFull,
    ConstraintFull,
    BadQpos,
    BadQvel,
    BadQacc,
    BadCtrl,
}

impl Warning {
    /// Number of kinds.
    pub const COUNT: usize = 7;
    /// All kinds, in order.
    pub const ALL: [Warning; Warning::COUNT] = [
        Warning::Inertia,
        Warning::ContactFull,
        Warning::ConstraintFull,
        Warning::BadQpos,
        Warning::BadQvel,
        Warning::BadQacc,
        Warning::BadCtrl,
    ];

    /// Short name: MuJoCo's, without the prefix and in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Warning::Inertia => "inertia",
            Warning::ContactFull => "contactfull",
            Warning::ConstraintFull => "cnstrfull",
            Warning::BadQpos => "badqpos",
            Warning::BadQvel => "badqvel",
            Warning::BadQacc => "badqacc",
            Warning::BadCtrl => "badctrl",
        }
    }
}

/// How often a warning was raised.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WarningStat {
    /// Number of times since the last reset.
    pub number: usize,
    /// The index that caused it last: a coordinate or a degree of freedom.
    pub lastinfo: usize,
    /// Time of the first occurrence, s, before any automatic reset.
    pub first_time: f64,
}

impl Fields {
    /// Counts a warning; `info` says where.
    pub(crate) fn warn(&mut self, warning: Warning, info: usize) {
        let stat = &mut self.warning[warning as usize];
        if stat.number == 0 {
            stat.first_time = self.time;
        }
        stat.number += 1;
        stat.lastinfo = info;
    }
}
