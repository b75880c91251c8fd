//! `visual` and `asset`: the appearance of the scene, and meshes.

use super::Element;
use super::FLAG;
use super::INT;
use super::INTS;
use super::Kind;
use super::LIST;
use super::LOOK;
use super::REAL;
use super::TEXT;
use super::attributes;
use super::reals;
use super::word;

/// A section of `visual` with these attributes.
const fn visual_section(name: &'static str, attributes: &'static [&'static [super::Attr]]) -> Element {
    Element::new(name, attributes).status(LOOK).once()
}

pub(super) static VISUAL: Element =
    Element::new("visual", &[]).status(LOOK).children(&[&GLOBAL, &QUALITY, &HEADLIGHT, &MAP, &SCALE, &RGBA]);

static GLOBAL: Element = visual_section(
    "global",
    &[attributes! {
        REAL => fovy ipd azimuth elevation linewidth glow realtime;
        INT => cameraid offwidth offheight;
        FLAG => orthographic ellipsoidinertia bvactive;
    }],
);
static QUALITY: Element = visual_section(
    "quality",
    &[attributes! {
        INT => shadowsize offsamples numslices numstacks numquads;
    }],
);
static HEADLIGHT: Element = visual_section(
    "headlight",
    &[attributes! {
        reals(3) => ambient diffuse specular;
        INT => active;
    }],
);
static MAP: Element = visual_section(
    "map",
    &[attributes! {
        REAL => stiffness stiffnessrot force torque alpha fogstart fogend znear zfar haze shadowclip shadowscale
            actuatortendon;
    }],
);
static SCALE: Element = visual_section(
    "scale",
    &[attributes! {
        REAL => forcewidth contactwidth contactheight connect com camera light selectpoint jointlength jointwidth
            actuatorlength actuatorwidth framelength framewidth constraint slidercrank frustum;
    }],
);
static RGBA: Element = visual_section(
    "rgba",
    &[attributes! {
        reals(4) => fog haze force inertia joint actuator actuatornegative actuatorpositive com camera light
            selectpoint connect contactpoint contactforce contactfriction contacttorque contactgap rangefinder
            constraint slidercrank crankbroken frustum bv bvactive;
    }],
);

pub(super) static ASSET: Element =
    Element::new("asset", &[]).children(&[&TEXTURE, &MATERIAL, &MESH, &HFIELD, &SKIN, &MODEL]);

static TEXTURE: Element = Element::new(
    "texture",
    &[attributes! {
        Kind::Name("texture") => name;
        Kind::Words(&[word("2d", 0), word("cube", 1), word("skybox", 2)]) => type;
        Kind::Words(&[word("auto", 0), word("linear", 1), word("sRGB", 2)]) => colorspace;
        TEXT => content_type file gridlayout fileright fileleft fileup filedown filefront fileback;
        Kind::Ints(2, 2) => gridsize;
        Kind::Words(&[word("none", 0), word("gradient", 1), word("checker", 2), word("flat", 3)]) => builtin;
        reals(3) => rgb1 rgb2 markrgb;
        Kind::Words(&[word("none", 0), word("edge", 1), word("cross", 2), word("random", 3)]) => mark;
        REAL => random;
        INT => width height nchannel;
        FLAG => hflip vflip;
    }],
)
.status(LOOK);

/// A material, without its name and class.
pub(super) const MATERIAL_ATTRS: &[super::Attr] = attributes! {
    Kind::Ref("texture") => texture;
    reals(2) => texrepeat;
    FLAG => texuniform;
    REAL => emission specular shininess reflectance metallic roughness;
    reals(4) => rgba;
};
pub(super) static MATERIAL: Element = Element::new(
    "material",
    &[attributes! { Kind::Name("material") => name; Kind::Class => class; }, MATERIAL_ATTRS],
)
.children(&[&LAYER]);
pub(super) static LAYER: Element = Element::new(
    "layer",
    &[attributes! { Kind::Words(TEXTURE_ROLES) => role; Kind::Ref("texture") => texture; }],
);

/// The roles of the textures of a material, as in `mjtTextureRole`.
const TEXTURE_ROLES: &[super::Word] = &[
    word("rgb", 1),
    word("occlusion", 2),
    word("roughness", 3),
    word("metallic", 4),
    word("normal", 5),
    word("opacity", 6),
    word("emissive", 7),
    word("rgba", 8),
    word("orm", 9),
];

/// A mesh, without its name, class and data.
pub(super) const MESH_ATTRS: &[super::Attr] = attributes! {
    reals(3) => scale;
    INT => maxhullvert;
    Kind::Words(&[word("convex", 0), word("exact", 1), word("legacy", 2), word("shell", 3)]) => inertia;
};
static MESH: Element = Element::new(
    "mesh",
    &[
        attributes! {
            Kind::Name("mesh") => name;
            Kind::Class => class;
            TEXT => content_type file builtin;
            FLAG => smoothnormal;
            Kind::Ref("material") => material;
            LIST => vertex normal texcoord params;
            INTS => face;
            reals(3) => refpos;
            reals(4) => refquat;
        },
        MESH_ATTRS,
    ],
)
.children(&[&super::extension::PLUGIN]);
static HFIELD: Element = Element::new(
    "hfield",
    &[attributes! {
        Kind::Name("hfield") => name;
        TEXT => content_type file;
        INT => nrow ncol;
        reals(4) => size;
        LIST => elevation;
    }],
);
pub(super) static SKIN: Element = Element::new(
    "skin",
    &[attributes! {
        Kind::Name("skin") => name;
        TEXT => file;
        Kind::Ref("material") => material;
        reals(4) => rgba;
        REAL => inflate;
        INT => group;
        LIST => vertex texcoord;
        INTS => face;
    }],
)
.children(&[&BONE]);
static BONE: Element = Element::new(
    "bone",
    &[attributes! {
        Kind::Ref("body") => body;
        reals(3) => bindpos;
        reals(4) => bindquat;
        INTS => vertid;
        LIST => vertweight;
    }],
);
static MODEL: Element = Element::new(
    "model",
    &[attributes! {
        Kind::Name("model") => name;
        TEXT => file;
        TEXT => content_type [super::Status::Ignored("a model is MJCF, whatever it says; MuJoCo ignores it too")];
    }],
);
