//! The command `pfaff` with the standard joints and forces.

use std::io;
use std::process::ExitCode;

use pfaff::model::Registry;
use pfaff_cli::{Stream, run};

fn main() -> ExitCode {
    let (out, err) = (&mut io::stdout(), &mut io::stderr());
    let arguments = std::env::args_os();
    run(
        &Registry::standard(),
        arguments,
        Stream::terminal(out),
        Stream::terminal(err),
    )
}
