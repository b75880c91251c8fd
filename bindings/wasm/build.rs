//! Sets the initial memory to 16 MB. This is enough for most labs without growth, after which all views of
//! the memory must be renewed.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-link-arg-cdylib=--initial-memory=16777216");
}
