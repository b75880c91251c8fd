//! `compiler`, `option`, `size`, `statistic`.

use super::Element;
use super::FLAG;
use super::INT;
use super::INTS;
use super::Kind;
use super::MOOT;
use super::REAL;
use super::Status::Ignored;
use super::Status::Only;
use super::TEXT;
use super::attributes;
use super::not_yet;
use super::reals;
use super::upto;
use super::word;
use crate::kinds::{angle, choice, cone, integrator, jacobian, solver};

pub(super) static COMPILER: Element = Element::new(
    "compiler",
    &[attributes! {
        FLAG => autolimits balanceinertia;
        REAL => boundmass boundinertia;
        Kind::Words(&[word("radian", angle::RADIAN), word("degree", angle::DEGREE)]) => angle;
        TEXT => eulerseq;
        Kind::Words(&[word("false", choice::FALSE), word("true", choice::TRUE), word("auto", choice::AUTO)]) => inertiafromgeom;
        Kind::Ints(2, 2) => inertiagrouprange;
        Kind::Words(&[word("local", 0), not_yet("global", 1)]) => coordinate [Only("local")];
        REAL => settotalmass;
        FLAG => alignfree discardvisual fusestatic fitaabb;
        TEXT => assetdir meshdir;
        TEXT => texturedir [super::LOOK];
        FLAG => strippath;
        Kind::Words(&[word("warning", 0), word("merge", 1), word("error", 2)]) => conflict [MOOT];
        FLAG => saveinertial usethread [Ignored("for MuJoCo's own compiler and writer")];
    }],
)
.children(&[&LENGTHRANGE]);

static LENGTHRANGE: Element = Element::new(
    "lengthrange",
    &[attributes! {
        Kind::Words(&[word("none", 0), word("muscle", 1), word("muscleuser", 2), word("all", 3)]) => mode;
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
        Kind::Words(&[
            word("Euler", integrator::EULER), word("RK4", integrator::RK4), word("implicit", integrator::IMPLICIT),
            word("implicitfast", integrator::IMPLICITFAST), word("discrete", integrator::DISCRETE),
        ]) => integrator;
        Kind::Words(&[word("pyramidal", cone::PYRAMIDAL), word("elliptic", cone::ELLIPTIC)]) => cone;
        Kind::Words(&[word("PGS", solver::PGS), word("CG", solver::CG), word("Newton", solver::NEWTON)]) => solver;
        INT => iterations ls_iterations;
        Kind::Words(&[word("dense", jacobian::DENSE), word("sparse", jacobian::SPARSE), word("auto", jacobian::AUTO)]) => jacobian;
        INT => noslip_iterations ccd_iterations;
        REAL => noslip_tolerance ccd_tolerance sleep_tolerance;
        INT => sdf_iterations sdf_initpoints;
        INTS => actuatorgroupdisable;
    }],
)
.children(&[&FLAGS]);

const SWITCH: Kind = Kind::Words(&[word("disable", 0), word("enable", 1)]);

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
