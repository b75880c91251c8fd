//! Candidate measures of a lab: displayed values at the start, at the end, at named times and at contacts; velocities of
//! bodies; constants of the model. The simplest come first.

use super::units::{LONGEST_TIMESTEP, second, si};
use super::words::split_words;
use labspec::bind::{ModelNames, Programs, Scope, dimensions, of_label};
use labspec::check;
use labspec::run::{self, Play, Session, Start};
use labspec::spec::Lab;
use labspec::verify::Stated;
use labspec_bind::element_owner;
use labspec_core::{AccessSet, Model, Plan};
use labspec_core::{geom, joint, trntype, wraptype};
use labspec_expr::Compiler;
use labspec_expr::dimension::{Dimension, Measure};
use std::collections::BTreeSet;
use std::ops::ControlFlow;

/// A quantity that can be measured in a run.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    /// The expression of the measure.
    pub(crate) text: String,
    /// The dimension of its values.
    pub(crate) dimension: Dimension,
    /// The penalty for complexity.
    pub(crate) cost: f64,
    /// The words of its label and of the names in it.
    pub(crate) words: BTreeSet<String>,
    /// The words that a text uses for it, if it is a constant of the model, independent of runs.
    pub(crate) constant: Option<ConstantWords>,
    /// The label of a displayed value, or the name of a joint or an actuator, without the unit.
    pub(crate) label: String,
    /// A time, s, that the text must name near the number.
    pub(crate) time: Option<f64>,
}

/// The words that a text uses for a constant of the model.
#[derive(Clone, Debug, Default)]
pub(crate) struct ConstantWords {
    /// Words for the kind of constant; empty if its unit determines it.
    pub(crate) kind: BTreeSet<String>,
    /// The words for its object: those of its name and, if no other object has another value, those for its shape. Empty for the
    /// constants of the whole model.
    pub(crate) owner: BTreeSet<String>,
}

/// The maximum numbers of pairs of geoms, named times, joints and constants of one kind.
const PAIRS: usize = 4;
const TIMES: usize = 24;
const JOINTS: usize = 6;
const CONSTANTS: usize = 12;
/// The maximum number of steps of the run in which contacts are searched.
const STEPS: usize = 20_000;

/// Words for the constants of a model.
const GRAVITY_WORDS: &str = "gravity gravitational fall falls falling free";
const MASS_WORDS: &str = "mass heavy heavier light lighter weighs weight kilogram";
const HEIGHT_WORDS: &str = "height high above centre center dropped drop drops starts start from";
const SIZE_WORDS: &str = "radius size length long width wide thick thickness half";
/// Words for the contact of two geoms.
const CONTACT_WORDS: &str = "contact touch touches touchdown impact lands landing hits first";

/// A displayed value, or a quantity derived from it: an expression, its dimension, its words.
struct DisplayedNumber {
    text: String,
    dimension: Dimension,
    words: String,
    /// Its label, or the name of its object.
    label: String,
    /// Its cost in addition to that of a displayed value.
    more: f64,
    /// Whether it is a coordinate along the ground.
    horizontal: bool,
}

/// All candidate measures of a lab whose expressions compile.
pub(super) fn candidates(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    numbers: &[Stated],
) -> Vec<Candidate> {
    let mut all = Vec::new();
    constants(model, &mut all);
    let pairs = touching_geoms(lab, model, programs);
    let mut displayed = displayed_numbers(lab, model, programs);
    displayed.extend(motions(model));
    displayed.extend(forces(model));
    let times = times(numbers);
    for (a, b) in &pairs {
        let met = format!("contact('{a}', '{b}')");
        let named = format!("{a} {b} {CONTACT_WORDS}");
        let s = second();
        add(&mut all, format!("first({met})"), s, 2.0, &named, "");
        add(&mut all, format!("first({met}) - model.opt.timestep"), s, 2.6, &named, "");
    }
    for x in displayed.iter().filter(|x| x.text != "data.time") {
        let DisplayedNumber { text, dimension, words, label, more, .. } = x;
        let mut add_candidate =
            |measure: String, cost: f64| add(&mut all, measure, *dimension, cost + more, words, label);
        add_candidate(format!("final({text})"), 2.0);
        add_candidate(format!("max({text})"), 2.2);
        add_candidate(format!("min({text})"), 2.2);
        add_candidate(format!("initial({text})"), 2.2);
        add_candidate(format!("max({text}) - min({text})"), 3.0);
        add_candidate(format!("mean({text})"), 3.5);
        for (a, b) in &pairs {
            // The names of the two geoms alone do not speak of their contact.
            let words = format!("{words} {CONTACT_WORDS}");
            let mut add_candidate =
                |measure: String, cost: f64| add(&mut all, measure, *dimension, cost + more, &words, label);
            add_candidate(format!("before(contact('{a}', '{b}'), {text})"), 2.6);
            add_candidate(format!("at(contact('{a}', '{b}'), {text})"), 3.0);
        }
        if *more == 0.0 {
            add(&mut all, format!("period({text})"), second(), 3.0, words, label);
            add(&mut all, format!("crossing({text})"), second(), 3.0, words, label);
        }
        for t in &times {
            let text = format!("at(data.time >= {t} - 1e-9, {text})");
            add(&mut all, text, *dimension, 2.5 + more, words, label);
            if let Some(last) = all.last_mut() {
                last.time = Some(*t);
            }
        }
    }
    depths(model, &displayed, &mut all);
    let names = ModelNames::new(model, Scope::Measure).with(&programs.functions);
    let mut globals = programs.globals.clone();
    let mut texts = BTreeSet::new();
    all.retain(|c| {
        texts.insert(c.text.clone())
            && Compiler::new(&names, &mut globals).expression(&c.text).program.is_some()
    });
    all
}

fn add(all: &mut Vec<Candidate>, text: String, dimension: Dimension, cost: f64, named: &str, label: &str) {
    let (words, label) = (split_words(named).collect(), label.to_string());
    all.push(Candidate { text, dimension, cost, words, constant: None, label, time: None });
}

/// The traces and readouts, without duplicates of the same expression.
fn displayed_numbers(lab: &Lab, model: &Model, programs: &Programs) -> Vec<DisplayedNumber> {
    let found = dimensions(lab, model, programs);
    let mut all: Vec<DisplayedNumber> = Vec::new();
    for ((labels, probe), measured) in check::labels_of(lab).zip(&programs.probes).zip(&found.probes) {
        let Some(bound) = &probe.bound else { continue };
        let label = labels.iter().find_map(|l| of_label(l.as_str()));
        let dimension = measured.as_ref().and_then(|m| match m.value {
            Measure::Dimension(d) if d.factor.is_finite() && d.factor != 0.0 => Some(d),
            _ => None,
        });
        let Some(dimension) = label.map(|(_, d)| d).or(dimension) else { continue };
        let text = bound.text.value.trim().to_string();
        let reads = bound.program.effects().reads.iter();
        let owners = reads.filter_map(|r| element_owner(model, r.field, r.first, r.count?));
        let names = owners.filter_map(|(kind, i)| model.names.of_kind(kind).get(i).map(String::as_str));
        let words: Vec<&str> = labels.iter().map(|l| l.as_str()).chain(names).collect();
        match all.iter_mut().find(|s| s.text == text) {
            Some(same) => same.words = format!("{} {}", same.words, words.join(" ")),
            None => {
                // "height (m)": the label without its unit.
                let label = words.first().map_or("", |label| label.split('(').next().unwrap_or("").trim());
                let label = label.to_string();
                all.push(DisplayedNumber {
                    text,
                    dimension,
                    words: words.join(" "),
                    label,
                    more: 0.0,
                    horizontal: false,
                });
            }
        }
    }
    all
}

/// The coordinates and velocities of named joints.
fn motions(m: &Model) -> Vec<DisplayedNumber> {
    let [metre, radian] = ["m", "rad"].map(|u| labspec_bind::units::parse(u).unwrap_or(Dimension::NUMBER));
    let per = |d: Dimension| second().power(-1.0).and_then(|s| d.product(s)).unwrap_or(d);
    let mut all = Vec::new();
    let named = m.names.joint.iter().zip(&m.jnt_type).filter(|(name, _)| simple(name));
    for (name, kind) in named.take(JOINTS) {
        let mut one = |what: &str, i: usize, dimension| {
            all.push(DisplayedNumber {
                text: format!("data.joint('{name}').{what}[{i}]"),
                dimension,
                words: name.clone(),
                label: name.clone(),
                more: 1.0,
                horizontal: *kind == joint::FREE && i < 2,
            });
        };
        match *kind {
            joint::FREE => {
                (0..3).for_each(|i| one("qpos", i, metre));
                (0..3).for_each(|i| one("qvel", i, per(metre)));
            }
            joint::HINGE => {
                one("qpos", 0, radian);
                one("qvel", 0, per(radian));
            }
            joint::SLIDE => {
                one("qpos", 0, metre);
                one("qvel", 0, per(metre));
            }
            _ => {}
        }
    }
    all
}

/// Forces that a lab may not display: of actuators, of gravity and limits on joints, of contacts on geoms.
fn forces(m: &Model) -> Vec<DisplayedNumber> {
    let [newton, torque] = ["N", "N m"].map(|u| labspec_bind::units::parse(u).unwrap_or(Dimension::NUMBER));
    let mut all = Vec::new();
    let joints =
        m.names.joint.iter().zip(&m.jnt_type).zip(&m.jnt_dofadr).filter(|((name, _), _)| simple(name));
    for ((name, kind), dof) in joints.take(JOINTS) {
        let dimension = match *kind {
            joint::HINGE => torque,
            joint::SLIDE => newton,
            _ => continue,
        };
        for (what, description) in [
            ("bias", "weight gravity load"),
            ("constraint", "limit contact stop"),
            ("actuator", "motor servo"),
        ] {
            let words = format!("{name} force torque {description}");
            all.push(DisplayedNumber {
                text: format!("data.qfrc_{what}[{dof}]"),
                dimension,
                words,
                label: format!("{name} {what}"),
                more: 1.2,
                horizontal: false,
            });
        }
    }
    let actuators = m.names.actuator.iter().enumerate().filter(|(_, name)| simple(name));
    for (a, name) in actuators.take(JOINTS) {
        let Some(rotates) = drives_hinge(m, a) else { continue };
        let dimension = if rotates { torque } else { newton };
        let words = format!("{name} force torque servo motor limit");
        let text = format!("data.actuator_force[{a}]");
        all.push(DisplayedNumber {
            text,
            dimension,
            words,
            label: format!("{name} force"),
            more: 1.2,
            horizontal: false,
        });
    }
    all
}

/// Whether an actuator drives a hinge, so that its force is a torque; `None` if this is not simple.
fn drives_hinge(m: &Model, actuator: usize) -> Option<bool> {
    let index = |list: &[i32], i: usize| list.get(i).and_then(|x| usize::try_from(*x).ok());
    let moved = index(&m.actuator_trnid, 2 * actuator)?;
    let kind = match *m.actuator_trntype.get(actuator)? {
        trntype::JOINT | trntype::JOINTINPARENT => *m.jnt_type.get(moved)?,
        // A tendon is a sum of joints, or a path along sites, which has a force.
        trntype::TENDON => {
            let first = index(&m.tendon_adr, moved)?;
            if m.wrap_type.get(first) != Some(&wraptype::JOINT) {
                return Some(false);
            }
            *m.jnt_type.get(index(&m.wrap_objid, first)?)?
        }
        _ => return None,
    };
    match kind {
        joint::HINGE => Some(true),
        joint::SLIDE => Some(false),
        _ => None,
    }
}

/// Whether a name needs no escapes in an expression.
fn simple(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | ' ' | '.' | '/'))
}

/// Adds the constants of the model that a text may state.
fn constants(m: &Model, all: &mut Vec<Candidate>) {
    let unit = |text: &str| labspec_bind::units::parse(text).unwrap_or(Dimension::NUMBER);
    let mut add = |text: String, dimension, cost, owner: &str, kind: &str| {
        let [owner, kind] = [owner, kind].map(|words| split_words(words).collect::<BTreeSet<String>>());
        let words = owner.union(&kind).cloned().collect();
        let constant = Some(ConstantWords { kind, owner });
        all.push(Candidate { text, dimension, cost, words, constant, label: String::new(), time: None });
    };
    add("model.opt.timestep".into(), second(), 1.0, "", "timestep timesteps step steps");
    for (i, g) in m.opt.gravity.iter().enumerate().filter(|(_, g)| **g != 0.0) {
        let minus = if *g < 0.0 { "-" } else { "" };
        add(format!("{minus}model.opt.gravity[{i}]"), unit("m/s^2"), 1.0, "", GRAVITY_WORDS);
    }
    let bodies = m.names.body.iter().enumerate().skip(1).filter(|(_, name)| simple(name));
    let is_only_body = m.nbody == 2;
    for (i, name) in bodies.take(CONSTANTS) {
        let first = m.body_geomadr.get(i).and_then(|g| usize::try_from(*g).ok());
        let shape = first
            .filter(|_| is_only_body)
            .and_then(|g| m.geom_type.get(g))
            .map_or("", |kind| shape_words(*kind));
        let owner = &format!("{name} {shape}");
        add(format!("model.body('{name}').mass[0]"), unit("kg"), 1.5, owner, MASS_WORDS);
        for k in 0..3 {
            if m.body_pos.get(3 * i + k).is_some_and(|x| *x != 0.0) {
                add(format!("model.body('{name}').pos[{k}]"), unit("m"), 2.5, owner, HEIGHT_WORDS);
            }
        }
    }
    let geoms = m.names.geom.iter().zip(&m.geom_type).enumerate().filter(|(_, (name, _))| simple(name));
    let has_size = |kind: i32| !matches!(kind, geom::PLANE | geom::MESH | geom::HFIELD);
    // Of several equal ones, the text names the shape.
    let sizes = |k: usize| {
        let geoms = m.geom_type.iter().enumerate().filter(|(_, kind)| has_size(**kind));
        let mut sizes = geoms.filter_map(move |(i, _)| m.geom_size.get(3 * i + k).copied());
        let first = sizes.next();
        first.is_some_and(|first| sizes.all(|x| x == first))
    };
    for (i, (name, kind)) in geoms.take(CONSTANTS) {
        if !has_size(*kind) {
            continue;
        }
        for k in 0..3 {
            let owner = &format!("{name} {}", if sizes(k) { shape_words(*kind) } else { "" });
            if m.geom_size.get(3 * i + k).is_some_and(|x| *x != 0.0) {
                add(format!("model.geom('{name}').size[{k}]"), unit("m"), 2.0, owner, SIZE_WORDS);
            }
        }
        add(format!("model.geom('{name}').solref[0]"), second(), 2.5, name, "solref");
    }
}

/// Whether a word of a text is a shape.
pub(super) fn is_shape(word: &str) -> bool {
    let kinds = [geom::SPHERE, geom::BOX, geom::CAPSULE, geom::CYLINDER, geom::ELLIPSOID];
    kinds.into_iter().any(|kind| shape_words(kind).split(' ').any(|shape| shape == word))
}

/// The words of a text for a shape.
fn shape_words(kind: i32) -> &'static str {
    match kind {
        geom::SPHERE => "ball balls sphere spheres bob",
        geom::BOX => "box boxes cube cubes block blocks crate brick",
        geom::CAPSULE => "rod rods capsule link links pole bar",
        geom::CYLINDER => "cylinder cylinders disk disc wheel wheels puck",
        geom::ELLIPSOID => "ellipsoid egg",
        _ => "",
    }
}

/// The depth of a sphere in the ground at its coordinate 0: its radius minus its height.
fn depths(m: &Model, displayed: &[DisplayedNumber], all: &mut Vec<Candidate>) {
    let Some(metre) = labspec_bind::units::parse("m") else { return };
    let geoms =
        m.names.geom.iter().zip(&m.geom_type).filter(|(name, kind)| simple(name) && **kind == geom::SPHERE);
    for (name, _) in geoms.take(PAIRS) {
        for x in displayed.iter().filter(|x| x.dimension == metre && !x.horizontal) {
            for (how, cost) in [("final", 3.0), ("min", 3.2)] {
                let text = format!("model.geom('{name}').size[0] - {how}({})", x.text);
                add(
                    all,
                    text,
                    metre,
                    cost + x.more,
                    &format!(
                        "{name} {} deep deeper depth sink sinks sits rest resting penetration inside displacement",
                        x.words
                    ),
                    "depth",
                );
            }
        }
    }
}

/// Times that the text names, s; those next to many numbers come first.
fn times(numbers: &[Stated]) -> Vec<f64> {
    let mut all: Vec<f64> = Vec::new();
    for s in numbers {
        let t = si(s);
        let is_time = s.dimension == second().times(s.dimension.factor);
        if is_time && t > LONGEST_TIMESTEP && t <= 20.0 && !all.contains(&t) && all.len() < TIMES {
            all.push(t);
        }
    }
    all
}

/// The pairs of named geoms that touch in a run of the unchanged lab.
fn touching_geoms(lab: &Lab, model: &Model, programs: &Programs) -> Vec<(String, String)> {
    let plan = Some(Plan::new(model, &AccessSet::ANY));
    let mut session = Session::start(programs, model, Start { plan, ..Start::of_lab(lab) });
    let timestep = session.world.model.opt.timestep;
    let Ok(steps) = run::count_steps(lab, None, None, timestep) else { return Vec::new() };
    let mut pairs: Vec<(String, String)> = Vec::new();
    run::play(&mut session, &Play::steps(steps.min(STEPS)), |session, _| {
        for c in &session.world.data.fields().contact {
            let name = |g: usize| model.names.geom.get(g).filter(|n| simple(n)).cloned();
            if let (Some(a), Some(b)) = (name(c.geom1), name(c.geom2))
                && !pairs.contains(&(a.clone(), b.clone()))
                && pairs.len() < PAIRS
            {
                pairs.push((a, b));
            }
        }
        ControlFlow::Continue(())
    });
    pairs
}
