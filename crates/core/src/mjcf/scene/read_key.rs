//! Keyframes: named initial states.

use crate::mjcf::classes::Props;
use crate::mjcf::fill::Sizes;
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::spec::KeySpec;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::{ElementNode, ElementTree, name};

/// All keyframes in the order of the text, at least `min` of them.
pub(crate) fn keys(tree: &ElementTree, sizes: &Sizes, min: usize, report: &mut Diagnostics) -> Vec<KeySpec> {
    let given: Vec<&ElementNode> = listed(
        tree.sections("keyframe").flat_map(|(section, _)| tree.children(section)).map(|(_, node)| node),
    );
    let numbers = 1 + sizes.nq + sizes.nv + sizes.na + sizes.nu + 7 * sizes.nmocap;
    let span = given.first().map_or(0..0, |n| n.span.clone());
    if !report.take(given.len().max(min).saturating_mul(numbers), span, "all keyframes together") {
        return Vec::new();
    }
    let mut list: Vec<KeySpec> = listed(given.into_iter().map(|node| key(node, sizes, report)));
    while list.len() < min {
        list.push(KeySpec {
            name: String::new(),
            time: 0.0,
            qpos: None,
            qvel: None,
            act: None,
            ctrl: None,
            mpos: None,
            mquat: None,
        });
    }
    list
}

/// How a list that is too short is treated.
#[derive(Clone, Copy, PartialEq)]
enum Padding {
    /// Missing numbers are zero, as in MuJoCo.
    Zero,
    /// A short list is an error. MuJoCo fills the rest of a configuration with angles in degrees and with poses outside their
    /// frames, which authors do not intend.
    Needed,
}

fn key(node: &ElementNode, sizes: &Sizes, report: &mut Diagnostics) -> KeySpec {
    let p = Props::written_props(node);
    let mut list = |name: &str, n: usize, rest: Padding, what: String| {
        let mut given = p.list(name).filter(|list| !list.is_empty())?.to_vec();
        if rest == Padding::Zero && given.len() < n {
            given.resize(n, 0.0);
        }
        if given.len() != n {
            let plural = if given.len() == 1 { "" } else { "s" };
            let owner = node.describe();
            let message =
                format!("`{name}` of {owner} has {} number{plural}, but the model needs {n}", given.len());
            report.error(rules::KEYFRAME, p.span(name).unwrap_or(0..0), message).why(what);
            return None;
        }
        Some(given)
    };
    let state = |what: &str, free: usize, ball: usize| {
        format!("{what}: {free} for a free joint, {ball} for a ball joint, one for a slide or hinge joint")
    };
    let none = |n: usize, what: &str| match n {
        0 => "the model has no actuators that need it".to_string(),
        _ => what.to_string(),
    };
    KeySpec {
        name: name(node),
        time: p.real("time").unwrap_or(0.0),
        qpos: list("qpos", sizes.nq, Padding::Needed, state("one coordinate after the other", 7, 4)),
        qvel: list("qvel", sizes.nv, Padding::Zero, state("one velocity after the other", 6, 3)),
        act: list("act", sizes.na, Padding::Zero, none(sizes.na, "one for each state of an actuator")),
        ctrl: list("ctrl", sizes.nu, Padding::Zero, none(sizes.nu, "one for each control of an actuator")),
        mpos: list("mpos", 3 * sizes.nmocap, Padding::Needed, "three for each mocap body".into()),
        mquat: list("mquat", 4 * sizes.nmocap, Padding::Needed, "four for each mocap body".into()),
    }
}
