//! Builds that do not depend on the folder in which they are made: paths of this machine are replaced, and crates have the same names.
//!
//! cargo gives each crate a hash (`-C metadata`), which is part of the names of its functions and so determines their order. For a crate
//! outside of the workspace that is built (here the crates of the repository, for a package in `bindings/`), cargo computes it from the
//! path. This program stands between cargo and rustc (`RUSTC_WRAPPER`) and gives each crate a hash of what tells it from the others.

use sha2::{Digest, Sha256};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Set where this program is called by cargo, in the place of rustc.
const COMPILES: &str = "LABSPEC_XTASK_COMPILES";

/// What cargo passes to rustc before the hash of a crate.
const METADATA: &str = "metadata=";

/// The flags of rustc that tell crates of one package from each other.
const DISTINCT: [&str; 4] = ["--crate-name", "--crate-type", "--target", "--cfg"];

/// Lets a command of cargo, or one that calls cargo, compile with the same names in every folder.
pub(crate) fn same_names(command: &mut Command) -> Result<(), String> {
    let here = std::env::current_exe().map_err(|e| format!("this program does not find itself: {e}"))?;
    command.env("RUSTC_WRAPPER", here).env(COMPILES, "1");
    Ok(())
}

/// Whether cargo has called this program, in the place of rustc.
pub(crate) fn is_compiler() -> bool {
    std::env::var_os(COMPILES).is_some()
}

/// Calls rustc, which is the first argument, with the others.
pub(crate) fn compile() -> ExitCode {
    let mut arguments = std::env::args_os().skip(1);
    let Some(rustc) = arguments.next() else {
        eprintln!("xtask: {COMPILES} is set, and there is no compiler to call");
        return ExitCode::FAILURE;
    };
    let package =
        ["CARGO_PKG_NAME", "CARGO_PKG_VERSION"].map(|name| std::env::var_os(name).unwrap_or_default());
    let status = Command::new(&rustc).args(renamed(arguments.collect(), &package)).status();
    match status {
        Ok(status) => ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)),
        Err(why) => {
            eprintln!("xtask: cannot run {}: {why}", rustc.display());
            ExitCode::FAILURE
        }
    }
}

/// The arguments of rustc with a hash of the crate that does not depend on a path. Without a hash, they stay as they are.
fn renamed(mut arguments: Vec<OsString>, package: &[OsString; 2]) -> Vec<OsString> {
    let mut parts: Vec<&OsString> = package.iter().collect();
    for pair in arguments.windows(2) {
        if DISTINCT.iter().any(|flag| pair[0] == *flag) {
            parts.extend(pair);
        }
    }
    let mut hash = Sha256::new();
    for part in parts {
        hash.update(part.as_encoded_bytes());
        hash.update([0]);
    }
    let name: String = hash.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect();
    for argument in &mut arguments {
        if argument.to_str().is_some_and(|text| text.starts_with(METADATA)) {
            *argument = format!("{METADATA}{name}").into();
        }
    }
    arguments
}

/// Flags of rustc that replace paths of this machine: the repository, the folder of cargo's files, the packages that
/// cargo has loaded, and the sources of the standard library, if they are installed.
pub(crate) fn same_paths(root: &Path, target: &Path) -> Vec<String> {
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(std::env::home_dir()?.join(".cargo")));
    // Of flags that fit, rustc takes the last one.
    let mut places =
        vec![(root.to_path_buf(), "labspec".to_string()), (target.to_path_buf(), "target".into())];
    places.extend(home.map(|home| (home, "cargo".into())));
    places.extend(standard_library());
    let flag = |(path, name): (PathBuf, String)| {
        format!("--remap-path-prefix={}={name}", path.canonicalize().unwrap_or(path).display())
    };
    places.into_iter().map(flag).collect()
}

/// Where rustup installs the sources of the standard library, and where rustc says they are if they are not installed.
fn standard_library() -> Option<(PathBuf, String)> {
    let output = |arguments: &[&str]| {
        let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
        let bytes = Command::new(rustc).args(arguments).output().ok()?.stdout;
        String::from_utf8(bytes).ok()
    };
    let root = PathBuf::from(output(&["--print", "sysroot"])?.trim());
    let version = output(&["-vV"])?;
    let commit = version.lines().find_map(|line| line.strip_prefix("commit-hash: "))?;
    Some((root.join("lib/rustlib/src/rust"), format!("/rustc/{commit}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The arguments for a crate, with the hash of cargo.
    fn compiled(cfg: &str, hash: &str, package: [&str; 2]) -> Vec<OsString> {
        let arguments = ["--crate-name", "a", "src/lib.rs", "--crate-type", "lib", "--cfg", cfg, "-C", hash];
        renamed(arguments.map(Into::into).to_vec(), &package.map(Into::into))
    }

    #[test]
    fn a_crate_has_one_name_in_every_folder() {
        let here = compiled("feature=\"x\"", "metadata=1", ["a", "0.1.0"]);
        assert_eq!(here, compiled("feature=\"x\"", "metadata=2", ["a", "0.1.0"]));
        assert_ne!(here, compiled("feature=\"y\"", "metadata=1", ["a", "0.1.0"]));
        assert_ne!(here, compiled("feature=\"x\"", "metadata=1", ["a", "0.2.0"]));
        assert_eq!(here.len(), 9);
        // Without a hash nothing is added: cargo asks for the version of the compiler.
        assert_eq!(renamed(vec!["-vV".into()], &[OsString::new(), OsString::new()]), ["-vV"]);
    }
}
