//! `sensor`: one element for each kind in the table of sensors.

use super::{Attr, AttributeType, Element, INT, LIST, REAL, TEXT, attributes, extension, keyword, upto};
use crate::kinds::interpolation;
use crate::model::Obj;
use crate::sensor::{self, SensorTarget};

const COMMON: &[Attr] = attributes! {
    AttributeType::Name("sensor") => name;
    LIST => user;
};
const VALUES: &[Attr] = attributes! { REAL => cutoff noise; };
const TIMING: &[Attr] = attributes! {
    INT => nsample;
    REAL => delay;
    upto(2) => interval;
    AttributeType::Keywords(&[keyword("zoh", interpolation::HOLD), keyword("linear", interpolation::LINEAR), keyword("cubic", interpolation::CUBIC)]) => interp;
};
const FRAMES: AttributeType = AttributeType::Keywords(&[
    keyword("body", Obj::Body as i32),
    keyword("xbody", Obj::XBody as i32),
    keyword("geom", Obj::Geom as i32),
    keyword("site", Obj::Site as i32),
    keyword("camera", Obj::Camera as i32),
]);
const OBJECT: &[Attr] = attributes! { FRAMES => objtype; TEXT => objname; };
const REFERENCE: &[Attr] = attributes! {
    FRAMES => reftype;
    TEXT => refname;
};
const SITE: &[Attr] = attributes! { AttributeType::Ref("site") => site; };
const JOINT: &[Attr] = attributes! { AttributeType::Ref("joint") => joint; };
const TENDON: &[Attr] = attributes! { AttributeType::Ref("tendon") => tendon; };
const ACTUATOR: &[Attr] = attributes! { AttributeType::Ref("actuator") => actuator; };
const BODY: &[Attr] = attributes! { AttributeType::Ref("body") => body; };
const DATA: &[Attr] = attributes! { TEXT => data; };
const CAMERA: &[Attr] = attributes! { AttributeType::Ref("camera") => camera; };
const PAIR: &[Attr] =
    attributes! { AttributeType::Ref("body") => body1 body2; AttributeType::Ref("geom") => geom1 geom2; };

const CONTACT: &[Attr] = attributes! {
    AttributeType::Ref("body") => subtree1 subtree2;
    TEXT => data;
    AttributeType::Keywords(&[keyword("none", 0), keyword("mindist", 1), keyword("maxforce", 2), keyword("netforce", 3)]) => reduce;
    INT => num;
};
const USERS: &[Attr] = attributes! {
    FRAMES => objtype;
    TEXT => objname;
    AttributeType::Keywords(&[keyword("real", 0), keyword("positive", 1), keyword("axis", 2), keyword("quaternion", 3)]) => datatype;
    AttributeType::Keywords(&[keyword("none", 0), keyword("pos", 1), keyword("vel", 2), keyword("acc", 3)]) => needstage;
    INT => dim;
};
const TACTILE: &[Attr] = attributes! {
    REAL => cutoff;
    AttributeType::Ref("geom") => geom;
    AttributeType::Ref("mesh") => mesh;
};
const PLUGIN: &[Attr] = attributes! {
    REAL => cutoff;
    TEXT => plugin instance objtype objname reftype refname;
};

/// The attribute groups of a kind of sensor: those that select the measured object, and those that almost all kinds have.
const fn groups(kind: &sensor::SensorKind) -> &'static [&'static [Attr]] {
    match kind.senses {
        SensorTarget::Nothing => &[COMMON, VALUES, TIMING],
        SensorTarget::Site => &[COMMON, VALUES, TIMING, SITE],
        SensorTarget::Ray => &[COMMON, VALUES, TIMING, SITE, CAMERA, DATA],
        SensorTarget::SiteInImage => &[COMMON, VALUES, TIMING, SITE, CAMERA],
        SensorTarget::ScalarJoint | SensorTarget::BallJoint | SensorTarget::LimitedJoint => {
            &[COMMON, VALUES, TIMING, JOINT]
        }
        SensorTarget::Tendon | SensorTarget::LimitedTendon => &[COMMON, VALUES, TIMING, TENDON],
        SensorTarget::Actuator => &[COMMON, VALUES, TIMING, ACTUATOR],
        SensorTarget::Frame => &[COMMON, VALUES, TIMING, OBJECT],
        SensorTarget::RelativeFrame => &[COMMON, VALUES, TIMING, OBJECT, REFERENCE],
        SensorTarget::FrameInSite => &[COMMON, VALUES, TIMING, OBJECT, SITE],
        SensorTarget::Subtree => &[COMMON, VALUES, TIMING, BODY],
        SensorTarget::Pair => &[COMMON, VALUES, TIMING, PAIR],
        SensorTarget::Contacts => &[COMMON, VALUES, TIMING, PAIR, SITE, CONTACT],
        SensorTarget::User => &[COMMON, VALUES, USERS],
        SensorTarget::Tactile => &[COMMON, TIMING, TACTILE],
        SensorTarget::Plugin => &[COMMON, PLUGIN],
    }
}

const COUNT: usize = sensor::KINDS.len();
static ELEMENTS: [Element; COUNT] = {
    let mut all = [const { Element::new("", &[]) }; COUNT];
    let mut i = 0;
    while i < COUNT {
        let kind = &sensor::KINDS[i];
        let element = Element::new(kind.name, groups(kind));
        all[i] = match kind.senses {
            SensorTarget::Tactile => element.refused(),
            SensorTarget::Plugin => element.children(&[&extension::CONFIG]).refused(),
            _ => element,
        };
        i += 1;
    }
    all
};
static CHILDREN: [&Element; COUNT] = {
    let mut all = [&ELEMENTS[0]; COUNT];
    let mut i = 0;
    while i < COUNT {
        all[i] = &ELEMENTS[i];
        i += 1;
    }
    all
};
pub(super) static SENSOR: Element = Element::new("sensor", &[]).children(&CHILDREN);
