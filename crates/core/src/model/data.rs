//! `Data`: the state, the inputs and everything computed from them. The struct comes from the field table.

use crate::constraint::{Islands, Jacobian, Scratch};
use crate::dynamics::jacobian::Columns;
use crate::dynamics::path::Path;
use crate::dynamics::{articulated, chain, kinematics};
use crate::forces::derivative;
use crate::model::define;
use crate::model::fields::data_fields;
use crate::model::meter::Meter;
use crate::sensor::Match;
use crate::step::{forward, reset, sleep};
use crate::step::{integrate::Metric, integrate::RungeKutta};
use crate::step::{plan::Demand, plan::Plan};
use crate::{Model, collision};

macro_rules! define_data {
    ($($rows:tt)*) => { define! {
        /// State, inputs and results of a simulation, field by field as MuJoCo's `mjData`.
        #[allow(non_snake_case)] // MuJoCo's names: M, qLD
        Data {
            /// Detected contacts of the last position stage.
            pub contact: Vec<Contact>,
            /// Warnings since the last reset, by [`Warning`].
            pub warning: [WarningStat; Warning::COUNT],
            /// Which stages run; see `set_plan`.
            pub(crate) plan: Plan,
            /// Intermediate results that are nobody's business, kept so that steps do not allocate.
            pub(crate) work: Work,
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
    /// 0 included, 1 in the gap, 3 no degree of freedom affected.
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

/// Intermediate results of the stages.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Work {
    /// What was done.
    pub(crate) meter: Meter,
    /// Pairs of geoms to test.
    pub(crate) pairs: collision::Pairs,
    /// Contacts of one pair of geoms.
    pub(crate) narrow: crate::geometry::Narrow,
    /// Jacobian of the constraints.
    pub(crate) jac: Jacobian,
    /// Columns of one contact's Jacobian.
    pub(crate) columns: Option<Box<Columns>>,
    /// Taken out while the solver works with them.
    pub(crate) islands: Option<Box<Islands>>,
    pub(crate) solver: Option<Box<Scratch>>,
    /// Trees of a few slides and hinges.
    pub(crate) chains: chain::Chains,
    pub(crate) frames: kinematics::Frames,
    /// Trees of many degrees of freedom.
    pub(crate) articulated: articulated::Articulated,
    /// Motions of ancestors, for rows of M.
    pub(crate) path: Path,
    /// Spatial accelerations and forces of bodies.
    pub(crate) cacc: Vec<f64>,
    pub(crate) cfrc: Vec<f64>,
    /// M v.
    pub(crate) mv: Vec<f64>,
    /// Factorization of M + h B, and the acceleration it gives.
    pub(crate) ld: Vec<f64>,
    pub(crate) diag_inv: Vec<f64>,
    pub(crate) qacc: Vec<f64>,
    /// Whether `qacc` is that of Euler's method with implicit damping, for the forces of this step.
    pub(crate) damped: bool,
    /// What implicit damping adds to the diagonal of M.
    pub(crate) damping: Vec<f64>,
    pub(crate) rk: RungeKutta,
    /// Contacts that pass the filter of a sensor.
    pub(crate) matches: Vec<Match>,
    /// What sleeping trees keep.
    pub(crate) sleep: sleep::Work,
    /// Controls as they act: delayed and clamped.
    pub(crate) ctrl: Vec<f64>,
    /// Sums of the forces of actuators on each tendon.
    pub(crate) tendon_force: Vec<f64>,
    /// A row of the moments of actuators.
    pub(crate) moment: Vec<f64>,
    /// Derivatives of forces with respect to velocities.
    pub(crate) derivative: derivative::Work,
    /// The metric of the discrete integrator.
    pub(crate) metric: Metric,
}

impl Data {
    /// Counts a warning; `info` says where.
    pub(crate) fn warn(&mut self, warning: Warning, info: usize) {
        let stat = &mut self.warning[warning as usize];
        if stat.number == 0 {
            stat.first_time = self.time;
        }
        stat.number += 1;
        stat.lastinfo = info;
    }

    /// Data for a model, at the default configuration. Nothing is computed yet: call `forward`.
    ///
    /// The plan allows any field to be read or written at any time: see `Data::planned` for less work.
    pub fn new(m: &Model) -> Data {
        Data::planned(m, Plan::new(m, &Demand::ANY))
    }

    /// Data that computes only what a plan keeps.
    pub fn planned(m: &Model, plan: Plan) -> Data {
        let mut d = Data::unplanned(m);
        forward::set_plan(m, &mut d, plan);
        d
    }

    /// Data with the full pipeline and no collision pairs.
    pub(crate) fn unplanned(m: &Model) -> Data {
        let mut d = Data { plan: Plan::awake(), ..Data::default() };
        let w = &mut d.work;
        w.meter = Meter::new(m);
        w.chains = chain::Chains::new(m);
        w.frames = kinematics::Frames::new(m);
        w.articulated = articulated::Articulated::new(m);
        w.path = Path::new(m);
        w.cacc = vec![0.0; 6 * m.nbody];
        w.cfrc = vec![0.0; 6 * m.nbody];
        w.islands = Some(Box::default());
        w.solver = Some(Box::default());
        w.columns = Some(Box::new(Columns::with_room(m.nv)));
        w.ld = vec![0.0; m.nC];
        (w.ctrl, w.tendon_force) = (vec![0.0; m.nu], vec![0.0; m.ntendon]);
        w.moment = vec![0.0; m.nv];
        w.rk = RungeKutta::new(m);
        w.sleep = sleep::Work::new(m);
        for v in [&mut w.mv, &mut w.diag_inv, &mut w.qacc, &mut w.damping] {
            *v = vec![0.0; m.nv];
        }
        reset::reset_data(m, &mut d);
        d
    }

    /// The plan that decides what is computed.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }
}
