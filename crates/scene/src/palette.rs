//! The colours of a light page: those of `web/elements/src/view/theme.ts`.

/// Red, green, blue and opacity, from 0 to 1, in sRGB.
pub(crate) type Color = [f64; 4];

/// A colour as `0xrrggbb`.
const fn hex(rgb: u32) -> Color {
    [(rgb >> 16 & 255) as f64 / 255.0, (rgb >> 8 & 255) as f64 / 255.0, (rgb & 255) as f64 / 255.0, 1.0]
}

/// Behind the scene.
pub(crate) const BACKGROUND: Color = hex(0xf4f6f9);
/// Planes without a colour.
pub(crate) const FLOOR: Color = hex(0xe3e7ea);
/// Geoms without a colour.
pub(crate) const GEOM: Color = hex(0x93a5b6);
/// Opacity of the lines on planes.
pub(crate) const GRID: f64 = 0.3;
/// The axes of frames.
pub(crate) const AXES: [Color; 3] = [hex(0xe03131), hex(0x2f9e44), hex(0x1c7ed6)];
pub(crate) const CONTACT: Color = hex(0x0ca678);
pub(crate) const FORCE: Color = hex(0xf76707);
pub(crate) const JOINT: Color = hex(0x7048e8);
pub(crate) const COM: Color = hex(0xfab005);
pub(crate) const CAMERA: Color = hex(0x1971c2);
pub(crate) const TRAIL: Color = hex(0xd6336c);
/// Width of lines, pixels.
pub(crate) const LINE_WIDTH: f64 = 2.0;
/// Opacity of an overlay behind a surface.
pub(crate) const HIDDEN: f64 = 0.3;
/// Light from above and from below, linear.
pub(crate) const SKY: [f64; 3] = [0.42, 0.44, 0.48];
pub(crate) const GROUND: [f64; 3] = [0.2, 0.19, 0.18];
