//! Tests numbers with verdicts on motions: random mechanisms with redundant constraints move, and
//! the numbers that the product calls determined are compared with solutions of an independent
//! dense solver at the same states.
//!
//! - (a) A determined number is the same in all solutions: without the rows of random admissible
//!   sets, with elastic joints of random compliance, and in separate runs with other redundant
//!   rows.
//! - (b) A number that depends on the choice differs between two of these solutions, or is in the
//!   left null space without any load along it.
//! - (c) A determined number that is not ill-determined changes by less than 12 % if one datum
//!   moves by 1e-4 of the size; an ill-determined number changes by more than 8 %.
//! - (d) A rejected mechanism does not move in an independent Newton step.
//!
//! | module | content |
//! | --- | --- |
//! | [`scenes`] | random mechanisms |
//! | [`run`] | runs of the product |
//! | [`verdicts`] | the verdicts of the product on a run |
//! | [`forms`] | components of reactions as forms of the multipliers |
//! | [`oracle`] | all solutions at a state |
//! | [`sets`] | rows to delete, compliances, and their solutions |
//! | `decomposition` | singular values and vectors |
//! | `newton`, `displaced` | data that are displaced one at a time |
//! | [`moves`] | independent steps |
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
