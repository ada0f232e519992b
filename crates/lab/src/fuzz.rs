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
//! | [`damage`] | what is done to a text |
//! | [`trial`] | one text through the library, and what must hold of what comes out |
//! | [`watch`] | processes that try texts, with limits of time and memory |
//! | [`campaign`] | many inputs, several at the same time; what was found |
//! | [`minimise`] | the shortest text that still fails alike |
//! | [`passages`] | parallelograms through their flat poses, against closed forms |
//! | [`forms`] | quadratic forms: common zeros, against a decision in whole numbers |
//! | [`mod@exact`] | degenerate scenes whose answer exact arithmetic knows: does the program give it? |
//! | [`numbers`] | random motions: are numbers that are called determined the same in all solutions? |
//! | [`space`] | mechanisms in space with planted redundancy, and what exact arithmetic says of them |

pub mod campaign;
pub mod damage;
pub mod exact;
pub mod forms;
pub mod input;
pub mod minimise;
pub mod numbers;
pub mod passages;
pub mod scenes;
pub mod space;
pub mod trial;
pub mod watch;
