//! The equations of the robot as straight-line code, on the rows that are kept where nobody asks for
//! others. Written by `cargo xtask codegen --scene`; a test compares it with its scene.

#[rustfmt::skip]
pub mod automatic;
