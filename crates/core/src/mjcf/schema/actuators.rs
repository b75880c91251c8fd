//! `actuator`, and the entries of its elements in `default`.

use super::AUTO;
use super::Attr;
use super::AttributeType;
use super::Element;
use super::FLAG;
use super::INT;
use super::LIST;
use super::REAL;
use super::TEXT;
use super::attributes;
use super::extension;
use super::keyword;
use super::reals;
use super::unsupported_keyword;
use super::upto;
use crate::kinds::{biastype, dyntype, gaintype, interpolation};

const COMMON: &[Attr] = attributes! {
    INT => group nsample;
    AttributeType::Keywords(&[keyword("zoh", interpolation::HOLD), keyword("linear", interpolation::LINEAR), keyword("cubic", interpolation::CUBIC)]) => interp;
    REAL => delay;
    LIST => user;
};
const FORCE: &[Attr] = attributes! { AUTO => forcelimited; reals(2) => forcerange; };
const CONTROL: &[Attr] = attributes! { AUTO => ctrllimited; reals(2) => ctrlrange; };
const RANGE: &[Attr] = attributes! { reals(2) => ctrlrange; };
const ACTIVATION: &[Attr] = attributes! { AUTO => actlimited; reals(2) => actrange; };
const JOINTLIKE: &[Attr] = attributes! {
    upto(6) => gear;
    REAL => cranklength armature;
    upto(3) => damping;
};
/// Types that user callbacks would compute are refused: a model alone does not define their behaviour.
const DYNAMICS_TYPES: &[super::Keyword] = &[
    keyword("none", dyntype::NONE),
    keyword("integrator", dyntype::INTEGRATOR),
    keyword("filter", dyntype::FILTER),
    keyword("filterexact", dyntype::FILTEREXACT),
    keyword("muscle", dyntype::MUSCLE),
    keyword("dcmotor", dyntype::DCMOTOR),
    keyword("pid", dyntype::PID),
    unsupported_keyword("user", 7),
];
const GAIN_TYPES: &[super::Keyword] = &[
    keyword("fixed", gaintype::FIXED),
    keyword("affine", gaintype::AFFINE),
    keyword("muscle", gaintype::MUSCLE),
    keyword("dcmotor", gaintype::DCMOTOR),
    keyword("so3", gaintype::SO3),
    keyword("pid", gaintype::PID),
    unsupported_keyword("user", 6),
];
const BIAS_TYPES: &[super::Keyword] = &[
    keyword("none", biastype::NONE),
    keyword("affine", biastype::AFFINE),
    keyword("muscle", biastype::MUSCLE),
    keyword("dcmotor", biastype::DCMOTOR),
    keyword("so3", biastype::SO3),
    unsupported_keyword("user", 5),
];
const GENERAL: &[Attr] = attributes! {
    INT => actdim;
    FLAG => actearly;
    AttributeType::Keywords(DYNAMICS_TYPES) => dyntype;
    upto(10) => dynprm;
};
const GAIN: &[Attr] = attributes! { AttributeType::Keywords(GAIN_TYPES) => gaintype; AttributeType::Keywords(BIAS_TYPES) => biastype; TEXT => input; upto(10) => gainprm biasprm; reals(2) => ffrange velrange; };
const SERVO: &[Attr] = attributes! { REAL => kp kv dampratio; };
const INHERIT: &[Attr] = attributes! { REAL => inheritrange; };
const INPUT: &[Attr] = attributes! { TEXT => input; };
const PID: &[Attr] = attributes! { REAL => ki imax slewmax; reals(2) => ffrange posrange velrange; };
const KV: &[Attr] = attributes! { REAL => kv; };
const CYLINDER: &[Attr] = attributes! { REAL => timeconst area diameter; reals(3) => bias; };
const MUSCLE: &[Attr] = attributes! {
    reals(2) => timeconst;
    reals(2) => range;
    REAL => force scale lmin lmax vmax fpmax fvmax;
};
const GRIP: &[Attr] = attributes! { REAL => gain; };
const MOTOR_DC: &[Attr] = attributes! {
    REAL => resistance;
    upto(2) => motorconst inductance;
    upto(3) => nominal saturation cogging;
    upto(5) => lugre;
    upto(6) => controller thermal;
    TEXT => input;
};
const TIMECONST: &[Attr] = attributes! { REAL => timeconst; };

/// Attributes of an actuator that its entry in `default` does not have: its name and its targets.
const NAMED: &[Attr] =
    attributes! { AttributeType::Name("actuator") => name; AttributeType::Class => class; };
const TRANSMISSION: &[Attr] = attributes! {
    AttributeType::Ref("joint") => joint jointinparent;
    AttributeType::Ref("tendon") => tendon;
    AttributeType::Ref("site") => slidersite cranksite;
    reals(2) => lengthrange;
};
const SITE: &[Attr] = attributes! { AttributeType::Ref("site") => site; };
const REFSITE: &[Attr] = attributes! { AttributeType::Ref("site") => refsite; };
const BODY: &[Attr] = attributes! { AttributeType::Ref("body") => body; };
const JOINT: &[Attr] = attributes! { AttributeType::Ref("joint") => joint; };

macro_rules! actuators {
    ($($id:ident $name:literal [$($group:ident),*] [$($place:expr),*];)*) => {
        /// The elements of `actuator`.
        mod place {
            use super::*;
            $(pub(super) static $id: Element = Element::new($name, &[NAMED, COMMON, $($group,)* $($place),*]);)*
        }
        /// The entries in `default`.
        mod defaults {
            use super::*;
            $(pub(super) static $id: Element = Element::new($name, &[COMMON, $($group),*]).once();)*
        }
        pub(super) static ACTUATOR: Element =
            Element::new("actuator", &[]).children(&[$(&place::$id,)* &PLUGIN]);
        pub(super) const DEFAULTS: [&Element; 12] = [$(&defaults::$id),*];
    };
}

const TAUSMOOTH: &[Attr] = attributes! { REAL => tausmooth; };

actuators! {
    A_GENERAL "general" [FORCE, CONTROL, ACTIVATION, JOINTLIKE, GENERAL, GAIN] [TRANSMISSION, SITE, REFSITE, BODY];
    A_MOTOR "motor" [FORCE, CONTROL, JOINTLIKE] [TRANSMISSION, SITE, REFSITE];
    A_POSITION "position" [FORCE, CONTROL, JOINTLIKE, SERVO, INHERIT, TIMECONST] [TRANSMISSION, SITE, REFSITE];
    A_VELOCITY "velocity" [FORCE, CONTROL, JOINTLIKE, KV] [TRANSMISSION, SITE, REFSITE];
    A_INTVELOCITY "intvelocity" [FORCE, CONTROL, ACTIVATION, JOINTLIKE, SERVO, INHERIT] [TRANSMISSION, SITE, REFSITE];
    A_ORIENTATION "orientation" [FORCE, RANGE, SERVO, INPUT] [JOINT, SITE, REFSITE];
    A_PID "pid" [FORCE, CONTROL, JOINTLIKE, SERVO, INHERIT, INPUT, PID] [TRANSMISSION, SITE, REFSITE];
    A_DAMPER "damper" [FORCE, RANGE, JOINTLIKE, KV] [TRANSMISSION, SITE, REFSITE];
    A_CYLINDER "cylinder" [FORCE, CONTROL, JOINTLIKE, CYLINDER] [TRANSMISSION, SITE, REFSITE];
    A_MUSCLE "muscle" [FORCE, CONTROL, JOINTLIKE, MUSCLE] [TRANSMISSION, TAUSMOOTH];
    A_ADHESION "adhesion" [FORCE, RANGE, GRIP] [BODY];
    A_DCMOTOR "dcmotor" [CONTROL, JOINTLIKE, MOTOR_DC] [TRANSMISSION, SITE, REFSITE];
}

static PLUGIN: Element = Element::new(
    "plugin",
    &[
        NAMED,
        COMMON,
        FORCE,
        CONTROL,
        ACTIVATION,
        JOINTLIKE,
        GENERAL,
        TRANSMISSION,
        SITE,
        attributes! {
            TEXT => plugin instance;
        },
    ],
)
.children(&[&extension::CONFIG])
.refused();
