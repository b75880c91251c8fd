//! Lint rules for models. Each rule has its own file: what is wrong, why it matters, a wrong and a right model. The passes of the
//! compiler report violations.

pub use labspec_finding::Rule;

// The build script lists the files of this folder.
include!(concat!(env!("OUT_DIR"), "/rules.rs"));
