//! Parts of the JSON Schemas of the program's reports. No value has one of these types: fields name them in their attribute
//! `schemars(with = …)`.

use labspec::ledger::State;
use labspec::report::{NonfiniteEntries, NonfiniteName, key};
use labspec::stress::{FaultKind, InteractionKind};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::marker::PhantomData;

/// The key under which the schema of a number has the schema of its name, until the object of the number is complete.
pub(super) const NONFINITE: &str = "x-nonfinite";

/// A number that may be NaN or infinite: then it is `null`, and the entry `nonfinite` of its object names it. The object has
/// this entry because of such a number.
pub(super) struct AnyNumber;

impl JsonSchema for AnyNumber {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "number".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({"type": ["number", "null"], (NONFINITE): generator.subschema_for::<NonfiniteName>()})
    }
}

/// A list of such numbers, or of numbers that may be missing.
pub(super) struct AnyNumbers;

impl JsonSchema for AnyNumbers {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "numbers".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut list = generator.subschema_for::<Vec<Option<f64>>>();
        list.insert(NONFINITE.into(), generator.subschema_for::<NonfiniteEntries>().to_value());
        list
    }
}

/// The value of a control.
pub(super) struct ControlValue;

impl JsonSchema for ControlValue {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "control".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({"type": ["number", "boolean", "string"]})
    }
}

/// A fixed set of words in reports.
pub(super) trait Words {
    /// The name of the definition.
    const NAME: &'static str;

    /// The words.
    fn list_words() -> Vec<String>;
}

/// A word of a set.
pub(super) struct WordOf<T>(PhantomData<T>);

impl<T: Words> JsonSchema for WordOf<T> {
    fn schema_name() -> Cow<'static, str> {
        T::NAME.into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({"type": "string", "enum": T::list_words()})
    }
}

impl Words for State {
    const NAME: &'static str = "state";

    fn list_words() -> Vec<String> {
        let mut words: Vec<String> = State::ALL.map(|state| key(state.as_str())).into();
        // What is true is so by one evidence or the other.
        words.dedup();
        words
    }
}

impl Words for InteractionKind {
    const NAME: &'static str = "interaction";

    fn list_words() -> Vec<String> {
        InteractionKind::ALL.map(|kind| key(kind.description())).into()
    }
}

impl Words for FaultKind {
    const NAME: &'static str = "kind";

    fn list_words() -> Vec<String> {
        FaultKind::ALL.map(|kind| key(kind.description())).into()
    }
}

/// The cell of the map of stability where nothing goes wrong.
pub(super) const FINE: &str = "fine";
/// The cell of the map of stability that was not computed.
pub(super) const UNKNOWN: &str = "unknown";

/// A cell of the map of stability.
pub(super) struct Cell;

impl Words for Cell {
    const NAME: &'static str = "cell";

    fn list_words() -> Vec<String> {
        let of_map = [FINE, UNKNOWN].map(String::from).into_iter();
        of_map.chain(FaultKind::list_words()).collect()
    }
}

/// What a comparison has as the truth.
pub(super) struct Truth;

impl Words for Truth {
    const NAME: &'static str = "truth";

    fn list_words() -> Vec<String> {
        TRUTHS.map(key).into()
    }
}

/// What a number is compared with: the reference, or its closed form.
pub(super) const TRUTHS: [&str; 2] = ["tiny steps", "closed form"];
