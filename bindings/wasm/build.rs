//! A page starts with 16 MB: enough for most labs without growing, which makes views of memory anew.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-link-arg-cdylib=--initial-memory=16777216");
}
