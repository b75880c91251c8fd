//! Ranges with a flag: `range` and `limited`, and their like for forces.

use super::defaults::Props;
use super::diagnostic::code;
use super::read_body::Context;
use super::tree::Node;

/// Names of a range's attributes.
pub(crate) struct Limit {
    pub(crate) range: &'static str,
    pub(crate) flag: &'static str,
    /// The code of what is wrong with it.
    pub(crate) code: &'static str,
}

/// Whether a range holds, and the range. The flag decides; where it is `auto`, a range that is given holds.
pub(crate) fn read(cx: &mut Context, p: &Props, node: &Node, limit: &Limit) -> (bool, [f64; 2]) {
    let Limit { range, flag, code } = *limit;
    let [lower, upper] = p.reals(range, [0.0; 2]);
    let span = p.span(range).unwrap_or(node.span.clone());
    let given = p.has(range) && (lower, upper) != (0.0, 0.0);
    let limited = match p.word(flag) {
        Some(0) => false,
        Some(1) => true,
        _ if cx.compiler.autolimits => given,
        _ => {
            if given {
                let message = format!("{} has a {range}, but nothing says that it holds", node.shown());
                cx.report
                    .error(code, span.clone(), message)
                    .why(format!("`autolimits` of compiler is false, so a {range} alone has no effect"))
                    .help(format!("write `{flag}=\"true\"`, or `{flag}=\"false\"`, or remove `autolimits`"));
            }
            false
        }
    };
    if limited && lower >= upper {
        let message = format!("the {range} of {} is {lower} to {upper}", node.shown());
        let error =
            cx.report.error(code, span, message).why("the lower limit must be smaller than the upper");
        if p.has(range) {
            error.help(format!("write `{range}=\"{upper} {lower}\"`, or remove `{flag}` and `{range}`"));
        } else {
            error.help(format!("write `{range}=\"LOWER UPPER\"`, or remove `{flag}`"));
        }
    }
    (limited, [lower, upper])
}

/// The limits of a joint's coordinate.
pub(crate) const JOINT: Limit = Limit { range: "range", flag: "limited", code: code::JOINT };
/// The limits of the force of actuators on a joint.
pub(crate) const JOINT_FORCE: Limit =
    Limit { range: "actuatorfrcrange", flag: "actuatorfrclimited", code: code::JOINT };
/// The limits of a tendon's length.
pub(crate) const TENDON: Limit = Limit { code: code::TENDON, ..JOINT };
/// The limits of the force of actuators on a tendon.
pub(crate) const TENDON_FORCE: Limit = Limit { code: code::TENDON, ..JOINT_FORCE };
