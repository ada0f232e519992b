//! The problems: two mechanisms on independent rows, one orbit, one stiff reaction.

pub mod arenstorf;
pub mod mechanism;
pub mod robertson;
