//! `cargo run --release -p tests --example book_figures` writes the figures of the book into
//! `docs/book/figures`. A test compares the existing ones with these.
#![allow(clippy::print_stdout)]

mod figures;

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .ok_or("tests/ lies in the root")?;
    for (name, svg) in figures::all(root)? {
        let path = root.join("docs/book/figures").join(name);
        std::fs::write(&path, svg)?;
        println!("{}", path.display());
    }
    Ok(())
}
