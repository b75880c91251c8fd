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

/// The name of the program that cargo builds.
const PROGRAM: &str = if cfg!(windows) { "labspec.exe" } else { "labspec" };

/// The folder beside the program that has the scripts and styles of pages.
const PAGE: &str = "page";

/// The programs of an archive: the name of each, and the processors for which it is built. The first one runs on all processors of the
/// target, and starts another one where the processor has its instructions.
#[cfg(all(unix, target_arch = "x86_64"))]
const PROGRAMS: &[(&str, Option<&str>)] =
    &[("labspec", Some("x86-64")), ("labspec-x86-64-v3", Some("x86-64-v3"))];
#[cfg(not(all(unix, target_arch = "x86_64")))]
const PROGRAMS: &[(&str, Option<&str>)] = &[(PROGRAM, None)];

/// A processor without the instructions of x86-64-v3, as the emulator names it.
const OLD_PROCESSOR: &str = "Nehalem";

/// A lesson without findings.
const LESSON: &str = r#"# A fall

```lab simlab
{"xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>",
 "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}
```
"#;

/// A file of the archive: its path in it, its mode, and its bytes.
struct Packed {
    path: PathBuf,
    mode: u32,
    bytes: Vec<u8>,
}

/// Builds the programs, and writes their archive with a checksum; returns the path of the archive. `build` builds the modules, if the
/// scripts of pages are missing.
pub(crate) fn release(
    folder: Option<PathBuf>,
    build: impl Fn() -> Result<PathBuf, String>,
) -> Result<PathBuf, String> {
    let scripts = page::built(build)?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let mut files = Vec::new();
    for (name, processor) in PROGRAMS {
        let program = program(&root, &target, *processor)?;
        files.push(Packed { path: name.into(), mode: 0o755, bytes: read(&program)? });
        if files.len() == 1 {
            files.extend(generated(&program)?);
        }
    }
    let first = target.join(folder_of(PROGRAMS[0].1)).join("release").join(PROGRAM);
    let name = format!("labspec-{}-{}", version(&first)?, host()?);
    files.extend(copied(&root, &scripts)?);
    let folder = folder.unwrap_or_else(|| target.join("release-archives"));
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let archive = folder.join(format!("{name}.tar.gz"));
    let bytes = pack(&files, &name)?;
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

/// The folder of the builds for a processor.
fn folder_of(processor: Option<&str>) -> String {
    processor.map_or_else(|| "for-this-target".into(), |name| format!("for-{name}"))
}

/// Builds the program for a processor.
fn program(root: &Path, target: &Path, processor: Option<&str>) -> Result<PathBuf, String> {
    let folder = target.join(folder_of(processor));
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .args(["build", "--release", "--quiet", "--locked", "--package", "labspec-cli"])
        // Symbols are needed only for profiling.
        .env("CARGO_PROFILE_RELEASE_STRIP", "symbols")
        .env("CARGO_TARGET_DIR", &folder)
        .current_dir(root);
    if let Some(name) = processor {
        // These flags replace those of `.cargo/config.toml`.
        cargo.env("RUSTFLAGS", format!("-C target-cpu={name}"));
    }
    let built = cargo.status().map_err(|e| format!("cannot run cargo: {e}"))?;
    if !built.success() {
        return Err("the program was not built".into());
    }
    Ok(folder.join("release").join(PROGRAM))
}

/// What the program prints for shells and for `man`.
fn generated(program: &Path) -> Result<Vec<Packed>, String> {
    let mut files = Vec::new();
    let mut add = |path: String, arguments: &[&str]| {
        let bytes = output(program, arguments)?.into_bytes();
        files.push(Packed { path: path.into(), mode: 0o644, bytes });
        Ok::<(), String>(())
    };
    for (shell, file) in [("bash", "labspec.bash"), ("zsh", "_labspec"), ("fish", "labspec.fish")] {
        add(format!("completions/{file}"), &["completions", shell])?;
    }
    add("man/labspec.1".into(), &["man"])?;
    for command in output(program, &["man", "--list"])?.lines() {
        add(format!("man/labspec-{command}.1"), &["man", command])?;
    }
    Ok(files)
}

/// The output of a program that succeeds.
fn output(program: &Path, arguments: &[&str]) -> Result<String, String> {
    let done = Command::new(program).args(arguments).output();
    let done = done.map_err(|e| format!("cannot run {}: {e}", program.display()))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if done.status.success() {
        return Ok(text(&done.stdout));
    }
    Err(format!("{} {}: {}", program.display(), arguments.join(" "), text(&done.stderr)))
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|e| format!("{}: {e}", path.display()))
}

/// The documents, and the scripts and styles of pages.
fn copied(root: &Path, scripts: &Path) -> Result<Vec<Packed>, String> {
    let mut from: Vec<(PathBuf, PathBuf)> =
        PAPERS.iter().map(|paper| (root.join(paper), PathBuf::new())).collect();
    for inside in ["", "fonts"] {
        let to = Path::new(PAGE).join(inside);
        from.extend(files_of(&scripts.join(inside))?.into_iter().map(|path| (path, to.clone())));
    }
    let packed = |(path, folder): (PathBuf, PathBuf)| {
        let file = path.file_name().ok_or("a file has no name")?;
        Ok(Packed { path: folder.join(file), mode: 0o644, bytes: read(&path)? })
    };
    from.into_iter().map(packed).collect()
}

/// The version that the program reports: `labspec 0.1.0`.
fn version(program: &Path) -> Result<String, String> {
    let text = output(program, &["-V"])?;
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
fn pack(files: &[Packed], name: &str) -> Result<Vec<u8>, String> {
    let zip = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    let mut tar = tar::Builder::new(zip);
    for Packed { path, mode, bytes } in files {
        let mut header = tar::Header::new_gnu();
        header.set_size(bytes.len() as u64);
        header.set_mode(*mode);
        header.set_mtime(0);
        let path = Path::new(name).join(path);
        tar.append_data(&mut header, path, bytes.as_slice()).map_err(|e| e.to_string())?;
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
    fs::write(lessons.join("a.md"), LESSON).map_err(failed)?;
    tar::Archive::new(GzDecoder::new(archive)).unpack(folder).map_err(failed)?;
    let unpacked = folder.join(name);
    let program = unpacked.join(PROGRAMS[0].0);
    try_processors(&unpacked, &program, &lessons)?;
    let site = folder.join("site");
    let mut command = Command::new(&program);
    command.arg("build").arg(&lessons).arg("--out").arg(&site).env_remove("LABSPEC_PAGE");
    let output = command.output().map_err(failed)?;
    // The program finds the scripts beside itself before it looks in the repository around it.
    let of_archive = unpacked.join(PAGE).join("site.js");
    let same =
        fs::read(of_archive).map_err(failed)? == fs::read(site.join("page/site.js")).unwrap_or_default();
    if !same {
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(format!("the packed program builds no site: {message}"));
    }
    fs::remove_dir_all(folder).map_err(failed)
}

/// Runs the program where a faster one is beside it, where there is none, and on an emulated old processor, if `qemu-x86_64` is
/// installed. It says which instructions the program that ran was built for.
fn try_processors(unpacked: &Path, program: &Path, lessons: &Path) -> Result<(), String> {
    let [.., (faster, Some(_))] = PROGRAMS else { return Ok(()) };
    let has_instructions = |text: &str, name: &str| match text.contains(name) {
        true => Ok(()),
        false => Err(format!("the program was not built for {name}: {text}")),
    };
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        has_instructions(&output(program, &["--version"])?, "AVX2")?;
    }
    let (faster, hidden) = (unpacked.join(faster), unpacked.join("hidden"));
    fs::rename(&faster, &hidden).map_err(|e| format!("{}: {e}", faster.display()))?;
    has_instructions(&output(program, &["--version"])?, "SSE2")?;
    fs::rename(&hidden, &faster).map_err(|e| format!("{}: {e}", faster.display()))?;
    let emulator = Path::new("qemu-x86_64");
    if Command::new(emulator).arg("--version").output().is_err() {
        eprintln!("xtask: qemu-x86_64 is not installed, so the program is not tried on an old processor");
        return Ok(());
    }
    let (program, lessons) = (program.display().to_string(), lessons.display().to_string());
    let emulated = |arguments: &[&str]| {
        output(emulator, &[&["-cpu", OLD_PROCESSOR, program.as_str()], arguments].concat())
    };
    has_instructions(&emulated(&["--version"])?, "SSE2")?;
    // The lab of this lesson runs, and has no findings.
    emulated(&["check", "--no-cache", &lessons]).map(drop)
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
        let of_pages = ["dist/site.js", "dist/labspec.wasm", "dist/fonts/a.woff2", "dist/cache/x"];
        let written = PAPERS.into_iter().chain(of_pages);
        written.for_each(|name| fs::write(root.join(name), name).unwrap());
        let packed = || {
            let program = Packed { path: "labspec".into(), mode: 0o755, bytes: b"program".to_vec() };
            let files: Vec<Packed> =
                std::iter::once(program).chain(copied(&root, &scripts).unwrap()).collect();
            pack(&files, "labspec-1").unwrap()
        };
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
