//! Reads a lab and its `verify` object. Each can contain the other, so the two readers call each other.

use super::address::LabAddress;
use super::fields::Fields;
use super::format::{CAMERA, INTEGRATORS, LAB, Object, RUN, VERIFY};
use super::integrators::{add_comparison, read_comparison};
use super::lab::{Camera, Expect, Lab, Run, Verify, VerifyLab};
use super::problem::{Mistake, Problem};
use super::read_claim::{
    read_breaks, read_change, read_column, read_exact, read_find, read_measures, read_over, read_press,
    read_says, read_sweep,
};
use super::{allow, control, plot, read};
use crate::json::{Json, Member, Node};
use crate::source::Text;

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
    let lab = Lab { unread_controls: lab.controls.len() < listed || no_list_of_controls(node), ..lab };
    Some(match comparison {
        Some(comparison) => add_comparison(lab, comparison),
        None => lab,
    })
}

/// Whether the list of controls itself could not be read.
fn no_list_of_controls(node: &Node) -> bool {
    node.get("controls").is_some_and(|n| !matches!(n.json, Json::Array(_)))
}

fn read_expect(text: &Text, problems: &mut Vec<Problem>) -> Option<Expect> {
    if text.as_str() == "breaks" {
        return Some(Expect::Breaks(text.span()));
    }
    problems.push(Mistake::LabExpects(text.value.clone()).at(text.span()));
    None
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
    let before = problems.len();
    let mut fields = Fields::open(node, &VERIFY, problems)?;
    let f = &mut fields;
    if !["options", "value", "says", "table", "exact"].iter().any(|key| f.has(key)) {
        let mistake = Mistake::ClaimsNothing.at(f.span());
        f.problems.push(mistake);
    }
    let verify = Verify {
        span: f.span(),
        lab: f.node("lab").map(|n| read_verify_lab(n, f.problems).unwrap_or(VerifyLab::Broken)),
        uses: f.text("use").and_then(|text| read_uses(text, f.problems)),
        runs: f.map("runs").iter().filter_map(|m| read_run(m, f.problems)).collect(),
        measure: read_measures(f, "measure"),
        find: f.map("find").iter().filter_map(|m| read_find(m, f.problems)).collect(),
        options: f.list("options").iter().filter_map(|n| read::text(n, "a condition", f.problems)).collect(),
        over: f.map("over").iter().filter_map(|m| read_over(m, f.problems)).collect(),
        value: f.text("value"),
        wrong: f.list("wrong").iter().filter_map(|n| read::text(n, "a wrong value", f.problems)).collect(),
        says: f.list("says").iter().filter_map(|n| read_says(n, f.problems)).collect(),
        table: f.list("table").iter().filter_map(|n| read_column(n, f.problems)).collect(),
        exact: f.map("exact").iter().filter_map(|m| read_exact(m, f.problems)).collect(),
    };
    fields.finish();
    for problem in problems.iter_mut().skip(before) {
        if let Problem::Format(misfit) = problem {
            misfit.in_verify = true;
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
fn read_uses(text: Text, problems: &mut Vec<Problem>) -> Option<(Text, LabAddress)> {
    let address = LabAddress::parse(&text.value);
    if address.is_none() {
        problems.push(Mistake::NoPlace(text.value.clone()).at(text.span()));
    }
    Some((text, address?))
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
        breaks: f.text("expect").is_some_and(|t| read_breaks(&t, f.problems)),
    };
    fields.finish();
    Some(run)
}
