//! Every rule of models, each on a page of its own: what is wrong, why it matters, a wrong and a right model. The passes of the
//! compiler say where one is broken.

pub use labspec_finding::Rule;

// Every file of this folder, by the build script.
include!(concat!(env!("OUT_DIR"), "/rules.rs"));
