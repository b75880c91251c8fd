//! Checks of whole actuators: parts that must be consistent, ranges that are computed from others, numbers of activations.

use super::shortcut::inputs;
use crate::forces::actuation::slots;
use crate::kinds::{biastype, choice, dyntype, gaintype, joint, trntype};
use crate::mjcf::body::limits;
use crate::mjcf::context::Context;
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::spec::{ActuatorSpec, BodySpec, JointSpec, RangeSpec, TendonSpec};
use crate::mjcf::text::diagnostic::ReportedFinding;
use crate::mjcf::text::tree::ElementNode;

/// Completes an actuator and reports inconsistent parts.
pub(crate) fn finish(
    a: &mut ActuatorSpec,
    cx: &mut Context,
    node: &ElementNode,
    bodies: &[BodySpec],
    tendons: &[TendonSpec],
) {
    let mut check = ActuatorCheck { cx, node };
    if a.inheritrange > 0.0 {
        check.inherit(a, bodies, tendons);
    }
    for (limit, kind) in
        [(&mut a.ctrl, &limits::CONTROL), (&mut a.force, &limits::FORCE), (&mut a.act, &limits::ACTIVATION)]
    {
        check.limit(limit, kind);
    }
    check.family(a);
    check.numbers(a);
    check.activations(a);
    if a.ctrlspec == 0 {
        a.ctrlspec = match a.gaintype {
            gaintype::SO3 => inputs::EXPMAP,
            gaintype::PID => inputs::POS | inputs::VEL,
            gaintype::DCMOTOR => inputs::VOLTAGE,
            _ => 0,
        };
    }
}

/// The range of each control.
pub(crate) fn controls(a: &ActuatorSpec) -> Vec<RangeSpec> {
    let alike = |n: usize| vec![a.ctrl.clone(); n];
    let with_flag = |range: [f64; 2]| RangeSpec { flag: i32::from(range[0] < range[1]), range };
    match a.gaintype {
        gaintype::SO3 => alike(if a.ctrlspec == inputs::QUAT { 4 } else { 3 }),
        gaintype::PID => listed(
            [inputs::POS, inputs::VEL, inputs::FF].into_iter().filter(|bit| a.ctrlspec & bit != 0).map(
                |bit| match bit {
                    inputs::POS => a.ctrl.clone(),
                    inputs::VEL => with_flag(a.velrange),
                    _ => with_flag(a.ffrange),
                },
            ),
        ),
        gaintype::DCMOTOR => alike((a.ctrlspec & (inputs::NONE - 1)).count_ones() as usize),
        _ => alike(1),
    }
}

/// The number of force outputs.
pub(crate) fn outputs(a: &ActuatorSpec) -> usize {
    if a.transmission.is_some_and(|t| t.kind == trntype::SO3) { 3 } else { 1 }
}

struct ActuatorCheck<'c, 'a> {
    cx: &'c mut Context<'a>,
    node: &'c ElementNode,
}

impl ActuatorCheck<'_, '_> {
    /// Reports an error at one of these attributes, or at the element if its class has the attribute.
    fn error(&mut self, attribute: &str, message: &str) -> ReportedFinding<'_> {
        let span = self.node.attribute(attribute).map_or(self.node.span.clone(), |a| a.span.clone());
        let message = format!("{} {message}", self.node.describe());
        self.cx.report.error(rules::ACTUATOR, span, message)
    }

    fn limit(&mut self, limit: &mut RangeSpec, kind: &limits::Limit) {
        let span = self.node.attribute(kind.range).map_or(self.node.span.clone(), |a| a.span.clone());
        let owner = self.node.describe();
        let given = limit.range != [0.0; 2];
        let limited = limits::decide(self.cx, limit.flag, given, limit.range, span, &owner, kind);
        limit.flag = i32::from(limited);
    }

    /// Sets the range of a position setpoint from the range of its target.
    fn inherit(&mut self, a: &mut ActuatorSpec, bodies: &[BodySpec], tendons: &[TendonSpec]) {
        let servo = match a.gaintype {
            gaintype::FIXED => a.biastype == biastype::AFFINE && a.gainprm[0] == -a.biasprm[1],
            gaintype::PID => a.ctrlspec == 0 || a.ctrlspec & inputs::POS != 0,
            _ => false,
        };
        let input_range = if a.dyntype == dyntype::INTEGRATOR { &a.act } else { &a.ctrl };
        // If a range is given as well, an error is reported where the range is read.
        let Some(target) = a.transmission.filter(|_| servo && input_range.range == [0.0; 2]) else { return };
        let index = usize::try_from(target.id[0]).unwrap_or(usize::MAX);
        let joints = || bodies.iter().flat_map(|b| &b.joints).nth(index);
        let scalar = |j: &JointSpec| matches!(j.kind, joint::SLIDE | joint::HINGE);
        let (limited, [lower, upper]) = match target.kind {
            trntype::JOINT | trntype::JOINTINPARENT => match joints() {
                Some(j) if scalar(j) => (j.limited, j.range),
                _ => {
                    self.error("inheritrange", "has `inheritrange` and acts on a free or ball joint")
                        .why("their coordinates do not have a lower and an upper limit");
                    return;
                }
            },
            trntype::TENDON => tendons.get(index).map_or((false, [0.0; 2]), |t| (t.limited, t.range)),
            _ => {
                self.error("inheritrange", "has `inheritrange` and acts on neither a joint nor a tendon")
                    .why("there is no range to inherit");
                return;
            }
        };
        if !limited && lower == upper {
            self.error("inheritrange", "has `inheritrange`, but its target has no `range`")
                .help("give the joint or tendon a `range`, or write `ctrlrange`");
            return;
        }
        let (mean, radius) = (0.5 * (lower + upper), 0.5 * (upper - lower) * a.inheritrange);
        let range = [mean - radius, mean + radius];
        let to = if a.dyntype == dyntype::INTEGRATOR { &mut a.act } else { &mut a.ctrl };
        to.range = range;
    }

    /// Checks that gain, bias and dynamics are consistent.
    fn family(&mut self, a: &ActuatorSpec) {
        let so3 = [a.gaintype == gaintype::SO3, a.biastype == biastype::SO3];
        if so3[0] != so3[1] {
            self.error("gaintype", "has a `gaintype` or a `biastype` of so3, but not both")
                .why("an orientation servo needs both")
                .help("use `orientation`");
        } else if so3[0] {
            self.so3(a);
        }
        if a.gaintype == gaintype::PID {
            self.pid(a);
        } else if a.dyntype == dyntype::PID {
            self.error("dyntype", "has a `dyntype` of pid, but not the `gaintype`").help("use `pid`");
        }
        if [a.gaintype, a.biastype].contains(&gaintype::DCMOTOR) || a.dyntype == dyntype::DCMOTOR {
            self.dcmotor(a);
        }
        let takes = matches!(a.gaintype, gaintype::SO3 | gaintype::PID | gaintype::DCMOTOR);
        if a.ctrlspec != 0 && !takes {
            self.error("input", "has `input`, but takes a single control")
                .why("only `orientation`, `pid` and `dcmotor` let `input` choose their controls");
        }
        if a.gaintype == gaintype::MUSCLE {
            self.muscle(&a.gainprm);
        }
        if a.biastype == biastype::MUSCLE && (a.gaintype != gaintype::MUSCLE || a.biasprm != a.gainprm) {
            self.muscle(&a.biasprm);
        }
    }

    fn so3(&mut self, a: &ActuatorSpec) {
        if a.transmission.is_some_and(|t| t.kind != trntype::SO3) {
            self.error("joint", "sets an orientation, but acts on neither a ball joint nor a site");
        }
        if a.gainprm[0] != -a.biasprm[1] {
            self.error("biasprm", "has a bias that does not match its gain")
                .help("write `biasprm=\"0 -KP -KV\"` with the same KP as in `gainprm`");
        }
        if !matches!(a.dyntype, dyntype::NONE | dyntype::INTEGRATOR) {
            self.error("dyntype", "has a `dyntype` that is neither none nor integrator");
        }
        if a.ctrlspec == inputs::QUAT && a.dyntype != dyntype::NONE {
            self.error("input", "integrates quaternions")
                .why("an integrator adds rotation vectors")
                .help("write `input=\"expmap\"`");
        }
        if a.force.flag == choice::TRUE && a.force.range[0] != 0.0 {
            self.error("forcerange", "has a forcerange that does not begin at zero")
                .why("the range limits the magnitude of its torque");
        }
    }

    fn pid(&mut self, a: &ActuatorSpec) {
        if a.biastype != biastype::AFFINE {
            self.error("biastype", "has the `gaintype` pid, but not the `biastype` affine");
        }
        if !matches!(a.dyntype, dyntype::NONE | dyntype::PID) {
            self.error("dyntype", "has the `gaintype` pid, but a `dyntype` other than none and pid");
        }
        if a.dyntype != dyntype::PID && a.gainprm[0] != 0.0 {
            self.error("gainprm", "has an integral gain, but no state for the integral")
                .help("write `dyntype=\"pid\"`, or use `pid` with `ki`");
        }
        let supported = inputs::POS | inputs::VEL | inputs::FF;
        if a.ctrlspec & !supported != 0 {
            self.error("input", "has inputs other than pos, vel and ff");
        }
        if a.dyntype == dyntype::PID && a.ctrlspec != 0 && a.ctrlspec & inputs::POS == 0 {
            self.error("input", "has a state for its position setpoint, but takes no setpoint")
                .why("`ki` integrates the error of the position, and `slewmax` limits its setpoint")
                .help("add `pos` to `input`");
        }
    }

    fn dcmotor(&mut self, a: &ActuatorSpec) {
        let states = slots(&a.dynprm, &a.gainprm).count();
        if a.dyntype == dyntype::DCMOTOR {
            if !a.actearly {
                self.error("actearly", "has the `dyntype` dcmotor, but not `actearly`")
                    .why("the current of a motor acts in the step in which it flows");
            }
        } else if states > 0 {
            self.error("dyntype", "has parameters of motor states, but another `dyntype`")
                .help("write `dyntype=\"dcmotor\"`, or use `dcmotor`");
        }
        if a.gaintype != gaintype::DCMOTOR {
            return;
        }
        let has = |bits: i32| a.ctrlspec & bits != 0;
        let controller = has(inputs::POS | inputs::VEL | inputs::FF) && !has(inputs::NONE);
        if a.gainprm[4..7].iter().any(|&k| k != 0.0) && !controller {
            self.error("controller", "has controller gains, but takes no setpoint")
                .help("write `input` with some of `pos vel ff`");
        } else if a.gainprm[5] > 0.0 && !has(inputs::POS) {
            self.error("controller", "integrates a position error, but takes no position")
                .help("add `pos` to `input`, or write 0 as the second number of `controller`");
        }
        if a.dynprm[7] > 0.0 && !controller {
            self.error("controller", "limits the speed of its setpoint, but takes no setpoint")
                .help("write `input` with some of `pos vel ff`");
        }
    }

    /// Checks range₀ < range₁, lmin < 1 < lmax, and positive scale, vmax, fpmax, fvmax.
    fn muscle(&mut self, prm: &[f64; 10]) {
        let [lower, upper, _, scale, lmin, lmax, vmax, fpmax, fvmax, _] = *prm;
        if lower >= upper {
            self.error("range", "has a `range` that does not grow")
                .why("it gives the operating range, in optimal lengths: for example 0.75 to 1.05");
        }
        if lmin >= 1.0 || lmax <= 1.0 {
            self.error("lmin", "has no active force at its optimal length")
                .why("lengths are in optimal lengths: `lmin` must be smaller than 1, `lmax` larger");
        }
        if [scale, vmax, fpmax, fvmax].iter().any(|&x| x <= 0.0) {
            self.error("scale", "has a scale, vmax, fpmax or fvmax that is not larger than zero");
        }
    }

    /// Checks delay, armature and damping.
    fn numbers(&mut self, a: &ActuatorSpec) {
        if a.nsample < 0 {
            let message =
                format!("{} keeps a negative number of samples, so it keeps none", self.node.describe());
            let span = self.node.attribute("nsample").map_or(self.node.span.clone(), |a| a.span.clone());
            self.cx.report.warning(rules::NO_EFFECT, span, message).help("remove `nsample`");
        }
        if a.delay > 0.0 && a.nsample <= 0 {
            self.error("delay", "has a delay, but keeps no past controls")
                .why("a delayed control is read from the history of controls")
                .help(
                    "write `nsample`, the number of steps to remember: at least the delay over the timestep",
                );
        }
        if a.delay < 0.0 {
            self.error("delay", "has a negative delay").why("it would act before the control is given");
        }
        let reflected = a.armature != 0.0 || a.damping != [0.0; 3];
        let target = a.transmission.map(|t| t.kind);
        if reflected && matches!(target, Some(trntype::SITE | trntype::SLIDERCRANK | trntype::BODY)) {
            let attribute = if a.armature != 0.0 { "armature" } else { "damping" };
            self.error(attribute, &format!("has `{attribute}` and acts on neither a joint nor a tendon"))
                .why("an actuator's own inertia and damping are added to those of a joint or tendon");
        }
    }

    /// Sets the number of activations.
    fn activations(&mut self, a: &mut ActuatorSpec) {
        let states = slots(&a.dynprm, &a.gainprm).count() as i32;
        let pid = i32::from(a.gainprm[0] > 0.0) + i32::from(a.dynprm[1] > 0.0);
        let needed = match a.dyntype {
            dyntype::NONE => 0,
            dyntype::INTEGRATOR if a.gaintype == gaintype::SO3 => 3,
            dyntype::DCMOTOR => states,
            dyntype::PID => pid,
            _ => 1,
        };
        if a.actdim >= 0 && a.actdim != needed {
            let message = format!("has an `actdim` of {}, but its dynamics have {needed}", a.actdim);
            self.error("actdim", &message).help("remove `actdim`: `dyntype` determines the number");
        }
        if a.dyntype == dyntype::PID && pid != 1 {
            self.error("slewmax", "has states that are neither an integral nor a limited setpoint")
                .why("MuJoCo 3.14.0 gives a pid one state")
                .help("write either `ki` (the first of `gainprm`) or `slewmax` (the second of `dynprm`)");
        }
        if a.act.flag == choice::TRUE && needed == 0 && a.dyntype == dyntype::NONE {
            self.error("actrange", "has an actrange, but no activation")
                .why("only actuators with a `dyntype` have a state to limit")
                .help("remove `actrange`, or write `ctrlrange` or `dyntype`");
        }
        a.actdim = needed;
    }
}
