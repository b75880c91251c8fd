//! Reads a lab and its `verify` object. Each can contain the other, so the two readers call each other.

use super::address::LabAddress;
use super::fields::Fields;
use super::format::{CAMERA, INTEGRATORS, LAB, Object, RUN, VERIFY};
use super::integrators::{add_comparison, read_comparison};
use super::lab::{BreakExpectation, Camera, Expect, Lab, Run, UsedObject, Verify, VerifyLab};
use super::problem::{FormatProblem, Meant, Mistake, Problem};
use super::read_claim::{
    read_all_says, read_change, read_columns, read_exact, read_expectation, read_find, read_measures,
    read_over, read_press, read_sweep,
};
use super::{allow, control, plot, read};
use crate::json::{Json, Member, Node};
use crate::source::{SourceMap, Text};
use labspec_finding::order;
use std::collections::BTreeSet;

/// Reads a lab.
pub(super) fn read_lab(node: &Node, problems: &mut Vec<Problem>) -> Option<Lab> {
    read_keys(node, &LAB, problems)
}

/// Reads a lab that compares integrators.
pub(super) fn read_integrators(node: &Node, problems: &mut Vec<Problem>) -> Option<Lab> {
    read_keys(node, &INTEGRATORS, problems)
}

/// Reads a lab outside of a fence, whose keys decide about its kind.
pub(super) fn read_any_lab(node: &Node, problems: &mut Vec<Problem>) -> Option<Lab> {
    let compares = node.get("integrators").is_some();
    if compares { read_integrators(node, problems) } else { read_lab(node, problems) }
}

fn read_keys(node: &Node, object: &'static Object, problems: &mut Vec<Problem>) -> Option<Lab> {
    let first = problems.len();
    let mut fields = Fields::open(node, object, problems)?;
    let f = &mut fields;
    let lab = Lab {
        span: f.span(),
        model: f.text("model"),
        xml: f.text("xml"),
        key: f.whole("key"),
        title: f.text("title"),
        kind: f.text("kind"),
        note: f.text("note"),
        height: f.number("height"),
        dock: f.flag("dock"),
        autoplay: f.flag("autoplay"),
        camera: f.node("camera").and_then(|n| read_camera(n, f.problems)).unwrap_or_default(),
        overlays: read_overlays(f),
        toggles: f.list("toggles").iter().filter_map(|n| read::text(n, "a toggle", f.problems)).collect(),
        force_scale: f.number("forceScale"),
        trail: f.text("trail"),
        speeds: f.list("speeds").iter().filter_map(|n| read::number(n, "a speed", f.problems)).collect(),
        stop_at: f.number("stopAt"),
        setup: f.text("setup"),
        controller: f.text("controller"),
        unread_controls: false,
        unread_key: None,
        controls: f.list("controls").iter().filter_map(|n| control::read(n, f.problems)).collect(),
        plots: f.list("plots").iter().filter_map(|n| plot::read(n, f.problems)).collect(),
        readouts: f.list("readouts").iter().filter_map(|n| plot::readout(n, f.problems)).collect(),
        verify: f.node("verify").and_then(|n| read_verify(n, f.problems)),
        lint: allow::read_allowance(f.node("lint"), f.span(), f.problems),
        expect: f.text("expect").and_then(|t| read_expect(&t, f.problems)),
        comparison: None,
    };
    let comparison = (object.name == INTEGRATORS.name).then(|| read_comparison(f));
    let listed = f.list("controls").len();
    fields.finish();
    let unread_key = unread_key(
        node,
        &[
            ("key", lab.key.is_none()),
            ("stopAt", lab.stop_at.is_none()),
            ("setup", lab.setup.is_none()),
            ("controller", lab.controller.is_none()),
        ],
    );
    let misspelt = misspelt_key(problems.get(first..).unwrap_or_default(), object.what);
    let unread_key = unread_key.or(misspelt.filter(|key| DECISIVE_KEYS.contains(key)));
    let unread_controls = lab.controls.len() < listed || no_list_of_controls(node);
    let lab = Lab { unread_controls, unread_key, ..lab };
    Some(match comparison {
        Some(comparison) => add_comparison(lab, comparison),
        None => lab,
    })
}

/// Keys of a lab that decide about its runs.
const DECISIVE_KEYS: [&str; 7] = ["model", "xml", "key", "stopAt", "setup", "controller", "controls"];

/// The key that is probably meant by an unknown key of an object: the page does not read it, even where the check does.
fn misspelt_key(problems: &[Problem], object: &'static str) -> Option<&'static str> {
    problems.iter().find_map(|problem| match problem {
        Problem::Format(FormatProblem { mistake: Mistake::UnknownKey { object: of, meant, .. }, .. })
            if *of == object =>
        {
            match meant {
                Meant::There(key) | Meant::Likely(key) | Meant::Other { key, .. } => Some(*key),
                Meant::Unclear(_) => None,
            }
        }
        _ => None,
    })
}

/// The first of these keys that an object has and that was not read.
fn unread_key(node: &Node, keys: &[(&'static str, bool)]) -> Option<&'static str> {
    keys.iter().find(|(key, is_missing)| *is_missing && node.get(key).is_some()).map(|(key, _)| *key)
}

/// The number of entries of an object or a list under a key.
fn entries(node: &Node, key: &str) -> usize {
    match node.get(key).map(|n| &n.json) {
        Some(Json::Array(items)) => items.len(),
        Some(Json::Object(members)) => members.len(),
        Some(_) => usize::MAX,
        None => 0,
    }
}

/// Whether the list of controls itself could not be read.
fn no_list_of_controls(node: &Node) -> bool {
    node.get("controls").is_some_and(|n| !matches!(n.json, Json::Array(_)))
}

fn read_expect(text: &Text, problems: &mut Vec<Problem>) -> Option<Expect> {
    match text.as_str() {
        "breaks" => Some(Expect::Breaks(text.span())),
        "may break" => Some(Expect::MayBreak),
        _ => {
            problems.push(Mistake::LabExpects(text.value.clone()).at(text.span()));
            None
        }
    }
}

fn read_camera(node: &Node, problems: &mut Vec<Problem>) -> Option<Camera> {
    let mut fields = Fields::open(node, &CAMERA, problems)?;
    let standard = Camera::default();
    let camera = Camera {
        azimuth: fields.number("azimuth").map_or(standard.azimuth, |n| n.value),
        elevation: fields.number("elevation").map_or(standard.elevation, |n| n.value),
        distance: fields.number("distance").map(|n| n.value),
        target: fields.node("target").and_then(|n| read_point(n, fields.problems)),
    };
    fields.finish();
    Some(camera)
}

/// Three numbers.
fn read_point(node: &Node, problems: &mut Vec<Problem>) -> Option<[f64; 3]> {
    if let Json::Array(items) = &node.json
        && let [Json::Number(x), Json::Number(y), Json::Number(z)] =
            items.iter().map(|n| &n.json).collect::<Vec<_>>()[..]
    {
        return Some([*x, *y, *z]);
    }
    if node.is_broken() || matches!(&node.json, Json::Array(items) if items.iter().any(Node::is_broken)) {
        return None;
    }
    problems.push(Mistake::NoPoint.at(node.span.clone()));
    None
}

fn read_overlays(fields: &mut Fields<'_, '_>) -> Vec<(Text, bool)> {
    let mut all = Vec::new();
    for member in fields.map("overlays") {
        match member.value.json {
            Json::Bool(on) => all.push((member.key.clone(), on)),
            Json::Broken => {}
            _ => fields.problems.push(Mistake::NoSwitch.at(member.value.span.clone())),
        }
    }
    all
}

/// Reads a `verify` object.
pub(super) fn read_verify(node: &Node, problems: &mut Vec<Problem>) -> Option<Verify> {
    read_object(node, false, problems)
}

/// Reads the runs and measures of a definition, which other objects use.
pub(super) fn read_definition(node: &Node, problems: &mut Vec<Problem>) -> Option<Verify> {
    read_object(node, true, problems)
}

fn read_object(node: &Node, is_definition: bool, problems: &mut Vec<Problem>) -> Option<Verify> {
    let before = problems.len();
    let mut fields = Fields::open(node, &VERIFY, problems)?;
    let f = &mut fields;
    // An empty list claims as little as none.
    let claims =
        ["options", "value", "says", "table", "exact"].iter().any(|key| f.has(key) && !f.is_empty(key));
    if claims && is_definition {
        let mistake = Mistake::ClaimsInDefinition.at(f.span());
        f.problems.push(mistake);
    }
    if !claims && !is_definition {
        let mistake = Mistake::ClaimsNothing.at(f.span());
        f.problems.push(mistake);
    }
    let verify = Verify {
        span: f.span(),
        lab: f.node("lab").map(|n| read_verify_lab(n, f.problems).unwrap_or(VerifyLab::Broken)),
        uses: f.text("use").and_then(|text| read_uses(text, f.problems)),
        runs: read_runs(f.map("runs"), f.problems),
        measure: read_measures(f, "measure"),
        find: f.map("find").iter().filter_map(|m| read_find(m, f.problems)).collect(),
        options: f.list("options").iter().filter_map(|n| read::text(n, "a condition", f.problems)).collect(),
        over: f.map("over").iter().filter_map(|m| read_over(m, f.problems)).collect(),
        value: f.text("value"),
        wrong: f.list("wrong").iter().filter_map(|n| read::text(n, "a wrong value", f.problems)).collect(),
        says: read_all_says(f.list("says"), f.problems),
        table: f.list("table").iter().filter_map(|n| read_columns(n, f.problems)).flatten().collect(),
        exact: f.map("exact").iter().filter_map(|m| read_exact(m, f.problems)).collect(),
    };
    fields.finish();
    for problem in problems.iter_mut().skip(before) {
        if let Problem::Format(problem) = problem {
            problem.in_verify = true;
        }
    }
    Some(verify)
}

fn read_verify_lab(node: &Node, problems: &mut Vec<Problem>) -> Option<VerifyLab> {
    match &node.json {
        Json::Text(text) => {
            let (file, place) = text.value.rsplit_once('#').unwrap_or((&text.value, ""));
            match (file, LabAddress::parse(&format!("#{place}"))) {
                ("", Some(address)) => Some(VerifyLab::Reference(text.clone(), address)),
                (file, Some(address)) => Some(VerifyLab::Elsewhere(text.clone(), file.to_string(), address)),
                (_, None) => {
                    problems.push(Mistake::NoPlace(text.value.clone()).at(text.span()));
                    None
                }
            }
        }
        Json::Object(_) => read_lab(node, problems).map(|l| VerifyLab::Inline(Box::new(l))),
        Json::Broken => None,
        _ => {
            problems.push(Mistake::NoLab(node.describe()).at(node.span.clone()));
            None
        }
    }
}

/// The object whose runs and measures are used.
fn read_uses(text: Text, problems: &mut Vec<Problem>) -> Option<(Text, UsedObject)> {
    let used = match LabAddress::parse(&text.value) {
        Some(address) => UsedObject::Owner(address),
        None if !text.value.is_empty() && text.value.chars().all(is_name) => {
            UsedObject::Defined(text.value.clone())
        }
        None => {
            problems.push(Mistake::NoPlace(text.value.clone()).at(text.span()));
            return None;
        }
    };
    Some((text, used))
}

/// Whether a character can be part of the name of a definition.
pub(super) fn is_name(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '-' | '_')
}

/// Reads the runs of an object. A name with commas, `"light, heavy"`, lists a name for each run of its sweep.
fn read_runs(members: &[Member], problems: &mut Vec<Problem>) -> Vec<Run> {
    let mut all: Vec<Run> = Vec::new();
    let mut listed = Vec::new();
    for member in members {
        let Some(run) = read_run(member, problems) else { continue };
        let Some(sweep) = run.sweep.as_ref().filter(|_| run.name.value.contains(',')) else {
            all.push(run);
            continue;
        };
        let (names, members) = (run.name.value.split(',').count(), sweep.count());
        if members != names {
            problems.push(Mistake::RunNames { names, members }.at(run.name.span()));
            continue;
        }
        let names = names_of_list(&run.name);
        listed.extend(names.iter().map(|name| name.value.clone()));
        let members = names.into_iter().enumerate();
        all.extend(members.map(|(i, name)| Run { name, sweep: Some(sweep.member(i)), ..run.clone() }));
    }
    // Equal keys are reported as such; equal names in lists are no equal keys.
    let listed = order::set(listed);
    let mut read = BTreeSet::new();
    for run in &all {
        if !read.insert(&run.name.value) && listed.contains(&run.name.value) {
            problems.push(Mistake::RunTwice(run.name.value.clone()).at(run.name.span()));
        }
    }
    all
}

/// The names in a list that is separated by commas.
fn names_of_list(list: &Text) -> Vec<Text> {
    let mut start = 0;
    let parts = list.value.split(',').map(|part| {
        let name = part.trim();
        let from = start + part.len() - part.trim_start().len();
        start += part.len() + 1;
        Text {
            value: name.to_string(),
            map: SourceMap::whole(name.len(), list.span_of(from..from + name.len())),
        }
    });
    parts.collect()
}

fn read_run(member: &Member, problems: &mut Vec<Problem>) -> Option<Run> {
    let mut fields = Fields::open(&member.value, &RUN, problems)?;
    let f = &mut fields;
    let run = Run {
        name: member.key.clone(),
        lab: f.node("lab").map(|n| read_verify_lab(n, f.problems).unwrap_or(VerifyLab::Broken)),
        model: f.map("model").iter().filter_map(|m| read_change(m, f.problems)).collect(),
        key: f.node("key").and_then(|n| read::scalar(n, "key", f.problems)),
        controller: f.text("controller"),
        set: f
            .map("set")
            .iter()
            .filter_map(|m| {
                Some((m.key.clone(), read::scalar(&m.value, "the value of a control", f.problems)?))
            })
            .collect(),
        press: f.list("press").iter().filter_map(|n| read_press(n, f.problems)).collect(),
        setup: f.text("setup"),
        until: f.number("until"),
        steps: f.whole("steps"),
        stop: f.text("stop"),
        sweep: f.node("sweep").and_then(|n| read_sweep(n, f.problems)),
        expect: f.text("expect").map_or(BreakExpectation::None, |t| read_expectation(&t, f.problems)),
        unread_key: None,
    };
    fields.finish();
    let unread = unread_key(
        &member.value,
        &[
            ("key", run.key.is_none()),
            ("controller", run.controller.is_none()),
            ("setup", run.setup.is_none()),
            ("until", run.until.is_none()),
            ("steps", run.steps.is_none()),
            ("stop", run.stop.is_none()),
            ("sweep", run.sweep.is_none()),
            ("set", run.set.len() < entries(&member.value, "set")),
            ("press", run.press.len() < entries(&member.value, "press")),
            ("model", run.model.len() < entries(&member.value, "model")),
        ],
    );
    Some(Run { unread_key: unread, ..run })
}
