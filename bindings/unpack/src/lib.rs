//! A packed module: the bytes of a WebAssembly module in another order, in which gzip makes them a fifth smaller. What stands together in a
//! function (operators, indices of locals, offsets of addresses, constants) is divided into streams of one kind.
//!
//! Numbers are in LEB128, as in a module. In this order: the size of the module; the sizes of what comes before the content of its code
//! section, of that content, and of what comes after it; the number of functions; the number of pairs; for each pair the byte that replaces
//! it, and the two that it replaces; the number of streams; for each its name and its size; what comes before; what comes after; the streams.
//!
//! The first stream has the operators, in which a pair stands for two bytes or pairs. The others have what follows operators:
//! [`copy_function`] says what that is, for the build that packs a module (`bindings/xtask`) and for [`unpack`] in a page. Operators and what
//! follows them are those of the WebAssembly specification, section 5.4.

#![cfg_attr(target_arch = "wasm32", no_std)]

#[cfg(target_arch = "wasm32")]
mod page;

/// The names of the streams. The constants before an operator are a stream whose name is `CONSTANTS` plus the operator, and the locals that
/// are read before an operator are one whose name is `GETS` plus the kind of the operator.
pub mod stream {
    pub const OPERATORS: usize = 0;
    pub const SET: usize = 2;
    pub const TEE: usize = 3;
    pub const LOADS: usize = 4;
    pub const STORES: usize = 5;
    pub const ALIGNMENTS: usize = 6;
    pub const CALLS: usize = 7;
    pub const LABELS: usize = 8;
    pub const BLOCKS: usize = 9;
    pub const LOCALS: usize = 10;
    pub const WIDE: usize = 11;
    pub const FLOATS: usize = 12;
    pub const OTHER: usize = 13;
    pub const GETS: usize = 16;
    pub const CONSTANTS: usize = 32;
    /// Larger than every name.
    pub const NAMES: usize = CONSTANTS + 256;
}

/// The usual alignment of each load and store, from operator 0x28 on, as powers of two.
const USUAL: [u8; 23] = [2, 3, 2, 3, 0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 2, 3, 2, 3, 0, 1, 0, 1, 2];

/// A module is not packed, or has an operator that is not known here.
#[derive(Debug)]
pub struct Damaged;

/// A place in a function, and places in the streams: what is at one is copied to the other.
pub trait Transfer {
    /// Copies the next byte of an operator.
    fn operator(&mut self) -> Result<u8, Damaged>;
    /// The operator after the number that is copied next.
    fn following(&mut self) -> Result<u8, Damaged>;
    /// Copies a number, and returns it.
    fn number(&mut self, stream: usize) -> Result<u32, Damaged>;
    fn bytes(&mut self, stream: usize, count: u32) -> Result<(), Damaged>;
    /// Copies a byte, with the bits of `mask` flipped.
    fn flipped(&mut self, stream: usize, mask: u8) -> Result<(), Damaged>;
}

/// Copies a function: its locals, and its operators up to the end.
pub fn copy_function(transfer: &mut impl Transfer) -> Result<(), Damaged> {
    for _ in 0..transfer.number(stream::LOCALS)? {
        transfer.number(stream::LOCALS)?;
        transfer.bytes(stream::LOCALS, 1)?;
    }
    let mut open = 1;
    while open > 0 {
        let operator = transfer.operator()?;
        match operator {
            // Blocks, loops and conditions, and their ends.
            0x02..=0x04 => {
                open += 1;
                transfer.number(stream::BLOCKS)?;
            }
            0x0b => open -= 1,
            // Jumps, tables of jumps, calls, calls by a table, a choice with types.
            0x0c | 0x0d => transfer.number(stream::LABELS).map(drop)?,
            0x0e => {
                for _ in 0..=transfer.number(stream::OTHER)? {
                    transfer.number(stream::OTHER)?;
                }
            }
            0x10 => transfer.number(stream::CALLS).map(drop)?,
            0x11 => {
                transfer.number(stream::OTHER)?;
                transfer.number(stream::OTHER)?;
            }
            0x1c => {
                let types = transfer.number(stream::OTHER)?;
                transfer.bytes(stream::OTHER, types)?;
            }
            0x20 => {
                let following = kind(transfer.following()?);
                transfer.number(stream::GETS + following)?;
            }
            0x21 => transfer.number(stream::SET).map(drop)?,
            0x22 => transfer.number(stream::TEE).map(drop)?,
            0x28..=0x3e => {
                transfer.flipped(stream::ALIGNMENTS, USUAL[usize::from(operator - 0x28)])?;
                transfer.number(if operator < 0x36 { stream::LOADS } else { stream::STORES })?;
            }
            // Globals, tables, the size of the memory, references.
            0x23..=0x26 | 0x3f | 0x40 | 0xd0 | 0xd2 => transfer.number(stream::OTHER).map(drop)?,
            // Constants.
            0x41 => {
                let following = usize::from(transfer.following()?);
                transfer.number(stream::CONSTANTS + following)?;
            }
            0x42 => transfer.number(stream::WIDE).map(drop)?,
            0x43 => transfer.bytes(stream::FLOATS, 4)?,
            0x44 => transfer.bytes(stream::FLOATS, 8)?,
            // Conversions that saturate, and parts of memory and tables.
            0xfc => match long_operator(transfer)? {
                0..=7 => {}
                8 | 10 | 12 | 14 => {
                    transfer.number(stream::OTHER)?;
                    transfer.number(stream::OTHER)?;
                }
                _ => transfer.number(stream::OTHER).map(drop)?,
            },
            0xfd => copy_vector(transfer)?,
            // Nothing follows.
            0x00 | 0x01 | 0x05 | 0x0f | 0x1a | 0x1b | 0x45..=0xc4 | 0xd1 => {}
            _ => return Err(Damaged),
        }
    }
    Ok(())
}

/// Kinds of operators before which other locals are read.
fn kind(operator: u8) -> usize {
    match operator {
        0x20 => 1,
        0x21 => 2,
        0x22 => 3,
        // Loads, stores, constants, control, calls.
        0x28..=0x35 => 4,
        0x36..=0x3e => 5,
        0x41 | 0x42 => 6,
        0x02..=0x04 | 0x0b..=0x0d => 7,
        0x10 | 0x11 => 8,
        _ => 0,
    }
}

/// The number after the first byte of an operator.
fn long_operator(transfer: &mut impl Transfer) -> Result<u32, Damaged> {
    let (mut value, mut shift) = (0, 0);
    loop {
        let byte = transfer.operator()?;
        value |= u32::from(byte & 127).checked_shl(shift).ok_or(Damaged)?;
        shift += 7;
        if byte < 128 {
            return Ok(value);
        }
    }
}

/// What follows an operator on vectors: an alignment and an offset, 16 bytes, or the number of a lane.
fn copy_vector(transfer: &mut impl Transfer) -> Result<(), Damaged> {
    let operator = long_operator(transfer)?;
    if matches!(operator, 0..=11 | 84..=93) {
        transfer.number(stream::ALIGNMENTS)?;
        transfer.number(stream::LOADS)?;
    }
    match operator {
        12 | 13 => transfer.bytes(stream::OTHER, 16),
        21..=34 | 84..=91 => transfer.bytes(stream::OTHER, 1),
        _ => Ok(()),
    }
}

/// A number at a place, which is then after it.
fn number(bytes: &[u8], place: &mut usize) -> Result<u32, Damaged> {
    let (mut value, mut shift) = (0, 0);
    loop {
        let byte = *bytes.get(*place).ok_or(Damaged)?;
        *place += 1;
        value |= u32::from(byte & 127).checked_shl(shift).ok_or(Damaged)?;
        shift += 7;
        if byte < 128 {
            return Ok(value);
        }
    }
}

/// The number of bytes that a number has in a module.
fn digits(value: usize) -> usize {
    if value < 128 { 1 } else { 1 + digits(value >> 7) }
}

/// The sizes at the beginning of a packed module.
pub struct Head {
    /// The size of the module, bytes.
    pub size: usize,
    before: usize,
    content: usize,
    after: usize,
    functions: u32,
    /// For each byte of the operators the bytes that it stands for, if it is a pair.
    pairs: [Option<[u8; 2]>; 256],
    /// Where each stream begins, and where the operators end.
    places: [usize; stream::NAMES],
    operators: usize,
    /// Where the bytes of the module before its functions begin.
    first: usize,
}

impl Head {
    pub fn read(packed: &[u8]) -> Result<Head, Damaged> {
        let mut at = 0;
        let mut next = || number(packed, &mut at).map(|value| value as usize);
        let (size, before, content, after) = (next()?, next()?, next()?, next()?);
        let functions = next()? as u32;
        let mut pairs = [None; 256];
        for _ in 0..next()? {
            let mut byte = || next().and_then(|value| u8::try_from(value).map_err(|_| Damaged));
            let (pair, two) = (byte()?, [byte()?, byte()?]);
            pairs[usize::from(pair)] = Some(two);
        }
        let mut sizes = [0; stream::NAMES];
        for _ in 0..next()? {
            let (name, size) = (next()?, next()?);
            *sizes.get_mut(name).ok_or(Damaged)? = size;
        }
        let first = at;
        let mut places = [0; stream::NAMES];
        at = first.saturating_add(before).saturating_add(after);
        for (place, size) in places.iter_mut().zip(sizes) {
            *place = at;
            at = at.saturating_add(size);
        }
        let operators = places[stream::OPERATORS] + sizes[stream::OPERATORS];
        Ok(Head { size, before, content, after, functions, pairs, places, operators, first })
    }
}

/// The most bytes that wait while a pair is replaced: each pair is made of bytes that were there before it.
const DEEPEST: usize = 257;

/// Writes a module into `out`, whose length is the size of the module.
pub fn unpack(packed: &[u8], head: &Head, out: &mut [u8]) -> Result<(), Damaged> {
    let middle = head.first.saturating_add(head.before);
    let (begin, end) = (head.before, head.before.saturating_add(head.content));
    out.get_mut(..begin).ok_or(Damaged)?.copy_from_slice(packed.get(head.first..middle).ok_or(Damaged)?);
    let rest = packed.get(middle..middle.saturating_add(head.after)).ok_or(Damaged)?;
    if out.len() != end.saturating_add(head.after) {
        return Err(Damaged);
    }
    out.get_mut(end..).ok_or(Damaged)?.copy_from_slice(rest);
    let out = out.get_mut(..end).ok_or(Damaged)?;
    let operators = packed.get(head.places[stream::OPERATORS]..head.operators).ok_or(Damaged)?;
    let next = expand(operators, &head.pairs, out)?;
    let mut unpacker = Unpacker { packed, places: head.places, out, to: begin, next };
    unpacker.write_number(head.functions as usize)?;
    for _ in 0..head.functions {
        unpacker.function()?;
    }
    if unpacker.to == end { Ok(()) } else { Err(Damaged) }
}

/// Writes the operators at the end of `out`, with pairs replaced by what they stand for. Returns where they begin.
///
/// Every operator is at least one byte of the functions, so that what is written from the beginning does not reach an operator that is
/// still to be read.
fn expand(operators: &[u8], pairs: &[Option<[u8; 2]>; 256], out: &mut [u8]) -> Result<usize, Damaged> {
    let mut place = out.len();
    let mut waiting = [0; DEEPEST];
    // From the last one to the first, so that their number need not be known.
    for &operator in operators.iter().rev() {
        let mut count = 1;
        waiting[0] = operator;
        while count > 0 {
            let byte = waiting[count - 1];
            match pairs[usize::from(byte)] {
                Some([first, second]) => {
                    waiting[count - 1] = first;
                    *waiting.get_mut(count).ok_or(Damaged)? = second;
                    count += 1;
                }
                None => {
                    place = place.checked_sub(1).ok_or(Damaged)?;
                    out[place] = byte;
                    count -= 1;
                }
            }
        }
    }
    Ok(place)
}

struct Unpacker<'a> {
    packed: &'a [u8],
    /// The next byte of each stream.
    places: [usize; stream::NAMES],
    out: &'a mut [u8],
    to: usize,
    /// Where the next operator is in `out`.
    next: usize,
}

impl Unpacker<'_> {
    fn write(&mut self, byte: u8) -> Result<(), Damaged> {
        if self.to >= self.next {
            return Err(Damaged);
        }
        *self.out.get_mut(self.to).ok_or(Damaged)? = byte;
        self.to += 1;
        Ok(())
    }

    fn write_number(&mut self, mut value: usize) -> Result<(), Damaged> {
        while value > 127 {
            self.write((value & 127) as u8 | 128)?;
            value >>= 7;
        }
        self.write(value as u8)
    }

    /// The size of a function, and the function.
    fn function(&mut self) -> Result<(), Damaged> {
        // The size has one byte or more.
        let start = self.to;
        self.to += 1;
        copy_function(self)?;
        let (end, length) = (self.to, self.to - start - 1);
        let digits = digits(length);
        if end - 1 + digits > self.next {
            return Err(Damaged);
        }
        self.out.copy_within(start + 1..end, start + digits);
        self.to = start;
        self.write_number(length)?;
        self.to += length;
        Ok(())
    }

    fn copy(&mut self, stream: usize, mask: u8) -> Result<u8, Damaged> {
        let place = &mut self.places[stream];
        let byte = *self.packed.get(*place).ok_or(Damaged)? ^ mask;
        *place += 1;
        self.write(byte)?;
        Ok(byte)
    }
}

impl Transfer for Unpacker<'_> {
    fn operator(&mut self) -> Result<u8, Damaged> {
        let operator = *self.out.get(self.next).ok_or(Damaged)?;
        self.next += 1;
        self.write(operator)?;
        Ok(operator)
    }

    fn number(&mut self, stream: usize) -> Result<u32, Damaged> {
        let (mut value, mut shift) = (0, 0u32);
        loop {
            let byte = self.copy(stream, 0)?;
            value |= u32::from(byte & 127).wrapping_shl(shift);
            shift += 7;
            if byte < 128 {
                return Ok(value);
            }
        }
    }

    fn following(&mut self) -> Result<u8, Damaged> {
        self.out.get(self.next).copied().ok_or(Damaged)
    }

    fn bytes(&mut self, stream: usize, count: u32) -> Result<(), Damaged> {
        (0..count).try_for_each(|_| self.copy(stream, 0).map(drop))
    }

    fn flipped(&mut self, stream: usize, mask: u8) -> Result<(), Damaged> {
        self.copy(stream, mask).map(drop)
    }
}
