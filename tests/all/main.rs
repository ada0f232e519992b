//! All tests that need more than one crate, in one binary.

mod allocations;
mod choices;
mod granularity;
mod robot_trolley;
mod singular_passages;
mod three_cranks;
mod tidy;
mod verdict_catalogue;
