//! `custom`: user data as numbers, texts and tuples.

use super::{AttributeType, Element, INT, LIST, REAL, TEXT, USER, attributes};

pub(super) static CUSTOM: Element =
    Element::new("custom", &[]).children(&[&NUMERIC, &TEXT_DATA, &TUPLE]).status(USER);
static NUMERIC: Element = Element::new(
    "numeric",
    &[attributes! { AttributeType::Name("numeric") => name; LIST => data; INT => size; }],
);
static TEXT_DATA: Element =
    Element::new("text", &[attributes! { AttributeType::Name("text") => name; TEXT => data; }]);
static TUPLE: Element = Element::new("tuple", &[attributes! { AttributeType::Name("tuple") => name; }])
    .children(&[&TUPLE_ELEMENT]);
static TUPLE_ELEMENT: Element =
    Element::new("element", &[attributes! { TEXT => objtype objname; REAL => prm; }]);
