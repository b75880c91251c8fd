//! The rules of the language over the engine: what only somebody knows who knows both, each on a page of its own.

pub use labspec_finding::Rule;

// Every file of this folder, by the build script.
include!(concat!(env!("OUT_DIR"), "/rules.rs"));
