//! Textures from PNG files: one picture, or the six faces of a cube, with smaller copies for what is far away. The layouts are those of the XML
//! reference (`asset/texture`), and the limits those of the elements (`web/elements/src/texture`).

use crate::texture::{FACES, FLAT_KIND, Place};
use labspec_core::{Model, Texture};
use png::{ColorType, Decoder, Limits, Transformations};
use std::io::Cursor;
use std::sync::Arc;

/// The largest side of a picture, pixels.
const MAX_SIDE: u32 = 4096;
/// The largest number of pixels of all files of a model. A texture beyond it stays white.
const MAX_PIXELS: usize = 1 << 24;
/// The largest number of faces in one file.
const MAX_CELLS: usize = 12;
/// Letters of the faces in a layout, in their order.
const LETTERS: &str = "RLUDFB";

/// The pictures of a model's textures, by the number of the texture. Builtin textures have none.
#[derive(Clone, Debug, Default)]
pub struct Images(Arc<[Option<Image>]>);

impl Images {
    /// Decodes the pictures that the textures of a model name. `file` gives the bytes of a file by its path in the folder of the model. A
    /// texture with a file that is missing, too large or no PNG has no picture: it is white.
    pub fn read(m: &Model, file: impl Fn(&str) -> Option<Vec<u8>>) -> Images {
        let mut left = MAX_PIXELS;
        Images(m.textures.iter().map(|t| Image::read(t, &file, &mut left)).collect())
    }

    pub(crate) fn get(&self, texture: usize) -> Option<&Image> {
        self.0.get(texture)?.as_ref()
    }
}

/// The picture of a texture: one face, or the six of a cube.
#[derive(Clone, Debug)]
pub(crate) struct Image {
    faces: Vec<Arc<Levels>>,
    /// Whether coordinates repeat; those of a face of a cube end at its border.
    repeats: bool,
    has_alpha: bool,
}

impl Image {
    fn read(t: &Texture, file: impl Fn(&str) -> Option<Vec<u8>>, left: &mut usize) -> Option<Image> {
        if t.builtin != 0 || t.files.is_empty() {
            return None;
        }
        let picture = |path: &String| match path.as_str() {
            // A face without a file.
            "" => Some(None),
            path => Some(Some(Pixels::decode(&file(path)?, left)?.flipped(t.flip))),
        };
        let pictures: Vec<Option<Pixels>> = t.files.iter().map(picture).collect::<Option<_>>()?;
        let faces = match (t.kind, <[Option<Pixels>; 1]>::try_from(pictures)) {
            (FLAT_KIND, Ok([only])) => vec![Arc::new(Levels::new(only?))],
            (FLAT_KIND, Err(_)) => return None,
            (_, Ok([only])) => cut_faces(&only?, t)?,
            (_, Err(pictures)) => {
                let side = pictures.iter().flatten().next()?.width;
                let plain = Arc::new(Levels::new(Pixels::plain(t, side)));
                let face = |picture: Option<Pixels>| picture.map_or(Some(plain.clone()), |p| square(p, side));
                pictures.into_iter().map(face).collect::<Option<_>>()?
            }
        };
        let repeats = t.kind == FLAT_KIND;
        (repeats || faces.len() == FACES).then_some(Image { faces, repeats, has_alpha: t.nchannel == 4 })
    }

    /// The number of pixels between two places, at least 1; 1 if they are on different faces.
    pub(crate) fn distance(&self, a: Place, b: Place) -> f64 {
        let Some(pixels) = self.level(a.face, 0) else { return 1.0 };
        if a.face != b.face {
            return 1.0;
        }
        let [x, y] = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
        libm::hypot(x * pixels.width as f64, y * pixels.height as f64).max(1.0)
    }

    /// The colour and the opacity at a place, as the mean of about this many pixels in a row; in sRGB.
    pub(crate) fn color(&self, place: Place, pixels: f64) -> [f64; 4] {
        let last = self.faces.first().map_or(0, |levels| levels.0.len().saturating_sub(1));
        let level = libm::log2(pixels.max(1.0)).min(last as f64);
        let at = |level: f64| self.between_pixels(place, level as usize);
        let mut color = mixed(at(level.floor()), at(level.ceil()), level - level.floor());
        if !(self.has_alpha && self.repeats) {
            color[3] = 1.0;
        }
        color
    }

    /// The colour between the four nearest pixels of a level.
    fn between_pixels(&self, Place { face, at }: Place, level: usize) -> [f64; 4] {
        let Some(pixels) = self.level(face, level) else { return [1.0; 4] };
        let [u, v] = if self.repeats { at.map(|u| u - u.floor()) } else { at };
        let [x, y] = [u * pixels.width as f64 - 0.5, v * pixels.height as f64 - 0.5];
        let get = |i: f64, j: f64| self.pixel(pixels, face, level, [x.floor() + i, y.floor() + j]);
        let [right, below] = [x - x.floor(), y - y.floor()];
        mixed(mixed(get(0.0, 0.0), get(1.0, 0.0), right), mixed(get(0.0, 1.0), get(1.0, 1.0), right), below)
    }

    /// The colour of a pixel, which may be one beyond the border: it then is on the other side, or on the next face of the cube.
    fn pixel(&self, pixels: &Pixels, face: usize, level: usize, [x, y]: [f64; 2]) -> [f64; 4] {
        let [width, height] = [pixels.width as f64, pixels.height as f64];
        let is_inside = (0.0..width).contains(&x) && (0.0..height).contains(&y);
        let nearest = |pixels: &Pixels, x: f64, y: f64| pixels.get(x as usize, y as usize);
        let color = if is_inside {
            nearest(pixels, x, y)
        } else if self.repeats {
            nearest(pixels, x.rem_euclid(width), y.rem_euclid(height))
        } else {
            let beyond = Place { face, at: [(x + 0.5) / width, (y + 0.5) / height] };
            let Place { face, at: [u, v] } = Place::cube(beyond.direction());
            self.level(face, level).map_or([u8::MAX; 4], |other| {
                let inside = |u: f64, count: usize| (u * count as f64).min(count as f64 - 1.0);
                nearest(other, inside(u, other.width), inside(v, other.height))
            })
        };
        color.map(|c| f64::from(c) / 255.0)
    }

    fn level(&self, face: usize, level: usize) -> Option<&Pixels> {
        self.faces.get(face)?.0.get(level)
    }
}

/// A picture, and copies of it: each has half the width and the height of the one before it, down to one pixel.
#[derive(Debug)]
struct Levels(Vec<Pixels>);

impl Levels {
    fn new(picture: Pixels) -> Levels {
        let mut levels = vec![picture];
        while let Some(half) = levels.last().and_then(Pixels::halved) {
            levels.push(half);
        }
        Levels(levels)
    }
}

/// A picture: rows from top to bottom, each pixel red, green, blue and opacity.
#[derive(Clone, Debug, Default)]
struct Pixels {
    width: usize,
    height: usize,
    rgba: Vec<[u8; 4]>,
}

impl Pixels {
    /// The picture of a PNG file, if no more than `left` pixels are in it, which then are fewer.
    fn decode(file: &[u8], left: &mut usize) -> Option<Pixels> {
        let bytes = 8 * MAX_PIXELS;
        let mut decoder = Decoder::new_with_limits(Cursor::new(file), Limits { bytes });
        decoder.set_transformations(Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().ok()?;
        let (width, height) = (reader.info().width, reader.info().height);
        if width.max(height) > MAX_SIDE {
            return None;
        }
        *left = left.checked_sub(width as usize * height as usize)?;
        let mut data = vec![0; reader.output_buffer_size()?];
        let info = reader.next_frame(&mut data).ok()?;
        let opaque = |[r, g, b]: [u8; 3]| [r, g, b, u8::MAX];
        let rgba = match info.color_type {
            ColorType::Grayscale => data.iter().map(|y| opaque([*y; 3])).collect(),
            ColorType::GrayscaleAlpha => data.as_chunks().0.iter().map(|[y, a]| [*y, *y, *y, *a]).collect(),
            ColorType::Rgb => data.as_chunks().0.iter().map(|rgb| opaque(*rgb)).collect(),
            ColorType::Rgba => data.as_chunks().0.to_vec(),
            ColorType::Indexed => return None,
        };
        Some(Pixels { width: width as usize, height: height as usize, rgba })
    }

    /// A square of the first colour of a texture.
    fn plain(t: &Texture, side: usize) -> Pixels {
        let [r, g, b] = t.rgb1.map(|c| (255.0 * c.clamp(0.0, 1.0)) as u8);
        Pixels { width: side, height: side, rgba: vec![[r, g, b, u8::MAX]; side * side] }
    }

    fn get(&self, x: usize, y: usize) -> [u8; 4] {
        self.rgba.get(y * self.width + x).copied().unwrap_or_default()
    }

    /// A picture of this size whose pixel at a column and a row is the one that `from` names.
    fn selected(&self, [width, height]: [usize; 2], from: impl Fn(usize, usize) -> [usize; 2]) -> Pixels {
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let rgba = places.map(|(x, y)| from(x, y)).map(|[x, y]| self.get(x, y)).collect();
        Pixels { width, height, rgba }
    }

    /// Mirrored left to right, and top to bottom.
    fn flipped(self, flip: [bool; 2]) -> Pixels {
        let [width, height] = [self.width, self.height];
        let turned = |flip: bool, i: usize, count: usize| if flip { count - 1 - i } else { i };
        match flip {
            [false, false] => self,
            _ => {
                self.selected([width, height], |x, y| [turned(flip[0], x, width), turned(flip[1], y, height)])
            }
        }
    }

    /// Half the width and the height: the mean of the pixels. `None`: it is one pixel.
    fn halved(&self) -> Option<Pixels> {
        if self.width.max(self.height) <= 1 {
            return None;
        }
        let [width, height] = [self.width, self.height].map(|side| (side / 2).max(1));
        let pixel = |x: usize, y: usize| {
            let [right, below] = [(2 * x + 1).min(self.width - 1), (2 * y + 1).min(self.height - 1)];
            let four = [(2 * x, 2 * y), (right, 2 * y), (2 * x, below), (right, below)];
            let four = four.map(|(x, y)| self.get(x.min(self.width - 1), y.min(self.height - 1)));
            [0, 1, 2, 3].map(|i| (four.iter().map(|p| u16::from(p[i])).sum::<u16>() / 4) as u8)
        };
        let rgba = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y));
        Some(Pixels { width, height, rgba: rgba.collect() })
    }
}

fn mixed(a: [f64; 4], b: [f64; 4], share: f64) -> [f64; 4] {
    [0, 1, 2, 3].map(|i| a[i] + share * (b[i] - a[i]))
}

/// A face of a cube, if it is a square of this side.
fn square(picture: Pixels, side: usize) -> Option<Arc<Levels>> {
    (picture.width == side && picture.height == side).then(|| Arc::new(Levels::new(picture)))
}

/// The faces in one picture: a grid, or one picture for all faces.
fn cut_faces(picture: &Pixels, t: &Texture) -> Option<Vec<Arc<Levels>>> {
    let [rows, columns] = t.gridsize.map(|n| usize::try_from(n).unwrap_or(0));
    if [rows, columns] == [1, 1] {
        return Some(vec![square(picture.clone(), picture.width)?; FACES]);
    }
    if rows == 0 || columns == 0 || rows.saturating_mul(columns) > MAX_CELLS {
        return None;
    }
    let side = picture.width / columns;
    if side == 0 || picture.height / rows != side {
        return None;
    }
    // Faces without a cell share one picture, which the limit of pixels does not count.
    let plain = Arc::new(Levels::new(Pixels::plain(t, side)));
    let cells: Vec<Option<usize>> = t.gridlayout.chars().map(|letter| LETTERS.find(letter)).collect();
    let face = |face: usize| {
        let cell = cells.iter().take(rows * columns).rposition(|cell| *cell == Some(face));
        let Some(cell) = cell else { return plain.clone() };
        let [left, top] = [cell % columns * side, cell / columns * side];
        Arc::new(Levels::new(picture.selected([side, side], |x, y| [left + x, top + y])))
    };
    Some((0..FACES).map(face).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: [u8; 4] = [255, 0, 0, 255];
    const BLUE: [u8; 4] = [0, 0, 255, 255];

    fn png_of(width: u32, pixels: &[[u8; 4]]) -> Vec<u8> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width, pixels.len() as u32 / width);
        encoder.set_color(ColorType::Rgba);
        encoder.write_header().unwrap().write_image_data(pixels.as_flattened()).unwrap();
        file
    }

    fn read(t: Texture, files: &[&[u8]]) -> Option<Image> {
        let t = Texture { files: (0..files.len()).map(|i| i.to_string()).collect(), ..t };
        let file = |path: &str| files.get(path.parse::<usize>().ok()?).map(|file| file.to_vec());
        Image::read(&t, file, &mut MAX_PIXELS.clone())
    }

    fn flat() -> Texture {
        Texture { kind: FLAT_KIND, ..Texture::default() }
    }

    fn color(image: &Image, face: usize, at: [f64; 2], pixels: f64) -> [u8; 4] {
        image.color(Place { face, at }, pixels).map(|c| (255.0 * c).round() as u8)
    }

    #[test]
    fn a_picture_has_its_colours_at_the_middles_of_its_pixels_and_repeats() {
        let image = read(flat(), &[&png_of(2, &[RED, BLUE])]).unwrap();
        assert_eq!((color(&image, 0, [0.25, 0.5], 1.0), color(&image, 0, [0.75, 0.5], 1.0)), (RED, BLUE));
        // Between them, and at both ends, half of each.
        for u in [0.0, 0.5, 1.0] {
            assert_eq!(color(&image, 0, [u, 0.5], 1.0), [128, 0, 128, 255]);
        }
        let image = read(Texture { flip: [true, false], ..flat() }, &[&png_of(2, &[RED, BLUE])]).unwrap();
        assert_eq!(color(&image, 0, [0.25, 0.5], 1.0), BLUE);
    }

    #[test]
    fn what_is_far_away_has_the_mean_of_its_pixels() {
        let image = read(flat(), &[&png_of(4, &[RED, BLUE, RED, BLUE])]).unwrap();
        assert_eq!(color(&image, 0, [0.125, 0.5], 1.0), RED);
        assert_eq!(color(&image, 0, [0.125, 0.5], 4.0), [127, 0, 127, 255]);
        let [a, b] = [[0.0, 0.5], [0.5, 0.5]].map(|at| Place { face: 0, at });
        assert_eq!(image.distance(a, b), 2.0);
    }

    #[test]
    fn a_grid_has_a_face_in_each_cell_and_the_first_colour_elsewhere() {
        let t = Texture {
            gridsize: [1, 2],
            gridlayout: "UD".into(),
            rgb1: [0.0, 1.0, 0.0],
            ..Texture::default()
        };
        let image = read(t, &[&png_of(2, &[RED, BLUE])]).unwrap();
        let faces = [0, 2, 3].map(|face| color(&image, face, [0.5, 0.5], 1.0));
        assert_eq!(faces, [[0, 255, 0, 255], RED, BLUE]);
    }

    #[test]
    fn six_files_are_the_faces() {
        let [red, blue] = [RED, BLUE].map(|pixel| png_of(1, &[pixel]));
        let image = read(Texture::default(), &[&red, &blue, &red, &blue, &red, &blue]).unwrap();
        assert_eq!([4, 5].map(|face| color(&image, face, [0.5, 0.5], 1.0)), [RED, BLUE]);
    }

    #[test]
    fn at_the_border_of_a_face_its_colour_meets_that_of_the_next_one() {
        let [red, blue] = [RED, BLUE].map(|pixel| png_of(1, &[pixel]));
        // The right face is red, the front blue.
        let image = read(Texture::default(), &[&red, &red, &red, &red, &blue, &red]).unwrap();
        for place in [Place { face: 4, at: [1.0, 0.5] }, Place { face: 0, at: [0.0, 0.5] }] {
            assert_eq!(color(&image, place.face, place.at, 1.0), [128, 0, 128, 255]);
        }
    }

    #[test]
    fn alpha_counts_where_the_texture_has_four_channels() {
        let clear = png_of(1, &[[255, 0, 0, 0]]);
        assert_eq!(color(&read(flat(), &[&clear]).unwrap(), 0, [0.5; 2], 1.0), RED);
        let image = read(Texture { nchannel: 4, ..flat() }, &[&clear]).unwrap();
        assert_eq!(color(&image, 0, [0.5; 2], 1.0)[3], 0);
    }

    #[test]
    fn hostile_files_are_no_pictures() {
        let good = png_of(2, &[RED, BLUE]);
        let huge = {
            let mut file = good.clone();
            file[16..24].copy_from_slice(&[0, 0, 16, 1, 0, 0, 16, 1]);
            file
        };
        for file in [&[][..], b"GIF89a", &good[..40], &huge] {
            assert!(read(flat(), &[file]).is_none());
        }
        for (gridsize, files) in [([0, 1], 1), ([-1, 3], 1), ([5, 5], 1), ([1, 1], 2), ([1, 1], 7)] {
            let t = Texture { gridsize, gridlayout: "RLUDFB".into(), ..Texture::default() };
            assert!(read(t, &vec![&good[..]; files]).is_none(), "{gridsize:?} {files}");
        }
        let mut left = 3;
        assert!(Pixels::decode(&good, &mut left).is_some() && left == 1);
        assert!(Pixels::decode(&good, &mut left).is_none());
    }
}
