//! The contract of the crate, seen from outside: canonical form, derivatives, programs and printed
//! code.
//!
//! The references are independent of the code under test: [`tree`] keeps an expression as it was
//! written, [`running`] evaluates it on dual numbers with a bound of its rounding error,
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

/// Enough that each kind of node meets each other one; a run takes about a second.
const CASES: u32 = 1000;

fn config() -> Config {
    Config {
        max_global_rejects: CASES,
        failure_persistence: None,
        ..Config::with_cases(CASES)
    }
}
