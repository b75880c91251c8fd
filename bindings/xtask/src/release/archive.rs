//! Archives that have the same bytes for the same files: `.tar.gz` without times and owners.

use flate2::{Compression, GzBuilder, read::GzDecoder};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// A file of an archive: its path in it, and its contents.
pub(super) struct Packed {
    /// The path in the archive, without its first folder.
    pub(super) path: PathBuf,
    /// What is at the path.
    pub(super) contents: Contents,
}

/// What an archive has at a path.
pub(super) enum Contents {
    /// A file.
    File(Vec<u8>),
    /// A program.
    Program(Vec<u8>),
    /// A link to another file of the same folder.
    Link(&'static str),
}

impl Packed {
    /// A file.
    pub(super) fn file(path: impl Into<PathBuf>, bytes: Vec<u8>) -> Packed {
        Packed { path: path.into(), contents: Contents::File(bytes) }
    }
}

/// Packs files into a `.tar.gz`, in a folder with a name.
pub(super) fn pack(files: &[Packed], name: &str) -> Result<Vec<u8>, String> {
    let zip = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    let mut tar = tar::Builder::new(zip);
    for Packed { path, contents } in files {
        let path = Path::new(name).join(path);
        let mut header = tar::Header::new_gnu();
        header.set_mtime(0);
        header.set_mode(if matches!(contents, Contents::File(_)) { 0o644 } else { 0o755 });
        let done = match contents {
            Contents::File(bytes) | Contents::Program(bytes) => {
                header.set_size(bytes.len() as u64);
                tar.append_data(&mut header, path, bytes.as_slice())
            }
            Contents::Link(to) => {
                header.set_entry_type(tar::EntryType::Symlink);
                header.set_size(0);
                tar.append_link(&mut header, path, to)
            }
        };
        done.map_err(|e| e.to_string())?;
    }
    let zip = tar.into_inner().map_err(|e| e.to_string())?;
    zip.finish().map_err(|e| e.to_string())
}

/// Unpacks a `.tar.gz` into a folder.
pub(super) fn unpack(archive: &[u8], folder: &Path) -> Result<(), String> {
    tar::Archive::new(GzDecoder::new(archive)).unpack(folder).map_err(|e| super::failed(folder, &e))
}

/// The SHA-256 of bytes, in hexadecimal digits.
pub(super) fn sum(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_files_give_the_same_bytes_and_come_out_again() {
        let files = || {
            [
                Packed { path: "tool".into(), contents: Contents::Program(b"program".to_vec()) },
                Packed { path: "lib/a.so".into(), contents: Contents::Link("a.so.1") },
                Packed::file("lib/a.so.1", b"library".to_vec()),
            ]
        };
        let bytes = pack(&files(), "labspec-1").unwrap();
        assert_eq!(bytes, pack(&files(), "labspec-1").unwrap());
        let folder = tempfile();
        unpack(&bytes, &folder).unwrap();
        let inside = folder.join("labspec-1");
        assert_eq!(std::fs::read(inside.join("tool")).unwrap(), b"program");
        if cfg!(unix) {
            assert_eq!(std::fs::read(inside.join("lib/a.so")).unwrap(), b"library");
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }

    fn tempfile() -> PathBuf {
        std::env::temp_dir().join(format!("labspec-archive-{}", std::process::id()))
    }
}
