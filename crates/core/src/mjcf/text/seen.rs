//! Records which attributes of which elements the compiler looks up. A test requires that every attribute with the status
//! supported is read.

use std::cell::RefCell;
use std::collections::BTreeSet;

use crate::mjcf::schema::Element;

thread_local! {
    static SEEN: RefCell<BTreeSet<(usize, String)>> = const { RefCell::new(BTreeSet::new()) };
}

/// The address of an element of the schema. Each position in the schema has its own element.
fn key(element: &'static Element) -> usize {
    std::ptr::from_ref(element).addr()
}

/// Records that an attribute is looked up.
pub(crate) fn note(element: &'static Element, attribute: &str) {
    SEEN.with_borrow_mut(|seen| {
        if !seen.contains(&(key(element), attribute.to_string())) {
            seen.insert((key(element), attribute.to_string()));
        }
    });
}

/// Whether an attribute was looked up on this thread.
pub(crate) fn was_looked_up(element: &'static Element, attribute: &str) -> bool {
    SEEN.with_borrow(|seen| seen.contains(&(key(element), attribute.to_string())))
}
