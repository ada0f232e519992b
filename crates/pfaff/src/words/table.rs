//! Tables of answers: cells with texts and quantities, units of columns, and the layout as text.

use model::words::{Prefix, short};
use report::SceneUnits;
use scene::{Scene, Units, WithUnit};

/// A number counts as a rounding error if it is below this fraction of the largest number of its
/// column and unit. Such a number is printed as zero.
const VISIBLE: f64 = 1e-12;

/// Width of a column with lists (characters).
const LIST: usize = 34;

/// A cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A text.
    Text(String),
    /// Words. A long list has several lines.
    List(Vec<String>),
    /// A number in an SI unit; `None` if there is no number.
    Quantity(Option<f64>, &'static str),
}

impl Cell {
    /// Creates a cell with a number in an SI unit.
    #[must_use]
    pub fn quantity(value: impl Into<Option<f64>>, unit: &'static str) -> Self {
        Self::Quantity(value.into(), unit)
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Self::Text(text.into())
    }
}

/// Returns the units that a scene chooses.
#[must_use]
pub fn scene_units(scene: &Scene) -> SceneUnits {
    let value = |unit: &'static str, si: &str| {
        let text = format!("1 {unit}");
        let of = WithUnit::read(&text).filter(|_| unit != si)?;
        Some((unit, of.in_si(1.0)))
    };
    SceneUnits {
        length: value(scene.units.length, Units::SI.length),
        angle: value(scene.units.angle, Units::SI.angle),
    }
}

/// Units of printed quantities.
#[derive(Clone, Copy, Debug)]
pub enum UnitSystem {
    /// Units of the scene, otherwise SI units with prefixes.
    Scene(SceneUnits),
    /// SI units without prefixes.
    Si,
}

impl UnitSystem {
    /// Returns the unit for numbers up to this size in an SI unit, and the value of this unit in
    /// the SI unit.
    #[must_use]
    pub fn unit(&self, largest: f64, si: &str) -> (String, f64) {
        let Self::Scene(units) = self else {
            return (si.to_owned(), 1.0);
        };
        units.unit(si).unwrap_or_else(|| {
            let Prefix { symbol, factor } = Prefix::of(largest, si);
            (format!("{symbol}{si}"), factor)
        })
    }
}

/// Returns the texts of a table, column by column. The first text of each column is the header. All
/// quantities of a table in the same SI unit have the same prefix. If all quantities of a column
/// have the same unit, the header contains it.
pub(crate) fn cells_of_table(lines: &[Vec<Cell>], units: UnitSystem) -> Vec<Vec<String>> {
    let n = lines.iter().map(Vec::len).max().unwrap_or(0);
    let lines: Vec<Vec<Cell>> = lines.iter().flat_map(|line| unfolded(line)).collect();
    let quantities = lines.iter().flatten().filter_map(|cell| match cell {
        Cell::Quantity(Some(value), unit) => Some((*value, *unit)),
        _ => None,
    });
    let scale = Scale::new(quantities, units);
    (0..n).map(|k| scale.column(&lines, k)).collect()
}

/// Aligns lines of cells in columns.
pub(super) fn columns(lines: &[Vec<Cell>], units: UnitSystem) -> String {
    let columns = cells_of_table(lines, units);
    let width = |cells: &Vec<String>| cells.iter().map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = columns.iter().filter_map(width).collect();
    let mut out = String::new();
    for i in 0..columns.first().map_or(0, Vec::len) {
        let cells = columns.iter().zip(&widths);
        let cells = cells.map(|(cells, &w)| format!("{:<w$}", cells[i]));
        out.push_str(cells.collect::<Vec<_>>().join("  ").trim_end());
        out.push('\n');
    }
    out
}

/// Splits lists into lines of texts.
fn unfolded(line: &[Cell]) -> Vec<Vec<Cell>> {
    let chunks = line.iter().map(|cell| match cell {
        Cell::List(words) => folded(words),
        cell => vec![cell.clone()],
    });
    let chunks: Vec<Vec<Cell>> = chunks.collect();
    let height = chunks.iter().map(Vec::len).max().unwrap_or(0);
    let line = |i: usize| chunks.iter().map(move |cells| cells.get(i).cloned());
    let lines = (0..height.max(1)).map(|i| line(i).map(|cell| cell.unwrap_or_else(|| "".into())));
    lines.map(Iterator::collect).collect()
}

/// Joins words in lines of limited width.
fn folded(words: &[String]) -> Vec<Cell> {
    let mut lines: Vec<String> = Vec::new();
    for (k, word) in words.iter().enumerate() {
        let comma = if k + 1 < words.len() { "," } else { "" };
        match lines.last_mut() {
            Some(line) if line.chars().count() + word.chars().count() < LIST => {
                line.push_str(&format!(" {word}{comma}"));
            }
            _ => lines.push(format!("{word}{comma}")),
        }
    }
    lines.into_iter().map(Cell::from).collect()
}

/// Prefixes of units for a set of quantities.
pub(crate) struct Scale {
    units: UnitSystem,
    /// SI units, each with the size of its largest number.
    largest: Vec<(&'static str, f64)>,
}

impl Scale {
    /// Chooses the prefixes for these numbers in SI units.
    pub(crate) fn new(
        numbers: impl IntoIterator<Item = (f64, &'static str)>,
        units: UnitSystem,
    ) -> Self {
        let mut largest: Vec<(&str, f64)> = Vec::new();
        for (value, unit) in numbers {
            let size = if value.is_finite() { value.abs() } else { 0.0 };
            match largest.iter_mut().find(|(known, _)| *known == unit) {
                Some((_, most)) => *most = most.max(size),
                None => largest.push((unit, size)),
            }
        }
        Self { units, largest }
    }

    fn largest(&self, unit: &str) -> f64 {
        let found = self.largest.iter().find(|(known, _)| *known == unit);
        found.map_or(0.0, |(_, most)| *most)
    }

    /// Returns the texts of a column.
    fn column(&self, lines: &[Vec<Cell>], k: usize) -> Vec<String> {
        let mut units = lines.iter().filter_map(|line| match line.get(k) {
            Some(Cell::Quantity(_, unit)) => Some(*unit),
            _ => None,
        });
        let first = units.next();
        let common = first.filter(|first| units.all(|unit| unit == *first));
        let texts = lines.iter().enumerate().map(|(i, line)| match line.get(k) {
            None | Some(Cell::List(_)) => String::new(),
            Some(Cell::Text(text)) => match common.filter(|unit| i == 0 && !unit.is_empty()) {
                None => text.clone(),
                Some(unit) => format!("{text} ({})", self.unit(unit).0),
            },
            Some(Cell::Quantity(None, _)) => "–".to_owned(),
            Some(Cell::Quantity(Some(value), unit)) => {
                let number = self.number(*value, unit);
                match common {
                    None => format!("{number} {}", self.unit(unit).0),
                    Some(_) => number,
                }
            }
        });
        let texts = texts.collect();
        if first.is_some() {
            aligned(texts)
        } else {
            texts
        }
    }

    /// Returns the printed unit for an SI unit, and its value in the SI unit.
    pub(crate) fn unit(&self, si: &str) -> (String, f64) {
        self.units.unit(self.largest(si), si)
    }

    /// Formats a number in the printed unit, without the unit.
    pub(crate) fn number(&self, value: f64, si: &str) -> String {
        let is_visible = value.abs() > VISIBLE * self.largest(si) || value.is_nan();
        short(if is_visible {
            value / self.unit(si).1
        } else {
            0.0
        })
    }
}

/// Aligns the decimal points of a column with a header.
fn aligned(mut cells: Vec<String>) -> Vec<String> {
    let point = |cell: &str| {
        let end = cell.find(|c: char| !(c.is_ascii_digit() || c == '−'));
        cell[..end.unwrap_or(cell.len())].chars().count()
    };
    let before = cells.iter().skip(1).map(|cell| point(cell)).max();
    for cell in cells.iter_mut().skip(1) {
        let missing = before.unwrap_or(0) - point(cell);
        *cell = " ".repeat(missing) + cell;
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    fn force(value: f64) -> Cell {
        Cell::quantity(value, "N")
    }

    fn text(lines: &[Vec<Cell>], units: UnitSystem) -> Vec<String> {
        let text = columns(lines, units);
        text.lines().map(str::to_owned).collect()
    }

    #[test]
    fn a_unit_has_one_prefix_in_a_table_and_points_are_aligned() {
        let lines = [
            vec!["name".into(), "force".into(), "load".into()],
            vec!["a".into(), force(-3400.8), force(20.0)],
            vec!["bc".into(), force(12.5), Cell::quantity(1.25e6, "N·m")],
            vec!["d".into(), Cell::quantity(None, "N"), force(1e-12)],
        ];
        let scene = text(&lines, UnitSystem::Scene(SceneUnits::default()));
        assert_eq!(
            scene,
            [
                "name  force (kN)  load",
                "a     −3.401      0.02 kN",
                "bc     0.0125     1.25 MN·m",
                "d       –         0 kN",
            ]
        );
        let si = text(&lines, UnitSystem::Si);
        assert_eq!(si[1], "a     −3401           20 N");
    }

    #[test]
    fn units_of_the_scene_have_no_prefix() {
        let units = SceneUnits {
            length: Some(("mm", 1e-3)),
            angle: None,
        };
        let lines = [
            vec!["place".into(), "speed".into(), "angle".into()],
            vec![
                Cell::quantity(1.5, "m"),
                Cell::quantity(0.02, "m/s"),
                Cell::quantity(2e-3, "rad"),
            ],
        ];
        let all = text(&lines, UnitSystem::Scene(units));
        assert_eq!(all[0], "place (mm)  speed (mm/s)  angle (mrad)");
        assert_eq!(all[1], "1500        20            2");
    }
}
