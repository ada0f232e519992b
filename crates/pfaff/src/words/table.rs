//! Tables of answers: cells with texts and quantities, units of columns, and the layout as text.

use model::words::{short, units};
use report::page::safe;

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

/// Returns the texts of a table, column by column. The first text of each column is the header. All
/// quantities of a table in the same SI unit have the same prefix. If all quantities of a column
/// have the same unit, the header contains it.
fn cells_of_table(lines: &[Vec<Cell>]) -> Vec<Vec<String>> {
    let n = lines.iter().map(Vec::len).max().unwrap_or(0);
    let lines: Vec<Vec<Cell>> = lines.iter().flat_map(|line| unfolded(line)).collect();
    let quantities = lines.iter().flatten().filter_map(|cell| match cell {
        Cell::Quantity(Some(value), unit) => Some((*value, *unit)),
        _ => None,
    });
    let scale = Scale::new(quantities);
    (0..n).map(|k| scale.column(&lines, k)).collect()
}

/// Aligns lines of cells in columns.
pub(super) fn columns(lines: &[Vec<Cell>]) -> String {
    let columns = cells_of_table(lines);
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

/// Returns a table for a page. Columns that contain words are aligned to the left.
pub(crate) fn html_table(lines: &[Vec<Cell>]) -> String {
    let columns = cells_of_table(lines);
    let is_words = |text: &String| text.trim_start().starts_with(char::is_alphabetic);
    let class = |cells: &Vec<String>| {
        let is_name = cells.iter().skip(1).any(is_words);
        if is_name { " class=\"name\"" } else { "" }
    };
    let classes = columns.iter().map(class);
    let classes: Vec<&str> = classes.collect();
    let mut out = "<div class=\"wide\"><table>\n".to_owned();
    for i in 0..columns.first().map_or(0, Vec::len) {
        let mark = if i == 0 { "th" } else { "td" };
        let cells = columns.iter().zip(&classes).map(|(column, class)| {
            let text = safe(column[i].trim());
            format!("<{mark}{class}>{text}</{mark}>")
        });
        let cells: String = cells.collect();
        out.push_str(&match i {
            0 => format!("<thead><tr>{cells}</tr></thead>\n<tbody>\n"),
            _ => format!("<tr>{cells}</tr>\n"),
        });
    }
    out + "</tbody>\n</table></div>\n"
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
    /// SI units, each with the size of its largest number.
    largest: Vec<(&'static str, f64)>,
}

impl Scale {
    /// Chooses the prefixes for these numbers in SI units.
    pub(crate) fn new(numbers: impl IntoIterator<Item = (f64, &'static str)>) -> Self {
        let mut largest: Vec<(&str, f64)> = Vec::new();
        for (value, unit) in numbers {
            let size = if value.is_finite() { value.abs() } else { 0.0 };
            match largest.iter_mut().find(|(known, _)| *known == unit) {
                Some((_, most)) => *most = most.max(size),
                None => largest.push((unit, size)),
            }
        }
        Self { largest }
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
        units().unit(self.largest(si), si)
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
    use model::words::{SceneUnits, UnitSystem, in_units};

    fn force(value: f64) -> Cell {
        Cell::quantity(value, "N")
    }

    fn text(lines: &[Vec<Cell>]) -> Vec<String> {
        let text = columns(lines);
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
        let scene = text(&lines);
        assert_eq!(
            scene,
            [
                "name  force (kN)  load",
                "a     −3.401      0.02 kN",
                "bc     0.0125     1.25 MN·m",
                "d       –         0 kN",
            ]
        );
        let si = in_units(UnitSystem::Si, || text(&lines));
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
        let all = in_units(UnitSystem::Scene(units), || text(&lines));
        assert_eq!(all[0], "place (mm)  speed (mm/s)  angle (mrad)");
        assert_eq!(all[1], "1500        20            2");
    }
}
