//! Shortcuts: the parameters that each element of `actuator` writes to the general actuator.
//!
//! They are documented in MuJoCo's XML reference, "actuator". An element starts with the values of its class, so that a parameter
//! without an attribute keeps the value that a servo, a muscle or a motor of the class has set.

use super::overlay::ActuatorOverlay;
use super::shortcut_motor;
use crate::kinds::{biastype, choice, dyntype, gaintype};
use crate::mjcf::spec::ActuatorSpec;
use crate::mjcf::text::diagnostic::shorten_name;
use std::f64::consts::PI;

/// A function that writes the attributes of an element to an actuator.
type Set = fn(&mut ActuatorSpec, &mut ActuatorOverlay);

/// All elements, by name.
const SHORTCUTS: [(&str, Set); 12] = [
    ("general", |a, e| input(&mut a.ctrlspec, ValidInputs::Any, e)),
    ("motor", |a, _| {
        (a.gaintype, a.biastype, a.dyntype) = (gaintype::FIXED, biastype::NONE, dyntype::NONE);
        a.gainprm[0] = 1.0;
    }),
    ("position", |a, e| {
        servo(a, e);
        if let Some(time) = e.zero_or_more("timeconst") {
            a.dynprm[0] = time;
            a.dyntype = if time == 0.0 { dyntype::NONE } else { dyntype::FILTEREXACT };
        }
        inherit(a.inheritrange, a.ctrl.range, "ctrlrange", e);
    }),
    ("intvelocity", |a, e| {
        servo(a, e);
        a.dyntype = dyntype::INTEGRATOR;
        inherit(a.inheritrange, a.act.range, "actrange", e);
    }),
    ("velocity", |a, e| {
        (a.gaintype, a.biastype, a.dyntype) = (gaintype::FIXED, biastype::AFFINE, dyntype::NONE);
        let kv = e.p.real("kv").unwrap_or(a.gainprm[0]);
        a.gainprm[0] = kv;
        a.biasprm = [0.0; 10];
        a.biasprm[2] = -kv;
    }),
    ("damper", |a, e| {
        let inherited = if a.gaintype == gaintype::AFFINE { -a.gainprm[2] } else { 0.0 };
        let kv = e.zero_or_more("kv").unwrap_or(inherited);
        (a.gaintype, a.biastype, a.dyntype) = (gaintype::AFFINE, biastype::NONE, dyntype::NONE);
        a.gainprm = [0.0; 10];
        a.gainprm[2] = -kv;
        clamp_controls(a, e, "a damper with a negative control would push instead of resisting");
    }),
    ("cylinder", |a, e| {
        (a.gaintype, a.biastype, a.dyntype) = (gaintype::FIXED, biastype::AFFINE, dyntype::FILTER);
        a.dynprm[0] = e.p.real("timeconst").unwrap_or(a.dynprm[0]);
        let bias = e.p.reals("bias", [a.biasprm[0], a.biasprm[1], a.biasprm[2]]);
        a.biasprm[..3].copy_from_slice(&bias);
        a.gainprm[0] = e.p.real("area").unwrap_or(a.gainprm[0]);
        if let Some(diameter) = e.zero_or_more("diameter") {
            a.gainprm[0] = PI / 4.0 * diameter * diameter;
        }
    }),
    ("muscle", muscle),
    ("adhesion", |a, e| {
        (a.gaintype, a.biastype) = (gaintype::FIXED, biastype::NONE);
        a.gainprm[0] = e.zero_or_more("gain").unwrap_or(a.gainprm[0]);
        clamp_controls(a, e, "adhesion pulls surfaces together and never pushes them apart");
    }),
    ("orientation", |a, e| {
        input(&mut a.ctrlspec, ValidInputs::Chart, e);
        servo(a, e);
        (a.gaintype, a.biastype, a.dyntype) = (gaintype::SO3, biastype::SO3, dyntype::NONE);
    }),
    ("pid", pid),
    ("dcmotor", |a, e| {
        input(&mut a.ctrlspec, ValidInputs::Servo, e);
        shortcut_motor::dcmotor(a, e);
    }),
];

/// The function for an element of this name, or `None` if it is not an actuator.
pub(crate) fn find(name: &str) -> Option<Set> {
    SHORTCUTS.iter().find(|(n, _)| *n == name).map(|(_, set)| *set)
}

/// Gain, bias and damping of servos: kp (u - length) - kv velocity.
fn servo(a: &mut ActuatorSpec, e: &mut ActuatorOverlay) {
    (a.gaintype, a.biastype) = (gaintype::FIXED, biastype::AFFINE);
    let kp = e.p.real("kp").unwrap_or(a.gainprm[0]);
    a.gainprm[0] = kp;
    a.biasprm[1] = -kp;
    damping(a, e);
    a.inheritrange = e.p.real("inheritrange").unwrap_or(a.inheritrange);
}

/// Reads `kv` or `dampratio`. A damping ratio is stored as a positive number in the place of -kv, until `mj_setConst` computes kv
/// from the inertia.
fn damping(a: &mut ActuatorSpec, e: &mut ActuatorOverlay) {
    let (kv, ratio) = (e.zero_or_more("kv"), e.zero_or_more("dampratio"));
    if kv.is_some() && ratio.is_some() {
        let owner = e.node.describe();
        e.error("dampratio", format!("{owner} has both `kv` and `dampratio`"))
            .why("`dampratio` is another way to give `kv`: 1 is critical damping")
            .help("remove one of them");
    }
    a.biasprm[2] = match (kv, ratio) {
        (_, Some(ratio)) => ratio,
        (Some(kv), None) => -kv,
        (None, None) => a.biasprm[2],
    };
    if a.biasprm[2] > 0.0 && a.biasprm[1] > 0.0 && ratio.is_some() {
        let owner = e.node.describe();
        e.error("dampratio", format!("{owner} has `dampratio` and a negative `kp`"))
            .why("critical damping belongs to a spring with stiffness `kp`, which cannot be negative")
            .help("write a positive `kp`, or `kv`");
    }
}

/// Reports a range that is both given and inherited from the target.
fn inherit(inheritrange: f64, range: [f64; 2], attribute: &str, e: &mut ActuatorOverlay) {
    if inheritrange > 0.0 && range != [0.0; 2] {
        let owner = e.node.describe();
        e.error("inheritrange", format!("{owner} has both `{attribute}` and `inheritrange`"))
            .why(format!("`inheritrange` is another way to give `{attribute}`: the range of the target"))
            .help("remove one of them");
    }
}

/// Sets controls that are always clamped to their range, and reports a range with negative numbers.
fn clamp_controls(a: &mut ActuatorSpec, e: &mut ActuatorOverlay, why: &str) {
    a.ctrl.flag = choice::TRUE;
    if a.ctrl.range.iter().any(|&x| x < 0.0) {
        let owner = e.node.describe();
        let [lower, upper] = a.ctrl.range;
        e.error(
            "ctrlrange",
            format!("the ctrlrange of {owner} is {lower} to {upper}, but it must not be negative"),
        )
        .why(why)
        .help("write for example `ctrlrange=\"0 1\"`");
    }
}

/// kp (position - length) + ki ∫ + kv (velocity - actual velocity) + feedforward.
fn pid(a: &mut ActuatorSpec, e: &mut ActuatorOverlay) {
    input(&mut a.ctrlspec, ValidInputs::Servo, e);
    let stateful = a.dyntype == dyntype::PID;
    let if_stateful = |x: f64| if stateful { x } else { 0.0 };
    let [ki, imax, slewmax] = [if_stateful(a.gainprm[0]), if_stateful(a.dynprm[0]), if_stateful(a.dynprm[1])];
    let ki = e.zero_or_more("ki").unwrap_or(ki);
    let imax = e.zero_or_more("imax").unwrap_or(imax);
    let slewmax = e.zero_or_more("slewmax").unwrap_or(slewmax);
    (a.gaintype, a.biastype) = (gaintype::PID, biastype::AFFINE);
    a.biasprm[1] = e.p.real("kp").map_or(a.biasprm[1], |kp| -kp);
    damping(a, e);
    a.gainprm[0] = ki;
    if ki > 0.0 {
        a.dynprm[0] = imax;
    }
    a.dynprm[1] = slewmax;
    a.dyntype = if ki > 0.0 || slewmax > 0.0 { dyntype::PID } else { dyntype::NONE };
    a.actdim = -1;
    a.ctrl.range = e.p.reals("posrange", a.ctrl.range);
    a.inheritrange = e.p.real("inheritrange").unwrap_or(a.inheritrange);
    inherit(a.inheritrange, a.ctrl.range, "ctrlrange", e);
}

/// The parameters of muscles and their defaults, in the order of `gainprm`.
const MUSCLE: [(&str, f64); 7] = [
    ("force", -1.0),
    ("scale", 200.0),
    ("lmin", 0.5),
    ("lmax", 1.6),
    ("vmax", 1.5),
    ("fpmax", 1.3),
    ("fvmax", 1.2),
];

/// Reads the parameters of muscles. They are positive: a negative number counts as not given.
fn muscle(a: &mut ActuatorSpec, e: &mut ActuatorOverlay) {
    // The values of an actuator without muscle parameters count as not given.
    let or = |x: f64, nothing: f64, default: f64| if x == nothing { default } else { x };
    a.dynprm[0] = or(a.dynprm[0], 1.0, 0.01);
    a.dynprm[1] = or(a.dynprm[1], 0.0, 0.04);
    a.gainprm[0] = or(a.gainprm[0], 1.0, 0.75);
    a.gainprm[1] = or(a.gainprm[1], 0.0, 1.05);
    let given =
        |e: &ActuatorOverlay, name: &str, i: usize| e.p.list(name)?.get(i).copied().filter(|&x| x >= 0.0);
    for i in 0..2 {
        a.dynprm[i] = given(e, "timeconst", i).unwrap_or(a.dynprm[i]);
        a.gainprm[i] = given(e, "range", i).unwrap_or(a.gainprm[i]);
    }
    a.dynprm[2] = e.zero_or_more("tausmooth").unwrap_or(a.dynprm[2]);
    for (x, (name, default)) in a.gainprm.iter_mut().skip(2).zip(MUSCLE) {
        *x = given(e, name, 0).unwrap_or(or(*x, 0.0, default));
    }
    a.biasprm[..9].copy_from_slice(&a.gainprm[..9]);
    (a.gaintype, a.biastype, a.dyntype) = (gaintype::MUSCLE, biastype::MUSCLE, dyntype::MUSCLE);
}

/// The valid values of an `input` attribute.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ValidInputs {
    /// A parametrization of an orientation.
    Chart,
    /// A list of inputs of a controller.
    Servo,
    Any,
}

/// The values of `actuator_ctrlspec`: orientation parametrizations, and bits for a list of inputs.
pub(crate) mod inputs {
    pub(in crate::mjcf) const EXPMAP: i32 = 1;
    pub(in crate::mjcf) const QUAT: i32 = 2;
    pub(in crate::mjcf) const POS: i32 = 1;
    pub(in crate::mjcf) const VEL: i32 = 2;
    pub(in crate::mjcf) const FF: i32 = 4;
    pub(in crate::mjcf) const VOLTAGE: i32 = 8;
    pub(in crate::mjcf) const NONE: i32 = 16;
}
const CHARTS: [(&str, i32); 2] = [("expmap", inputs::EXPMAP), ("quat", inputs::QUAT)];
const LIST: [(&str, i32); 4] =
    [("pos", inputs::POS), ("vel", inputs::VEL), ("ff", inputs::FF), ("voltage", inputs::VOLTAGE)];

/// Reads the `input` attribute: an orientation parametrization, `none`, or a list in the order of [`LIST`].
fn input(spec: &mut i32, allowed: ValidInputs, e: &mut ActuatorOverlay) {
    let Some(text) = e.p.text("input").map(str::to_string) else { return };
    let chart = CHARTS.iter().find(|(name, _)| *name == text).map(|(_, n)| *n);
    let list = || {
        if text == "none" {
            return Some(inputs::NONE);
        }
        text.split_ascii_whitespace().try_fold(0, |bits, word| {
            let (_, bit) = LIST.iter().find(|(name, _)| *name == word)?;
            // Each input at most once, in order.
            (*bit > bits).then_some(bits | bit)
        })
    };
    let read = match allowed {
        ValidInputs::Chart => chart,
        ValidInputs::Servo => list(),
        ValidInputs::Any => chart.or_else(list),
    };
    match read {
        Some(n) => *spec = n,
        None => {
            let owner = e.node.describe();
            let help = match allowed {
                ValidInputs::Chart => "write `expmap` (a rotation vector) or `quat`",
                _ => "write some of `pos vel ff voltage`, in this order, or `none`",
            };
            e.error("input", format!("`input` of {owner} is {}", shorten_name(&text))).help(help);
        }
    }
}
