//! Packs the program into an archive, with the scripts and styles of pages, which it finds beside itself.

use crate::page;
use flate2::{Compression, GzBuilder, read::GzDecoder};
use sha2::{Digest, Sha256};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The documents next to the program.
const PAPERS: [&str; 5] = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE", "NOTICE"];

/// The folder beside the program that has the scripts and styles of pages.
const PAGE: &str = "page";

/// Builds the program, and writes its archive with a checksum; returns the path of the archive. `build` builds the modules, if the
/// scripts of pages are missing.
pub(crate) fn release(
    folder: Option<PathBuf>,
    build: impl Fn() -> Result<PathBuf, String>,
) -> Result<PathBuf, String> {
    let scripts = page::built(build)?;
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
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let archive = folder.join(format!("{name}.tar.gz"));
    let bytes = pack(&root, &program, &scripts, &name)?;
    try_out(&bytes, &name, &folder.join("try"))?;
    let sum: String = Sha256::digest(&bytes).iter().map(|b| format!("{b:02x}")).collect();
    let write =
        |path: &Path, bytes: &[u8]| fs::write(path, bytes).map_err(|e| format!("{}: {e}", path.display()));
    write(&archive, &bytes)?;
    let mut beside = OsString::from(&archive);
    beside.push(".sha256");
    write(Path::new(&beside), format!("{sum}  {name}.tar.gz\n").as_bytes())?;
    Ok(archive)
}

/// The version that the program reports: `labspec 0.1.0`.
fn version(program: &Path) -> Result<String, String> {
    let output = Command::new(program).arg("-V").output().map_err(|e| e.to_string())?;
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
fn pack(root: &Path, program: &Path, scripts: &Path, name: &str) -> Result<Vec<u8>, String> {
    let mut files = vec![(program.to_path_buf(), PathBuf::new(), 0o755)];
    files.extend(PAPERS.iter().map(|paper| (root.join(paper), PathBuf::new(), 0o644)));
    for inside in ["", "fonts"] {
        let to = Path::new(PAGE).join(inside);
        files.extend(files_of(&scripts.join(inside))?.into_iter().map(|path| (path, to.clone(), 0o644)));
    }
    let zip = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    let mut tar = tar::Builder::new(zip);
    for (path, folder, mode) in files {
        let bytes = fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let mut header = tar::Header::new_gnu();
        header.set_size(bytes.len() as u64);
        header.set_mode(mode);
        header.set_mtime(0);
        let file = path.file_name().ok_or("a file has no name")?;
        let inside = Path::new(name).join(folder).join(file);
        tar.append_data(&mut header, inside, bytes.as_slice()).map_err(|e| e.to_string())?;
    }
    let zip = tar.into_inner().map_err(|e| e.to_string())?;
    zip.finish().map_err(|e| e.to_string())
}

/// The files of a folder, in the order of their names.
fn files_of(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let failed = |e: std::io::Error| format!("{}: {e}", folder.display());
    let entries = fs::read_dir(folder).map_err(failed)?.map(|entry| entry.map(|entry| entry.path()));
    let mut all = entries.collect::<Result<Vec<_>, _>>().map_err(failed)?;
    all.retain(|path| path.is_file());
    all.sort();
    Ok(all)
}

/// Unpacks an archive, and builds a site with its program: the program finds the scripts of pages beside itself.
fn try_out(archive: &[u8], name: &str, folder: &Path) -> Result<(), String> {
    let failed = |e: std::io::Error| format!("{}: {e}", folder.display());
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(failed)?;
    }
    let lessons = folder.join("lessons");
    fs::create_dir_all(&lessons).map_err(failed)?;
    fs::write(lessons.join("a.md"), "# A\n\n```lab simlab\n{\"xml\": \"<mujoco/>\"}\n```\n")
        .map_err(failed)?;
    tar::Archive::new(GzDecoder::new(archive)).unpack(folder).map_err(failed)?;
    let program = folder.join(name).join(format!("labspec{}", std::env::consts::EXE_SUFFIX));
    let site = folder.join("site");
    let mut command = Command::new(&program);
    command.arg("build").arg(&lessons).arg("--out").arg(&site).env_remove("LABSPEC_PAGE");
    let output = command.output().map_err(failed)?;
    // The program finds the scripts beside itself before it looks in the repository around it.
    let of_archive = folder.join(name).join(PAGE).join("site.js");
    let same =
        fs::read(of_archive).map_err(failed)? == fs::read(site.join("page/site.js")).unwrap_or_default();
    if !same {
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(format!("the packed program builds no site: {message}"));
    }
    fs::remove_dir_all(folder).map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn an_archive_has_the_program_its_documents_and_the_scripts_of_pages() {
        let root = std::env::temp_dir().join(format!("labspec-pack-{}", std::process::id()));
        let scripts = root.join("dist");
        fs::create_dir_all(scripts.join("fonts")).unwrap();
        fs::create_dir_all(scripts.join("cache")).unwrap();
        let written = PAPERS.into_iter().chain([
            "labspec",
            "dist/site.js",
            "dist/labspec.wasm",
            "dist/fonts/a.woff2",
            "dist/cache/x",
        ]);
        written.for_each(|name| fs::write(root.join(name), name).unwrap());
        let packed = || pack(&root, &root.join("labspec"), &scripts, "labspec-1").unwrap();
        let bytes = packed();
        assert_eq!(bytes, packed(), "the same files give the same bytes");
        let mut archive = tar::Archive::new(GzDecoder::new(bytes.as_slice()));
        let entries: Vec<(String, u32)> = archive
            .entries()
            .unwrap()
            .map(|entry| entry.unwrap())
            .map(|entry| (entry.path().unwrap().display().to_string(), entry.header().mode().unwrap()))
            .collect();
        let names: BTreeSet<&str> = entries.iter().map(|(name, _)| name.as_str()).collect();
        for name in
            PAPERS.into_iter().chain(["labspec", "page/site.js", "page/labspec.wasm", "page/fonts/a.woff2"])
        {
            assert!(names.contains(format!("labspec-1/{name}").as_str()), "{name}: {names:?}");
        }
        assert_eq!(names.len(), PAPERS.len() + 4, "{names:?}");
        assert!(
            entries.iter().all(|(name, mode)| (*mode == 0o755) == name.ends_with("/labspec")),
            "{entries:?}"
        );
        fs::remove_dir_all(&root).unwrap();
    }
}
