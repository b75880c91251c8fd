//! The machines for which a release is built, and how cargo builds for them.

use super::Release;
use crate::reproducible::{same_names, same_paths};
use std::path::{Path, PathBuf};
use std::process::Command;

/// A kind of machine.
pub(super) struct Platform {
    /// The target as rustc names it.
    pub(super) triple: String,
    /// The processors for which programs are built: the first of them is every processor of the target.
    pub(super) processors: &'static [Processor],
    /// How its programs are built and run on this machine.
    cross: Option<Cross>,
}

/// A processor: how rustc names it, or its default; and the instructions that `labspec --version` says.
pub(super) struct Processor {
    pub(super) name: Option<&'static str>,
    pub(super) instructions: &'static str,
}

/// How programs for another machine are linked and run here.
#[derive(Clone, Copy)]
struct Cross {
    linker: &'static str,
    objcopy: &'static str,
    emulator: &'static str,
    /// Where the emulator finds the libraries of the machine.
    libraries: &'static str,
    /// How to get the tools on Debian.
    install: &'static str,
}

const X86_64: &[Processor] = &[
    Processor { name: Some("x86-64"), instructions: "SSE2" },
    Processor { name: Some(OF_TESTS), instructions: "AVX2" },
];

/// The processor of `.cargo/config.toml`.
const OF_TESTS: &str = "x86-64-v3";

const DEFAULT: &[Processor] = &[Processor { name: None, instructions: "" }];

/// The target that is built on another machine, if its tools are installed.
const OTHER: (&str, Cross) = (
    "aarch64-unknown-linux-gnu",
    Cross {
        linker: "aarch64-linux-gnu-gcc",
        objcopy: "aarch64-linux-gnu-objcopy",
        emulator: "qemu-aarch64",
        libraries: "/usr/aarch64-linux-gnu",
        install: "rustup target add aarch64-unknown-linux-gnu && apt-get install gcc-aarch64-linux-gnu qemu-user",
    },
);

/// This machine, and those for which programs can be built here. What is left out is printed.
pub(super) fn all() -> Result<Vec<Platform>, String> {
    let host = host()?;
    let processors = if host.starts_with("x86_64-") && cfg!(unix) { X86_64 } else { DEFAULT };
    let (triple, cross) = OTHER;
    let mut all = vec![Platform { triple: host.clone(), processors, cross: None }];
    if triple == host {
        return Ok(all);
    }
    if has_standard_library(triple) && is_installed(cross.linker) {
        all.push(Platform { triple: triple.into(), processors: DEFAULT, cross: Some(cross) });
    } else {
        eprintln!("xtask: skipped: {triple}: its tools are not installed: {}", cross.install);
    }
    Ok(all)
}

/// Whether this machine runs the builds for newer processors.
pub(super) fn here_is_fast() -> bool {
    #[cfg(target_arch = "x86_64")]
    let fast = std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    let fast = true;
    fast
}

/// Whether a program of this name can be run.
pub(super) fn is_installed(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok()
}

/// The output of rustc.
fn rustc(arguments: &[&str]) -> Result<String, String> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    output(Path::new(&rustc), arguments)
}

/// The target for which this machine builds.
fn host() -> Result<String, String> {
    let text = rustc(&["-vV"])?;
    let host = text.lines().find_map(|line| line.strip_prefix("host: ").map(String::from));
    host.ok_or_else(|| "rustc does not say what it builds for".into())
}

fn has_standard_library(triple: &str) -> bool {
    rustc(&["--print", "target-libdir", "--target", triple]).is_ok_and(|path| Path::new(path.trim()).exists())
}

/// The output of a program that succeeds.
pub(super) fn output(program: &Path, arguments: &[&str]) -> Result<String, String> {
    output_of(Command::new(program).args(arguments))
}

/// The output of a command that succeeds.
pub(super) fn output_of(command: &mut Command) -> Result<String, String> {
    let done =
        command.output().map_err(|e| format!("cannot run {}: {e}", command.get_program().display()))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    match done.status.success() {
        true => Ok(text(&done.stdout)),
        false => Err(format!("{command:?}: {}", text(&done.stderr))),
    }
}

impl Platform {
    /// Whether it is this machine.
    pub(super) fn is_here(&self) -> bool {
        self.cross.is_none()
    }

    /// The program that separates symbols from programs, if it is installed.
    pub(super) fn objcopy(&self) -> Option<&'static str> {
        Some(self.cross.map_or("objcopy", |cross| cross.objcopy)).filter(|name| is_installed(name))
    }

    /// The arguments of rustc with which a library is linked without its symbols.
    pub(super) fn without_symbols(&self) -> &'static [&'static str] {
        if self.objcopy().is_some() { &["-C", "link-arg=-s"] } else { &[] }
    }

    /// The arguments with which cargo and maturin read `release.toml`: none if nothing is optimized.
    pub(super) fn sizes(release: &Release) -> Vec<std::ffi::OsString> {
        match release.quick {
            true => Vec::new(),
            false => vec!["--config".into(), release.root.join("bindings/xtask/release.toml").into()],
        }
    }

    /// Whether a release that is only tried takes what is built for a processor as the tests build it, with the settings of
    /// `.cargo/config.toml` and in their folder: nothing that they have built is built again.
    fn is_built_as_for_tests(&self, release: &Release, processor: &Processor) -> bool {
        release.quick && self.is_here() && processor.name == Some(OF_TESTS)
    }

    /// The argument for cargo and maturin, and the name of the folder of what they build.
    pub(super) fn profile(
        &self,
        release: &Release,
        processor: &Processor,
    ) -> (&'static [&'static str], &'static str) {
        match self.is_built_as_for_tests(release, processor) {
            true => (&[], "debug"),
            false => (&["--release"], "release"),
        }
    }

    /// The folder in which everything is built for a processor: program, library and wheel share packages of
    /// others.
    pub(super) fn folder(&self, release: &Release, processor: &Processor) -> PathBuf {
        if self.is_built_as_for_tests(release, processor) {
            return release.target.clone();
        }
        release.target.join(format!("for-{}", processor.name.unwrap_or(&self.triple)))
    }

    /// A command of cargo that builds for a processor, and the folder of what it builds.
    pub(super) fn cargo(
        &self,
        release: &Release,
        processor: &Processor,
    ) -> Result<(Command, PathBuf), String> {
        let folder = self.folder(release, processor);
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.current_dir(&release.root);
        self.settings(&mut cargo, release, processor)?;
        cargo.env("CARGO_TARGET_DIR", &folder);
        let (_, name) = self.profile(release, processor);
        let built = match self.cross {
            Some(_) => folder.join(&self.triple).join(name),
            None => folder.join(name),
        };
        Ok((cargo, built))
    }

    /// The environment of a command that calls cargo.
    pub(super) fn settings(
        &self,
        command: &mut Command,
        release: &Release,
        processor: &Processor,
    ) -> Result<(), String> {
        if self.is_built_as_for_tests(release, processor) {
            return Ok(());
        }
        // Symbols are needed only for profiling and for reading a crash. Where they can be separated afterwards (the program has them in an
        // archive), packages of others on which program, library and wheel depend are built with the same settings, and so once.
        let strip = if self.objcopy().is_some() { "none" } else { "symbols" };
        command.env("CARGO_PROFILE_RELEASE_STRIP", strip);
        if release.quick {
            command.env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "0").env("CARGO_PROFILE_RELEASE_LTO", "off");
            command.env("CARGO_PROFILE_RELEASE_DEBUG", "0");
            command.env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "256");
        }
        // These flags replace those of `.cargo/config.toml`.
        let mut flags = same_paths(&release.root, &release.target);
        flags.extend(processor.name.map(|name| format!("-Ctarget-cpu={name}")));
        command.env_remove("RUSTFLAGS").env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"));
        same_names(command)?;
        if let Some(cross) = self.cross {
            command.env("CARGO_BUILD_TARGET", &self.triple);
            let triple = self.triple.to_uppercase().replace('-', "_");
            command.env(format!("CARGO_TARGET_{triple}_LINKER"), cross.linker);
        }
        Ok(())
    }

    /// A command that runs a program of this platform here, or `None` if it cannot be run.
    pub(super) fn run(&self, program: &Path) -> Option<Command> {
        let Some(cross) = self.cross else { return Some(Command::new(program)) };
        if !is_installed(cross.emulator) {
            eprintln!("xtask: skipped: programs for {} are not tried: {}", self.triple, cross.install);
            return None;
        }
        let mut command = Command::new(cross.emulator);
        command.args(["-L", cross.libraries]).arg(program);
        Some(command)
    }
}
