//! Whether the monitors of a run are compiled. They monitor redundant rows, residuals and energy,
//! output rows far from the path of their step, the prediction of singular configurations, the
//! exchange of independent rows, and generated code.
//!
//! The monitors are always compiled, except in the build that measures their cost:
//! `cargo xtask guards` compiles with `--cfg pfaff_unguarded`.

/// Whether the monitors are compiled.
pub(crate) const GUARDED: bool = !cfg!(pfaff_unguarded);
