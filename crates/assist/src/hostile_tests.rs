//! Any text has an outline, folds, edits, signatures and lenses, and all of them are inside of the text.

use crate::{
    Context, Document, OutlineItem, RunValues, folds, formatting, outline, run_lenses, signature_help,
    unclaimed_lenses,
};
use labspec::bind::scene::Models;
use labspec::lint::ModelFolder;
use labspec::source::Sources;
use proptest::prelude::*;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn check_nesting(items: &[OutlineItem], within: &Range<usize>, text: &str) {
    for item in items {
        assert!(within.start <= item.span.start && item.span.end <= within.end, "{item:?} in {within:?}");
        let inside = item.span.start <= item.selection.start && item.selection.end <= item.span.end;
        assert!(inside && !item.name.is_empty() && !item.name.contains('\n'), "{item:?}");
        assert!(
            text.get(item.span.clone()).is_some() && text.get(item.selection.clone()).is_some(),
            "{item:?}"
        );
        check_nesting(&item.children, &item.span, text);
    }
}

/// Checks everything that is said about a text.
fn check_all(path: &str, text: &str, context: &Context) {
    let mut document = Document::new(PathBuf::from(path), text);
    for (byte, _) in text.char_indices() {
        if let Some(found) = signature_help(&mut document, context, byte) {
            assert!(found.params.iter().all(|p| found.label.get(p.start..p.end).is_some()), "{found:?}");
            assert!(found.active.is_none_or(|i| i < found.params.len()), "{found:?}");
        }
    }
    let lesson = document.read_lesson(context).unwrap();
    check_nesting(&outline(&lesson), &(0..text.len()), text);
    assert!(folds(&lesson).iter().all(|fold| text.get(fold.span.clone()).is_some()));
    for edit in formatting(&lesson, context.models.folder(), None) {
        assert!(text.get(edit.span).is_some());
    }
    let runs = run_lenses(&lesson, &RunValues::default());
    assert!(runs.iter().chain(&unclaimed_lenses(&lesson)).all(|lens| text.get(lens.span.clone()).is_some()));
}

/// Pieces of lessons.
const PIECES: [&str; 24] = [
    "# 𝄞 A\n",
    "Under\n---\n",
    "\n",
    "> ",
    "- It falls 0.45 s, 3 m\n",
    "```lab simlab\n",
    "```quiz\n",
    "```lab integrators\n",
    "```\n",
    "{\"model\": \"servo\", \"title\": \"\",\n",
    "\"setup\": \"data.qpos[0]=1; Math.max(1, lib.bodyPos('ä\", ",
    "\"controls\": [{\"label\": \"a\", \"min\": 0, \"max\": 1, \"value\": 0, \"set\": \"data.ctrl[0]\"}],\n",
    "\"readouts\": [{\"label\": \"\\n\", \"expr\": \"1+\"}],",
    "\"verify\": {\"runs\": {\"a\": {\"sweep\": {}}}, \"measure\": {\"m\": \"max(data.qpos[0\"}, \"says\": [[\"1 m\", \"m\"]]}",
    "\"id\": \"q\", \"questions\": [{\"q\": \"<b>x\", \"options\": [\"a\", \"b\"], \"answer\": 0}, 3]",
    "}",
    "]}",
    "<details>\n",
    "</details>\n",
    "<!-- labspec verify {\"lab\": \"#1\", \"measure\": {\"m\": \"1\"}} -->\n",
    "<!--",
    "-->\n",
    "\r\n",
    "\u{feff}",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn any_lesson_is_described(parts in prop::collection::vec(0..PIECES.len(), 0..14)) {
        let specs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs").canonicalize().unwrap();
        let folder = ModelFolder::open(&specs.join("models")).unwrap();
        let context = Context::new(Arc::new(Models::new(folder)), Sources::Disk);
        let text: String = parts.iter().filter_map(|i| PIECES.get(*i)).copied().collect();
        check_all("a.md", &text, &context);
        check_all("a.json", &text, &context);
    }
}
