//! Contradictory ranges: disabled where they are written, violated by a keyframe, or missing for a servo.

use super::{digits, element_span, format_name, own_name};
use crate::kinds::joint;
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::{Attribute, ElementNode, ElementTree};
use crate::mjcf::text::values::Value;
use crate::model::{Model, Obj};

/// Ranges and the flags that disable them.
const PAIRS: [(&str, &str); 4] = [
    ("range", "limited"),
    ("ctrlrange", "ctrllimited"),
    ("forcerange", "forcelimited"),
    ("actrange", "actlimited"),
];
/// A keyframe may exceed a limit by this fraction of the range without a report, because limits are soft.
const LIMIT_TOLERANCE: f64 = 0.01;
const SERVOS: [&str; 2] = ["position", "intvelocity"];

pub(super) fn check_ranges(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    switched_off(tree, report);
    keys(tree, m, report);
    servos(tree, m, report);
}

fn attribute<'n>(node: &'n ElementNode, name: &str) -> Option<&'n Attribute> {
    node.attributes.iter().find(|a| a.attr.name == name)
}

/// Reports a range in an element whose flag is `false`.
fn switched_off(tree: &ElementTree, report: &mut Diagnostics) {
    for node in &tree.nodes {
        for (range, flag) in PAIRS {
            let (Some(range), Some(flag)) = (attribute(node, range), attribute(node, flag)) else { continue };
            if matches!(flag.value, Value::Keyword(0))
                && matches!(&range.value, Value::Reals(r) if r.iter().any(|x| *x != 0.0))
            {
                let message = format!(
                    "`{}` is given, but `{}` beside it is false, so it limits nothing",
                    range.attr.name, flag.attr.name
                );
                report.note(rules::RANGE_OFF, range.span.clone(), message).help("remove one of them");
            }
        }
    }
}

/// Reports keyframes that start beyond a limit.
fn keys(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let nodes: Vec<&ElementNode> =
        listed(tree.sections("keyframe").flat_map(|(i, _)| tree.children(i).map(|(_, n)| n)));
    for (k, node) in nodes.iter().enumerate().take(m.nkey) {
        // Coordinates that are not written are those of the default configuration.
        let Some(qpos) = attribute(node, "qpos") else { continue };
        for j in 0..m.njnt {
            let one = m.jnt_type.get(j).is_some_and(|t| matches!(*t, joint::HINGE | joint::SLIDE));
            let limited = m.jnt_limited.get(j).copied().unwrap_or(false);
            let Some(adr) = m.jnt_qposadr.get(j).filter(|_| one && limited) else { continue };
            let (Some(x), Some([low, high])) =
                (m.key_qpos.get(k * m.nq + *adr as usize), m.jnt_range.get(2 * j..2 * j + 2))
            else {
                continue;
            };
            let beyond = (low - x).max(x - high);
            if beyond > LIMIT_TOLERANCE * (high - low) {
                let name = m.names.of_kind(Obj::Joint).get(j).map_or("", String::as_str);
                let key = format_name("key", own_name(node).unwrap_or(""), k);
                let message = format!(
                    "{key} puts {} at {}, but its range is {} to {}",
                    format_name("joint", name, j),
                    digits(*x),
                    digits(*low),
                    digits(*high)
                );
                report
                    .warning(rules::KEY_BEYOND, qpos.span.clone(), message)
                    .why("the limit pushes the joint back from the first step on, so the scene does not begin at rest")
                    .help("move it into the range, or widen the range");
            }
        }
    }
}

/// Reports position servos that have neither a range of targets nor a range of forces.
fn servos(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let nodes: Vec<&ElementNode> =
        listed(tree.sections("actuator").flat_map(|(i, _)| tree.children(i).map(|(_, n)| n)));
    if nodes.len() != m.nactuator || m.nu != m.nactuator {
        return;
    }
    let free = |i: &usize| {
        let limit = |list: &[bool]| list.get(*i).copied().unwrap_or(false);
        !limit(&m.actuator_ctrllimited) && !limit(&m.actuator_forcelimited)
    };
    let servo = |i: &usize| nodes.get(*i).is_some_and(|n| SERVOS.contains(&n.element.name));
    let all: Vec<usize> = listed((0..nodes.len()).filter(servo));
    let open: Vec<usize> = listed(all.iter().copied().filter(free));
    let Some(first) = open.first() else { return };
    let name = m.names.of_kind(Obj::Actuator).get(*first).map_or("", String::as_str);
    let span = nodes.get(*first).map_or_else(|| element_span(tree, &SERVOS, name), |n| n.span.clone());
    let message = match open.len() {
        1 => format!("{} has neither `ctrlrange` nor `forcerange`", format_name("servo", name, *first)),
        n => format!("{n} of {} servos have neither `ctrlrange` nor `forcerange`", all.len()),
    };
    report
        .note(rules::FREE_SERVO, span, message)
        .why("it follows any target of a slider or a controller with as much force as it takes")
        .help("give it the range of its joint");
}
