//! Archives in the ZIP format (PKWARE APPNOTE 6.3), with the same bytes for the same files: they are deflated, in the order given, and
//! have one fixed date.

use rawzip::time::{UtcDateTime, ZipDateTime};
use rawzip::{CompressionMethod, DataDescriptorOutput, Error, ZipArchiveWriter};
use std::io::Write;

/// The date of all files, as seconds since 1970: 1 January 2000.
const DATE: i64 = 946_684_800;
/// The level of compression: beyond it, the module of the engine becomes hardly smaller.
const LEVEL: u8 = 6;
/// Files that anybody may read.
const MODE: u32 = 0o644;

/// A file as it is stored.
#[derive(Debug, Clone)]
pub(crate) struct Deflated {
    bytes: Vec<u8>,
    crc: u32,
    /// Bytes of the file.
    size: u64,
}

/// Compresses a file.
pub(crate) fn deflate(bytes: &[u8]) -> Deflated {
    Deflated {
        bytes: miniz_oxide::deflate::compress_to_vec(bytes, LEVEL),
        crc: rawzip::crc32(bytes),
        size: bytes.len() as u64,
    }
}

/// Writes an archive of files by their names, which are relative paths with `/`.
///
/// # Errors
/// A name or a size is one that the format does not have.
pub(crate) fn write_archive<'f>(
    files: impl Iterator<Item = (&'f str, &'f Deflated)>,
) -> Result<Vec<u8>, Error> {
    let date: UtcDateTime = ZipDateTime::from_unix(DATE);
    let mut archive = ZipArchiveWriter::new(Vec::new());
    for (name, file) in files {
        let (mut entry, _) = archive
            .new_file(name)
            .compression_method(CompressionMethod::DEFLATE)
            .last_modified(date)
            .unix_permissions(MODE)
            .start()?;
        entry.write_all(&file.bytes)?;
        entry.finish(DataDescriptorOutput::new(file.crc, file.size))?;
    }
    archive.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_come_back_and_the_bytes_are_the_same() {
        let files = [("a/ü b.txt", b"text ".repeat(1000)), ("empty", Vec::new()), ("z", vec![0, 255, 7])];
        let stored: Vec<(&str, Deflated)> =
            files.iter().map(|(name, bytes)| (*name, deflate(bytes))).collect();
        let write = || write_archive(stored.iter().map(|(name, file)| (*name, file))).unwrap();
        let archive = write();
        assert_eq!(archive, write());
        let read = rawzip::ZipArchive::from_slice(&archive).unwrap();
        let mut entries = read.entries();
        for (name, bytes) in &files {
            let entry = entries.next_entry().unwrap().unwrap();
            assert_eq!(entry.file_path().as_ref(), name.as_bytes());
            assert_eq!(entry.crc32(), rawzip::crc32(bytes));
            let data = read.get_entry(entry.wayfinder()).unwrap();
            assert_eq!(&miniz_oxide::inflate::decompress_to_vec(data.data()).unwrap(), bytes);
        }
        assert!(entries.next_entry().unwrap().is_none());
    }
}
