//! Tests values of reactions, and their verdicts, on motions. Random mechanisms with redundant
//! constraints move. The values that the product reports as determined are compared with solutions
//! of an independent dense solver at the same states.
//!
//! - (a) A determined value is the same in all solutions: without the rows of random admissible
//!   sets, with elastic joints of random compliance, and in separate runs with other redundant
//!   rows.
//! - (b) A value that is not determined differs between two of these solutions, or it has a
//!   component in the left null space and no load acts along this component.
//! - (c) If one datum changes by 1e-4 of the size, a determined value changes by less than 12 % if
//!   it is not ill-determined, and by more than 8 % if it is ill-determined.
//! - (d) An independent Newton step finds no motion of a rejected mechanism.
//!
//! | module | content |
//! | --- | --- |
//! | [`scenes`] | random mechanisms |
//! | [`run`] | runs of the product |
//! | [`verdicts`] | the verdicts of the product on a run |
//! | [`forms`] | components of reactions as forms of the multipliers |
//! | [`oracle`] | reference solver: all solutions at a state |
//! | [`sets`] | solutions for sets of deleted rows and for compliances |
//! | `decomposition` | singular values and vectors |
//! | `newton`, `displaced` | data that are displaced one at a time |
//! | [`moves`] | independent test whether a mechanism moves |
//! | `refusals` | reasons why mechanisms are rejected |
//! | [`examine`](mod@examine) | one mechanism |
//! | [`findings`] | kinds of disagreements, and counts |
//! | [`tally`] | many mechanisms |

mod decomposition;
mod displaced;
pub mod examine;
pub mod findings;
pub mod forms;
pub mod moves;
mod newton;
pub mod oracle;
mod refusals;
pub mod run;
pub mod scenes;
mod second_order;
pub mod sets;
pub mod tally;
pub mod verdicts;
