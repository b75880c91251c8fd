//! Compares the reader with the crate `png`, for images of every kind, intact and damaged.

use super::*;

/// Width, height and the red channel.
type Read = Option<(u32, u32, Vec<u8>)>;

fn read_with_engine(mut bytes: &[u8]) -> Read {
    let header = header(&mut bytes).ok()?;
    let few = u64::from(header.width) * u64::from(header.height) <= 1 << 16;
    let colors = few.then(|| first_colors(&header, bytes))?.ok()?;
    Some((header.width, header.height, colors))
}

fn read_with_crate(bytes: &[u8]) -> Read {
    let mut decoder = ::png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(::png::Transformations::normalize_to_color8());
    decoder.ignore_checksums(false);
    let mut reader = decoder.read_info().ok()?;
    let (width, height) = (reader.info().width, reader.info().height);
    let few = u64::from(width) * u64::from(height) <= 1 << 16;
    let mut pixels = few.then(|| reader.output_buffer_size().map(|n| vec![0; n]))??;
    let frame = reader.next_frame(&mut pixels).ok()?;
    Some((width, height, pixels.chunks_exact(frame.color_type.samples()).map(|p| p[0]).collect()))
}

/// A chunk with its length and checksum.
fn written(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let body = [kind, data].concat();
    [&(data.len() as u32).to_be_bytes(), &body[..], &crc(&body).to_be_bytes()].concat()
}

/// Pseudorandom numbers.
fn noise(seed: &mut u32) -> u8 {
    *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    (*seed >> 24) as u8
}

/// An image of noise. Each row has a random filter.
fn noise_image([width, height]: [u32; 2], color: u8, depth: u8, interlaced: bool) -> Vec<u8> {
    let samples = [1, 0, 3, 1, 2, 0, 4][usize::from(color)];
    let of = Header { width, height, depth, color, samples, interlaced };
    let mut seed = width * 31 + height * 7 + u32::from(color) * 5 + u32::from(depth);
    let mut rows = Vec::new();
    for &pass in of.passes() {
        let [nx, ny] = of.size(pass);
        for _ in 0..ny {
            rows.push(noise(&mut seed) % 5);
            rows.extend((0..of.row(nx)).map(|_| noise(&mut seed)));
        }
    }
    let head = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[depth, color, 0, 0, u8::from(interlaced)]];
    // The palette may be shorter than the range of samples. Samples beyond it are black.
    let palette: Vec<u8> = (0..3 * (1 << depth.min(7))).map(|_| noise(&mut seed)).collect();
    let packed = miniz_oxide::deflate::compress_to_vec_zlib(&rows, 6);
    let (first, second) = packed.split_at(packed.len() / 2);
    [
        SIGNATURE,
        &written(b"IHDR", &head.concat()),
        &written(b"gAMA", &[0, 0, 0xb1, 0x8f]),
        &if color == INDEXED { written(b"PLTE", &palette) } else { Vec::new() },
        &written(b"tEXt", b"Title\0noise"),
        &written(b"IDAT", first),
        &written(b"IDAT", second),
        &written(b"IEND", &[]),
    ]
    .concat()
}

const KINDS: [(u8, &[u8]); 5] =
    [(0, &[1, 2, 4, 8, 16]), (2, &[8, 16]), (INDEXED, &[1, 2, 4, 8]), (4, &[8, 16]), (6, &[8, 16])];

fn each_kind(sizes: &[[u32; 2]], mut visit: impl FnMut(Vec<u8>)) {
    for (color, depths) in KINDS {
        for (&depth, interlaced) in depths.iter().flat_map(|d| [(d, false), (d, true)]) {
            sizes.iter().for_each(|&size| visit(noise_image(size, color, depth, interlaced)));
        }
    }
}

#[test]
fn every_kind_is_read_as_by_the_package() {
    let sizes = [[1, 1], [2, 3], [5, 1], [1, 9], [7, 8], [13, 11], [33, 40], [100, 70]];
    each_kind(&sizes, |bytes| {
        let read = read_with_engine(&bytes);
        assert!(read.is_some());
        assert_eq!(read, read_with_crate(&bytes));
    });
}

/// The same file with correct checksums, as far as its chunks are complete.
fn with_checksums(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut offset = SIGNATURE.len();
    while let Some(length) = bytes.get(offset..).and_then(|b| b.first_chunk()) {
        let end = offset + 8 + u32::from_be_bytes(*length) as usize;
        let Some(sum) = bytes.get(offset + 4..end).map(crc) else { break };
        let Some(place) = bytes.get_mut(end..end + 4) else { break };
        place.copy_from_slice(&sum.to_be_bytes());
        offset = end + 4;
    }
    bytes
}

/// Damaged files that the crate can read give the same image here. A file that only this reader accepts (without its end) gives
/// an image of the size that its header states.
#[test]
fn damaged_pictures_are_read_as_by_the_package() {
    let compare = |bytes: &[u8], what: &str| match (read_with_engine(bytes), read_with_crate(bytes)) {
        (Some(a), Some(b)) => assert_eq!(a, b, "{what}"),
        (None, Some(_)) => panic!("{what}: is refused, and was read"),
        (Some((width, height, colors)), None) => {
            assert_eq!(colors.len() as u32, width * height, "{what}");
        }
        (None, None) => {}
    };
    each_kind(&[[5, 6]], |bytes| {
        for offset in 0..bytes.len() {
            compare(&bytes[..offset], &format!("{offset} of {}", bytes.len()));
            for change in [1, 0x20, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[offset] ^= change;
                let what = format!("{change} at {offset} of {}", bytes.len());
                compare(&damaged, &what);
                compare(&with_checksums(damaged), &what);
            }
        }
    });
}
