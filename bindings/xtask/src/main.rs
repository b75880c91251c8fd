//! Builds what is published.
//!
//! `cargo run --manifest-path bindings/xtask/Cargo.toml -- [FOLDER]` builds the modules of `bindings/wasm`, each with its JavaScript
//! and its TypeScript types: the player, and the checker, which contains the player. They are written to `web/labspec/generated`,
//! where the npm package takes them, and the checker to FOLDER (`bindings/wasm/pkg`), in `node/` and `web/`. Where the package
//! `binaryen` is installed in `web/`, its `wasm-opt` makes the modules smaller. The target is added where rustup is there and has it
//! not. `LABSPEC_PROFILE=quick` builds in a minute what is slow and large.
//!
//! `… -- release [FOLDER]` builds the program for this machine and packs it with its licences into
//! `labspec-VERSION-TARGET.tar.gz`, with its SHA-256 beside it, in FOLDER (`target/release-archives`). The same program gives the
//! same bytes.

mod archive;
mod panics;

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

/// A module that is built: its folder in the package, its features, and the other forms in which it is written.
const MODULES: [(&str, &[&str], &[&str]); 2] =
    [("player", &["--no-default-features"], &[]), ("checker", &[], &["node", "web"])];

/// What the modules use, for `wasm-opt`. Never relaxed vectors: their results depend on the machine.
const FEATURES: [&str; 7] = [
    "--enable-simd",
    "--enable-bulk-memory",
    "--enable-nontrapping-float-to-int",
    "--enable-sign-ext",
    "--enable-mutable-globals",
    "--enable-reference-types",
    "--enable-multivalue",
];

fn build(folder: Option<PathBuf>) -> Result<PathBuf, String> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("wasm");
    let web = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web");
    let folder = folder.unwrap_or_else(|| crates.join("pkg"));
    let profile = std::env::var("LABSPEC_PROFILE").unwrap_or_else(|_| "release".into());
    // Where there is no rustup, the target may be there all the same: the build tells.
    let _ = Command::new("rustup").args(["target", "add", TARGET]).output();
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| crates.join("target"), PathBuf::from);
    for (name, features, others) in MODULES {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["build", "--profile", &profile, "--quiet", "--locked", "--target", TARGET]);
        let built = cargo.args(features).current_dir(&crates).status();
        if !built.map_err(|e| format!("cannot run cargo: {e}"))?.success() {
            return Err(format!(
                "the {name} was not built; is the target installed? `rustup target add {TARGET}`"
            ));
        }
        let module = target.join(TARGET).join(&profile).join("labspec_wasm.wasm");
        let inside = web.join("labspec/generated").join(name);
        let forms = others.iter().map(|other| (*other, folder.join(other)));
        // All forms have the same module: it is optimized once.
        let mut optimized: Option<[Vec<u8>; 2]> = None;
        for (form, out) in std::iter::once(("web", inside.clone())).chain(forms) {
            let mut bindgen = wasm_bindgen_cli_support::Bindgen::new();
            bindgen
                .input_path(&module)
                .typescript(true)
                .remove_name_section(profile != "release")
                .out_name("labspec");
            // The package says itself where its module lies.
            bindgen.omit_default_module_path(out == inside);
            let chosen = match form {
                "node" => bindgen.nodejs(true),
                _ => bindgen.web(true),
            };
            chosen.and_then(|b| b.generate(&out)).map_err(|e| format!("{}: {e:#}", out.display()))?;
            if profile == "release" {
                let file = out.join("labspec_bg.wasm");
                let read = || std::fs::read(&file).map_err(|e| format!("{}: {e}", file.display()));
                let before = read()?;
                match &optimized {
                    Some([same, after]) if *same == before => {
                        std::fs::write(&file, after).map_err(|e| format!("{}: {e}", file.display()))?;
                    }
                    _ => {
                        if panics::to_traps(&file)? == 0 {
                            return Err(format!("{}: no function that panics was found", file.display()));
                        }
                        optimize(&web, &file)?;
                        optimized = Some([before, read()?]);
                    }
                }
            }
        }
    }
    Ok(folder)
}

/// Makes a module smaller, where `wasm-opt` is installed. Below address 1024 is the end of the stack, which nothing addresses by
/// arithmetic: offsets can go into loads and stores.
fn optimize(web: &Path, module: &Path) -> Result<(), String> {
    let program = web.join("node_modules/.bin/wasm-opt");
    if !program.exists() {
        return Ok(());
    }
    let done = Command::new(program)
        .args(["-O3", "--low-memory-unused"])
        .args(FEATURES)
        .arg(module)
        .arg("-o")
        .arg(module)
        .status();
    match done.map_err(|e| format!("cannot run wasm-opt: {e}"))?.success() {
        true => Ok(()),
        false => Err(format!("wasm-opt refuses {}", module.display())),
    }
}
