//! All tests that need more than one crate, in one binary.

mod robot_trolley;
mod three_cranks;
mod verdict_catalogue;
