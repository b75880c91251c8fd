//! Every rule of models, each on a page of its own: what is wrong, why it matters, a wrong and a right model. The passes of the
//! compiler say where one is broken.

pub use labspec_finding::Rule;

macro_rules! rules {
    ($($file:ident :: $name:ident,)*) => {
        $(mod $file; pub use $file::$name;)*
        /// Every rule.
        pub const ALL: &[&Rule] = &[$($name),*];
    };
}

rules! {
    mjcf_xml::XML,
    mjcf_limit::LIMIT,
    mjcf_file::FILE,
    mjcf_file_outside::OUTSIDE,
    mjcf_text::TEXT,
    mjcf_no_effect::NO_EFFECT,
    mjcf_unknown_element::UNKNOWN_ELEMENT,
    mjcf_misplaced_element::MISPLACED_ELEMENT,
    mjcf_repeated_element::REPEATED_ELEMENT,
    mjcf_unknown_attribute::UNKNOWN_ATTRIBUTE,
    mjcf_missing_attribute::MISSING_ATTRIBUTE,
    mjcf_conflicting_attributes::CONFLICT,
    mjcf_not_supported::NOT_SUPPORTED,
    mjcf_number::NUMBER,
    mjcf_count::COUNT,
    mjcf_keyword::KEYWORD,
    mjcf_value::VALUE,
    mjcf_duplicate_name::DUPLICATE_NAME,
    mjcf_unknown_name::UNKNOWN_NAME,
    mjcf_unknown_class::UNKNOWN_CLASS,
    mjcf_copy::COPY,
    mjcf_orientation::ORIENTATION,
    mjcf_joint::JOINT,
    mjcf_mocap::MOCAP,
    mjcf_mesh::MESH,
    mjcf_skin::SKIN,
    mjcf_hfield::HFIELD,
    mjcf_geom::GEOM,
    mjcf_inertia::INERTIA,
    mjcf_tendon::TENDON,
    mjcf_equality::EQUALITY,
    mjcf_actuator::ACTUATOR,
    mjcf_sensor::SENSOR,
    mjcf_keyframe::KEYFRAME,
}
