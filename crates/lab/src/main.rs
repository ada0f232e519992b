//! The command `lab`.

use std::io;
use std::process::ExitCode;

use pfaff::model::Registry;
use pfaff_cli::Stream;

fn main() -> ExitCode {
    let (out, err) = (&mut io::stdout(), &mut io::stderr());
    lab::command::run(
        &Registry::standard(),
        std::env::args_os(),
        Stream::terminal(out),
        Stream::terminal(err),
    )
}
