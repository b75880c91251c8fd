//! The archives of the C library: header, shared and static library, and `labspec.pc` for pkg-config.
//!
//! The shared library has a second build for x86-64-v3 in `glibc-hwcaps`, where the dynamic linker of glibc (2.33 and later) looks for it on
//! processors that have these instructions ("Hardware capabilities" in the manual `ld.so(8)`).

use super::archive::{Contents, Packed, pack, unpack};
use super::platform::{self, Platform, Processor, is_installed, output_of};
use super::program::on_old_processor;
use super::{Release, emptied, failed, files_of, read, write};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The file that programs are linked with; the file that they load, with the number of the interface; the file itself.
const NAMES: [&str; 2] = ["liblabspec.so", "liblabspec.so.1"];
const FILE: &str = "liblabspec.so.1.0.0";

/// `labspec.pc`; paths are relative to the file, so that the archive can be unpacked anywhere.
fn pkg_config(version: &str) -> String {
    format!(
        "prefix=${{pcfiledir}}/../..\nlibdir=${{prefix}}/lib\nincludedir=${{prefix}}/include\n\nName: labspec\nDescription: Labs, models \
         and checks of physics lessons\nVersion: {version}\nLibs: -L${{libdir}} -llabspec\nLibs.private: -lpthread -ldl -lm\nCflags: \
         -I${{includedir}}\n"
    )
}

/// Builds the libraries of all platforms with shared libraries of this kind, and writes their archives.
pub(super) fn archives(release: &Release) -> Result<Vec<PathBuf>, String> {
    let mut archives = Vec::new();
    for platform in platform::all()? {
        if !platform.triple.contains("linux-gnu") {
            eprintln!(
                "xtask: skipped: the archive of the C library is made for Linux with glibc, not for {}",
                platform.triple
            );
            continue;
        }
        let files = files(release, &platform)?;
        let name = format!("labspec-c-{}-{}", release.version, platform.triple);
        let bytes = pack(&files, &name)?;
        if platform.is_here() {
            try_out(release, &bytes, &name)?;
        }
        let archive = release.folder.join(format!("{name}.tar.gz"));
        write(&archive, &bytes)?;
        archives.push(archive);
    }
    Ok(archives)
}

/// The files of an archive.
fn files(release: &Release, platform: &Platform) -> Result<Vec<Packed>, String> {
    let sources = release.root.join("bindings/c");
    let mut files = Vec::new();
    for (place, processor) in platform.processors.iter().enumerate() {
        let built = build(release, platform, processor)?;
        let folder = match (place, processor.name) {
            (1.., Some(name)) => format!("lib/glibc-hwcaps/{name}"),
            _ => "lib".into(),
        };
        files.push(Packed {
            path: Path::new(&folder).join(FILE),
            contents: Contents::Program(read(&built.join("liblabspec.so"))?),
        });
        let links = if place == 0 { &NAMES[..] } else { &NAMES[1..] };
        files.extend(
            links
                .iter()
                .map(|link| Packed { path: Path::new(&folder).join(link), contents: Contents::Link(FILE) }),
        );
        if place == 0 {
            files.push(Packed::file("lib/liblabspec.a", read(&built.join("liblabspec.a"))?));
        }
    }
    files.push(Packed::file("lib/pkgconfig/labspec.pc", pkg_config(&release.version).into_bytes()));
    for header in files_of(&sources.join("include"))? {
        files.push(Packed::file(
            Path::new("include").join(header.file_name().unwrap_or_default()),
            read(&header)?,
        ));
    }
    for example in files_of(&sources.join("examples"))? {
        files.push(Packed::file(
            Path::new("examples").join(example.file_name().unwrap_or_default()),
            read(&example)?,
        ));
    }
    files.push(Packed::file("README.md", read(&sources.join("README.md"))?));
    for paper in ["LICENSE-MIT", "LICENSE-APACHE", "NOTICE"] {
        files.push(Packed::file(paper, read(&release.root.join(paper))?));
    }
    Ok(files)
}

/// Builds the libraries for a processor; returns their folder.
fn build(release: &Release, platform: &Platform, processor: &Processor) -> Result<PathBuf, String> {
    let (mut cargo, built) = platform.cargo(release, processor)?;
    let manifest = release.root.join("bindings/c/Cargo.toml");
    cargo
        .args(["rustc", "--quiet", "--locked", "--lib", "--package", "labspec-c", "--manifest-path"])
        .arg(manifest)
        .args(platform.profile(release, processor).0);
    cargo
        .args(["--", "-C"])
        .arg(format!("link-arg=-Wl,-soname,{}", NAMES[1]))
        .args(platform.without_symbols());
    if !cargo.status().map_err(|e| format!("cannot run cargo: {e}"))?.success() {
        return Err("the C library was not built".into());
    }
    Ok(built)
}

/// Unpacks an archive, builds the example with the flags of pkg-config, and runs it, also on an old processor.
fn try_out(release: &Release, archive: &[u8], name: &str) -> Result<(), String> {
    if !is_installed("gcc") || !is_installed("pkg-config") {
        eprintln!(
            "xtask: skipped: the archive of the C library is not tried: apt-get install gcc pkg-config"
        );
        return Ok(());
    }
    let folder = release.folder.join("try");
    emptied(&folder)?;
    unpack(archive, &folder)?;
    let unpacked = folder.join(name);
    let flags = output_of(
        Command::new("pkg-config")
            .args(["--cflags", "--libs", "labspec"])
            .env("PKG_CONFIG_PATH", unpacked.join("lib/pkgconfig")),
    )?;
    let program = folder.join("pendulum");
    output_of(
        Command::new("gcc")
            .args(["-std=c11", "-o"])
            .arg(&program)
            .arg(unpacked.join("examples/pendulum.c"))
            .args(flags.split_whitespace())
            .arg("-lm")
            .arg(format!("-Wl,-rpath,{}", unpacked.join("lib").display())),
    )?;
    let run = |command: &mut Command| {
        output_of(
            command
                .arg(release.root.join("specs/lessons/02-bounce-and-swing.md"))
                .arg(release.root.join("specs/models")),
        )
    };
    let text = run(&mut Command::new(&program))?;
    if !text.contains("angle") {
        return Err(format!("the example prints something else: {text}"));
    }
    if let Some(mut command) = on_old_processor(&program)
        && run(&mut command)? != text
    {
        return Err("the example prints other numbers on an old processor".into());
    }
    fs::remove_dir_all(&folder).map_err(|e| failed(&folder, &e))
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_file_for_pkg_config_is_relative_to_itself() {
        let text = super::pkg_config("1.2.3");
        assert!(
            text.starts_with("prefix=${pcfiledir}/../..\n") && text.contains("\nVersion: 1.2.3\n"),
            "{text}"
        );
        assert!(text.lines().all(|line| line.trim() == line), "{text}");
    }
}
