//! The header of the C library: `LABSPEC_BLESS=1 cargo test -p labspec-c-header` writes it.
#![cfg(test)]
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

fn package() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn header() -> String {
    let config = cbindgen::Config::from_file(package().join("cbindgen.toml")).unwrap();
    let builder = cbindgen::Builder::new().with_config(config).with_src(package().join("src/lib.rs"));
    let mut text = Vec::new();
    builder.generate().unwrap().write(&mut text);
    String::from_utf8(text).unwrap()
}

fn read(path: impl AsRef<Path>) -> String {
    std::fs::read_to_string(package().join(path)).unwrap()
}

#[test]
fn the_header_is_current() {
    let path = package().join("include/labspec.h");
    if std::env::var_os("LABSPEC_BLESS").is_some() {
        std::fs::write(&path, header()).unwrap();
    }
    assert!(
        read(&path) == header(),
        "include/labspec.h is not that of the sources: run `LABSPEC_BLESS=1 cargo test -p labspec-c-header`"
    );
}

/// The names of all entry points.
fn functions() -> Vec<String> {
    let sources = std::fs::read_dir(package().join("src")).unwrap().map(|file| read(file.unwrap().path()));
    let text: String = sources.collect();
    let starts = text.split("extern \"C\" fn ").skip(1);
    starts.map(|rest| rest[..rest.find('(').unwrap()].to_string()).collect()
}

#[test]
fn every_function_is_in_the_header() {
    let header = read("include/labspec.h");
    let missing: Vec<String> =
        functions().into_iter().filter(|name| !header.contains(&format!("{name}("))).collect();
    assert!(missing.is_empty(), "not in the header: {missing:?}");
}

#[test]
fn every_function_is_called_with_wrong_arguments() {
    let hostile = read("test/hostile.c") + &read("test/expect.h");
    let missing: Vec<String> =
        functions().into_iter().filter(|name| !hostile.contains(&format!("{name}("))).collect();
    assert!(missing.is_empty(), "not in test/hostile.c: {missing:?}");
}
