//! Random and damaged scenes, each tested with check, analyze and a short simulate. For any text,
//! the answer is a consistent result or an error with a message: no panic, no hang, no growth of
//! memory, no contradicting numbers.
//!
//! An input is a function of the seed and its number, so no input needs to be stored. Inputs are
//! tested in child processes that are supervised by their parent: stack overflows, exhausted memory
//! and endless loops are found as well as panics.
//!
//! | module | content |
//! | --- | --- |
//! | [`input`] | the text of an input |
//! | [`scenes`] | a random scene of all joints, drives, forces and functions |
//! | [`damage`] | random changes of a text |
//! | [`trial`] | one text passed to the library, and the properties that its results must have |
//! | [`watch`] | child processes that test texts, with limits of time and memory |
//! | [`campaign`] | many inputs, several at the same time, and the failures |
//! | [`minimise`] | the shortest text with the same failure |
//! | [`mod@exact`] | degenerate scenes whose answer is known by exact arithmetic, compared with that of the program |

pub mod campaign;
pub mod damage;
pub mod exact;
pub mod input;
pub mod minimise;
pub mod scenes;
pub mod trial;
pub mod watch;
