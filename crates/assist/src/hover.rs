//! Hover texts: the meaning of a name of the language or the model, with its value at the start of the lab, and the
//! meaning of a key of the format.

use super::code;
use super::document::{Context, Document};
use super::item::Hover;
use super::mjcf;
use super::start::{unit, value};
use labspec::bind::Scope;
use labspec::spec::FileKind;
use labspec::spec::format::completions_in;
use labspec_expr::{Globals, Help, Span, chain_at};

/// The hover text for a byte of a document, or `None` if there is none.
pub fn hover(document: &mut Document, context: &mut Context, byte: usize) -> Option<Hover> {
    let byte = document.file.floor(byte);
    if document.kind == FileKind::Model {
        return mjcf::hover(document.file.text(), byte);
    }
    let lesson = document.read_lesson(context)?;
    let file = &document.file;
    let Some((piece, inside)) = code::code_at(&lesson, byte) else {
        return hover_key(document, context, byte);
    };
    let text = &piece.text.value;
    let key = file.slice(piece.lab.span.clone());
    let started = context.started.start(&context.models, piece.lab, key)?;
    let functions = context.models.functions();
    let help = code::explained(&piece, &started.model, functions, &mut Globals::new()).help;
    // The smallest part that has help.
    let holds = |span: &Span| span.start <= inside && inside <= span.end;
    let mut explained: Vec<&(Span, Help)> = help.iter().filter(|(span, _)| holds(span)).collect();
    explained.sort_by_key(|(span, _)| span.end - span.start);
    let chain = chain_at(text, inside);
    if let Some(span) = chain
        && let Some((what, code)) = code::measured_as(&piece, span.text(text))
    {
        let text = format!("```js\n{} = {}\n```\n\n{what}", span.text(text), code.value);
        return Some(Hover { span: piece.text.span_of(span.into()), text });
    }
    let worth = chain.and_then(|span| {
        let code = span.text(text);
        value(started, code).map(|worth| format!("At the start of the lab: `{code}` = **{worth}**"))
    });
    let measures = chain.and_then(|span| {
        let code = span.text(text);
        unit(started, piece.lab, code).map(|unit| format!("By its dimension, `{code}` is in {unit}."))
    });
    let first = explained.first().map(|(_, help)| help);
    if first.is_none() && worth.is_none() {
        return None;
    }
    let title = first.map(|help| format!("```js\n{}\n```", help.title));
    let lines = first.map(|help| help.lines.join("\n\n")).filter(|lines| !lines.is_empty());
    let measured = (piece.scope == Scope::Measure && first.is_none())
        .then(|| "In a measure, over a whole run.".to_string());
    let parts: Vec<String> = [title, lines, measures, measured, worth].into_iter().flatten().collect();
    let span = chain.or(explained.first().map(|(span, _)| *span))?;
    Some(Hover { span: piece.text.span_of(span.into()), text: parts.join("\n\n") })
}

/// The value type and the meaning of a key of the format.
fn hover_key(document: &Document, context: &Context, byte: usize) -> Option<Hover> {
    let file = &document.file;
    // The quoted text that contains the byte.
    let line = file.text().get(..byte)?.rfind('\n').map_or(0, |newline| newline + 1);
    let start = file.text().get(line..byte)?.rfind('"').map(|quote| line + quote)?;
    let end = start + 1 + file.text().get(start + 1..)?.find(['"', '\n'])?;
    let word = file.text().get(start + 1..end)?;
    let offered = completions_in(file, end, &|asked| context.models.names(asked));
    let found = offered.iter().find(|c| c.text == word)?;
    let default = found.default.as_ref().map_or(String::new(), |d| format!("\n\nDefault: `{d}`"));
    let text = format!("**{}**: {}\n\n{}{default}", found.text, found.takes, found.doc);
    Some(Hover { span: file.snap(&(start..end + 1)), text })
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::bind::scene::Models;
    use labspec::lint::ModelFolder;
    use labspec::source::Sources;
    use std::path::{Path, PathBuf};
    use std::sync::Arc;

    /// The hover text at the mark in a lab or a claim about a model of `specs`.
    fn hovered(model: &str, inside: &str) -> String {
        let specs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs").canonicalize().unwrap();
        let folder = ModelFolder::open(&specs.join("models")).unwrap();
        let mut context = Context::new(Arc::new(Models::new(folder)), Sources::Disk);
        let marked = format!("```lab\n{{\"model\": \"{model}\", {inside}}}\n```\n");
        let text = marked.replacen('|', "", 1);
        let mut document = Document::new(PathBuf::from("a.md"), &text);
        hover(&mut document, &mut context, marked.find('|').unwrap()).map_or(String::new(), |h| h.text)
    }

    /// The unit depends on the joint, the actuator or the sensor: the text names the one that applies.
    #[test]
    fn units_are_those_of_the_object() {
        let all = " or ";
        for (model, code, unit) in [
            ("joints", "data.joint('door').q|pos", "one number, rad\n"),
            ("joints", "data.joint('door').qpos[|0]", "angle, rad"),
            ("joints", "data.joint('drawer').q|pos", "one number, m\n"),
            ("joints", "data.joint('drawer').qvel[|0]", "along its axis, m/s"),
            ("joints", "data.joint('door').q|vel", ", rad/s"),
            ("joints", "data.joint('drawer').q|acc", ", m/s^2"),
            ("joints", "data.joint('drawer').qfrc_b|ias", ", N\n"),
            ("joints", "data.joint('door').qfrc_applied[|0]", ", N m"),
            ("joints", "data.joint('boat').qpos[|2]", "z position, m"),
            ("joints", "data.joint('boat').qpos[|4]", "quaternion x"),
            ("joints", "data.joint('boat').qvel[|4]", "its own y, rad/s"),
            ("joints", "data.qpos[|0]", "position, m"),
            ("joints", "data.qpos[|1]", "angle, rad"),
            ("joints", "model.joint('door').stiff|ness", ", N m/rad"),
            ("joints", "model.joint('drawer').ran|ge", ", m\n"),
            ("servo", "data.actuator('lift').ct|rl", ", m\n"),
            ("servo", "data.actuator('lift').for|ce", ", N\n"),
            ("servo", "data.ct|rl", ", m\n"),
            ("pendulum", "data.q|pos", ", rad\n"),
        ] {
            let found =
                hovered(model, &format!("\"readouts\": [{{\"label\": \"a\", \"expr\": \"{code}\"}}]"));
            assert!(found.contains(unit) && !found.contains(all), "{code}: {found}");
        }
        // Where the elements differ, all units are named.
        let whole = hovered("joints", "\"readouts\": [{\"label\": \"a\", \"expr\": \"data.q|pos\"}]");
        assert!(whole.contains("m or rad"), "{whole}");
    }

    #[test]
    fn a_measure_is_explained_by_its_code() {
        let claim = |code: &str| {
            format!(
                "\"verify\": {{\"runs\": {{\"go\": {{\"until\": 1}}}}, \"measure\": {{\"top\": \"max(data.qpos[0])\"}}, \"says\": [[\"1 m\", \"{code}\"]]}}"
            )
        };
        for code in ["t|op", "1 + to|p", "go.t|op"] {
            let found = hovered("servo", &claim(code));
            assert!(found.contains("max(data.qpos[0])") && found.ends_with("a measure"), "{code}: {found}");
        }
    }
}
