//! All properties of all definitions, and that the harness can fail.

mod mutants;

use joints::conformance::check_all;

/// Any number does; this one is fixed so that a failure can be repeated.
const SEED: u64 = 2013;

#[test]
fn every_definition_has_every_property() {
    if let Err(failure) = check_all(SEED) {
        panic!("{failure}");
    }
}
