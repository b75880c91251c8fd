//! Completion, hover, definitions, renames and repairs, as an editor receives them.

#![allow(clippy::unwrap_used)]

use crate::lsp_editor::{Editor, codes, edited, lab, marked, place};
use crate::program::{CLEAN, folder};
use serde_json::{Value, json};

#[test]
fn completions_know_the_language_the_model_and_the_format() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    for (inside, expected, not) in [
        ("\"setup\": \"data.joint('|')\"", "heavy_free", "heavy"),
        ("\"setup\": \"data.body(\\\"he|\\\")\"", "heavy", "heavy_free"),
        ("\"setup\": \"data.|\"", "qpos", "geom_size"),
        ("\"setup\": \"model.opt.|\"", "timestep", "qpos"),
        ("\"setup\": \"ctx.peak = 1\", \"controller\": \"ctx.|\"", "peak", "qpos"),
        ("\"setup\": \"const v = data.qvel; v.|\"", "length", "qpos"),
        ("\"setup\": \"Math.|\"", "hypot", "qpos"),
        ("\"setup\": \"lib.|\"", "energy", "ncon"),
        ("\"setup\": \"const speed = 1; |\"", "speed", "qpos"),
        ("\"con|\"", "controls", "model"),
        ("\"readouts\": [{\"label\": \"a\", |}]", "expr", "label"),
        ("\"dock\": |", "true", "model"),
        ("\"verify\": {\"measure\": {\"top\": \"max(data.|)\"}}", "qpos", "geom_size"),
        ("\"verify\": {\"measure\": {\"top\": \"1\"}, \"options\": [\"|\"]}", "top", "qpos"),
    ] {
        let (text, byte) = marked(&lab(inside));
        editor.did_open("c.md", &text);
        let all = editor.at("completion", "c.md", &text, byte);
        let labels: Vec<&str> =
            all.as_array().unwrap().iter().map(|i| i["label"].as_str().unwrap()).collect();
        assert!(labels.contains(&expected) && !labels.contains(&not), "{inside}: {labels:?}");
        // Applying the completion keeps the JSON valid.
        let item = all.as_array().unwrap().iter().find(|i| i["label"] == expected).unwrap();
        if item.get("textEdit").is_some() {
            let new = edited(&text, &json!([item["textEdit"]]));
            assert!(new.contains(expected) && new.ends_with("}\n```\n"), "{new}");
        }
    }
    // Also in a claim in a comment.
    for (inside, expected, not) in [
        ("{\"lab\": \"#1\", \"mea|\"}", "measure", "model"),
        ("{\"lab\": \"#1\", \"measure\": {\"top\": \"max(data.|)\"}}", "qpos", "geom_size"),
        ("{\"lab\": \"#1\", \"measure\": {\"top\": \"1\"}, \"says\": [[\"2\", \"|\"]]}", "top", "qpos"),
    ] {
        let lesson =
            format!("{}\n<!-- labspec verify {inside} -->\nIt falls for 2 s.\n", lab("\"dock\": true"));
        let (text, byte) = marked(&lesson);
        editor.did_open("c.md", &text);
        let all = editor.at("completion", "c.md", &text, byte);
        let labels: Vec<&str> =
            all.as_array().unwrap().iter().map(|i| i["label"].as_str().unwrap()).collect();
        assert!(labels.contains(&expected) && !labels.contains(&not), "{inside}: {labels:?}");
    }
    // In a model, the schema and its own names are completed and explained.
    let (text, byte) = marked("<mujoco><worldbody><geom type='|'/></worldbody></mujoco>");
    editor.did_open("models/new.xml", &text);
    let all = editor.at("completion", "models/new.xml", &text, byte);
    let capsule = all.as_array().unwrap().iter().find(|i| i["label"] == "capsule").unwrap();
    assert_eq!(edited(&text, &json!([capsule["textEdit"]])), text.replace("''", "'capsule'"));
    let hover = editor.at("hover", "models/new.xml", &text, byte);
    assert!(hover["contents"]["value"].as_str().unwrap().starts_with("**type**: one of"), "{hover}");
    // There are no completions in prose.
    editor.did_open("c.md", "# Title\n\nSome data.qpos\n");
    assert_eq!(editor.at("completion", "c.md", "# Title\n\nSome data.qpos\n", 15), json!([]));
    assert_eq!(editor.end(), 0);
}

#[test]
fn a_lab_that_compares_integrators_is_known_to_the_editor() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let fence = |inside: &str| format!("# Ein Würfel 𝄞\n\n```lab integrators\n{{{inside}}}\n```\n");
    let claim =
        "\"model\": \"ball_drop\", \"verify\": {\"measure\": {\"top\": \"1\"}, \"says\": [[\"1\", \"|\"]]}";
    for (inside, expected, not) in [
        ("\"model\": \"ball_drop\", \"|\"", "integrators", "model"),
        ("\"model\": \"ball_drop\", \"time|\"", "timestep", "model"),
        ("\"model\": \"ball_drop\", \"integrators\": [\"|\"]", "implicitfast", "timestep"),
        ("\"model\": \"ball_drop\", \"setup\": \"data.|\"", "qpos", "geom_size"),
        (claim, "RK4", "qpos"),
    ] {
        let (text, byte) = marked(&fence(inside));
        editor.did_open("i.md", &text);
        let all = editor.at("completion", "i.md", &text, byte);
        let labels: Vec<&str> =
            all.as_array().unwrap().iter().map(|i| i["label"].as_str().unwrap()).collect();
        assert!(labels.contains(&expected) && !labels.contains(&not), "{inside}: {labels:?}");
    }
    let hovered = |editor: &mut Editor, inside: &str| {
        let (text, byte) = marked(&fence(inside));
        editor.did_open("i.md", &text);
        editor.at("hover", "i.md", &text, byte)["contents"]["value"].as_str().unwrap_or("").to_string()
    };
    let key = hovered(&mut editor, "\"model\": \"ball_drop\", \"integ|rators\": [\"RK4\"]");
    assert!(key.starts_with("**integrators**: list of words"), "{key}");
    let name = hovered(&mut editor, "\"model\": \"ball_drop\", \"integrators\": [\"R|K4\"]");
    assert!(name.starts_with("**RK4**") && name.contains("Runge-Kutta"), "{name}");
    let found = editor.did_open("i.md", &fence("\"model\": \"ball_drop\", \"integrators\": [\"rk4\"]"));
    assert!(codes(&found).contains(&"integrators-list"), "{found}");
    assert_eq!(editor.end(), 0);
}

#[test]
fn a_hover_states_the_initial_value() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    for (inside, expected) in [
        ("\"setup\": \"data.qpos[|2] = 7\"", "z position, m"),
        ("\"setup\": \"data.qpos[2] = 7\", \"controller\": \"ctx.z = data.qpos[|2]\"", "= **7**"),
        ("\"setup\": \"data.qpos[2] = 7\", \"controller\": \"ctx.z = data.q|pos\"", "= **[-0.2, 0, 7"),
        ("\"readouts\": [{\"label\": \"a\", \"expr\": \"model.opt.time|step\"}]", "= **0.002**"),
        ("\"readouts\": [{\"label\": \"a\", \"expr\": \"lib.bodyPos('heavy')[|2]\"}]", "= **"),
        ("\"set|up\": \"data.qpos[2] = 7\"", "code: statements"),
        ("\"key\": 99, \"setup\": \"while (true) {}\", \"controller\": \"data.q|vel[2] = 0\"", "velocities"),
    ] {
        let (text, byte) = marked(&lab(inside));
        editor.did_open("h.md", &text);
        let hover = editor.at("hover", "h.md", &text, byte);
        let hover = hover["contents"]["value"].as_str().unwrap_or("").to_string();
        assert!(hover.contains(expected), "{inside}: {hover}");
    }
    assert_eq!(editor.end(), 0);
}

#[test]
fn a_name_leads_to_the_model_and_back() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    editor.did_open("clean.md", CLEAN);
    let model = std::fs::read_to_string(folder.path().join("models/ball_drop.xml")).unwrap();
    let byte = CLEAN.find("'heavy_geom'").unwrap() + 3;
    let there = editor.at("definition", "clean.md", CLEAN, byte);
    assert_eq!(there[0]["uri"], editor.uri("models/ball_drop.xml").as_str());
    let at = model.find("\"heavy_geom\"").unwrap() + 1;
    assert_eq!(there[0]["range"]["start"], place(&model, at));
    let uri = editor.uri("models/ball_drop.xml");
    let document = json!({"uri": uri, "languageId": "xml", "version": 1, "text": model});
    editor.notify("textDocument/didOpen", json!({"textDocument": document}));
    let back = editor.at("definition", "models/ball_drop.xml", &model, at + 2);
    let uris: Vec<&str> = back.as_array().unwrap().iter().map(|l| l["uri"].as_str().unwrap()).collect();
    assert!(
        uris.contains(&editor.uri("clean.md").as_str()) && uris.contains(&editor.uri("course/a.md").as_str()),
        "{uris:?}"
    );
    // The name of a model leads to its file.
    let byte = CLEAN.find("\"ball_drop\"").unwrap() + 3;
    assert_eq!(editor.at("definition", "clean.md", CLEAN, byte)["uri"], uri.as_str());
    assert_eq!(editor.end(), 0);
}

/// Claims in comments, and claims about labs of other lessons, are renamed and checked like all others.
#[test]
fn claims_in_comments_are_code() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let claim = |lab: &str, name: &str| {
        format!(
            "<!-- labspec verify {{\"lab\": \"{lab}\", \"runs\": {{\"fall\": {{}}}}, \"measure\": {{\"top\": \"max(data.body('{name}').xpos[2])\"}}, \"says\": [[\"high\", \"top > 0.2\"]]}} -->\nIt is high.\n"
        )
    };
    let text =
        format!("{}\n{}\n{}", lab("\"dock\": true"), claim("#1", "heavy"), claim("clean.md#1", "heavy"));
    std::fs::write(folder.path().join("said.md"), &text).unwrap();
    assert_eq!(codes(&editor.did_open("said.md", &text)), [""; 0]);
    let byte = text.find("heavy').xpos").unwrap() + 2;
    let hover = editor.at("hover", "said.md", &text, byte);
    assert!(hover["contents"]["value"].as_str().unwrap_or("").contains("heavy"), "{hover}");
    let answer = editor.try_at("rename", "said.md", &text, byte, json!({"newName": "iron"})).unwrap();
    let edits = &answer["changes"][editor.uri("said.md").as_str()];
    let new = edited(&text, edits);
    assert_eq!(new.matches("'iron'").count(), 2, "{new}");
    // An unknown name is reported in both.
    let wrong = text.replace("'heavy'", "'haevy'");
    editor.did_open("said.md", &wrong);
    let found = editor.did_open("said.md", &wrong);
    assert_eq!(codes(&found), ["unknown-object"; 2], "{found}");
    assert_eq!(editor.end(), 0);
}

/// After a rename, the program reports the same about the whole course; if it would not, nothing is renamed.
#[test]
fn a_rename_keeps_the_course_true() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    editor.did_open("clean.md", CLEAN);
    let byte = CLEAN.find("'heavy_geom'").unwrap() + 3;
    let range = editor.at("prepareRename", "clean.md", CLEAN, byte);
    assert_eq!(range["placeholder"], "heavy_geom");
    let answer = editor.try_at("rename", "clean.md", CLEAN, byte, json!({"newName": "iron_geom"})).unwrap();
    let changes = answer["changes"].as_object().unwrap();
    let files: Vec<&str> =
        changes.keys().map(|uri| uri.strip_prefix(&format!("{}/", editor.root)).unwrap()).collect();
    // The lesson next to other models is not changed.
    assert_eq!(files, ["clean.md", "course/a.md", "models/ball_drop.xml", "wrong.md"]);
    for (uri, edits) in changes {
        let path = folder.path().join(uri.strip_prefix(&format!("{}/", editor.root)).unwrap());
        let text = std::fs::read_to_string(&path).unwrap();
        let new = edited(&text, edits);
        assert!(new.contains("iron_geom") && !new.contains("heavy_geom"), "{new}");
        std::fs::write(path, new).unwrap();
    }
    for lesson in ["clean.md", "course/a.md"] {
        let done = crate::program::run_in(folder.path(), &["check", lesson, "--models", "models"]);
        assert_eq!(done.code, 0, "{}", done.stdout);
    }
    assert_eq!(editor.end(), 0);
}

#[test]
fn a_rename_that_is_not_certain_is_refused() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let heavy = "data.body('he|avy').xpos[2]";
    for (inside, new, why) in [
        (format!("\"setup\": \"ctx.z = {heavy}\""), "light", "already"),
        (format!("\"setup\": \"ctx.z = {heavy}\""), "a b\"", "escape"),
        (format!("\"setup\": \"ctx.z = {heavy}\""), "", "at least one character"),
        (format!("\"setup\": \"ctx.z = {heavy}; ctx.name = 'heavy'\""), "iron", "or something else"),
        (
            format!("\"setup\": \"ctx.z = {heavy}; ctx.w = data.body('h\\u0065avy').xpos[2]\""),
            "iron",
            "escapes",
        ),
    ] {
        let (text, byte) = marked(&lab(&inside));
        editor.did_open("r.md", &text);
        let refused = editor.try_at("rename", "r.md", &text, byte, json!({"newName": new})).unwrap_err();
        assert!(refused["message"].as_str().unwrap().contains(why), "{inside}: {refused}");
    }
    assert_eq!(editor.end(), 0);
}

#[test]
fn repairs_are_offered_and_made() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    let text = lab(
        "\"titel\": \"A\", \"readouts\": [{\"label\": \"a\", \"expr\": \"data.qpos[2]\"}, {\"label\": \"a\", \"expr\": \"data.qpos[9]\"}]",
    );
    let found = editor.did_open("f.md", &text);
    assert!(
        codes(&found).contains(&"unknown-key") && codes(&found).contains(&"duplicate-readout"),
        "{found}"
    );
    let whole = json!({"start": place(&text, 0), "end": place(&text, text.len())});
    let ask = |only: Value| json!({"textDocument": {"uri": ""}, "range": whole, "context": {"diagnostics": [], "only": only}});
    let mut asked = ask(json!(["quickfix"]));
    asked["textDocument"]["uri"] = editor.uri("f.md").into();
    let all = editor.ask("textDocument/codeAction", asked).unwrap();
    let offered = |title: &str| {
        let found = all.as_array().unwrap().iter().find(|a| a["title"].as_str().unwrap().contains(title));
        found.unwrap_or_else(|| panic!("{title} in {all}")).clone()
    };
    let made = |action: &Value| edited(&text, &action["edit"]["documentChanges"][0]["edits"]);
    assert!(made(&offered("title")).contains("\"title\": \"A\""));
    let suppressed = made(&offered("suppress `duplicate-readout`"));
    assert!(
        suppressed.contains("\"lint\": {\"allow\": [\"duplicate-readout\"], \"why\": \"\"}"),
        "{suppressed}"
    );
    // With a reason, the finding is suppressed.
    let suppressed = suppressed.replace("\"why\": \"\"", "\"why\": \"on purpose\"");
    assert!(!codes(&editor.did_open("f.md", &suppressed)).contains(&"duplicate-readout"));
    let mut asked = ask(json!(["source.fixAll"]));
    editor.did_open("f.md", &text);
    asked["textDocument"]["uri"] = editor.uri("f.md").into();
    let all = editor.ask("textDocument/codeAction", asked).unwrap();
    assert!(all.as_array().unwrap().iter().all(|a| a["kind"] == "source.fixAll.labspec"), "{all}");
    assert_eq!(editor.end(), 0);
}

/// If the dimension is known, it is displayed, also for variables and functions, which have no declared unit.
#[test]
fn a_hover_states_the_dimension() {
    let folder = folder();
    let mut editor = Editor::open(folder.path());
    for (inside, expected) in [
        (
            "\"controller\": \"ctx.v = Math.hypot(data.qvel[0], data.qvel[1]); ctx.w = ctx.|v\"",
            Some("is in m/s"),
        ),
        (
            "\"controller\": \"ctx.v = 1000 * data.qvel[0]\", \"setup\": \"ctx.w = ctx.|v\"",
            Some("is in mm/s"),
        ),
        ("\"readouts\": [{\"label\": \"a\", \"expr\": \"model.body_mass[|1]\"}]", Some("is in kg")),
        ("\"readouts\": [{\"label\": \"a\", \"expr\": \"data.ti|me\"}]", Some("is in s")),
        // If it is uncertain, or the value is dimensionless, nothing is displayed.
        ("\"controller\": \"ctx.v = data.time > 1 ? data.qvel[0] : data.qpos[0]; ctx.w = ctx.|v\"", None),
        ("\"readouts\": [{\"label\": \"a\", \"expr\": \"data.nc|on\"}]", None),
    ] {
        let (text, byte) = marked(&lab(inside));
        editor.did_open("d.md", &text);
        let hover = editor.at("hover", "d.md", &text, byte);
        let hover = hover["contents"]["value"].as_str().unwrap_or("").to_string();
        match expected {
            Some(expected) => assert!(hover.contains(expected), "{inside}: {hover}"),
            None => assert!(!hover.contains("dimension"), "{inside}: {hover}"),
        }
    }
    assert_eq!(editor.end(), 0);
}
