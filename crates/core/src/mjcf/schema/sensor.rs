//! `sensor`.

use super::Status::Only;
use super::{Attr, Element, INT, Kind, LIST, REAL, TEXT, USER, attributes, not_yet, rest, upto, word};
use crate::model::Obj;

const COMMON: &[Attr] = attributes! {
    Kind::Name("sensor") => name;
    LIST => user [USER];
};
const VALUES: &[Attr] = attributes! { REAL => cutoff noise; };
const TIMING: &[Attr] = attributes! {
    INT => nsample [Only("0")];
    REAL => delay [Only("0")];
    upto(2) => interval [Only("0 0")];
    Kind::Words(&[word("zoh", 0), word("linear", 1), word("cubic", 2)]) => interp [Only("zoh")];
};
const FRAMES: Kind = Kind::Words(&[
    word("body", Obj::Body as i32),
    word("xbody", Obj::XBody as i32),
    word("geom", Obj::Geom as i32),
    word("site", Obj::Site as i32),
    not_yet("camera", Obj::Camera as i32),
]);
const OBJECT: &[Attr] = attributes! { FRAMES => objtype; TEXT => objname; };
const REFERENCE: &[Attr] = attributes! {
    FRAMES => reftype [super::Status::Unsupported];
    TEXT => refname [super::Status::Unsupported];
};
const SITE: &[Attr] = attributes! { Kind::Ref("site") => site; };
const JOINT: &[Attr] = attributes! { Kind::Ref("joint") => joint; };
const TENDON: &[Attr] = attributes! { Kind::Ref("tendon") => tendon; };
const ACTUATOR: &[Attr] = attributes! { Kind::Ref("actuator") => actuator; };
const BODY: &[Attr] = attributes! { Kind::Ref("body") => body; };
const CAMERA: &[Attr] = attributes! { Kind::Ref("camera") => camera; };
const PAIR: &[Attr] = attributes! { Kind::Ref("body") => body1 body2; Kind::Ref("geom") => geom1 geom2; };

/// A sensor with the attributes that nearly all have.
const fn sensor(name: &'static str, attributes: &'static [&'static [Attr]]) -> Element {
    Element::new(name, attributes)
}

macro_rules! sensors {
    ($($id:ident $name:literal [$($group:expr),*] $($refused:ident)?;)*) => {
        $(static $id: Element = sensor($name, &[COMMON, VALUES, TIMING $(, $group)*])$(.$refused())?;)*
        pub(super) static SENSOR: Element = Element::new("sensor", &[]).children(&[
            $(&$id,)* &TACTILE, &USER_SENSOR, &PLUGIN,
        ]);
    };
}

sensors! {
    TOUCH "touch" [SITE] refused;
    ACCELEROMETER "accelerometer" [SITE] refused;
    VELOCIMETER "velocimeter" [SITE] refused;
    GYRO "gyro" [SITE] refused;
    FORCE "force" [SITE] refused;
    TORQUE "torque" [SITE] refused;
    MAGNETOMETER "magnetometer" [SITE] refused;
    CAMPROJECTION "camprojection" [SITE, CAMERA] refused;
    RANGEFINDER "rangefinder" [SITE, CAMERA, attributes! { TEXT => data; }] refused;
    JOINTPOS "jointpos" [JOINT];
    JOINTVEL "jointvel" [JOINT];
    TENDONPOS "tendonpos" [TENDON] refused;
    TENDONVEL "tendonvel" [TENDON] refused;
    ACTUATORPOS "actuatorpos" [ACTUATOR] refused;
    ACTUATORVEL "actuatorvel" [ACTUATOR] refused;
    ACTUATORFRC "actuatorfrc" [ACTUATOR] refused;
    JOINTACTUATORFRC "jointactuatorfrc" [JOINT] refused;
    TENDONACTUATORFRC "tendonactuatorfrc" [TENDON] refused;
    BALLQUAT "ballquat" [JOINT];
    BALLANGVEL "ballangvel" [JOINT] refused;
    JOINTLIMITPOS "jointlimitpos" [JOINT] refused;
    JOINTLIMITVEL "jointlimitvel" [JOINT] refused;
    JOINTLIMITFRC "jointlimitfrc" [JOINT] refused;
    TENDONLIMITPOS "tendonlimitpos" [TENDON] refused;
    TENDONLIMITVEL "tendonlimitvel" [TENDON] refused;
    TENDONLIMITFRC "tendonlimitfrc" [TENDON] refused;
    FRAMEPOS "framepos" [OBJECT, REFERENCE];
    FRAMEQUAT "framequat" [OBJECT, REFERENCE];
    FRAMEXAXIS "framexaxis" [OBJECT, REFERENCE] refused;
    FRAMEYAXIS "frameyaxis" [OBJECT, REFERENCE] refused;
    FRAMEZAXIS "framezaxis" [OBJECT, REFERENCE] refused;
    FRAMELINVEL "framelinvel" [OBJECT, REFERENCE] refused;
    FRAMEANGVEL "frameangvel" [OBJECT, REFERENCE] refused;
    FRAMELINACC "framelinacc" [OBJECT] refused;
    FRAMEANGACC "frameangacc" [OBJECT] refused;
    SUBTREECOM "subtreecom" [BODY] refused;
    SUBTREELINVEL "subtreelinvel" [BODY] refused;
    SUBTREEANGMOM "subtreeangmom" [BODY] refused;
    INSIDESITE "insidesite" [OBJECT, SITE] refused;
    DISTANCE "distance" [PAIR] refused;
    NORMAL "normal" [PAIR] refused;
    FROMTO "fromto" [PAIR] refused;
    CONTACT "contact" [PAIR, SITE, attributes! {
        Kind::Ref("body") => subtree1 subtree2;
        TEXT => data reduce;
        INT => num;
    }] refused;
    E_POTENTIAL "e_potential" [] refused;
    E_KINETIC "e_kinetic" [] refused;
    CLOCK "clock" [];
}

static TACTILE: Element = sensor(
    "tactile",
    &[
        COMMON,
        TIMING,
        attributes! {
            REAL => cutoff;
            Kind::Ref("geom") => geom;
            Kind::Ref("mesh") => mesh;
        },
    ],
)
.refused();
static USER_SENSOR: Element = sensor(
    "user",
    &[
        COMMON,
        VALUES,
        attributes! {
            TEXT => objtype objname datatype needstage;
            INT => dim;
        },
    ],
)
.refused();
static PLUGIN: Element = sensor(
    "plugin",
    &[
        COMMON,
        attributes! {
            REAL => cutoff;
            TEXT => plugin instance objtype objname reftype refname;
        },
    ],
)
.children(&[&rest::CONFIG])
.refused();
