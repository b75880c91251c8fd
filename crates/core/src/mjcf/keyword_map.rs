//! A map from keywords of the schema. The keywords are few, so that a list is sufficient.

/// Maps some keywords to values.
#[derive(Clone, Debug)]
pub(super) struct KeywordMap<V>(Vec<(&'static str, V)>);

impl<V> Default for KeywordMap<V> {
    fn default() -> KeywordMap<V> {
        KeywordMap(Vec::new())
    }
}

impl<V> KeywordMap<V> {
    /// The value of a keyword.
    pub(super) fn get(&self, word: &str) -> Option<&V> {
        self.0.iter().find(|(w, _)| *w == word).map(|(_, value)| value)
    }

    /// Sets the value of a keyword, and replaces an existing one.
    pub(super) fn insert(&mut self, word: &'static str, value: V) {
        match self.0.iter_mut().find(|(w, _)| *w == word) {
            Some((_, old)) => *old = value,
            None => self.0.push((word, value)),
        }
    }

    /// The value of a keyword. If there is none, the default is inserted.
    pub(super) fn or_default(&mut self, word: &'static str) -> &mut V
    where
        V: Default,
    {
        let place = self.0.iter().position(|(w, _)| *w == word).unwrap_or(self.0.len());
        if place == self.0.len() {
            self.0.push((word, V::default()));
        }
        &mut self.0[place].1
    }

    /// Removes keywords and their values.
    pub(super) fn remove(&mut self, words: &[&str]) {
        self.0.retain(|(w, _)| !words.contains(w));
    }
}

#[cfg(test)]
mod tests {
    use super::KeywordMap;

    #[test]
    fn every_word_has_one_value() {
        let mut words = KeywordMap::default();
        words.insert("pos", 1);
        *words.or_default("quat") += 2;
        *words.or_default("pos") += 3;
        words.insert("quat", 7);
        assert_eq!((words.get("pos"), words.get("quat"), words.get("axis")), (Some(&4), Some(&7), None));
        words.remove(&["pos", "axis"]);
        assert_eq!((words.get("pos"), words.get("quat")), (None, Some(&7)));
    }
}
