//! `visual` and `asset`: the appearance of the scene, and meshes.

use super::APPEARANCE;
use super::AttributeType;
use super::Element;
use super::FLAG;
use super::INT;
use super::INTS;
use super::LIST;
use super::REAL;
use super::TEXT;
use super::attributes;
use super::keyword;
use super::reals;

/// A section of `visual` with these attributes.
const fn visual_section(name: &'static str, attributes: &'static [&'static [super::Attr]]) -> Element {
    Element::new(name, attributes).status(APPEARANCE).once()
}

pub(super) static VISUAL: Element = Element::new("visual", &[])
    .status(APPEARANCE)
    .children(&[&GLOBAL, &QUALITY, &HEADLIGHT, &MAP, &SCALE, &RGBA]);

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
        AttributeType::Name("texture") => name;
        AttributeType::Keywords(&[keyword("2d", 0), keyword("cube", 1), keyword("skybox", 2)]) => type;
        AttributeType::Keywords(&[keyword("auto", 0), keyword("linear", 1), keyword("sRGB", 2)]) => colorspace;
        TEXT => content_type file gridlayout fileright fileleft fileup filedown filefront fileback;
        AttributeType::Ints(2, 2) => gridsize;
        AttributeType::Keywords(&[keyword("none", 0), keyword("gradient", 1), keyword("checker", 2), keyword("flat", 3)]) => builtin;
        reals(3) => rgb1 rgb2 markrgb;
        AttributeType::Keywords(&[keyword("none", 0), keyword("edge", 1), keyword("cross", 2), keyword("random", 3)]) => mark;
        REAL => random;
        INT => width height nchannel;
        FLAG => hflip vflip;
    }],
)
.status(APPEARANCE);

/// A material, without its name and class.
pub(super) const MATERIAL_ATTRS: &[super::Attr] = attributes! {
    AttributeType::Ref("texture") => texture;
    reals(2) => texrepeat;
    FLAG => texuniform;
    REAL => emission specular shininess reflectance metallic roughness;
    reals(4) => rgba;
};
pub(super) static MATERIAL: Element = Element::new(
    "material",
    &[
        attributes! { AttributeType::Name("material") => name; AttributeType::Class => class; },
        MATERIAL_ATTRS,
    ],
)
.children(&[&LAYER]);
pub(super) static LAYER: Element = Element::new(
    "layer",
    &[
        attributes! { AttributeType::Keywords(TEXTURE_ROLES) => role; AttributeType::Ref("texture") => texture; },
    ],
);

/// The roles of the textures of a material, as in `mjtTextureRole`.
const TEXTURE_ROLES: &[super::Keyword] = &[
    keyword("rgb", 1),
    keyword("occlusion", 2),
    keyword("roughness", 3),
    keyword("metallic", 4),
    keyword("normal", 5),
    keyword("opacity", 6),
    keyword("emissive", 7),
    keyword("rgba", 8),
    keyword("orm", 9),
];

/// A mesh, without its name, class and data.
pub(super) const MESH_ATTRS: &[super::Attr] = attributes! {
    reals(3) => scale;
    INT => maxhullvert;
    AttributeType::Keywords(&[keyword("convex", 0), keyword("exact", 1), keyword("legacy", 2), keyword("shell", 3)]) => inertia;
};
static MESH: Element = Element::new(
    "mesh",
    &[
        attributes! {
            AttributeType::Name("mesh") => name;
            AttributeType::Class => class;
            TEXT => content_type file builtin;
            FLAG => smoothnormal;
            AttributeType::Ref("material") => material;
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
        AttributeType::Name("hfield") => name;
        TEXT => content_type file;
        INT => nrow ncol;
        reals(4) => size;
        LIST => elevation;
    }],
);
pub(super) static SKIN: Element = Element::new(
    "skin",
    &[attributes! {
        AttributeType::Name("skin") => name;
        TEXT => file;
        AttributeType::Ref("material") => material;
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
        AttributeType::Ref("body") => body;
        reals(3) => bindpos;
        reals(4) => bindquat;
        INTS => vertid;
        LIST => vertweight;
    }],
);
static MODEL: Element = Element::new(
    "model",
    &[attributes! {
        AttributeType::Name("model") => name;
        TEXT => file;
        TEXT => content_type [super::Status::Ignored("a model is MJCF, whatever it says; MuJoCo ignores it too")];
    }],
);
