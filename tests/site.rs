//! `labspec build`: the pages of a course. What lessons write runs nothing, what was not verified carries no mark, and the same course
//! gives the same bytes.

#![allow(clippy::unwrap_used)]

use crate::docs_site::values;
use crate::program::{Done, run_in};
use std::collections::BTreeMap;
use std::path::Path;

/// Replacements of the scripts and styles of pages.
const PAGE: [&str; 11] = [
    "site.js",
    "site.css",
    "sw.js",
    "elements.js",
    "engine.js",
    "labspec.wasm",
    "katex.js",
    "katex.css",
    "preview.js",
    "editor.js",
    "preview.css",
];

/// A folder with `page`, and with a course in `course`.
pub(crate) fn course(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page");
    std::fs::create_dir(&page).unwrap();
    PAGE.iter().for_each(|name| std::fs::write(page.join(name), format!("/* {name} */")).unwrap());
    for (name, text) in files {
        let path = folder.path().join("course").join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

fn build(folder: &Path, more: &[&str]) -> Done {
    run_in(folder, &[&["build", "course", "--out", "site", "--page", "page"], more].concat())
}

/// A page of the site.
pub(crate) fn page(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join("site").join(name)).unwrap()
}

/// The files of the site, by their names in it.
pub(crate) fn all_files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let (site, mut all) = (folder.join("site"), BTreeMap::new());
    let mut open = vec![site.clone()];
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()));
        } else {
            let name = path.strip_prefix(&site).unwrap().to_str().unwrap().to_string();
            all.insert(name, std::fs::read(&path).unwrap());
        }
    }
    all
}

/// A lesson, built.
fn built(text: &str) -> String {
    let folder = course(&[("a.md", text)]);
    build(folder.path(), &[]);
    page(folder.path(), "a.html")
}

/// The main part of a page.
fn main_of(html: &str) -> &str {
    html.split_once("<main").unwrap().1.split_once("</main>").unwrap().0
}

const BALL: &str =
    "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>";
const TRUE_LESSON: &str = r##"# Falling

From 1 m, the ball is at 0.5 m after a while.

```lab simlab
{"title": "Fall", "model": "ball", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}],
 "plots": [{"ylabel": "height (m)", "traces": [{"label": "ball", "expr": "data.qpos[2]"}]}],
 "verify": {"runs": {"fall": {"until": 0.32}}, "measure": {"height": "final(data.qpos[2])"}, "says": [["0.5 m", "height"]]}}
```

```quiz
{"id": "fall", "questions": [
  {"q": "Where is it?", "options": ["below 0.6 m", "above"], "answer": 0,
   "verify": {"lab": "#1", "runs": {"fall": {"until": 0.32}}, "measure": {"height": "final(data.qpos[2])"}, "options": ["height < 0.6", "height > 0.6"]}},
  {"q": "And why?", "options": ["gravity", "magic"], "answer": 0}]}
```
"##;

#[test]
fn every_part_of_a_course_has_its_place() {
    let folder = course(&[
        ("models/ball.xml", BALL),
        ("a.md", TRUE_LESSON),
        (
            "week 2/b.md",
            "# Next\n\nSee [the fall](../a.md#falling), [a lab](../a.md#lab-1), [data](d.csv) and $x^2$.\n\n| a | b |\n|--:|---|\n| 1 | 2 |\n",
        ),
        ("week 2/d.csv", "1"),
    ]);
    let done = build(folder.path(), &["--title", "Mechanics & more", "--base-url", "https://example.org/m"]);
    assert!(done.code == 0 || done.code == 1, "{}{}", done.stdout, done.stderr);
    let [a, b] = ["a.html", "week 2/b.html"].map(|name| page(folder.path(), name));
    assert!(a.contains("<title>Falling · Mechanics &amp; more</title>"), "{a}");
    assert!(a.contains("<sim-lab id=\"lab-1\"") && a.contains("<lesson-quiz id=\"quiz-fall\""), "{a}");
    assert_eq!(a.matches("<script type=\"model/mjcf\" data-name=\"ball\">").count(), 1, "{a}");
    assert!(a.contains("rel=\"next\" href=\"week%202/b.html\"") && !a.contains("rel=\"prev\""), "{a}");
    assert!(
        !a.contains("page/katex.css") && b.contains("../page/katex.css"),
        "only a page with formulas loads KaTeX"
    );
    for link in ["../a.html#falling", "../a.html#lab-1", "../files/week%202/d.csv"] {
        assert!(b.contains(&format!("href=\"{link}\"")), "{link}: {b}");
    }
    assert!(b.contains("<span class=\"math\">x^2</span>") && b.contains("<th class=\"end\">a</th>"), "{b}");
    let index = page(folder.path(), "index.html");
    assert!(
        index.contains("href=\"week%202/b.html\">Next</a>") && index.contains("From 1 m, the ball"),
        "{index}"
    );
    assert!(page(folder.path(), "labs.html").contains("href=\"a.html#lab-1\">Fall</a>"));
    let sitemap = page(folder.path(), "sitemap.xml");
    assert!(sitemap.contains("<loc>https://example.org/m/week%202/b.html</loc>"), "{sitemap}");
    let search: serde_json::Value = serde_json::from_str(&page(folder.path(), "search.json")).unwrap();
    assert!(
        search.as_array().unwrap().iter().any(|entry| entry["text"].as_str().unwrap().contains("0.5 m")),
        "{search}"
    );
    let worker = page(folder.path(), "sw.js");
    assert!(worker.contains("const VERSION = \"") && worker.contains("\"week%202/b.html\""), "{worker}");
}

#[test]
fn several_folders_are_one_site_whose_first_page_is_a_lesson() {
    let folder = course(&[
        ("labspec.toml", ""),
        (
            "docs/README.md",
            "# Guide\n\n[a](../lessons/a.md#falling), [b](more/b.md), [code](../src/main.rs#L3), [all](../src/), [none](../src/none.rs)\n",
        ),
        ("docs/more/b.md", "# More\n\n[back](../README.md#guide)\n"),
        ("lessons.md", "# Not asked for\n"),
        ("lessons/a.md", TRUE_LESSON),
        ("lessons/models/ball.xml", BALL),
        ("src/main.rs", "fn main() {}\n"),
    ]);
    let arguments = ["build", "course/docs", "course/lessons/a.md", "--out", "site", "--page", "page"];
    let named = ["--index", "course/docs/README.md", "--sources", "https://example.org/tree"];
    let done = run_in(folder.path(), &[&arguments[..], &named].concat());
    assert!(done.code < 2, "{}{}", done.stdout, done.stderr);
    let index = page(folder.path(), "index.html");
    for link in [
        "lessons/a.html#falling",
        "docs/more/b.html",
        "https://example.org/tree/src/main.rs#L3",
        "https://example.org/tree/src",
    ] {
        assert!(index.contains(&format!("href=\"{link}\"")), "{link}: {index}");
    }
    assert!(index.contains("<span class=\"dead-link\">none</span>"), "{index}");
    assert!(page(folder.path(), "docs/more/b.html").contains("href=\"../../index.html#guide\""));
    let list = page(folder.path(), "lessons.html");
    assert!(
        list.contains("href=\"lessons/a.html#lab-1\">Fall</a>") && list.contains("href=\"index.html\">Guide")
    );
    assert!(
        index.contains("href=\"lessons.html\">All pages</a>") && !list.contains("Not asked for"),
        "{index}"
    );
    // Without the two options, the first page is the list, and a link to a source is none.
    let done = run_in(folder.path(), &arguments);
    assert!(done.code < 2, "{}{}", done.stdout, done.stderr);
    assert!(page(folder.path(), "docs/README.html").contains("<span class=\"dead-link\">code</span>"));
    assert!(page(folder.path(), "index.html").contains("href=\"docs/README.html\">Guide"));
    for (wrong, why) in [
        (["--index", "course/lessons.md"], "is not among the lessons"),
        (["--index", "course/none.md"], "is not among the lessons"),
        (["--sources", "javascript:x"], "write an address"),
    ] {
        let done = run_in(folder.path(), &[&arguments[..], &wrong].concat());
        assert!(done.code == 2 && done.stderr.contains(why), "{wrong:?}: {}", done.stderr);
    }
}

#[test]
fn a_lab_has_its_results_without_scripts() {
    let folder = course(&[
        ("models/ball.xml", BALL),
        ("a.md", TRUE_LESSON),
        ("b.md", "```lab simlab\n{\"model\": \"none\", \"title\": \"Broken\"}\n```\n"),
    ]);
    build(folder.path(), &[]);
    let html = page(folder.path(), "a.html");
    let twin = html.split_once("<div class=\"twin\">").unwrap().1;
    assert!(twin.contains("after 0.300 s") && twin.contains("<dt>height (m)</dt><dd>0.55"), "{twin}");
    assert!(twin.contains("<svg") && html.contains("<li>below 0.6 m</li>"), "{twin}");
    let broken = page(folder.path(), "b.html");
    assert!(broken.contains("This lab cannot run: "), "{broken}");
}

#[test]
fn a_comparison_of_integrators_has_a_table_without_scripts() {
    let lab = r#"{"title": "Fall", "model": "ball", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}],
 "verify": {"measure": {"height": "final(data.qpos[2])"}, "says": [["0.56 m", "RK4.height"]]}KEYS}"#;
    let lesson = |keys: &str| {
        format!("# A fall\n\nIt ends at 0.56 m.\n\n```lab integrators\n{}\n```\n", lab.replace("KEYS", keys))
    };
    let folder = course(&[
        ("models/ball.xml", BALL),
        ("all.md", &lesson("")),
        ("two.md", &lesson(r#", "integrators": ["RK4", "Euler"]"#)),
        ("wrong.md", &lesson(r#", "integrators": ["</script>", 1]"#)),
    ]);
    build(folder.path(), &[]);
    let html = page(folder.path(), "two.html");
    assert!(
        html.contains("<sim-lab id=\"lab-1\"") && html.contains(r#""integrators":["RK4","Euler"]"#),
        "{html}"
    );
    assert!(!html.contains("\"verify\""), "{html}");
    let twin = html.split_once("<div class=\"twin\">").unwrap().1;
    let heads = "<th scope=\"col\">RK4</th><th scope=\"col\">Euler</th>";
    assert!(twin.contains("after 0.300 s") && twin.contains(heads), "{twin}");
    assert!(twin.contains("<tr><th scope=\"row\">height (m)</th><td>0.5"), "{twin}");
    let drift = twin.split_once("<tr><th scope=\"row\">largest energy drift</th>").unwrap().1;
    assert!(drift.split_once("</tr>").unwrap().0.ends_with("<td>0.0029</td>"), "{twin}");
    assert!(twin.contains("<svg"), "{twin}");
    // An element recognizes a comparison by its list.
    for name in ["all.html", "wrong.html"] {
        let html = page(folder.path(), name);
        assert!(
            html.contains(r#""integrators":["Euler","RK4","implicit","implicitfast"]"#),
            "{name}: {html}"
        );
    }
}

#[test]
fn a_model_with_files_is_copied_with_them() {
    let model = |file: &str| {
        format!(
            "<mujoco><!-- </script> --><asset><mesh name='m' file='{file}'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>"
        )
    };
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    let lesson =
        "# M\n\n```lab simlab\n{\"model\": \"solid\"}\n```\n\n```lab simlab\n{\"model\": \"plain\"}\n```\n";
    let (inside, outside) = (model("parts/m.obj"), model("../m.obj"));
    let files =
        [("week/a.md", lesson), ("models/parts/m.obj", mesh), ("m.obj", mesh), ("models/plain.xml", BALL)];
    let folder = course(&[&files[..], &[("models/solid.xml", &inside)]].concat());
    let done = build(folder.path(), &[]);
    assert!(done.code != 2, "{}", done.stderr);
    let html = page(folder.path(), "week/a.html");
    assert!(html.contains("data-models=\"../models/1/\"") && !html.contains("data-name=\"solid\""), "{html}");
    assert!(html.contains("data-name=\"plain\""), "{html}");
    assert_eq!(
        (page(folder.path(), "models/1/solid.xml"), page(folder.path(), "models/1/parts/m.obj")),
        (inside, mesh.to_string())
    );
    let folder = course(&[&files[..], &[("models/solid.xml", &outside), ("labspec.toml", "")]].concat());
    let done = build(folder.path(), &[]);
    assert!(
        done.code == 1
            && done.stdout.contains("the model `solid` reads `../m.obj`, which is not in its folder"),
        "{}",
        done.stdout
    );
}

#[test]
fn pictures_of_textures_are_copied_with_their_model() {
    let model = |file: &str| {
        format!(
            "<mujoco><compiler texturedir='t'/><asset><texture name='f' type='2d' file='{file}'/>\
             <texture name='c' type='cube' fileup='up.png'/><material name='f' texture='f'/><material name='c' texture='c'/></asset>\
             <worldbody><geom type='plane' size='1 1 1' material='f'/><body pos='0 0 1'><freejoint/><geom size='0.1' material='c'/></body></worldbody></mujoco>"
        )
    };
    let lesson = "# T\n\n```lab simlab\n{\"model\": \"floor\", \"stopAt\": 0.01}\n```\n";
    let (there, missing) = (model("floor.png"), model("none.png"));
    let files = [
        ("a.md", lesson),
        ("models/t/floor.png", "a picture"),
        ("models/t/up.png", "another"),
        ("labspec.toml", ""),
    ];
    let folder = course(&[&files[..], &[("models/floor.xml", &there)]].concat());
    let done = build(folder.path(), &[]);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    let html = page(folder.path(), "a.html");
    assert!(html.contains("data-models=\"models/1/\"") && !html.contains("data-name=\"floor\""), "{html}");
    let copied =
        ["floor.xml", "t/floor.png", "t/up.png"].map(|name| page(folder.path(), &format!("models/1/{name}")));
    assert_eq!(copied, [there.as_str(), "a picture", "another"]);
    // The hash of the page changes with the picture, so that a preview shows it.
    let hash = |html: &str| values(html, "data-models-hash").next().unwrap().to_string();
    std::fs::write(folder.path().join("course/models/t/floor.png"), "a new picture").unwrap();
    build(folder.path(), &[]);
    assert_ne!(hash(&page(folder.path(), "a.html")), hash(&html));
    // A picture that is missing is reported, and the lab runs.
    let folder = course(&[&files[..], &[("models/floor.xml", &missing)]].concat());
    let done = build(folder.path(), &[]);
    assert!(
        done.code == 1 && done.stdout.contains("the model `floor` reads `t/none.png`"),
        "{}",
        done.stdout
    );
    assert!(page(folder.path(), "a.html").contains("after 0.010 s"));
}

#[test]
fn only_what_this_build_verified_carries_the_mark() {
    let mark = |text: &str, model: &str, settings: &str| {
        let folder = course(&[("models/ball.xml", model), ("a.md", text), ("labspec.toml", settings)]);
        build(folder.path(), &[]);
        let html = page(folder.path(), "a.html");
        let marks = html
            .split("<p class=\"verified\">")
            .skip(1)
            .map(|m| m.split("<small>").next().unwrap().to_string());
        marks.map(|m| m.rsplit_once("</b>: ").unwrap().1.trim().to_string()).collect::<Vec<_>>()
    };
    assert_eq!(
        mark(TRUE_LESSON, BALL, ""),
        ["1 claim", "question 1 (1 claim)"],
        "a question without a claim has none"
    );
    // A wrong key, a wrong number in the text and in the claim, and another model.
    assert_eq!(mark(&TRUE_LESSON.replacen("\"answer\": 0", "\"answer\": 1", 1), BALL, ""), ["1 claim"]);
    assert_eq!(mark(&TRUE_LESSON.replace("0.5 m", "0.7 m"), BALL, ""), ["question 1 (1 claim)"]);
    assert_eq!(mark(TRUE_LESSON, &BALL.replace("0 0 1'", "0 0 1.2'"), ""), [""; 0]);
    // A claim that no longer parses, a broken block, and an error that the settings ignore.
    assert_eq!(mark(&TRUE_LESSON.replace("\"height < 0.6\"", "\"height <\""), BALL, ""), ["1 claim"]);
    assert_eq!(
        mark(&TRUE_LESSON.replace("{\"title\": \"Fall\", ", "{\"title\": \"Fall\" "), BALL, ""),
        [""; 0],
        "a lesson with a block that cannot be read has none"
    );
    let wrong = TRUE_LESSON.replacen("\"answer\": 0", "\"answer\": 1", 1);
    assert_eq!(
        mark(&wrong, BALL, "ignore = [\"answer-refuted\"]\n"),
        [""; 0],
        "a lesson with an ignored error"
    );
}

#[test]
fn a_course_has_content_packages_where_they_are_asked_for() {
    let folder = course(&[("models/ball.xml", BALL), ("a.md", TRUE_LESSON), ("week 2/b.md", "# Next\n")]);
    let at = |name: &str| folder.path().join("site").join(name);
    let done = build(folder.path(), &["--scorm", "--pass", "0.6"]);
    assert!(done.stdout.contains("2 content packages in scorm/"), "{}{}", done.stdout, done.stderr);
    let archive = std::fs::read(at("scorm/a.zip")).unwrap();
    assert!(archive.starts_with(b"PK\x03\x04") && at("scorm/week 2/b.zip").is_file());
    build(folder.path(), &["--scorm", "--pass", "0.6"]);
    assert_eq!(std::fs::read(at("scorm/a.zip")).unwrap(), archive, "the same course gives the same bytes");
    let [worker, list] = ["sw.js", "labspec-site.json"].map(|name| page(folder.path(), name));
    assert!(!worker.contains("scorm/") && list.contains("scorm/a.zip"), "{worker}{list}");
    assert!(!page(folder.path(), "a.html").contains("scorm"), "the page of the site reports to nobody");
    build(folder.path(), &[]);
    assert!(!at("scorm/a.zip").exists(), "a site without packages keeps none");
    for wrong in [&["--pass", "0.6"][..], &["--scorm", "--pass", "1.5"], &["--scorm", "--pass", "NaN"]] {
        assert_eq!(build(folder.path(), wrong).code, 2, "{wrong:?}");
    }
}

#[test]
fn the_same_course_gives_the_same_bytes_without_names_of_this_machine() {
    let files = [
        ("models/ball.xml", BALL),
        ("a.md", TRUE_LESSON),
        ("b/c.md", "# C\n\n```lab simlab\n{\"model\": \"no\"}\n```\n"),
    ];
    let folders = [course(&files), course(&files)];
    let [one, two] = [0, 1].map(|i| {
        build(folders[i].path(), &[]);
        all_files(folders[i].path())
    });
    assert_eq!(one, two);
    let name = folders[0].path().file_name().unwrap().to_str().unwrap();
    let names_it = |bytes: &Vec<u8>| String::from_utf8_lossy(bytes).contains(name);
    assert!(!one.values().any(names_it), "a page names a folder of this machine");
    // A second build into the same folder removes what the course has no more.
    std::fs::remove_file(folders[0].path().join("course/b/c.md")).unwrap();
    build(folders[0].path(), &[]);
    assert!(!folders[0].path().join("site/b/c.html").exists());
}

#[test]
fn hostile_lessons_run_nothing() {
    let html = built(concat!(
        "# A <script>alert(1)</script> {onclick=alert(1) .x}\n\n<img src=x onerror=alert(1)> [x](javascript:alert(1)) <javascript:alert(1)>\n\n",
        "<iframe src=//x></iframe><a href=\"data:text/html,x\">y</a> ![z](https://x/z.png) <style>*{}</style></main></body>\n\n",
        "[ref]: javascript:alert(1)\n[ref] <sim-lab></sim-lab> <!--labspec--> \n\n",
        "````\"onclick=alert(1)\ncode </code><script>alert(1)</script>\n````\n\n",
        "```lab simlab\n{\"title\": \"</script><script>alert(1)</script><!--\", \"xml\": \"<mujoco><!--</script><script>--></mujoco>\"}\n```\n\n",
        "```lab \"><script>alert(1)</script>\n{}\n```\n\n```quiz\n{\"id\": \"'><script>alert(1)</script>\", \"questions\": [{\"q\": \"<script>alert(1)</script>$<img src=x onerror=alert(1)>$\", \"options\": [\"<svg onload=alert(1)>\", \"b\"], \"answer\": 0}]}\n```\n",
    ));
    let main = main_of(&html);
    // What is left are scripts with data: no other element, attribute or address runs.
    let without_data =
        main.split("<script type=\"application/json\">").enumerate().map(|(i, part)| match i {
            0 => part,
            _ => part.split_once("</script>").unwrap().1,
        });
    let visible: String = without_data.collect();
    for part in [
        "<script",
        "<iframe",
        "<style",
        "<svg onload",
        "=\"javascript:",
        "=\"data:text",
        "</body>",
        "<sim-lab></sim-lab>",
    ] {
        assert!(!visible.contains(part), "{part}: {visible}");
    }
    // The only images are the pictures of the lab.
    let images: Vec<&str> = visible.split("<img").skip(1).collect();
    assert!(
        !images.is_empty() && images.iter().all(|rest| rest.starts_with(" src=\"pictures/")),
        "{visible}"
    );
    let tags = visible.split('<').filter_map(|part| part.split_once('>')).map(|(tag, _)| tag);
    assert!(tags.clone().count() > 20 && tags.into_iter().all(|tag| !tag.contains(" on")), "{visible}");
    assert_eq!(main.matches("<sim-lab").count(), 1, "{main}");
    assert!(html.contains("script-src &#39;self&#39; &#39;wasm-unsafe-eval&#39;"), "{html}");
    assert_eq!(html.matches("<main").count() + html.matches("<footer").count(), 2);
}

#[test]
fn fences_are_those_of_the_check() {
    let html = built(concat!(
        "- in a list\n\n  ```lab simlab\n  {\"xml\": \"<mujoco/>\", \"title\": \"Listed\"}\n  ```\n\n> ```quiz\n> {\"id\": \"q\", \"questions\": []}\n> ```\n\n",
        "<details><summary>More</summary>\n\n```lab simlab\n{\"xml\": \"<mujoco/>\", \"title\": \"Hidden\"}\n```\n\n</details>\n\nAfter\n\n",
        "    ```lab simlab\n    {\"xml\": \"<mujoco/>\"}\n    ```\n\n````md\n```lab simlab\n{}\n```\n````\n\n",
        "```lab simlab\n{\"xml\": \"<mujoco/>\", \"title\": \"Lost end\"}\nStill prose.\n\n```quiz\n{\"id\": \"r\", \"questions\": []}\n```\n",
    ));
    let main = main_of(&html);
    let labs: Vec<&str> = ["Listed", "Hidden", "Lost end"]
        .into_iter()
        .filter(|title| main.contains(&format!("\"title\":\"{title}\"")))
        .collect();
    assert_eq!(labs, ["Listed", "Hidden", "Lost end"]);
    assert!(main.contains("Still prose.") && main.contains("<p>After</p>"), "{main}");
    assert!(main.contains("<details><summary>More</summary>") && main.contains("</details>"), "{main}");
    assert!(!main.contains("&lt;!--labspec--&gt;") && !main.contains("<!--labspec-->"), "{main}");
}

#[test]
fn an_own_folder_is_replaced_and_no_other() {
    let folder = course(&[("a.md", "# A\n")]);
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("site")).unwrap();
    std::fs::write(at("site/mine.txt"), "mine").unwrap();
    let done = build(folder.path(), &[]);
    assert!(done.code == 2 && done.stderr.contains("did not write"), "{}", done.stderr);
    assert_eq!(std::fs::read_dir(at("site")).unwrap().count(), 1);
    for out in [".", "course"] {
        let done = run_in(folder.path(), &["build", "course", "--out", out, "--page", "page"]);
        assert_eq!(done.code, 2, "{out}: {}", done.stdout);
    }
    let done = run_in(folder.path(), &["build", "course", "--out", "other", "--page", "course"]);
    assert!(
        done.code == 2 && done.stderr.contains("xtask") && done.stderr.contains("--page"),
        "{}",
        done.stderr
    );
    for wrong in [["--base-url", "javascript:x"], ["--base-url", "https://x/\"><b>"], ["--lang", "\"><b>"]] {
        assert_eq!(
            run_in(
                folder.path(),
                &[&["build", "course", "--out", "other", "--page", "page"], &wrong[..]].concat()
            )
            .code,
            2
        );
    }
    // A list of files that names one outside removes nothing there.
    std::fs::write(at("kept.txt"), "kept").unwrap();
    std::fs::create_dir(at("old")).unwrap();
    std::fs::write(
        at("old/labspec-site.json"),
        r#"{"site": "labspec", "files": ["../kept.txt", "gone.html"]}"#,
    )
    .unwrap();
    run_in(folder.path(), &["build", "course", "--out", "old", "--page", "page"]);
    assert!(at("kept.txt").exists() && at("old/a.html").exists());
}
