//! Reads typed values out of JSON objects and collects what is wrong instead of stopping at the first mistake.

use super::literal::repaired;
use super::{Json, Member, Node, nearest};
use crate::finding::{Finding, Severity};
use crate::lint::rules::keys::{MISSING_KEY, UNKNOWN_KEY, WRONG_TYPE};
use crate::source::Text;
use std::ops::Range;

/// A number and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// The number; finite.
    pub value: f64,
    /// Bytes of the file.
    pub span: Range<usize>,
}

/// A value that a control can take.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// A number.
    Number(Number),
    /// A text.
    Text(Text),
    /// A truth value and its place.
    Bool(bool, Range<usize>),
}

impl Scalar {
    /// Bytes of the file.
    pub fn span(&self) -> Range<usize> {
        match self {
            Scalar::Number(n) => n.span.clone(),
            Scalar::Text(t) => t.span(),
            Scalar::Bool(_, span) => span.clone(),
        }
    }

    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Scalar::Number(n) => Some(n.value),
            _ => None,
        }
    }

    /// Whether two values are the same, wherever they stand.
    pub fn same(&self, other: &Scalar) -> bool {
        match (self, other) {
            (Scalar::Number(a), Scalar::Number(b)) => a.value == b.value,
            (Scalar::Text(a), Scalar::Text(b)) => a.value == b.value,
            (Scalar::Bool(a, _), Scalar::Bool(b, _)) => a == b,
            _ => false,
        }
    }

    /// As it stands in JSON.
    pub fn show(&self) -> String {
        match self {
            Scalar::Number(n) => n.value.to_string(),
            Scalar::Text(t) => format!("{:?}", t.value),
            Scalar::Bool(b, _) => b.to_string(),
        }
    }
}

/// The keys of one object, read one by one. Every key that is asked for is a known key; [`Fields::finish`]
/// reports the others.
pub struct Fields<'n, 'f> {
    /// What the object is, with its article: "a slider".
    what: &'static str,
    members: &'n [Member],
    span: Range<usize>,
    known: Vec<&'static str>,
    /// Misspelt keys: what was meant, and the index of the member.
    meant: Vec<(&'static str, usize)>,
    missing: Vec<(&'static str, Finding)>,
    /// Where findings go.
    pub findings: &'f mut Vec<Finding>,
}

impl<'n, 'f> Fields<'n, 'f> {
    /// Opens an object; anything else is a finding and `None`.
    pub fn open(
        node: &'n Node,
        what: &'static str,
        findings: &'f mut Vec<Finding>,
    ) -> Option<Fields<'n, 'f>> {
        match &node.json {
            Json::Object(members) => Some(Fields {
                what,
                members,
                span: node.span.clone(),
                known: Vec::new(),
                meant: Vec::new(),
                missing: Vec::new(),
                findings,
            }),
            _ => {
                wrong(findings, node, what, "an object { … }");
                None
            }
        }
    }

    /// The keys that the object may have. One that is misspelt is then read as what was meant (and reported by
    /// [`Fields::finish`]), so that one letter does not make everything else wrong.
    pub fn keys(&mut self, keys: &[&'static str]) {
        for (i, member) in self.members.iter().enumerate().take(200) {
            let key = member.key.as_str();
            if keys.contains(&key) || self.meant.len() >= 20 {
                continue;
            }
            let fitting = keys.iter().copied().filter(|k| fits(k, &member.value.json));
            if let Some(right) = nearest(key, fitting)
                && !self.has(right)
            {
                self.meant.push((right, i));
            }
        }
    }

    /// Bytes of the object, brackets included.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Says more exactly what the object is, once its keys have told.
    pub fn rename(&mut self, what: &'static str) {
        self.what = what;
    }

    /// The value of a key. Of two equal keys the last one counts, as in `JSON.parse`.
    pub fn node(&mut self, key: &'static str) -> Option<&'n Node> {
        if !self.known.contains(&key) {
            self.known.push(key);
        }
        let exact = self.members.iter().rev().find(|m| m.key.value == key);
        let meant =
            || self.meant.iter().find(|(right, _)| *right == key).and_then(|(_, i)| self.members.get(*i));
        exact.or_else(meant).map(|m| &m.value)
    }

    /// Whether the object has this key, perhaps misspelt.
    pub fn has(&self, key: &str) -> bool {
        self.members.iter().any(|m| m.key.value == key) || self.meant.iter().any(|(right, _)| *right == key)
    }

    /// A key that must be there.
    fn need(&mut self, key: &'static str, why: &str) -> Option<&'n Node> {
        let node = self.node(key);
        if node.is_none() {
            self.missing(key, why, Severity::Error);
        }
        node
    }

    /// Reports that a key is missing, at the opening bracket of the object.
    pub fn missing(&mut self, key: &'static str, why: &str, severity: Severity) {
        let open = self.span.start..self.span.end.min(self.span.start + 1);
        let finding = Finding::new(&MISSING_KEY, open, format!("{} needs `{key}`", self.what));
        self.missing.push((key, finding.severity(severity).why(why).help(format!("add \"{key}\": …"))));
    }

    /// A text.
    pub fn text(&mut self, key: &'static str) -> Option<Text> {
        let node = self.node(key)?;
        text(node, key, self.findings)
    }

    /// A text that must be there.
    pub fn need_text(&mut self, key: &'static str, why: &str) -> Option<Text> {
        let node = self.need(key, why)?;
        text(node, key, self.findings)
    }

    /// A number.
    pub fn number(&mut self, key: &'static str) -> Option<Number> {
        let node = self.node(key)?;
        number(node, key, self.findings)
    }

    /// A number that must be there.
    pub fn need_number(&mut self, key: &'static str, why: &str) -> Option<Number> {
        let node = self.need(key, why)?;
        number(node, key, self.findings)
    }

    /// A whole number; its sign and range are for the rules.
    pub fn whole(&mut self, key: &'static str) -> Option<Number> {
        let node = self.node(key)?;
        whole(node, key, self.findings)
    }

    /// A whole number that must be there.
    pub fn need_whole(&mut self, key: &'static str, why: &str) -> Option<Number> {
        let node = self.need(key, why)?;
        whole(node, key, self.findings)
    }

    /// A truth value; absent or wrong means `false`.
    pub fn flag(&mut self, key: &'static str) -> bool {
        let Some(node) = self.node(key) else { return false };
        match node.json {
            Json::Bool(b) => b,
            _ => {
                wrong_key(self.findings, node, key, "true or false, without quotes");
                false
            }
        }
    }

    /// A number, text or truth value that must be there.
    pub fn need_scalar(&mut self, key: &'static str, why: &str) -> Option<Scalar> {
        let node = self.need(key, why)?;
        scalar(node, key, self.findings)
    }

    /// The items of a list; absent or wrong means none.
    pub fn list(&mut self, key: &'static str) -> &'n [Node] {
        let Some(node) = self.node(key) else { return &[] };
        match &node.json {
            Json::Array(items) => items,
            _ => {
                wrong_key(self.findings, node, key, "a list [ … ]");
                &[]
            }
        }
    }

    /// The items of a list that must be there.
    pub fn need_list(&mut self, key: &'static str, why: &str) -> Option<&'n [Node]> {
        self.need(key, why)?;
        Some(self.list(key))
    }

    /// The members of an object of free keys; absent or wrong means none.
    pub fn map(&mut self, key: &'static str) -> &'n [Member] {
        let Some(node) = self.node(key) else { return &[] };
        match &node.json {
            Json::Object(members) => members,
            _ => {
                wrong_key(self.findings, node, key, "an object { … }");
                &[]
            }
        }
    }

    /// Reports every key that nobody asked for, and those that are missing unless they are only misspelt.
    pub fn finish(self) {
        let (mut misspelt, mut reported) = (Vec::new(), 0);
        for (i, member) in self.members.iter().enumerate() {
            let key = member.key.as_str();
            if self.known.contains(&key) {
                continue;
            }
            let finding = Finding::new(
                &UNKNOWN_KEY,
                member.key.span(),
                match key.trim().is_empty() {
                    true => format!("a key of {} has no name", self.what),
                    false => format!("{} has no key `{}`", self.what, shorten(key)),
                },
            );
            // Suggestions for the first ones only: a hostile object can have thousands.
            let known = || self.known.iter().copied().take(if reported < 20 { usize::MAX } else { 0 });
            let meant = self.meant.iter().find(|(right, at)| *at == i && self.known.contains(right));
            let there =
                |right: &str| self.members.iter().any(|m| m.key.value == right) || misspelt.contains(&right);
            let fitting = || nearest(key, known().filter(|k| fits(k, &member.value.json)));
            let near = meant.map(|(right, _)| *right).or_else(fitting);
            self.findings.push(match near.or_else(|| nearest(key, known())) {
                Some(right) if there(right) => finding.help(format!(
                    "did you mean `{right}`? the object has it already: delete one of the two"
                )),
                Some(right) if near.is_some() => {
                    misspelt.push(right);
                    finding.help(format!("did you mean `{right}`?")).fix(member.key.span(), right)
                }
                Some(right) => {
                    misspelt.push(right);
                    finding.help(format!("did you mean `{right}`? {}", takes(right)))
                }
                None => finding.help(format!("its keys are {}", self.known.join(", "))),
            });
            reported += 1;
        }
        let missing = self.missing.into_iter().filter(|(key, _)| !misspelt.contains(key));
        self.findings.extend(missing.map(|(_, finding)| finding));
    }
}

/// Keys whose value is a list, and those whose value is an object, wherever they stand.
const LISTS: [&str; 12] = [
    "controls",
    "plots",
    "readouts",
    "toggles",
    "speeds",
    "traces",
    "refLines",
    "options",
    "questions",
    "says",
    "press",
    "target",
];
const OBJECTS: [&str; 7] = ["camera", "overlays", "verify", "sim", "runs", "measure", "exact"];
/// Keys that take an object in one place and a text in another.
const EITHER: [&str; 2] = ["lab", "set"];

/// Whether a key can have such a value.
pub(crate) fn fits(key: &str, value: &Json) -> bool {
    match value {
        Json::Broken => true,
        Json::Array(_) => LISTS.contains(&key),
        Json::Object(_) => OBJECTS.contains(&key) || EITHER.contains(&key),
        _ => !LISTS.contains(&key) && !OBJECTS.contains(&key),
    }
}

/// What a key takes, as a sentence.
fn takes(key: &str) -> String {
    let what = match key {
        _ if LISTS.contains(&key) => "a list [ … ]",
        _ if OBJECTS.contains(&key) => "an object { … }",
        _ => "a single value",
    };
    format!("it takes {what}")
}

/// A text, or a finding.
pub(crate) fn text(node: &Node, what: &str, findings: &mut Vec<Finding>) -> Option<Text> {
    match &node.json {
        Json::Text(text) => Some(text.clone()),
        _ => {
            wrong_key(findings, node, what, "a text in double quotes");
            None
        }
    }
}

/// A number, or a finding.
pub(crate) fn number(node: &Node, what: &str, findings: &mut Vec<Finding>) -> Option<Number> {
    match &node.json {
        Json::Number(value) => Some(Number { value: *value, span: node.span.clone() }),
        _ => {
            wrong_key(findings, node, what, "a number, without quotes");
            None
        }
    }
}

fn whole(node: &Node, what: &str, findings: &mut Vec<Finding>) -> Option<Number> {
    let number = number(node, what, findings)?;
    if number.value.fract() == 0.0 {
        return Some(number);
    }
    findings.push(
        Finding::new(
            &WRONG_TYPE,
            node.span.clone(),
            format!("`{what}` is a whole number, not {}", number.value),
        )
        .help("write a number without a point"),
    );
    None
}

/// A number, a text or a truth value, or a finding.
pub(crate) fn scalar(node: &Node, what: &str, findings: &mut Vec<Finding>) -> Option<Scalar> {
    match &node.json {
        Json::Number(value) => Some(Scalar::Number(Number { value: *value, span: node.span.clone() })),
        Json::Text(text) => Some(Scalar::Text(text.clone())),
        Json::Bool(b) => Some(Scalar::Bool(*b, node.span.clone())),
        _ => {
            wrong_key(findings, node, what, "a number, a text or true/false");
            None
        }
    }
}

fn wrong_key(findings: &mut Vec<Finding>, node: &Node, key: &str, expected: &str) {
    wrong(findings, node, &format!("`{key}`"), expected);
}

fn wrong(findings: &mut Vec<Finding>, node: &Node, what: &str, expected: &str) {
    if node.is_broken() {
        return;
    }
    let finding = Finding::new(
        &WRONG_TYPE,
        node.span.clone(),
        format!("{what} must be {expected}; this is {}", node.describe()),
    );
    // "5" for 5 is the common case, and it has one repair.
    findings.push(match &node.json {
        Json::Text(text) if expected.starts_with("a number") => match repaired(text.value.trim()) {
            Some(bare) => {
                finding.help(format!("write {bare} without the quotes")).fix(node.span.clone(), bare)
            }
            None => finding.help(format!("write {expected}")),
        },
        Json::Text(text) if expected.starts_with("true or false") && is_flag(&text.value) => {
            let bare = text.value.trim().to_string();
            finding.help(format!("write {bare} without the quotes")).fix(node.span.clone(), bare)
        }
        Json::Number(_) if expected.starts_with("a text") => finding.help("put quotes around it"),
        _ => finding.help(format!("write {expected}")),
    });
}

fn is_flag(text: &str) -> bool {
    matches!(text.trim(), "true" | "false")
}

/// What an author wrote, in backticks; nothing is named as that.
pub(crate) fn named(text: &str) -> String {
    if text.trim().is_empty() { "\"\"".to_string() } else { format!("`{}`", shorten(text)) }
}

/// A key as it may be shown: a hostile one can be long.
pub(crate) fn shorten(text: &str) -> String {
    let mut short: String = text.chars().take(60).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}
