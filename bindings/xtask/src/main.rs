//! Builds the published artifacts.
//!
//! `cargo run --manifest-path bindings/xtask/Cargo.toml -- [FOLDER]` builds the modules of `bindings/wasm`, each with its
//! JavaScript and its TypeScript types: the player, the player without the MJCF compiler and convex shapes, and the checker, which
//! contains the player. They are written to
//! `web/labspec/generated`, where the npm package reads them, and the checker to FOLDER (`bindings/wasm/pkg`), in `node/` and
//! `web/`. If the package `binaryen` is installed in `web/`, its `wasm-opt` reduces the size of the modules. If rustup is
//! installed, the compilation target is added if necessary. `LABSPEC_PROFILE=quick` builds slow and large modules in a minute,
//! `LABSPEC_MODULE=player` only that module, and `LABSPEC_NAMES=1` keeps the names of functions, for profilers.
//!
//! `… -- release [FOLDER [PART…]]` writes a release into FOLDER (`target/release-archives`): the program for this machine and, where the
//! tools are installed, for 64-bit ARM, with manual pages, completions and the scripts of pages; the C library; all crates; the npm
//! packages; the wheel; the editor's extension; the lists of components (CycloneDX); and the SHA-256 of each. Archives are tried here,
//! also on an emulated old processor if `qemu-x86_64` is installed. `LABSPEC_PROFILE=quick` tries it without optimization.
//!
//! `… -- page` builds the modules, then the npm packages up to the scripts and styles of pages, which `labspec build` and `labspec
//! preview` find in `web/site/dist`.
//!
//! `… -- preview [LESSONS]` does the same once, then serves the lessons (`specs/lessons`) by `labspec preview`.
//!
//! `… -- site [FOLDER]` does the same once, then builds the documentation and the course of this repository by `labspec build`, in FOLDER
//! (`docs/site`).

mod function_order;
mod pack;
mod page;
mod panics;
mod release;
mod reproducible;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

const TARGET: &str = "wasm32-unknown-unknown";

fn main() -> ExitCode {
    if reproducible::is_compiler() {
        return reproducible::compile();
    }
    let mut arguments = std::env::args_os().skip(1);
    let first = arguments.next();
    let done = match first.as_deref().and_then(|a| a.to_str()) {
        Some("release") => {
            let folder = arguments.next().map(PathBuf::from);
            let parts: Vec<String> = arguments.map(|part| part.to_string_lossy().into_owned()).collect();
            release::release(folder, &parts, || page::built(|| build(None)))
        }
        Some("page") => build(None).and_then(|_| page::page()),
        Some("preview") => page::preview(arguments.next().map(PathBuf::from), || build(None)),
        Some("site") => page::site(arguments.next().map(PathBuf::from), || build(None)),
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

/// A module of the npm package.
struct Module {
    /// Its folder in the package.
    name: &'static str,
    /// Arguments of cargo.
    features: &'static [&'static str],
    /// Formats in which it is written in addition.
    others: &'static [&'static str],
}

const MODULES: [Module; 3] = [
    Module { name: "player", features: &["--no-default-features", "--features", "mjcf"], others: &[] },
    Module { name: "compiled", features: &["--no-default-features"], others: &[] },
    Module { name: "checker", features: &[], others: &["node", "web"] },
];

/// The WebAssembly features of the modules, for `wasm-opt`. Relaxed SIMD is never used, because its
/// results depend on the machine.
const FEATURES: [&str; 7] = [
    "--enable-simd",
    "--enable-bulk-memory",
    "--enable-nontrapping-float-to-int",
    "--enable-sign-ext",
    "--enable-mutable-globals",
    "--enable-reference-types",
    "--enable-multivalue",
];

/// How `wasm-opt` optimizes. A function is compiled when it is first called, so that large functions should not contain others that
/// run rarely. No pointer that is computed by arithmetic is below address 1024, which is the end of the stack: offsets can be part of
/// loads and stores.
const OPTIONS: [&str; 3] = ["-O3", "--low-memory-unused", "--one-caller-inline-max-function-size=200"];

/// Whether the modules keep the names of functions: `LABSPEC_NAMES`.
fn keeps_names() -> bool {
    std::env::var_os("LABSPEC_NAMES").is_some()
}

fn build(folder: Option<PathBuf>) -> Result<PathBuf, String> {
    let folder = folder.unwrap_or_else(|| crates().join("pkg"));
    // Without rustup, the target may be installed in another way; otherwise the build reports that it is missing.
    let _ = Command::new("rustup").args(["target", "add", TARGET]).output();
    let only = std::env::var("LABSPEC_MODULE").ok();
    if let Some(unknown) = only.as_deref().filter(|only| MODULES.iter().all(|module| module.name != *only)) {
        return Err(format!("LABSPEC_MODULE is player, compiled or checker, not {unknown}"));
    }
    let chosen = MODULES.iter().filter(|module| only.as_deref().is_none_or(|only| only == module.name));
    // Most of the time of a module is one thread of the linker: the modules are built at the same time.
    std::thread::scope(|scope| {
        let building: Vec<_> = chosen.map(|module| scope.spawn(|| module.build(&folder))).collect();
        building
            .into_iter()
            .try_for_each(|module| module.join().unwrap_or_else(|_| Err("a build panicked".into())))
    })?;
    unpacker(&web(), &web().join("labspec/generated"))?;
    Ok(folder)
}

/// The crate of the modules.
fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("wasm")
}

fn web() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web")
}

impl Module {
    /// Builds the module in all its formats: for the npm package, and in folders of `folder`.
    fn build(&self, folder: &Path) -> Result<(), String> {
        let profile = std::env::var("LABSPEC_PROFILE").unwrap_or_else(|_| "release".into());
        let compiled = self.compile(&profile)?;
        let inside = web().join("labspec/generated").join(self.name);
        let forms = self.others.iter().map(|other| (*other, folder.join(other)));
        // All formats contain the same module, so it is optimized once.
        let mut optimized: Option<[Vec<u8>; 2]> = None;
        for (form, out) in std::iter::once(("web", inside.clone())).chain(forms) {
            let mut bindgen = wasm_bindgen_cli_support::Bindgen::new();
            bindgen
                .input_path(&compiled)
                .typescript(true)
                .remove_name_section(profile != "release")
                .out_name("labspec");
            // The package determines the location of its module itself.
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
                        optimize(&web(), &file)?;
                        optimized = Some([before, read()?]);
                    }
                }
            }
        }
        packed(&inside.join("labspec_bg.wasm"))
    }

    /// The module as cargo builds it, in a folder of its own: builds of the same folder wait for each other.
    fn compile(&self, profile: &str) -> Result<PathBuf, String> {
        let target =
            std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| crates().join("target"), PathBuf::from);
        let target = target.join(self.name);
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["build", "--profile", profile, "--quiet", "--locked", "--target", TARGET]);
        cargo.arg("--target-dir").arg(&target);
        // With the flags of `.cargo/config.toml`.
        let flags = reproducible::same_paths(&page::root(), &target);
        reproducible::same_names(&mut cargo)?;
        cargo.arg("--config").arg(format!("target.{TARGET}.rustflags={flags:?}"));
        let built = cargo.args(self.features).current_dir(crates()).status();
        if !built.map_err(|e| format!("cannot run cargo: {e}"))?.success() {
            return Err(format!(
                "the {} was not built; is the target installed? `rustup target add {TARGET}`",
                self.name
            ));
        }
        Ok(target.join(TARGET).join(profile).join("labspec_wasm.wasm"))
    }
}

/// Writes a module beside itself in the order in which scripts contain it: see [`pack`].
fn packed(module: &Path) -> Result<(), String> {
    let failed = |e: std::io::Error| format!("{}: {e}", module.display());
    let bytes = std::fs::read(module).map_err(failed)?;
    let packed = pack::pack(&bytes).map_err(|why| format!("{}: {why}", module.display()))?;
    std::fs::write(module.with_extension("packed"), packed).map_err(failed)
}

/// Builds the module that restores packed modules in a page.
fn unpacker(web: &Path, generated: &Path) -> Result<(), String> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("unpack");
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| source.join("target"), PathBuf::from);
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["build", "--release", "--quiet", "--locked", "--target", TARGET]).current_dir(&source);
    let flags = reproducible::same_paths(&page::root(), &target);
    cargo.arg("--config").arg(format!("target.{TARGET}.rustflags={flags:?}"));
    if !cargo.status().map_err(|e| format!("cannot run cargo: {e}"))?.success() {
        return Err("what restores packed modules was not built".into());
    }
    let file = generated.join("unpack.wasm");
    std::fs::copy(target.join(TARGET).join("release/labspec_unpack.wasm"), &file)
        .map_err(|e| format!("{}: {e}", file.display()))?;
    panics::to_traps(&file)?;
    optimize(web, &file)
}

/// Makes a module smaller, where `wasm-opt` is installed: optimizes it, then puts functions that share code next to each other.
fn optimize(web: &Path, module: &Path) -> Result<(), String> {
    let program = web.join("node_modules/.bin/wasm-opt");
    if !program.exists() {
        return Ok(());
    }
    let run = |options: &[&str]| {
        let done =
            Command::new(&program).args(options).args(FEATURES).arg(module).arg("-o").arg(module).status();
        match done.map_err(|e| format!("cannot run wasm-opt: {e}"))?.success() {
            true => Ok(()),
            false => Err(format!("wasm-opt refuses {}", module.display())),
        }
    };
    if keeps_names() {
        return run(&[&["-g"], &OPTIONS[..]].concat());
    }
    run(&OPTIONS)?;
    function_order::name_by_place(module)?;
    run(&["--reorder-functions-by-name"])
}
