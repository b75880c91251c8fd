//! Deformable bodies, which are not supported yet.

use super::APPEARANCE;
use super::AUTO;
use super::Attr;
use super::AttributeType;
use super::Element;
use super::FLAG;
use super::INT;
use super::INTS;
use super::LIST;
use super::REAL;
use super::TEXT;
use super::attributes;
use super::extension;
use super::reals;
use super::upto;
use super::visual;

const RGBA: &[Attr] = attributes! { reals(4) => rgba; };
const CONTACT_ATTRS: &[Attr] = attributes! {
    INT => condim;
    REAL => adhesion margin gap;
    upto(2) => solref;
    upto(5) => solimp;
};
const FLEX_CONTACT: &[Attr] = attributes! {
    INT => contype conaffinity priority activelayers;
    upto(3) => friction;
    REAL => solmix;
    FLAG => internal passive;
    TEXT => selfcollide;
};
const NO_ADHESION: &[Attr] = attributes! {
    INT => condim;
    REAL => margin gap;
    upto(2) => solref;
    upto(5) => solimp;
};
static FLEXCONTACT: Element = Element::new("contact", &[NO_ADHESION, FLEX_CONTACT]).once();
static FLEXEDGE: Element = Element::new("edge", &[attributes! { REAL => stiffness damping; }]).once();
static COMPEDGE: Element = Element::new(
    "edge",
    &[attributes! {
        TEXT => equality;
        upto(2) => solref;
        upto(5) => solimp;
        REAL => stiffness damping;
    }],
)
.once();
static ELASTICITY: Element = Element::new(
    "elasticity",
    &[attributes! {
        REAL => young poisson damping thickness;
        TEXT => elastic2d;
    }],
)
.once();
static PIN: Element = Element::new("pin", &[attributes! { INTS => id range grid gridrange; }]);

const FLEX_COMMON: &[Attr] = attributes! {
    TEXT => name dof;
    INT => dim group;
    REAL => radius;
    AttributeType::Ref("material") => material;
    reals(4) => rgba;
    FLAG => flatskin;
    INTS => element cellcount;
    LIST => texcoord;
};
pub(super) static DEFORMABLE: Element = Element::new("deformable", &[]).children(&[&FLEX, &visual::SKIN]);
static FLEX: Element = Element::new(
    "flex",
    &[FLEX_COMMON, attributes! { TEXT => body node; LIST => vertex nodecoord; INTS => elemtexcoord; }],
)
.children(&[&FLEXCONTACT, &FLEXEDGE, &ELASTICITY])
.refused();
pub(super) static FLEXCOMP: Element = Element::new(
    "flexcomp",
    &[
        FLEX_COMMON,
        super::ORIENTATION,
        attributes! {
            TEXT => type file;
            INTS => count;
            reals(3) => spacing scale pos origin;
            REAL => mass inertiabox;
            FLAG => rigid;
            LIST => point;
        },
    ],
)
.children(&[&COMPEDGE, &ELASTICITY, &FLEXCONTACT, &PIN, &extension::PLUGIN])
.refused();

pub(super) static COMPOSITE: Element = Element::new(
    "composite",
    &[attributes! {
        TEXT => prefix type curve initial;
        INTS => count;
        reals(3) => offset;
        reals(4) => quat;
        LIST => vertex size;
    }],
)
.children(&[&COMP_JOINT, &COMP_SKIN, &COMP_GEOM, &COMP_SITE, &extension::PLUGIN])
.refused();
static COMP_JOINT: Element = Element::new(
    "joint",
    &[attributes! {
        TEXT => kind type;
        INT => group;
        reals(3) => axis;
        AUTO => limited;
        reals(2) => range;
        REAL => margin armature frictionloss;
        upto(3) => stiffness damping;
        upto(2) => solreflimit solreffriction solreffix;
        upto(5) => solimplimit solimpfriction solimpfix;
    }],
);
static COMP_SKIN: Element = Element::new(
    "skin",
    &[
        RGBA,
        attributes! {
            FLAG => texcoord;
            AttributeType::Ref("material") => material;
            INT => group subgrid;
            REAL => inflate;
        },
    ],
)
.once();
static COMP_GEOM: Element = Element::new(
    "geom",
    &[
        RGBA,
        CONTACT_ATTRS,
        attributes! {
            TEXT => type;
            upto(3) => size friction;
            INT => contype conaffinity group priority;
            REAL => mass density solmix;
            upto(6) => surfacevel;
            AttributeType::Ref("material") => material;
        },
    ],
)
.once();
static COMP_SITE: Element = Element::new(
    "site",
    &[attributes! {
        upto(3) => size;
        INT => group;
        TEXT => mesh;
        AttributeType::Ref("material") => material;
        reals(4) => rgba [APPEARANCE];
    }],
)
.once();
