//! All tests that need more than one crate, in one binary.

mod allocations;
mod bad_matrices;
mod exact_oracle;
mod invariance;
mod nearly_redundant;
mod plain;
mod planted_matrices;
mod planted_mechanisms;
mod robot_trolley;
mod singular_passages;
mod tally;
mod three_cranks;
mod tidy;
mod verdict_catalogue;
