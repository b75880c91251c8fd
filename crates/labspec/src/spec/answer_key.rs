//! The key of a question with options or with a statement: written openly under `answer`, or as a hash under `hash`.

use super::fields::Fields;
use super::format::HASH;
use super::problem::{Expected, Mistake};
use super::read::{whole, wrong_key};
use crate::json::{Json, Node, Number};
use crate::source::Text;
use sha2::{Digest, Sha256};
use std::ops::Range;

/// The maximum number of options for which the hash of several options is compared with all combinations.
const MOST_COMBINED: usize = 12;
/// The maximum number of options for which the hash of one option is compared with each.
const MOST_OPTIONS: usize = 100;

/// Which options are correct, or whether the statement is true.
#[derive(Clone, Debug, PartialEq)]
pub struct AnswerKey {
    /// Byte range of the value in the file.
    pub span: Range<usize>,
    /// The value.
    pub value: KeyValue,
    /// The `hash` of a question that has an `answer` as well.
    pub hash_beside: Option<Range<usize>>,
}

/// The ways to write a key.
#[derive(Clone, Debug, PartialEq)]
pub enum KeyValue {
    /// The index of the correct option, from 0.
    Option(Number),
    /// The indexes of the correct options, from 0.
    Options(Vec<Number>),
    /// Whether the statement is true.
    Truth(bool),
    /// The hash of the answer.
    Hash(AnswerHash),
}

/// A salt, and the SHA-256 of the salt and the answer.
#[derive(Clone, Debug, PartialEq)]
pub struct AnswerHash {
    /// Any text.
    pub salt: Text,
    /// The hash as 64 hexadecimal digits.
    pub sha256: Text,
}

impl AnswerHash {
    /// The maximum length of a salt, in bytes.
    pub const MOST_SALT: usize = 256;

    /// Whether the hash has 64 hexadecimal digits.
    pub fn has_digits(&self) -> bool {
        self.sha256.value.len() == 64 && self.sha256.value.bytes().all(|b| b.is_ascii_hexdigit())
    }

    /// Whether the salt is short enough.
    pub fn has_salt(&self) -> bool {
        self.salt.value.len() <= AnswerHash::MOST_SALT
    }

    /// Whether this is the hash of an answer, which is given as a page writes it: `1`, `0,2` or `true`.
    fn is_of(&self, answer: &str) -> bool {
        let mut hash = Sha256::new();
        hash.update(self.salt.value.as_bytes());
        hash.update(b":");
        hash.update(answer.as_bytes());
        let digits: String = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
        digits.eq_ignore_ascii_case(&self.sha256.value)
    }

    fn is_readable(&self) -> bool {
        self.has_digits() && self.has_salt()
    }

    /// The only option with this hash.
    fn option(&self, count: usize) -> Option<usize> {
        let count = if self.is_readable() { count.min(MOST_OPTIONS) } else { 0 };
        (0..count).find(|i| self.is_of(&i.to_string()))
    }

    /// The options with this hash, where there are few enough to try all combinations.
    fn options(&self, count: usize) -> Option<Vec<usize>> {
        if count > MOST_COMBINED || !self.is_readable() {
            return None;
        }
        let chosen = |mask: u32| (0..count).filter(move |i| mask >> i & 1 == 1);
        let written = |mask: u32| chosen(mask).map(|i| i.to_string()).collect::<Vec<_>>().join(",");
        (0..1_u32 << count).find(|mask| self.is_of(&written(*mask))).map(|mask| chosen(mask).collect())
    }
}

impl AnswerKey {
    /// The correct options of a question with `count` of them. `None` if an index is not that of an option, or if no choice
    /// that was tried has the hash.
    pub(super) fn right_options(&self, count: usize, several: bool) -> Option<Vec<usize>> {
        let index = |n: &Number| (0..count).find(|&i| i as f64 == n.value);
        match &self.value {
            KeyValue::Option(n) if !several => index(n).map(|i| vec![i]),
            KeyValue::Options(all) if several => {
                let mut all: Vec<usize> = all.iter().map(index).collect::<Option<_>>()?;
                all.sort_unstable();
                all.dedup();
                Some(all)
            }
            KeyValue::Hash(hash) if several => hash.options(count),
            KeyValue::Hash(hash) => hash.option(count).map(|i| vec![i]),
            _ => None,
        }
    }

    /// Whether the statement is true. `None` if neither answer has the hash.
    pub(super) fn is_true(&self) -> Option<bool> {
        match &self.value {
            KeyValue::Truth(truth) => Some(*truth),
            KeyValue::Hash(hash) if hash.is_readable() => {
                [true, false].into_iter().find(|truth| hash.is_of(&truth.to_string()))
            }
            _ => None,
        }
    }

    /// The key as a text: the answer, or that it is a hash.
    pub(crate) fn describe(&self) -> String {
        match &self.value {
            KeyValue::Option(n) => n.value.to_string(),
            KeyValue::Options(all) => all.iter().map(|n| n.value.to_string()).collect::<Vec<_>>().join(", "),
            KeyValue::Truth(truth) => truth.to_string(),
            KeyValue::Hash(hash) => format!("hash {}", hash.sha256.value),
        }
    }
}

/// Reads `answer` or `hash`. A question without both lacks `answer`. `options` are those of the question.
pub(super) fn read_key(fields: &mut Fields<'_, '_>, options: &[Text]) -> Option<AnswerKey> {
    let several = fields.takes_list("answer");
    let (answer, hash) = (fields.node("answer"), fields.node("hash"));
    let Some(answer) = answer else {
        let Some(node) = hash else {
            let why = if several {
                "it has the indexes of the correct options, from 0"
            } else if fields.takes_flag("answer") {
                "it says whether the statement is true"
            } else {
                "it is the index of the correct option, from 0"
            };
            fields.missing("answer", why, false);
            return None;
        };
        let value = KeyValue::Hash(read_hash(node, fields)?);
        return Some(AnswerKey { span: node.span.clone(), value, hash_beside: None });
    };
    if let Some(node) = hash {
        let _ = read_hash(node, fields);
    }
    let letter = |text: &Text| match text.value.trim().as_bytes() {
        [letter @ b'A'..=b'Z'] => Some(usize::from(letter - b'A')).filter(|index| *index < options.len()),
        _ => None,
    };
    let named =
        |text: &Text| options.iter().position(|option| option.value == text.value).or_else(|| letter(text));
    let value = read_answer(answer, several, &named, fields)?;
    Some(AnswerKey { span: answer.span.clone(), value, hash_beside: hash.map(|node| node.span.clone()) })
}

/// Reads the key. `named`: the index of the option with this text or letter.
fn read_answer(
    node: &Node,
    several: bool,
    named: &dyn Fn(&Text) -> Option<usize>,
    fields: &mut Fields<'_, '_>,
) -> Option<KeyValue> {
    if several {
        let Json::Array(items) = &node.json else {
            wrong_key(fields.problems, node, "answer", Expected::List);
            return None;
        };
        let all: Vec<Option<Number>> = items.iter().map(|item| index(item, named, fields)).collect();
        return Some(KeyValue::Options(all.into_iter().collect::<Option<_>>()?));
    }
    if fields.takes_flag("answer") {
        let Json::Bool(truth) = node.json else {
            wrong_key(fields.problems, node, "answer", Expected::Flag);
            return None;
        };
        return Some(KeyValue::Truth(truth));
    }
    index(node, named, fields).map(KeyValue::Option)
}

/// The index of an option. Its text or its letter is reported, with the index: a text such as "2" may be that of another option.
fn index(node: &Node, named: &dyn Fn(&Text) -> Option<usize>, fields: &mut Fields<'_, '_>) -> Option<Number> {
    if let Json::Text(text) = &node.json
        && let Some(index) = named(text)
    {
        fields.problems.push(Mistake::AnswerText(index).at(node.span.clone()));
        return None;
    }
    whole(node, "answer", fields.problems)
}

fn read_hash(node: &Node, fields: &mut Fields<'_, '_>) -> Option<AnswerHash> {
    let mut inside = Fields::open(node, &HASH, fields.problems)?;
    let (salt, sha256) = (inside.text("salt"), inside.text("sha256"));
    inside.finish();
    Some(AnswerHash { salt: salt?, sha256: sha256? })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceMap;

    fn hash(salt: &str, sha256: &str) -> AnswerHash {
        let text = |value: &str| Text { value: value.to_string(), map: SourceMap::point(0) };
        AnswerHash { salt: text(salt), sha256: text(sha256) }
    }

    fn key(value: KeyValue) -> AnswerKey {
        AnswerKey { span: 0..0, value, hash_beside: None }
    }

    /// The hashes are those that `hashAnswer` of the elements gives.
    #[test]
    fn a_hash_is_that_of_one_choice() {
        // Of "fall:1", "fall:0,2", "fall:" and "fall:true".
        let [one, two, none, truth] = [
            "c2b13ffa5d46ef6535899ba40be9e4490faad74ee58ea5aaed7c2eecf7da4cfb",
            "97da2a75c623e49a83efb57c9effd897a400b1947e459822aa5fc989acb11be9",
            "1a5a7f4e5b1431aef18d918d994059d92107908bb5c0058d1ced604266888db5",
            "9973592072055a23a878080d13ddf0f44a09f8470bdaa207f2b10b14f7962f81",
        ]
        .map(|digits| key(KeyValue::Hash(hash("fall", digits))));
        assert_eq!(one.right_options(3, false), Some(vec![1]));
        assert_eq!(one.right_options(1, false), None);
        assert_eq!(two.right_options(3, true), Some(vec![0, 2]));
        assert_eq!(none.right_options(3, true), Some(vec![]));
        assert_eq!(two.right_options(MOST_COMBINED + 1, true), None);
        assert_eq!(truth.is_true(), Some(true));
        assert_eq!(two.is_true(), None);
    }

    #[test]
    fn a_hash_of_another_form_is_of_no_choice() {
        for (salt, digits) in [("fall", "abc"), (&*"x".repeat(300), &*"0".repeat(64))] {
            assert_eq!(key(KeyValue::Hash(hash(salt, digits))).right_options(3, true), None);
        }
    }

    /// The fixes of a question of this kind with the options 1, 2 and 3.
    fn fixes(kind: &str, answer: serde_json::Value) -> Vec<(String, String)> {
        let question = serde_json::json!({"kind": kind, "q": "How often?", "options": ["1", "2", "3"], "answer": answer});
        let quiz = serde_json::json!({"id": "q", "questions": [question]}).to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
        let of_answer = report.findings.iter().filter(|f| f.message.starts_with("`answer`"));
        of_answer.map(|f| (f.message.clone(), f.help.clone().unwrap_or_default())).collect()
    }

    /// A text that names an option is never taken for an index: "2" is the option 1.
    #[test]
    fn texts_of_options_are_no_indexes() {
        let index = |i: &str| {
            (
                "`answer` must be the index of an option, not its text or its letter".to_string(),
                format!("write {i}, the index of this option"),
            )
        };
        assert_eq!(fixes("multiple", serde_json::json!(["1", "2"])), [index("0"), index("1")]);
        assert_eq!(fixes("multiple", serde_json::json!(["B", 0])), [index("1")]);
        assert_eq!(fixes("mcq", serde_json::json!("2")), [index("1")]);
        assert_eq!(fixes("mcq", serde_json::json!("C")), [index("2")]);
        assert_eq!(fixes("multiple", serde_json::json!(["7"])).len(), 1);
        assert!(!fixes("multiple", serde_json::json!(["7"])).contains(&index("7")));
    }
}
