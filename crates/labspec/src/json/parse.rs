//! From JSON text to a tree whose every node knows its place in the author's file.

use super::explain::{explain, missing_comma};
use super::{guard, strings};
use crate::finding::Finding;
use crate::lint::rules::json::{DUPLICATE_KEY, SYNTAX};
use crate::source::{SourceMap, Text};
use jsonc_parser::ast;
use jsonc_parser::errors::ParseError;
use std::collections::HashMap;
use std::ops::Range;

/// A value and its bytes in the author's file.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The value.
    pub json: Json,
    /// Bytes of the file, quotes and brackets included.
    pub span: Range<usize>,
}

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Json {
    /// `null`
    Null,
    /// `true` or `false`
    Bool(bool),
    /// A finite number.
    Number(f64),
    /// A string, decoded.
    Text(Text),
    /// An array.
    Array(Vec<Node>),
    /// An object, in the author's order, duplicates included.
    Object(Vec<Member>),
}

/// A key and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// The key, decoded.
    pub key: Text,
    /// The value.
    pub value: Node,
}

impl Node {
    /// The value of a key, if this is an object that has it.
    pub fn get(&self, key: &str) -> Option<&Node> {
        match &self.json {
            Json::Object(members) => members.iter().find(|m| m.key.value == key).map(|m| &m.value),
            _ => None,
        }
    }

    /// What it is, in an author's words.
    pub fn describe(&self) -> &'static str {
        match &self.json {
            Json::Null => "null",
            Json::Bool(_) => "true or false",
            Json::Number(_) => "a number",
            Json::Text(_) => "a text",
            Json::Array(_) => "a list",
            Json::Object(_) => "an object",
        }
    }
}

/// Parses strict JSON. `below` maps bytes of `text` to bytes of the file.
///
/// Returns the tree, unless the syntax is wrong, and what there is to say: one syntax error, or duplicate keys.
pub fn parse(text: &str, below: &SourceMap) -> (Option<Node>, Vec<Finding>) {
    let mut builder = Builder { text, below, findings: Vec::new() };
    let node = builder.build();
    (node, builder.findings)
}

/// The parser, as strict as it gets.
fn strict(text: &str) -> Result<Option<ast::Value<'_>>, ParseError> {
    let options = jsonc_parser::ParseOptions {
        allow_comments: false,
        allow_loose_object_property_names: false,
        allow_trailing_commas: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    jsonc_parser::parse_to_ast(text, &jsonc_parser::CollectOptions::default(), &options)
        .map(|parsed| parsed.value)
}

struct Builder<'a> {
    text: &'a str,
    below: &'a SourceMap,
    findings: Vec<Finding>,
}

impl Builder<'_> {
    fn build(&mut self) -> Option<Node> {
        if let Some(problem) = guard::check(self.text) {
            self.fail(problem);
            return None;
        }
        match strict(self.text) {
            Ok(Some(value)) => self.node(&value),
            Ok(None) => {
                self.fail(Finding::new(&SYNTAX, 0..0, "nothing here").help("write one JSON object: { … }"));
                None
            }
            Err(error) => {
                let problem = explain(self.text, &error);
                self.fail(problem);
                None
            }
        }
    }

    /// Records a problem whose spans are bytes of `text`.
    fn fail(&mut self, mut finding: Finding) {
        finding.span = self.below.span(finding.span);
        if let Some(fix) = &mut finding.fix {
            fix.span = self.below.span(fix.span.clone());
        }
        self.findings.push(finding);
    }

    fn node(&mut self, value: &ast::Value<'_>) -> Option<Node> {
        use jsonc_parser::common::Ranged;
        let range = value.range().start..value.range().end;
        let json = match value {
            ast::Value::NullKeyword(_) => Json::Null,
            ast::Value::BooleanLit(b) => Json::Bool(b.value),
            ast::Value::NumberLit(n) => match n.value.parse::<f64>() {
                Ok(x) if x.is_finite() => Json::Number(x),
                _ => {
                    self.fail(
                        Finding::new(&SYNTAX, range, "this number is too large to compute with")
                            .help("the largest is about 1.8e308"),
                    );
                    return None;
                }
            },
            ast::Value::StringLit(s) => Json::Text(self.string(&s.range)?),
            ast::Value::Array(array) => {
                let mut items = Vec::with_capacity(array.elements.len());
                let mut end = None;
                for element in &array.elements {
                    self.comma(end, element.range().start)?;
                    end = Some(element.range().end);
                    items.push(self.node(element)?);
                }
                Json::Array(items)
            }
            ast::Value::Object(object) => self.object(object)?,
        };
        Some(Node { json, span: self.below.span(range) })
    }

    fn object(&mut self, object: &ast::Object<'_>) -> Option<Json> {
        let mut members: Vec<Member> = Vec::with_capacity(object.properties.len());
        let mut seen: HashMap<String, Range<usize>> = HashMap::new();
        let mut end = None;
        for property in &object.properties {
            self.comma(end, property.range.start)?;
            end = Some(property.range.end);
            let ast::ObjectPropName::String(name) = &property.name else { return None };
            let key = self.string(&name.range)?;
            if let Some(first) = seen.insert(key.value.clone(), key.span()) {
                self.findings.push(
                    Finding::new(
                        &DUPLICATE_KEY,
                        key.span(),
                        format!("`{}` is written twice in one object", key.value),
                    )
                    .related(first, "the first one, which is ignored")
                    .help("keep one of the two"),
                );
            }
            members.push(Member { key, value: self.node(&property.value)? });
        }
        Some(Json::Object(members))
    }

    /// A string literal whose range includes its quotes.
    fn string(&mut self, range: &jsonc_parser::common::Range) -> Option<Text> {
        let inside = range.start + 1..range.end.saturating_sub(1);
        match self.text.get(inside.clone()).and_then(strings::decode) {
            Some((value, map)) => {
                let map = if map.derived_len() == 0 {
                    SourceMap::point(inside.start)
                } else {
                    map.shifted(inside.start)
                };
                Some(Text { value, map: map.then(self.below) })
            }
            None => {
                self.fail(
                    Finding::new(
                        &SYNTAX,
                        range.start..range.end,
                        "a `\\u` escape in this text is not a character",
                    )
                    .help("write the character itself: JSON is UTF-8"),
                );
                None
            }
        }
    }

    /// A comma between the end of the last item and the start of the next one. The parser does not miss it
    /// everywhere.
    fn comma(&mut self, end: Option<usize>, start: usize) -> Option<()> {
        let Some(end) = end else { return Some(()) };
        if self.text.get(end..start).is_some_and(|between| between.contains(',')) {
            return Some(());
        }
        self.fail(missing_comma(self.text, end));
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn run(text: &str) -> (Option<Node>, Vec<Finding>) {
        parse(text, &SourceMap::verbatim(0..text.len()))
    }

    /// The message and the text under the span of the only finding.
    fn complaint(text: &str) -> (String, String) {
        let (node, findings) = run(text);
        assert!(node.is_none(), "{text} was accepted");
        assert_eq!(findings.len(), 1, "{findings:?}");
        (findings[0].message.clone(), text[findings[0].span.clone()].to_string())
    }

    #[test]
    fn mistakes_are_told_in_plain_words() {
        for (text, message, place) in [
            (r#"{"a": 1 "b": 2}"#, "a comma is missing here", ""),
            (r#"[1 {"b": 2}]"#, "a comma is missing here", ""),
            (r#"{"a": 1,}"#, "a comma before a closing bracket", ","),
            (r#"{'a': 1}"#, "a single quote where JSON needs a double quote", "'"),
            (r#"{"a": 1} // note"#, "JSON has no comments", "//"),
            (r#"{a: 1}"#, "the key `a` has no quotes", "a"),
            (r#"{"a": "b"#, "this string is never closed", "\""),
            ("{\"a\": \"b\n\"}", "this string is not closed on its line", "\"b"),
            ("{\"a\": \"b\tc\"}", "a control character (U+0009) inside a string", "\t"),
            (r#"{"a": NaN}"#, "`NaN` is not a number that JSON knows", "NaN"),
            (r#"{"a": -Infinity}"#, "`-Infinity` is not a number that JSON knows", "-Infinity"),
            (r#"{"a": True}"#, "`True` is written `true` in JSON", "True"),
            (r#"{"a": .5}"#, "`.5` is not a number as JSON writes it", ".5"),
            (r#"{"a": "\tau \alpha"}"#, "`\\a` is not an escape of JSON", "\\a"),
            (r#"{"a" 1}"#, "a colon is missing after this key", "1"),
            (r#"{"a": {"b": 1}"#, "this object is never closed", "{"),
            (r#"{"a": [1, 2}"#, "a `}` that closes nothing here", "}"),
            (r#"{"a": 1}}"#, "text after the end of the JSON value", "}"),
            ("{\"a\":\u{a0}1}", "an invisible character (U+00A0) between values", "\u{a0}"),
            ("", "nothing here", ""),
            (r#"{"a": 1e999}"#, "this number is too large to compute with", "1e999"),
        ] {
            assert_eq!(complaint(text), (message.to_string(), place.to_string()), "{text}");
        }
    }

    #[test]
    fn deep_nesting_is_refused_before_it_can_hurt() {
        let deep = "[".repeat(1_000_000);
        assert!(complaint(&deep).0.contains("brackets inside each other"));
    }

    #[test]
    fn too_many_values_are_refused() {
        let long = format!("[{}1]", "1,".repeat(super::super::MAX_VALUES + 1));
        assert!(complaint(&long).0.contains("values in one JSON text"));
    }

    #[test]
    fn duplicate_keys_are_found_and_strings_know_their_place() {
        let text = r#"{"a": "x\ny", "a": ""}"#;
        let (node, findings) = run(text);
        assert_eq!(findings[0].code, "duplicate-key");
        assert_eq!(findings[0].span, 15..16);
        let node = node.unwrap();
        let Json::Object(members) = &node.json else { panic!() };
        let Json::Text(first) = &members[0].value.json else { panic!() };
        assert_eq!(&text[first.span_of(1..3)], "\\ny");
        let Json::Text(second) = &members[1].value.json else { panic!() };
        assert_eq!(second.span(), 20..20);
    }

    fn to_serde(node: &Node) -> serde_json::Value {
        use serde_json::Value;
        match &node.json {
            Json::Null => Value::Null,
            Json::Bool(b) => (*b).into(),
            Json::Number(x) => (*x).into(),
            Json::Text(t) => t.value.clone().into(),
            Json::Array(items) => items.iter().map(to_serde).collect(),
            Json::Object(members) => {
                Value::Object(members.iter().map(|m| (m.key.value.clone(), to_serde(&m.value))).collect())
            }
        }
    }

    /// Fragments that make JSON and nearly-JSON often.
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
        ]);
        prop::collection::vec(piece, 0..9).prop_map(|pieces| pieces.concat())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        /// What we accept is what serde_json accepts, with the same values.
        #[test]
        fn acceptance_is_that_of_serde(text in nearly_json()) {
            let ours = run(&text).0;
            let theirs: Option<serde_json::Value> = serde_json::from_str(&text).ok();
            prop_assert_eq!(ours.is_some(), theirs.is_some(), "{:?}", text);
            if let (Some(ours), Some(theirs)) = (ours, theirs) {
                let numbers_as_floats: serde_json::Value = floats(theirs);
                prop_assert_eq!(to_serde(&ours), numbers_as_floats);
            }
        }

        #[test]
        fn any_text_is_survived(text in any::<String>()) {
            let ours = run(&text).0;
            prop_assert_eq!(ours.is_some(), serde_json::from_str::<serde_json::Value>(&text).is_ok());
        }
    }

    fn floats(value: serde_json::Value) -> serde_json::Value {
        use serde_json::Value;
        match value {
            Value::Number(n) => n.as_f64().unwrap().into(),
            Value::Array(items) => items.into_iter().map(floats).collect(),
            Value::Object(map) => Value::Object(map.into_iter().map(|(k, v)| (k, floats(v))).collect()),
            other => other,
        }
    }
}
