//! Deflated data, as they are in PNG pictures (RFC 1950, RFC 1951).

/// What a stream of zlib holds; `None` when it is damaged, or is not `expected` bytes long.
pub(super) fn zlib(bytes: &[u8], expected: usize) -> Option<Vec<u8>> {
    let (&[method, flags], rest) = bytes.split_first_chunk::<2>()?;
    let head = u32::from(method) << 8 | u32::from(flags);
    // Method 8, windows of at most 32 kB, a check of the two bytes, and no dictionary.
    if method & 15 != 8 || method >> 4 > 7 || head % 31 != 0 || flags & 32 != 0 {
        return None;
    }
    let mut bits = Bits { bytes: rest, held: 0, count: 0 };
    let mut out = Vec::new();
    while !block(&mut bits, &mut out, expected)? {}
    let sum = bits.bytes.first_chunk::<4>()?;
    (out.len() == expected && adler(&out) == u32::from_be_bytes(*sum)).then_some(out)
}

/// The sum with which a stream ends.
fn adler(bytes: &[u8]) -> u32 {
    let (mut a, mut b) = (1, 0);
    for &x in bytes {
        a = (a + u32::from(x)) % 65521;
        b = (b + a) % 65521;
    }
    b << 16 | a
}

/// Bits from the lowest of each byte on.
struct Bits<'a> {
    bytes: &'a [u8],
    /// Bits of the last byte that were not taken, and their number.
    held: u32,
    count: u32,
}

impl Bits<'_> {
    /// The next `n` bits as a number, the first of them the lowest.
    fn take(&mut self, n: u32) -> Option<u32> {
        while self.count < n {
            let (&next, rest) = self.bytes.split_first()?;
            self.held |= u32::from(next) << self.count;
            (self.bytes, self.count) = (rest, self.count + 8);
        }
        let taken = self.held & ((1 << n) - 1);
        (self.held, self.count) = (self.held >> n, self.count - n);
        Some(taken)
    }
}

/// A prefix code, given by the length of each symbol's word: words are numbered by length, then by symbol.
struct Code {
    /// How many words there are of each length.
    counts: [u32; 16],
    /// Symbols in the order of their words.
    symbols: Vec<u16>,
}

impl Code {
    /// `None` when there are more words than fit.
    fn new(lengths: &[u8]) -> Option<Code> {
        let mut code = Code { counts: [0; 16], symbols: Vec::new() };
        let mut room = 1_i64 << 15;
        for length in 1..16_u8 {
            for (symbol, _) in lengths.iter().enumerate().filter(|(_, l)| **l == length) {
                code.symbols.push(symbol as u16);
                code.counts[usize::from(length)] += 1;
                room -= 1 << (15 - length);
            }
        }
        (room >= 0).then_some(code)
    }

    /// The next symbol.
    fn next(&self, bits: &mut Bits) -> Option<usize> {
        // The word so far, the first word of its length, and how many words are shorter.
        let (mut word, mut first, mut before) = (0, 0, 0);
        for count in &self.counts[1..] {
            word = word << 1 | bits.take(1)?;
            if word < first + count {
                return self.symbols.get((before + word - first) as usize).map(|&s| usize::from(s));
            }
            first = (first + count) << 1;
            before += count;
        }
        None
    }
}

/// Appends a block; whether it was the last.
fn block(bits: &mut Bits, out: &mut Vec<u8>, most: usize) -> Option<bool> {
    let last = bits.take(1)? == 1;
    match bits.take(2)? {
        0 => stored(bits, out, most)?,
        1 => {
            let lengths: Vec<u8> = (0..288)
                .map(|s| [8, 9, 7, 8][usize::from(s > 143) + usize::from(s > 255) + usize::from(s > 279)])
                .collect();
            packed(bits, out, most, &Code::new(&lengths)?, &Code::new(&[5; 30])?)?;
        }
        2 => {
            let [words, distances] = codes(bits)?;
            packed(bits, out, most, &words, &distances)?;
        }
        _ => return None,
    }
    Some(last)
}

/// Bytes as they are, from the next whole byte on: their number, its complement, and they.
fn stored(bits: &mut Bits, out: &mut Vec<u8>, most: usize) -> Option<()> {
    (bits.held, bits.count) = (0, 0);
    let (&[a, b, c, d], rest) = bits.bytes.split_first_chunk::<4>()?;
    let n = u16::from_le_bytes([a, b]);
    let (own, rest) = rest.split_at_checked(usize::from(n))?;
    bits.bytes = rest;
    out.extend_from_slice(own);
    (u16::from_le_bytes([c, d]) == !n && out.len() <= most).then_some(())
}

/// The codes of a block that brings its own: of literals and lengths, and of distances.
fn codes(bits: &mut Bits) -> Option<[Code; 2]> {
    const ORDER: [usize; 19] = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];
    let (words, distances) = (257 + bits.take(5)? as usize, 1 + bits.take(5)? as usize);
    let mut own = [0; 19];
    for &symbol in ORDER.iter().take(4 + bits.take(4)? as usize) {
        own[symbol] = bits.take(3)? as u8;
    }
    let own = Code::new(&own)?;
    let mut lengths: Vec<u8> = Vec::new();
    while lengths.len() < words + distances {
        let (value, times) = match own.next(bits)? {
            16 => (*lengths.last()?, 3 + bits.take(2)?),
            17 => (0, 3 + bits.take(3)?),
            18 => (0, 11 + bits.take(7)?),
            length => (length as u8, 1),
        };
        lengths.resize(lengths.len() + times as usize, value);
    }
    let (of_words, of_distances) = lengths.split_at_checked(words)?;
    (of_distances.len() == distances).then_some([Code::new(of_words)?, Code::new(of_distances)?])
}

/// Literals, and copies of what is a distance back.
fn packed(bits: &mut Bits, out: &mut Vec<u8>, most: usize, words: &Code, distances: &Code) -> Option<()> {
    loop {
        let symbol = words.next(bits)?;
        if symbol == 256 {
            return Some(());
        }
        if symbol < 256 {
            out.push(symbol as u8);
        } else {
            // Four lengths share a number of further bits, two distances do.
            let length = match symbol - 257 {
                s @ 0..8 => 3 + s,
                s @ 8..28 => 3 + ((4 + s % 4) << (s / 4 - 1)) + bits.take(s as u32 / 4 - 1)? as usize,
                28 => 258,
                _ => return None,
            };
            let distance = match distances.next(bits)? {
                s @ 0..4 => 1 + s,
                s @ 4..30 => 1 + ((2 + s % 2) << (s / 2 - 1)) + bits.take(s as u32 / 2 - 1)? as usize,
                _ => return None,
            };
            let from = out.len().checked_sub(distance)?;
            for i in from..from + length {
                out.push(*out.get(i)?);
            }
        }
        if out.len() > most {
            return None;
        }
    }
}
