//! The errors that the parser reports for invalid JSON.

use super::*;
use crate::lint::json::to_finding;
use crate::source::SourceMap;

pub(super) fn run(text: &str) -> Parsed {
    parse(text, &SourceMap::verbatim(0..text.len()))
}

/// The message of every finding, and the text of its span.
fn list_findings(text: &str) -> Vec<(String, String)> {
    let parsed = run(text);
    assert!(parsed.broken, "{text} was accepted");
    let message_and_text = |p: &Problem| (to_finding(p).message, text[p.span.clone()].to_string());
    parsed.problems.iter().map(message_and_text).collect()
}

/// The text with all fixes applied, from the end to the start.
fn fixed(text: &str) -> String {
    let mut fixes: Vec<_> = run(text).problems.into_iter().filter_map(|p| p.repair).collect();
    fixes.sort_by_key(|(span, _)| (span.start, span.end));
    let mut text = text.to_string();
    for (span, right) in fixes.into_iter().rev() {
        text.replace_range(span, &right);
    }
    text
}

/// The value that was read, as JSON, without unreadable parts.
fn value(text: &str) -> serde_json::Value {
    run(text).node.map_or(serde_json::Value::Null, |n| to_serde(&n))
}

/// One error per row: its message, its text, the value that was read, and the repaired text (unchanged when there is no
/// repair).
#[test]
#[expect(clippy::too_many_lines, reason = "a table of mistakes")]
fn errors_are_reported_and_parsing_continues() {
    for (text, message, place, read, repaired) in [
        (r#"{"a": 1 "b": 2}"#, "a comma is missing here", "", r#"{"a":1,"b":2}"#, r#"{"a": 1, "b": 2}"#),
        (r#"[1 {"b": 2}]"#, "a comma is missing here", "", r#"[1,{"b":2}]"#, r#"[1, {"b": 2}]"#),
        (
            r#"{"xml": "<a><b name="arm" pos="0 0 1"><c limited="true"/></b></a>", "n": 1}"#,
            "a text contains 6 double quotes",
            "\"",
            r#"{"xml":"<a><b name=\"arm\" pos=\"0 0 1\"><c limited=\"true\"/></b></a>","n":1}"#,
            r#"{"xml": "<a><b name=\"arm\" pos=\"0 0 1\"><c limited=\"true\"/></b></a>", "n": 1}"#,
        ),
        (r#"{"a": 1,}"#, "a comma is before a closing bracket", ",", r#"{"a":1}"#, r#"{"a": 1}"#),
        (r#"[1, 2, ]"#, "a comma is before a closing bracket", ",", "[1,2]", "[1, 2 ]"),
        (r#"{"a": 1,, "b": 2}"#, "there is an extra comma", ",", r#"{"a":1,"b":2}"#, r#"{"a": 1, "b": 2}"#),
        (r#"[, 1]"#, "a comma has no value before it", ",", "[1]", "[ 1]"),
        (
            r#"{"a": 1; "b": 2}"#,
            "a semicolon is used where JSON needs a comma",
            ";",
            r#"{"a":1,"b":2}"#,
            r#"{"a": 1, "b": 2}"#,
        ),
        (
            r#"{'a': 1}"#,
            "JSON has a single quote where it needs a double quote",
            "'",
            r#"{"a":1}"#,
            r#"{"a": 1}"#,
        ),
        (
            r#"{'a': 'it\'s "x"'}"#,
            "JSON has 2 texts in single quotes where it needs double quotes",
            "'",
            r#"{"a":"it's \"x\""}"#,
            r#"{"a": "it's \"x\""}"#,
        ),
        (r#"{"a": 1} // note"#, "JSON has no comments", "// note", r#"{"a":1}"#, r#"{"a": 1} "#),
        (
            "{\"a\": 1, # note\n \"b\": 2}",
            "JSON has no comments",
            "# note",
            r#"{"a":1,"b":2}"#,
            "{\"a\": 1, \n \"b\": 2}",
        ),
        (r#"{"a": /* x */ 1}"#, "JSON has no comments", "/* x */", r#"{"a":1}"#, r#"{"a":  1}"#),
        (r#"{a: 1}"#, "the key `a` has no quotes", "a", r#"{"a":1}"#, r#"{"a": 1}"#),
        (
            "{\"a\": \"b,\n\"c\": 1}",
            "this string is not closed",
            "\"b",
            r#"{"a":"b","c":1}"#,
            "{\"a\": \"b\",\n\"c\": 1}",
        ),
        ("{\"a\": \"b\nc\"}", "a text contains a line break", "\n", r#"{"a":"b\nc"}"#, r#"{"a": "b\nc"}"#),
        (
            r#"{"model": "ball, "stopAt": 2}"#,
            "this string is not closed",
            "\"ball",
            r#"{"model":"ball","stopAt":2}"#,
            r#"{"model": "ball", "stopAt": 2}"#,
        ),
        (
            r#"{"model: "ball"}"#,
            "this string is not closed",
            "\"model",
            r#"{"model":"ball"}"#,
            r#"{"model": "ball"}"#,
        ),
        (
            r#"{"a": "the "heavy" ball"}"#,
            "a text contains 2 double quotes",
            "\"",
            r#"{"a":"the \"heavy\" ball"}"#,
            r#"{"a": "the \"heavy\" ball"}"#,
        ),
        (
            "{\"a\": \"b\tc\"}",
            "a string contains a control character (U+0009)",
            "\t",
            r#"{"a":"b\tc"}"#,
            r#"{"a": "b\tc"}"#,
        ),
        (r#"{"a": NaN}"#, "JSON has no number `NaN`", "NaN", "{}", r#"{"a": NaN}"#),
        (r#"{"a": -Infinity}"#, "JSON has no number `-Infinity`", "-Infinity", "{}", r#"{"a": -Infinity}"#),
        (
            r#"{"a": True}"#,
            "`True` must be written `true` in JSON",
            "True",
            r#"{"a":true}"#,
            r#"{"a": true}"#,
        ),
        (
            r#"{"a": None}"#,
            "`None` must be written `null` in JSON",
            "None",
            r#"{"a":null}"#,
            r#"{"a": null}"#,
        ),
        (r#"{"a": .5}"#, "`.5` is not a JSON number", ".5", r#"{"a":0.5}"#, r#"{"a": 0.5}"#),
        (r#"{"a": 5.}"#, "`5.` is not a JSON number", "5.", r#"{"a":5.0}"#, r#"{"a": 5}"#),
        (r#"{"a": +1}"#, "`+1` is not a JSON number", "+1", r#"{"a":1.0}"#, r#"{"a": 1}"#),
        (r#"{"a": 0x10}"#, "`0x10` is not a JSON number", "0x10", r#"{"a":16.0}"#, r#"{"a": 16}"#),
        (r#"{"a": 0,5}"#, "a number has a decimal comma", ",", r#"{"a":0.0}"#, r#"{"a": 0.5}"#),
        (
            r#"{"a": "\tau \alpha"}"#,
            "`\\a` is not a JSON escape",
            "\\a",
            r#"{"a":"\tau \\alpha"}"#,
            r#"{"a": "\tau \\alpha"}"#,
        ),
        (r#"{"a": "it\'s"}"#, "`\\'` is not a JSON escape", "\\'", r#"{"a":"it's"}"#, r#"{"a": "it's"}"#),
        (r#"{"a" 1}"#, "a colon is missing after this key", "", r#"{"a":1}"#, r#"{"a": 1}"#),
        (
            r#"{"a" = 1}"#,
            "an equals sign is used where JSON needs a colon",
            "=",
            r#"{"a":1}"#,
            r#"{"a" : 1}"#,
        ),
        (r#"{"a":: 1}"#, "there is an extra colon", ":", r#"{"a":1}"#, r#"{"a": 1}"#),
        (r#"{"a": }"#, "the value of this key is missing", "\"a\"", "{}", r#"{"a": }"#),
        (r#"{"a": {"b": 1}"#, "this object is not closed", "{", r#"{"a":{"b":1}}"#, r#"{"a": {"b": 1}}"#),
        (r#"{"a": [{"b": 1"#, "this object is not closed", "{", r#"{"a":[{"b":1}]}"#, r#"{"a": [{"b": 1}]}"#),
        (r#"{"a": [1, 2}"#, "a `]` is missing here", "", r#"{"a":[1,2]}"#, r#"{"a": [1, 2]}"#),
        (
            r#"{"a": [1, 2}, "b": 3}"#,
            "`}` is used where a list ends",
            "}",
            r#"{"a":[1,2],"b":3}"#,
            r#"{"a": [1, 2], "b": 3}"#,
        ),
        (
            r#"{"a": [{"b": 1], "c": 2}"#,
            "a `}` is missing here",
            "",
            r#"{"a":[{"b":1}],"c":2}"#,
            r#"{"a": [{"b": 1}], "c": 2}"#,
        ),
        (
            r#"{"a": [1]], "b": 2}"#,
            "this `]` closes nothing",
            "]",
            r#"{"a":[1],"b":2}"#,
            r#"{"a": [1], "b": 2}"#,
        ),
        (
            r#"{"a": {"b": 1}}, "c": 2}"#,
            "this `}` closes nothing",
            "}",
            r#"{"a":{"b":1},"c":2}"#,
            r#"{"a": {"b": 1}, "c": 2}"#,
        ),
        (r#"{"a": 1}}"#, "this `}` closes nothing", "}", r#"{"a":1}"#, r#"{"a": 1}"#),
        (r#""a": 1}"#, "the opening `{` is missing", "", r#"{"a":1}"#, r#"{"a": 1}"#),
        (
            r#"{"a": 1} x"#,
            "there is text after the end of the JSON value",
            "x",
            r#"{"a":1}"#,
            r#"{"a": 1} x"#,
        ),
        (
            "{\"a\":\u{a0}1}",
            "an invisible character (U+00A0) is between values",
            "\u{a0}",
            r#"{"a":1}"#,
            r#"{"a": 1}"#,
        ),
        ("", "there is no JSON here", "", "null", ""),
        (r#"{"a": 1e999}"#, "this number is too large", "1e999", "{}", r#"{"a": 1e999}"#),
        (
            r#"{"a": ball}"#,
            "`ball` is neither a number nor a text in quotes",
            "ball",
            r#"{"a":"ball"}"#,
            r#"{"a": "ball"}"#,
        ),
        (
            r#"{"a": data.body("ball").xpos[2], "b": 1}"#,
            "`data.body(\"ball\").xpos[2]` is neither a number nor a text in quotes",
            "data.body(\"ball\").xpos[2]",
            r#"{"a":"data.body(\"ball\").xpos[2]","b":1}"#,
            r#"{"a": "data.body(\"ball\").xpos[2]", "b": 1}"#,
        ),
        (
            r#"{"a": 2 * 3}"#,
            "`2 * 3` is neither a number nor a text in quotes",
            "2 * 3",
            "{}",
            r#"{"a": 2 * 3}"#,
        ),
        (
            r#"{"a": 5 kg, "b": 1}"#,
            "`kg` does not belong here",
            "kg",
            r#"{"a":5,"b":1}"#,
            r#"{"a": 5 kg, "b": 1}"#,
        ),
        (
            r#"{“a”: “b”}"#,
            "JSON has 4 typographic quotes where it needs \"",
            "“",
            r#"{"a":"b"}"#,
            r#"{"a": "b"}"#,
        ),
    ] {
        assert_eq!(list_findings(text), [(message.to_string(), place.to_string())], "{text}");
        let read: serde_json::Value = serde_json::from_str(read).unwrap();
        assert_eq!(value(text), floats(read), "{text}");
        assert_eq!(fixed(text), repaired, "{text}");
        assert!(
            repaired == text || serde_json::from_str::<serde_json::Value>(repaired).is_ok(),
            "{repaired}"
        );
    }
}

#[test]
fn all_errors_of_a_block_are_reported_together() {
    let text = r#"{
  'model': "ball",
  stopAt: 2
  "dock": True,  // beside the text
  "note": "the angle $\alpha$",
  "camera": {"azimuth": +90, "elevation" 10,},
  "readouts": [{"label": "z", "expr": "data.qpos[2]"}
}"#;
    let messages: Vec<_> = list_findings(text).into_iter().map(|(message, _)| message).collect();
    insta::assert_debug_snapshot!(messages, @r#"
    [
        "JSON has a single quote where it needs a double quote",
        "the key `stopAt` has no quotes",
        "a comma is missing here",
        "`True` must be written `true` in JSON",
        "JSON has no comments",
        "`\\a` is not a JSON escape",
        "`+90` is not a JSON number",
        "a colon is missing after this key",
        "a comma is before a closing bracket",
        "a `]` is missing here",
    ]
    "#);
    let repaired: serde_json::Value = serde_json::from_str(&fixed(text)).unwrap();
    assert_eq!(floats(repaired), value(text));
}

#[test]
fn deep_nesting_is_refused_before_it_can_hurt() {
    let deep = "[".repeat(1_000_000);
    assert!(list_findings(&deep)[0].0.contains("nested brackets"));
}

#[test]
fn too_many_values_are_refused() {
    let long = format!("[{}1]", "1,".repeat(MAX_VALUES + 1));
    assert!(list_findings(&long)[0].0.contains("the JSON has more than"));
}

#[test]
fn duplicate_keys_are_found_and_strings_know_their_place() {
    let text = r#"{"a": "x\ny", "a": ""}"#;
    let parsed = run(text);
    assert_eq!((to_finding(&parsed.problems[0]).code, parsed.broken), ("duplicate-key", false));
    assert_eq!(parsed.problems[0].span, 15..16);
    let node = parsed.node.unwrap();
    let Json::Text(first) = &node.members()[0].value.json else { panic!() };
    assert_eq!(&text[first.span_of(1..3)], "\\ny");
    let Json::Text(second) = &node.members()[1].value.json else { panic!() };
    assert_eq!(second.span(), 20..20);
}

/// Long and hostile texts are parsed in linear time.
#[test]
fn hostile_texts_are_read_in_one_pass() {
    for piece in [
        "\"",
        "'",
        "\"\n",
        "\" ",
        "\"a",
        "\"a\"",
        "{\"",
        "/*",
        "//",
        "#",
        "{",
        "}",
        "]",
        ",",
        ":",
        "\"a\":",
        "“",
        "“a”,",
        "\\",
        "\"\\",
        "a",
        "a ",
        "(",
        "1",
        "1 ",
        "\u{a0}",
        "[1]",
        "\"a\"b\"",
        "\"x, \"y\"",
        "\n",
        "‘’",
        "`",
        "\"}",
        "=",
        "é",
    ] {
        for (before, behind) in [("", ""), ("{\"a\": ", "\"}"), ("[\"", "\"]"), ("{\"a\": \"\n", " \n\" \n")]
        {
            let text = format!("{before}{}{behind}", piece.repeat(400_000 / piece.len()));
            let start = std::time::Instant::now();
            let parsed = run(&text);
            assert!(parsed.problems.len() <= MAX_ERRORS, "{piece}");
            assert!(start.elapsed().as_secs() < 5, "{before}{piece}: {:?}", start.elapsed());
        }
    }
}

pub(super) fn to_serde(node: &Node) -> serde_json::Value {
    use serde_json::Value;
    match &node.json {
        Json::Null | Json::Broken => Value::Null,
        Json::Bool(b) => (*b).into(),
        Json::Number(x) => (*x).into(),
        Json::Text(t) => t.value.clone().into(),
        Json::Array(items) => items.iter().filter(|n| !n.is_broken()).map(to_serde).collect(),
        Json::Object(members) => {
            let read = members.iter().filter(|m| !m.value.is_broken());
            Value::Object(read.map(|m| (m.key.value.clone(), to_serde(&m.value))).collect())
        }
    }
}

pub(super) fn floats(value: serde_json::Value) -> serde_json::Value {
    use serde_json::Value;
    match value {
        Value::Number(n) => n.as_f64().unwrap().into(),
        Value::Array(items) => items.into_iter().map(floats).collect(),
        Value::Object(map) => Value::Object(map.into_iter().map(|(k, v)| (k, floats(v))).collect()),
        other => other,
    }
}
