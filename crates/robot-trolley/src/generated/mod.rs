//! The equations of the robot as straight-line code, one module for each way to eliminate its redundant rows. Written by
//! `cargo xtask codegen --scene`; a test compares them with their scene.

#[rustfmt::skip]
pub mod drop_18_21;
#[rustfmt::skip]
pub mod drop_19_21;
#[rustfmt::skip]
pub mod drop_6_21;
