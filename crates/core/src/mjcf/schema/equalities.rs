//! `equality`.

use super::Attr;
use super::AttributeType;
use super::Element;
use super::FLAG;
use super::INT;
use super::REAL;
use super::Status::Supported;
use super::Status::Unsupported;
use super::attributes;
use super::reals;
use super::upto;

pub(super) const EQUALITY_ATTRS: &[Attr] =
    attributes! { FLAG => active; upto(2) => solref; upto(5) => solimp; };
const EQUALITY_OWN: &[Attr] =
    attributes! { AttributeType::Name("equality") => name; AttributeType::Class => class; };
const TWO_BODIES: &[Attr] = attributes! {
    AttributeType::Ref("body") => body1 body2;
    AttributeType::Ref("site") => site1 site2;
    reals(3) => anchor;
};
const FLEX_REF: &[Attr] = attributes! { AttributeType::Ref("flex") => flex; };

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
    EQ_JOINT "joint" [attributes! { AttributeType::Ref("joint") => joint1 joint2; upto(5) => polycoef; }] Supported;
    EQ_TENDON "tendon" [attributes! { AttributeType::Ref("tendon") => tendon1 tendon2; upto(5) => polycoef; }] Supported;
    EQ_FLEX "flex" [FLEX_REF] Unsupported;
    EQ_FLEXVERT "flexvert" [FLEX_REF] Unsupported;
    EQ_FLEXSTRAIN "flexstrain" [FLEX_REF, attributes! { INT => cell; }] Unsupported;
}
