//! `labspec check --html FILE`: one page that contains every claim of a course, loads nothing, runs nothing, and contains no
//! information about the machine on which it was written. The page is also XML, so that an XML parser checks its nesting.

#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

use crate::program::{folder, run_in};
use crate::support::{model_text, workspace};
use labspec::bind::scene::Models;
use labspec::check;
use labspec::lint::{ModelFolder, load_lesson, load_lesson_file};
use labspec::source::SourceFile;
use labspec::spec::{QuestionKind, Quiz};
use labspec::verify::plain;
use roxmltree::{Document, Node, ParsingOptions};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::OnceLock;

/// The elements that a page may contain.
const ELEMENTS: &str = "a article b bdi body caption circle code dd desc details div dl dt figure footer g h1 h2 h3 h4 head \
                        header html li line main meta ol p path polyline rect section span style sub summary sup svg table tbody td \
                        text th thead title tr tspan ul";
/// The attributes that it may contain.
const ATTRIBUTES: &str = "aria-hidden aria-label charset class content cx cy d dy fill font-family font-size font-weight height \
                          href http-equiv id lang name open points r role scope start stroke stroke-dasharray stroke-linecap \
                          stroke-linejoin stroke-width style text-anchor transform viewBox width x x1 x2 y y1 y2";
/// Colours of pictures that are visible on white and on black.
const ON_BOTH: [&str; 4] = ["none", "#cc79a7", "#e69f00", "#56b4e9"];

fn parse(page: &str) -> Document<'_> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(page, options).unwrap_or_else(|e| {
        let line = page.lines().nth(e.pos().row as usize - 1).unwrap_or("");
        panic!("{e}: {}", line.chars().take(400).collect::<String>())
    })
}

/// The visible text of an element, with normalized spaces.
fn visible_text(node: Node<'_, '_>) -> String {
    let all: String = node.descendants().filter(Node::is_text).filter_map(|t| t.text()).collect();
    all.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn with_class<'a, 'i>(node: Node<'a, 'i>, class: &str) -> Vec<Node<'a, 'i>> {
    let has = |n: &Node<'_, '_>| n.attribute("class").is_some_and(|all| all.split(' ').any(|c| c == class));
    node.descendants().filter(has).collect()
}

/// Nothing is loaded, nothing runs, and every link leads to an element of the page.
fn check_harmless(page: &str) {
    let tree = parse(page);
    let ids: Vec<&str> = tree.descendants().filter_map(|n| n.attribute("id")).collect();
    let unique: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(ids.len(), unique.len(), "two elements have one id");
    for node in tree.descendants().filter(Node::is_element) {
        let name = node.tag_name().name();
        assert!(ELEMENTS.split_whitespace().any(|e| e == name), "<{name}>");
        for attribute in node.attributes() {
            let (key, value) = (attribute.name(), attribute.value());
            assert!(ATTRIBUTES.split_whitespace().any(|a| a == key), "<{name} {key}={value:?}>");
            if key == "href" {
                assert!(unique.contains(value.strip_prefix('#').unwrap()), "a link to {value}");
            }
            if key == "style" {
                let width = value.strip_prefix("width:").and_then(|v| v.strip_suffix('%')).unwrap();
                assert!((0.0..=100.0).contains(&width.parse::<f64>().unwrap()), "{value}");
            }
        }
    }
    for loads in ["url(", "@import", "<script", "javascript:"] {
        assert!(!page.contains(loads), "{loads}");
    }
    let hidden = |c: &char| {
        (c.is_control() && *c != '\n') || matches!(c, '\u{200e}'..='\u{200f}' | '\u{202a}'..='\u{202e}')
    };
    assert_eq!(page.chars().find(hidden), None);
}

/// The page for these paths, and the JSON report of the same check.
fn page_of(folder: &Path, arguments: &[&str]) -> (String, Value) {
    let out = tempfile::tempdir().unwrap();
    let file = out.path().join("page.html");
    let mut all = vec!["check"];
    all.extend(arguments);
    all.extend(["--format", "json", "--html", file.to_str().unwrap()]);
    let done = run_in(folder, &all);
    assert!(done.code <= 1 || done.code == 3, "{}", done.stderr);
    (std::fs::read_to_string(&file).unwrap(), serde_json::from_str(&done.stdout).unwrap())
}

const COURSE: [&str; 3] = ["specs/lessons", "--models", "specs/models"];

/// The page of our own course: two checks of it are sufficient for all tests.
fn course() -> &'static (String, Value) {
    static PAGE: OnceLock<(String, Value)> = OnceLock::new();
    PAGE.get_or_init(|| page_of(&workspace(), &[&COURSE[..], &["--jobs", "4"]].concat()))
}

#[test]
fn the_page_contains_every_question_with_its_verdict() {
    let (page, report) = course();
    let tree = parse(page);
    let word = |claim: &Value| claim["answer"]["verdict"].as_str().unwrap_or("open").to_string();
    let lessons = report["lessons"].as_array().unwrap();
    let sections = with_class(tree.root(), "lesson");
    assert_eq!(sections.len(), lessons.len());
    let models = ModelFolder::open(&workspace().join("specs/models")).unwrap();
    let (mut questions, mut measures, mut quotes) = (0, 0, 0);
    for (section, lesson) in sections.iter().zip(lessons) {
        let file = lesson["file"].as_str().unwrap();
        assert_eq!(visible_text(section.first_element_child().unwrap()), file.rsplit('/').next().unwrap());
        let verdicts: BTreeMap<&str, String> = lesson["claims"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| (c["name"].as_str().unwrap(), word(c)))
            .collect();
        let articles: BTreeMap<String, Node<'_, '_>> = with_class(*section, "claim")
            .into_iter()
            .map(|a| (visible_text(with_class(a, "name")[0]), a))
            .collect();
        let read = load_lesson_file(&workspace().join(file), &models).unwrap();
        for quiz in &read.quizzes {
            for (n, question) in Quiz::numbered(quiz) {
                questions += 1;
                let name = format!("quiz {}, question {n}", quiz.id.as_ref().map_or("", |t| t.as_str()));
                let article = articles.get(&name).unwrap_or_else(|| panic!("{file}: {name}"));
                let expected = verdicts.get(name.as_str()).map_or("open", String::as_str);
                assert!(
                    visible_text(with_class(*article, "verdict")[0]).ends_with(expected),
                    "{file}: {name}"
                );
                // A formula of one letter is displayed as that letter.
                let normal = |html: &str| {
                    plain(html).replace('$', "").split_whitespace().collect::<Vec<_>>().join(" ")
                };
                assert_eq!(visible_text(with_class(*article, "asked")[0]), normal(&question.q.value));
                let QuestionKind::Choice { options, .. } = &question.kind else { continue };
                let items: Vec<Node<'_, '_>> =
                    with_class(*article, "options")[0].children().filter(Node::is_element).collect();
                assert_eq!(items.len(), options.len());
                for (i, (item, option)) in items.iter().zip(options).enumerate() {
                    let keyed = question.right_option() == Some(i);
                    let text = format!("{}{}", normal(&option.value), if keyed { " key" } else { "" });
                    assert_eq!(visible_text(item.first_element_child().unwrap()), text);
                    assert_eq!(item.attribute("class") == Some("key"), keyed);
                    if let Some(condition) = question.verify.as_ref().and_then(|v| v.options.get(i)) {
                        let held = visible_text(with_class(*item, "condition")[0]);
                        let is_stated = condition.value.trim() == "undecided" || held.contains("hold");
                        assert!(is_stated, "{file}: {name}: {held}");
                    }
                }
            }
        }
        // Every measure and every quoted number, with its value.
        for claim in lesson["claims"].as_array().unwrap() {
            let name = claim["name"].as_str().unwrap();
            let found =
                articles.iter().find(|(title, _)| *title == name || title.starts_with(&format!("{name} ")));
            let article = *found.unwrap_or_else(|| panic!("{file}: {name}")).1;
            let text = visible_text(article);
            let rows = article.descendants().filter(|n| n.has_tag_name("tr"));
            let rows: Vec<Vec<String>> =
                rows.map(|row| row.children().filter(Node::is_element).map(visible_text).collect()).collect();
            for (measure, value) in claim["measures"].as_object().unwrap() {
                measures += 1;
                let row =
                    rows.iter().find(|row| row[0] == *measure).unwrap_or_else(|| panic!("{file}: {measure}"));
                // Six digits are displayed.
                let agrees = |x: f64, text: &str| (text.parse::<f64>().unwrap() - x).abs() <= 5e-6 * x.abs();
                if let Some(x) = value["value"].as_f64() {
                    assert!(agrees(x, &row[1]), "{file}: {name}: {row:?}");
                }
                match value["halved"].as_f64() {
                    Some(x) => assert!(agrees(x, &row[2]), "{file}: {name}: {row:?}"),
                    None => {
                        assert!(row[2].parse::<f64>().map_or(row[2] == "–", |x| !x.is_finite()), "{row:?}")
                    }
                }
            }
            for quote in claim["quotes"].as_array().unwrap() {
                quotes += 1;
                let quoted = quote["text"].as_str().unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
                assert!(text.contains(&quoted), "{file}: {name}: {quoted}");
            }
        }
    }
    assert!(
        questions > 25 && measures > 60 && quotes > 60,
        "{questions} questions, {measures} measures, {quotes} quotes"
    );
}

#[test]
fn the_page_of_a_course_loads_nothing_and_is_small() {
    let (page, _) = course();
    check_harmless(page);
    assert!(page.len() < 1_500_000, "{} bytes", page.len());
    let tree = parse(page);
    let pictures =
        tree.descendants().filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "svg"))).count();
    assert!(pictures > 30, "{pictures} pictures");
    // The XML namespace of SVG is not an address that is loaded.
    let rest = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    assert!(!rest.contains("src=") && !rest.contains("<link"));
}

/// In dark mode, every colour of a picture is replaced by a suitable one.
#[test]
fn pictures_are_visible_in_dark_mode() {
    let (page, _) = course();
    let tree = parse(page);
    let style = visible_text(tree.descendants().find(|n| n.has_tag_name("style")).unwrap());
    let dark = style.split("prefers-color-scheme: dark").nth(1).unwrap();
    let inside =
        tree.descendants().filter(|n| n.tag_name().namespace() == Some("http://www.w3.org/2000/svg"));
    let mut colours = BTreeSet::new();
    for node in inside {
        for key in ["fill", "stroke"] {
            colours.extend(node.attribute(key).map(|value| format!("[{key}=\"{value}\"]")));
        }
    }
    assert!(colours.len() > 8);
    for colour in &colours {
        let fine = ON_BOTH.iter().any(|c| colour.contains(&format!("\"{c}\"")));
        assert!(fine || dark.contains(&format!("svg {colour}")), "{colour}");
    }
}

#[test]
fn the_same_course_gives_the_same_bytes() {
    let one = page_of(&workspace(), &[&COURSE[..], &["--jobs", "1"]].concat()).0;
    assert!(one == course().0);
}

/// The page does not depend on the location of the course.
#[test]
fn the_page_contains_no_path_of_the_machine() {
    let folder = folder();
    let whole = folder.path().canonicalize().unwrap();
    let absolute = page_of(&whole, &[whole.to_str().unwrap()]).0;
    let relative = page_of(&whole, &["."]).0;
    assert!(!absolute.contains(whole.to_str().unwrap()));
    assert_eq!(absolute, relative);
    check_harmless(&absolute);
    for part in ["✗</span> refuted", "wrong.md", "unknown-field", "0.450 s", "in the baseline"] {
        assert_eq!(absolute.contains(part), part != "in the baseline", "{part}");
    }
}

/// Contents of a lesson that would have an effect in a browser or a terminal, or mislead a reader.
const HOSTILE: [&str; 8] = [
    "$<script>alert(1)</script>_{<b onclick=alert(1)>}\\u202e$ $x^{<img src=x>}$ $\\\\frac{<i>}{2}$",
    "<script>alert(1)</script>",
    "\\\"><img src=x onerror=alert(1)>",
    "</style></title><svg onload=alert(1)>",
    "a\\u0000b\\u001b[2Jc\\u009b",
    "\\u202edeifirev\\u2066\\u200f",
    "]]>&#x3c;script&#x3e;<!--",
    "' onmouseover='alert(1)",
];

#[test]
fn text_of_lessons_is_text() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("models")).unwrap();
    std::fs::write(folder.path().join("models/free_fall.xml"), model_text("free_fall")).unwrap();
    let [long, option] = [20_000, 250_000].map(|n| format!("<b>{}", "<i>é&".repeat(n)));
    for (i, bad) in HOSTILE.into_iter().chain([long.as_str()]).enumerate() {
        let lab = format!(
            r#"{{"model": "free_fall", "title": "{bad}", "stopAt": 0.1,
              "plots": [{{"ylabel": "{bad}", "refLines": [{{"y": 1, "label": "{bad}"}}], "traces": [{{"label": "{bad}", "expr": "data.qpos[2]"}}]}}],
              "verify": {{"runs": {{"{bad}": {{"until": 0.1}}, "other": {{"until": 0.1}}}},
                "measure": {{"high": "final(data.qpos[2])"}}, "says": [["{bad} 1 m", "other.high"], ["0.951 m", "other.high"]],
                "exact": {{"{bad}": "1 - 4.905 * data.time * data.time"}}}}}}"#
        );
        let option = if bad.len() > 1000 { option.as_str() } else { bad };
        let quiz = format!(
            r##"{{"id": "{bad}", "questions": [
              {{"kind": "mcq", "q": "{bad}", "options": ["{option}", "right"], "answer": 1, "explain": "{bad}",
                "verify": {{"lab": "#1", "measure": {{"high": "final(data.qpos[2])"}}, "options": ["high > 2 || '{}' === 'x'", "high < 2"]}}}},
              {{"kind": "numeric", "q": "{bad}", "answer": 1, "unit": "{bad}"}}, {{"kind": "open", "q": "{bad}", "reference": "{bad}"}}]}}"##,
            bad.replace('\'', "")
        );
        let raw: String = serde_json::from_str(&format!("\"{bad}\"")).unwrap();
        let text = format!(
            "# {raw}\n\nIt falls {raw} 0.951 m, {raw} 3 m.\n\n```lab\n{lab}\n```\n\n```quiz\n{quiz}\n```\n"
        );
        std::fs::write(folder.path().join(format!("{i}.md")), text).unwrap();
        let (page, report) = page_of(folder.path(), &[&format!("{i}.md")]);
        check_harmless(&page);
        assert!(page.len() < 400_000, "{} bytes", page.len());
        let tree = parse(&page);
        let asked: Vec<String> = with_class(tree.root(), "asked").into_iter().map(visible_text).collect();
        assert_eq!(asked.len(), 3, "{report:#}");
    }
}

/// The numbers that the page lists as unclaimed are those that the rule reports.
#[test]
fn unclaimed_numbers_are_those_of_the_rule() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("models")).unwrap();
    let numbers: Vec<String> = (1..=10).map(|n| format!("{n} m")).collect();
    let says: Vec<Value> =
        (1..=10).map(|n| serde_json::json!([format!("{n} m"), format!("0.5 * {}", 2 * n)])).collect();
    let quiz = serde_json::json!({"id": "long", "questions": [
        {"kind": "numeric", "q": "How long is it?", "answer": 3, "tol": 0.1, "unit": "m",
         "verify": {"value": "1.5 * 2", "says": says}}]});
    let text =
        format!("# Long\n\nIt is {}, below 20 m, and 11 m.\n\n```quiz\n{quiz}\n```\n", numbers.join(", "));
    std::fs::write(folder.path().join("a.md"), text).unwrap();
    let (page, report) = page_of(folder.path(), &["a.md"]);
    let messages: Vec<&str> =
        report["findings"].as_array().unwrap().iter().filter_map(|f| f["message"].as_str()).collect();
    assert_eq!(messages, ["no `verify` quotes 11 m, although nearly all of the other 10 numbers are quoted"]);
    let tree = parse(&page);
    let listed: Vec<String> = with_class(tree.root(), "numbers")[0]
        .descendants()
        .filter(|n| n.has_tag_name("b"))
        .map(visible_text)
        .collect();
    assert_eq!(listed, ["11 m"]);
    assert_eq!(
        visible_text(with_class(tree.root(), "whole")[0]),
        "Questions 1 of 1 have a check Numbers with units 10 of 11 are claimed"
    );
}

/// Simple formulas are rendered, others are displayed as written: in questions, options and explanations.
#[test]
fn formulas_are_read() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("models")).unwrap();
    let quiz = serde_json::json!({"id": "fall", "questions": [{
        "kind": "mcq", "q": "It falls $0.442\\,\\mathrm{s}$ at $g$ = $9.81\\,\\mathrm{m/s^2}$. How <b>fast</b> is it?",
        "options": ["$v = \\sqrt{2gd}$", "$v \\approx v_0 e^{-t/\\tau}$", "for $5 and $6"], "answer": 0,
        "explain": "<p>$\\tfrac12 m v^2 = m g d$, so it is $4.3 \\times 10^{-3}$ km/s.</p>"}]});
    std::fs::write(folder.path().join("a.md"), format!("# A fall\n\n```quiz\n{quiz}\n```\n")).unwrap();
    let (page, _) = page_of(folder.path(), &["a.md"]);
    check_harmless(&page);
    let tree = parse(&page);
    let one = |class: &str| with_class(tree.root(), class)[0];
    assert_eq!(visible_text(one("asked")), "It falls 0.442 s at g = 9.81 m/s2. How fast is it?");
    let options: Vec<Node<'_, '_>> = one("options").children().filter(Node::is_element).collect();
    let texts: Vec<String> = options.iter().map(|o| visible_text(o.first_element_child().unwrap())).collect();
    assert_eq!(texts, ["v = \\sqrt{2gd} key", "v ≈ v0 e-t/τ", "for $5 and $6"]);
    assert_eq!(visible_text(one("explained")), "\\tfrac12 m v^2 = m g d, so it is 4.3×10-3 km/s.");
    let all = |name: &str| -> Vec<String> {
        tree.descendants().filter(|n| n.has_tag_name(name)).map(visible_text).collect()
    };
    assert_eq!(all("code"), ["v = \\sqrt{2gd}", "\\tfrac12 m v^2 = m g d"]);
    assert_eq!(
        (all("sup"), all("sub")),
        (["2", "-t/τ", "-3"].map(String::from).into(), vec!["0".to_string()])
    );
}

/// Each run is listed with its actions and its initial settings, which equal those of the record.
#[test]
fn runs_have_their_settings_beside_them() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("models")).unwrap();
    let model = "<mujoco><option cone='elliptic'/><worldbody><body name='ball' pos='0 0 1'><freejoint/>\
        <geom name='ball' size='.1' mass='1'/></body></worldbody><keyframe><key name='high' qpos='0 0 3 1 0 0 0'/></keyframe></mujoco>";
    std::fs::write(folder.path().join("models/ball.xml"), model).unwrap();
    let lab = r#"{"model": "ball", "stopAt": 0.2,
      "controls": [{"label": "h", "set": "model.opt.timestep", "min": 0.001, "max": 0.01, "step": 0.001, "value": 0.002},
                   {"type": "button", "label": "Kick", "run": "data.qvel[2] = 1"}],
      "controller": "data.qfrc_applied[0] = 0",
      "verify": {"runs": {"plain": {}, "all": {"model": {"body ball pos": [0, 0, 2]}, "key": "high", "set": {"h": 0.004}, "press": [["Kick", 0.1]],
          "setup": "model.opt.gravity[2] = -1.5", "controller": "", "until": 0.5, "stop": "data.qpos[2] < 0.1"},
          "many": {"sweep": {"h": [0.001, 0.005]}, "steps": 10}},
        "measure": {"z": "final(data.qpos[2])"}, "says": [["0.8 m", "plain.z"]]}}"#;
    let steady = lab.replace(r#""many": {"sweep": {"h": [0.001, 0.005]}, "steps": 10}"#, r#""last": {}"#);
    let steady = steady
        .replace(r#""set": {"h": 0.004}, "#, "")
        .replace(r#""setup": "model.opt.gravity[2] = -1.5", "#, "");
    for (name, lab) in [("a.md", lab), ("b.md", steady.as_str())] {
        std::fs::write(
            folder.path().join(name),
            format!("# A fall\n\nIt is at 0.8 m.\n\n```lab\n{lab}\n```\n"),
        )
        .unwrap();
    }
    let record = folder.path().join("record.json");
    let (page, _) = page_of(folder.path(), &["a.md", "--record", record.to_str().unwrap()]);
    check_harmless(&page);
    let rows = |page: &str| -> (String, Vec<Vec<String>>) {
        let tree = parse(page);
        let of = |t: &Node<'_, '_>| t.descendants().find(|n| n.has_tag_name("caption")).map(visible_text);
        let runs = tree.descendants().filter(|n| n.has_tag_name("table"));
        let table = runs.into_iter().find(|t| of(t).is_some_and(|c| c.starts_with("Runs"))).unwrap();
        let lines = table.descendants().filter(|n| n.has_tag_name("tr")).skip(1);
        let cells = lines.map(|row| row.children().filter(Node::is_element).map(visible_text).collect());
        (of(&table).unwrap(), cells.collect())
    };
    let (caption, all) = rows(&page);
    assert_eq!(caption, "Runs");
    let done: Vec<[&str; 2]> = all.iter().map(|row| [row[0].as_str(), row[2].as_str()]).collect();
    assert_eq!(
        done,
        [
            ["plain", "as the lab stands"],
            [
                "all",
                "body ball pos = 0 0 2; keyframe \"high\"; h = 0.004; setup model.opt.gravity[2] = -1.5; no controller; Kick pressed at 0.1 s; until 0.5 s; stops at data.qpos[2] < 0.1"
            ],
            ["many[0]", "h = 0.001; 10 steps"],
            ["many[1]", "h = 0.005; 10 steps"],
        ]
    );
    // The record contains the same settings.
    let record: Value = serde_json::from_str(&std::fs::read_to_string(record).unwrap()).unwrap();
    let recorded = record["lessons"][0]["claims"][0]["runs"].as_array().unwrap();
    assert_eq!(recorded.len(), all.len());
    for (row, run) in all.iter().zip(recorded) {
        let s = &run["settings"];
        let expected = format!(
            "timestep {} s, {}, solver {} (at most {} iterations, tolerance {}), {} cone",
            s["timestep"],
            s["integrator"].as_str().unwrap(),
            s["solver"].as_str().unwrap(),
            s["iterations"],
            "1e-8",
            s["cone"].as_str().unwrap()
        );
        assert!(row[3].starts_with(&expected), "{} and not {expected}", row[3]);
        assert_eq!(row[3].ends_with(", gravity 0 0 -1.5"), row[0] == "all", "{}", row[3]);
    }
    // Settings shared by all runs are stated once.
    let (caption, all) = rows(&page_of(folder.path(), &["b.md"]).0);
    assert!(caption.starts_with("Runs all with timestep 0.002 s, Euler, solver Newton"), "{caption}");
    assert!(all.iter().all(|row| row.len() == 3), "{all:?}");
}

/// A page never overwrites a lesson.
#[test]
fn a_lesson_is_not_overwritten() {
    let folder = folder();
    let before = std::fs::read_to_string(folder.path().join("clean.md")).unwrap();
    let done = run_in(folder.path(), &["check", "clean.md", "--html", "clean.md"]);
    assert_eq!(done.code, 2, "{}", done.stdout);
    assert!(done.stderr.contains("would overwrite a lesson"), "{}", done.stderr);
    assert_eq!(std::fs::read_to_string(folder.path().join("clean.md")).unwrap(), before);
}

/// The curves belong to the runs: they begin where the run begins, end where it stops, and show its measured values.
#[test]
fn curves_are_those_of_the_runs() {
    let folder = folder();
    let models = ModelFolder::open(&folder.path().join("models")).unwrap();
    let text = r#"{"model": "free_fall",
      "controls": [{"label": "start", "set": "data.qpos[2]", "min": 0.5, "max": 3, "value": 1}],
      "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}, {"traces": [{"label": "speed", "expr": "-data.qvel[2]"}]}],
      "verify": {"runs": {"low": {"until": 1, "stop": "data.qpos[2] < 0.5"}, "high": {"set": {"start": 2}, "until": 2, "stop": "data.qpos[2] < 0.5"}},
        "measure": {"t": "final(data.time)", "v": "final(-data.qvel[2])"},
        "says": [["1 s", "low.t"]]}}"#;
    let lesson = load_lesson(SourceFile::new("a.json", text), &models);
    let models = Models::new(models);
    let drawn = check::curves(&lesson, &models);
    let checked = check::check_lesson(lesson, &models, check::CheckLevel::CLAIMS);
    let measures = &checked.claims[0].judgement.measures;
    assert_eq!(drawn.len(), 1);
    let [low, high] = drawn[0].runs.as_slice() else { panic!("{drawn:?}") };
    assert_eq!([low.run.as_str(), high.run.as_str()], ["low", "high"]);
    for (run, start) in [(low, 1.0), (high, 2.0)] {
        let measured =
            |m: &str| measures.iter().find(|x| x.name == format!("{}.{m}", run.run)).unwrap().value;
        assert_eq!(run.plots.len(), 2);
        assert_eq!((run.times[0], run.values[0][0], run.values[1][0]), (0.0, start, 0.0));
        assert!(run.times.len() > 50 && run.times.len() <= 302);
        assert!(run.times.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(
            [measured("t"), measured("v")],
            [*run.times.last().unwrap(), *run.values[1].last().unwrap()]
        );
    }
}
