//! `contact`: pairs and exclusions.

use super::Attr;
use super::AttributeType;
use super::Element;
use super::INT;
use super::REAL;
use super::attributes;
use super::upto;

pub(super) const PAIR_ATTRS: &[Attr] = attributes! {
    INT => condim;
    REAL => adhesion margin gap;
    upto(2) => solref solreffriction;
    upto(5) => solimp friction;
};
pub(super) static CONTACT: Element = Element::new("contact", &[]).children(&[&PAIR, &EXCLUDE]);
static PAIR: Element = Element::new(
    "pair",
    &[
        attributes! { AttributeType::Name("pair") => name; AttributeType::Class => class; AttributeType::Ref("geom") => geom1 geom2; },
        PAIR_ATTRS,
    ],
);
static EXCLUDE: Element = Element::new(
    "exclude",
    &[attributes! { AttributeType::Name("exclude") => name; AttributeType::Ref("body") => body1 body2; }],
);
