//! Colours, strokes and sizes. The colours are from Okabe and Ito (2008); colour-blind readers can
//! distinguish them. No information depends on colour alone.

/// Text and frames.
pub(super) const INK: &str = "#222222";
/// Axes, leader lines, secondary text.
pub(super) const GREY: &str = "#5f6870";
/// Grid lines.
pub(super) const GRID: &str = "#e3e6e9";
/// Size of titles (px).
pub(super) const TITLE_SIZE: f64 = 14.0;
/// Size of all other text (px).
pub(super) const TEXT_SIZE: f64 = 12.0;

/// Colours of the light scheme of pages, with the corresponding colours of the dark scheme.
const DARK: [(&str, &str); 9] = [
    ("#ffffff", "#14171a"),
    ("#222222", "#e8eaec"),
    ("#5f6870", "#a3abb3"),
    ("#e3e6e9", "#2b3036"),
    ("#8a939b", "#59626b"),
    ("#000000", "#ffffff"),
    ("#0072b2", "#2b8ad6"),
    ("#56b4e9", "#9bdcff"),
    ("#f1f3f5", "#1d2125"),
];

/// Colours of curves.
const CURVES: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
];

/// Stroke of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pattern {
    /// A continuous line.
    #[default]
    Solid,
    /// Dashes.
    Dashed,
    /// Dots.
    Dotted,
}

impl Pattern {
    const ALL: [Self; 3] = [Self::Solid, Self::Dashed, Self::Dotted];

    pub(super) fn dashes(self) -> &'static str {
        match self {
            Self::Solid => "none",
            Self::Dashed => "7 4",
            Self::Dotted => "1.5 3.5",
        }
    }
}

/// Appearance of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// Index in the palette of seven colours. The palette repeats.
    pub colour: usize,
    /// Stroke of the curve.
    pub pattern: Pattern,
}

impl Style {
    /// The style of the curve with this index. Colour and stroke both depend on the index, so that
    /// coinciding curves are all visible.
    #[must_use]
    pub fn nth(place: usize) -> Self {
        Self {
            colour: place,
            pattern: Pattern::ALL[place % Pattern::ALL.len()],
        }
    }

    pub(super) fn colour(self) -> &'static str {
        CURVES[self.colour % CURVES.len()]
    }
}

/// CSS rules that exchange the colours if the reader prefers a dark page.
pub(super) fn dark_scheme() -> String {
    let rule = |(light, dark): (&str, &str)| {
        format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
    };
    let rules: String = DARK.into_iter().map(rule).collect();
    format!("@media (prefers-color-scheme: dark){{{rules}}}")
}
