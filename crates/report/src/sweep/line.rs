//! Lines with digests. Every line starts with a digest of the rest of the line, so that a line that
//! was truncated by a crash is recognised. A truncated line is ignored, and its run is made again.
//!
//! ```text
//! 4be1d0… {"plan":"…","runs":[1,500],"host":"node7","pid":4711,"born":8812}
//! 71ab06… begin 1 2 3
//! 09f3a7… 3,1.2,done,,dop853,10.0,…
//! ```

use std::io;

use serde::{Deserialize, Serialize};

use super::{Cell, Column, Runs};
use crate::files::process::Process;

/// The first line of a file: the plan and the runs to which its rows belong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Head {
    /// Digest of the plan.
    pub(super) plan: String,
    /// First and last run.
    pub(super) runs: (u64, u64),
    /// The process that writes the file; `None` for a finished shard, which does not contain the
    /// process.
    #[serde(flatten)]
    pub(super) by: Option<Process>,
}

impl Head {
    pub(super) fn runs(&self) -> Option<Runs> {
        Runs::new(self.runs.0, self.runs.1)
    }
}

/// A line of the text with its digest.
pub(super) fn line(text: &[u8]) -> Vec<u8> {
    let mut line = format!("{:016x} ", digest(text)).into_bytes();
    line.extend_from_slice(text);
    line.push(b'\n');
    line
}

/// Returns whether the first line of a file is intact, and all intact lines.
pub(super) fn intact(bytes: &[u8]) -> (bool, impl Iterator<Item = &[u8]>) {
    let mut lines = bytes.split_inclusive(|b| *b == b'\n').map(text);
    let first = lines.next().flatten();
    (first.is_some(), first.into_iter().chain(lines.flatten()))
}

/// The text of a line, if it is complete.
fn text(line: &[u8]) -> Option<&[u8]> {
    let (head, text) = line.strip_suffix(b"\n")?.split_at_checked(17)?;
    let written = std::str::from_utf8(head).ok()?.strip_suffix(' ')?;
    (u64::from_str_radix(written, 16).ok()? == digest(text)).then_some(text)
}

/// The content of a line, except the first line of a file.
pub(super) enum Entry {
    /// These runs start together.
    Begin(Vec<u64>),
    /// This run starts. The process makes no other run until it is finished.
    Alone(u64),
    /// The process ended the attempt intentionally. The started runs did not cause the end.
    End,
    /// A finished run.
    Row(u64, Vec<Cell>),
}

const BEGIN: &str = "begin";
const ALONE: &str = "alone";
const END: &str = "end";

impl Entry {
    /// The text of an entry that is not a row.
    pub(super) fn text(&self) -> Vec<u8> {
        let text = match self {
            Self::Begin(runs) => {
                let runs: Vec<String> = runs.iter().map(u64::to_string).collect();
                format!("{BEGIN} {}", runs.join(" "))
            }
            Self::Alone(run) => format!("{ALONE} {run}"),
            Self::End => END.to_owned(),
            Self::Row(_, cells) => return record(cells).unwrap_or_default(),
        };
        text.into_bytes()
    }

    /// Reads a line; rows of other runs are ignored.
    pub(super) fn read(line: &[u8], columns: &[Column], wanted: Runs) -> Option<Self> {
        if line.first().is_some_and(u8::is_ascii_digit) {
            let number = line.split(|b| *b == b',').next()?;
            let run: u64 = std::str::from_utf8(number).ok()?.parse().ok()?;
            let cells = wanted.has(run).then(|| cells(line, columns))??;
            return Some(Self::Row(run, cells));
        }
        let mut words = std::str::from_utf8(line).ok()?.split(' ');
        let word = words.next()?;
        let mut runs = words.map(|run| run.parse::<u64>().ok());
        match word {
            BEGIN => Some(Self::Begin(runs.collect::<Option<_>>()?)),
            ALONE => Some(Self::Alone(runs.next()??)),
            END => Some(Self::End),
            _ => None,
        }
    }
}

/// The text of a row.
pub(super) fn record(cells: &[Cell]) -> io::Result<Vec<u8>> {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new());
    writer.serialize(cells).map_err(io::Error::other)?;
    let mut text = writer.into_inner().map_err(|e| e.into_error())?;
    text.pop();
    Ok(text)
}

/// The cells of a row, if they match the columns.
fn cells(line: &[u8], columns: &[Column]) -> Option<Vec<Cell>> {
    let text = std::str::from_utf8(line).ok()?;
    if !text.contains('"') {
        // Most rows have no quotes. A separate CSV reader for each row would take longer than all
        // other work.
        return cells_of(text.split(','), columns);
    }
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(line);
    let record = reader.records().next()?.ok()?;
    cells_of(record.iter(), columns)
}

fn cells_of<'f>(
    mut fields: impl Iterator<Item = &'f str>,
    columns: &[Column],
) -> Option<Vec<Cell>> {
    let cells = columns
        .iter()
        .map(|column| Cell::read(fields.next()?, column.kind))
        .collect::<Option<Vec<Cell>>>()?;
    fields.next().is_none().then_some(cells)
}

/// A 64-bit digest, FNV-1a with a final mix of its bits. Different texts have different digests,
/// unless they are constructed to have the same digest.
#[must_use]
pub fn digest(bytes: &[u8]) -> u64 {
    let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    let hash = bytes.iter().fold(0xcbf2_9ce4_8422_2325, step);
    let mixed = (hash ^ (hash >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    mixed ^ (mixed >> 32)
}
