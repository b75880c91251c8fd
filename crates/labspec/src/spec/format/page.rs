//! Generates `docs/reference/format.md`: a section for every object, a table row for every key.

use super::describe::{default, takes};
use super::{Absent, CONTROL, EVENTS, FIRST, Family, Key, LAB, Need, OBJECTS, OVERLAYS, Object, QUESTION};
use super::{KeyRule, Type, Word};
use crate::printable::capital;
use std::fmt::Write;

/// The reference page of the format, as Markdown.
pub fn page() -> String {
    let mut text = String::from(
        "# Format\n\nEvery object of labs, quizzes and checks, with all its keys. The guide is [lessons.md](../lessons.md); [language.md](language.md) explains the code. An editor that knows JSON Schema uses [lab.json](../schema/lab.json) and [quiz.json](../schema/quiz.json), which `labspec schema` prints; a program that embeds labspec calls `labspec::spec::format::completions`.\n\nA key that is not listed here is an error. Examples refer to `specs/models/fall.xml`: one ball, 2 m above nothing.\n\nAll keys exist since version ",
    );
    let _ = writeln!(text, "{FIRST}, unless a line says otherwise.");
    for object in OBJECTS {
        if CONTROL.objects.first().is_some_and(|first| first.name == object.name) {
            family(&mut text, &CONTROL);
        }
        if QUESTION.objects.first().is_some_and(|first| first.name == object.name) {
            family(&mut text, &QUESTION);
        }
        section(&mut text, object);
        if object.name == LAB.name {
            write_words(&mut text, "Overlays", &OVERLAYS);
            events(&mut text);
        }
    }
    text
}

fn family(text: &mut String, family: &Family) {
    let first = family.words.first().map_or("", |w| w.text);
    let _ = write!(
        text,
        "\n## {}\n\n{} `{}` selects the kind; without it, the kind is `{first}`.\n",
        capital(family.name),
        family.doc,
        family.key
    );
    table(text, family.key, family.words);
}

fn section(text: &mut String, object: &Object) {
    let level = if object.tag.is_some() { "###" } else { "##" };
    let _ = write!(text, "\n{level} {}\n\n{}", heading(object), object.doc);
    for rule in object.key_rules {
        let (count, names, rule) = match rule {
            KeyRule::ExactlyOne(names) => ("Exactly one", *names, "must be present"),
            KeyRule::AtLeastOne(names) => ("At least one", *names, "must be present"),
            KeyRule::OneAdvised(names) => ("At least one", *names, "should be present"),
            KeyRule::AtMostOne(names) => ("Only one", names.as_slice(), "can be present"),
            KeyRule::FirstCounts(names) => ("Only the first", names.as_slice(), "counts"),
        };
        let names: Vec<String> = names.iter().map(|n| format!("`{n}`")).collect();
        let _ = write!(text, " {count} of {} {rule}.", names.join(", "));
    }
    if object.minimal != "{}" {
        let _ = write!(text, "\n\n```json\n{}\n```", object.minimal);
    }
    text.push_str("\n\n| key | type | default | meaning | example |\n|---|---|---|---|---|\n");
    for key in object.keys {
        let since = if key.since == FIRST { String::new() } else { format!(" (since {})", key.since) };
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {}{since} | `{}` |",
            key.name,
            cell(&match object.tag.filter(|(tag, _)| *tag == key.name) {
                Some((_, word)) => format!("\"{word}\""),
                None => takes(key) + &link(&key.ty),
            }),
            cell(&describe_default(key)),
            cell(key.doc),
            cell(key.example)
        );
    }
}

/// A link to the keys of the objects that this type accepts.
fn link(ty: &Type) -> String {
    let heading = match ty {
        Type::Object(object) => heading(object),
        Type::OneOf(family) => capital(family.name),
        Type::List(item) => return link(item),
        Type::Map(map) => return link(&map.ty),
        Type::Either(a, b) => return link(a) + &link(b),
        _ => return String::new(),
    };
    format!(" ([keys](#{}))", heading.to_lowercase().replace(' ', "-"))
}

/// The name of an object, without its article.
fn heading(object: &Object) -> String {
    capital(object.what.split_once(' ').map_or(object.what, |(_, name)| name))
}

/// What applies if a key is absent.
fn describe_default(key: &Key) -> String {
    if key.required() {
        return "an error".into();
    }
    match (key.absent, key.need) {
        (Absent::Described(words), _) => words.into(),
        (_, Need::Advised(_)) => "a warning".into(),
        (Absent::Text(""), _) => "–".into(),
        _ => default(key).map_or("–".into(), |value| format!("`{}`", spaced(&value))),
    }
}

/// JSON with a space after every comma.
fn spaced(value: &serde_json::Value) -> String {
    match value.as_array() {
        Some(items) => {
            let items: Vec<String> = items.iter().map(spaced).collect();
            format!("[{}]", items.join(", "))
        }
        None => value.to_string(),
    }
}

fn write_words(text: &mut String, title: &str, words: &[Word]) {
    let _ = write!(text, "\n### {title}\n\nWords for `overlays` and `toggles`.\n");
    table(text, "word", words);
}

fn table(text: &mut String, head: &str, words: &[Word]) {
    let _ = write!(text, "\n| {head} | meaning |\n|---|---|\n");
    for word in words {
        let _ = writeln!(text, "| `{}` | {} |", word.text, cell(word.doc));
    }
}

fn events(text: &mut String) {
    text.push_str("\n### Order of events\n\n");
    for (i, event) in EVENTS.iter().enumerate() {
        let _ = writeln!(text, "{}. {event}", i + 1);
    }
}

/// Escapes the bars of a text, so that they do not separate table cells.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}
