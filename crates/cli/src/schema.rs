//! `labspec schema`.

use super::common::{CommandOutcome, Failure};
use super::stdio::print;
use clap::ValueEnum;
use labspec::spec::format;

/// Arguments of `schema`.
#[derive(clap::Args, Debug)]
pub(super) struct SchemaArguments {
    /// The kind of object
    #[arg(value_enum, default_value = "lesson")]
    of: Of,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Of {
    /// A lab
    Lab,
    /// A lab that compares integrators
    Integrators,
    /// A quiz
    Quiz,
    /// A JSON file: a lab, a quiz, or a list of them
    Lesson,
}

pub(super) fn schema(a: &SchemaArguments) -> Result<CommandOutcome, Failure> {
    let root = match a.of {
        Of::Lab => format::Root::Lab,
        Of::Integrators => format::Root::Integrators,
        Of::Quiz => format::Root::Quiz,
        Of::Lesson => format::Root::Lesson,
    };
    print(&labspec::reference::schema(root)).map(|()| CommandOutcome::Clean)
}
