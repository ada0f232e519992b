//! Whether the monitors of a run are compiled in: dropped rows, residuals and energy, rows of
//! output beside their step, the foresight of singular configurations, the exchange of kept rows,
//! and what is checked of generated code.
//!
//! Always, but in the build that measures what they cost: `cargo xtask guards` compiles with
//! `--cfg pfaff_unguarded`.

/// Whether they are.
pub(crate) const GUARDED: bool = !cfg!(pfaff_unguarded);
