//! An object of the model that a text names in place of the one that a measure reads.

use super::{Other, ReadMeasure};
use crate::language::ComparisonWords;
use crate::language::words::{find, split_words};
use labspec_core::{Model, Obj};

/// The kinds of objects whose names texts use.
const KINDS: [Obj; 7] =
    [Obj::Body, Obj::Geom, Obj::Joint, Obj::Site, Obj::Actuator, Obj::Tendon, Obj::Sensor];
/// Shorter names are other words of a text.
const SHORTEST: usize = 3;
/// The number of words before a name in which a preposition makes it an agent: `by the red cart`.
const AGENT_LENGTH: usize = 2;

/// The object that a text names, if it is of the same kind as the one that the measure reads, which the text does not name.
pub(super) fn other(read: &ReadMeasure<'_, '_>, text: &str) -> Option<Other> {
    let model = &read.bound.scene_of(read.bound.runs.get(read.run)?)?.scene.model;
    let literals = literals(&read.text.value);
    let is_named = |name: &str| words_of_name(name).is_some_and(|words| find(text, &words).is_some());
    if literals.iter().any(|name| is_named(name)) {
        return None;
    }
    let mut pairs = literals.iter().flat_map(|name| {
        let named = siblings(model, name, &is_named).into_iter();
        named.filter(|other| !literals.contains(other)).map(move |other| (*name, other))
    });
    let (Some((name, other)), None) = (pairs.next(), pairs.next()) else { return None };
    if is_partner(read, text, other) {
        return None;
    }
    let replaced = ['\'', '"'].iter().fold(read.text.value.to_string(), |text, quote| {
        text.replace(&format!("{quote}{name}{quote}"), &format!("{quote}{other}{quote}"))
    });
    let value = read.with_text(replaced.clone())?;
    Some(Other {
        words: other.to_string(),
        read: format!("`{name}`: `{}`", read.text.as_str()),
        with: format!("`{replaced}` in the same run"),
        value,
    })
}

/// Whether the text names an object to describe another one: `the partner of the red cart`, `pushed by the red cart`, `the red cart
/// pushes the other one`.
fn is_partner(read: &ReadMeasure<'_, '_>, text: &str, name: &str) -> bool {
    let listed =
        |list: ComparisonWords, word: &str| read.languages.comparisons(list).any(|other| other == word);
    let place = words_of_name(name).and_then(|words| find(text, &words));
    let before = place.and_then(|start| text.get(..start)).unwrap_or("");
    split_words(text).any(|word| listed(|c| c.partners, word))
        || split_words(before).rev().take(AGENT_LENGTH).any(|word| listed(|c| c.agents, word))
}

/// The texts between quotes in an expression.
fn literals(text: &str) -> Vec<&str> {
    let mut all = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find(['\'', '"']) {
        let quote = if rest.get(start..).is_some_and(|t| t.starts_with('\'')) { '\'' } else { '"' };
        let Some((inside, behind)) = rest.get(start + 1..).and_then(|t| t.split_once(quote)) else { break };
        all.push(inside);
        rest = behind;
    }
    all.dedup();
    all
}

/// The words of a name in lower case: `left_wheel` is "left wheel". `None` for a name that is no word.
fn words_of_name(name: &str) -> Option<String> {
    let is_word = name.chars().all(|c| c.is_alphabetic() || matches!(c, '_' | '-' | ' '));
    let words = name.to_lowercase().replace(['_', '-'], " ");
    (is_word && words.chars().count() >= SHORTEST).then_some(words)
}

/// The names, as far as they are wanted, of objects that have the same kinds as the objects with this name, and the same types.
fn siblings<'m>(model: &'m Model, name: &str, is_wanted: &dyn Fn(&str) -> bool) -> Vec<&'m str> {
    let kinds: Vec<(Obj, usize)> =
        KINDS.iter().filter_map(|kind| Some((*kind, model.names.id(*kind, name)?))).collect();
    let Some((first, id)) = kinds.first().copied() else { return Vec::new() };
    let others = model.names.of_kind(first).iter().enumerate().filter(|(other, _)| *other != id);
    let is_sibling = |other: &str| {
        kinds.iter().all(|(kind, id)| {
            model
                .names
                .id(*kind, other)
                .is_some_and(|other| type_of(model, *kind, *id) == type_of(model, *kind, other))
        })
    };
    let others = others.map(|(_, other)| other.as_str()).filter(|other| is_wanted(other));
    others.filter(|other| is_sibling(other)).collect()
}

/// What objects that can be taken for each other have in common.
fn type_of(model: &Model, kind: Obj, id: usize) -> Option<i32> {
    match kind {
        Obj::Body => model.body_dofnum.get(id).copied(),
        Obj::Geom => model.geom_type.get(id).copied(),
        Obj::Joint => model.jnt_type.get(id).copied(),
        Obj::Sensor => model.sensor_type.get(id).copied(),
        _ => Some(0),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::measures_another::tests::found;
    use super::*;

    #[test]
    fn names_in_expressions_and_texts_are_read() {
        assert_eq!(literals("force('iron') - x[\"cork\"]"), ["iron", "cork"]);
        assert_eq!(words_of_name("left_wheel").as_deref(), Some("left wheel"));
        assert_eq!(words_of_name("b2"), None);
    }

    #[test]
    fn another_object_is_found() {
        let iron = "max(data.body('iron').xpos[2])";
        assert_eq!(found("How high is the cork ball at most?", iron, 1.0).len(), 1);
        assert_eq!(found("How high is the iron ball at most?", iron, 1.0), [""; 0]);
        assert_eq!(found("How high is the iron ball above the cork ball?", iron, 1.0), [""; 0]);
        for question in [
            "How high is the scale?",
            "How high is the partner of the cork ball?",
            "How high is the ball that the cork ball meets?",
            "To which height does the cork ball push the other ball?",
        ] {
            assert_eq!(found(question, iron, 1.0), [""; 0], "{question}");
        }
    }
}
