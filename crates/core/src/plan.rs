//! The plan: which stages a scene needs, with the reason for each, decided once and followed by every step.
//!
//! It follows from the structure of the model, from what will be read, and from what will be written: a
//! parameter that some program writes is treated as if it had any value. A plan never changes a number: the
//! stages it leaves out compute nothing that what is kept, or read, depends on.

use crate::reflect::{FieldSet, Object, Stage, field};
use crate::{Model, collision, enable, joint};

/// What programs read and write.
#[derive(Clone, Copy, Debug)]
pub struct Demand {
    /// Fields that are read between steps.
    pub reads: FieldSet,
    /// Fields that are written between steps.
    pub writes: FieldSet,
}

impl Demand {
    /// Anything may be read or written: what an embedding program gets that says nothing.
    pub const ANY: Demand = Demand { reads: FieldSet::ALL, writes: FieldSet::ALL };
    /// Anything may be read, only state and controls are written.
    pub const OBSERVE: Demand = Demand { reads: FieldSet::ALL, writes: FieldSet::EMPTY };
}

/// How the mass matrix is inverted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exact {
    /// All bodies are simple: M is diagonal and constant.
    Diagonal,
    General,
}

/// One line of the plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decision {
    /// The stage.
    pub stage: Stage,
    /// Whether it runs.
    pub keep: bool,
    /// Why, for a person to read.
    pub reason: String,
}

/// Which stages run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    decisions: Vec<Decision>,
    kept: u32,
    pub(crate) mass: Exact,
    /// Whether some tree is more than one simple body.
    pub(crate) some_general: bool,
    /// Whether forces applied to bodies are looked at.
    pub(crate) applied_forces: bool,
    pub(crate) contact_bits_may_change: bool,
    pub(crate) contact_params_may_change: bool,
}

impl Default for Plan {
    fn default() -> Self {
        Plan {
            decisions: Vec::new(),
            kept: 0,
            mass: Exact::General,
            some_general: true,
            applied_forces: true,
            contact_bits_may_change: true,
            contact_params_may_change: true,
        }
    }
}

impl Plan {
    /// Whether a stage runs.
    #[inline(always)]
    pub fn keeps(&self, stage: Stage) -> bool {
        self.kept & (1 << stage as u32) != 0
    }

    /// Every stage with the reason to keep it or leave it out, in the order of the pipeline.
    pub fn decisions(&self) -> &[Decision] {
        &self.decisions
    }

    /// Every stage runs, needed or not: the reference that plans are held against.
    pub fn full() -> Plan {
        let mut plan = Plan::default();
        for stage in STAGES {
            plan.decide(stage, true, "the full pipeline was asked for".into());
        }
        plan
    }

    /// The stages that this scene needs.
    pub fn new(m: &Model, demand: &Demand) -> Plan {
        let asked = Asked { m, demand };
        let mut plan = Plan::default();

        // Decided from the model and what is written, in the order of their dependence.
        let bits_change = asked.writes(Object::Model, &["geom_contype", "geom_conaffinity", "geom_bodyid"]);
        plan.contact_bits_may_change = bits_change;
        plan.contact_params_may_change =
            asked.writes(Object::Model, &CONTACT_PARAMS) || asked.writes(Object::Option, &OVERRIDES);
        let contacts = asked.contacts(bits_change);
        let limits = asked.limits();
        let springs = asked.springs();
        let moving_mass = asked.general_mass();
        let energy = asked.energy();
        let sensors = m.nsensor > 0 && asked.reads(Stage::Sensors).is_some();
        let constrained = contacts.is_ok() || limits.is_ok();
        plan.mass = if moving_mass.is_ok() { Exact::General } else { Exact::Diagonal };
        plan.some_general = moving_mass.is_ok();
        plan.applied_forces = asked.writes(Object::Data, &["xfrc_applied"]);

        let dynamics = m.nv > 0;
        let reading = |stage: Stage| asked.reads(stage);
        let sensed =
            |stage: Stage| (sensors && asked.sensed(stage)).then(|| "a sensor measures it".to_string());
        let bias = dynamics.then(|| "gravity and the motion of bodies make forces".to_string());
        let spatial = moving_mass
            .clone()
            .ok()
            .map(|_| "forces of a tree are computed about its centre of mass".to_string());
        let com = spatial
            .clone()
            .or_else(|| reading(Stage::ComPos))
            .or_else(|| reading(Stage::ComVel))
            .or_else(|| reading(Stage::MassMatrix));
        let slides =
            m.jnt_type.contains(&joint::SLIDE).then(|| "slide joints act along their axes".to_string());
        let applied = plan.applied_forces.then(|| "forces may be applied to bodies".to_string());
        let poses = com.as_ref().map(|_| "poses of bodies are where every force starts".to_string());
        let poses = poses.or_else(|| contacts.is_ok().then(|| "contacts need poses".to_string()));
        let poses =
            poses.or_else(|| sensors.then(|| "sensors need poses".to_string())).or(slides).or(applied);
        let poses =
            poses.or_else(|| energy.is_ok().then(|| "potential energy depends on positions".to_string()));
        let poses = poses
            .or_else(|| reading(Stage::Kinematics))
            .or_else(|| reading(Stage::GeomPoses))
            .or_else(|| reading(Stage::SitePoses));
        let mut put = |stage: Stage, yes: Option<String>, no: &str| {
            let keep = yes.is_some();
            plan.decide(stage, keep, yes.unwrap_or_else(|| no.to_string()));
        };
        put(Stage::Kinematics, poses, "bodies fly freely, nothing can touch, and nothing reads a pose");
        let geoms = contacts.as_ref().ok().map(|_| "contacts need the geoms' poses".to_string());
        put(
            Stage::GeomPoses,
            geoms.or_else(|| reading(Stage::GeomPoses)).or_else(|| sensed(Stage::GeomPoses)),
            "no contact is possible and nothing reads a geom's pose",
        );
        put(
            Stage::SitePoses,
            reading(Stage::SitePoses).or_else(|| sensed(Stage::SitePoses)),
            if m.nsite == 0 { "the model has no sites" } else { "nothing reads a site's pose" },
        );
        put(Stage::ComPos, com, "every moving body is a simple one: its forces have a closed form");
        put(
            Stage::MassMatrix,
            moving_mass.clone().ok().or_else(|| asked.reads_field("crb")),
            &moving_mass.clone().err().unwrap_or_default(),
        );
        put(Stage::Factor, moving_mass.clone().ok(), &moving_mass.clone().err().unwrap_or_default());
        put(Stage::Collision, contacts.clone().ok(), &contacts.clone().err().unwrap_or_default());
        let why = contacts.clone().ok().or_else(|| limits.clone().ok());
        let no = "no contact and no limit is possible";
        put(Stage::Constraint, why.clone(), no);
        put(
            Stage::ComVel,
            spatial
                .map(|_| "Coriolis and centrifugal forces need velocities".into())
                .or_else(|| reading(Stage::ComVel)),
            "every moving body is a simple one: its forces have a closed form",
        );
        put(Stage::Passive, springs.clone().ok(), &springs.clone().err().unwrap_or_default());
        put(Stage::Reference, why.clone(), no);
        put(Stage::Bias, bias, "nothing moves");
        put(
            Stage::Acceleration,
            dynamics.then(|| "it is what the integrator needs".to_string()),
            "nothing moves",
        );
        put(Stage::Solve, constrained.then(|| "constraint forces".to_string()), no);
        put(
            Stage::Sensors,
            sensors.then(|| "sensor values are read".to_string()),
            if m.nsensor == 0 { "the model has no sensors" } else { "nothing reads sensordata" },
        );
        put(Stage::Energy, energy.clone().ok(), &energy.err().unwrap_or_default());
        plan
    }

    fn decide(&mut self, stage: Stage, keep: bool, reason: String) {
        if keep {
            self.kept |= 1 << stage as u32;
        }
        self.decisions.push(Decision { stage, keep, reason });
    }
}

/// The stages of a forward pass, in order.
const STAGES: [Stage; 16] = [
    Stage::Kinematics,
    Stage::GeomPoses,
    Stage::SitePoses,
    Stage::ComPos,
    Stage::MassMatrix,
    Stage::Factor,
    Stage::Collision,
    Stage::Constraint,
    Stage::ComVel,
    Stage::Passive,
    Stage::Reference,
    Stage::Bias,
    Stage::Acceleration,
    Stage::Solve,
    Stage::Sensors,
    Stage::Energy,
];

/// What the parameters of a contact are mixed from.
const CONTACT_PARAMS: [&str; 8] = [
    "geom_condim",
    "geom_priority",
    "geom_solmix",
    "geom_solref",
    "geom_solimp",
    "geom_friction",
    "geom_margin",
    "geom_gap",
];
const OVERRIDES: [&str; 5] = ["o_margin", "o_solref", "o_solimp", "o_friction", "enableflags"];

/// Questions to the model and the demand. `Ok` is the reason to keep a stage, `Err` the reason to leave it out.
struct Asked<'a> {
    m: &'a Model,
    demand: &'a Demand,
}

impl Asked<'_> {
    /// The first field of a stage that is read, as a reason.
    fn reads(&self, stage: Stage) -> Option<String> {
        if self.demand.reads == FieldSet::ALL {
            return Some("its results may be read".into());
        }
        let f =
            self.demand.reads.iter().find(|f| f.info().object == Object::Data && f.info().stage == stage)?;
        Some(format!("data.{} is read", f.info().name))
    }

    /// Whether one field of the data is read, as a reason.
    fn reads_field(&self, name: &str) -> Option<String> {
        field(Object::Data, name)
            .filter(|&f| self.demand.reads.contains(f))
            .map(|_| format!("data.{name} may be read"))
    }

    fn writes(&self, object: Object, names: &[&str]) -> bool {
        names.iter().any(|n| field(object, n).is_some_and(|f| self.demand.writes.contains(f)))
    }

    fn contacts(&self, bits_change: bool) -> Result<String, String> {
        let m = self.m;
        if m.ngeom == 0 {
            return Err("the model has no geoms".into());
        }
        let pairs = collision::candidate_pairs(m, |a, b| bits_change || collision::can_collide(m, a, b));
        match pairs.len() {
            0 => Err("no pair of geoms can ever touch".into()),
            1 => Ok("one pair of geoms can touch".into()),
            n => Ok(format!("{n} pairs of geoms can touch")),
        }
    }

    fn limits(&self) -> Result<String, String> {
        if self.m.njnt > 0 && self.writes(Object::Model, &["jnt_limited"]) {
            return Ok("joint limits are switched while the lab runs".into());
        }
        match self.m.jnt_limited.iter().filter(|&&l| l).count() {
            0 => Err("no joint is limited".into()),
            1 => Ok("one joint is limited".into()),
            n => Ok(format!("{n} joints are limited")),
        }
    }

    fn springs(&self) -> Result<String, String> {
        let m = self.m;
        if m.nv > 0 && self.writes(Object::Model, &["dof_damping", "jnt_stiffness"]) {
            return Ok("springs or dampers are set while the lab runs".into());
        }
        if m.dof_damping.iter().chain(&m.jnt_stiffness).any(|&x| x != 0.0) {
            return Ok("joints have springs or dampers".into());
        }
        Err("no joint has a spring or a damper".into())
    }

    fn general_mass(&self) -> Result<String, String> {
        let m = self.m;
        if (0..m.nv).any(|i| m.dof_simplenum[i] == 0) {
            return Ok("the mass matrix depends on the configuration".into());
        }
        Err("every moving body is a single free or sliding one: its mass matrix is diagonal and constant"
            .into())
    }

    fn energy(&self) -> Result<String, String> {
        let switched = self.writes(Object::Option, &["enableflags"]);
        if !switched && !self.m.opt.enabled(enable::ENERGY) {
            return Err("the energy flag is off".into());
        }
        match self.reads(Stage::Energy) {
            Some(why) => Ok(why),
            None => Err("nothing reads the energy".into()),
        }
    }

    /// Whether a sensor measures something that the stage computes.
    fn sensed(&self, stage: Stage) -> bool {
        let kind = match stage {
            Stage::GeomPoses => crate::Obj::Geom,
            Stage::SitePoses => crate::Obj::Site,
            _ => return false,
        };
        self.m.sensor_objtype.contains(&(kind as i32))
    }
}
