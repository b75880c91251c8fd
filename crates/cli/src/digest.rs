//! SHA-256 in hexadecimal digits, which identifies the content of cached results.

use sha2::{Digest, Sha256};

/// The digest of bytes.
pub(super) fn hex(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

/// The digest of several texts. It distinguishes `["ab", "c"]` from `["a", "bc"]`.
pub(super) fn hex_of(parts: &[&[u8]]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.len() as u64).to_be_bytes());
        hash.update(part);
    }
    format!("{:x}", hash.finalize())
}
