//! All tests that need more than one crate, in one binary.

mod allocations;
mod deletions;
mod robot_trolley;
mod singular_passages;
mod three_cranks;
mod tidy;
mod verdict_catalogue;
