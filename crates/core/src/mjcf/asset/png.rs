//! PNG pictures, as far as heights need them: what is red, in 8 bits (W3C, *Portable Network Graphics*, third edition).

use super::inflate::zlib;

/// What a picture says before its pixels.
pub(super) struct Png<'a> {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Bits of a sample, and samples of a pixel.
    depth: usize,
    channels: usize,
    interlaced: bool,
    /// Red, green and blue of each index, when pixels are indices.
    palette: Option<&'a [u8]>,
    /// The parts of the compressed rows.
    data: Vec<u8>,
}

const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";
/// The first column and row of each pass over an interlaced picture, and its steps to the right and down.
const PASSES: [[usize; 4]; 7] =
    [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];

/// A picture, its pixels still packed.
pub(super) fn open(bytes: &[u8]) -> Result<Png<'_>, &'static str> {
    let mut rest = bytes.strip_prefix(&SIGNATURE).ok_or("it does not begin as one")?;
    let (mut picture, mut palette): (Option<Png>, _) = (None, None);
    loop {
        let (kind, data) = chunk(&mut rest)?;
        match (&kind, &mut picture) {
            (b"IHDR", None) => picture = Some(header(data)?),
            (_, None) => return Err("it does not begin with its size"),
            (b"PLTE", _) => palette = Some(data),
            (b"IDAT", Some(picture)) => picture.data.extend_from_slice(data),
            (b"IEND", _) => break,
            // What a reader may leave out has a small first letter.
            _ if kind[0].is_ascii_uppercase() => return Err("a part of it is of an unknown kind"),
            _ => {}
        }
    }
    let mut picture = picture.ok_or("it has no size")?;
    if picture.palette.is_some() {
        picture.palette = Some(palette.ok_or("it has no palette")?);
    }
    Ok(picture)
}

/// The next part: its kind and what it holds.
fn chunk<'a>(bytes: &mut &'a [u8]) -> Result<([u8; 4], &'a [u8]), &'static str> {
    const SHORT: &str = "it is cut off";
    let (&length, rest) = bytes.split_first_chunk::<4>().ok_or(SHORT)?;
    let length = u32::from_be_bytes(length) as usize;
    let sum_of = rest.get(..length.saturating_add(4)).ok_or(SHORT)?;
    let (&kind, data) = sum_of.split_first_chunk::<4>().ok_or(SHORT)?;
    let (&sum, rest) = rest[sum_of.len()..].split_first_chunk::<4>().ok_or(SHORT)?;
    *bytes = rest;
    if crc(sum_of) == u32::from_be_bytes(sum) { Ok((kind, data)) } else { Err("a part of it is damaged") }
}

/// The remainder by x³² + x²⁶ + … + 1 that tells whether a part is whole.
fn crc(bytes: &[u8]) -> u32 {
    let shift = |c: u32, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 };
    !bytes.iter().fold(u32::MAX, |c, &x| (0..8).fold(c ^ u32::from(x), shift))
}

fn header<'a>(data: &[u8]) -> Result<Png<'a>, &'static str> {
    let &[w0, w1, w2, w3, h0, h1, h2, h3, depth, colour, 0, 0, interlace @ 0..=1] = data else {
        return Err("its first part is damaged");
    };
    let channels = match (colour, depth) {
        (0, 1 | 2 | 4 | 8 | 16) | (3, 1 | 2 | 4 | 8) => 1,
        (2, 8 | 16) => 3,
        (4, 8 | 16) => 2,
        (6, 8 | 16) => 4,
        _ => return Err("its colours are of an unknown kind"),
    };
    let [width, height] = [[w0, w1, w2, w3], [h0, h1, h2, h3]].map(u32::from_be_bytes);
    if width == 0 || height == 0 {
        return Err("it is empty");
    }
    let palette = (colour == 3).then_some(&[] as &[u8]);
    let (depth, interlaced) = (usize::from(depth), interlace == 1);
    Ok(Png { width, height, depth, channels, interlaced, palette, data: Vec::new() })
}

impl Png<'_> {
    /// What is red of each pixel, row by row from above: grey counts as red.
    pub(super) fn red(&self) -> Result<Vec<u8>, &'static str> {
        let (width, height) = (self.width as usize, self.height as usize);
        let passes: &[[usize; 4]] = if self.interlaced { &PASSES } else { &[[0, 0, 1, 1]] };
        // Columns and rows of a pass; without columns there are no rows.
        let size = |&[x, y, right, down]: &[usize; 4]| {
            let columns = width.saturating_sub(x).div_ceil(right);
            [columns, if columns == 0 { 0 } else { height.saturating_sub(y).div_ceil(down) }]
        };
        let bits = self.depth * self.channels;
        let line = |columns: usize| (columns * bits).div_ceil(8);
        // A byte before each row says how it was filtered.
        let length = passes.iter().map(size).map(|[columns, rows]| rows * (1 + line(columns))).sum();
        let mut bytes = zlib(&self.data, length).ok_or("its pixels are damaged")?;
        let mut red = vec![0; width * height];
        let mut rest = bytes.as_mut_slice();
        for pass in passes {
            let [columns, rows] = size(pass);
            let mut above = vec![0; line(columns)];
            for j in 0..rows {
                let (row, after) = rest.split_at_mut(1 + line(columns));
                rest = after;
                let (filter, row) = row.split_at_mut(1);
                unfilter(filter[0], row, &above, bits.div_ceil(8))
                    .ok_or("its rows are of an unknown kind")?;
                let [x, y, right, down] = *pass;
                for i in 0..columns {
                    red[(y + j * down) * width + x + i * right] = self.sample(row, i * bits);
                }
                above.copy_from_slice(row);
            }
        }
        Ok(red)
    }

    /// The sample at a bit of a row, in 8 bits.
    fn sample(&self, row: &[u8], bit: usize) -> u8 {
        let byte = row[bit / 8];
        let value = match self.depth {
            // Of 16 bits the upper half.
            8 | 16 => byte,
            depth => byte >> (8 - depth - bit % 8) & (u8::MAX >> (8 - depth)),
        };
        match self.palette {
            Some(palette) => palette.get(3 * usize::from(value)).copied().unwrap_or(0),
            None if self.depth < 8 => value * (u8::MAX / (u8::MAX >> (8 - self.depth))),
            None => value,
        }
    }
}

/// Takes back what was subtracted from the bytes of a row: a guess from the byte to the left, that above, or both.
/// `step` is how far to the left the same sample is.
fn unfilter(filter: u8, row: &mut [u8], above: &[u8], step: usize) -> Option<()> {
    for i in 0..row.len() {
        let up = above[i];
        let (left, corner) = if i < step { (0, 0) } else { (row[i - step], above[i - step]) };
        let guess = match filter {
            0 => 0,
            1 => left,
            2 => up,
            3 => ((u16::from(left) + u16::from(up)) / 2) as u8,
            4 => nearest(left, up, corner),
            _ => return None,
        };
        row[i] = row[i].wrapping_add(guess);
    }
    Some(())
}

/// Paeth's guess: of left, up and corner that which is nearest to the plane through them.
fn nearest(left: u8, up: u8, corner: u8) -> u8 {
    let [a, b, c] = [left, up, corner].map(i16::from);
    let far = |x: i16| (a + b - c - x).abs();
    if far(a) <= far(b) && far(a) <= far(c) {
        left
    } else if far(b) <= far(c) {
        up
    } else {
        corner
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A picture as another program writes it.
    fn written(
        size: [u32; 2],
        colour: png::ColorType,
        depth: png::BitDepth,
        data: &[u8],
        how: (u8, u8),
    ) -> Vec<u8> {
        let mut out = Vec::new();
        let mut encoder = png::Encoder::new(&mut out, size[0], size[1]);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        if colour == png::ColorType::Indexed {
            encoder.set_palette((0..=255).flat_map(|i: u8| [i.wrapping_mul(7), 1, 2]).collect::<Vec<u8>>());
        }
        encoder.set_filter(
            [
                png::Filter::NoFilter,
                png::Filter::Sub,
                png::Filter::Up,
                png::Filter::Avg,
                png::Filter::Paeth,
                png::Filter::Adaptive,
            ][usize::from(how.0)],
        );
        encoder.set_compression(
            [png::Compression::NoCompression, png::Compression::Fast, png::Compression::High]
                [usize::from(how.1)],
        );
        encoder.write_header().and_then(|mut w| w.write_image_data(data)).unwrap();
        out
    }

    proptest! {
        #[test]
        fn red_is_what_another_reader_sees(
            size in prop::array::uniform2(1u32..40),
            kind in 0usize..15,
            how in (0u8..6, 0u8..3),
            noise in prop::collection::vec(any::<u8>(), 64),
            smooth in any::<bool>(),
        ) {
            use png::{BitDepth::*, ColorType::*};
            let (colour, depth, bits) = [
                (Grayscale, One, 1), (Grayscale, Two, 2), (Grayscale, Four, 4), (Grayscale, Eight, 8), (Grayscale, Sixteen, 16),
                (Indexed, One, 1), (Indexed, Two, 2), (Indexed, Four, 4), (Indexed, Eight, 8),
                (Rgb, Eight, 24), (Rgb, Sixteen, 48), (GrayscaleAlpha, Eight, 16), (GrayscaleAlpha, Sixteen, 32),
                (Rgba, Eight, 32), (Rgba, Sixteen, 64),
            ][kind];
            let n = (size[0] as usize * bits).div_ceil(8) * size[1] as usize;
            let data: Vec<u8> = (0..n).map(|i| if smooth { (i / 3) as u8 } else { noise[i * i % 64] ^ i as u8 }).collect();
            let bytes = written(size, colour, depth, &data, how);
            let mut decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
            decoder.set_transformations(png::Transformations::normalize_to_color8());
            let mut reader = decoder.read_info().unwrap();
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            let step = reader.next_frame(&mut pixels).unwrap().color_type.samples();
            let theirs: Vec<u8> = pixels.chunks_exact(step).map(|p| p[0]).collect();
            let picture = open(&bytes).unwrap();
            prop_assert_eq!([picture.width, picture.height], size);
            prop_assert_eq!(picture.red().unwrap(), theirs);
        }

        #[test]
        fn interlaced_pictures_are_put_together(size in prop::array::uniform2(1usize..20), seed in any::<u8>()) {
            let [width, height] = size;
            let grey = |x: usize, y: usize| (31 * x + 57 * y) as u8 ^ seed;
            let mut rows = Vec::new();
            for [x, y, right, down] in PASSES {
                for row in (y..height).step_by(down).filter(|_| x < width) {
                    rows.push(0);
                    rows.extend((x..width).step_by(right).map(|column| grey(column, row)));
                }
            }
            let mut packed = vec![0x78, 1, 1];
            packed.extend((rows.len() as u16).to_le_bytes());
            packed.extend((!(rows.len() as u16)).to_le_bytes());
            packed.extend(&rows);
            let (a, b) = rows.iter().fold((1, 0), |(a, b), &x| ((a + u32::from(x)) % 65521, (b + a + u32::from(x)) % 65521));
            packed.extend((b << 16 | a).to_be_bytes());
            let mut bytes = SIGNATURE.to_vec();
            let head = [0, 0, 0, width as u8, 0, 0, 0, height as u8, 8, 0, 0, 0, 1];
            for (kind, data) in [(b"IHDR", &head[..]), (b"IDAT", &packed), (b"IEND", &[])] {
                bytes.extend((data.len() as u32).to_be_bytes());
                let from = bytes.len();
                bytes.extend(kind);
                bytes.extend(data);
                bytes.extend(crc(&bytes[from..]).to_be_bytes());
            }
            let red = open(&bytes).unwrap().red().unwrap();
            let expected: Vec<u8> = (0..height).flat_map(|y| (0..width).map(move |x| grey(x, y))).collect();
            prop_assert_eq!(&red, &expected);
            let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
            let mut theirs = vec![0; width * height];
            reader.next_frame(&mut theirs).unwrap();
            prop_assert_eq!(red, theirs);
        }

        /// Whatever the bytes are: an answer, and never another picture.
        #[test]
        fn damage_is_found(at in any::<prop::sample::Index>(), with in 1u8.., cut in any::<prop::sample::Index>()) {
            let data: Vec<u8> = (0..400u32).map(|i| (i * i / 7) as u8).collect();
            let bytes = written([20, 20], png::ColorType::Grayscale, png::BitDepth::Eight, &data, (5, 2));
            let mut bad = bytes.clone();
            bad[at.index(bytes.len())] ^= with;
            prop_assert!(open(&bad).is_err());
            let short = &bytes[..cut.index(bytes.len())];
            prop_assert!(open(short).is_err());
        }

        /// Damage of the packed pixels themselves, which their own sum finds.
        #[test]
        fn damaged_pixels_are_found(at in any::<prop::sample::Index>(), with in 1u8..) {
            let data: Vec<u8> = (0..400u32).map(|i| (i * i / 7) as u8).collect();
            let bytes = written([20, 20], png::ColorType::Grayscale, png::BitDepth::Eight, &data, (5, 2));
            let mut picture = open(&bytes).unwrap();
            let whole = picture.red().unwrap();
            let at = at.index(picture.data.len());
            picture.data[at] ^= with;
            let seen = picture.red();
            prop_assert!(seen.is_err() || seen.as_ref() == Ok(&whole), "{:?}", at);
        }
    }
}
