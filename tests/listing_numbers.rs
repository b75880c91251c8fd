//! `labspec check --listings`: numbers of the text that the output of a listing has.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::{is_available, needs};
use crate::program::run_in;
use crate::support::model_text;
use serde_json::Value;

const LAB: &str = "```lab simlab\n{\"model\": \"free_fall\", \"stopAt\": 0.3, \"readouts\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]}\n```\n";

/// Eleven numbers that the output has.
const TEXT: &str = "# A fall of 0.9500 m

It lands after 0.4401 s, or 0.44 s. It is at 4.317 m/s then, about 4.3 m/s.

| height (m) | time (s) | speed (m/s) |
|---|---|---|
| 0.950 | 0.440 | 4.32 |
| 0.95 | 0.440 | 4.317 |
";

const LISTING: &str = "```python
import math
print(f\"{0.95:.4f} m: t = {math.sqrt(2 * 0.95 / 9.81):.4f} s, v = {math.sqrt(2 * 9.81 * 0.95):.3f} m/s\")
```
Output:
```text
0.9500 m: t = 0.4401 s, v = 4.317 m/s
```
";

/// A folder with the lesson, or `None` where listings cannot run.
fn folder(text: &str) -> Option<tempfile::TempDir> {
    if !needs("python3") || !needs("../shared/corpus") {
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("models")).unwrap();
    std::fs::write(folder.path().join("models/free_fall.xml"), model_text("free_fall")).unwrap();
    std::fs::write(folder.path().join("a.md"), text).unwrap();
    let network = if is_available("unshare") { "" } else { "network = true" };
    std::fs::write(folder.path().join("labspec.toml"), format!("[listings]\n{network}\n")).unwrap();
    Some(folder)
}

/// The report of a check, and its text for people; `None` where listings cannot run.
fn check(text: &str, options: &[&str]) -> Option<(Value, String)> {
    let folder = folder(text)?;
    let human = run_in(folder.path(), &[&["check", "a.md"], options].concat()).stdout;
    let done = run_in(folder.path(), &[&["check", "a.md", "--format", "json"], options].concat());
    let report = serde_json::from_str(&done.stdout).unwrap_or_else(|e| panic!("{e}: {}", done.stderr));
    Some((report, human))
}

/// The texts of the numbers that outputs have, and those that findings name as unclaimed.
fn numbers(report: &Value, text: &str) -> (Vec<String>, Vec<String>) {
    let marked = |row: &Value| {
        let byte = |key: &str| row[key].as_u64().unwrap() as usize;
        text[byte("start")..byte("end")].to_string()
    };
    let rows = |list: &str, key: &str, value: &str| -> Vec<String> {
        report[list].as_array().unwrap().iter().filter(|row| row[key] == value).map(marked).collect()
    };
    (rows("ledger", "subject", "printedNumber"), rows("findings", "code", "numbers-unclaimed"))
}

#[test]
fn numbers_of_an_output_that_was_printed_are_counted() {
    let text = format!("{TEXT}\n{LAB}\n{LISTING}");
    let Some((report, human)) = check(&text, &["--listings"]) else { return };
    let (printed, unclaimed) = numbers(&report, &text);
    assert_eq!(printed.len(), 11, "{printed:?} {unclaimed:?}");
    assert_eq!(unclaimed, [""; 0], "{:#}", report["findings"]);
    let counts = &report["summary"]["claims"];
    assert_eq!(
        (counts["printedNumber"]["simulated"].as_u64(), &counts["quotedNumber"]["simulated"]),
        (Some(11), &0.into())
    );
    assert!(human.contains("1 listing as displayed, 11 numbers in the output of listings"), "{human}");
    assert!(human.contains("printed    listing #1, 11 numbers of the text"), "{human}");
}

#[test]
fn a_changed_number_of_the_text_is_unclaimed_again() {
    let text = format!("{TEXT}\n{LAB}\n{LISTING}");
    for (right, wrong) in [
        ("0.4401 s", "0.4411 s"),
        ("0.44 s", "0.45 s"),
        ("| 4.32 |", "| 4.33 |"),
        ("# A fall of 0.9500", "# A fall of 0.9600"),
    ] {
        let planted = text.replacen(right, wrong, 1);
        let Some((report, _)) = check(&planted, &["--listings"]) else { return };
        let (printed, unclaimed) = numbers(&report, &planted);
        assert_eq!(printed.len(), 10, "{wrong}: {printed:?}");
        let number =
            wrong.trim_matches(|c: char| !c.is_ascii_digit() && c != 's').trim_start_matches("A fall of ");
        assert!(unclaimed.len() == 1 && unclaimed[0].starts_with(number), "{number}: {unclaimed:?}");
    }
}

/// Numbers of the text in other units than those of the output; a changed digit is unclaimed again.
#[test]
fn units_of_outputs_are_converted() {
    let units = "# A fall of 950 mm\n\nIt lands after 440.1 ms, or 440 ms. It is at 15.54 km/h then, and that is 432 cm/s.\n";
    let text = format!("{units}\n{LAB}\n{LISTING}").replace("```python", "It fell 9.5e2 mm.\n\n```python");
    let Some((report, human)) = check(&text, &["--listings"]) else { return };
    let (printed, unclaimed) = numbers(&report, &text);
    assert_eq!(
        printed,
        ["950 mm", "440.1 ms", "440 ms", "15.54 km/h", "432 cm/s", "9.5e2 mm"],
        "{unclaimed:?}"
    );
    assert_eq!(unclaimed, [""; 0]);
    assert!(human.contains("6 numbers in the output of listings"), "{human}");
    for (right, wrong) in [
        ("A fall of 950 mm", "A fall of 960 mm"),
        ("440.1 ms", "440.2 ms"),
        ("or 440 ms", "or 450 ms"),
        ("15.54 km/h", "15.55 km/h"),
        ("432 cm/s", "433 cm/s"),
        ("432 cm/s", "432 mm/s"),
        ("9.5e2 mm", "9.6e2 mm"),
    ] {
        let planted = text.replacen(right, wrong, 1);
        let Some((report, _)) = check(&planted, &["--listings"]) else { return };
        let (printed, _) = numbers(&report, &planted);
        let number = wrong.trim_start_matches("A fall of ").trim_start_matches("or ");
        assert!(printed.len() == 5 && !printed.contains(&number.to_string()), "{wrong}: {printed:?}");
    }
}

#[test]
fn nothing_is_claimed_by_an_output_that_differs_or_did_not_run() {
    let text = format!("{TEXT}\n{LAB}\n{LISTING}");
    let wrong = text.replace("```text\n0.9500 m", "```text\n0.9501 m");
    let fails = text.replace("import math\n", "import math\nraise ValueError\n");
    let varies =
        text.replace("import math\n", "import math, os\n").replace("print(f\"", "print(os.getcwd(), f\"");
    for (text, options) in
        [(&text, &[][..]), (&wrong, &["--listings"]), (&fails, &["--listings"]), (&varies, &["--listings"])]
    {
        let Some((report, human)) = check(text, options) else { return };
        let (printed, unclaimed) = numbers(&report, text);
        assert_eq!((printed, unclaimed), (vec![], vec!["0.9500 m".to_string()]), "{:#}", report["findings"]);
        assert!(!human.contains("in the output of listings"), "{human}");
    }
}

/// In a lesson without labs nothing is unclaimed, unless outputs have most of its numbers.
#[test]
fn a_lesson_without_labs_has_unclaimed_numbers_beside_an_output() {
    let text = format!("{TEXT}\n{LISTING}").replace("or 0.44 s", "or 0.45 s");
    let Some((report, _)) = check(&text, &["--listings"]) else { return };
    let message = report["findings"][0]["message"].as_str().unwrap();
    assert_eq!(numbers(&report, &text).1, ["0.45 s"], "{report:#}");
    assert!(
        message.contains("no output of a listing has it, unlike nearly all of the other 10 numbers"),
        "{message}"
    );
    let Some((report, _)) = check(&text, &[]) else { return };
    assert_eq!(numbers(&report, &text), (vec![], vec![]));
}

/// The cells of a table that displays an output were compared themselves; they are claimed with the unit of their column.
#[test]
fn numbers_in_a_displayed_table_are_claimed() {
    let text = "It is 3.75 mm after 0.2 s, not 3.75 s.\n\n```python\nfor i in (1, 2):\n    print(i / 10, i * 1.875)\n```\nOutput:\n\n| time (s) | height (mm) |\n|---|---|\n| 0.1 | 1.875 |\n| 0.2 | 3.75 |\n";
    let Some((report, _)) = check(text, &["--listings"]) else { return };
    assert_eq!(numbers(&report, text).0, ["3.75 mm"], "{report:#}");
}

/// A number that `verify` quotes is counted once.
#[test]
fn quoted_numbers_stay_quoted() {
    let verify = "\"verify\": {\"runs\": {\"fall\": {\"until\": 0.3}}, \"measure\": {\"t\": \"final(data.time)\"}, \"says\": [[\"0.300 s\", \"t\"]]}, ";
    let text = format!(
        "It ends at 0.300 s.\n\n{}\n```python\nprint('0.300 s')\n```\n```text\n0.300 s\n```\n",
        LAB.replace("\"stopAt\"", &format!("{verify}\"stopAt\""))
    );
    let Some((report, _)) = check(&text, &["--listings"]) else { return };
    let counts = &report["summary"]["claims"];
    assert_eq!(
        (&counts["quotedNumber"]["computed"], &counts["printedNumber"]["simulated"]),
        (&1.into(), &0.into()),
        "{report:#}"
    );
}

/// The page of a check lists the numbers that nothing claims.
#[test]
fn the_page_of_a_check_counts_the_numbers_of_outputs_as_claimed() {
    let text = format!("{TEXT}\n{LAB}\n{LISTING}");
    for (options, is_claimed) in [(&[][..], false), (&["--listings"], true)] {
        let Some(folder) = folder(&text) else { return };
        run_in(folder.path(), &[&["check", "a.md", "--html", "page.html"], options].concat());
        let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
        assert_eq!(page.contains("that nothing claims"), !is_claimed, "{options:?}");
    }
}
