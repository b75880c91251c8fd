//! Which labs and questions carry the mark "verified": those whose claims the ledger of this check states as true.

use labspec::ledger::{Ledger, State, Subject};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};

/// The claims that count: what a lesson states, not that its lab can run.
const CLAIMS: [Subject; 3] = [Subject::Answer, Subject::Quote, Subject::ClosedForm];

/// The number of true claims of each owner in a lesson. An owner with any claim that is not true, or a lab that does not run, is not
/// among them, and neither is one without claims. A lesson of which something was ignored or left out has none.
pub(crate) fn verified_owners(ledger: &Ledger, path: &str) -> BTreeMap<String, usize> {
    let mut count: BTreeMap<String, usize> = BTreeMap::new();
    let mut failed: BTreeSet<&str> = BTreeSet::new();
    for entry in ledger.entries().iter().filter(|e| *e.path == *path) {
        let is_true = matches!(entry.state, State::True(_));
        match entry.subject {
            Subject::File if matches!(entry.state, State::Skipped | State::Unchecked) => {
                return BTreeMap::new();
            }
            Subject::File | Subject::Option => {}
            _ if !is_true => {
                failed.insert(&entry.owner);
            }
            subject if CLAIMS.contains(&subject) => *count.entry(entry.owner.clone()).or_default() += 1,
            _ => {}
        }
    }
    count.retain(|owner, _| !failed.contains(owner.as_str()));
    count
}

/// SHA-256 of several texts in hexadecimal digits. It distinguishes `["ab", "c"]` from `["a", "bc"]`.
pub(crate) fn hex_of(parts: &[&[u8]]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.len() as u64).to_be_bytes());
        hash.update(part);
    }
    format!("{:x}", hash.finalize())
}

/// The first digits of a digest, as a page prints it.
pub(crate) fn short_hash(parts: &[&[u8]]) -> String {
    hex_of(parts).chars().take(12).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::ledger::{Entry, Evidence};

    fn entry(subject: Subject, owner: &str, state: State) -> Entry {
        let (owner, what, remark) = (owner.to_string(), String::new(), String::new());
        Entry { subject, owner, path: "a.md".into(), span: 0..0, state, word: "", what, remark }
    }

    #[test]
    fn a_mark_is_earned_by_true_claims_only() {
        let good = State::True(Evidence::Simulated);
        let earned = |entries: &[(Subject, &str, State)]| {
            let mut ledger = Ledger::default();
            entries.iter().for_each(|(subject, owner, state)| ledger.add(entry(*subject, owner, *state)));
            verified_owners(&ledger, "a.md").into_iter().collect::<Vec<_>>()
        };
        let lab = (Subject::Lab, "lab #1", good);
        assert_eq!(earned(&[lab]), [], "a lab without claims");
        let quote = (Subject::Quote, "lab #1", good);
        assert_eq!(earned(&[lab, quote, quote]), [("lab #1".to_string(), 2)]);
        for state in [State::False, State::Unchecked, State::Skipped, State::Baselined, State::NotClaimed] {
            assert_eq!(earned(&[lab, quote, (Subject::Quote, "lab #1", state)]), [], "{state:?}");
            assert_eq!(earned(&[quote, (Subject::Lab, "lab #1", state)]), [], "{state:?}");
        }
        assert_eq!(earned(&[quote, (Subject::Answer, "quiz q, question 1", State::False)]).len(), 1);
        assert_eq!(earned(&[quote, (Subject::File, "a.md", State::Skipped)]), []);
    }
}
