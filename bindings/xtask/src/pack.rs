//! Packs a module: see the crate `labspec_unpack`, which says what a packed module is, and which restores it in a page.

use labspec_unpack::{Damaged, Head, Transfer, copy_function, stream, unpack};

/// The section of a module that has its functions.
const CODE: u8 = 10;

/// The packed bytes of a module.
pub(crate) fn pack(module: &[u8]) -> Result<Vec<u8>, String> {
    let packed = packed(module).map_err(|Damaged| "the module has operators that cannot be packed")?;
    let mut out = vec![0; module.len()];
    let restored = Head::read(&packed).and_then(|head| unpack(&packed, &head, &mut out));
    match restored.is_ok() && out == module {
        true => Ok(packed),
        false => Err("the module is not restored after packing".into()),
    }
}

fn packed(module: &[u8]) -> Result<Vec<u8>, Damaged> {
    let (begin, end) = code_section(module)?;
    let mut reader = Reader { module, at: begin, streams: vec![Vec::new(); stream::NAMES] };
    let functions = reader.skip_number()?;
    for _ in 0..functions {
        // The size, which is computed again.
        reader.skip_number()?;
        copy_function(&mut reader)?;
    }
    if reader.at != end {
        return Err(Damaged);
    }
    let mut streams = reader.streams;
    let pairs = replace_pairs(&mut streams[stream::OPERATORS]);
    let mut out = Vec::new();
    for size in [module.len(), begin, end - begin, module.len() - end, functions as usize, pairs.len()] {
        write_number(&mut out, size);
    }
    for byte in pairs.into_iter().flatten() {
        write_number(&mut out, byte.into());
    }
    let used: Vec<_> = streams.iter().enumerate().filter(|(_, bytes)| !bytes.is_empty()).collect();
    write_number(&mut out, used.len());
    for (name, bytes) in &used {
        write_number(&mut out, *name);
        write_number(&mut out, bytes.len());
    }
    out.extend_from_slice(&module[..begin]);
    out.extend_from_slice(&module[end..]);
    used.iter().for_each(|(_, bytes)| out.extend_from_slice(bytes));
    Ok(out)
}

/// Where the content of the section with the functions begins, and where it ends.
fn code_section(module: &[u8]) -> Result<(usize, usize), Damaged> {
    // After the magic number and the version.
    let mut reader = Reader { module, at: 8, streams: Vec::new() };
    loop {
        let section = *module.get(reader.at).ok_or(Damaged)?;
        reader.at += 1;
        let size = reader.skip_number()? as usize;
        let end = reader.at + size;
        if section == CODE && end <= module.len() {
            return Ok((reader.at, end));
        }
        reader.at = end;
    }
}

fn write_number(out: &mut Vec<u8>, mut value: usize) {
    while value > 127 {
        out.push((value & 127) as u8 | 128);
        value >>= 7;
    }
    out.push(value as u8);
}

/// Replaces the most frequent pairs of bytes, one after the other, by the bytes that are not used. Returns each such byte with its pair.
fn replace_pairs(bytes: &mut Vec<u8>) -> Vec<[u8; 3]> {
    let free: Vec<u8> = (0..=u8::MAX).filter(|byte| !bytes.contains(byte)).collect();
    let replace = |pair: u8| {
        let mut counts = vec![0u32; 1 << 16];
        bytes.windows(2).for_each(|two| counts[usize::from(two[0]) << 8 | usize::from(two[1])] += 1);
        // The first of the most frequent ones.
        let (most, count) = counts.iter().enumerate().rev().max_by_key(|(_, count)| **count)?;
        if *count < 2 {
            return None;
        }
        let [first, second] = (most as u16).to_be_bytes();
        let mut replaced = Vec::with_capacity(bytes.len());
        let mut place = 0;
        while let Some(&byte) = bytes.get(place) {
            let is_pair = byte == first && bytes.get(place + 1) == Some(&second);
            replaced.push(if is_pair { pair } else { byte });
            place += if is_pair { 2 } else { 1 };
        }
        *bytes = replaced;
        Some([pair, first, second])
    };
    free.into_iter().map_while(replace).collect()
}

/// A place in a module, and the streams that are read from there.
struct Reader<'a> {
    module: &'a [u8],
    at: usize,
    streams: Vec<Vec<u8>>,
}

impl Reader<'_> {
    /// Copies the next byte into a stream, if one is given.
    fn byte(&mut self, stream: Option<usize>, mask: u8) -> Result<u8, Damaged> {
        let byte = *self.module.get(self.at).ok_or(Damaged)?;
        self.at += 1;
        if let Some(stream) = stream {
            self.streams.get_mut(stream).ok_or(Damaged)?.push(byte ^ mask);
        }
        Ok(byte)
    }

    fn any_number(&mut self, stream: Option<usize>) -> Result<u32, Damaged> {
        let (mut value, mut shift) = (0, 0u32);
        loop {
            let byte = self.byte(stream, 0)?;
            // Constants of 64 bits and signs lose bits here that nobody reads.
            value |= u32::from(byte & 127).wrapping_shl(shift);
            shift += 7;
            if byte < 128 {
                return Ok(value);
            }
        }
    }

    fn skip_number(&mut self) -> Result<u32, Damaged> {
        self.any_number(None)
    }
}

impl Transfer for Reader<'_> {
    fn operator(&mut self) -> Result<u8, Damaged> {
        self.byte(Some(stream::OPERATORS), 0)
    }

    fn following(&mut self) -> Result<u8, Damaged> {
        let after = self.module.get(self.at..).ok_or(Damaged)?.iter().position(|byte| *byte < 128);
        self.module.get(self.at + after.ok_or(Damaged)? + 1).copied().ok_or(Damaged)
    }

    fn number(&mut self, stream: usize) -> Result<u32, Damaged> {
        self.any_number(Some(stream))
    }

    fn bytes(&mut self, stream: usize, count: u32) -> Result<(), Damaged> {
        (0..count).try_for_each(|_| self.byte(Some(stream), 0).map(drop))
    }

    fn flipped(&mut self, stream: usize, mask: u8) -> Result<(), Damaged> {
        self.byte(Some(stream), mask).map(drop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A module with functions that have every kind of operator.
    fn module(bodies: &[&[u8]]) -> Vec<u8> {
        let mut content = vec![bodies.len() as u8];
        for body in bodies {
            write_number(&mut content, body.len());
            content.extend_from_slice(body);
        }
        let mut module = b"\0asm\x01\0\0\0".to_vec();
        // A section before the functions, and one after them.
        module.extend_from_slice(&[0, 3, 1, b'a', 7, CODE]);
        write_number(&mut module, content.len());
        module.extend_from_slice(&content);
        module.extend_from_slice(&[0, 2, 1, b'b']);
        module
    }

    #[test]
    fn a_module_is_restored() {
        let locals = [2, 0xff, 1, 0x7f, 1, 0x7c];
        let operators: &[&[u8]] = &[
            &[
                0x20, 0x81, 1, 0x21, 0, 0x22, 1, 0x23, 0, 0x41, 0x80, 0x7f, 0x6a, 0x42, 0xff, 0xff, 0xff,
                0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0,
            ],
            &[
                0x28, 2, 0x80, 8, 0x37, 0, 4, 0x02, 0x40, 0x03, 0x7f, 0x04, 0x40, 0x05, 0x0b, 0x0c, 1, 0x0b,
                0x0b, 0x0d, 0,
            ],
            &[
                0x0e, 2, 0, 1, 0, 0x10, 0x85, 2, 0x11, 3, 0, 0x1c, 1, 0x7f, 0x3f, 0, 0xd2, 1, 0xd1, 0x1b,
                0x43, 1, 2, 3, 4,
            ],
            &[
                0x44, 1, 2, 3, 4, 5, 6, 7, 8, 0xfc, 7, 0xfc, 0x0a, 0, 0, 0xfc, 0x0b, 0, 0xfd, 0x0c, 1, 2, 3,
                4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16,
            ],
            &[0xfd, 0, 4, 8, 0xfd, 0x1b, 3, 0xfd, 0x54, 0, 1, 2, 0xfd, 0xae, 1, 0xfd, 0x5c, 2, 0],
        ];
        let mut bodies: Vec<Vec<u8>> =
            operators.iter().map(|operators| [&locals, *operators, &[0x0b]].concat()).collect();
        // Sizes of one, two and three bytes.
        bodies.extend(
            [200, 20_000].map(|length| [&[0], [0x41, 7, 0x1a].repeat(length).as_slice(), &[0x0b]].concat()),
        );
        let bodies: Vec<&[u8]> = bodies.iter().map(Vec::as_slice).collect();
        let module = module(&bodies);
        assert!(pack(&module).unwrap().len() < module.len());
    }

    #[test]
    fn what_is_no_packed_module_is_refused() {
        let module = module(&[&[0, 0x41, 7, 0x1a, 0x0b]]);
        let packed = pack(&module).unwrap();
        for place in 0..packed.len() {
            let mut damaged = packed.clone();
            damaged.truncate(place);
            let restored =
                Head::read(&damaged).and_then(|head| unpack(&damaged, &head, &mut vec![0; module.len()]));
            assert!(restored.is_err(), "{place}");
            for byte in [0, 1, 127, 128, 255] {
                damaged = packed.clone();
                damaged[place] = byte;
                // An error, or other bytes; it ends, and nothing is read or written outside.
                let _ =
                    Head::read(&damaged).and_then(|head| unpack(&damaged, &head, &mut vec![0; module.len()]));
            }
        }
        assert!(pack(b"\0asm\x01\0\0\0").is_err());
        // An operator that is not in the specification.
        assert!(pack(&self::module(&[&[0, 0xff, 0x0b]])).is_err());
    }
}
