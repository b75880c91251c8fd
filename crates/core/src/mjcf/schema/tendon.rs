//! `tendon`.

use super::{APPEARANCE, AUTO, Attr, AttributeType, Element, INT, LIST, REAL, attributes, reals, upto};

pub(super) const TENDON_ATTRS: &[Attr] = attributes! {
    INT => group;
    AUTO => limited;
    reals(2) => range;
    REAL => margin frictionloss;
    upto(2) => solreflimit solreffriction springlength;
    upto(5) => solimplimit solimpfriction;
    upto(3) => stiffness damping;
};
pub(super) const TENDON_DRAWN: &[Attr] = attributes! {
    AttributeType::Ref("material") => material [APPEARANCE];
    REAL => width;
    reals(4) => rgba;
};
pub(super) const TENDON_USER: &[Attr] = attributes! { LIST => user; };
const TENDON_OWN: &[Attr] = attributes! {
    AttributeType::Name("tendon") => name;
    AttributeType::Class => class;
    REAL => armature;
    AUTO => actuatorfrclimited;
    reals(2) => actuatorfrcrange;
};
pub(super) static TENDON: Element = Element::new("tendon", &[]).children(&[&SPATIAL, &FIXED]);
static SPATIAL: Element = Element::new("spatial", &[TENDON_OWN, TENDON_ATTRS, TENDON_DRAWN, TENDON_USER])
    .children(&[&WRAP_SITE, &WRAP_GEOM, &WRAP_PULLEY]);
static WRAP_SITE: Element = Element::new("site", &[attributes! { AttributeType::Ref("site") => site; }]);
static WRAP_GEOM: Element = Element::new(
    "geom",
    &[attributes! { AttributeType::Ref("geom") => geom; AttributeType::Ref("site") => sidesite; }],
);
static WRAP_PULLEY: Element = Element::new("pulley", &[attributes! { REAL => divisor; }]);
static FIXED: Element =
    Element::new("fixed", &[TENDON_OWN, TENDON_ATTRS, TENDON_USER]).children(&[&WRAP_JOINT]);
static WRAP_JOINT: Element =
    Element::new("joint", &[attributes! { AttributeType::Ref("joint") => joint; REAL => coef; }]);
