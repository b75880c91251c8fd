#![allow(clippy::unwrap_used, clippy::panic)] // a panic is the report of a failed test

use super::compare::MAX_DIFFERENCES;
use super::decimal::segments;
use super::*;
use crate::finding::Finding;
use crate::ledger::State;
use crate::lint::{ModelFolder, load_lesson};
use crate::source::SourceFile;
use crate::spec::Lesson;

fn lesson(text: &str) -> Lesson {
    load_lesson(SourceFile::new("a.md", text), &ModelFolder::unknown())
}

/// The findings of the only listing of a lesson, and its result.
fn check(text: &str, run: &ListingRun) -> (Vec<Finding>, ListingResult) {
    let lesson = lesson(text);
    let listings = pair_listings(&lesson);
    let [listing] = listings.as_slice() else { panic!("{} listings in {text}", listings.len()) };
    let mut findings = Vec::new();
    let result = check_listing(listing, run, &mut findings);
    (findings, result)
}

fn with_output(output: &str) -> String {
    format!("# A\n\n```python\nprint(1)\n```\nOutput:\n```text\n{output}\n```\n\nText.\n")
}

/// The marked texts of the differences between a displayed and a printed output.
fn differences(displayed: &str, printed: &str) -> Vec<String> {
    let text = with_output(displayed);
    let (findings, result) = check(&text, &ListingRun::Finished(printed.into()));
    assert_eq!(findings.is_empty(), matches!(result.state, State::True(_)), "{result:?}");
    findings.iter().map(|f| text[f.span.clone()].to_string()).collect()
}

fn is_same(displayed: &str, printed: &str) -> bool {
    differences(displayed, printed).is_empty()
}

#[test]
fn numbers_are_compared_by_their_displayed_digits() {
    let right = [
        ("0.44", "0.4401"),
        ("0.4", "0.44"),
        ("1", "0.96"),
        ("10.0", "9.96"),
        ("100", "99.7"),
        ("0.13", "0.125"),
        ("0.12", "0.125"),
        ("-0.0", "0.0"),
        ("0.0", "-0.0"),
        ("0.00", "-0.004"),
        ("1.2e-05", "1.2346e-05"),
        ("1.23e+3", "1234.6"),
        ("1e2", "100"),
        ("1E+10", "1e10"),
        ("−0.5", "-0.5"),
        ("+0.5", "0.5"),
        ("007", "7"),
        ("0.0", "0.00e+00"),
        ("[1.5,-2.5]", "[1.50,-2.49]"),
        ("x=0.5", "x=0.5"),
        ("MuJoCo 3.14.0", "MuJoCo 3.14.0"),
        ("nan inf", "nan inf"),
        ("3.14.0", "3.14.0"),
        ("1e99999", "1e99999"),
    ];
    for (displayed, printed) in right {
        assert!(is_same(displayed, printed), "{displayed} {printed}");
    }
    let wrong = [
        ("0.4401", "0.44"),
        ("0.440", "0.44"),
        ("1.0", "1"),
        ("0.45", "0.4401"),
        ("0.43", "0.4401"),
        ("99", "99.7"),
        ("0.5", "-0.5"),
        ("1.24e-05", "1.2346e-05"),
        ("1.2e-06", "1.2346e-05"),
        ("100", "1e+02"),
        ("x2", "x3"),
        ("3.14.0", "3.14.1"),
        ("3.14", "3.14.0"),
        ("0", "0.6"),
        ("1", "1e99999"),
        ("1e9999", "1e-9999"),
        ("nan", "0.0"),
        ("0.0e+01", "0.00e+00"),
    ];
    for (displayed, printed) in wrong {
        assert!(!is_same(displayed, printed), "{displayed} {printed}");
    }
}

#[test]
fn numbers_in_words_are_found() {
    let numbers = |word: &str| -> Vec<String> {
        let numbers = segments(word).into_iter().filter(|s| s.number.is_some());
        numbers.map(|s| word[s.range].to_string()).collect()
    };
    assert_eq!(numbers("v=-1.5e-3m/s2"), ["-1.5e-3"]);
    assert_eq!(numbers("(1,-2,.5)"), ["1", "-2", ".5"]);
    assert_eq!(numbers("3-2"), ["3", "2"]);
    assert_eq!(numbers("x2 qpos[0]"), ["0"]);
    assert_eq!(numbers("3.14.0"), [""; 0]);
    assert_eq!(numbers("1+2j"), ["1", "2"]);
    assert_eq!(numbers("é1e"), [""; 0]);
    assert_eq!(numbers("−3°"), ["−3"]);
}

#[test]
fn differences_are_at_their_numbers_and_words() {
    let printed = "analytic: t = 0.4401 s, v = 4.317 m/s\nheavy: t = 0.4400 s\nlight: t = 0.4400 s\n";
    assert!(differences(printed, printed).is_empty());
    assert_eq!(differences(&printed.replace("4.317", "4.371"), printed), ["4.371"]);
    assert_eq!(differences(&printed.replace("heavy:", "Heavy:"), printed), ["Heavy:"]);
    assert_eq!(differences(&printed.replace("analytic: ", ""), printed), [""]);
    assert_eq!(differences(&printed.replace("m/s", "m / s"), printed), ["m / s"]);
    assert_eq!(differences(printed, &printed.replace("v = 4.317 ", "")), ["v = 4.317"]);
    // A missing line is one difference, an extra line too.
    assert_eq!(differences(&printed.replace("heavy: t = 0.4400 s\n", ""), printed), [""]);
    assert_eq!(differences(&printed.replace("light", "new line\nlight"), printed), ["new line"]);
    assert_eq!(differences("", "a\nb\n"), [""]);
    assert_eq!(differences("a", ""), ["a"]);
    assert!(differences("", "\n\n").is_empty());
}

#[test]
fn spaces_and_line_endings_do_not_matter() {
    assert!(is_same("a   1\n\n  b 2", "\n\na 1  \n\nb\t2\n\n"));
    let text = with_output("a 1\nb 2").replace('\n', "\r\n");
    let (findings, _) = check(&text, &ListingRun::Finished("a 1\r\nb 3\r\n".into()));
    let [finding] = findings.as_slice() else { panic!("{findings:?}") };
    assert_eq!(&text[finding.span.clone()], "2");
    let fix = finding.fix.clone().unwrap();
    let mut fixed = text.clone();
    fixed.replace_range(fix.span, &fix.text);
    assert_eq!(fixed, with_output("a 1\nb 3").replace('\n', "\r\n"));
}

/// Every digit of an output, replaced by every other one, is a difference at its number.
#[test]
fn every_changed_digit_is_a_difference() {
    let outputs = [
        "analytic: t = 0.4401 s, v = 4.317 m/s\nheavy at rest: centre z = 0.04987 m, penetration = 0.130 mm",
        "[[-1.50000000e-03  2.00000000e+00]\n [ 0.00000000e+00 -9.81000000e+00]]",
        "x1: 12 of 30 (40 %), MuJoCo 3.14.0, 2026-11-28 10:05:59, 0x1f, -0.0 007",
    ];
    let mut tried = 0;
    for output in outputs {
        assert!(is_same(output, output));
        for (at, c) in output.char_indices().filter(|(_, c)| c.is_ascii_digit()) {
            for digit in ('0'..='9').filter(|digit| *digit != c) {
                let mut changed = output.to_string();
                changed.replace_range(at..at + 1, &digit.to_string());
                tried += 1;
                let found = differences(&changed, output);
                assert_eq!(found.len(), 1, "{changed}: {found:?}");
            }
        }
    }
    assert!(tried > 800, "{tried}");
}

#[test]
fn a_fix_makes_the_output_that_of_the_listing() {
    let text = with_output("a 1\nb 2\nc 3");
    let printed = "a 1\nb 5  \nextra\nc 4\n";
    let (findings, result) = check(&text, &ListingRun::Finished(printed.into()));
    assert_eq!((result.state, findings.iter().filter(|f| f.fix.is_some()).count()), (State::False, 1));
    let fix = findings[0].fix.clone().unwrap();
    let mut fixed = text.clone();
    fixed.replace_range(fix.span, &fix.text);
    assert_eq!(fixed, with_output("a 1\nb 5\nextra\nc 4"));
    assert!(check(&fixed, &ListingRun::Finished(printed.into())).0.is_empty());
    // What would end the block, and what no file should contain, is not written.
    for printed in ["```\n", "  ~~~~\n", "\u{1b}[31mred\n"] {
        let (findings, _) = check(&text, &ListingRun::Finished(printed.into()));
        assert!(!findings.is_empty() && findings.iter().all(|f| f.fix.is_none()), "{printed}");
    }
    let quoted: String = text.lines().map(|line| format!("> {line}\n")).collect();
    let (findings, _) = check(&quoted, &ListingRun::Finished(printed.into()));
    assert!(!findings.is_empty() && findings.iter().all(|f| f.fix.is_none()));
    assert_eq!(&quoted[findings[0].span.clone()], "2");
}

#[test]
fn the_rows_of_a_table_are_the_last_printed_lines() {
    let table =
        "| timestep (s) | error (mm) |\n|---:|:--:|\n| 0.0005 | -0.7357 |\n| `0.0010` | **−1.47** |\n";
    let text =
        format!("```py file=a.py\nprint(1)\n```\n\n**Output with MuJoCo 3.14.0:**\n\n{table}\nText | 5\n");
    let printed = "h  error\n0.0005  -0.7357\n0.0010 | -1.4715\n";
    let marked = |text: &str| {
        let (findings, result) = check(text, &ListingRun::Finished(printed.into()));
        assert!(findings.iter().all(|f| f.fix.is_none()));
        let table = text.find("| time").unwrap()..text.find("\n\nText").unwrap();
        assert_eq!(result.span, table);
        findings.iter().map(|f| text[f.span.clone()].to_string()).collect::<Vec<_>>()
    };
    assert!(marked(&text).is_empty());
    assert_eq!(marked(&text.replace("0.7357", "0.7375")), ["-0.7375"]);
    assert_eq!(marked(&text.replace("−1.47", "−1.48")), ["−1.48"]);
    assert_eq!(marked(&text.replace("-0.7357 |", "|")), [""]);
    // More rows than were printed.
    let long = text.replace("| 0.0005", "| 1 | 2 |\n| 3 | 4 |\n| 0.0005");
    assert!(!check(&long, &ListingRun::Finished(printed.into())).0.is_empty());
}

#[test]
fn listings_are_paired_with_what_is_below_them() {
    let pairs = |text: &str| pair_listings(&lesson(text)).len();
    let code = "```python\nprint(1)\n```\n";
    assert_eq!(pairs(&with_output("1")), 1);
    for between in ["", "\n", "Output:\n\n", "**Output**:\n", "Ausgabe:\n", "Output of the script:\n"] {
        assert_eq!(pairs(&format!("{code}{between}```text\n1\n```\n")), 1, "{between}");
    }
    assert_eq!(pairs(&format!("{code}Output:\n```\n1\n```\n")), 1);
    // An unnamed fence is an output only below its line.
    assert_eq!(pairs(&format!("{code}\n```\n1\n```\n")), 0);
    for other in [
        "A sentence.\n\n```text\n1\n```\n",
        "Output:\n\nA sentence.\n\n```text\n1\n```\n",
        "Output:\n```json\n1\n```\n",
        "Output:\n```text file=a.txt\n1\n```\n",
        "Output:\n",
        "",
        "| a |\n|---|\n| 1 |\n",
        "Output:\n\n| a |\n| 1 |\n",
        "Output:\n\n| a |\n|---|\n",
    ] {
        assert_eq!(pairs(&format!("{code}{other}")), 0, "{other}");
    }
    assert_eq!(pairs("```js\n1\n```\nOutput:\n```text\n1\n```\n"), 0);
    let two = format!("{}{}", with_output("1"), with_output("2"));
    let read = lesson(&two);
    let names: Vec<String> = pair_listings(&read).iter().map(Listing::name).collect();
    assert_eq!(names, ["listing #1", "listing #2"]);
}

#[test]
fn a_path_that_leaves_the_folder_is_refused() {
    for (path, is_inside) in [
        ("a.py", true),
        ("examples/a.py", true),
        ("../x.py", false),
        ("a/../../x.py", false),
        ("/tmp/x.py", false),
        ("C:/x.py", false),
        ("..\\x.py", false),
        ("a/", false),
    ] {
        let text = with_output("1").replace("```python", &format!("```python file={path}"));
        let (findings, result) = check(&text, &ListingRun::Finished("1\n".into()));
        assert_eq!(findings.is_empty(), is_inside, "{path}: {findings:?}");
        assert_eq!(result.state == State::False, !is_inside, "{path}");
        assert!(findings.iter().all(|f| f.code == "listing-fails" && text[f.span.clone()].contains(path)));
    }
}

#[test]
fn an_exception_is_reported_at_the_line_of_the_listing() {
    let text = with_output("1")
        .replace("print(1)", "import math\n  \nmath.sqrt(-1)")
        .replace("```python", "```python file=ex/a.py");
    let errors = "Traceback (most recent call last):\n  File \"ex/a.py\", line 3, in <module>\n    math.sqrt(-1)\n  File \"/lib/ba.py\", line 1, in f\nValueError: math domain error\n";
    let (findings, result) = check(&text, &ListingRun::Failed(1, errors.into()));
    let [finding] = findings.as_slice() else { panic!("{findings:?}") };
    assert_eq!((finding.code, &text[finding.span.clone()]), ("listing-fails", "math.sqrt(-1)"));
    assert!(finding.message.contains("ValueError: math domain error"), "{}", finding.message);
    assert_eq!((result.state, result.word), (State::False, "fails"));
    // A line that the listing does not have, and no line at all.
    for errors in [errors.replace("line 3", "line 99"), errors.replace("ex/a.py", "b.py"), String::new()] {
        let (findings, _) = check(&text, &ListingRun::Failed(7, errors));
        assert_eq!(&text[findings[0].span.clone()], "```python file=ex/a.py");
    }
    let (findings, result) = check(&text, &ListingRun::NotRun("no interpreter".into(), "install one".into()));
    assert!(
        findings.is_empty()
            && result.state == State::Unchecked
            && result.remark == "no interpreter; install one"
    );
}

/// Long outputs are compared in linear time, and at most some of the differences are described.
#[test]
fn hostile_outputs_are_compared() {
    let lines = |word: &str| format!("{word} 1 2 3\n").repeat(20_000);
    let (findings, result) = check(&with_output(&lines("a")), &ListingRun::Finished(lines("b")));
    assert_eq!(findings.len(), MAX_DIFFERENCES + 1);
    assert_eq!(result.remark, "20000 differences");
    assert!(findings.iter().any(|f| f.message.contains("19980 more differences")), "{findings:?}");
    let long = "9".repeat(500_000);
    assert!(is_same(&long, &format!("{long}.4")) && !is_same(&format!("1{long}"), &format!("{long}.4")));
    assert!(is_same(&format!("1{}", "0".repeat(500_000)), &format!("{}.5", "9".repeat(500_000))));
    for odd in
        ["-", "--1", "+-1.", "...", "1..2", ".", "e5", "1e", "1e+", "−", "-−1e-1", "\u{0}1", "1\u{300}2"]
    {
        assert!(is_same(odd, odd) && !is_same(&format!("{odd}x"), odd), "{odd}");
    }
}
