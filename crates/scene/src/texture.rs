//! MuJoCo's builtin textures (XML reference, `asset/texture`), computed at the point that is seen. A texture from a file is white.

use labspec_core::Texture;
use labspec_core::math::Vec3;

/// `mjtTexture`, `mjtBuiltin` and `mjtMark`.
const FLAT_KIND: i32 = 0;
pub(crate) const SKY_KIND: i32 = 2;
const GRADIENT: i32 = 1;
const CHECKER: i32 = 2;
const FLAT: i32 = 3;
const EDGE: i32 = 1;
const CROSS: i32 = 2;
const RANDOM: i32 = 3;

/// Faces of a cube: right, left, up, down, front, back.
const UP: usize = 2;
const DOWN: usize = 3;
const FRONT: usize = 4;

const WHITE: Vec3 = [1.0; 3];

/// An S-shaped curve from 0 to 1, for gradients.
fn sigmoid(t: f64) -> f64 {
    let u = 2.0 * t - 1.0;
    0.5 + std::f64::consts::FRAC_1_SQRT_2 * u / (1.0 + u * u).sqrt()
}

/// The colour of a flat texture at coordinates that repeat from 0 to 1, v downwards; in sRGB.
pub(crate) fn flat(t: &Texture, [u, v]: [f64; 2]) -> Vec3 {
    color(t, [u - u.floor(), v - v.floor()], 0)
}

/// The colour of a cube texture in a direction, in sRGB.
pub(crate) fn cube(t: &Texture, direction: Vec3) -> Vec3 {
    let [x, y, z] = direction;
    let [a, b, c] = direction.map(f64::abs);
    // The faces of OpenGL's cube maps: the larger coordinate decides, and the others run to the right and downwards.
    let (face, s, r, m) = if a >= b && a >= c {
        if x > 0.0 { (0, -z, -y, a) } else { (1, z, -y, a) }
    } else if b >= c {
        if y > 0.0 { (UP, x, z, b) } else { (DOWN, x, -z, b) }
    } else if z > 0.0 {
        (FRONT, x, -y, c)
    } else {
        (FRONT + 1, -x, -y, c)
    };
    color(t, [0.5 * (s / m + 1.0), 0.5 * (r / m + 1.0)], face)
}

/// The colour at a place of a face, from 0 to 1.
fn color(t: &Texture, [u, v]: [f64; 2], face: usize) -> Vec3 {
    let is_flat = t.kind == FLAT_KIND;
    let [width, height] = [t.size[0], if is_flat { t.size[1] } else { t.size[0] }];
    if t.builtin == 0 || width <= 0 || height <= 0 {
        return WHITE;
    }
    if is_marked(t, [u, v], [f64::from(width), f64::from(height)]) {
        return t.markrgb;
    }
    let is_first = match t.builtin {
        FLAT => face != DOWN,
        // On the front and the back, the colours are exchanged.
        CHECKER => ((u < 0.5) == (v < 0.5)) == (face < FRONT),
        GRADIENT => return gradient(t, 2.0 * u - 1.0, 2.0 * v - 1.0, face),
        _ => return WHITE,
    };
    if is_first { t.rgb1 } else { t.rgb2 }
}

/// The first colour in the middle of an image or at the top of a cube, the second one at the border or at the bottom.
fn gradient(t: &Texture, x: f64, y: f64, face: usize) -> Vec3 {
    let rise = match face {
        UP => libm::atan2(1.0, libm::hypot(x, y)),
        DOWN => -libm::atan2(1.0, libm::hypot(x, y)),
        _ => libm::atan2(-y, libm::hypot(x, 1.0)),
    };
    let height = if t.kind == FLAT_KIND {
        (1.0 - libm::hypot(x, y)).max(0.0)
    } else {
        0.5 + rise / std::f64::consts::PI
    };
    let share = sigmoid(height);
    [0, 1, 2].map(|i| t.rgb1[i] * share + t.rgb2[i] * (1.0 - share))
}

/// Marks of one pixel's width: the border, a cross in the middle, or random dots.
fn is_marked(t: &Texture, [u, v]: [f64; 2], [width, height]: [f64; 2]) -> bool {
    let [x, y] = [(u * width).floor(), (v * height).floor()];
    match t.mark {
        EDGE => x <= 0.0 || y <= 0.0 || x >= width - 1.0 || y >= height - 1.0,
        CROSS => x == (width / 2.0).floor() || y == (height / 2.0).floor(),
        // The dots of a page are others: a texture gives their density only.
        RANDOM => f64::from(scrambled(x as u32, y as u32)) / f64::from(u32::MAX) < t.random,
        _ => false,
    }
}

/// A number that looks random for each pixel.
fn scrambled(x: u32, y: u32) -> u32 {
    let mixed = x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b).rotate_left(13);
    let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d);
    (mixed ^ mixed >> 12).wrapping_mul(0x297a_2d39) ^ mixed >> 15
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checker() -> Texture {
        let colors = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
        Texture {
            kind: 0,
            builtin: CHECKER,
            rgb1: colors.0,
            rgb2: colors.1,
            size: [2, 2],
            ..Texture::default()
        }
    }

    #[test]
    fn the_fields_of_a_checker_alternate() {
        let t = checker();
        assert_eq!(flat(&t, [0.25, 0.25]), t.rgb1);
        assert_eq!(flat(&t, [0.75, 0.25]), t.rgb2);
        assert_eq!(flat(&t, [-0.25, 3.75]), t.rgb1);
    }

    #[test]
    fn the_sky_is_the_first_colour_above_and_the_second_below() {
        let t = Texture { kind: SKY_KIND, builtin: GRADIENT, ..checker() };
        let [above, level, below] = [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]].map(|d| cube(&t, d));
        assert_eq!((above, below), (t.rgb1, t.rgb2));
        assert!((level[0] - 0.5).abs() < 1e-12 && (level[2] - 0.5).abs() < 1e-12, "{level:?}");
    }

    #[test]
    fn a_texture_from_a_file_changes_no_colour() {
        assert_eq!(flat(&Texture::default(), [0.1, 0.2]), WHITE);
    }
}
