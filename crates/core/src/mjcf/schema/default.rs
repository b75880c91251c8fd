//! `default`: the defaults of a class for each kind of element.

use super::Attr;
use super::AttributeType;
use super::Element;
use super::actuators;
use super::attributes;
use super::body;
use super::equalities;
use super::pairs;
use super::tendon;
use super::visual;

/// An entry of `default`: the defaults of its class for one kind of element.
const fn entry(name: &'static str, attributes: &'static [&'static [Attr]]) -> Element {
    Element::new(name, attributes).once()
}

pub(super) static DEFAULT: Element =
    Element::new("default", &[attributes! { AttributeType::Class => class; }]).children(&DEFAULT_CHILDREN);

static DEFAULT_CHILDREN: [&Element; 23] = {
    let [a, b, c, d, e, f, g, h, i, j, k, l] = actuators::DEFAULTS;
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
static D_MATERIAL: Element = entry("material", &[visual::MATERIAL_ATTRS]).children(&[&visual::LAYER]);
static D_MESH: Element = entry("mesh", &[visual::MESH_ATTRS]);
static D_PAIR: Element = entry("pair", &[pairs::PAIR_ATTRS]);
static D_EQUALITY: Element = entry("equality", &[equalities::EQUALITY_ATTRS]);
static D_TENDON: Element =
    entry("tendon", &[tendon::TENDON_ATTRS, tendon::TENDON_DRAWN, tendon::TENDON_USER]);
