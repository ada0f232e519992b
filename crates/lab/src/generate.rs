//! Large scenes whose answer is known: families of mechanisms of any size, written as text, one
//! thing after the other.
//!
//! An [`Order`] says what is wanted; [`Order::generate`] checks it; a [`Generator`] knows the
//! answer and writes the scene. Same order, same bytes. Nothing is read here, and nothing moves.
//!
//! | module | content |
//! | --- | --- |
//! | `order` | what may be asked for, and how large it would be |
//! | `answer` | counts, ranks, and which reactions are not determined |
//! | `family` | what the families have in common |
//! | [`n_four_bar`], `parallelograms`, `lattice`, `fleet`, `random` | the families, each with the reasoning behind its answer |
//! | `text`, `points`, `share` | a scene as text; points and directions; cells spread evenly |

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
