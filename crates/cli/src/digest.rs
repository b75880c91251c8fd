//! SHA-256 in hexadecimal digits: by content results of earlier checks are known again.

use sha2::{Digest, Sha256};

/// The digest of some bytes.
pub(super) fn hex(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

/// The digest of several texts, which `["ab", "c"]` and `["a", "bc"]` do not share.
pub(super) fn hex_of(parts: &[&[u8]]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.len() as u64).to_be_bytes());
        hash.update(part);
    }
    format!("{:x}", hash.finalize())
}
