//! A number and its verdict, on motions: random mechanisms with redundant constraints move, and
//! what the product calls determined is compared with solutions that an own dense solver finds at
//! the same states.
//!
//! - (a) What is called determined is the same in all solutions: without the rows of random
//!   admissible sets, with elastic joints of random compliance, and in separate runs of the product
//!   that drop other rows.
//! - (b) What is called a matter of choice differs between two of these, or lies in the left null
//!   space where no load reaches it.
//! - (c) What is determined and not fragile changes by less than 12 % where one datum moves by 1e-4
//!   of the size; what is fragile changes by more than 8 %.
//! - (d) What is refused does not move by an own Newton step.
//!
//! | module | content |
//! | --- | --- |
//! | [`scenes`] | random mechanisms |
//! | [`run`] | runs of the product |
//! | [`verdicts`] | what the product calls determined on a run |
//! | [`forms`] | components of reactions as forms of the multipliers |
//! | [`oracle`] | all solutions at a state |
//! | [`sets`] | rows to drop, compliances, and the solutions that belong to them |
//! | `decomposition` | singular values and vectors |
//! | `newton`, `displaced` | data that are displaced one at a time |
//! | [`moves`] | own steps |
//! | `refusals` | reasons of refusals |
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
