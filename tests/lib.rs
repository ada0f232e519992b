//! Mechanisms that several tests use, built with the library alone. Test data live beside this crate; the tests
//! are in `all/`.

pub mod robot;
