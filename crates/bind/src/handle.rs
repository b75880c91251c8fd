//! Encoding of objects and collections as ids of the language: small, dense, and decoded without a table.

use labspec_core::Obj;
use labspec_core::reflect::Object;
use labspec_expr::{CollectionId, ObjectId};

/// `model` or `data`: which fields a named object has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FieldOwner {
    Model,
    Data,
}

/// An object with members.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HandleTarget {
    /// `model`, `model.opt`, `model.stat`, `data`.
    Struct(Object),
    /// `mj`, `sim` or `lib`: the index of its name in [`super::functions::OBJECTS`].
    Functions(usize),
    /// `mj.mjtObj`: the index of an enumeration in [`super::enums::ENUMS`].
    Enum(usize),
    /// `mj.mjtObj.mjOBJ_BODY`: the indexes of an enumeration and its member.
    Member(usize, usize),
    /// `data.joint("hinge")`: one object of the model.
    Named(FieldOwner, Obj, usize),
}

/// The kinds of named objects, and their nouns in the language.
pub(super) const KINDS: [(Obj, &str); 21] = [
    (Obj::Body, "body"),
    (Obj::Joint, "joint"),
    (Obj::Geom, "geom"),
    (Obj::Site, "site"),
    (Obj::Camera, "camera"),
    (Obj::Light, "light"),
    (Obj::Mesh, "mesh"),
    (Obj::Skin, "skin"),
    (Obj::HField, "hfield"),
    (Obj::Texture, "texture"),
    (Obj::Material, "material"),
    (Obj::Pair, "pair"),
    (Obj::Exclude, "exclude"),
    (Obj::Equality, "equality"),
    (Obj::Tendon, "tendon"),
    (Obj::Actuator, "actuator"),
    (Obj::Sensor, "sensor"),
    (Obj::Numeric, "numeric"),
    (Obj::Text, "text"),
    (Obj::Tuple, "tuple"),
    (Obj::Key, "key"),
];

/// Alternative nouns, as in MuJoCo's own bindings.
const ALIASES: [(&str, &str); 8] = [
    ("jnt", "joint"),
    ("cam", "camera"),
    ("tex", "texture"),
    ("mat", "material"),
    ("eq", "equality"),
    ("ten", "tendon"),
    ("keyframe", "key"),
    ("hf", "hfield"),
];

/// The kind of object that a noun denotes.
pub(super) fn kind_of(word: &str) -> Option<Obj> {
    let word = ALIASES.iter().find(|(alias, _)| *alias == word).map_or(word, |(_, noun)| noun);
    KINDS.iter().find(|(_, noun)| *noun == word).map(|(kind, _)| *kind)
}

const STRUCTS: [Object; 4] = [Object::Model, Object::Option, Object::Statistic, Object::Data];
const FUNCTIONS: u32 = 0x100;
const ENUMS: u32 = 0x200;
/// The first id of the members of enumerations, 256 ids for each enumeration.
const MEMBERS: u32 = 0x1_0000;
const NAMED: u32 = 1 << 31;
const DATA_SIDE: u32 = 1 << 30;
const INDEX: u32 = (1 << 24) - 1;

/// Returns the id of an object.
pub(super) fn encode(target: HandleTarget) -> ObjectId {
    ObjectId(match target {
        HandleTarget::Struct(object) => STRUCTS.iter().position(|&s| s == object).unwrap_or(0) as u32,
        HandleTarget::Functions(i) => FUNCTIONS + i as u32,
        HandleTarget::Enum(i) => ENUMS + i as u32,
        HandleTarget::Member(i, j) => MEMBERS + ((i as u32) << 8) + j as u32,
        HandleTarget::Named(side, kind, index) => {
            let kind = KINDS.iter().position(|&(k, _)| k == kind).unwrap_or(0) as u32;
            let side = if side == FieldOwner::Data { DATA_SIDE } else { 0 };
            NAMED | side | kind << 24 | (index as u32 & INDEX)
        }
    })
}

/// Returns the object of an id, or `None` if no object has the id.
pub(super) fn decode(ObjectId(id): ObjectId) -> Option<HandleTarget> {
    if id & NAMED != 0 {
        let side = if id & DATA_SIDE != 0 { FieldOwner::Data } else { FieldOwner::Model };
        let (kind, _) = *KINDS.get((id >> 24 & 0x3f) as usize)?;
        return Some(HandleTarget::Named(side, kind, (id & INDEX) as usize));
    }
    if id >= MEMBERS {
        return Some(HandleTarget::Member(((id - MEMBERS) >> 8) as usize, (id & 0xff) as usize));
    }
    if id >= ENUMS {
        return Some(HandleTarget::Enum((id - ENUMS) as usize));
    }
    if id >= FUNCTIONS {
        return Some(HandleTarget::Functions((id - FUNCTIONS) as usize));
    }
    STRUCTS.get(id as usize).map(|&s| HandleTarget::Struct(s))
}

/// The index of the object whose id is passed to a function as a number.
pub(super) fn index_of(number: f64) -> usize {
    (number as u32 & INDEX) as usize
}

/// Returns the collection of all objects of a kind.
pub(super) fn collection(side: FieldOwner, kind: Obj) -> CollectionId {
    let kind = KINDS.iter().position(|&(k, _)| k == kind).unwrap_or(0) as u32;
    CollectionId(kind << 1 | u32::from(side == FieldOwner::Data))
}

/// Returns the side, the kind and the noun of a collection.
pub(super) fn of_collection(CollectionId(id): CollectionId) -> Option<(FieldOwner, Obj, &'static str)> {
    let (kind, noun) = *KINDS.get((id >> 1) as usize)?;
    Some((if id & 1 == 1 { FieldOwner::Data } else { FieldOwner::Model }, kind, noun))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_decode_to_what_was_encoded() {
        for (i, &(kind, _)) in KINDS.iter().enumerate() {
            for side in [FieldOwner::Model, FieldOwner::Data] {
                let target = HandleTarget::Named(side, kind, 1000 * i + 7);
                assert_eq!(decode(encode(target)), Some(target));
                assert_eq!(index_of(f64::from(encode(target).0)), 1000 * i + 7);
                assert_eq!(of_collection(collection(side, kind)).map(|(s, k, _)| (s, k)), Some((side, kind)));
            }
        }
        for target in [
            HandleTarget::Struct(Object::Data),
            HandleTarget::Struct(Object::Option),
            HandleTarget::Functions(2),
            HandleTarget::Enum(3),
            HandleTarget::Member(3, 70),
        ] {
            assert_eq!(decode(encode(target)), Some(target));
        }
    }
}
