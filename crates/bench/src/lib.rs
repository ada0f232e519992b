//! Nothing to use here: see `benches/`.
