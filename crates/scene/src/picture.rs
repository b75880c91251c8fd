//! The pixels of a picture.

use crate::View;
use crate::content::{Content, Solid};
use crate::eye::Eye;
use crate::light::Lights;
use crate::surface::{Scene, Visible};
use labspec_core::{Data, Full, Model};
use std::cell::Cell;

/// A picture: rows from top to bottom, three bytes for each pixel: red, green, blue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels.
    pub width: usize,
    /// Pixels.
    pub height: usize,
    /// 3 × width × height bytes, sRGB.
    pub rgb: Vec<u8>,
}

/// The quality of JPEG, in percent: edges keep their colours, and files are a sixth of what PNG needs.
const QUALITY: u8 = 88;

impl Picture {
    /// The picture as a JPEG file. `None` if it has no pixels.
    pub fn to_jpeg(&self) -> Option<Vec<u8>> {
        let mut file = Vec::new();
        let (width, height) = (u16::try_from(self.width).ok()?, u16::try_from(self.height).ok()?);
        let mut encoder = jpeg_encoder::Encoder::new(&mut file, QUALITY);
        encoder.set_sampling_factor(jpeg_encoder::SamplingFactor::F_1_1);
        encoder.set_optimized_huffman_tables(true);
        encoder.encode(&self.rgb, width, height, jpeg_encoder::ColorType::Rgb).ok()?;
        Some(file)
    }
}

/// The side of the squares whose pixels are drawn with one list of solids.
const TILE: usize = 16;
/// Pixels whose colours differ by more are drawn with more rays, in parts of 255.
const EDGE: i32 = 12;
/// The rays of a pixel at an edge, as offsets from its upper left corner: one in each of eight rows and columns.
const SAMPLES: [[f64; 2]; 8] = [
    [0.5625, 0.0625],
    [0.8125, 0.1875],
    [0.0625, 0.3125],
    [0.3125, 0.4375],
    [0.9375, 0.5625],
    [0.6875, 0.6875],
    [0.1875, 0.8125],
    [0.4375, 0.9375],
];

/// The most tests whether a ray meets a shape, for all rays of a picture: a few seconds.
const MAX_TESTS: usize = 200_000_000;

/// Draws a scene. `None` if it has so many shapes that this takes longer than a few seconds (6,000 that cast shadows, in a picture of
/// 800 × 300 pixels), or surfaces of more than a million triangles.
///
/// The data have all fields of their state (`forward`).
pub fn draw(m: &Model, d: &Data<Full>, view: &View) -> Option<Picture> {
    let size = view.size.map(|side| side.min(View::MAX_SIDE));
    let eye = Eye::new(&view.camera, m, size);
    let content = Content::new(m, d, view, &eye)?;
    let lights = Lights::new(m, d, &eye, &content.solids, view.overlays.shadows);
    let near = 1e-4 * m.stat.extent.max(1e-6);
    let tiles = Tiles::new(&content, &eye, size);
    let [width, height] = size;
    if tiles.tests().saturating_add(width * height * lights.shadow_tests()) > MAX_TESTS {
        return None;
    }
    let all = (0..content.solids.len() as u32).collect();
    let scene = Scene { m, content, all, lights, eye, images: &view.images, near, tests: Cell::new(0) };
    let mut rgb = vec![0; 3 * width * height];
    for (y, row) in rgb.chunks_exact_mut((3 * width).max(1)).enumerate() {
        for (x, pixel) in row.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            *pixel = bytes(one_ray(&scene, &tiles, [x, y], [0.5, 0.5]));
        }
        if scene.tests.get() > MAX_TESTS {
            return None;
        }
    }
    let plain = rgb.clone();
    let at = |x: usize, y: usize| plain.as_chunks::<3>().0.get(y * width + x);
    for (y, row) in rgb.chunks_exact_mut((3 * width).max(1)).enumerate() {
        for (x, pixel) in row.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            let around = [(x + 1, y), (x.wrapping_sub(1), y), (x, y + 1), (x, y.wrapping_sub(1))];
            let middle = *pixel;
            let differs =
                |other: &[u8; 3]| (0..3).any(|i| (i32::from(middle[i]) - i32::from(other[i])).abs() > EDGE);
            let neighbours = around.iter().filter(|(x, y)| *x < width && *y < height);
            if neighbours.filter_map(|(x, y)| at(*x, *y)).any(differs) {
                *pixel = bytes(mean(SAMPLES.map(|place| one_ray(&scene, &tiles, [x, y], place))));
            }
        }
        if scene.tests.get() > MAX_TESTS {
            return None;
        }
    }
    Some(Picture { width, height, rgb })
}

fn one_ray(scene: &Scene<'_>, tiles: &Tiles, [x, y]: [usize; 2], [dx, dy]: [f64; 2]) -> Visible {
    let ray = scene.eye.ray(x as f64 + dx, y as f64 + dy);
    let (solids, overlays) = tiles.at(x, y);
    scene.visible(&ray, solids, overlays)
}

fn mean(all: [Visible; SAMPLES.len()]) -> Visible {
    let share = 1.0 / all.len() as f64;
    let sum = |of: fn(&Visible) -> f64| all.iter().map(of).sum::<f64>() * share;
    Visible { rgb: [sum(|s| s.rgb[0]), sum(|s| s.rgb[1]), sum(|s| s.rgb[2])], opacity: sum(|s| s.opacity) }
}

fn bytes(visible: Visible) -> [u8; 3] {
    visible.rgb.map(|c| (255.0 * c.clamp(0.0, 1.0) + 0.5) as u8)
}

/// For each square of pixels the solids that it can show.
struct Tiles {
    columns: usize,
    solids: Vec<Vec<u32>>,
    overlays: Vec<Vec<u32>>,
}

impl Tiles {
    fn new(content: &Content, eye: &Eye, [width, height]: [usize; 2]) -> Tiles {
        let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let lists = |all: &[Solid]| {
            let mut lists = vec![Vec::new(); columns * rows];
            for (i, solid) in (0u32..).zip(all) {
                let (center, radius) = solid.placed.bound();
                let [left, right, top, bottom] = eye.covered(center, radius);
                for row in top / TILE..bottom.div_ceil(TILE).min(rows) {
                    for column in left / TILE..right.div_ceil(TILE).min(columns) {
                        lists[row * columns + column].push(i);
                    }
                }
            }
            lists
        };
        Tiles { columns, solids: lists(&content.solids), overlays: lists(&content.overlays) }
    }

    /// The number of tests for one ray of each pixel.
    fn tests(&self) -> usize {
        self.solids.iter().chain(&self.overlays).map(|list| TILE * TILE * list.len()).sum()
    }

    fn at(&self, x: usize, y: usize) -> (&[u32], &[u32]) {
        let tile = y / TILE * self.columns + x / TILE;
        (list(&self.solids, tile), list(&self.overlays, tile))
    }
}

fn list(lists: &[Vec<u32>], tile: usize) -> &[u32] {
    lists.get(tile).map_or(&[], Vec::as_slice)
}
