//! All tests that need more than one crate, in one binary.

mod allocations;
mod along_motion;
mod choices;
mod deletions;
mod existence;
mod generic;
mod granularity;
mod robot_trolley;
mod second_order;
mod singular_passages;
mod three_cranks;
mod tidy;
mod verdict_catalogue;
