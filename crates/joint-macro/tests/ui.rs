//! Definitions with one error each; the compiler must report the error at the correct position.
//! After a change of a message, run `TRYBUILD=overwrite cargo test -p pfaff-joint-macro --test ui`
//! and check the difference.

#[test]
fn a_wrong_definition_is_a_compile_error_at_the_wrong_token() {
    trybuild::TestCases::new().compile_fail("tests/ui/*.rs");
}
