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

/// The workflow, the action and the hook use existing commands and options of the program.
#[test]
fn callers_of_the_program_use_existing_commands() {
    let read = |name: &str| std::fs::read_to_string(workspace().join(name)).unwrap();
    let help = run(&["check", "--help"]).stdout;
    for (file, words) in
        [("action.yml", vec!["--format", "github"]), (".pre-commit-hooks.yaml", vec!["labspec check"])]
    {
        let text = read(file);
        for word in words {
            assert!(text.contains(word), "{file}: {word}");
            assert!(help.contains(word), "{word}");
        }
    }
}
