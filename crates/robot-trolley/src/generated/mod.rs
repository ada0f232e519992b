//! The equations of the robot as straight-line code, for the rows that are kept by default. Written
//! by `cargo xtask codegen --scene`; a test compares the code with its scene.

#[rustfmt::skip]
pub mod automatic;
