//! `default`, `keyframe`, `custom`, contact pairs, tendons, equality constraints, and the sections that are
//! refused for now: deformable bodies, plugins, includes.

use super::Status::{Supported, Unsupported};
use super::{
    AUTO, Attr, Element, FLAG, INT, INTS, Kind, LIST, LOOK, REAL, TEXT, USER, actuator, attributes, body,
    reals, scene, upto,
};

/// An entry of `default`: what its class says about one kind of element.
const fn entry(name: &'static str, attributes: &'static [&'static [Attr]]) -> Element {
    Element::new(name, attributes).once()
}

pub(super) static DEFAULT: Element =
    Element::new("default", &[attributes! { Kind::Class => class; }]).children(&DEFAULT_CHILDREN);

static DEFAULT_CHILDREN: [&Element; 23] = {
    let [a, b, c, d, e, f, g, h, i, j, k, l] = actuator::DEFAULTS;
    [
        &DEFAULT,
        &D_JOINT,
        &D_GEOM,
        &D_SITE,
        &D_CAMERA,
        &D_LIGHT,
        &D_MATERIAL,
        &D_MESH,
        &D_PAIR,
        &D_EQUALITY,
        &D_TENDON,
        a,
        b,
        c,
        d,
        e,
        f,
        g,
        h,
        i,
        j,
        k,
        l,
    ]
};

static D_JOINT: Element = entry("joint", &[body::JOINT_ATTRS]);
static D_GEOM: Element = entry("geom", &[body::GEOM_ATTRS]);
static D_SITE: Element = entry("site", &[body::SITE_ATTRS]);
static D_CAMERA: Element = entry("camera", &[body::CAMERA_ATTRS]);
static D_LIGHT: Element = entry("light", &[body::LIGHT_ATTRS]);
static D_MATERIAL: Element = entry("material", &[scene::MATERIAL_ATTRS]).children(&[&scene::LAYER]);
static D_MESH: Element = entry("mesh", &[scene::MESH_ATTRS]);
static D_PAIR: Element = entry("pair", &[PAIR_ATTRS]);
static D_EQUALITY: Element = entry("equality", &[EQUALITY_ATTRS]);
static D_TENDON: Element = entry("tendon", &[TENDON_ATTRS, TENDON_DRAWN, TENDON_USER]);

pub(super) static KEYFRAME: Element = Element::new("keyframe", &[]).children(&[&KEY]);
static KEY: Element = Element::new(
    "key",
    &[attributes! {
        Kind::Name("key") => name;
        REAL => time;
        LIST => qpos qvel act ctrl mpos mquat;
    }],
);

pub(super) static CUSTOM: Element =
    Element::new("custom", &[]).children(&[&NUMERIC, &TEXT_DATA, &TUPLE]).status(USER);
static NUMERIC: Element =
    Element::new("numeric", &[attributes! { Kind::Name("numeric") => name; LIST => data; INT => size; }]);
static TEXT_DATA: Element =
    Element::new("text", &[attributes! { Kind::Name("text") => name; TEXT => data; }]);
static TUPLE: Element =
    Element::new("tuple", &[attributes! { Kind::Name("tuple") => name; }]).children(&[&TUPLE_ELEMENT]);
static TUPLE_ELEMENT: Element =
    Element::new("element", &[attributes! { TEXT => objtype objname; REAL => prm; }]);

pub(crate) static INCLUDE: Element = Element::new("include", &[attributes! { TEXT => file; }]);

pub(super) static EXTENSION: Element =
    Element::new("extension", &[]).children(&[&EXTENSION_PLUGIN]).refused();
static EXTENSION_PLUGIN: Element =
    Element::new("plugin", &[attributes! { TEXT => plugin; }]).children(&[&INSTANCE]);
static INSTANCE: Element = Element::new("instance", &[attributes! { TEXT => name; }]).children(&[&CONFIG]);
pub(super) static CONFIG: Element = Element::new("config", &[attributes! { TEXT => key value; }]);
pub(super) static PLUGIN: Element =
    Element::new("plugin", &[attributes! { TEXT => plugin instance; }]).children(&[&CONFIG]).refused();

const CONTACT_ATTRS: &[Attr] = attributes! {
    INT => condim;
    REAL => adhesion margin gap;
    upto(2) => solref;
    upto(5) => solimp;
};
const PAIR_ATTRS: &[Attr] = attributes! {
    INT => condim;
    REAL => adhesion margin gap;
    upto(2) => solref solreffriction;
    upto(5) => solimp friction;
};
pub(super) static CONTACT: Element = Element::new("contact", &[]).children(&[&PAIR, &EXCLUDE]);
static PAIR: Element = Element::new(
    "pair",
    &[
        attributes! { Kind::Name("pair") => name; Kind::Class => class; Kind::Ref("geom") => geom1 geom2; },
        PAIR_ATTRS,
    ],
);
static EXCLUDE: Element = Element::new(
    "exclude",
    &[attributes! { Kind::Name("exclude") => name; Kind::Ref("body") => body1 body2; }],
);

const TENDON_ATTRS: &[Attr] = attributes! {
    INT => group;
    AUTO => limited;
    reals(2) => range;
    REAL => margin frictionloss;
    upto(2) => solreflimit solreffriction springlength;
    upto(5) => solimplimit solimpfriction;
    upto(3) => stiffness damping;
};
const TENDON_DRAWN: &[Attr] = attributes! {
    Kind::Ref("material") => material [LOOK];
    REAL => width;
    reals(4) => rgba;
};
const TENDON_USER: &[Attr] = attributes! { LIST => user; };
const TENDON_OWN: &[Attr] = attributes! {
    Kind::Name("tendon") => name;
    Kind::Class => class;
    REAL => armature;
    AUTO => actuatorfrclimited;
    reals(2) => actuatorfrcrange;
};
const RGBA: &[Attr] = attributes! { reals(4) => rgba; };
pub(super) static TENDON: Element = Element::new("tendon", &[]).children(&[&SPATIAL, &FIXED]);
static SPATIAL: Element = Element::new("spatial", &[TENDON_OWN, TENDON_ATTRS, TENDON_DRAWN, TENDON_USER])
    .children(&[&WRAP_SITE, &WRAP_GEOM, &WRAP_PULLEY]);
static WRAP_SITE: Element = Element::new("site", &[attributes! { Kind::Ref("site") => site; }]);
static WRAP_GEOM: Element =
    Element::new("geom", &[attributes! { Kind::Ref("geom") => geom; Kind::Ref("site") => sidesite; }]);
static WRAP_PULLEY: Element = Element::new("pulley", &[attributes! { REAL => divisor; }]);
static FIXED: Element =
    Element::new("fixed", &[TENDON_OWN, TENDON_ATTRS, TENDON_USER]).children(&[&WRAP_JOINT]);
static WRAP_JOINT: Element =
    Element::new("joint", &[attributes! { Kind::Ref("joint") => joint; REAL => coef; }]);

const EQUALITY_ATTRS: &[Attr] = attributes! { FLAG => active; upto(2) => solref; upto(5) => solimp; };
const EQUALITY_OWN: &[Attr] = attributes! { Kind::Name("equality") => name; Kind::Class => class; };
const TWO_BODIES: &[Attr] = attributes! {
    Kind::Ref("body") => body1 body2;
    Kind::Ref("site") => site1 site2;
    reals(3) => anchor;
};
const FLEX_REF: &[Attr] = attributes! { Kind::Ref("flex") => flex; };

macro_rules! equalities {
    ($($id:ident $name:literal [$($group:expr),*] $status:expr;)*) => {
        $(static $id: Element =
            Element::new($name, &[EQUALITY_OWN, EQUALITY_ATTRS $(, $group)*]).status($status);)*
        pub(super) static EQUALITY: Element = Element::new("equality", &[]).children(&[$(&$id),*]);
    };
}
equalities! {
    CONNECT "connect" [TWO_BODIES] Supported;
    WELD "weld" [TWO_BODIES, attributes! { reals(7) => relpose; REAL => torquescale; }] Supported;
    EQ_JOINT "joint" [attributes! { Kind::Ref("joint") => joint1 joint2; upto(5) => polycoef; }] Supported;
    EQ_TENDON "tendon" [attributes! { Kind::Ref("tendon") => tendon1 tendon2; upto(5) => polycoef; }] Supported;
    EQ_FLEX "flex" [FLEX_REF] Unsupported;
    EQ_FLEXVERT "flexvert" [FLEX_REF] Unsupported;
    EQ_FLEXSTRAIN "flexstrain" [FLEX_REF, attributes! { INT => cell; }] Unsupported;
}

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
    Kind::Ref("material") => material;
    reals(4) => rgba;
    FLAG => flatskin;
    INTS => element cellcount;
    LIST => texcoord;
};
pub(super) static DEFORMABLE: Element = Element::new("deformable", &[]).children(&[&FLEX, &scene::SKIN]);
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
.children(&[&COMPEDGE, &ELASTICITY, &FLEXCONTACT, &PIN, &PLUGIN])
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
.children(&[&COMP_JOINT, &COMP_SKIN, &COMP_GEOM, &COMP_SITE, &PLUGIN])
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
            Kind::Ref("material") => material;
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
            Kind::Ref("material") => material;
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
        Kind::Ref("material") => material;
        reals(4) => rgba [LOOK];
    }],
)
.once();
