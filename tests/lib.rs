//! Test data live beside this crate; the tests are in `all/`.
