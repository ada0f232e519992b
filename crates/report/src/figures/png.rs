//! Figures as PNG files: the SVG text of a figure, painted.
//!
//! Nothing is drawn twice: whatever is to be seen in a picture stands in the SVG, with its style
//! sheet. Text is set in the fonts of `fonts/`, so that a picture looks the same on every
//! machine. Only characters that these do not have are looked for in the fonts of the machine; one
//! that is not there either becomes a box.

use std::ops::RangeInclusive;

#[cfg(feature = "png")]
mod paint;

/// A figure as the content of a PNG file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Png {
    /// The file: RGB without transparency, with the name of this program as `Software`.
    pub bytes: Vec<u8>,
    /// Width and height in pixels.
    pub pixels: [u32; 2],
    /// Characters that no font has, each once: they are boxes.
    pub boxes: String,
}

/// The program that pictures name as the one that made them.
pub(crate) const SOFTWARE: &str = "pfaff";

/// Pixels for each px of the figure if nothing else is requested: sharp on a screen with small
/// pixels, and 1920 of them for the picture of a mechanism.
#[cfg(any(feature = "png", test))]
const SHARP: f64 = 2.0;

/// Scales that can be requested. With less than a tenth no symbol can be told from another.
const SCALES: RangeInclusive<f64> = 0.1..=20.0;

/// Pixels of the largest picture: 4 bytes each, three times while it is painted and packed.
const MOST_PIXELS: f64 = 2.5e7;

/// Reason why a figure cannot be a PNG file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PngError {
    /// Painting is not part of this program.
    #[error(
        "this program is built without the feature `png`: take SVG, or install it with `--features png`"
    )]
    Unavailable,
    /// The scale is not a number, or not one for a picture.
    #[error(
        "the scale is {found}, need a number from {} to {} (pixels of the picture per px of the figure)",
        SCALES.start(),
        SCALES.end()
    )]
    Scale {
        /// The scale.
        found: f64,
    },
    /// The picture would be too large.
    #[error(
        "the picture would have {width} x {height} pixels, the most are {} million: {}",
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
    /// The figure has more elements than can be painted, or is not SVG.
    #[error("the figure cannot be painted: {reason}; take SVG")]
    Figure {
        /// What is wrong.
        reason: String,
    },
    /// The picture cannot be packed.
    #[error("the picture cannot be written as PNG: {reason}; take SVG")]
    Packing {
        /// What is wrong.
        reason: String,
    },
}

fn smaller(largest: f64) -> String {
    let rounded = (10.0 * largest).floor() / 10.0;
    if SCALES.contains(&rounded) {
        format!("take a scale up to {rounded}")
    } else {
        "take SVG".to_owned()
    }
}

/// Checks before a long computation what [`png()`] would refuse after it.
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

/// Paints a figure of this crate. `scale` is the number of pixels for each px of the figure; by
/// default 2, or less where the picture would be too large.
///
/// # Errors
/// - [`PngError::Unavailable`]: this crate is built without the feature `png`.
/// - [`PngError::Scale`], [`PngError::Pixels`]: the scale is no number, or too large.
/// - [`PngError::Figure`], [`PngError::Packing`]: the figure cannot be painted.
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

/// The scale and the size in pixels for a figure of this size (px).
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
