//! The legend of a mechanism: what its marks and symbols mean.

use model::reaction::ConstraintGroup;
use model::{ConstraintKind, Mechanism, System};

use super::{MARGIN, Marking, WIDTH};
use crate::figures::geometry::Site;
use crate::figures::style::{INK, Mark, TEXT_SIZE};
use crate::figures::svg::{Svg, text_width};
use crate::figures::symbol::Symbol;

/// Height of a line (px).
const LEGEND_LINE: f64 = 26.0;
/// Half the width of a sample (px).
const SAMPLE: f64 = 28.0;

/// Marks and symbols that occur, with their meaning.
pub(super) struct Legend {
    lines: Vec<Vec<Entry>>,
}

impl Legend {
    /// The legend of a figure.
    pub(super) fn of(mechanism: &Mechanism, sites: &[Site], marking: Marking<'_>) -> Self {
        let verdicts = match marking {
            Marking::Plain => Vec::new(),
            Marking::Verdicts(_) => Mark::VERDICTS.map(Entry::of_mark).to_vec(),
        };
        let mut kinds: Vec<Entry> = Vec::new();
        for (site, group) in sites.iter().zip(&mechanism.layout().groups) {
            let entry = Entry::of_kind(site.symbol, group);
            if kinds.iter().all(|k| k.text != entry.text) {
                kinds.push(entry);
            }
        }
        let mut lines = vec![verdicts, Vec::new()];
        let mut x = 0.0;
        for kind in kinds {
            if x > 0.0 && x + kind.width() > WIDTH - 2.0 * MARGIN {
                lines.push(Vec::new());
                x = 0.0;
            }
            x += kind.width();
            if let Some(line) = lines.last_mut() {
                line.push(kind);
            }
        }
        lines.retain(|l| !l.is_empty());
        Self { lines }
    }

    /// Its height (px).
    pub(super) fn height(&self) -> f64 {
        LEGEND_LINE * self.lines.len() as f64 + 6.0
    }

    /// Draws it; the middle of its first line is at `top`.
    pub(super) fn draw(&self, svg: &mut Svg, top: f64) {
        for (row, entries) in self.lines.iter().enumerate() {
            let y = top + LEGEND_LINE * row as f64;
            let mut x = MARGIN;
            for entry in entries {
                entry.draw(svg, [x, y]);
                x += entry.width();
            }
        }
    }
}

/// A symbol with its meaning.
#[derive(Clone)]
struct Entry {
    symbol: Symbol,
    mark: Mark,
    text: String,
}

impl Entry {
    fn of_mark(mark: Mark) -> Self {
        Self {
            symbol: Symbol::Pin,
            mark,
            text: format!("reaction {}", mark.words()),
        }
    }

    fn of_kind(symbol: Symbol, group: &ConstraintGroup) -> Self {
        let kind = group.spec.common.scene_type;
        Self {
            symbol: symbol.lying(),
            mark: Mark::Plain,
            text: match group.kind {
                ConstraintKind::Joint => kind.to_owned(),
                ConstraintKind::Drive => format!("{kind} drive"),
            },
        }
    }

    fn width(&self) -> f64 {
        2.0 * SAMPLE + 4.0 + text_width(&self.text, TEXT_SIZE) + 6.0
    }

    fn draw(&self, svg: &mut Svg, [x, y]: [f64; 2]) {
        let offset = self.symbol.offset();
        let (place, end) = match self.symbol {
            Symbol::Rod => ([x + 10.0, y], [x + 2.0 * SAMPLE - 10.0, y]),
            _ => {
                let place = [x + SAMPLE - offset[0], y - offset[1]];
                (place, place)
            }
        };
        self.symbol.draw(svg, place, end, self.mark);
        svg.element("text")
            .at([
                ("x", x + 2.0 * SAMPLE + 4.0),
                ("y", y + 4.0),
                ("font-size", TEXT_SIZE),
            ])
            .with("fill", INK)
            .text(&self.text);
    }
}
