//! Figures as PNG files, rendered from the SVG text of the figure.
//!
//! Every visible part of a picture comes from the SVG and its style sheet. Text uses the fonts in
//! `fonts/`, so that a picture looks the same on every machine. Only characters that are missing in
//! these fonts are taken from the fonts of the machine. A character that is missing in all fonts is
//! drawn as a box.

use std::ops::RangeInclusive;

#[cfg(feature = "png")]
mod paint;

/// A figure as the content of a PNG file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Png {
    /// Content of the file: RGB without transparency, with the name of this program as `Software`.
    pub bytes: Vec<u8>,
    /// Width and height in pixels.
    pub pixels: [u32; 2],
    /// Characters that no font contains, without repetitions; they are drawn as boxes.
    pub boxes: String,
}

/// The name of the program in the metadata of pictures.
pub(crate) const SOFTWARE: &str = "pfaff";

/// Default number of pixels for each px of the figure. With this value a picture is sharp on a
/// screen with small pixels, and the picture of a mechanism has 1920 pixels.
#[cfg(any(feature = "png", test))]
const SHARP: f64 = 2.0;

/// Range of permitted scales. Below 0.1, symbols cannot be distinguished.
const SCALES: RangeInclusive<f64> = 0.1..=20.0;

/// Maximum number of pixels of a picture. A pixel has 4 bytes. While the picture is rendered and
/// compressed, three copies of the pixels are in memory.
const MOST_PIXELS: f64 = 2.5e7;

/// Reason why a figure cannot be converted to a PNG file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PngError {
    /// This program was built without the rendering of pictures.
    #[error(
        "this program is built without the feature `png`: use SVG, or install it with `--features png`"
    )]
    Unavailable,
    /// The scale is not a number, or out of range.
    #[error(
        "the scale is {found}, need a number from {} to {} (pixels of the picture per px of the figure)",
        SCALES.start(),
        SCALES.end()
    )]
    Scale {
        /// The given scale.
        found: f64,
    },
    /// The picture would be too large.
    #[error(
        "the picture would have {width} x {height} pixels, at most {} million are supported: {}",
        MOST_PIXELS / 1e6,
        smaller(*largest)
    )]
    Pixels {
        /// Width at this scale.
        width: f64,
        /// Height at this scale.
        height: f64,
        /// The largest scale for this figure.
        largest: f64,
    },
    /// The figure has more elements than can be rendered, or is not SVG.
    #[error("the figure cannot be painted: {reason}; use SVG")]
    Figure {
        /// Description of the fault.
        reason: String,
    },
    /// The picture cannot be compressed.
    #[error("the picture cannot be written as PNG: {reason}; use SVG")]
    Packing {
        /// Description of the fault.
        reason: String,
    },
}

fn smaller(largest: f64) -> String {
    let rounded = (10.0 * largest).floor() / 10.0;
    if SCALES.contains(&rounded) {
        format!("use a scale up to {rounded}")
    } else {
        "take SVG".to_owned()
    }
}

/// Checks before a long computation whether [`png()`] would fail afterwards.
///
/// # Errors
/// - [`PngError::Unavailable`]
/// - [`PngError::Scale`]
pub fn check_png(scale: Option<f64>) -> Result<(), PngError> {
    if !cfg!(feature = "png") {
        return Err(PngError::Unavailable);
    }
    match scale {
        Some(found) if !SCALES.contains(&found) => Err(PngError::Scale { found }),
        _ => Ok(()),
    }
}

/// Renders a figure of this crate. `scale` is the number of pixels for each px of the figure. The
/// default is 2, or less if the picture would be too large.
///
/// # Errors
/// - [`PngError::Unavailable`]: this crate is built without the feature `png`.
/// - [`PngError::Scale`], [`PngError::Pixels`]: the scale is not a number, or too large.
/// - [`PngError::Figure`], [`PngError::Packing`]: the figure cannot be rendered.
pub fn png(svg: &str, scale: Option<f64>) -> Result<Png, PngError> {
    check_png(scale)?;
    #[cfg(feature = "png")]
    let painted = paint::paint(svg, scale);
    #[cfg(not(feature = "png"))]
    let painted = {
        let _ = svg;
        Err(PngError::Unavailable)
    };
    painted
}

/// Returns the scale and the size in pixels for a figure of this size (px).
#[cfg(any(feature = "png", test))]
fn measure([width, height]: [f64; 2], scale: Option<f64>) -> Result<(f64, [u32; 2]), PngError> {
    let largest = (MOST_PIXELS / (width * height)).sqrt();
    let scale = scale.unwrap_or_else(|| SHARP.min(largest));
    let pixels = [width, height].map(|side| (side * scale).round().max(1.0));
    if scale > largest || scale < *SCALES.start() {
        let [width, height] = pixels;
        return Err(PngError::Pixels {
            width,
            height,
            largest,
        });
    }
    Ok((scale, pixels.map(|side| side as u32)))
}

#[cfg(test)]
mod tests;
