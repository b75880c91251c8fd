//! The same sources in two folders, compiled with the program between cargo and rustc, as it is for packages.

use std::path::Path;
use std::process::Command;

#[test]
fn libraries_of_two_folders_have_the_same_bytes() {
    let folder = std::env::temp_dir().join(format!("labspec-same-bytes-{}", std::process::id()));
    let built = ["one", "two/deeper"].map(|place| library(&folder.join(place)));
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(built[0] == built[1], "the bytes depend on the folder");
}

/// Builds a library with a dependency outside of its workspace, by the program in the place of rustc.
fn library(root: &Path) -> Vec<u8> {
    let write = |path: &str, text: &str| {
        let path = root.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    let manifest = |name: &str, rest: &str| {
        format!("[package]\nname = \"{name}\"\nedition = \"2024\"\n[workspace]\n{rest}")
    };
    write("crates/inner/Cargo.toml", &manifest("inner", ""));
    // The message of the panic contains the path of the file, and the functions are two copies for two types.
    write("crates/inner/src/lib.rs", "pub fn at<T: Copy>(list: &[T], i: usize) -> T { list[i] }\n");
    let rest =
        "[lib]\ncrate-type = [\"cdylib\"]\n[dependencies]\ninner = { path = \"../../crates/inner\" }\n";
    write("bindings/outer/Cargo.toml", &manifest("outer", rest));
    let source = "#[unsafe(no_mangle)]\npub extern \"C\" fn sum(i: usize) -> u64 { inner::at(&[1, 2, 3], i) + u64::from(inner::at(&[1u8, 2], i)) }\n";
    write("bindings/outer/src/lib.rs", source);
    let target = root.join("target");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--offline", "--release"]).current_dir(root.join("bindings/outer"));
    cargo
        .env("CARGO_TARGET_DIR", &target)
        .env("CARGO_ENCODED_RUSTFLAGS", format!("--remap-path-prefix={}=here", root.display()));
    cargo.env("RUSTC_WRAPPER", env!("CARGO_BIN_EXE_labspec-xtask")).env("LABSPEC_XTASK_COMPILES", "1");
    assert!(cargo.status().unwrap().success());
    std::fs::read(target.join("release/libouter.so")).unwrap()
}
