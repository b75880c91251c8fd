//! `compiler`, `option`, `size`, `statistic`.

use super::AttributeType;
use super::Element;
use super::FLAG;
use super::INT;
use super::INTS;
use super::MOOT;
use super::REAL;
use super::Status::Ignored;
use super::Status::Only;
use super::TEXT;
use super::attributes;
use super::keyword;
use super::reals;
use super::unsupported_keyword;
use super::upto;
use crate::kinds::{angle, choice, cone, integrator, jacobian, solver};

pub(super) static COMPILER: Element = Element::new(
    "compiler",
    &[attributes! {
        FLAG => autolimits balanceinertia;
        REAL => boundmass boundinertia;
        AttributeType::Keywords(&[keyword("radian", angle::RADIAN), keyword("degree", angle::DEGREE)]) => angle;
        TEXT => eulerseq;
        AttributeType::Keywords(&[keyword("false", choice::FALSE), keyword("true", choice::TRUE), keyword("auto", choice::AUTO)]) => inertiafromgeom;
        AttributeType::Ints(2, 2) => inertiagrouprange;
        AttributeType::Keywords(&[keyword("local", 0), unsupported_keyword("global", 1)]) => coordinate [Only("local")];
        REAL => settotalmass;
        FLAG => alignfree discardvisual fusestatic fitaabb;
        TEXT => assetdir meshdir;
        TEXT => texturedir [super::APPEARANCE];
        FLAG => strippath;
        AttributeType::Keywords(&[keyword("warning", 0), keyword("merge", 1), keyword("error", 2)]) => conflict [MOOT];
        FLAG => saveinertial usethread [Ignored("for MuJoCo's own compiler and writer")];
    }],
)
.children(&[&LENGTHRANGE]);

static LENGTHRANGE: Element = Element::new(
    "lengthrange",
    &[attributes! {
        AttributeType::Keywords(&[keyword("none", 0), keyword("muscle", 1), keyword("muscleuser", 2), keyword("all", 3)]) => mode;
        FLAG => useexisting uselimit;
        REAL => accel maxforce timeconst timestep inttotal interval tolrange;
    }],
)
.once();

pub(super) static OPTION: Element = Element::new(
    "option",
    &[attributes! {
        REAL => timestep impratio tolerance ls_tolerance density viscosity o_margin;
        reals(3) => gravity wind magnetic;
        upto(2) => o_solref;
        upto(5) => o_solimp o_friction;
        AttributeType::Keywords(&[
            keyword("Euler", integrator::EULER), keyword("RK4", integrator::RK4), keyword("implicit", integrator::IMPLICIT),
            keyword("implicitfast", integrator::IMPLICITFAST), keyword("discrete", integrator::DISCRETE),
        ]) => integrator;
        AttributeType::Keywords(&[keyword("pyramidal", cone::PYRAMIDAL), keyword("elliptic", cone::ELLIPTIC)]) => cone;
        AttributeType::Keywords(&[keyword("PGS", solver::PGS), keyword("CG", solver::CG), keyword("Newton", solver::NEWTON)]) => solver;
        INT => iterations ls_iterations;
        AttributeType::Keywords(&[keyword("dense", jacobian::DENSE), keyword("sparse", jacobian::SPARSE), keyword("auto", jacobian::AUTO)]) => jacobian;
        INT => noslip_iterations ccd_iterations;
        REAL => noslip_tolerance ccd_tolerance sleep_tolerance;
        INT => sdf_iterations sdf_initpoints;
        INTS => actuatorgroupdisable;
    }],
)
.children(&[&FLAGS]);

const SWITCH: AttributeType = AttributeType::Keywords(&[keyword("disable", 0), keyword("enable", 1)]);

static FLAGS: Element = Element::new(
    "flag",
    &[attributes! {
        SWITCH => constraint equality frictionloss limit contact spring damper gravity clampctrl warmstart
            filterparent actuation refsafe sensor midphase eulerdamp autoreset island multiccd;
        SWITCH => nativeccd [Ignored("this engine has its own search for convex shapes; the older one of the library is not reproduced")];
        SWITCH => override energy fwdinv invdiscrete sleep diagexact;
        SWITCH => ipc [MOOT];
    }],
)
.once();

const MEMORY: super::Status = Ignored("memory grows as needed");

pub(super) static SIZE: Element = Element::new(
    "size",
    &[attributes! {
        INT => nkey;
        TEXT => memory [MEMORY];
        INT => njmax nconmax nstack [MEMORY];
        INT => nuser_body nuser_jnt nuser_tendon nuser_actuator;
        INT => nuserdata nuser_geom nuser_site nuser_cam nuser_sensor;
    }],
);

pub(super) static STATISTIC: Element = Element::new(
    "statistic",
    &[attributes! {
        REAL => meaninertia meanmass meansize extent;
        reals(3) => center;
    }],
);
