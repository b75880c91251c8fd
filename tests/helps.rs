//! The help of every rule, done literally in the wrong example of the rule: the finding ends, and no other one begins.
//!
//! A help is done in one of three ways. Its fix is applied. Or what it quotes (``write `X` ``, ``did you mean `X`?``, "delete it")
//! is written at the place of the finding. Or the right example of the rule is what the help says: all that it adds to the
//! wrong example is in the help. The remaining helps are not literal; they are listed, so that no other one joins them.

// A test that cannot read its own inputs must fail.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::population::{sample, takes_all};
use crate::rules::report_of;
use crate::support::{for_each, workspace};
use labspec::rules::{self, Rule, example};
use labspec_finding::Example;
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;

/// A finding of an example.
#[derive(Clone)]
struct Reported {
    code: String,
    file: String,
    span: Range<usize>,
    help: String,
    fix: Option<(Range<usize>, String)>,
}

/// How a help was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Done {
    /// Its fix was applied.
    Fixed,
    /// What it quotes was written.
    Written,
    /// The right example is what it says.
    InRightExample,
    /// It is not literal.
    NotLiteral,
    /// The finding has none.
    WithoutHelp,
}

/// An example, its files, and the findings of its check.
struct Case {
    example: Example,
    files: Vec<(String, Vec<u8>)>,
}

impl Case {
    fn text(&self) -> String {
        String::from_utf8_lossy(&self.files[0].1).into_owned()
    }

    /// The findings with another text of the checked file.
    fn findings(&self, text: &str) -> Vec<Reported> {
        let mut files = self.files.clone();
        files[0].1 = text.as_bytes().to_vec();
        let (report, _) = report_of(&self.example, &files);
        report["findings"].as_array().into_iter().flatten().map(reported).collect()
    }

    /// Whether the rule is content with a text, and no other rule objects.
    fn ends(&self, before: &[Reported], code: &str, text: &str) -> bool {
        let count = |list: &[Reported], code: &str| list.iter().filter(|f| f.code == code).count();
        let after = self.findings(text);
        let fewer = count(&after, code) < count(before, code);
        fewer && after.iter().all(|f| count(&after, &f.code) <= count(before, &f.code))
    }
}

fn reported(f: &Value) -> Reported {
    let text = |value: &Value| value.as_str().unwrap_or("").to_string();
    let span = |f: &Value| {
        let byte = |key: &str| f[key].as_u64().unwrap_or(0) as usize;
        byte("start")..byte("end")
    };
    let fix = &f["fix"];
    Reported {
        code: text(&f["code"]),
        file: text(&f["file"]),
        span: span(f),
        help: text(&f["help"]),
        fix: fix.is_object().then(|| (span(fix), text(&fix["text"]))),
    }
}

fn replaced(text: &str, span: Range<usize>, new: &str) -> Option<String> {
    Some(format!("{}{new}{}", text.get(..span.start)?, text.get(span.end..)?))
}

/// What a help quotes, in its order: texts in backquotes, and the word after "write", "use", "set it to" or "add".
fn quoted(help: &str) -> Vec<String> {
    let mut all: Vec<String> = help.split('`').skip(1).step_by(2).map(str::to_string).collect();
    for verb in ["write ", "use ", "add ", "set it to ", "write one of ", "use one of: "] {
        for (at, _) in help.match_indices(verb) {
            let rest = &help[at + verb.len()..];
            if let Some(inside) = rest.strip_prefix('"').and_then(|rest| rest.split_once('"')) {
                all.push(inside.0.to_string());
                all.push(format!("\"{}\"", inside.0));
            }
            let end = rest.find([',', ';', ' ', ':']).unwrap_or(rest.len());
            all.push(rest[..end].to_string());
            let end = [" in the", " without", ", ", "; "].iter().filter_map(|stop| rest.find(stop)).min();
            all.push(rest[..end.unwrap_or(rest.len())].to_string());
        }
    }
    all.retain(|text| !text.is_empty() && !text.contains('…'));
    let mut seen = Vec::new();
    all.retain(|text| {
        let new = !seen.contains(text);
        seen.push(text.clone());
        new
    });
    all
}

/// The text in quotes around a span: an attribute, a JSON string.
fn around(text: &str, span: &Range<usize>) -> Option<Range<usize>> {
    let (before, after) = (text.get(..span.start)?, text.get(span.end..)?);
    let quote = before.chars().rev().find(|c| matches!(c, '"' | '\''))?;
    Some(before.rfind(quote)? + 1..span.end + after.find(quote)?)
}

/// The members of JSON objects in a help, each with its key: `"init": true`.
fn members(help: &str) -> Vec<(String, String)> {
    let mut all = Vec::new();
    for (at, _) in help.match_indices("\": ") {
        let Some(start) = help[..at].rfind('"') else { continue };
        let value = &help[at + 3..];
        let (mut depth, mut text, mut end) = (0, false, value.len());
        for (i, c) in value.char_indices() {
            match c {
                '"' if !value[..i].ends_with('\\') => text = !text,
                '[' | '{' if !text => depth += 1,
                ']' | '}' if !text => depth -= 1,
                ',' | '`' | ' ' | ';' | ':' if !text && depth == 0 => end = end.min(i),
                _ => {}
            }
            if depth < 0 {
                end = end.min(i);
            }
        }
        let value = &value[..end];
        if !value.is_empty() && !value.contains('…') {
            all.push((help[start + 1..at].to_string(), format!("{}{value}", &help[start..at + 3])));
        }
    }
    all
}

/// The text with a member in place of the one with its key, or of the one that the help replaces, or in an object.
fn with_members(text: &str, finding: &Reported) -> Vec<String> {
    let members = members(&finding.help);
    let value_end = |start: usize| {
        let ends = [", \"", "}", "]}"].iter().filter_map(|end| text[start..].find(end));
        ends.min().map(|end| start + end)
    };
    let place_of = |key: &str| {
        let start = text.find(&format!("\"{key}\": "))?;
        Some(start..value_end(start + key.len() + 4)?)
    };
    let replaces = finding.help.split("nstead of ").nth(1);
    let old = replaces.map(|rest| rest.trim_start_matches(['`', '"']).split(['`', '"']).next().unwrap_or(""));
    let mut all = Vec::new();
    let mut together = text.to_string();
    for (key, member) in &members {
        for key in [Some(key.as_str()), old].into_iter().flatten() {
            all.extend(place_of(key).and_then(|place| replaced(text, place, member)));
        }
        if let Some(place) = place_of(key) {
            together = together.replacen(&text[place], member, 1);
        }
        let open = text[..finding.span.end].rfind('{').map(|at| at + 1);
        all.extend(open.and_then(|at| replaced(text, at..at, &format!("{member}, "))));
    }
    all.push(together);
    all
}

/// The text with the value of an attribute that a help sets: "set the timestep to 0.01 s".
fn with_attribute(text: &str, help: &str) -> Option<String> {
    let (name, value) = help.split("et the ").nth(1)?.split_once(" to ")?;
    let value = value.split(' ').next()?;
    let start = text.find(&format!("{name}='"))? + name.len() + 2;
    let end = start + text[start..].find('\'')?;
    replaced(text, start..end, value)
}

/// The texts that a help, done literally at the place of its finding, can give; the usual places first.
fn written(text: &str, finding: &Reported) -> Vec<String> {
    let mut all = with_members(text, finding);
    let span = &finding.span;
    let Some(marked) = text.get(span.clone()) else { return all };
    all.extend(with_attribute(text, &finding.help));
    let whole = around(text, span);
    let close = |c: char| text[span.end..].find(c).map(|at| span.end + at);
    let number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-');
    let digits = &marked[..marked.find(|c| !number(c)).unwrap_or(marked.len())];
    for new in quoted(&finding.help) {
        let in_json = new.replace('"', "\\\"");
        all.extend(replaced(text, span.clone(), &new));
        all.extend(whole.clone().and_then(|whole| replaced(text, whole, &in_json)));
        // The same text in several places: in the prose and in its quote.
        if marked.len() > 2 {
            all.push(text.replace(marked, &new));
        }
        if !digits.is_empty() {
            all.push(text.replace(digits, &new));
        }
        // Beside it, as a key of its object, as an item of its list, as an attribute, after its statement.
        for end in ['}', ']'] {
            all.extend(close(end).and_then(|end| replaced(text, end..end, &format!(", {new}"))));
        }
        all.extend(replaced(text, span.end..span.end, &format!(" {new}")));
        all.extend(replaced(text, span.start..span.start, &new));
        all.extend(whole.clone().and_then(|whole| replaced(text, whole.end..whole.end, &format!("; {new}"))));
    }
    if finding.help.contains("so that they differ") {
        all.extend(replaced(text, span.end..span.end, " 2"));
    }
    if ["delete", "remove", "keep one of"].iter().any(|verb| finding.help.contains(verb)) {
        all.extend(deleted(text, span));
    }
    let mut seen = std::collections::BTreeSet::new();
    all.retain(|new| new != text && seen.insert(new.clone()));
    all
}

/// The text without the marked part, or without the key or the item that contains it.
fn deleted(text: &str, span: &Range<usize>) -> Vec<String> {
    let (before, after) = (&text[..span.start], &text[span.end..]);
    let starts =
        [Some(span.start), before.strip_suffix('"').map(str::len), before.rfind(','), before.rfind(", {")];
    let ends = [Some(0), after.find(", \"").map(|at| at + 2), after.find('}'), after.find(']')];
    let mut all = Vec::new();
    for start in starts.into_iter().flatten() {
        all.extend(ends.into_iter().flatten().filter_map(|end| replaced(text, start..span.end + end, "")));
    }
    all
}

/// The words and numbers of a text, with their counts.
fn count_words(text: &str) -> BTreeMap<&str, usize> {
    let mut all = BTreeMap::new();
    for word in
        text.split(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.'))).filter(|word| !word.is_empty())
    {
        *all.entry(word.trim_matches('.')).or_default() += 1;
    }
    all
}

/// Whether all that the right example adds to the wrong one is in the help.
fn says_right_example(wrong: &str, right: &str, help: &str) -> bool {
    let (wrong, right) = (count_words(wrong), count_words(right));
    let offered = count_words(help);
    let added: Vec<&str> = right
        .iter()
        .filter(|(word, n)| wrong.get(*word).is_none_or(|m| m < n))
        .map(|(word, _)| *word)
        .collect();
    let removed = wrong.iter().any(|(word, n)| right.get(word).is_none_or(|m| m < n));
    let deletes = ["delete", "remove"].iter().any(|verb| help.contains(verb));
    let all_said = added.iter().all(|word| offered.contains_key(word));
    all_said && if added.is_empty() { removed && deletes } else { true }
}

/// Does the help of a rule, which may be listed as not literal. `None` if its finding has no help.
fn do_help(rule: &Rule, is_listed: bool) -> Option<(Done, Reported)> {
    let case = Case { example: rule.bad, files: example::files(&rule.bad) };
    let text = case.text();
    let before = case.findings(&text);
    let place = example::marked(&rule.bad);
    let of_rule = || before.iter().filter(|f| f.code == rule.code);
    let finding = of_rule().find(|f| place.as_ref() == Some(&f.span)).or_else(|| of_rule().next())?.clone();
    let in_file = finding.file.ends_with(&case.files[0].0);
    if let Some((span, new)) = finding.fix.clone().filter(|_| in_file)
        && replaced(&text, span, &new).is_some_and(|fixed| case.ends(&before, rule.code, &fixed))
    {
        return Some((Done::Fixed, finding));
    }
    if finding.help.is_empty() {
        return None;
    }
    // Read before the tries, each of which is a check.
    if says_right_example(&rule.bad.text(), &rule.good.text(), &finding.help) {
        return Some((Done::InRightExample, finding));
    }
    // Whether the list is still right is tested where nothing may be left out.
    let tried = text.len() < MAX_LENGTH && in_file && (!is_listed || takes_all());
    let mut tries = written(&text, &finding).into_iter().take(MAX_TRIES);
    let done = match tried && tries.any(|new| case.ends(&before, rule.code, &new)) {
        true => Done::Written,
        false => Done::NotLiteral,
    };
    Some((done, finding))
}

/// The largest number of places and forms in which a help is tried.
const MAX_TRIES: usize = 56;
/// Longer examples are generated, and too long for all tries.
const MAX_LENGTH: usize = 4000;

/// A sample has one rule of `STEP`.
const STEP: usize = 3;

#[test]
fn helps_done_literally_end_their_findings() {
    let all: Vec<&Rule> = sample(rules::all().collect(), STEP);
    let list = std::fs::read_to_string(workspace().join("tests/helps/not_literal.txt")).unwrap();
    let is_taken = |code: &&str| all.iter().any(|rule| rule.code == *code) || takes_all();
    let listed: Vec<&str> = list.lines().filter(|line| !line.starts_with('#')).filter(is_taken).collect();
    let done = for_each(all.len(), |i| do_help(all[i], listed.contains(&all[i].code)));
    let mut counts: BTreeMap<Done, usize> = BTreeMap::new();
    let (mut open, mut helps) = (Vec::new(), String::new());
    for (rule, done) in all.iter().zip(&done) {
        match done {
            Some((Done::NotLiteral, finding)) => {
                open.push(rule.code);
                helps += &format!("{}: {}\n", rule.code, finding.help);
            }
            None => open.push(rule.code),
            Some(_) => {}
        }
        let done = done.as_ref().map_or(Done::WithoutHelp, |(done, _)| *done);
        *counts.entry(done).or_default() += 1;
    }
    println!("{counts:?}\n{helps}");
    let added: Vec<_> = open.iter().filter(|code| !listed.contains(code)).collect();
    let removed: Vec<_> = listed.iter().filter(|code| !open.contains(code)).collect();
    assert!(
        added.is_empty() && removed.is_empty(),
        "{counts:?}; not literal, and not in tests/helps/not_literal.txt: {added:?}; literal now: {removed:?}"
    );
}
