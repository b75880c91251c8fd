//! What a page shows under labels: readouts and traces, which `shown('label')` reads. Whoever has the page computes them.

use labspec_expr::dimension::Dimension;
use labspec_expr::{CollectionId, ObjectId};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// The collection of all labels.
pub(crate) const LABELS: CollectionId = CollectionId(u32::MAX);

/// Labels, and which of them texts have asked for.
#[derive(Clone, Debug, Default)]
pub struct DisplayedLabels {
    labels: Vec<String>,
    /// What the numbers measure, as far as the labels say it.
    measures: Vec<Option<Dimension>>,
    asked: RefCell<BTreeSet<usize>>,
}

impl DisplayedLabels {
    /// With these labels, and what each says of its unit. Of two equal ones the first counts.
    pub fn new(labels: impl IntoIterator<Item = (String, Option<Dimension>)>) -> DisplayedLabels {
        let (labels, measures) = labels.into_iter().unzip();
        DisplayedLabels { labels, measures, asked: RefCell::default() }
    }

    pub(crate) fn measure(&self, label: usize) -> Option<Dimension> {
        self.measures.get(label).copied().flatten()
    }

    /// The labels.
    pub fn labels(&self) -> &[String] {
        &self.labels
    }

    /// The places in the list of what was asked for: only these need be computed.
    pub fn asked(&self) -> Vec<usize> {
        self.asked.borrow().iter().copied().collect()
    }

    pub(crate) fn find(&self, label: &str) -> Option<ObjectId> {
        let at = self.labels.iter().position(|l| l == label)?;
        self.asked.borrow_mut().insert(at);
        Some(ObjectId(at as u32))
    }
}
