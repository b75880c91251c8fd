//! How far a lab is from breaking: the largest timestep, gains, stiffnesses and mass ratios with which it still runs as it stands.
//!
//! Each is found by running: multiplied by two until it breaks, then by bisection. A run begins with a touch, a small speed of every
//! joint: what stands exactly in its balance shows nothing. Beside it stands the bound that `advice::stability` derives for one
//! degree of freedom, where there is one.

use super::bodies::{body_name, body_of};
use super::case::{Case, Outcome};
use super::fault::{Fault, FaultKind};
use super::search::{self, Limit};
use crate::advice::stability;
use crate::interrupt;
use crate::run::Session;
use labspec_core::math::{rows, rows_mut};
use labspec_core::{Model, Obj, disable, servo_gains, set_const};

/// What is made larger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Knob {
    /// The timestep, s.
    Timestep,
    /// The gain of a servo.
    Gain,
    /// The stiffness of a joint or a tendon, or of all contacts together.
    Stiffness,
    /// The mass of a body beside that of another one that it touches.
    MassRatio,
}

impl Knob {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Knob::Timestep => "timestep",
            Knob::Gain => "gain",
            Knob::Stiffness => "stiffness",
            Knob::MassRatio => "mass ratio",
        }
    }
}

/// How far something may be raised.
#[derive(Clone, Debug, PartialEq)]
pub struct Margin {
    /// What is raised.
    pub knob: Knob,
    /// Of what.
    pub who: String,
    /// Its unit; empty where it differs from joint to joint, or for a ratio.
    pub unit: &'static str,
    /// The value that the lab has.
    pub now: f64,
    /// The largest value that was fine; `None` where even the smallest one tried breaks.
    pub largest: Option<f64>,
    /// The smallest value above it that breaks; `None` where nothing did.
    pub breaks: Option<f64>,
    /// What goes wrong there, and with whom.
    pub how: Option<(FaultKind, String)>,
    /// The bound that theory gives for one degree of freedom.
    pub bound: Option<f64>,
    /// How many runs it took.
    pub runs: usize,
}

/// Work for one margin, and for one run of it.
const WORK: u64 = 4_000_000_000;
const RUN: u64 = 1_000_000_000;
/// A speed that every joint has at the start, m/s or rad/s.
const TOUCH: f64 = 1e-3;
/// A run has so many steps at least, however long they are: fewer show nothing.
const STEPS: f64 = 300.0;
/// No lab has longer steps, s.
const LONGEST: f64 = 1.0;
/// Servos, springs and pairs of bodies that are looked at, at most of each.
const MOST: usize = 12;

/// Multiplies something of a model.
type Apply = dyn Fn(&mut Model, f64);

/// Something that is multiplied.
struct Raised {
    knob: Knob,
    who: String,
    unit: &'static str,
    now: f64,
    most: f64,
    /// Whose bounds count; all for the timestep.
    object: Option<(Obj, Option<usize>)>,
    apply: Box<Apply>,
}

/// All margins of a lab as it stands, for runs of so many seconds; and what was left out. Work is added to `work`.
pub(super) fn margins(
    case: &Case<'_>,
    length: f64,
    tell: &mut dyn FnMut(&str),
    work: &mut u64,
) -> (Vec<Margin>, Vec<String>) {
    let model = case.start(&case.base, RUN).world.model;
    let mut left_out = Vec::new();
    let mut list = vec![timestep(&model)];
    let mut some = |mut all: Vec<Raised>, what: &str| {
        if all.len() > MOST {
            left_out.push(format!("margins of {} more {what}", all.len() - MOST));
            all.truncate(MOST);
        }
        all
    };
    list.extend(some(gains(&model), "servos"));
    list.extend(some(stiffnesses(&model), "springs"));
    let base = run(case, None, length, work);
    list.extend(contacts(&model, &base.touching));
    list.extend(some(ratios(&model, &base.touching), "pairs of bodies"));
    let mut found = Vec::new();
    for raised in list {
        tell(&format!("margin: {} of {}", raised.knob.words(), raised.who));
        match search(case, &raised, length, work) {
            Some(margin) => found.push(margin),
            None => left_out.push(format!(
                "the margin of the {} of {}, which takes more work than it may",
                raised.knob.words(),
                raised.who
            )),
        }
    }
    (found, left_out)
}

fn search(case: &Case<'_>, raised: &Raised, length: f64, work: &mut u64) -> Option<Margin> {
    let before = *work;
    let (mut runs, mut how) = (0, None);
    let limit = search::largest(raised.most, |x| {
        if *work - before > WORK || interrupt::requested() {
            return None;
        }
        runs += 1;
        let step = if raised.knob == Knob::Timestep { x * raised.now } else { 0.0 };
        let outcome = run(case, Some((&raised.apply, x)), length.max(STEPS * step), work);
        let fault = worst(&outcome.faults, &[]);
        if let Some(fault) = fault {
            how = Some((fault.kind, fault.who.clone()));
        } else if outcome.cut {
            return None;
        }
        Some(fault.is_none())
    })?;
    let start = case.start(&case.base, RUN).world.model;
    let bound = search::largest(raised.most, |x| {
        let mut model = start.clone();
        (raised.apply)(&mut model, x);
        Some(!stiff(&model, raised.object))
    });
    let bound = bound.filter(|b| b.broken.is_some()).and_then(|Limit { fine, .. }| fine);
    Some(Margin {
        knob: raised.knob,
        who: raised.who.clone(),
        unit: raised.unit,
        now: raised.now,
        largest: limit.fine.map(|x| x * raised.now),
        breaks: limit.broken.map(|x| x * raised.now),
        how: how.filter(|_| limit.broken.is_some()),
        bound: bound.map(|x| x * raised.now).filter(|_| raised.knob != Knob::MassRatio),
        runs,
    })
}

/// Whether theory says that something is too stiff.
fn stiff(m: &Model, object: Option<(Obj, Option<usize>)>) -> bool {
    stability::suspects(m)
        .iter()
        .any(|s| object.is_none_or(|(kind, id)| kind == s.object && id.is_none_or(|id| id == s.id)))
}

/// What breaks a run, if anything does: creeping and programs that throw are no matter of margins.
pub(super) fn worst<'f>(faults: &'f [Fault], known: &[(FaultKind, String)]) -> Option<&'f Fault> {
    let counts = |f: &&Fault| {
        !matches!(f.kind, FaultKind::Drifts | FaultKind::Throws | FaultKind::Warns)
            && !known.iter().any(|(kind, who)| *kind == f.kind && *who == f.who)
    };
    faults.iter().filter(counts).min_by_key(|f| f.kind)
}

fn run(case: &Case<'_>, raised: Option<(&Apply, f64)>, length: f64, work: &mut u64) -> Outcome {
    let change = |session: &mut Session<'_>| {
        if let Some((apply, x)) = raised {
            apply(&mut session.world.model, x);
            // What follows from masses is computed anew; without an inertia above zero it stays as it was.
            let world = &mut session.world;
            let _ = set_const(&mut world.model, &mut world.data);
        }
        session.world.data.edit().qvel.iter_mut().for_each(|v| *v += TOUCH);
    };
    let outcome = case.run(&case.base, Some(&change), length, RUN);
    *work += outcome.spent;
    outcome
}

fn timestep(m: &Model) -> Raised {
    let now = m.opt.timestep;
    Raised {
        knob: Knob::Timestep,
        who: "the lab".into(),
        unit: "s",
        now,
        most: (LONGEST / now).max(1.0),
        object: None,
        apply: Box::new(|m, x| *m.edit().opt.timestep *= x),
    }
}

/// Numbers of a gain or a bias for each actuator.
const WIDTH: usize = 10;

fn gains(m: &Model) -> Vec<Raised> {
    let mut list = Vec::new();
    for a in 0..m.nactuator {
        let Some([kp, kv]) = servo_gains(m, a) else { continue };
        let (gain, bias) = if kp > 0.0 { (kp, 1) } else { (kv, 2) };
        let apply = move |m: &mut Model, x: f64| {
            let edit = m.edit();
            for (list, at) in [(edit.actuator_gainprm, WIDTH * a), (edit.actuator_biasprm, WIDTH * a + bias)]
            {
                if let Some(value) = list.get_mut(at) {
                    *value *= x;
                }
            }
        };
        let mut twice = m.clone();
        apply(&mut twice, 2.0);
        let scaled = servo_gains(&twice, a).map(|g| g[bias - 1]);
        if gain > 0.0 && scaled == Some(2.0 * gain) {
            list.push(Raised {
                knob: Knob::Gain,
                who: named(&m.names.actuator, a, "the servo"),
                unit: "",
                now: gain,
                most: f64::INFINITY,
                object: Some((Obj::Actuator, Some(a))),
                apply: Box::new(apply),
            });
        }
    }
    list
}

fn stiffnesses(m: &Model) -> Vec<Raised> {
    let mut list = Vec::new();
    if !m.opt.disabled(disable::SPRING) {
        for j in (0..m.njnt).filter(|&j| m.jnt_stiffness.get(j).is_some_and(|&k| k > 0.0)) {
            list.push(Raised {
                knob: Knob::Stiffness,
                who: named(&m.names.joint, j, "joint"),
                unit: "",
                now: m.jnt_stiffness[j],
                most: f64::INFINITY,
                object: Some((Obj::Joint, Some(j))),
                apply: Box::new(move |m, x| {
                    m.edit().jnt_stiffness.iter_mut().skip(j).take(1).for_each(|k| *k *= x)
                }),
            });
        }
        for t in (0..m.ntendon).filter(|&t| m.tendon_stiffness.get(t).is_some_and(|&k| k > 0.0)) {
            list.push(Raised {
                knob: Knob::Stiffness,
                who: named(&m.names.tendon, t, "tendon"),
                unit: "N/m",
                now: m.tendon_stiffness[t],
                most: f64::INFINITY,
                object: Some((Obj::Tendon, Some(t))),
                apply: Box::new(move |m, x| {
                    m.edit().tendon_stiffness.iter_mut().skip(t).take(1).for_each(|k| *k *= x)
                }),
            });
        }
    }
    list
}

/// The stiffness of all contacts together: one over the square of the shortest time constant. The engine keeps that above two steps;
/// here it does not, so that the limit shows.
fn contacts(m: &Model, touching: &[[usize; 2]]) -> Option<Raised> {
    let times = touching.iter().flatten().filter_map(|&g| rows::<2>(&m.geom_solref).get(g)).map(|s| s[0]);
    let shortest = times.filter(|t| *t > 0.0).fold(f64::INFINITY, f64::min);
    let apply = |m: &mut Model, x: f64| {
        let edit = m.edit();
        *edit.opt.disableflags |= disable::REFSAFE;
        for list in [edit.geom_solref, edit.pair_solref] {
            for s in rows_mut::<2>(list) {
                *s = if s[0] > 0.0 { [s[0] / x.sqrt(), s[1]] } else { [s[0] * x, s[1] * x.sqrt()] };
            }
        }
    };
    shortest.is_finite().then(|| Raised {
        knob: Knob::Stiffness,
        who: "all contacts".into(),
        unit: "1/s²",
        now: 1.0 / (shortest * shortest),
        most: f64::INFINITY,
        object: Some((Obj::Geom, None)),
        apply: Box::new(apply),
    })
}

/// The ratio of masses of bodies that touch, hang on each other or are tied together, with one of them heavier and lighter.
fn ratios(m: &Model, touching: &[[usize; 2]]) -> Vec<Raised> {
    let mut list: Vec<Raised> = Vec::new();
    let mut pairs: Vec<[usize; 2]> = touching.iter().map(|gs| gs.map(|g| body_of(m, g))).collect();
    let joined = |b: &usize| m.body_jntnum.get(*b).is_some_and(|&n| n > 0);
    let parent = |b: usize| m.body_parentid.get(b).map_or(0, |&p| p as usize);
    pairs.extend((1..m.nbody).filter(joined).map(|b| [parent(b), b]));
    pairs.extend(tied(m));
    pairs.iter_mut().for_each(|p| p.sort_unstable());
    pairs.sort_unstable();
    pairs.dedup();
    let mass = |b: usize| m.body_mass.get(b).copied().unwrap_or(0.0);
    let moves = |b: &usize| m.body_treeid.get(*b).is_some_and(|&t| t >= 0) && mass(*b) > 0.0;
    for [a, b] in pairs.into_iter().filter(|p| p.iter().all(moves)) {
        for [heavy, light] in [[a, b], [b, a]] {
            list.push(Raised {
                knob: Knob::MassRatio,
                who: format!("{} to {}", body_name(m, heavy), body_name(m, light)),
                unit: "",
                now: mass(heavy) / mass(light),
                most: f64::INFINITY,
                object: None,
                apply: Box::new(move |m, x| heavier(m, heavy, x)),
            });
        }
    }
    list
}

/// Bodies that an equality ties together.
fn tied(m: &Model) -> Vec<[usize; 2]> {
    let bodies = |e: &usize| {
        m.eq_objtype.get(*e) == Some(&(Obj::Body as i32)) && m.eq_active0.get(*e).copied().unwrap_or(false)
    };
    let end = |list: &[i32], e: usize| list.get(e).and_then(|&b| usize::try_from(b).ok());
    let both = |e: usize| Some([end(&m.eq_obj1id, e)?, end(&m.eq_obj2id, e)?]);
    (0..m.neq).filter(bodies).filter_map(both).collect()
}

fn heavier(m: &mut Model, body: usize, x: f64) {
    let edit = m.edit();
    edit.body_mass.iter_mut().skip(body).take(1).for_each(|mass| *mass *= x);
    edit.body_inertia.iter_mut().skip(3 * body).take(3).for_each(|inertia| *inertia *= x);
}

fn named(names: &[String], i: usize, what: &str) -> String {
    match names.get(i) {
        Some(name) if !name.is_empty() => format!("{what} \"{name}\""),
        _ => format!("{what} {i}"),
    }
}
