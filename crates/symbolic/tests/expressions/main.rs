//! Tests the guarantees of the crate through its public interface: canonical form, derivatives,
//! programs and printed code.
//!
//! The references are independent of the code under test. [`tree`] stores an expression as it was
//! written, [`running`] evaluates it on dual numbers with a bound of its rounding error, and
//! [`interpreter`] runs printed code from its text.

mod canonical;
mod counts;
mod derivatives;
mod interpreter;
mod printing;
mod running;
mod simplification;
mod substitution;
mod tree;

use proptest::test_runner::Config;

/// Enough cases that each kind of node is combined with each other one; a run takes about a second.
const CASES: u32 = 1000;

fn config() -> Config {
    Config {
        max_global_rejects: CASES,
        failure_persistence: None,
        ..Config::with_cases(CASES)
    }
}
