//! A switch that determines whether the monitors of a run are compiled. The monitors check
//! redundant rows, residuals and energy, the distance of output rows from the path of their step,
//! and generated code. The monitors also predict singular configurations and exchange independent
//! rows.
//!
//! The monitors are always compiled, except in the build that measures their cost:
//! `cargo xtask guards` compiles with `--cfg pfaff_unguarded`.

/// Whether the monitors are compiled.
pub(crate) const GUARDED: bool = !cfg!(pfaff_unguarded);
