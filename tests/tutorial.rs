//! The tutorial and the cookbook, executed literally: their files are written, their changes made, their commands run, and the output
//! must equal that in the page. Before it, the tutorial shows the example course in a browser, by the command of the README.
//!
//! A block belongs to the line of prose before it. `diff` changes the last file named in the line. `sh` is run, and a block of
//! `text` after it is its output. Any other block is written into the last file named in the line, or appended to it if the
//! line begins with "Add". A drawing in the page (`.svg`) is the file with that name.
//!
//! `LABSPEC_BLESS=1 cargo test -p labspec-cli --test all tutorial` writes the current output into the pages and their pictures.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The prose and the blocks of a page, in order.
enum Part<'a> {
    Words(&'a str),
    Block { ticks: &'a str, kind: &'a str, inside: String },
}

fn parts(page: &str) -> Vec<Part<'_>> {
    let (mut lines, mut out) = (page.lines(), Vec::new());
    while let Some(line) = lines.next() {
        let kind = line.trim_start_matches('`');
        let ticks = &line[..line.len() - kind.len()];
        if ticks.len() < 3 {
            out.push(Part::Words(line));
            continue;
        }
        let inside = lines.by_ref().take_while(|l| *l != ticks).map(|l| format!("{l}\n")).collect();
        out.push(Part::Block { ticks, kind, inside });
    }
    out
}

/// A terminal: a current folder, and a shell whose path contains the program.
struct Terminal {
    here: PathBuf,
}

impl Terminal {
    /// Runs a block of commands, and returns its output. `cd` affects the following blocks.
    fn types(&mut self, commands: &str) -> String {
        let program = Path::new(env!("CARGO_BIN_EXE_labspec")).parent().unwrap();
        let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
        let place = self.here.join("place");
        let done = Command::new("sh")
            .args(["-c", &format!("exec 2>&1\n{commands}\npwd > '{}'", place.display())])
            .current_dir(&self.here)
            .env("PATH", path)
            .output()
            .unwrap();
        self.here = std::fs::read_to_string(&place).unwrap().trim_end().into();
        std::fs::remove_file(place).unwrap();
        String::from_utf8(done.stdout).unwrap()
    }

    /// Applies a change in the format of the page: `-` marks removed lines, `+` added lines; others remain.
    fn changes(&self, name: &str, change: &str) {
        let side = |gone: char| -> String {
            let lines = change.lines().filter(|l| !l.starts_with(gone));
            lines.map(|l| format!("{}\n", l.get(1..).unwrap_or_default())).collect()
        };
        let (before, after) = (side('+'), side('-'));
        let text = std::fs::read_to_string(self.here.join(name)).unwrap();
        assert_eq!(text.matches(&before).count(), 1, "{name} has this not once:\n{before}");
        std::fs::write(self.here.join(name), text.replace(&before, &after)).unwrap();
    }
}

/// The command that shows the example course, and the picture of a lesson of it. `web/site/test` tests the page itself.
const PREVIEW: &str = "    cargo run --manifest-path bindings/xtask/Cargo.toml -- preview\n";

#[test]
fn the_tutorial_begins_with_the_course_in_a_browser() {
    let [page, readme, tool] = ["docs/tutorial.md", "README.md", "bindings/xtask/src/main.rs"]
        .map(|name| std::fs::read_to_string(workspace().join(name)).unwrap());
    let (start, _) = page.split_once("## Install the program").unwrap();
    assert!(start.contains(PREVIEW) && readme.contains(PREVIEW), "the README has another command");
    assert!(tool.contains("Some(\"preview\") =>"), "xtask has no such command");
    let picture =
        start.split("](").find(|part| part.starts_with("pictures/")).unwrap().split(')').next().unwrap();
    assert!(
        std::fs::read(workspace().join("docs").join(picture)).unwrap().starts_with(b"\x89PNG"),
        "{picture}"
    );
}

/// The only block that is not run: it builds the program, which already exists in the test.
const BUILD: &str = "cargo install --path crates/cli --locked\nlabspec -V\n";

#[test]
fn the_tutorial_is_followed_word_for_word() {
    let (outputs, pictures) = follow("docs/tutorial.md");
    assert!(outputs > 8 && pictures > 0, "{outputs} {pictures}");
}

#[test]
fn the_cookbook_is_followed_word_for_word() {
    let (outputs, _) = follow("docs/cookbook.md");
    assert!(outputs > 20, "{outputs}");
}

/// Follows a page: returns the number of outputs and of pictures that were compared.
fn follow(page: &str) -> (usize, usize) {
    let page_file = workspace().join(page);
    let page = std::fs::read_to_string(&page_file).unwrap();
    let bless = std::env::var_os("LABSPEC_BLESS").is_some();
    let folder = tempfile::tempdir().unwrap();
    let mut terminal = Terminal { here: folder.path().into() };
    // The output that has not been compared yet, and the updated page.
    let (mut output, mut real) = (None, String::new());
    let (mut before, mut typed, mut pictures) = ("", 0, 0);
    for part in parts(&page) {
        let (ticks, kind, inside) = match part {
            Part::Words(line) => {
                if !line.is_empty() {
                    assert_eq!(
                        output.take().unwrap_or_default(),
                        "",
                        "nothing of this is shown before {line}"
                    );
                    before = line;
                }
                let picture = line.split_once("](pictures/").and_then(|(_, rest)| rest.split(')').next());
                if let Some(name) = picture.filter(|name| name.ends_with(".svg")) {
                    let drawn = std::fs::read_to_string(terminal.here.join(name)).unwrap();
                    let stored = workspace().join("docs/pictures").join(name);
                    if bless {
                        std::fs::write(&stored, &drawn).unwrap();
                    }
                    assert!(drawn == std::fs::read_to_string(stored).unwrap(), "{name} shows something else");
                    pictures += 1;
                }
                real += &format!("{line}\n");
                continue;
            }
            Part::Block { ticks, kind, inside } => (ticks, kind, inside),
        };
        let name = before.rsplit('`').nth(1);
        let mut block = inside.clone();
        match kind {
            "sh" if inside == BUILD => output = Some(terminal.types("labspec -V")),
            "sh" => output = Some(terminal.types(&inside)),
            "text" => {
                block = output.take().unwrap();
                typed += 1;
            }
            "diff" => terminal.changes(name.unwrap(), &inside),
            _ => {
                let path = terminal.here.join(name.unwrap());
                let old = if before.starts_with("Add") {
                    std::fs::read_to_string(&path).unwrap() + "\n"
                } else {
                    assert!(!path.exists(), "{} is written twice", path.display());
                    String::new()
                };
                std::fs::write(path, old + &inside).unwrap();
            }
        }
        if !bless {
            assert!(
                inside == block,
                "behind \"{before}\" the page shows\n{inside}\nand the terminal\n{block}"
            );
        }
        real += &format!("{ticks}{kind}\n{block}{ticks}\n");
    }
    if bless {
        std::fs::write(&page_file, &real).unwrap();
    }
    assert!(real == std::fs::read_to_string(&page_file).unwrap());
    (typed, pictures)
}
