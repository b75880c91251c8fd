//! The archives of the program, with its manual pages, its completions, and the scripts and styles of pages, which it finds beside itself; and
//! the archives of its symbols, which debuggers and profilers find by the name in the program.

use super::archive::{Contents, Packed, pack, unpack};
use super::platform::{self, Platform, Processor, output, output_of};
use super::{Release, emptied, failed, files_of, read, write};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The documents next to the program.
pub(super) const PAPERS: [&str; 5] = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE", "NOTICE"];

/// The name of the program that cargo builds.
const PROGRAM: &str = if cfg!(windows) { "labspec.exe" } else { "labspec" };

/// The folder beside the program that has the scripts and styles of pages.
const PAGE: &str = "page";

/// A processor without the instructions of x86-64-v3, as the emulator names it.
const OLD_PROCESSOR: &str = "Nehalem";

/// A lesson without findings.
const LESSON: &str = r#"# A fall

```lab simlab
{"xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>",
 "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}
```
"#;

/// Builds the programs of all platforms, and writes their archives.
pub(super) fn archives(release: &Release) -> Result<Vec<PathBuf>, String> {
    // What this machine's program prints is the same for all.
    let mut generated = Vec::new();
    let scripts = (release.scripts)()?;
    let mut archives = Vec::new();
    for platform in platform::all()? {
        let (mut files, mut symbols) = (Vec::new(), Vec::new());
        for (place, processor) in platform.processors.iter().enumerate() {
            let program = program(release, &platform, processor)?;
            let name = match (place, processor.name) {
                (1.., Some(name)) => format!("labspec-{name}"),
                _ => PROGRAM.into(),
            };
            let (program, with_name) = separated(&platform, program, &name)?;
            symbols.extend(with_name);
            files.push(Packed { path: name.into(), contents: Contents::Program(read(&program)?) });
            if generated.is_empty() {
                generated = for_shells(&program)?;
            }
        }
        files.extend(generated.iter().map(|(path, bytes)| Packed::file(path, bytes.clone())));
        files.extend(copied(&release.root, &scripts)?);
        let name = format!("labspec-{}-{}", release.version, platform.triple);
        let bytes = pack(&files, &name)?;
        try_out(&bytes, &name, &platform, &release.folder.join("try"))?;
        let archive = release.folder.join(format!("{name}.tar.gz"));
        write(&archive, &bytes)?;
        archives.push(archive);
        if symbols.is_empty() {
            eprintln!("xtask: skipped: the symbols for {}: apt-get install binutils", platform.triple);
        } else {
            let name = format!("{name}-symbols");
            let archive = release.folder.join(format!("{name}.tar.gz"));
            write(&archive, &pack(&symbols, &name)?)?;
            archives.push(archive);
        }
    }
    Ok(archives)
}

/// The program without its symbols, and its symbols in a file with the name that the program then contains, if the tool is installed.
fn separated(platform: &Platform, program: PathBuf, name: &str) -> Result<(PathBuf, Option<Packed>), String> {
    let Some(objcopy) = platform.objcopy() else { return Ok((program, None)) };
    let symbols = program.with_file_name(format!("{name}.debug"));
    output_of(Command::new(objcopy).arg("--only-keep-debug").args([&program, &symbols]))?;
    let stripped = program.with_file_name(format!("{name}.stripped"));
    let link = format!("--add-gnu-debuglink={}", symbols.display());
    output_of(Command::new(objcopy).args(["--strip-all", &link]).args([&program, &stripped]))?;
    let path = PathBuf::from(symbols.file_name().unwrap_or_default());
    Ok((stripped, Some(Packed::file(path, read(&symbols)?))))
}

/// Builds the program for a processor.
fn program(release: &Release, platform: &Platform, processor: &Processor) -> Result<PathBuf, String> {
    let (mut cargo, built) = platform.cargo(release, processor)?;
    cargo.args(["build", "--quiet", "--locked", "--package", "labspec-cli"]);
    cargo.args(platform.profile(release, processor).0);
    cargo.args(Platform::sizes(release));
    match cargo.status().map_err(|e| format!("cannot run cargo: {e}"))?.success() {
        true => Ok(built.join(PROGRAM)),
        false => Err("the program was not built".into()),
    }
}

/// What the program prints for shells and for `man`: paths in the archive, and bytes.
fn for_shells(program: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>, String> {
    let mut files = Vec::new();
    let mut add = |path: String, arguments: &[&str]| {
        files.push((path.into(), output(program, arguments)?.into_bytes()));
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
        Ok(Packed::file(folder.join(file), read(&path)?))
    };
    from.into_iter().map(packed).collect()
}

/// Unpacks an archive, checks a lesson and builds a site with its program, which finds the scripts of pages beside itself.
fn try_out(archive: &[u8], name: &str, platform: &Platform, folder: &Path) -> Result<(), String> {
    emptied(folder)?;
    let lessons = folder.join("lessons");
    fs::create_dir_all(&lessons).map_err(|e| failed(&lessons, &e))?;
    write(&lessons.join("a.md"), LESSON.as_bytes())?;
    unpack(archive, folder)?;
    let unpacked = folder.join(name);
    let program = unpacked.join(PROGRAM);
    if platform.is_here() {
        try_processors(&unpacked, &program, platform)?;
    }
    if let Some(mut command) = platform.run(&program) {
        // The lab of this lesson runs, and has no findings.
        output_of(command.args(["check", "--no-cache"]).arg(&lessons))?;
    }
    let site = folder.join("site");
    if let Some(mut command) = platform.run(&program) {
        let text =
            output_of(command.arg("build").arg(&lessons).arg("--out").arg(&site).env_remove("LABSPEC_PAGE"))?;
        // The program finds the scripts beside itself before it looks in the repository around it.
        let of_archive = unpacked.join(PAGE).join("site.js");
        if read(&of_archive)? != read(&site.join("page/site.js"))? {
            return Err(format!("the packed program builds a site with other scripts: {text}"));
        }
    }
    fs::remove_dir_all(folder).map_err(|e| failed(folder, &e))
}

/// Runs the program where a faster one is beside it, where there is none, and on an emulated old processor, if `qemu-x86_64` is
/// installed. It says which instructions the program that ran was built for.
fn try_processors(unpacked: &Path, program: &Path, platform: &Platform) -> Result<(), String> {
    let [every, Processor { name: Some(name), instructions }] = platform.processors else { return Ok(()) };
    let has_instructions = |text: &str, name: &str| match text.contains(name) {
        true => Ok(()),
        false => Err(format!("the program was not built for {name}: {text}")),
    };
    if platform::here_is_fast() {
        has_instructions(&output(program, &["--version"])?, instructions)?;
    }
    let (faster, hidden) = (unpacked.join(format!("labspec-{name}")), unpacked.join("hidden"));
    fs::rename(&faster, &hidden).map_err(|e| failed(&faster, &e))?;
    has_instructions(&output(program, &["--version"])?, every.instructions)?;
    fs::rename(&hidden, &faster).map_err(|e| failed(&faster, &e))?;
    if let Some(mut command) = on_old_processor(program) {
        has_instructions(&output_of(command.arg("--version"))?, every.instructions)?;
        let lessons = unpacked.with_file_name("lessons");
        if let Some(mut command) = on_old_processor(program) {
            output_of(command.args(["check", "--no-cache"]).arg(lessons))?;
        }
    }
    Ok(())
}

/// A command that runs a program on an emulated processor without the instructions of x86-64-v3, if the emulator is installed.
pub(super) fn on_old_processor(program: &Path) -> Option<Command> {
    const EMULATOR: &str = "qemu-x86_64";
    if !platform::is_installed(EMULATOR) {
        eprintln!("xtask: skipped: nothing is tried on an old processor: apt-get install qemu-user");
        return None;
    }
    let mut command = Command::new(EMULATOR);
    command.args(["-cpu", OLD_PROCESSOR]).arg(program);
    Some(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_archive_has_the_documents_and_the_scripts_of_pages() {
        let root = std::env::temp_dir().join(format!("labspec-pack-{}", std::process::id()));
        let scripts = root.join("dist");
        fs::create_dir_all(scripts.join("fonts")).unwrap();
        fs::create_dir_all(scripts.join("cache")).unwrap();
        let of_pages = ["dist/site.js", "dist/labspec.wasm", "dist/fonts/a.woff2", "dist/cache/x"];
        let written = PAPERS.into_iter().chain(of_pages);
        written.for_each(|name| fs::write(root.join(name), name).unwrap());
        let files = copied(&root, &scripts).unwrap();
        let paths: Vec<String> = files.iter().map(|file| file.path.display().to_string()).collect();
        for name in PAPERS.into_iter().chain(["page/site.js", "page/labspec.wasm", "page/fonts/a.woff2"]) {
            assert!(paths.iter().any(|path| path == name), "{name}: {paths:?}");
        }
        assert_eq!(paths.len(), PAPERS.len() + 3, "{paths:?}");
        fs::remove_dir_all(&root).unwrap();
    }
}
