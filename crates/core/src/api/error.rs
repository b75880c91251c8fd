//! Errors of calls, and their reasons.

use crate::mjcf::Finding;
#[cfg(feature = "mjcf")]
use crate::mjcf::MjcfFileError;
use crate::model::Obj;
use crate::model::reflect::{FieldId, Kind, is_writable};
use crate::model::stage::Stage;
use crate::model::state::StateError;
use crate::step::inverse::InverseError;
use crate::step::save::RestoreError;
use std::fmt;

/// The reason why a call failed. The arguments of the call are unchanged.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// The text of a model has errors: all that were found, in the order of the text.
    Model(Vec<Finding>),
    /// A file cannot be read, or its model has errors.
    #[cfg(feature = "mjcf")]
    File(MjcfFileError),
    /// The data belong to another model.
    ForeignData,
    /// There is no object of this kind and name.
    NoName {
        /// The kind of object that was searched for.
        kind: Obj,
        /// The name.
        name: String,
        /// The most similar existing name.
        nearest: Option<String>,
    },
    /// There is no object of this kind with this id.
    NoId {
        /// The kind of object that the id refers to: a kind of MJCF object, "keyframe", "contact".
        kind: &'static str,
        /// The id.
        id: usize,
        /// The number of such objects.
        count: usize,
    },
    /// There is no field of this name.
    NoField(String),
    /// The plan does not compute this field, so that its values are not current.
    LeftOut {
        /// The field.
        field: FieldId,
        /// The stage that would compute it.
        stage: Stage,
    },
    /// The field cannot be written: the engine computes it, or uses it as an index.
    NotWritable(FieldId),
    /// A list has the wrong length.
    Length {
        /// A description of the list.
        what: &'static str,
        /// The required number of elements.
        expected: usize,
        /// The actual number of elements.
        found: usize,
    },
    /// A number that is not valid for its parameter.
    Value {
        /// The parameter.
        what: &'static str,
        /// The condition that the number must satisfy.
        must: &'static str,
    },
    /// Inverse dynamics failed.
    Inverse(InverseError),
    /// A state cannot be read or written.
    State(StateError),
    /// Saved data cannot be restored.
    Restore(RestoreError),
    /// The build does not contain the general algorithm for convex shapes (feature `convex`), and a pair of geoms needs it.
    NoConvex {
        /// The first geom.
        geom1: usize,
        /// The second geom, which may touch the first or whose distance is requested.
        geom2: usize,
    },
    /// The bytes are not a compiled model of this version, or they were changed.
    NotAModel,
}

impl Error {
    /// The findings in the text of a model. Empty for any other error.
    pub fn diagnostics(&self) -> &[Finding] {
        match self {
            Error::Model(list) => list,
            #[cfg(feature = "mjcf")]
            Error::File(MjcfFileError::Model { diagnostics, .. }) => diagnostics,
            _ => &[],
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Model(list) => {
                for (i, d) in list.iter().enumerate() {
                    let end = if i + 1 < list.len() { "\n" } else { "" };
                    write!(f, "byte {}: {}{end}", d.span.start, d.message)?;
                }
                Ok(())
            }
            #[cfg(feature = "mjcf")]
            Error::File(e) => e.fmt(f),
            Error::ForeignData => f.write_str(
                "the data belong to another model: make data for this one with `Data::new(&model)`",
            ),
            Error::NoName { kind, name, nearest } => {
                let kind = format!("{kind:?}").to_ascii_lowercase();
                write!(f, "the model has no {kind} named `{name}`")?;
                nearest.as_ref().map_or(Ok(()), |n| write!(f, "; did you mean `{n}`?"))
            }
            Error::NoId { kind, id, count } => {
                write!(f, "{kind} {id} does not exist: the model has {count}, counted from 0")
            }
            Error::NoField(name) => write!(f, "model and data have no field `{name}`"),
            Error::LeftOut { field, stage } => write!(
                f,
                "`{}` cannot be read: the plan may skip the {stage:?} stage, so its value may be out of date; add it to the `reads` of the plan's `AccessSet`",
                field.info().name
            ),
            Error::NotWritable(field) => write!(
                f,
                "`{}` cannot be written: {}",
                field.info().name,
                match field.info().kind {
                    _ if is_writable(*field) => "it is a field of the data, not of the model",
                    Kind::Structure => "it is fixed when the model is compiled",
                    _ => "the engine computes it",
                }
            ),
            Error::Length { what, expected, found } => {
                write!(f, "{what} must have {expected} numbers, but has {found}")
            }
            Error::Value { what, must } => write!(f, "{what} must be {must}"),
            Error::Inverse(e) => e.fmt(f),
            Error::State(e) => e.fmt(f),
            Error::Restore(e) => e.fmt(f),
            Error::NoConvex { geom1, geom2 } => write!(
                f,
                "the contacts or the distance of geoms {geom1} and {geom2} need the general algorithm for convex shapes, which this build does not include: build the engine with its feature `convex`, or use spheres, capsules, boxes and planes"
            ),
            Error::NotAModel => f.write_str(
                "the bytes are not a compiled model of this version of the engine: compile the model again and store the result",
            ),
        }
    }
}

impl std::error::Error for Error {}

impl From<InverseError> for Error {
    fn from(e: InverseError) -> Error {
        Error::Inverse(e)
    }
}

impl From<StateError> for Error {
    fn from(e: StateError) -> Error {
        Error::State(e)
    }
}

impl From<RestoreError> for Error {
    fn from(e: RestoreError) -> Error {
        Error::Restore(e)
    }
}

/// The message for people, for hosts whose errors are strings.
impl From<Error> for String {
    fn from(e: Error) -> String {
        e.to_string()
    }
}
