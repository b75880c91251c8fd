//! Tests of the completions.

use super::*;
use crate::markdown::{self, BlockKind};
use crate::source::SourceFile;
use proptest::prelude::*;
use std::borrow::Cow;
use std::ops::Range;

/// No models are available.
const NONE: fn(RequestedNames<'_>) -> Vec<String> = |_| Vec::new();

/// The completions at the marker `¦`, which is removed from the text.
fn words_at(marked: &str) -> Vec<&'static str> {
    let word = |text: Cow<'static, str>| match text {
        Cow::Borrowed(word) => word,
        Cow::Owned(name) => panic!("{name}: no models are known"),
    };
    all(marked).into_iter().map(|c| word(c.text)).collect()
}

fn all(marked: &str) -> Vec<Completion> {
    let offset = marked.find('¦').unwrap();
    completions(&marked.replace('¦', ""), offset, &NONE)
}

/// The text after a completion is applied.
fn apply_completion(marked: &str, word: &str) -> String {
    let completion = all(marked).into_iter().find(|c| c.text == word).unwrap();
    let mut text = marked.replace('¦', "");
    text.replace_range(completion.replace, &completion.insert);
    text
}

fn names(object: &Object, but: &[&str]) -> Vec<&'static str> {
    object.keys.iter().map(|k| k.name).filter(|k| !but.contains(k)).collect()
}

#[test]
fn behind_a_brace_or_a_comma_stand_the_keys_that_are_not_there_yet() {
    assert_eq!(words_at(r#"{"model": "fall", ¦}"#), names(&LAB, &["model", "xml"]));
    assert_eq!(words_at(r#"{¦ "model": "fall", "camera": {}}"#), names(&LAB, &["model", "xml", "camera"]));
    assert_eq!(words_at(r#"{"model": "fall", "camera": {¦"#), names(&CAMERA, &[]));
    assert_eq!(words_at(r#"{"model": "fall", "plots": [{"traces": [{¦}]}]}"#), names(&TRACE, &[]));
    assert_eq!(words_at(r#"{"plots": [{"traces": [], "refLines": [{"y": 1, ¦"#), ["label"]);
    assert_eq!(words_at(r#"{"verify": {"runs": {"a": {"until": 1, ¦}}}}"#), names(&RUN, &["until", "steps"]));
    assert_eq!(words_at(r#"{"verify": {"exact": {"z": {¦}}}}"#), ["is", "tol"]);
    assert_eq!(words_at(r#"{"verify": {"lab": {¦}}}"#), names(&LAB, &[]));
    assert_eq!(words_at(r#"{"id": "a", ¦}"#), ["title", "questions", "lint"]);
    assert_eq!(words_at(r#"[{"model": "fall"}, {"id": "a", ¦"#), ["title", "questions", "lint"]);
    assert_eq!(
        words_at(r#"{"id": "a", "questions": [{"kind": "predict", "sim": {"xml": "", ¦"#),
        names(&LAB, &["model", "xml"])
    );
    // The kind of the root object is not known yet.
    let both = words_at("{¦");
    assert!(both.starts_with(&names(&LAB, &[])) && both.ends_with(&["id", "questions"]));
}

#[test]
fn the_word_of_a_family_tells_the_keys_and_so_do_the_keys() {
    assert_eq!(words_at(r#"{"controls": [{"type": "button", ¦}]}"#), ["label", "run"]);
    assert_eq!(words_at(r#"{"controls": [{¦ "label": "a", "type": "button"}]}"#), ["run"]);
    let keys = words_at(r#"{"controls": [{"label": "a", "min": 0, ¦}]}"#);
    assert_eq!(keys, names(&SLIDER, &["label", "min"]));
    let keys = words_at(r#"{"controls": [{"label": "a", ¦}]}"#);
    assert!(keys.contains(&"run") && keys.contains(&"options") && keys.contains(&"min"));
    // `apply` has no effect if `set` is present.
    assert!(!words_at(r#"{"controls": [{"type": "slider", "set": "x", ¦}]}"#).contains(&"apply"));
    assert_eq!(
        words_at(r#"{"questions": [{"kind": "numeric", "q": "?", ¦}]}"#),
        names(&NUMERIC, &["kind", "q"])
    );
    assert!(!words_at(r#"{"questions": [{"tol": 1, ¦}]}"#).contains(&"options"));
}

#[test]
fn what_is_written_chooses() {
    assert_eq!(words_at(r#"{"model": "fall", "con¦"#), ["controller", "controls"]);
    assert_eq!(words_at(r#"{"model": "fall", "con¦": []}"#), ["controller", "controls"]);
    assert_eq!(words_at(r#"{"model": "fall", con¦ }"#), ["controller", "controls"]);
    assert_eq!(words_at("{\"model\": \"fall\", \"con¦\n \"controls\": []}"), ["controller"]);
    assert_eq!(words_at(r#"{"model": "fall", "con¦, "controls": [{"label": "a"}]}"#), ["controller"]);
    assert_eq!(words_at(r#"{"model": "fall", "¦"}"#), names(&LAB, &["model", "xml"]));
    // No key starts with this text, so all keys are offered.
    assert_eq!(words_at(r#"{"model": "fall", "zzz¦"}"#), names(&LAB, &["model", "xml"]));
    assert_eq!(
        apply_completion(r#"{"model": "fall", "con¦"}"#, "controls"),
        r#"{"model": "fall", "controls": }"#
    );
    assert_eq!(apply_completion(r#"{"con¦t": []}"#, "controls"), r#"{"controls": []}"#);
    assert_eq!(apply_completion("{\"con¦\n\"model\": 1}", "controls"), "{\"controls\": \n\"model\": 1}");
}

#[test]
fn a_value_takes_its_words() {
    assert_eq!(words_at(r#"{"controls": [{"type": "¦"}]}"#), ["slider", "select", "button"]);
    assert_eq!(words_at(r#"{"controls": [{"type": ¦}]}"#), ["slider", "select", "button"]);
    assert_eq!(words_at(r#"{"controls": [{"type": "s¦, "label": "a"}]}"#), ["slider", "select"]);
    assert_eq!(words_at("{\"controls\": [{\"type\": \"b¦}]}"), ["button"]);
    assert_eq!(words_at(r#"{"questions": [{"kind": "¦mcq", "q": "?"}]}"#).len(), 8);
    assert_eq!(words_at(r#"{"id": "a", "questions": [{"kind": "n¦"}]}"#), ["numeric"]);
    assert_eq!(words_at(r#"{"expect": ¦, "model": "a"}"#), ["breaks", "may break"]);
    assert_eq!(words_at(r#"{"model": "a", "dock": ¦}"#), ["true", "false"]);
    assert_eq!(words_at(r#"{"model": "a", "dock": t¦}"#), ["true"]);
    assert_eq!(words_at(r#"{"model": "a", "toggles": ["com", "¦", "sites"]}"#).len(), OVERLAYS.len() - 2);
    assert_eq!(words_at(r#"{"model": "a", "overlays": {"com": true, "s¦"}}"#), ["sites", "shadows"]);
    assert_eq!(words_at(r#"{"model": "a", "overlays": {"com": ¦}}"#), ["true", "false"]);
    assert_eq!(
        apply_completion(r#"{"controls": [{"type": se¦}]}"#, "select"),
        r#"{"controls": [{"type": "select"}]}"#
    );
}

/// The models provide their own names and the names of their sites. The sites are those of the model of the enclosing lab.
#[test]
fn names_come_from_the_models() {
    let names = |asked: RequestedNames<'_>| match asked {
        RequestedNames::Models => ["fall", "swing", "spin"].map(String::from).to_vec(),
        RequestedNames::SitesOf("swing") => ["tip", "top", "a\"b"].map(String::from).to_vec(),
        RequestedNames::SitesIn("<mujoco model=\"m\"/>") => vec!["inside".into()],
        other => panic!("{other:?}"),
    };
    let offered = |marked: &str| {
        let offset = marked.find('¦').unwrap();
        let all = completions(&marked.replace('¦', ""), offset, &names);
        all.into_iter().map(|c| (c.text.into_owned(), c.insert)).collect::<Vec<_>>()
    };
    let texts = |marked: &str| offered(marked).into_iter().map(|(text, _)| text).collect::<Vec<_>>();
    assert_eq!(texts(r#"{"model": "¦"}"#), ["fall", "swing", "spin"]);
    assert_eq!(texts(r#"{"model": "s¦"}"#), ["swing", "spin"]);
    assert_eq!(texts(r#"{"model": "swing", "trail": "t¦"}"#), ["tip", "top"]);
    assert_eq!(offered(r#"{"trail": "a¦", "model": "swing"}"#), [("a\"b".into(), r#""a\"b""#.into())]);
    assert_eq!(texts(r#"{"xml": "<mujoco model=\"m\"/>", "trail": ¦}"#), ["inside"]);
    // The model is that of the innermost lab. Without a model, there are no sites.
    let sim = r#"{"id": "q", "questions": [{"kind": "predict", "sim": {"model": "swing", "trail": "¦"}}]}"#;
    assert_eq!(texts(sim).len(), 3);
    assert_eq!(texts(r#"{"trail": "¦"}"#), Vec::<String>::new());
}

#[test]
fn in_code_and_free_text_and_between_values_there_is_nothing() {
    for marked in [
        r#"{"model": "¦fall"}"#,
        r#"{"setup": "ctx.a = ¦1"}"#,
        r#"{"setup": "ctx.a = {¦"#,
        r#"{"setup": "a = se¦t" "stopAt": 1}"#,
        "{\"setup\": \"a = se¦t\n \"stopAt\": 1}",
        r#"{"setup": "ctx.a = {'¦"#,
        r#"{"readouts": [{"label": "t", "expr": "data.¦time"}]}"#,
        r#"{"readouts": [{"label": "t", "expr": "data.¦"#,
        r#"{"stopAt": ¦}"#,
        r#"{"stopAt": 1¦}"#,
        r#"{"model": "fall" ¦}"#,
        r#"{"model"¦: "fall"}"#,
        r#"{"model": "fall"}¦"#,
        r#"{"verify": {"measure": {"¦"}}}"#,
        r#"{"verify": {"runs": {"a": {"set": {¦"#,
        r#"{"questions": [{"options": ["a", ¦]}]}"#,
        r#"{"no such key": {¦}}"#,
        r#"{"model": {"a": {¦}}}"#,
        r#"[[{¦"#,
        "¦",
        "# A lesson¦",
    ] {
        assert_eq!(words_at(marked), Vec::<&str>::new(), "{marked}");
    }
}

#[test]
fn each_says_what_it_means_what_it_takes_and_what_counts_without_it() {
    let height = all(r#"{"model": "fall", "hei¦"#).remove(0);
    assert_eq!(
        (&*height.text, height.doc, height.takes.as_str(), height.default.as_deref(), height.required),
        ("height", "the height of the picture", "number above 0, in px", Some("300"), false)
    );
    let select = all(r#"{"controls": [{"type": "sel¦"}]}"#).remove(0);
    assert_eq!((&*select.text, select.doc, select.is_key), ("select", "one of several values", false));
    assert_eq!(
        (select.takes.as_str(), select.default.as_deref()),
        (r#""slider", "select", "button""#, Some("\"slider\""))
    );
    assert!(all(r#"{"plots": [{"¦"#)[0].required);
}

/// The JSON of all fences of the example lessons.
fn bodies() -> Vec<String> {
    let mut all = Vec::new();
    for text in [
        include_str!("../../../../../specs/lessons/01-what-a-step-computes.md"),
        include_str!("../../../../../specs/lessons/02-bounce-and-swing.md"),
    ] {
        let scan = markdown::scan(&SourceFile::new("a.md", text));
        let blocks = scan.blocks.into_iter().filter(|b| !matches!(b.kind, BlockKind::Code { .. }));
        all.extend(blocks.map(|b| b.body.value));
        all.push(text.into());
    }
    assert!(all.len() > 8);
    all
}

#[test]
fn no_offset_of_a_lesson_is_a_panic() {
    for (i, text) in bodies().into_iter().enumerate() {
        // A sample has every third offset, from another one in each text.
        let (first, step) = if crate::takes_all() { (0, 1) } else { (i % 3, 3) };
        for offset in (first..=text.len() + 1).step_by(step) {
            for c in completions(&text, offset, &NONE) {
                assert!(text.get(c.replace).is_some());
            }
        }
    }
}

/// The keys of a tree with their byte ranges; for each key also all keys of its object.
fn keys_of(node: &crate::json::Node, out: &mut Vec<(Range<usize>, String, Vec<String>)>) {
    if let crate::json::Json::Array(items) = &node.json {
        items.iter().for_each(|item| keys_of(item, out));
    }
    for member in node.members() {
        let all = node.members().iter().map(|m| m.key.value.clone()).collect();
        out.push((member.key.span(), member.key.value.clone(), all));
        keys_of(&member.value, out);
    }
}

/// At every key of the labs and quizzes of the example lessons, that key is offered and the other keys of the object are
/// not. The key can be complete, half written, or not yet written.
#[test]
fn at_every_key_of_a_lesson_it_is_offered_and_its_neighbours_are_not() {
    let mut tried = 0;
    for text in bodies() {
        let parsed = crate::json::parse(&text, &crate::source::SourceMap::verbatim(0..text.len()));
        if parsed.broken {
            continue;
        }
        let mut keys = Vec::new();
        keys_of(&parsed.node.unwrap(), &mut keys);
        let declared = |name: &str| OBJECTS.iter().any(|o| o.key(name).is_some());
        for (span, name, all) in keys {
            let whole = completions(&text, span.start, &NONE);
            // A name chosen by the author: the label of a control, the name of a run or of a measure.
            if whole.is_empty() || !declared(&name) {
                continue;
            }
            tried += 1;
            // Written up to the second letter, with the remaining text after it, or without.
            let half = span.start + name.len().min(2);
            let (before, cut) = (&text[..half], &text[half..]);
            let unclosed = format!("{before}\n{}", cut.split_once(',').map_or("", |(_, rest)| rest));
            for (text, offset) in
                [(&text, span.start), (&text, span.end), (&before.to_string(), half), (&unclosed, half)]
            {
                let offered: Vec<_> = completions(text, offset, &NONE).into_iter().map(|c| c.text).collect();
                assert!(
                    offered.contains(&Cow::Borrowed(name.as_str())),
                    "{name} at {offset}: {offered:?}\n{text}"
                );
            }
            for other in all.iter().filter(|k| **k != name) {
                assert!(!whole.iter().any(|c| c.text == other.as_str()), "{other} beside {name}");
            }
        }
    }
    assert!(tried > 200, "{tried}");
}

/// Every quote in this line could start a string that extends to the end of the line.
#[test]
fn a_hostile_line_takes_no_longer_than_its_length() {
    for piece in ["\"a,\\", "\"\\", "{\"", "[\"a, ", "\"a\"b"] {
        let text = format!("{{{}", piece.repeat(200_000));
        completions(&text, text.len(), &NONE);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]
    /// No text causes a panic, and the replaced range is a part of the text.
    #[test]
    fn no_text_is_a_panic(pieces in prop::collection::vec(prop::sample::select(vec![
        "{", "}", "[", "]", ",", ":", "\"", "\\", "\n", " ", "é", "😀", "\"model\"", "\"controls\": [", "\"type\": \"",
        "\"kind\"", "\"questions\": [{", "\"overlays\": {", "\"verify\": {\"runs\": {\"a\": {", "1", "true", "com", "/*",
    ]), 0..30)) {
        let text = pieces.concat();
        for offset in 0..=text.len() {
            for c in completions(&text, offset, &NONE) {
                prop_assert!(text.get(c.replace).is_some());
            }
        }
    }
}
