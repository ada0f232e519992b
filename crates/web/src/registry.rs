//! The joints and forces that a scene may use.

use std::sync::LazyLock;

use pfaff::model::Registry;

/// The joints and forces of the program.
pub(crate) static REGISTRY: LazyLock<Registry> = LazyLock::new(Registry::standard);
