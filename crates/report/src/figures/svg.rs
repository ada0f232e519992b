//! Writes SVG text, element by element. Only this module escapes names that come from the user.

use std::fmt::Write;

/// Fonts in the order of preference. The sizes of labels are estimated for the widest font.
const FONTS: &str = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

/// Text in the first element of every figure. Figures of other programs do not contain this text.
pub(crate) const GENERATOR: &str = "'Liberation Sans', 'DejaVu Sans', sans-serif\" role=\"img\"";

/// Conservative estimate of the mean width of a character relative to the font size.
const CHARACTER: f64 = 0.62;

/// Estimated width of a text (px).
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    CHARACTER * size * text.chars().count() as f64
}

/// An SVG document under construction.
pub(super) struct Svg {
    text: String,
    open: Vec<&'static str>,
}

impl Svg {
    /// A white page (px) with a title for screen readers.
    pub(super) fn new(width: f64, height: f64, title: &str) -> Self {
        let mut svg = Self {
            text: String::new(),
            open: Vec::new(),
        };
        let (w, h) = (number(width), number(height));
        svg.element("svg")
            .with("xmlns", "http://www.w3.org/2000/svg")
            .with("width", &w)
            .with("height", &h)
            .with("viewBox", &format!("0 0 {w} {h}"))
            .with("font-family", FONTS)
            .with("role", "img")
            .open();
        svg.element("title").text(title);
        svg.element("rect")
            .with("width", &w)
            .with("height", &h)
            .with("fill", "#ffffff")
            .empty();
        svg
    }

    /// Starts an element. One of the last three methods of [`Element`] writes the element.
    pub(super) fn element(&mut self, tag: &'static str) -> Element<'_> {
        self.text.push('<');
        self.text.push_str(tag);
        Element { svg: self, tag }
    }

    /// Closes the last opened element.
    pub(super) fn close(&mut self) {
        if let Some(tag) = self.open.pop() {
            self.end_tag(tag);
        }
    }

    /// Closes all elements.
    pub(super) fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }

    fn end_tag(&mut self, tag: &str) {
        self.text.push_str("</");
        self.text.push_str(tag);
        self.text.push_str(">\n");
    }
}

/// A start tag to which attributes can be added.
pub(super) struct Element<'a> {
    svg: &'a mut Svg,
    tag: &'static str,
}

impl Element<'_> {
    /// An attribute.
    pub(super) fn with(self, name: &str, value: &str) -> Self {
        let text = &mut self.svg.text;
        text.push(' ');
        text.push_str(name);
        text.push_str("=\"");
        escape(value, text);
        text.push('"');
        self
    }

    /// Adds numerical attributes.
    pub(super) fn at<const N: usize>(self, numbers: [(&str, f64); N]) -> Self {
        numbers
            .into_iter()
            .fold(self, |e, (name, value)| e.with(name, &number(value)))
    }

    /// Writes the element without content.
    pub(super) fn empty(self) {
        self.svg.text.push_str("/>\n");
    }

    /// Writes the element with a text.
    pub(super) fn text(self, content: &str) {
        self.svg.text.push('>');
        escape(content, &mut self.svg.text);
        self.svg.end_tag(self.tag);
    }

    /// Opens the element for other elements.
    pub(super) fn open(self) {
        self.svg.text.push_str(">\n");
        self.svg.open.push(self.tag);
    }
}

/// A number rounded to hundredths of a pixel.
pub(super) fn number(value: f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    // Adding zero changes −0 to 0.
    let rounded = if rounded.is_finite() {
        rounded + 0.0
    } else {
        0.0
    };
    format!("{rounded}")
}

/// A list of points for the attributes `points` or `d`.
pub(super) fn point_list(points: impl IntoIterator<Item = [f64; 2]>) -> String {
    let mut list = String::new();
    for [x, y] in points {
        let gap = if list.is_empty() { "" } else { " " };
        // Writing to a string cannot fail.
        let _ = write!(list, "{gap}{},{}", number(x), number(y));
    }
    list
}

/// Escapes characters with a meaning in XML, and replaces characters that XML forbids.
pub(crate) fn escape(from: &str, to: &mut String) {
    for c in from.chars() {
        match c {
            '&' => to.push_str("&amp;"),
            '<' => to.push_str("&lt;"),
            '>' => to.push_str("&gt;"),
            '"' => to.push_str("&quot;"),
            '\t' | '\n' | '\r' => to.push(' '),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => to.push('\u{fffd}'),
            c => to.push(c),
        }
    }
}
