//! Tests of the integrators on problems with known solutions.

mod allocations;
mod arenstorf;
mod break_times;
mod edges;
mod events;
mod failures;
mod hook;
mod kepler;
mod order;
mod output;
mod problems;
mod radau5;
