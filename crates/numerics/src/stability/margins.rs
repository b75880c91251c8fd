//! Stability margins: the largest timestep, gains, stiffnesses and mass ratios with which the lab still runs without a fault.
//!
//! Each margin is found by runs: the parameter is raised until a fault occurs, then bisected. The model is changed before the
//! lab is loaded, so that keyframe, `setup` and controls act on it as on a page. The runs are those of a check: the unchanged
//! interaction, and one with an invisible perturbation. If a program of the lab sets the parameter itself, it is changed after
//! that. Each margin is listed with the bound that `monitors::stability` derives for one degree of freedom, if there is one.

use super::search::{self, SearchLimit};
use labspec::interrupt;
use labspec::monitors::stability;
use labspec::run::Session;
use labspec::stress::{
    FaultKind, Interaction, InteractionKind, RunOutcome, StressCase, body_name, body_of, worst_fault,
};
use labspec_core::math::{rows, rows_mut};
use labspec_core::{Data, Model, Obj, disable, servo_gains, set_const};

/// The kind of parameter that is raised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// The timestep, s.
    Timestep,
    /// The gain of a servo.
    Gain,
    /// The stiffness of a joint or a tendon, or of all contacts together.
    Stiffness,
    /// The ratio of the masses of two bodies that touch.
    MassRatio,
}

impl ParameterKind {
    /// Every kind.
    pub const ALL: [ParameterKind; 4] =
        [ParameterKind::Timestep, ParameterKind::Gain, ParameterKind::Stiffness, ParameterKind::MassRatio];

    /// The parameter in words.
    pub fn description(self) -> &'static str {
        match self {
            ParameterKind::Timestep => "timestep",
            ParameterKind::Gain => "gain",
            ParameterKind::Stiffness => "stiffness",
            ParameterKind::MassRatio => "mass ratio",
        }
    }
}

/// How far a parameter can be raised.
#[derive(Clone, Debug, PartialEq)]
pub struct Margin {
    /// The kind of parameter.
    pub parameter: ParameterKind,
    /// The object to which it belongs.
    pub subject: String,
    /// Its unit; empty for a ratio, or if the unit depends on the joint.
    pub unit: &'static str,
    /// The current value in the lab.
    pub current: f64,
    /// The largest value without a fault; `None` if even the smallest one that was tried fails.
    pub largest: Option<f64>,
    /// The smallest value above it that fails; `None` if none failed.
    pub breaks: Option<f64>,
    /// The fault at that value, and the object that has it.
    pub how: Option<(FaultKind, String)>,
    /// The theoretical bound for one degree of freedom.
    pub bound: Option<f64>,
    /// The number of runs.
    pub runs: usize,
    /// For the stiffness of all contacts: the geoms of these contacts.
    pub geoms: Vec<usize>,
}

/// The work limits for one margin, and for one run.
const WORK: u64 = 4_000_000_000;
const RUN: u64 = 1_000_000_000;
/// The longest timestep that is tried, s, and the smallest number of steps of a run.
const LONGEST: f64 = 1.0;
const STEPS: f64 = 10.0;
/// The factors between the values that are tried. Small steps are needed for a timestep, because a lab may work again
/// beyond the first failure.
const FINE_FACTOR: f64 = 1.2;
const COARSE_FACTOR: f64 = 2.0;
/// The maximum number of servos, of springs and of pairs of bodies that are tested.
const MOST: usize = 12;

/// Multiplies a parameter of a model by a factor.
type Apply = dyn Fn(&mut Model, f64);
/// Reads the parameter.
type Read = dyn Fn(&Model) -> f64;

/// A parameter that is raised.
struct RaisedParameter {
    parameter: ParameterKind,
    subject: String,
    unit: &'static str,
    current: f64,
    most: f64,
    /// The object whose theoretical bounds apply; `None` means all, for the timestep.
    object: Option<(Obj, Option<usize>)>,
    apply: Box<Apply>,
    read: Box<Read>,
    geoms: Vec<usize>,
}

/// All margins of a lab for runs of this length, s, and what was left out. The work is added to `work`.
pub(super) fn margins(
    case: &StressCase<'_>,
    length: f64,
    report_progress: &mut dyn FnMut(&str),
    work: &mut u64,
) -> (Vec<Margin>, Vec<String>) {
    let model = case.start(&case.base, RUN).world.model;
    let mut skipped = Vec::new();
    let mut list = vec![timestep(&model, length)];
    let mut some = |mut all: Vec<RaisedParameter>, what: &str| {
        if all.len() > MOST {
            skipped.push(format!("margins of {} more {what}", all.len() - MOST));
            all.truncate(MOST);
        }
        all
    };
    list.extend(some(gains(&model), "servos"));
    list.extend(some(stiffnesses(&model), "springs"));
    let base = case.run(&case.base, None, length, RUN);
    *work += base.spent;
    list.extend(contacts(&model, &base.touching));
    list.extend(some(ratios(&model, &base.touching), "pairs of bodies"));
    let mut found = Vec::new();
    for raised in list {
        report_progress(&format!("margin: {} of {}", raised.parameter.description(), raised.subject));
        match search(case, &raised, length, work) {
            Ok(margin) => found.push(margin),
            Err(why) => skipped.push(format!(
                "the margin of the {} of {}, {why}",
                raised.parameter.description(),
                raised.subject
            )),
        }
    }
    (found, skipped)
}

/// # Errors
/// The reason why nothing is known.
fn search(
    case: &StressCase<'_>,
    raised: &RaisedParameter,
    length: f64,
    work: &mut u64,
) -> Result<Margin, &'static str> {
    let before = *work;
    let (mut runs, mut how, mut set) = (0, None, false);
    let factor = if raised.parameter == ParameterKind::Timestep { FINE_FACTOR } else { COARSE_FACTOR };
    let limit = search::largest(raised.most, factor, |x| {
        if *work - before > WORK || interrupt::requested() {
            return None;
        }
        for interaction in [case.base.clone(), case.base.and(InteractionKind::Touched, Vec::new())] {
            runs += 1;
            let Some(outcome) = run(case, &interaction, raised, x, length, work) else {
                set = true;
                return None;
            };
            if let Some(fault) = worst_fault(&outcome.faults, &[]) {
                how = Some((fault.kind, fault.subject.clone()));
                return Some(false);
            }
            if outcome.cut {
                return None;
            }
        }
        Some(true)
    });
    let limit = limit.ok_or(if set {
        "which a program of the lab sets itself"
    } else {
        "which needs more work than allowed"
    })?;
    let start = case.start(&case.base, RUN).world.model;
    let bound = search::largest(raised.most, factor, |x| {
        let mut model = start.clone();
        (raised.apply)(&mut model, x);
        Some(!stiff(&model, raised.object))
    });
    let bound = bound.filter(|b| b.broken.is_some()).and_then(|SearchLimit { fine, .. }| fine);
    Ok(Margin {
        parameter: raised.parameter,
        subject: raised.subject.clone(),
        unit: raised.unit,
        current: raised.current,
        largest: limit.fine.map(|x| x * raised.current),
        breaks: limit.broken.map(|x| x * raised.current),
        how: how.filter(|_| limit.broken.is_some()),
        bound: bound.map(|x| x * raised.current).filter(|_| raised.parameter != ParameterKind::MassRatio),
        runs,
        geoms: raised.geoms.clone(),
    })
}

/// Whether the theoretical bound states that an object is too stiff.
fn stiff(m: &Model, object: Option<(Obj, Option<usize>)>) -> bool {
    stability::unstable_parts(m)
        .iter()
        .any(|s| object.is_none_or(|(kind, id)| kind == s.object && id.is_none_or(|id| id == s.id)))
}

/// A run with a raised parameter, or `None` if a program of the lab sets it and it cannot be changed after that.
fn run(
    case: &StressCase<'_>,
    interaction: &Interaction,
    raised: &RaisedParameter,
    x: f64,
    length: f64,
    work: &mut u64,
) -> Option<RunOutcome> {
    let target = x * raised.current;
    let same = |m: &Model| ((raised.read)(m) - target).abs() <= 1e-9 * target.abs();
    let mut model = case.model.clone();
    // The factor is relative to the value after the lab is loaded.
    let current = (raised.read)(&model);
    (raised.apply)(&mut model, if current > 0.0 { target / current } else { x });
    if raised.parameter == ParameterKind::MassRatio {
        // Recomputes the fields that depend on masses; if an inertia is not positive, they remain unchanged.
        let mut data = Data::new(&model);
        let _ = set_const(&mut model, &mut data);
    }
    let case = case.with_model(&model);
    let free = raised.parameter != ParameterKind::MassRatio;
    let change = |session: &mut Session<'_>| {
        let set = (raised.read)(&session.world.model);
        if free && !same(&session.world.model) && set > 0.0 {
            (raised.apply)(&mut session.world.model, target / set);
        }
    };
    let (outcome, model) = case.run_to_model(interaction, Some(&change), length, RUN);
    *work += outcome.spent;
    same(&model).then_some(outcome)
}

fn timestep(m: &Model, length: f64) -> RaisedParameter {
    let current = m.opt.timestep;
    RaisedParameter {
        parameter: ParameterKind::Timestep,
        subject: "the lab".into(),
        unit: "s",
        current,
        most: (LONGEST.min(length / STEPS) / current).max(1.0),
        object: None,
        apply: Box::new(|m, x| *m.edit().opt.timestep *= x),
        read: Box::new(|m| m.opt.timestep),
        geoms: Vec::new(),
    }
}

/// The numbers per actuator for its gain and bias parameters.
const WIDTH: usize = 10;

fn gains(m: &Model) -> Vec<RaisedParameter> {
    let mut list = Vec::new();
    for a in 0..m.nactuator {
        let Some([kp, kv]) = servo_gains(m, a) else { continue };
        let (gain, bias) = if kp > 0.0 { (kp, 1) } else { (kv, 2) };
        let apply = move |m: &mut Model, x: f64| {
            let edit = m.edit();
            for (list, index) in
                [(edit.actuator_gainprm, WIDTH * a), (edit.actuator_biasprm, WIDTH * a + bias)]
            {
                if let Some(value) = list.get_mut(index) {
                    *value *= x;
                }
            }
        };
        let mut twice = m.clone();
        apply(&mut twice, 2.0);
        let scaled = servo_gains(&twice, a).map(|g| g[bias - 1]);
        if gain > 0.0 && scaled == Some(2.0 * gain) {
            list.push(RaisedParameter {
                parameter: ParameterKind::Gain,
                subject: named(&m.names.actuator, a, "the servo"),
                unit: "",
                current: gain,
                most: f64::INFINITY,
                object: Some((Obj::Actuator, Some(a))),
                apply: Box::new(apply),
                read: Box::new(move |m| servo_gains(m, a).map_or(0.0, |g| g[bias - 1])),
                geoms: Vec::new(),
            });
        }
    }
    list
}

fn stiffnesses(m: &Model) -> Vec<RaisedParameter> {
    let mut list = Vec::new();
    if !m.opt.disabled(disable::SPRING) {
        for j in (0..m.njnt).filter(|&j| m.jnt_stiffness.get(j).is_some_and(|&k| k > 0.0)) {
            list.push(RaisedParameter {
                parameter: ParameterKind::Stiffness,
                subject: named(&m.names.joint, j, "joint"),
                unit: "",
                current: m.jnt_stiffness[j],
                most: f64::INFINITY,
                object: Some((Obj::Joint, Some(j))),
                apply: Box::new(move |m, x| {
                    m.edit().jnt_stiffness.iter_mut().skip(j).take(1).for_each(|k| *k *= x)
                }),
                read: Box::new(move |m| m.jnt_stiffness.get(j).copied().unwrap_or(0.0)),
                geoms: Vec::new(),
            });
        }
        for t in (0..m.ntendon).filter(|&t| m.tendon_stiffness.get(t).is_some_and(|&k| k > 0.0)) {
            list.push(RaisedParameter {
                parameter: ParameterKind::Stiffness,
                subject: named(&m.names.tendon, t, "tendon"),
                unit: "N/m",
                current: m.tendon_stiffness[t],
                most: f64::INFINITY,
                object: Some((Obj::Tendon, Some(t))),
                apply: Box::new(move |m, x| {
                    m.edit().tendon_stiffness.iter_mut().skip(t).take(1).for_each(|k| *k *= x)
                }),
                read: Box::new(move |m| m.tendon_stiffness.get(t).copied().unwrap_or(0.0)),
                geoms: Vec::new(),
            });
        }
    }
    list
}

/// The stiffness of all contacts together: the inverse square of the shortest time constant. The engine keeps the time constant
/// above two steps; here this is disabled to find the limit.
fn contacts(m: &Model, touching: &[[usize; 2]]) -> Option<RaisedParameter> {
    let mut geoms: Vec<usize> = touching.iter().flatten().copied().collect();
    geoms.sort_unstable();
    geoms.dedup();
    let touching_geoms = geoms.clone();
    let read = move |m: &Model| {
        let times = touching_geoms.iter().filter_map(|&g| rows::<2>(&m.geom_solref).get(g)).map(|s| s[0]);
        let shortest = times.filter(|t| *t > 0.0).fold(f64::INFINITY, f64::min);
        1.0 / (shortest * shortest)
    };
    let apply = |m: &mut Model, x: f64| {
        let edit = m.edit();
        *edit.opt.disableflags |= disable::REFSAFE;
        for list in [edit.geom_solref, edit.pair_solref] {
            for s in rows_mut::<2>(list) {
                *s = if s[0] > 0.0 { [s[0] / x.sqrt(), s[1]] } else { [s[0] * x, s[1] * x.sqrt()] };
            }
        }
    };
    let current = read(m);
    (current > 0.0).then(|| RaisedParameter {
        parameter: ParameterKind::Stiffness,
        subject: "all contacts".into(),
        unit: "1/s²",
        current,
        most: f64::INFINITY,
        object: Some((Obj::Geom, None)),
        apply: Box::new(apply),
        read: Box::new(read),
        geoms,
    })
}

/// The mass ratios of bodies that touch, are connected by a joint or are tied together. Of each pair, each body
/// in turn is made heavier.
fn ratios(m: &Model, touching: &[[usize; 2]]) -> Vec<RaisedParameter> {
    let mut list: Vec<RaisedParameter> = Vec::new();
    let mut pairs: Vec<[usize; 2]> = touching.iter().map(|gs| gs.map(|g| body_of(m, g))).collect();
    let joined = |b: &usize| m.body_jntnum.get(*b).is_some_and(|&n| n > 0);
    let parent = |b: usize| m.body_parentid.get(b).map_or(0, |&p| p as usize);
    pairs.extend((1..m.nbody).filter(joined).map(|b| [parent(b), b]));
    pairs.extend(constrained_pairs(m));
    pairs.iter_mut().for_each(|p| p.sort_unstable());
    pairs.sort_unstable();
    pairs.dedup();
    let mass = |b: usize| m.body_mass.get(b).copied().unwrap_or(0.0);
    let moves = |b: &usize| m.body_treeid.get(*b).is_some_and(|&t| t >= 0) && mass(*b) > 0.0;
    for [a, b] in pairs.into_iter().filter(|p| p.iter().all(moves)) {
        for [heavy, light] in [[a, b], [b, a]] {
            list.push(RaisedParameter {
                parameter: ParameterKind::MassRatio,
                subject: format!("{} to {}", body_name(m, heavy), body_name(m, light)),
                unit: "",
                current: mass(heavy) / mass(light),
                most: f64::INFINITY,
                object: None,
                apply: Box::new(move |m, x| scale_mass(m, heavy, x)),
                read: Box::new(move |m| {
                    let mass = |b: usize| m.body_mass.get(b).copied().unwrap_or(0.0);
                    mass(heavy) / mass(light)
                }),
                geoms: Vec::new(),
            });
        }
    }
    list
}

/// Pairs of bodies that an equality constraint ties together.
fn constrained_pairs(m: &Model) -> Vec<[usize; 2]> {
    let bodies = |e: &usize| {
        m.eq_objtype.get(*e) == Some(&(Obj::Body as i32)) && m.eq_active0.get(*e).copied().unwrap_or(false)
    };
    let end = |list: &[i32], e: usize| list.get(e).and_then(|&b| usize::try_from(b).ok());
    let both = |e: usize| Some([end(&m.eq_obj1id, e)?, end(&m.eq_obj2id, e)?]);
    (0..m.neq).filter(bodies).filter_map(both).collect()
}

fn scale_mass(m: &mut Model, body: usize, x: f64) {
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
