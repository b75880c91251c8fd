//! What the engine's warnings, and energy that grows without one, mean for a lesson: what broke, when, the likely cause,
//! and what to write instead.

use super::{Session, shown};
use labspec_core::growth::Growth;
use labspec_core::stability::{self, Part, Suspect};
use labspec_core::{Model, Obj, Warning, joint};

/// A run that met a bad number or gained energy from nothing, in a teacher's words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Breakdown {
    /// The code of the finding.
    pub code: &'static str,
    /// What is no number, or what grows, and when.
    pub what: String,
    /// What the page shows.
    pub why: &'static str,
    /// The likely cause and what to change.
    pub help: String,
}

/// In the order in which one follows from the other.
const WORST_FIRST: [(Warning, &str); 5] = [
    (Warning::BadQpos, RESET),
    (Warning::BadQvel, RESET),
    (Warning::BadQacc, RESET),
    (
        Warning::BadCtrl,
        "MuJoCo then takes all controls as 0: a student sees everything go limp without a word",
    ),
    (Warning::ContactFull, "what is not kept does not push: bodies sink into each other without a word"),
];
const RESET: &str =
    "MuJoCo then resets the data and goes on from time 0: a student sees the scene jump back without a word";
const GROWS: &str = "the steps make it, not physics: a student sees things leap or swing ever wider, without a word from MuJoCo";

impl Breakdown {
    /// The worst of what a session met; `None` when it met nothing.
    pub fn of(session: &Session<'_>) -> Option<Breakdown> {
        let met = |w: Warning| session.warnings.get(w as usize).filter(|stat| stat.number > 0);
        let Some((warning, why, stat)) = WORST_FIRST.iter().find_map(|&(w, why)| Some((w, why, met(w)?)))
        else {
            return session.growth().map(|growth| Breakdown::by_growth(&session.world.model, growth));
        };
        let (code, model) = ("simulation-diverges", &session.world.model);
        let joint = |adr: &[i32], width| joint_of(model, stat.lastinfo, adr, width);
        let what = match warning {
            Warning::BadQpos => format!("the position of {}", joint(&model.jnt_qposadr, joint::nq)),
            Warning::BadQvel => format!("the velocity of {}", joint(&model.jnt_dofadr, joint::nv)),
            Warning::BadQacc => format!("the acceleration of {}", joint(&model.jnt_dofadr, joint::nv)),
            Warning::BadCtrl => format!("control {}", stat.lastinfo),
            _ => {
                let what = format!("more than {} contacts at t = {:.4} s", stat.lastinfo, stat.first_time);
                let help = "let fewer bodies touch, or move them apart at the start".into();
                return Some(Breakdown { code, what, why, help });
            }
        };
        let what = format!("{what} is not a number or above 1e10 at t = {:.4} s", stat.first_time);
        let help = match warning {
            Warning::BadCtrl => "guard the expression that is written to `data.ctrl` with a condition".into(),
            _ => cause(model),
        };
        Some(Breakdown { code, what, why, help })
    }

    /// Energy that nothing gave.
    fn by_growth(model: &Model, g: Growth) -> Breakdown {
        let what = format!(
            "energy grows from t = {:.4} s: {} J that nothing gave, where all that the start held is {} J; the most of it moves {}",
            g.time,
            shown(g.gain, 2),
            shown(g.held, 2),
            joint_of(model, g.dof, &model.jnt_dofadr, joint::nv)
        );
        Breakdown { code: "energy-grows", what, why: GROWS, help: cause(model) }
    }
}

/// The likely cause of a run that breaks, and what to write instead.
fn cause(model: &Model) -> String {
    match stability::suspects(model).first() {
        Some(worst) => format!(
            "the likely cause: {} is {} times too stiff for a step of {} s; {}",
            owner(model, worst),
            times(worst),
            model.opt.timestep,
            remedy(model, worst)
        ),
        None => format!(
            "try a smaller timestep than {} s, softer contacts or springs, or a smaller range of the control",
            model.opt.timestep
        ),
    }
}

/// What is too stiff: `the servo "lift"`, `the spring of joint "knee"`.
pub fn owner(model: &Model, s: &Suspect) -> String {
    let names = model.names.of(s.object);
    let name = match names.get(s.id) {
        Some(name) if !name.is_empty() => format!("\"{name}\""),
        _ => s.id.to_string(),
    };
    match (s.part, s.object) {
        (Part::Servo, _) => format!("the servo {name}"),
        (Part::Constraint, Obj::Geom) => format!("the contact of geom {name}"),
        (Part::Constraint, Obj::Pair) => format!("the contact of pair {name}"),
        (Part::Constraint, _) => format!("the equality {name}"),
        (part, object) => {
            let what = if part == Part::Limit { "limit" } else { "spring or damper" };
            format!("the {what} of {} {name}", if object == Obj::Tendon { "tendon" } else { "joint" })
        }
    }
}

/// How many times too stiff: never "1.0 times".
pub fn times(s: &Suspect) -> String {
    if s.excess < 1.1 { "slightly more than 1".into() } else { format!("{:.1}", s.excess) }
}

/// What to write instead.
pub fn remedy(model: &Model, s: &Suspect) -> String {
    let attribute = match (s.part, s.object) {
        (Part::Servo, _) => "`kp` and `kv`",
        (Part::Spring, _) => "`stiffness` and `damping`",
        (Part::Limit, _) => "`solreflimit`",
        (Part::Constraint, _) => "`solref`",
    };
    let shorter = format!("{:.1e}", 0.9 * s.timestep.min(model.opt.timestep));
    format!("write a timestep of {shorter} s, or softer {attribute}, or `integrator=\"discrete\"`")
}

fn joint_of(model: &Model, index: usize, adr: &[i32], width: fn(i32) -> usize) -> String {
    let found = (0..model.njnt).find(|&j| {
        let first = adr.get(j).map_or(0, |&a| a as usize);
        (first..first + width(model.jnt_type.get(j).copied().unwrap_or(3))).contains(&index)
    });
    match found.and_then(|j| model.names.joint.get(j).map(|n| (j, n))) {
        Some((_, name)) if !name.is_empty() => format!("joint \"{name}\""),
        Some((j, _)) => format!("joint {j}"),
        None => format!("degree of freedom {index}"),
    }
}
