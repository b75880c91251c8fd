//! Names of `ctx` variables in the order of their slots: a list that only grows, shared by all that compiled with it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The first names of a shared list. Cloning does not copy the list; when two clones diverge, the second
/// one to grow makes a copy.
#[derive(Clone, Debug, Default)]
pub struct GlobalNames {
    list: Arc<Mutex<Vec<Arc<str>>>>,
    count: usize,
}

impl GlobalNames {
    /// The number of names.
    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// Adds a name.
    pub(crate) fn push(&mut self, name: &str) {
        let first = self.count;
        let changed_list = {
            let mut names = held(&self.list);
            if names.len() == first {
                names.push(name.into());
                None
            } else {
                Some(names.iter().take(first).cloned().chain([name.into()]).collect())
            }
        };
        if let Some(copy) = changed_list {
            self.list = Arc::new(Mutex::new(copy));
        }
        self.count += 1;
    }

    /// The names from a slot on, with their slots.
    pub(crate) fn since(&self, slot: usize) -> Vec<(u32, Arc<str>)> {
        let names = held(&self.list);
        (0..).zip(names.iter().take(self.count).cloned()).skip(slot).collect()
    }
}

fn held(list: &Mutex<Vec<Arc<str>>>) -> MutexGuard<'_, Vec<Arc<str>>> {
    list.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(globals: &GlobalNames, since: usize) -> Vec<(u32, String)> {
        globals.since(since).into_iter().map(|(slot, name)| (slot, name.to_string())).collect()
    }

    #[test]
    fn clones_share_common_names_and_diverge() {
        let mut first = GlobalNames::default();
        first.push("a");
        let early = first.clone();
        let mut other = first.clone();
        first.push("b");
        other.push("c");
        first.push("d");
        let pair = |slot, name: &str| (slot, name.to_string());
        assert_eq!(names(&early, 0), [pair(0, "a")]);
        assert_eq!(names(&first, 1), [pair(1, "b"), pair(2, "d")]);
        assert_eq!(names(&other, 0), [pair(0, "a"), pair(1, "c")]);
        assert_eq!((early.len(), first.len(), other.len()), (1, 3, 2));
        // The list is copied only where clones diverged.
        assert!(Arc::ptr_eq(&early.list, &first.list) && !Arc::ptr_eq(&early.list, &other.list));
    }
}
