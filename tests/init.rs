//! `labspec init` writes a course whose claims are true; and `labspec completions`.

#![allow(clippy::unwrap_used)]

use crate::program::{run, run_in};
use crate::support::workspace;
use std::collections::BTreeSet;

#[test]
fn a_new_folder_holds_a_lesson_that_is_true() {
    let folder = tempfile::tempdir().unwrap();
    let made = run_in(folder.path(), &["init", "course"]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    assert!(made.stdout.contains("now run: labspec check course/lessons"), "{}", made.stdout);
    let done = run_in(folder.path(), &["check", "course/lessons", "--deny", "warnings,notes"]);
    assert_eq!(done.code, 0, "{}", done.stdout);
    assert!(done.stdout.contains("1 answer verified, 1 quoted number verified"), "{}", done.stdout);
    // The workflow checks with the version that has written it.
    let workflow =
        std::fs::read_to_string(folder.path().join("course/.github/workflows/labspec.yml")).unwrap();
    let version = run(&["-V"]).stdout;
    let version = version.split_whitespace().nth(1).unwrap();
    assert!(workflow.contains(&format!("uses: labspec/labspec@v{version}\n")), "{workflow}");
    // Existing files are not changed.
    let lesson = folder.path().join("course/lessons/01-fall.md");
    std::fs::write(&lesson, "mine").unwrap();
    let again = run_in(folder.path(), &["init", "course"]);
    assert_eq!(again.code, 2);
    assert!(again.stderr.contains("nothing was written"), "{}", again.stderr);
    assert_eq!(std::fs::read_to_string(&lesson).unwrap(), "mine");
}

/// All commands, and all long options of `check`, in the syntax of each shell's script.
#[test]
fn shells_complete_every_command() {
    let help = run(&["check", "--help"]).stdout;
    let is_long = |word: &&str| word.starts_with("--") && word.len() > 2;
    let options: BTreeSet<&str> =
        help.lines().filter_map(|line| line.split([' ', '=']).find(is_long)).collect();
    assert!(options.len() > 15 && options.contains("--update-baseline"), "{options:?}");
    for (shell, command, option) in [
        ("bash", "cmd=\"labspec__subcmd__NAME\"", " --NAME "),
        ("zsh", "'NAME:", "--NAME["),
        ("fish", "-a \"NAME\"", "-l NAME "),
        (
            "powershell",
            "::new('NAME', 'NAME', [CompletionResultType]::ParameterValue",
            "::new('--NAME', '--NAME'",
        ),
        ("elvish", "cand NAME '", "cand --NAME '"),
    ] {
        let done = run(&["completions", shell]);
        assert_eq!(done.code, 0, "{shell}");
        for name in ["check", "precision", "stability", "lsp"] {
            assert!(done.stdout.contains(&command.replace("NAME", name)), "{shell}: {name}");
        }
        for name in options.iter().map(|o| o.trim_start_matches('-')) {
            // In zsh, options with a value have an additional `=`.
            let [plain, taking] =
                [option.to_string(), option.replace('[', "=[")].map(|o| o.replace("NAME", name));
            assert!(done.stdout.contains(&plain) || done.stdout.contains(&taking), "{shell}: {name}");
        }
    }
}

/// Every command has a manual page with all its options, except the hidden ones.
#[test]
fn manual_pages_list_commands_and_options() {
    let names = run(&["man", "--list"]).stdout;
    let names: Vec<&str> = names.lines().collect();
    assert!(names.contains(&"check") && names.len() > 15, "{names:?}");
    assert!(!names.contains(&"reference") && !names.contains(&"help"), "{names:?}");
    // Hyphens are escaped in these pages.
    let page = |arguments: &[&str]| run(&[&["man"], arguments].concat()).stdout.replace("\\-", "-");
    let program = page(&[]);
    assert!(program.starts_with(".ie") && program.contains(".TH labspec 1"), "{program}");
    for name in &names {
        assert!(program.contains(&format!("labspec-{name}(1)")), "{name}");
        let of_command = page(&[name]);
        assert!(of_command.contains(&format!(".TH labspec-{name} 1")), "{of_command}");
        // The harness takes every output of these two for a report.
        let help =
            if ["bench", "record"].contains(name) { String::new() } else { run(&[name, "--help"]).stdout };
        for option in help.lines().filter_map(|l| l.split([' ', '=', ',']).find(|w| w.starts_with("--"))) {
            assert!(of_command.contains(option), "{name} {option}");
        }
    }
    let done = run(&["man", "chek"]);
    assert_eq!((done.code, done.stderr.contains("did you mean `check`?")), (2, true), "{}", done.stderr);
}

/// The workflow, the action and the hook use existing commands and options of the program.
#[test]
fn callers_of_the_program_use_existing_commands() {
    let read = |name: &str| std::fs::read_to_string(workspace().join(name)).unwrap();
    let help = run(&["check", "--help"]).stdout;
    for (file, words) in
        [("action.yml", vec!["--format", "github"]), ("hooks/pre-commit", vec!["check", "--skip-others"])]
    {
        let text = read(file);
        for word in words {
            assert!(text.contains(word), "{file}: {word}");
            assert!(help.contains(word), "{word}");
        }
    }
    // What cargo installs is the package of the program.
    for file in ["action.yml", "hooks/pre-commit", "Containerfile"] {
        assert!(read(file).contains("cargo install") && read(file).contains("--path crates/cli"), "{file}");
    }
    let hook = read(".pre-commit-hooks.yaml");
    let entry = hook.lines().find_map(|line| line.trim().strip_prefix("entry: ")).unwrap();
    assert!(workspace().join(entry).is_file(), "{entry}");
}

/// The hook, with the files of a commit: those without a lesson are skipped, and a commit without any lesson passes.
#[test]
fn the_hook_checks_lessons_and_models_only() {
    let folder = tempfile::tempdir().unwrap();
    let files = [
        ("README.md", "# A page\n"),
        ("package.json", "{\"name\": \"x\"}"),
        ("feed.xml", "<rss/>"),
        ("part.xml", "<mujocoinclude><geom size=\"1\"/></mujocoinclude>"),
        ("code.py", "print()"),
        ("ball.xml", "<mujoco><worldbody><geom size=\"0.1\"/></worldbody></mujoco>"),
        ("bad.xml", "<mujoco><worldbody><geom size=\"-1\"/></worldbody></mujoco>"),
        ("lab.json", "{\"title\": \"x\", \"xml\": \"<mujoco/>\"}"),
        ("bad.json", "{\"xml\": \"<mujoco/>\", \"setup\": \"data.qpso[0] = 1\"}"),
    ];
    files.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
    let hook = |names: &[&str]| {
        let mut command = std::process::Command::new("bash");
        command.arg(workspace().join("hooks/pre-commit")).args(names).current_dir(folder.path());
        let done = command.env("LABSPEC", env!("CARGO_BIN_EXE_labspec")).output().unwrap();
        (done.status.code(), String::from_utf8_lossy(&done.stdout).into_owned())
    };
    let others = ["README.md", "package.json", "feed.xml", "part.xml", "code.py"];
    assert_eq!(hook(&others).0, Some(0), "{:?}", hook(&others));
    assert_eq!(hook(&["code.py"]), (Some(0), "nothing to check\n".into()));
    let all = hook(&[&others[..], &["ball.xml", "lab.json"]].concat());
    assert!(all.0 == Some(0) && all.1.contains("1 lab run") && all.1.contains("no problems"), "{all:?}");
    for bad in ["bad.xml", "bad.json"] {
        assert_eq!(hook(&["README.md", bad]).0, Some(1), "{bad}");
    }
    // A pipe is not opened, and `verify` calls nothing clean that has no claims.
    let pipe = folder.path().join("pipe.xml");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    assert_eq!(hook(&["README.md", "pipe.xml"]).0, Some(1));
    assert_eq!(
        run_in(folder.path(), &["verify", "--skip-others", "lab.json"]).code,
        2,
        "no option of `verify`"
    );
    // Without the option, a named file must be a lesson.
    let named = run_in(folder.path(), &["check", "package.json"]);
    assert_eq!(named.code, 1, "{}", named.stdout);
    assert_eq!(run_in(folder.path(), &["check", "README.md"]).code, 2);
}
