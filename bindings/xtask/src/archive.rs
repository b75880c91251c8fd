//! Packs the program into an archive.

use flate2::{Compression, GzBuilder};
use sha2::{Digest, Sha256};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The documents next to the program.
const PAPERS: [&str; 5] = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE", "NOTICE"];

/// Builds the program, and writes its archive with a checksum; returns the path of the archive.
pub(crate) fn release(folder: Option<PathBuf>) -> Result<PathBuf, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let built = Command::new(&cargo)
        .args(["build", "--release", "--quiet", "--locked", "--package", "labspec-cli"])
        // Symbols are needed only for profiling.
        .env("CARGO_PROFILE_RELEASE_STRIP", "symbols")
        .current_dir(&root)
        .status()
        .map_err(|e| format!("cannot run cargo: {e}"))?;
    if !built.success() {
        return Err("the program was not built".into());
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let program = target.join("release").join(format!("labspec{}", std::env::consts::EXE_SUFFIX));
    let name = format!("labspec-{}-{}", version(&program)?, host()?);
    let folder = folder.unwrap_or_else(|| target.join("release-archives"));
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let archive = folder.join(format!("{name}.tar.gz"));
    let bytes = pack(&root, &program, &name)?;
    let sum: String = Sha256::digest(&bytes).iter().map(|b| format!("{b:02x}")).collect();
    let write = |path: &Path, bytes: &[u8]| {
        std::fs::write(path, bytes).map_err(|e| format!("{}: {e}", path.display()))
    };
    write(&archive, &bytes)?;
    let mut beside = OsString::from(&archive);
    beside.push(".sha256");
    write(Path::new(&beside), format!("{sum}  {name}.tar.gz\n").as_bytes())?;
    Ok(archive)
}

/// The version that the program reports: `labspec 0.1.0`.
fn version(program: &Path) -> Result<String, String> {
    let output = Command::new(program).arg("--version").output().map_err(|e| e.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.split_whitespace()
        .nth(1)
        .map(String::from)
        .ok_or_else(|| "the program does not say its version".into())
}

/// The target for which it was built.
fn host() -> Result<String, String> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).arg("-vV").output().map_err(|e| format!("cannot run rustc: {e}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let host = text.lines().find_map(|line| line.strip_prefix("host: ").map(String::from));
    host.ok_or_else(|| "rustc does not say what it builds for".into())
}

/// Without times and owners, so that the same files give the same bytes.
fn pack(root: &Path, program: &Path, name: &str) -> Result<Vec<u8>, String> {
    let zip = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    let mut tar = tar::Builder::new(zip);
    let papers = PAPERS.iter().map(|paper| (root.join(paper), 0o644));
    for (path, mode) in [(program.to_path_buf(), 0o755)].into_iter().chain(papers) {
        let bytes = std::fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let mut header = tar::Header::new_gnu();
        header.set_size(bytes.len() as u64);
        header.set_mode(mode);
        header.set_mtime(0);
        let file = path.file_name().ok_or("a file has no name")?;
        let inside = Path::new(name).join(file);
        tar.append_data(&mut header, inside, bytes.as_slice()).map_err(|e| e.to_string())?;
    }
    let zip = tar.into_inner().map_err(|e| e.to_string())?;
    zip.finish().map_err(|e| e.to_string())
}
