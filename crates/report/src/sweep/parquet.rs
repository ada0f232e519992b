//! Writes a table as Parquet. Counts are INT64 with nulls, numbers are DOUBLE, and texts are UTF-8.
//! The description of the sweep is in the metadata of the file, under `pfaff.sweep`.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::{Cell, Column, Kind, SweepPlan};
use crate::tables::TableError;

/// Key of the description in the metadata.
const KEY: &str = "pfaff.sweep";

/// Writes all rows and returns the writer.
pub(super) fn write<W: Write + Send>(
    out: W,
    plan: &SweepPlan,
    columns: &[Column],
    rows: &[&[Cell]],
) -> Result<W, TableError> {
    table(out, plan, columns, rows).map_err(|e| TableError::Write {
        table: "sweep.parquet",
        source: match e {
            ParquetError::External(source) => io::Error::other(source),
            other => io::Error::other(other),
        },
    })
}

fn table<W: Write + Send>(
    out: W,
    plan: &SweepPlan,
    columns: &[Column],
    rows: &[&[Cell]],
) -> Result<W, ParquetError> {
    let fields = columns.iter().map(|c| field(c).map(Arc::new));
    let schema = Type::group_type_builder("sweep")
        .with_fields(fields.collect::<Result<_, _>>()?)
        .build()?;
    let description = serde_json::to_string(plan).map_err(|e| ParquetError::External(e.into()))?;
    let properties = WriterProperties::builder()
        .set_key_value_metadata(Some(vec![KeyValue::new(KEY.to_owned(), description)]))
        .build();
    let mut file = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    for k in 0..columns.len() {
        let Some(mut writer) = group.next_column()? else {
            break;
        };
        let cells = rows.iter().filter_map(|cells| cells.get(k));
        match columns[k].kind {
            Kind::Count => {
                let counts: Vec<Option<i64>> = cells.map(count).collect();
                let known: Vec<i64> = counts.iter().copied().flatten().collect();
                let levels: Vec<i16> = counts.iter().map(|n| i16::from(n.is_some())).collect();
                let writer = writer.typed::<Int64Type>();
                writer.write_batch(&known, Some(&levels), None)?;
            }
            Kind::Number => {
                let numbers: Vec<f64> = cells.map(number).collect();
                let writer = writer.typed::<DoubleType>();
                writer.write_batch(&numbers, None, None)?;
            }
            Kind::Text => {
                let texts: Vec<ByteArray> = cells.map(text).collect();
                let writer = writer.typed::<ByteArrayType>();
                writer.write_batch(&texts, None, None)?;
            }
        }
        writer.close()?;
    }
    group.close()?;
    file.into_inner()
}

fn field(column: &Column) -> Result<Type, ParquetError> {
    let (physical, repetition, logical) = match column.kind {
        Kind::Count => (Physical::INT64, Repetition::OPTIONAL, None),
        Kind::Number => (Physical::DOUBLE, Repetition::REQUIRED, None),
        Kind::Text => (
            Physical::BYTE_ARRAY,
            Repetition::REQUIRED,
            Some(LogicalType::String),
        ),
    };
    Type::primitive_type_builder(&column.name, physical)
        .with_repetition(repetition)
        .with_logical_type(logical)
        .build()
}

fn count(cell: &Cell) -> Option<i64> {
    match cell {
        Cell::Count(n) => n.and_then(|n| i64::try_from(n).ok()),
        _ => None,
    }
}

fn number(cell: &Cell) -> f64 {
    match cell {
        Cell::Number(x) => *x,
        _ => f64::NAN,
    }
}

fn text(cell: &Cell) -> ByteArray {
    match cell {
        Cell::Text(text) => text.as_str().into(),
        _ => ByteArray::new(),
    }
}
