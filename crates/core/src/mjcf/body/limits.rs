//! Ranges with a flag, such as `range` and `limited`, for coordinates and forces.

use crate::kinds::choice;
use crate::mjcf::classes::Props;
use crate::mjcf::context::Context;
use crate::mjcf::rules::{self, Rule};
use crate::mjcf::text::tree::ElementNode;

/// The names of the attributes of a range.
pub(crate) struct Limit {
    pub(crate) range: &'static str,
    pub(crate) flag: &'static str,
    /// The rule for errors in the range.
    pub(crate) code: &'static Rule,
}

/// Whether a range is active, and the range. The flag decides; if it is `auto`, a given range is active.
pub(crate) fn read(cx: &mut Context, p: &Props, node: &ElementNode, limit: &Limit) -> (bool, [f64; 2]) {
    let range = p.reals(limit.range, [0.0; 2]);
    let span = p.span(limit.range).unwrap_or(node.span.clone());
    let given = p.has(limit.range) && range != [0.0; 2];
    let flag = p.keyword(limit.flag).unwrap_or(choice::AUTO);
    (decide(cx, flag, given, range, span, &node.describe(), limit), range)
}

/// Whether a range is active. Reports an active range whose upper limit does not exceed its lower limit.
pub(crate) fn decide(
    cx: &mut Context,
    flag: i32,
    given: bool,
    [lower, upper]: [f64; 2],
    span: std::ops::Range<usize>,
    owner: &str,
    limit: &Limit,
) -> bool {
    let Limit { range, flag: attribute, code } = *limit;
    let limited = match flag {
        choice::FALSE => false,
        choice::TRUE => true,
        _ if cx.compiler.autolimits => {
            if given && lower >= upper {
                let message = format!("the {range} of {owner} is {lower} to {upper}, which limits nothing");
                cx.report
                    .warning(rules::NO_EFFECT, span.clone(), message)
                    .why("the lower limit must be smaller than the upper one; otherwise there is no limit")
                    .help(match lower > upper {
                        true => format!("write `{range}=\"{upper} {lower}\"`, or remove it"),
                        false => format!("write `{range}=\"LOWER UPPER\"`, or remove it"),
                    });
            }
            given && lower < upper
        }
        _ => {
            if given {
                let message = format!("{owner} has a {range}, but it is not switched on");
                cx.report
                    .error(code, span.clone(), message)
                    .why(format!("`autolimits` of compiler is false, so a {range} alone has no effect"))
                    .help(format!(
                        "write `{attribute}=\"true\"`, or `{attribute}=\"false\"`, or remove `autolimits`"
                    ));
            }
            false
        }
    };
    if limited && lower >= upper {
        let message = format!("the {range} of {owner} is {lower} to {upper}");
        let error =
            cx.report.error(code, span, message).why("the lower limit must be smaller than the upper");
        if given {
            error.help(format!("write `{range}=\"{upper} {lower}\"`, or remove `{attribute}` and `{range}`"));
        } else {
            error.help(format!("write `{range}=\"LOWER UPPER\"`, or remove `{attribute}`"));
        }
    }
    limited
}

/// The limits of a joint's coordinate.
pub(crate) const JOINT: Limit = Limit { range: "range", flag: "limited", code: rules::JOINT };
/// The limits of the force of actuators on a joint.
pub(crate) const JOINT_FORCE: Limit =
    Limit { range: "actuatorfrcrange", flag: "actuatorfrclimited", code: rules::JOINT };
/// The limits of a tendon's length.
pub(crate) const TENDON: Limit = Limit { code: rules::TENDON, ..JOINT };
/// The limits of the force of actuators on a tendon.
pub(crate) const TENDON_FORCE: Limit = Limit { code: rules::TENDON, ..JOINT_FORCE };
/// The limits of controls, forces and activations of actuators.
pub(crate) const CONTROL: Limit = Limit { range: "ctrlrange", flag: "ctrllimited", code: rules::ACTUATOR };
pub(crate) const FORCE: Limit = Limit { range: "forcerange", flag: "forcelimited", code: rules::ACTUATOR };
pub(crate) const ACTIVATION: Limit = Limit { range: "actrange", flag: "actlimited", code: rules::ACTUATOR };
