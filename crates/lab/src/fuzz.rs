//! Random and damaged scenes, each through check, analyze and a short simulate. Whatever the text,
//! the answer is a result whose numbers fit together or an error by name: no panic, no hang, no
//! growth of memory, no number that contradicts another.
//!
//! An input is a function of the seed and its number, so nothing has to be stored. Each is tried in
//! a process of its own kind, which its parent watches: an overflow of the stack, an exhausted
//! memory and an endless loop are found as panics are.
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
//! | [`mod@exact`] | degenerate scenes whose answer exact arithmetic knows: does the program give it? |

pub mod campaign;
pub mod damage;
pub mod exact;
pub mod input;
pub mod minimise;
pub mod passages;
pub mod scenes;
pub mod trial;
pub mod watch;
