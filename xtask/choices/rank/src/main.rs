//! Prints the rank and the dependent rows of a matrix from the standard input, one row per line.

use linalg::Matrix;
use rank::{Accuracy, components, decide};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = std::io::read_to_string(std::io::stdin())?;
    let mut rows = Vec::new();
    for line in text.lines() {
        let row: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        rows.push(row?);
    }
    let columns = rows.first().map_or(0, Vec::len);
    let decision = decide(&Matrix::from_vec(rows.len(), columns, rows.concat())?, Accuracy::Rounding)?;
    println!("rank {}, {:?}", decision.rank, decision.status);
    println!("dependent: {:?}", components(&decision).coupled);
    Ok(())
}
