//! Pixel images, rendered by `resvg` from our own SVG with an embedded font, so that the pixels are the same on every machine.

use resvg::{tiny_skia, usvg};

/// The font has Latin, Greek and Cyrillic letters, arrows and mathematical symbols.
const FONT: &[u8] = include_bytes!("../fonts/DejaVuSans.ttf");
/// The maximum width and height in pixels.
const MOST: f32 = 8192.0;
/// The metadata that identify the program that made a picture.
const MAKER: (&str, &str) = ("Software", "labspec");

/// Renders a picture as PNG, scaled by a factor.
///
/// # Errors
/// The text is not a picture, or the image would be too large.
pub fn png(svg: &str, scale: f32) -> Result<Vec<u8>, String> {
    let mut options = usvg::Options { font_family: "DejaVu Sans".into(), ..usvg::Options::default() };
    options.fontdb_mut().load_font_data(FONT.to_vec());
    let tree = usvg::Tree::from_str(svg, &options).map_err(|e| e.to_string())?;
    let [wide, high] = [tree.size().width(), tree.size().height()].map(|x| (scale * x).ceil());
    let fits = |x: f32| (1.0..=MOST).contains(&x);
    let pixels =
        (fits(wide) && fits(high)).then(|| tiny_skia::Pixmap::new(wide as u32, high as u32)).flatten();
    let Some(mut pixels) = pixels else {
        return Err(format!("{wide} by {high} pixels are too many or too few; the limit is {MOST} each"));
    };
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixels.as_mut());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixels.width(), pixels.height());
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let written = encoder
        .add_text_chunk(MAKER.0.into(), MAKER.1.into())
        .and_then(|()| encoder.write_header())
        .and_then(|mut out| out.write_image_data(&pixels.take_demultiplied()));
    written.map(|()| bytes).map_err(|e| e.to_string())
}

/// Whether a file with this beginning is one of these images.
pub fn is_own_png(start: &[u8]) -> bool {
    let comment = format!("{}\0{}", MAKER.0, MAKER.1);
    start.starts_with(b"\x89PNG") && start.windows(comment.len()).take(256).any(|w| w == comment.as_bytes())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use crate::{Chart, Series, line_chart};

    fn chart(title: &str) -> String {
        let series = Series { label: "a".into(), ..Series::default() };
        line_chart(&Chart {
            title: title.into(),
            series: vec![series],
            width: 320.0,
            height: 200.0,
            ..Chart::default()
        })
    }

    fn pixels(bytes: &[u8]) -> (u32, u32, Vec<u8>) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut out = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut out).unwrap();
        (info.width, info.height, out)
    }

    #[test]
    fn a_picture_contains_its_texts() {
        let (one, two) = (png(&chart(""), 2.0).unwrap(), png(&chart("x² + μ"), 2.0).unwrap());
        let ((wide, high, a), (_, _, b)) = (pixels(&one), pixels(&two));
        assert_eq!((wide, high), (640, 400));
        let dark = |p: &[u8]| p.chunks(4).filter(|c| c[0] < 100).count();
        assert!(dark(&b) > dark(&a) + 50, "{} {}", dark(&a), dark(&b));
        assert!(is_own_png(&one));
        assert_eq!(one, png(&chart(""), 2.0).unwrap());
    }

    #[test]
    fn invalid_and_oversized_pictures_are_errors() {
        assert!(png("<svg", 1.0).is_err());
        assert!(png(&chart(""), 1e3).is_err());
        assert!(png(&chart(""), f32::NAN).is_err());
        assert!(!is_own_png(b"\x89PNG by somebody else"));
    }
}
