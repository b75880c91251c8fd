//! `keyframe`.

use super::{AttributeType, Element, LIST, REAL, attributes};

pub(super) static KEYFRAME: Element = Element::new("keyframe", &[]).children(&[&KEY]);
static KEY: Element = Element::new(
    "key",
    &[attributes! {
        AttributeType::Name("key") => name;
        REAL => time;
        LIST => qpos qvel act ctrl mpos mquat;
    }],
);
