//! All tests that need more than one crate, in one binary.

mod allocations;
mod along_motion;
mod bad_matrices;
mod cases;
mod choices;
mod constrained_methods;
mod deletions;
mod exact_oracle;
mod existence;
mod formulations;
mod generic;
mod granularity;
mod independent_coordinates;
mod invariance;
mod long_runs;
mod nearly_redundant;
mod plain;
mod planted_matrices;
mod planted_mechanisms;
mod robot_trolley;
mod second_order;
mod singular_passages;
mod tally;
mod three_cranks;
mod tidy;
mod verdict_catalogue;
