//! Stiff and extreme cases, each with its right answer: a bound with its source, or the error that
//! has to come. What is right comes from closed forms, published values, another derivation or
//! exact arithmetic, never from the code that is judged.
//!
//! ```
//! use std::num::NonZeroUsize;
//! let family = lab::stress::find("trivial").unwrap();
//! let rows = lab::stress::run(&[family], NonZeroUsize::MIN, &|| false, |_| {});
//! let tally = report::stress::Tally::of(rows.iter().map(|row| row.judgement));
//! assert_eq!(tally.silently_wrong, 0);
//! ```
//!
//! | module | content |
//! | --- | --- |
//! | [`mod@case`] | a case with its right answer; a family of cases |
//! | [`mod@judge`] | what is to be thought of an outcome |
//! | [`mod@run`] | many cases on some threads, each with a time limit |
//! | [`motion`] | scenes to the last row of their motion, by every method |
//! | [`mod@families`] | the list of families, each in a file of its own |

pub mod case;
pub mod families;
pub mod judge;
pub mod motion;
pub mod run;

pub use case::{Case, Expected, Family, Outcome};
pub use families::{families, find};
pub use judge::judge;
pub use run::run;
