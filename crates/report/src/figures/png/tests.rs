//! Tests of sizes and errors, and of pictures as read by another program.

use super::*;

#[test]
fn a_picture_has_two_pixels_for_each_px_if_it_is_not_too_large() {
    assert_eq!(measure([960.0, 535.4], None), Ok((2.0, [1920, 1071])));
    assert_eq!(measure([960.0, 535.4], Some(0.5)), Ok((0.5, [480, 268])));
    // For a figure of 1000 x 100 000 px, a quarter of this number of pixels is permitted, so the
    // scale is half a pixel for each px.
    assert_eq!(measure([1e3, 1e5], None), Ok((0.5, [500, 50_000])));
}

#[test]
fn what_cannot_be_painted_says_what_can() {
    let refused = |size, scale| measure(size, scale).expect_err("too large").to_string();
    assert_eq!(
        refused([1000.0, 1000.0], Some(10.0)),
        "the picture would have 10000 x 10000 pixels, at most 25 million are supported: use a scale up to 5"
    );
    let endless = refused([1e3, 1e7], None);
    assert!(
        endless.ends_with("25 million are supported: take SVG"),
        "{endless}"
    );
    for scale in [f64::NAN, f64::INFINITY, 0.0, -1.0, 0.09, 21.0] {
        let error = png("<svg/>", Some(scale)).expect_err("no scale");
        if cfg!(feature = "png") {
            let expected = format!(
                "the scale is {scale}, need a number from 0.1 to 20 (pixels of the picture per px of the figure)"
            );
            assert_eq!(error.to_string(), expected);
        } else {
            assert_eq!(error, PngError::Unavailable);
        }
    }
}

#[cfg(feature = "png")]
mod painted {
    use super::super::{Png, PngError, png};
    use crate::figures::svg::Svg;
    use crate::figures::{Panel, Series, Style, histories};

    /// Properties of a picture, as read by another program.
    struct Read {
        size: [usize; 2],
        colours: Vec<[u8; 3]>,
        software: String,
        /// Pixels per metre.
        density: u32,
    }

    impl Read {
        fn of(picture: &Png) -> Self {
            let decoder = ::png::Decoder::new(std::io::Cursor::new(&picture.bytes));
            let mut reader = decoder.read_info().expect("a PNG file");
            let mut data = vec![0; reader.output_buffer_size().expect("it fits")];
            reader.next_frame(&mut data).expect("pixels");
            let info = reader.info();
            assert_eq!(info.color_type, ::png::ColorType::Rgb);
            let texts = &info.uncompressed_latin1_text;
            Self {
                size: [info.width as usize, info.height as usize],
                colours: data.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
                software: texts
                    .iter()
                    .map(|t| format!("{}={}", t.keyword, t.text))
                    .collect(),
                density: info.pixel_dims.expect("a density").xppu,
            }
        }

        fn at(&self, x: usize, y: usize) -> [u8; 3] {
            self.colours[y * self.size[0] + x]
        }

        fn count(&self, colour: [u8; 3]) -> usize {
            self.colours.iter().filter(|c| **c == colour).count()
        }
    }

    const WHITE: [u8; 3] = [255; 3];

    /// A page of 40 x 20 px with a red square of 10 px in its corner.
    fn square() -> String {
        let mut svg = Svg::new(40.0, 20.0, "square");
        let side = [("width", 10.0), ("height", 10.0)];
        svg.element("rect").at(side).with("fill", "#d00000").empty();
        svg.finish()
    }

    /// A page with a text in the fonts of figures.
    fn text(content: &str, weight: &str) -> Png {
        let mut svg = Svg::new(400.0, 30.0, "text");
        let place = [("x", 4.0), ("y", 20.0), ("font-size", 13.0)];
        let element = svg.element("text").at(place);
        element.with("font-weight", weight).text(content);
        png(&svg.finish(), None).expect("a picture")
    }

    #[test]
    fn pixels_are_those_of_the_figure() {
        for (scale, asked) in [(2, None), (1, Some(1.0)), (7, Some(7.0))] {
            let read = Read::of(&png(&square(), asked).expect("a picture"));
            assert_eq!(read.size, [40 * scale, 20 * scale]);
            assert_eq!(read.count([208, 0, 0]), (10 * scale).pow(2));
            assert_eq!(read.count(WHITE), 700 * scale.pow(2));
            assert_eq!(read.at(0, 0), [208, 0, 0]);
            assert_eq!(read.software, "Software=pfaff");
            // 96 px to the inch of 25.4 mm.
            assert_eq!(read.density, [0, 3780, 7559, 0, 0, 0, 0, 26457][scale]);
        }
    }

    #[test]
    fn every_stated_character_is_in_both_fonts() {
        let stated = include_str!("../../../fonts/characters.txt");
        let lines = stated.lines().filter(|line| !line.starts_with('#'));
        let number = |text: &str| u32::from_str_radix(text, 16).expect("a character");
        let mut characters = 0;
        for range in lines.flat_map(|line| line.split(',')) {
            let range = range.strip_prefix("U+").expect("a range");
            let (from, to) = range.split_once('-').unwrap_or((range, range));
            let content: String = (number(from)..=number(to))
                .filter_map(char::from_u32)
                .collect();
            characters += content.chars().count();
            for weight in ["400", "700"] {
                assert_eq!(text(&content, weight).boxes, "", "{range}");
            }
        }
        assert!(characters > 600, "{characters}");
    }

    #[test]
    fn bold_is_darker_and_names_of_600_are_bold() {
        let ink = |weight| {
            let read = Read::of(&text("steering", weight));
            let dark = read.colours.iter().map(|c| u64::from(255 - c[0]));
            dark.sum::<u64>()
        };
        assert!(ink("400") > 0);
        assert!(ink("700") * 10 > ink("400") * 13);
        assert_eq!(ink("600"), ink("700"));
        assert_eq!(ink("500"), ink("400"));
    }

    #[test]
    fn a_character_that_no_font_has_is_a_box_and_told() {
        // The characters are unassigned. A repeated character is reported once.
        let picture = text("a\u{378}b\u{378}\u{380}", "400");
        assert_eq!(picture.boxes, "\u{378}\u{380}");
        let with_box = Read::of(&picture);
        let without = Read::of(&text("a b  ", "400"));
        assert!(with_box.count(WHITE) + 100 < without.count(WHITE));
    }

    #[test]
    fn odd_texts_are_painted() {
        for odd in [
            "",
            " ",
            "\u{301}",
            "q\u{307} = e\u{301}\u{302}\u{303}\u{304}\u{306}",
            "\u{202e}right to left\u{202c}",
            "\u{5e9}\u{5dc}\u{5d5}\u{5dd} and \u{645}\u{631}\u{62d}\u{628}\u{627} 12",
            "\u{915}\u{94d}\u{937}\u{93f}",
            "\u{e01}\u{e33}",
            "\u{1f468}\u{200d}\u{1f469}\u{200d}\u{1f467}\u{fe0f}",
            "\u{85}\u{2028}\u{2029}x\u{2029}",
            "\u{feff}\u{ad}\u{200b}\u{200d}\u{2060}",
            "\u{e000}\u{f0000}\u{10fffd}\u{e0041}",
            "\u{7f}\u{80}\u{9f}\u{fffd}\u{ffff}\u{0}",
            "\u{1100}\u{1161}\u{11a8}\u{ac01}",
            "</text><script>&amp;]]>",
        ] {
            for weight in ["400", "600"] {
                assert!(text(odd, weight).bytes.len() > 100, "{odd:?}");
            }
        }
        let long = "\u{5e9}x\u{301} ".repeat(3000);
        assert!(text(&long, "400").bytes.len() > 100);
    }

    #[test]
    fn dark_colours_of_pages_are_left_out() {
        let series = Series {
            label: "x",
            t: &[0.0, 1.0, 2.0],
            y: &[0.0, 1.0, -1.0],
            style: Style::nth(0),
        };
        let panel = Panel {
            title: "place",
            unit: "m",
            series: &[series],
        };
        let read = Read::of(&png(&histories(&[panel], 1), None).expect("a picture"));
        assert!(read.count(WHITE) * 10 > read.colours.len() * 8);
        assert!(read.count([0x00, 0x72, 0xb2]) > 100, "the curve");
        let again = png(&histories(&[panel], 1), None);
        assert_eq!(png(&histories(&[panel], 1), None), again);
    }

    #[test]
    fn what_is_no_figure_is_refused() {
        for wrong in [
            "",
            "no figure",
            "<svg>",
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"0\"/>",
        ] {
            let error = png(wrong, None).expect_err(wrong);
            assert!(matches!(error, PngError::Figure { .. }), "{error}");
        }
    }
}
