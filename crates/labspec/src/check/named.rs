//! Labels that name one thing of the model, while their expressions read another.

use crate::bind::{Bound, Programs};
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use crate::spec::Lab;
use labspec_bind::element_owner;
use labspec_core::{Model, Obj};
use std::collections::BTreeSet;

/// What labels name, and what they call it.
const KINDS: [(Obj, &str); 6] = [
    (Obj::Body, "body"),
    (Obj::Joint, "joint"),
    (Obj::Geom, "geom"),
    (Obj::Site, "site"),
    (Obj::Actuator, "actuator"),
    (Obj::Sensor, "sensor"),
];

/// Most names and most labels that are looked at.
const MOST: usize = 400;

/// A name of the model.
struct Named {
    kind: Obj,
    noun: &'static str,
    index: usize,
    name: String,
    words: Vec<String>,
    body: usize,
}

/// A label, and what its expression reads.
struct Shown<'l> {
    label: &'l Text,
    bound: &'l Bound,
    /// The names in it, the longest where one is a part of another.
    names: Vec<usize>,
    /// Its words without the name that it has, if that is one.
    rest: Vec<String>,
    /// What it reads, if that is known of everything.
    reads: Vec<(Obj, usize)>,
    /// The bodies that this belongs to.
    bodies: BTreeSet<usize>,
}

/// Every name of a body, joint, geom, site, actuator or sensor.
pub(super) fn names(model: &Model) -> impl Iterator<Item = &str> {
    KINDS.iter().flat_map(|(kind, _)| model.names.of(*kind)).map(String::as_str).filter(|n| !n.is_empty())
}

pub(super) fn check(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    let all = elements(model);
    let traces = lab.plots.iter().flat_map(|p| &p.traces).map(|t| &t.label);
    let labels = traces.chain(lab.readouts.iter().map(|r| &r.label));
    let shown: Vec<Shown<'_>> = labels
        .zip(&programs.probes)
        .take(MOST)
        .filter_map(|(label, probe)| shown(label, probe.bound.as_ref()?, model, &all))
        .collect();
    for one in &shown {
        let ([name], Some(&body)) = (one.names.as_slice(), one.bodies.first()) else { continue };
        let Some(named) = all.get(*name).filter(|n| n.body != body && one.bodies.len() == 1) else {
            continue;
        };
        if !(alone(one, named) || beside(one, named, body, &shown, &all)) {
            continue;
        }
        let reads = one
            .reads
            .iter()
            .filter_map(|(kind, index)| all.iter().find(|n| n.kind == *kind && n.index == *index));
        let Some(other) = reads.into_iter().next() else { continue };
        findings.push(
            Finding::new(
                rules::LABEL_NAMES_ANOTHER,
                one.label.span(),
                format!(
                    "the label names the {} \"{}\", and the expression reads the {} \"{}\"",
                    named.noun, named.name, other.noun, other.name
                ),
            )
            .help("read what the label names, or name what is read; two labels may have been exchanged")
            .related(one.bound.text.span(), format!("this belongs to \"{}\"", other.name)),
        );
    }
}

/// Whether the label is a name and nothing else, of something that has what the expression reads.
fn alone(one: &Shown<'_>, named: &Named) -> bool {
    let same_kind = |kind: Obj| kind == named.kind || named.kind == Obj::Body && kind == Obj::Joint;
    one.rest.is_empty() && one.reads.iter().all(|(kind, _)| same_kind(*kind))
}

/// Whether another label is the same but for its name, which is that of what this one reads. Where that one reads a third thing, the
/// names may mean something else.
fn beside(one: &Shown<'_>, named: &Named, body: usize, shown: &[Shown<'_>], all: &[Named]) -> bool {
    shown.iter().any(|other| {
        let [name] = other.names.as_slice() else { return false };
        let Some(its) = all.get(*name) else { return false };
        let reads = other.bodies.len() == 1 && other.bodies.iter().all(|b| *b == body || *b == named.body);
        let alike = other.rest == one.rest && its.kind == named.kind;
        its.body == body && reads && alike
    })
}

/// A label with what it names and reads; `None` when it is not known of all that is read where it belongs.
fn shown<'l>(label: &'l Text, bound: &'l Bound, model: &Model, all: &[Named]) -> Option<Shown<'l>> {
    let effects = bound.program.effects();
    if effects.reads_everything || effects.any_ctx || effects.calls_values || !effects.ctx_reads.is_empty() {
        return None;
    }
    let words = words(match super::labels::of_label(label.as_str()) {
        Some((unit, _)) => label.as_str().get(..label.as_str().rfind(unit)?)?,
        None => label.as_str(),
    });
    let mut reads = Vec::new();
    for access in &effects.reads {
        let owner = element_owner(model, access.field, access.first, access.count?);
        match owner {
            Some((kind, index)) => reads.push((kind, index)),
            // Time and options belong to nobody.
            None if access.count == Some(1) => {}
            None => return None,
        }
    }
    let bodies = reads.iter().map(|(kind, index)| body_of(model, *kind, *index)).collect::<Option<_>>()?;
    // Where several things have one name, the first of the kind that is read is meant.
    let mut names: Vec<(usize, usize, usize)> = Vec::new();
    for (i, named) in all.iter().enumerate() {
        let Some(at) = words.windows(named.words.len()).position(|w| w == named.words) else { continue };
        let to = at + named.words.len();
        let within = |n: &(usize, usize, usize)| n.1 <= at && to <= n.2;
        let same_body = |n: &(usize, usize, usize)| all.get(n.0).is_some_and(|o| o.body == named.body);
        let covered = names.iter().any(|n| within(n) && (n.1, n.2) != (at, to));
        match names.iter_mut().find(|n| n.1 == at && n.2 == to && same_body(n)) {
            Some(known) if reads.iter().any(|(kind, _)| *kind == named.kind) => known.0 = i,
            Some(_) => {}
            None if covered => {}
            None => {
                names.retain(|n| !(at <= n.1 && n.2 <= to) || (n.1, n.2) == (at, to));
                names.push((i, at, to));
            }
        }
    }
    let mut rest = words.clone();
    if let [(_, from, to)] = names.as_slice() {
        rest.drain(*from..*to);
    }
    Some(Shown { label, bound, names: names.into_iter().map(|n| n.0).collect(), rest, reads, bodies })
}

/// The words of a label or a name, in small letters.
fn words(text: &str) -> Vec<String> {
    let parts = text.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty());
    parts.map(str::to_lowercase).collect()
}

/// Everything that has a name of its own and belongs to a body that is not the world. A letter is no name that a label would have.
fn elements(model: &Model) -> Vec<Named> {
    let mut all = Vec::new();
    for (kind, noun) in KINDS {
        for (index, name) in
            model.names.of(kind).iter().enumerate().filter(|(_, n)| n.chars().count() > 1).take(MOST)
        {
            let body = body_of(model, kind, index).filter(|b| *b != 0);
            // A space of names stands before a stroke.
            let own = name.rsplit('/').next().unwrap_or(name);
            if let (Some(body), false) = (body, words(own).is_empty()) {
                all.push(Named { kind, noun, index, name: name.clone(), words: words(own), body });
            }
        }
    }
    all
}

/// The body that something belongs to.
fn body_of(model: &Model, kind: Obj, index: usize) -> Option<usize> {
    let at = |list: &[i32], i: usize| list.get(i).and_then(|b| usize::try_from(*b).ok());
    match kind {
        Obj::Body => Some(index),
        Obj::Joint => at(&model.jnt_bodyid, index),
        Obj::Geom => at(&model.geom_bodyid, index),
        Obj::Site => at(&model.site_bodyid, index),
        Obj::Actuator => match *model.actuator_trntype.get(index)? {
            labspec_core::trntype::JOINT | labspec_core::trntype::JOINTINPARENT => {
                at(&model.jnt_bodyid, at(&model.actuator_trnid, 2 * index)?)
            }
            _ => None,
        },
        Obj::Sensor => {
            let kinds = [Obj::Body, Obj::XBody, Obj::Joint, Obj::Geom, Obj::Site, Obj::Actuator];
            let kind = kinds.into_iter().find(|k| model.sensor_objtype.get(index) == Some(&(*k as i32)))?;
            let kind = if kind == Obj::XBody { Obj::Body } else { kind };
            body_of(model, kind, at(&model.sensor_objid, index)?)
        }
        _ => None,
    }
}
