//! Properties of the parser: it accepts the same texts as `serde_json`, has the same spans as `jsonc-parser`, never panics
//! or hangs, and reports every error.

use super::tests::{floats, run, to_serde};
use super::*;
use proptest::prelude::*;
use std::ops::Range;

/// Spans of all values and keys, in order.
fn list_spans(node: &Node, all: &mut Vec<Range<usize>>) {
    all.push(node.span.clone());
    if let Json::Array(items) = &node.json {
        items.iter().for_each(|n| list_spans(n, all));
    }
    for member in node.members() {
        let key = member.key.span();
        all.push(key.start - 1..key.end + 1);
        list_spans(&member.value, all);
    }
}

/// The spans of all values and keys from `jsonc-parser`, in order.
fn reference_spans(value: &jsonc_parser::ast::Value<'_>, all: &mut Vec<Range<usize>>) {
    use jsonc_parser::ast::{ObjectPropName, Value};
    use jsonc_parser::common::Ranged;
    all.push(value.range().start..value.range().end);
    match value {
        Value::Array(array) => array.elements.iter().for_each(|v| reference_spans(v, all)),
        Value::Object(object) => {
            for property in &object.properties {
                let ObjectPropName::String(name) = &property.name else { panic!() };
                all.push(name.range.start..name.range.end);
                reference_spans(&property.value, all);
            }
        }
        _ => {}
    }
}

/// Fragments that often form valid or nearly valid JSON.
fn nearly_json() -> impl Strategy<Value = String> {
    let piece = prop::sample::select(vec![
        "{",
        "}",
        "[",
        "]",
        ",",
        ":",
        "\"a\"",
        "\"b\\n\"",
        "\"<p>x=\"",
        "\"\\u00e9\"",
        "\"\\ud83d\"",
        "1",
        "-2.5",
        "1e5",
        "01",
        "-",
        "+1",
        ".5",
        "5.",
        "0x1",
        "1e",
        "1e999",
        "true",
        "null",
        "nul",
        "falsee",
        "NaN",
        " ",
        "\n",
        "\u{b}",
        "\u{a0}",
        "'a'",
        "a",
        "\"",
        "\\",
        "//x\n",
        "/**/",
        "“",
        "\"\t\"",
        "\u{feff}",
        "\"é\u{7f}\"",
        "{}",
        "[]",
        "{\"a\":1}",
        "[1,2]",
        "\"a\":",
        ",\"a\":",
        "“b”",
        "‘",
        "=",
        ";",
        "\r\n",
        "\"a, \"",
        "x y",
        "(1, 2)",
    ]);
    prop::collection::vec(piece, 0..12).prop_map(|pieces| pieces.concat())
}

/// JSON with all kinds of spaces.
fn strict_json() -> impl Strategy<Value = String> {
    let text = prop::sample::select(vec![
        r#""""#,
        r#""a""#,
        r#""a, \"b\": “c” 'd' // #""#,
        r#""é\ud83d\ude00\n}]""#,
        r#""\\""#,
        r#""x: y = {z}, ""#,
        r#"" , ""#,
    ]);
    let leaf = prop_oneof![
        text.clone().prop_map(str::to_string),
        prop::sample::select(vec!["1", "-0.5e-3", "0", "true", "false", "null", "12E+2"])
            .prop_map(str::to_string),
    ];
    let space = || prop::sample::select(vec!["", " ", "\n  ", "\t", "\r\n"]);
    leaf.prop_recursive(4, 40, 5, move |inner| {
        let item = (space(), inner.clone(), space()).prop_map(|(a, v, b)| format!("{a}{v}{b}"));
        let member =
            (space(), text.clone(), space(), item.clone()).prop_map(|(a, k, b, v)| format!("{a}{k}{b}:{v}"));
        prop_oneof![
            prop::collection::vec(item, 0..5).prop_map(|all| format!("[{}]", all.join(","))),
            prop::collection::vec(member, 0..5).prop_map(|all| format!("{{{}}}", all.join(","))),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]
    /// The parser accepts the same texts as serde_json with the same values; all others have a finding.
    #[test]
    fn acceptance_is_that_of_serde(text in nearly_json()) {
        let read = run(&text);
        let by_serde: Option<serde_json::Value> = serde_json::from_str(&text).ok();
        prop_assert_eq!(!read.broken, by_serde.is_some(), "{:?}", text);
        prop_assert_eq!(read.broken, read.problems.iter().any(|p| !matches!(p.mistake, Mistake::Twice(_))));
        if let Some(by_serde) = by_serde {
            prop_assert_eq!(to_serde(&read.node.unwrap()), floats(by_serde));
        }
    }

    /// Strict JSON: the values of serde_json, the spans of jsonc-parser.
    #[test]
    fn strict_json_is_read_exactly(text in strict_json()) {
        let read = run(&text);
        prop_assert!(!read.broken, "{:?}: {:?}", text, read.problems);
        let node = read.node.unwrap();
        prop_assert_eq!(to_serde(&node), floats(serde_json::from_str(&text).unwrap()));
        let reference = jsonc_parser::parse_to_ast(&text, &Default::default(), &Default::default()).unwrap().value.unwrap();
        let (mut a, mut b) = (Vec::new(), Vec::new());
        list_spans(&node, &mut a);
        reference_spans(&reference, &mut b);
        prop_assert_eq!(a, b);
    }

    #[test]
    fn any_text_causes_no_panic(text in any::<String>()) {
        let read = run(&text);
        prop_assert_eq!(read.broken, serde_json::from_str::<serde_json::Value>(&text).is_err());
        prop_assert_eq!(read.broken, !read.problems.is_empty());
    }
}
