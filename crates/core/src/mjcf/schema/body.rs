//! `worldbody` and the elements of bodies: joints, inertias, geoms, sites, cameras, lights.

use super::{
    AUTO, Attr, AttributeType, Element, FLAG, INT, Keyword, LIST, ORIENTATION, REAL, TEXT, attributes,
    extension, flexible, keyword, reals, unsupported_keyword, upto,
};
use crate::kinds::{camlight, choice, geom, joint, lighttype, projection};

const GEOM_SHAPES: &[Keyword] = &[
    keyword("plane", geom::PLANE),
    keyword("hfield", geom::HFIELD),
    keyword("sphere", geom::SPHERE),
    keyword("capsule", geom::CAPSULE),
    keyword("ellipsoid", geom::ELLIPSOID),
    keyword("cylinder", geom::CYLINDER),
    keyword("box", geom::BOX),
    keyword("mesh", geom::MESH),
    unsupported_keyword("sdf", 8),
];
const SITE_SHAPES: &[Keyword] = &[
    keyword("sphere", geom::SPHERE),
    keyword("capsule", geom::CAPSULE),
    keyword("ellipsoid", geom::ELLIPSOID),
    keyword("cylinder", geom::CYLINDER),
    keyword("box", geom::BOX),
    keyword("mesh", geom::MESH),
];

const POS: &[Attr] = attributes! { reals(3) => pos; };
const CLASS: &[Attr] = attributes! { AttributeType::Class => class; };

static BODY_CHILDREN: [&Element; 15] = [
    &BODY,
    &FRAME,
    &REPLICATE,
    &INERTIAL,
    &JOINT,
    &FREEJOINT,
    &GEOM,
    &SITE,
    &CAMERA,
    &LIGHT,
    &ATTACH,
    &extension::PLUGIN,
    &flexible::COMPOSITE,
    &flexible::FLEXCOMP,
    &extension::INCLUDE,
];

/// The world: a body without frame, joints and inertia.
pub(super) static WORLDBODY: Element = Element::new("worldbody", &[]).children(&[
    &BODY,
    &FRAME,
    &REPLICATE,
    &GEOM,
    &SITE,
    &CAMERA,
    &LIGHT,
    &ATTACH,
    &flexible::COMPOSITE,
    &flexible::FLEXCOMP,
    &extension::INCLUDE,
]);

pub(crate) static BODY: Element = Element::new(
    "body",
    &[
        attributes! { AttributeType::Name("body") => name; AttributeType::Class => childclass; },
        POS,
        ORIENTATION,
        attributes! {
            FLAG => mocap;
            AttributeType::Keywords(&[keyword("auto", choice::TRUE), keyword("false", choice::FALSE)]) => simple;
            REAL => gravcomp;
            AttributeType::Keywords(&[keyword("auto", 0), keyword("never", 1), keyword("allowed", 2), keyword("init", 3)]) => sleep;
            LIST => user;
        },
    ],
)
.children(&BODY_CHILDREN);

pub(crate) static FRAME: Element = Element::new(
    "frame",
    &[
        attributes! { AttributeType::Name("frame") => name; AttributeType::Class => childclass; },
        POS,
        ORIENTATION,
    ],
)
.children(&BODY_CHILDREN);

static REPLICATE: Element = Element::new(
    "replicate",
    &[attributes! {
        INT => count;
        TEXT => sep;
        reals(3) => offset euler;
        AttributeType::Class => childclass;
    }],
)
.children(&BODY_CHILDREN);

static ATTACH: Element = Element::new("attach", &[attributes! { TEXT => prefix model body frame; }]);

static INERTIAL: Element = Element::new(
    "inertial",
    &[
        POS,
        ORIENTATION,
        attributes! {
            REAL => mass;
            reals(3) => diaginertia;
            reals(6) => fullinertia;
        },
    ],
)
.once();

/// A joint, without its name and class.
pub(super) const JOINT_ATTRS: &[Attr] = attributes! {
    AttributeType::Keywords(&[
        keyword("free", joint::FREE), keyword("ball", joint::BALL), keyword("slide", joint::SLIDE),
        keyword("hinge", joint::HINGE),
    ]) => type;
    reals(3) => pos axis;
    AUTO => limited;
    reals(2) => range;
    REAL => margin armature ref springref;
    upto(3) => stiffness damping;
    upto(2) => solreflimit;
    upto(5) => solimplimit;
    REAL => frictionloss;
    reals(2) => springdamper actuatorfrcrange;
    upto(2) => solreffriction;
    upto(5) => solimpfriction;
    AUTO => actuatorfrclimited;
    FLAG => actuatorgravcomp;
    INT => group;
    LIST => user;
};
static JOINT: Element =
    Element::new("joint", &[attributes! { AttributeType::Name("joint") => name; }, CLASS, JOINT_ATTRS]);
static FREEJOINT: Element = Element::new(
    "freejoint",
    &[attributes! {
        AttributeType::Name("joint") => name;
        AttributeType::Keywords(&[keyword("false", choice::FALSE), keyword("true", choice::TRUE), keyword("auto", choice::AUTO)]) => align;
        INT => group;
    }],
);

/// A geom, without its name and class.
pub(super) const GEOM_ATTRS: &[Attr] = attributes! {
    AttributeType::Keywords(GEOM_SHAPES) => type;
    reals(3) => pos;
    reals(4) => quat axisangle;
    reals(3) => euler zaxis;
    reals(6) => xyaxes;
    upto(3) => size friction;
    INT => contype conaffinity condim group priority;
    REAL => mass density solmix margin gap;
    upto(2) => solref;
    upto(5) => solimp;
    reals(4) => rgba;
    AttributeType::Ref("material") => material;
    FLAG => shellinertia;
    REAL => adhesion;
    upto(6) => surfacevel;
    reals(6) => fromto;
    AttributeType::Ref("mesh") => mesh;
    AttributeType::Ref("hfield") => hfield;
    REAL => fitscale;
    AttributeType::Keywords(&[keyword("none", 0), keyword("ellipsoid", geom::ELLIPSOID)]) => fluidshape;
    upto(5) => fluidcoef;
    LIST => user;
};
static GEOM: Element =
    Element::new("geom", &[attributes! { AttributeType::Name("geom") => name; }, CLASS, GEOM_ATTRS])
        .children(&[&extension::PLUGIN]);

/// A site, without its name and class.
pub(super) const SITE_ATTRS: &[Attr] = attributes! {
    AttributeType::Keywords(SITE_SHAPES) => type;
    reals(3) => pos;
    reals(4) => quat axisangle;
    reals(3) => euler zaxis;
    reals(6) => xyaxes;
    upto(3) => size;
    reals(4) => rgba;
    AttributeType::Ref("material") => material;
    INT => group;
    reals(6) => fromto;
    AttributeType::Ref("mesh") => mesh;
    LIST => user;
};
static SITE: Element =
    Element::new("site", &[attributes! { AttributeType::Name("site") => name; }, CLASS, SITE_ATTRS]);

const TRACKING: AttributeType = AttributeType::Keywords(&[
    keyword("fixed", camlight::FIXED),
    keyword("track", camlight::TRACK),
    keyword("trackcom", camlight::TRACKCOM),
    keyword("targetbody", camlight::TARGETBODY),
    keyword("targetbodycom", camlight::TARGETBODYCOM),
]);

/// A camera, without its name, class and target.
pub(super) const CAMERA_ATTRS: &[Attr] = attributes! {
    reals(3) => pos euler zaxis;
    reals(4) => quat axisangle;
    reals(6) => xyaxes;
    TRACKING => mode;
    AttributeType::Keywords(&[keyword("perspective", projection::PERSPECTIVE), keyword("orthographic", projection::ORTHOGRAPHIC)]) => projection;
    REAL => fovy ipd;
    AttributeType::Ints(2, 2) => resolution;
    TEXT => output;
    reals(2) => focal focalpixel principal principalpixel sensorsize;
    LIST => user;
};
static CAMERA: Element = Element::new(
    "camera",
    &[
        attributes! { AttributeType::Name("camera") => name; AttributeType::Ref("body") => target; },
        CLASS,
        CAMERA_ATTRS,
    ],
);

/// A light, without its name, class, target and texture.
pub(super) const LIGHT_ATTRS: &[Attr] = attributes! {
    reals(3) => pos dir ambient diffuse specular attenuation;
    FLAG => active castshadow directional;
    REAL => bulbradius cutoff exponent intensity range softness;
    TRACKING => mode;
    AttributeType::Keywords(&[keyword("spot", lighttype::SPOT), keyword("directional", lighttype::DIRECTIONAL), keyword("point", lighttype::POINT), keyword("image", lighttype::IMAGE)]) => type;
};
static LIGHT: Element = Element::new(
    "light",
    &[
        attributes! {
            AttributeType::Name("light") => name;
            AttributeType::Ref("body") => target;
            AttributeType::Ref("texture") => texture;
        },
        CLASS,
        LIGHT_ATTRS,
    ],
);
