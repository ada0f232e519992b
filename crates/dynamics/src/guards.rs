//! Whether the monitors of a run are compiled in: dropped rows, residuals and energy, rows of
//! output far from the path of their step, the prediction of singular configurations, the exchange
//! of kept rows, and the checks of generated code.
//!
//! Always, except in the build that measures their cost: `cargo xtask guards` compiles with
//! `--cfg pfaff_unguarded`.

/// Whether the monitors are compiled in.
pub(crate) const GUARDED: bool = !cfg!(pfaff_unguarded);
