//! Height fields: elevations on a grid, from text or a file, normalized to the range from 0 to 1.

use super::mesh::{AssetProblem, Bytes};
#[cfg(feature = "pictures")]
use super::png;
use crate::mjcf::gather::listed;
use crate::mjcf::text::diagnostic::shorten_name;

/// Limit for the samples of a height field.
const MAX_SAMPLES: usize = 4_000_000;

/// A height field.
#[derive(Debug)]
pub(crate) struct HField {
    /// Half lengths in x and y, height of the top, depth of the base, m.
    pub(crate) size: [f64; 4],
    pub(crate) nrow: usize,
    pub(crate) ncol: usize,
    /// Elevations from 0 to 1, row by row, starting at the smallest y.
    pub(crate) data: Vec<f64>,
}

/// The numbers of rows and columns, and elevations before normalization.
pub(crate) struct ElevationSamples {
    nrow: usize,
    ncol: usize,
    data: Vec<f64>,
}

impl HField {
    /// A height field whose lowest sample is 0 and whose highest is 1.
    pub(crate) fn new(samples: ElevationSamples, size: &[f64]) -> Result<HField, AssetProblem> {
        let Ok(size) = <[f64; 4]>::try_from(size) else {
            return Err(AssetProblem::new(
                "size",
                "has no `size`",
                "",
                "write half lengths in x and y, height of the top and depth of the base: `size=\"5 5 1 0.1\"`",
            ));
        };
        if let Some(x) = size.iter().find(|&&x| x <= 0.0) {
            return Err(AssetProblem::new(
                "size",
                format!("has {x} in its `size`"),
                "a height field needs an extent, a height and a base",
                "write four numbers larger than zero",
            ));
        }
        let ElevationSamples { nrow, ncol, mut data } = samples;
        if let Some(i) = data.iter().position(|x| !x.is_finite()) {
            return Err(AssetProblem::new(
                "file",
                format!("has a sample {i} that is not finite"),
                "",
                "write a finite number",
            ));
        }
        let lowest = data.iter().fold(f64::INFINITY, |s, &x| s.min(x));
        let range = data.iter().fold(f64::NEG_INFINITY, |s, &x| s.max(x)) - lowest;
        for x in &mut data {
            // In single precision, as in MuJoCo.
            let above = (*x - lowest) as f32;
            *x = f64::from(if range > crate::math::MINVAL { above / range as f32 } else { above });
        }
        Ok(HField { size, nrow, ncol, data })
    }

    /// The size of a geom: half lengths of a box of about the same volume.
    pub(crate) fn geom_size(&self) -> [f64; 3] {
        let [x, y, top, base] = self.size;
        [x, y, 0.25 * top + 0.5 * base]
    }

    /// Centre and half lengths of the bounding box.
    pub(crate) fn aabb(&self) -> [f64; 6] {
        let [x, y, top, base] = self.size;
        [0.0, 0.0, (top - base) / 2.0, x, y, (top + base) / 2.0]
    }

    /// Radius of the bounding sphere about the frame of the height field.
    pub(crate) fn rbound(&self) -> f64 {
        let [x, y, top, base] = self.size;
        crate::math::norm([x, y, top.max(base)])
    }
}

/// Checks the numbers of rows and columns.
fn grid(nrow: i32, ncol: i32, attribute: &'static str) -> Result<(usize, usize), AssetProblem> {
    match (usize::try_from(nrow), usize::try_from(ncol)) {
        (Ok(r), Ok(c)) if r > 0 && c > 0 && r.saturating_mul(c) <= MAX_SAMPLES => Ok((r, c)),
        _ => Err(AssetProblem::new(
            attribute,
            format!("has {nrow} rows and {ncol} columns"),
            "",
            "write at least one of each in `nrow` and `ncol`, and at most 4000000 samples",
        )),
    }
}

/// A height field whose elevations are in its attribute, starting at the largest y. Without elevations, it is flat.
pub(crate) fn written(nrow: i32, ncol: i32, elevation: &[f64]) -> Result<ElevationSamples, AssetProblem> {
    let (nrow, ncol) = grid(nrow, ncol, "nrow")?;
    if elevation.is_empty() {
        return Ok(ElevationSamples { nrow, ncol, data: vec![0.0; nrow * ncol] });
    }
    if elevation.len() != nrow * ncol {
        return Err(AssetProblem::new(
            "elevation",
            format!("has {} elevations, but {nrow} rows of {ncol} columns", elevation.len()),
            "",
            "write a number for each sample, row by row from the largest y",
        ));
    }
    let rows = elevation.chunks_exact(ncol).rev();
    let data = listed(rows.flatten().map(|&x| f64::from(x as f32)));
    Ok(ElevationSamples { nrow, ncol, data })
}

/// The content types of the file formats.
const PNG: &str = "image/png";
const MUJOCO_HFIELD: &str = "image/vnd.mujoco.hfield";

/// Reads a file: a PNG image or MuJoCo's format. The extension of the name or `content_type` determines the format, by the rules
/// measured on MuJoCo 3.14.0: a content type with a `/` that is not one of the two is refused, and any other text selects
/// MuJoCo's format.
pub(crate) fn decode(path: &str, content_type: &str, bytes: &[u8]) -> Result<ElevationSamples, AssetProblem> {
    let kind = match content_type {
        "" if path.to_ascii_lowercase().ends_with(".png") => PNG,
        "" => MUJOCO_HFIELD,
        kind if kind.contains('/') => kind,
        _ => MUJOCO_HFIELD,
    };
    match kind {
        PNG => read_image(bytes),
        MUJOCO_HFIELD => decode_samples(bytes),
        _ => Err(AssetProblem::new(
            "content_type",
            format!("has a file of the kind {}", shorten_name(kind)),
            "heights come from an image or from MuJoCo's own format",
            "write `content_type=\"image/png\"`, or delete it",
        )),
    }
}

/// A PNG image: the elevation is the red channel in 8 bits, and the last row of the image has the smallest y.
#[cfg(feature = "pictures")]
fn read_image(bytes: &[u8]) -> Result<ElevationSamples, AssetProblem> {
    let bad = |what: &str| {
        AssetProblem::file(
            format!("has a file that cannot be read as a PNG image: {what}"),
            "export the image again",
        )
    };
    let mut rest = bytes;
    let header = png::header(&mut rest).map_err(bad)?;
    let to_int = |n: u32| i32::try_from(n).unwrap_or(i32::MAX);
    let (nrow, ncol) = grid(to_int(header.height), to_int(header.width), "file")?;
    let red = png::first_colors(&header, rest).map_err(bad)?;
    let data = listed(red.chunks_exact(ncol).rev().flatten().map(|&x| f64::from(x)));
    Ok(ElevationSamples { nrow, ncol, data })
}

/// Returns an error, in builds without support for images.
#[cfg(not(feature = "pictures"))]
fn read_image(_: &[u8]) -> Result<ElevationSamples, AssetProblem> {
    Err(AssetProblem::file(
        "has an image, but this program was built without image support".to_string(),
        "write the heights into the model, as `elevation`, or ship the compiled model",
    ))
}

/// MuJoCo's format: the numbers of rows and columns, then the elevations in single precision, starting at the smallest y.
fn decode_samples(bytes: &[u8]) -> Result<ElevationSamples, AssetProblem> {
    if bytes.starts_with(b"\x89PNG") {
        return Err(AssetProblem::file(
            "has a PNG image as its file, but neither its name nor its type says so",
            "use a file name that ends in .png, or write `content_type=\"image/png\"`",
        ));
    }
    let mut numbers = Bytes(bytes);
    let Some([nrow, ncol]) = numbers.ints() else {
        return Err(AssetProblem::file(
            format!("has a file of {} bytes", bytes.len()),
            "the file begins with two 32-bit integers: rows and columns",
        ));
    };
    let (nrow, ncol) = grid(nrow, ncol, "file")?;
    if numbers.0.len() != 4 * nrow * ncol {
        return Err(AssetProblem::file(
            format!(
                "has a file of {} bytes, but {nrow} rows of {ncol} columns need {}",
                bytes.len(),
                8 + 4 * nrow * ncol
            ),
            "write the file again: it is truncated or has another format",
        ));
    }
    Ok(ElevationSamples { nrow, ncol, data: listed((0..nrow * ncol).map_while(|_| numbers.real())) })
}
