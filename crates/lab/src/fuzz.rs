//! Tests random and damaged scenes. Each scene is tested with check, analyze and a short simulate.
//! For any text, the required result is a consistent answer or an error with a message. A panic, an
//! endless loop, growing memory, or contradicting values are failures.
//!
//! An input is a function of the seed and its number, so no input needs to be stored. Child
//! processes test the inputs under the supervision of a parent process. Therefore stack overflows,
//! exhausted memory and endless loops are detected, as well as panics.
//!
//! | module | content |
//! | --- | --- |
//! | [`input`] | the text of an input |
//! | [`scenes`] | a random scene of all joints, drives, forces and functions |
//! | [`damage`] | random changes of a text |
//! | [`trial`] | the run of one text through the library, with checks of the results |
//! | [`watch`] | processes that test texts, with limits of time and memory |
//! | [`campaign`] | many inputs, several at the same time, and the failures found |
//! | [`minimise`] | the shortest text with the same failure |
//! | [`passages`] | parallelograms at their singular configurations, compared with closed forms |
//! | [`forms`] | common zeros of quadratic forms, compared with a decision in integers |
//! | [`mod@exact`] | degenerate scenes, compared with exact arithmetic |
//! | [`numbers`] | random motions: whether determined values are the same in all solutions |
//! | [`space`] | mechanisms in space with planted redundancy, compared with exact arithmetic |

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
