//! A new name for an element of a model, in the model and in every lab and claim that names it. Where it is not certain what a text
//! means, nothing is changed, and the answer says why.

use super::names::{Ground, Name, Places};
use super::places;
use labspec::source::SourceFile;
use serde_json::{Map, Value, json};

/// All changes that the new name asks for.
///
/// # Errors
/// A sentence for the author: the name cannot be one, is taken, or it is not certain what bears the old one.
pub(super) fn rename(name: &Name, places: &Places, new: &str, ground: &Ground<'_>) -> Result<Value, String> {
    let Name { noun, name: old, .. } = name;
    good(new)?;
    if places.spots.iter().filter(|spot| spot.defines).count() != 1 {
        return Err(format!("the model does not define the {noun} `{old}` in exactly one place"));
    }
    if let Some(doubt) = places.doubts.first() {
        return Err(format!(
            "{}: {}; nothing was changed",
            describe_position(&doubt.file, doubt.span.start),
            doubt.why
        ));
    }
    if let Some(spot) = places.spots.iter().find(|spot| !spot.plain) {
        let at = describe_position(&spot.file, spot.span.start);
        return Err(format!("{at}: the name is written with escapes here, so nothing was changed"));
    }
    let mut changes: Map<String, Value> = Map::new();
    let mut spots: Vec<_> =
        places.spots.iter().map(|spot| (spot.file.path().clone(), spot.span.start, spot)).collect();
    spots.sort_by(|a, b| (&a.0, a.1).cmp(&(&b.0, b.1)));
    spots.dedup_by(|a, b| (&a.0, a.1) == (&b.0, b.1));
    for (path, _, spot) in spots {
        let edit = json!({"range": places::range(&spot.file, &spot.span), "newText": new});
        let edits = changes.entry(ground.uri(&path)).or_insert_with(|| json!([]));
        if let Value::Array(edits) = edits {
            edits.push(edit);
        }
    }
    Ok(json!({"changes": changes}))
}

/// Names that need escapes nowhere: neither in MJCF, nor in JSON, nor in code.
fn good(new: &str) -> Result<(), String> {
    if new.is_empty() || new.trim() != new {
        return Err("a name needs at least one character, and no spaces around it".into());
    }
    match new.chars().find(|c| c.is_control() || "\"'`\\<>&/".contains(*c)) {
        Some(c) => Err(format!("a name cannot contain `{}`, which would need an escape", c.escape_default())),
        None => Ok(()),
    }
}

fn describe_position(file: &SourceFile, byte: usize) -> String {
    format!("{}, line {}", file.path(), file.position(byte).line)
}
