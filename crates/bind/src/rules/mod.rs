//! Lint rules that need both the language and the engine. Each rule has its own file.

pub use labspec_finding::Rule;

// The build script lists the files of this folder.
include!(concat!(env!("OUT_DIR"), "/rules.rs"));
