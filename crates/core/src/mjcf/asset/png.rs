//! Reads PNG images (ISO/IEC 15948) for height fields: the first colour channel of each pixel, in 8 bits. This file reads chunks,
//! filters and interlacing; `miniz_oxide` decompresses the data.

use miniz_oxide::inflate::TINFLStatus;
use miniz_oxide::inflate::core::inflate_flags::{
    TINFL_FLAG_PARSE_ZLIB_HEADER, TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF,
};
use miniz_oxide::inflate::core::{DecompressorOxide, decompress};

const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The colour type of images whose samples are indexes into a palette.
const INDEXED: u8 = 3;

/// The contents of the first chunk of an image.
#[derive(Clone, Copy)]
pub(super) struct Header {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Bits per sample.
    depth: u8,
    color: u8,
    /// Samples per pixel.
    samples: u8,
    interlaced: bool,
}

/// A pass, a set of pixels that are stored together: the first pixel, and the distance between neighbours, both in x and y.
type Pass = ([u32; 2], [u32; 2]);
const SINGLE_PASS: &[Pass] = &[([0, 0], [1, 1])];
/// The seven passes of Adam7.
const ADAM7_PASSES: &[Pass] = &[
    ([0, 0], [8, 8]),
    ([4, 0], [8, 8]),
    ([0, 4], [4, 8]),
    ([2, 0], [4, 4]),
    ([0, 2], [2, 4]),
    ([1, 0], [2, 2]),
    ([0, 1], [1, 2]),
];

impl Header {
    fn bits(&self) -> usize {
        usize::from(self.depth) * usize::from(self.samples)
    }

    fn passes(&self) -> &'static [Pass] {
        if self.interlaced { ADAM7_PASSES } else { SINGLE_PASS }
    }

    /// The number of pixels per row of a pass, and the number of rows. Zeros if the image is too small for the pass.
    fn size(&self, ([x, y], [dx, dy]): Pass) -> [usize; 2] {
        let [nx, ny] =
            [self.width.saturating_sub(x).div_ceil(dx), self.height.saturating_sub(y).div_ceil(dy)];
        [nx as usize, if nx == 0 { 0 } else { ny as usize }]
    }

    /// The number of bytes for this many pixels of a row.
    fn row(&self, pixels: usize) -> usize {
        (pixels * self.bits()).div_ceil(8)
    }

    /// The first sample of pixel `x` of a row, scaled to 8 bits: the upper byte of 16 bits; fewer bits are scaled to the full
    /// range.
    fn first(&self, row: &[u8], x: usize, palette: &[u8]) -> u8 {
        let bit = x * self.bits();
        let byte = row.get(bit / 8).copied().unwrap_or(0);
        let most = if self.depth < 8 { (1 << self.depth) - 1 } else { 255 };
        let sample =
            if self.depth < 8 { byte >> (8 - usize::from(self.depth) - bit % 8) & most } else { byte };
        match self.color {
            // A palette may be incomplete; missing colours are black.
            INDEXED => palette.get(3 * usize::from(sample)).copied().unwrap_or(0),
            _ => sample * (255 / most),
        }
    }
}

/// A chunk of the file: four letters for its type, and its bytes.
type Chunk<'b> = ([u8; 4], &'b [u8]);

/// Removes the next chunk from the front of the bytes. Critical chunks must have a correct checksum.
fn chunk<'b>(bytes: &mut &'b [u8]) -> Result<Chunk<'b>, &'static str> {
    let cut = "it is truncated";
    let (length, rest) = bytes.split_first_chunk().ok_or(cut)?;
    let (body, rest) =
        rest.split_at_checked((u32::from_be_bytes(*length) as usize).saturating_add(4)).ok_or(cut)?;
    let (sum, rest) = rest.split_first_chunk().ok_or(cut)?;
    let (kind, data) = body.split_first_chunk().ok_or(cut)?;
    if is_critical(kind) && crc(body) != u32::from_be_bytes(*sum) {
        return Err("it is damaged: a checksum is wrong");
    }
    *bytes = rest;
    Ok((*kind, data))
}

/// Whether a chunk is critical: its first letter is upper case.
fn is_critical(kind: &[u8; 4]) -> bool {
    kind[0].is_ascii_uppercase()
}

/// The cyclic redundancy check of chunks.
fn crc(bytes: &[u8]) -> u32 {
    let bit = |c: u32| if c & 1 == 1 { 0xedb8_8320 ^ c >> 1 } else { c >> 1 };
    !bytes.iter().fold(!0, |c, &byte| (0..8).fold(c ^ u32::from(byte), |c, _| bit(c)))
}

/// Reads the header. Afterwards `bytes` starts after the header.
pub(super) fn header(bytes: &mut &[u8]) -> Result<Header, &'static str> {
    *bytes = bytes.strip_prefix(SIGNATURE).ok_or("it has no PNG signature")?;
    let (kind, data) = chunk(bytes)?;
    let (b"IHDR", &[a, b, c, d, e, f, g, h, depth, color, 0, 0, interlaced @ (0 | 1)]) = (&kind, data) else {
        return Err("its header is invalid");
    };
    let (width, height) = (u32::from_be_bytes([a, b, c, d]), u32::from_be_bytes([e, f, g, h]));
    let samples = match (color, depth) {
        (0, 1 | 2 | 4 | 8 | 16) | (INDEXED, 1 | 2 | 4 | 8) => 1,
        (4, 8 | 16) => 2,
        (2, 8 | 16) => 3,
        (6, 8 | 16) => 4,
        _ => return Err("its colour type is unknown"),
    };
    Ok(Header { width, height, depth, color, samples, interlaced: interlaced == 1 })
}

/// The first colour channel of each pixel, row by row from the top. `bytes` starts after the header. The caller has checked that
/// the size in the header is within the limits.
pub(super) fn first_colors(header: &Header, mut bytes: &[u8]) -> Result<Vec<u8>, &'static str> {
    let (mut palette, mut packed): (&[u8], Vec<u8>) = (&[], Vec::new());
    // The compressed data are in consecutive chunks. Later chunks are not needed.
    while packed.is_empty() || bytes.get(4..8) == Some(b"IDAT") {
        match chunk(&mut bytes)? {
            (kind, data) if kind == *b"IDAT" => packed.extend(data),
            (kind, data) if kind == *b"PLTE" => palette = data,
            (kind, _) if is_critical(&kind) => return Err("it has an unknown chunk"),
            _ => {}
        }
    }
    if header.color == INDEXED && palette.is_empty() {
        return Err("it has no palette");
    }
    let size = |&pass: &Pass| {
        let [nx, ny] = header.size(pass);
        ny * (1 + header.row(nx))
    };
    let mut rows = unpack(&packed, header.passes().iter().map(size).sum())?;
    let (width, mut rest) = (header.width as usize, rows.as_mut_slice());
    let mut colors = vec![0; width * header.height as usize];
    for &pass in header.passes() {
        let [nx, ny] = header.size(pass);
        let mut above = vec![0; header.row(nx)];
        let ([x0, y0], [dx, dy]) = pass;
        for i in 0..ny {
            let Some(([filter], after)) = std::mem::take(&mut rest).split_first_chunk_mut() else { break };
            let Some((row, after)) = after.split_at_mut_checked(above.len()) else { break };
            unfilter(*filter, row, &above, header.bits().div_ceil(8))?;
            let line =
                colors.get_mut((y0 as usize + i * dy as usize) * width + x0 as usize..).unwrap_or_default();
            for (x, color) in line.iter_mut().step_by(dx as usize).take(nx).enumerate() {
                *color = header.first(row, x, palette);
            }
            above.copy_from_slice(row);
            rest = after;
        }
    }
    Ok(colors)
}

/// Decompresses `size` bytes.
fn unpack(packed: &[u8], size: usize) -> Result<Vec<u8>, &'static str> {
    let mut all = vec![0; size];
    let flags = TINFL_FLAG_PARSE_ZLIB_HEADER | TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF;
    let (status, _, n) = decompress(&mut Box::<DecompressorOxide>::default(), packed, &mut all, 0, flags);
    match status {
        TINFLStatus::Adler32Mismatch => Err("it is damaged: a checksum is wrong"),
        // All pixels are present. Surplus or missing data after them are ignored.
        _ if n == size => Ok(all),
        TINFLStatus::Done | TINFLStatus::FailedCannotMakeProgress => Err("it is truncated"),
        _ => Err("it is damaged: its compressed data cannot be read"),
    }
}

/// Reverses the filter of a row. Each byte is stored as its difference from a prediction, which depends on the byte `step` before
/// it, the byte above, and the byte above that one.
fn unfilter(filter: u8, row: &mut [u8], above: &[u8], step: usize) -> Result<(), &'static str> {
    for i in 0..row.len() {
        let before = |row: &[u8]| i.checked_sub(step).and_then(|i| row.get(i)).copied().unwrap_or(0);
        let (a, b, c) = (before(row), above.get(i).copied().unwrap_or(0), before(above));
        let predicted = match filter {
            0 => 0,
            1 => a,
            2 => b,
            3 => a.midpoint(b),
            4 => nearest(a, b, c),
            _ => return Err("it has an unknown filter"),
        };
        row[i] = row[i].wrapping_add(predicted);
    }
    Ok(())
}

/// Paeth predictor: the value among the three that is closest to a + b - c.
fn nearest(a: u8, b: u8, c: u8) -> u8 {
    let [x, y, z] = [a, b, c].map(i16::from);
    let [far_a, far_b, far_c] = [y - z, x - z, x + y - 2 * z].map(i16::abs);
    if far_a <= far_b && far_a <= far_c {
        a
    } else if far_b <= far_c {
        b
    } else {
        c
    }
}

#[cfg(test)]
#[path = "png_tests.rs"]
mod tests;
