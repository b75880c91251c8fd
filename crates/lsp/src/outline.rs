//! The outline and the folds of a lesson in the protocol.

use super::convert;
use labspec::source::SourceFile;
use labspec::spec::Lesson;
use labspec_assist::{FoldKind, OutlineItem, OutlineKind, folded_lines, folds, outline};
use lsp_types::{DocumentSymbol, FoldingRange, FoldingRangeKind, SymbolKind};
use std::collections::BTreeSet;

/// The symbols of a lesson.
pub(super) fn symbols(lesson: &Lesson) -> Vec<DocumentSymbol> {
    outline(lesson).into_iter().map(|item| symbol(&lesson.file, item)).collect()
}

fn symbol(file: &SourceFile, item: OutlineItem) -> DocumentSymbol {
    let children: Vec<DocumentSymbol> = item.children.into_iter().map(|child| symbol(file, child)).collect();
    #[allow(deprecated, reason = "the type has no constructor without this field")]
    DocumentSymbol {
        name: item.name,
        detail: (!item.detail.is_empty()).then_some(item.detail),
        kind: symbol_kind(item.kind),
        tags: None,
        deprecated: None,
        range: convert::range(file, &item.span),
        selection_range: convert::range(file, &item.selection),
        children: (!children.is_empty()).then_some(children),
    }
}

fn symbol_kind(kind: OutlineKind) -> SymbolKind {
    match kind {
        // As in the outline of Markdown.
        OutlineKind::Heading => SymbolKind::STRING,
        OutlineKind::Lab => SymbolKind::MODULE,
        OutlineKind::Control => SymbolKind::PROPERTY,
        OutlineKind::Trace => SymbolKind::VARIABLE,
        OutlineKind::Readout => SymbolKind::FIELD,
        OutlineKind::Claim => SymbolKind::OBJECT,
        OutlineKind::Run => SymbolKind::EVENT,
        OutlineKind::Measure => SymbolKind::NUMBER,
        OutlineKind::Quiz => SymbolKind::CLASS,
        OutlineKind::Question => SymbolKind::METHOD,
    }
}

/// The folds of a lesson. Of several that begin in one line, editors show the longest.
pub(super) fn folding_ranges(lesson: &Lesson) -> Vec<FoldingRange> {
    let file = &lesson.file;
    let mut starts = BTreeSet::new();
    let mut all = Vec::new();
    for fold in folds(lesson) {
        let range = convert::range(file, &fold.span);
        let lines = range.start.line as usize..range.end.line as usize;
        let Some(lines) = folded_lines(lines, fold.kind) else { continue };
        if !starts.insert(lines.start) {
            continue;
        }
        let number = |line: usize| u32::try_from(line).unwrap_or(u32::MAX);
        all.push(FoldingRange {
            start_line: number(lines.start),
            end_line: number(lines.end),
            kind: (fold.kind == FoldKind::Comment).then_some(FoldingRangeKind::Comment),
            ..FoldingRange::default()
        });
    }
    all
}
