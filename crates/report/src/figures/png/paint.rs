//! Renders SVG with resvg, and compresses the pixels.

use std::collections::BTreeSet;
use std::sync::{Arc, Once};

use fontdb::{Database, ID, Source, Style};
use png::{BitDepth, ColorType, Compression, Encoder, PixelDimensions, SrgbRenderingIntent, Unit};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{FontResolver, Group, Node, Options, Tree};

use super::{Png, PngError, SOFTWARE, measure};

const REGULAR: &[u8] = include_bytes!("../../../fonts/DejaVuSansCondensed.ttf");
const BOLD: &[u8] = include_bytes!("../../../fonts/DejaVuSansCondensed-Bold.ttf");

/// Smallest font weight for which browsers use the bold font of a family.
const BOLD_FROM: u16 = 600;

/// Pixels per metre at scale 1: 96 per inch, as in CSS.
const PER_METRE: f64 = 96.0 / 0.0254;

pub(super) fn paint(svg: &str, scale: Option<f64>) -> Result<Png, PngError> {
    let tree = Tree::from_str(svg, &options()).map_err(|e| PngError::Figure {
        reason: e.to_string(),
    })?;
    let size = [tree.size().width(), tree.size().height()];
    let (scale, pixels) = measure(size.map(f64::from), scale)?;
    let [width, height] = pixels;
    let mut picture = Pixmap::new(width, height).ok_or(PngError::Figure {
        reason: format!("there is no picture of {width} x {height} pixels"),
    })?;
    picture.fill(Color::WHITE);
    let [x, y] = [0, 1].map(|k| pixels[k] as f32 / size[k]);
    resvg::render(&tree, Transform::from_scale(x, y), &mut picture.as_mut());
    let mut boxes = BTreeSet::new();
    find_boxes(tree.root(), &mut boxes);
    let bytes = pack(&picture, scale).map_err(|e| PngError::Packing {
        reason: e.to_string(),
    })?;
    Ok(Png {
        bytes,
        pixels,
        boxes: boxes.into_iter().collect(),
    })
}

/// Uses the two fonts of this crate for all text; the font families in the text have no effect.
fn options() -> Options<'static> {
    let mut fonts = Database::new();
    let mut add = |face: &'static [u8]| {
        let ids = fonts.load_font_source(Source::Binary(Arc::new(face)));
        ids.first().copied()
    };
    let [regular, bold] = [add(REGULAR), add(BOLD)];
    let of_machine = Once::new();
    let mut options = Options {
        fontdb: Arc::new(fonts),
        ..Options::default()
    };
    options.font_resolver = FontResolver {
        select_font: Box::new(move |font, _| {
            if font.weight() >= BOLD_FROM {
                bold
            } else {
                regular
            }
        }),
        select_fallback: Box::new(move |character, used, fonts| {
            of_machine.call_once(|| Arc::make_mut(fonts).load_system_fonts());
            find_font(character, used, fonts)
        }),
    };
    options
}

/// Returns a font that contains this character. If possible, the font is upright and as bold as the
/// first font in `used`.
fn find_font(character: char, used: &[ID], fonts: &mut Arc<Database>) -> Option<ID> {
    let find = FontResolver::default_fallback_selector();
    let is_bold = fonts.face(*used.first()?)?.weight.0 >= BOLD_FROM;
    let others = fonts
        .faces()
        .filter(|face| face.style != Style::Normal || (face.weight.0 >= BOLD_FROM) != is_bold);
    let others = others.map(|face| face.id);
    let left_out: Vec<ID> = used.iter().copied().chain(others).collect();
    find(character, &left_out, fonts).or_else(|| find(character, used, fonts))
}

/// Collects the characters of glyph 0, which is the box of a font.
fn find_boxes(group: &Group, found: &mut BTreeSet<char>) {
    for node in group.children() {
        match node {
            Node::Group(group) => find_boxes(group, found),
            Node::Text(text) => {
                let spans = text.layouted().iter();
                let glyphs = spans.flat_map(|span| &span.positioned_glyphs);
                for glyph in glyphs.filter(|glyph| glyph.id.0 == 0) {
                    found.extend(glyph.text.chars());
                }
            }
            _ => {}
        }
    }
}

/// Returns the pixels as the content of a file. All pixels are opaque, because the page is white.
fn pack(picture: &Pixmap, scale: f64) -> Result<Vec<u8>, png::EncodingError> {
    let colours = picture.data().chunks_exact(4);
    let colours: Vec<u8> = colours.flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    // In a document, the picture has the size of the figure. This size does not depend on the
    // scale.
    let per_metre = (scale * PER_METRE).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
        unit: Unit::Meter,
    }));
    encoder.add_text_chunk("Software".to_owned(), SOFTWARE.to_owned())?;
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&colours)?;
    writer.finish()?;
    Ok(bytes)
}
