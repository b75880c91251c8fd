//! The values that a page displays under labels: readouts and traces, which `shown('label')` reads. The owner
//! of the page computes them.

use labspec_expr::dimension::Dimension;
use labspec_expr::{CollectionId, ObjectId};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// The collection of all labels.
pub(crate) const LABELS: CollectionId = CollectionId(u32::MAX);

/// Labels, and which of them programs have used.
#[derive(Clone, Debug, Default)]
pub struct DisplayedLabels {
    labels: Vec<String>,
    /// The dimension that each label states, if it states one.
    measures: Vec<Option<Dimension>>,
    used: RefCell<BTreeSet<usize>>,
}

impl DisplayedLabels {
    /// Creates the list of labels, each with the dimension of the unit that it states. If two labels are
    /// equal, the first one is used.
    pub fn new(labels: impl IntoIterator<Item = (String, Option<Dimension>)>) -> DisplayedLabels {
        let (labels, measures) = labels.into_iter().unzip();
        DisplayedLabels { labels, measures, used: RefCell::default() }
    }

    pub(crate) fn measure(&self, label: usize) -> Option<Dimension> {
        self.measures.get(label).copied().flatten()
    }

    /// Returns the labels.
    pub fn labels(&self) -> &[String] {
        &self.labels
    }

    /// Returns the indexes of the labels that programs use. Only these need to be computed.
    pub fn used_labels(&self) -> Vec<usize> {
        self.used.borrow().iter().copied().collect()
    }

    pub(crate) fn find(&self, label: &str) -> Option<ObjectId> {
        let index = self.labels.iter().position(|l| l == label)?;
        self.used.borrow_mut().insert(index);
        Some(ObjectId(index as u32))
    }
}
