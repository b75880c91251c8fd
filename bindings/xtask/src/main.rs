//! Builds what is published.
//!
//! `cargo run --manifest-path bindings/xtask/Cargo.toml -- [FOLDER]` builds the package of `bindings/wasm`: the module, its
//! JavaScript and its TypeScript types, into FOLDER (`bindings/wasm/pkg`), in `node/` and `web/`. The target is added where rustup
//! is there and has it not.
//!
//! `… -- release [FOLDER]` builds the program for this machine and packs it with its licences into
//! `labspec-VERSION-TARGET.tar.gz`, with its SHA-256 beside it, in FOLDER (`target/release-archives`). The same program gives the
//! same bytes.

mod archive;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

const TARGET: &str = "wasm32-unknown-unknown";

fn main() -> ExitCode {
    let mut arguments = std::env::args_os().skip(1);
    let first = arguments.next();
    let done = match first.as_deref().and_then(|a| a.to_str()) {
        Some("release") => archive::release(arguments.next().map(PathBuf::from)),
        _ => build(first.map(PathBuf::from)),
    };
    match done {
        Ok(folder) => {
            println!("{}", folder.display());
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("xtask: {why}");
            ExitCode::FAILURE
        }
    }
}

fn build(folder: Option<PathBuf>) -> Result<PathBuf, String> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("wasm");
    let folder = folder.unwrap_or_else(|| crates.join("pkg"));
    // Where there is no rustup, the target may be there all the same: the build tells.
    let _ = Command::new("rustup").args(["target", "add", TARGET]).output();
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["build", "--release", "--quiet", "--locked", "--target", TARGET]).current_dir(&crates);
    let built = cargo.status().map_err(|e| format!("cannot run cargo: {e}"))?;
    if !built.success() {
        return Err(format!("the module was not built; is the target there? `rustup target add {TARGET}`"));
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| crates.join("target"), PathBuf::from);
    let module = target.join(TARGET).join("release/labspec_wasm.wasm");
    for kind in ["node", "web"] {
        let mut bindgen = wasm_bindgen_cli_support::Bindgen::new();
        bindgen.input_path(&module).typescript(true).remove_name_section(true).out_name("labspec");
        let chosen = match kind {
            "node" => bindgen.nodejs(true),
            _ => bindgen.web(true),
        };
        let out = folder.join(kind);
        chosen.and_then(|b| b.generate(&out)).map_err(|e| format!("{}: {e:#}", out.display()))?;
    }
    Ok(folder)
}
