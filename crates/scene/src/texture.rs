//! Where a texture is seen, and MuJoCo's builtin textures (XML reference, `asset/texture`), computed at that place. Textures from files are
//! in `image`; one without its file is white.

use labspec_core::Texture;
use labspec_core::math::Vec3;

/// `mjtTexture`, `mjtBuiltin` and `mjtMark`.
pub(crate) const FLAT_KIND: i32 = 0;
pub(crate) const SKY_KIND: i32 = 2;
const GRADIENT: i32 = 1;
const CHECKER: i32 = 2;
const FLAT: i32 = 3;
const EDGE: i32 = 1;
const CROSS: i32 = 2;
const RANDOM: i32 = 3;

/// Faces of a cube: right, left, up, down, front, back.
pub(crate) const FACES: usize = 6;
const UP: usize = 2;
const DOWN: usize = 3;
const FRONT: usize = 4;

const WHITE: Vec3 = [1.0; 3];

/// An S-shaped curve from 0 to 1, for gradients.
fn sigmoid(t: f64) -> f64 {
    let u = 2.0 * t - 1.0;
    0.5 + std::f64::consts::FRAC_1_SQRT_2 * u / (1.0 + u * u).sqrt()
}

/// A place of a texture: a face, 0 for a flat texture, and coordinates on it from 0 to 1, v downwards. Those of a flat texture repeat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) face: usize,
    pub(crate) at: [f64; 2],
}

impl Place {
    pub(crate) fn flat(at: [f64; 2]) -> Place {
        Place { face: 0, at }
    }

    /// The place of a cube texture in a direction.
    pub(crate) fn cube([x, y, z]: Vec3) -> Place {
        let [a, b, c] = [x, y, z].map(f64::abs);
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
        Place { face, at: [0.5 * (s / m + 1.0), 0.5 * (r / m + 1.0)] }
    }

    /// A direction of a place of a cube texture, which also may be a little beyond the border of its face.
    pub(crate) fn direction(self) -> Vec3 {
        let [s, r] = self.at.map(|u| 2.0 * u - 1.0);
        match self.face {
            0 => [1.0, -r, -s],
            1 => [-1.0, -r, s],
            UP => [s, 1.0, r],
            DOWN => [s, -1.0, -r],
            FRONT => [s, -r, 1.0],
            _ => [-s, -r, -1.0],
        }
    }
}

/// The colour of a builtin texture, in sRGB.
pub(crate) fn color(t: &Texture, Place { face, at }: Place) -> Vec3 {
    let is_flat = t.kind == FLAT_KIND;
    let [u, v] = if is_flat { at.map(|u| u - u.floor()) } else { at };
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
        assert_eq!(color(&t, Place::flat([0.25, 0.25])), t.rgb1);
        assert_eq!(color(&t, Place::flat([0.75, 0.25])), t.rgb2);
        assert_eq!(color(&t, Place::flat([-0.25, 3.75])), t.rgb1);
    }

    #[test]
    fn the_sky_is_the_first_colour_above_and_the_second_below() {
        let t = Texture { kind: SKY_KIND, builtin: GRADIENT, ..checker() };
        let [above, level, below] =
            [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]].map(|d| color(&t, Place::cube(d)));
        assert_eq!((above, below), (t.rgb1, t.rgb2));
        assert!((level[0] - 0.5).abs() < 1e-12 && (level[2] - 0.5).abs() < 1e-12, "{level:?}");
    }

    #[test]
    fn a_direction_has_its_place_and_beyond_a_border_is_the_next_face() {
        for face in 0..FACES {
            for at in [[0.1, 0.2], [0.9, 0.3], [0.5, 0.99]] {
                let place = Place::cube(Place { face, at }.direction());
                assert_eq!(place.face, face);
                assert!((0..2).all(|i| (place.at[i] - at[i]).abs() < 1e-12), "{face} {at:?} {place:?}");
            }
        }
        // To the right of the front is the right face, at its left border.
        let Place { face, at: [u, v] } = Place::cube(Place { face: FRONT, at: [1.01, 0.4] }.direction());
        assert!(face == 0 && (0.0..0.02).contains(&u) && (v - 0.4).abs() < 0.01, "{face} {u} {v}");
    }

    #[test]
    fn a_texture_without_its_file_changes_no_colour() {
        assert_eq!(color(&Texture::default(), Place::flat([0.1, 0.2])), WHITE);
    }
}
