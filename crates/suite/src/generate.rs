//! Generates large scenes with known results. The mechanisms belong to families and can have any
//! size. The text of a scene is written in sequence.
//!
//! An [`Order`] is a request, which [`Order::generate`] checks. A [`Generator`] contains the known
//! results and writes the scene. Equal requests result in identical files. This module reads no
//! scene and computes no motion.
//!
//! | module | content |
//! | --- | --- |
//! | `order` | requests, and the size of their scenes |
//! | `answer` | counts, ranks, and which reactions are not determined |
//! | `family` | the common interface of the families |
//! | [`n_four_bar`], `parallelograms`, `lattice`, `fleet`, `random` | the families, each with the derivation of its results |
//! | `text`, `points`, `share` | a scene as text; points and directions; cells distributed evenly |

mod answer;
mod family;
mod fleet;
mod lattice;
pub mod n_four_bar;
mod order;
mod parallelograms;
mod points;
mod random;
mod share;
#[cfg(test)]
mod tests;
mod text;

pub use answer::{Answer, Free, FreeReaction};
pub use order::{GenerateError, Generator, Kind, LARGEST, Order};
