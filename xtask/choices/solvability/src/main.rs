//! Prints the rows with unique multipliers of a matrix from the standard input, one row per line.

use linalg::Matrix;
use solvability::Solvability;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = std::io::read_to_string(std::io::stdin())?;
    let mut rows = Vec::new();
    for line in text.lines() {
        let row: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        rows.push(row?);
    }
    let columns = rows.first().map_or(0, Vec::len);
    let c = Matrix::from_vec(rows.len(), columns, rows.concat())?;
    let solvability = Solvability::of(&c, rank::Accuracy::Rounding)?;
    for i in 0..c.nrows() {
        println!("row {}: {:?}", i + 1, solvability.row(i)?);
    }
    Ok(())
}
