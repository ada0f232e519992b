//! The problems: two mechanisms on kept rows, one orbit, one stiff reaction.

pub mod arenstorf;
pub mod mechanism;
pub mod robertson;
