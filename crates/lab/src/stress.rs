//! Stiff and extreme cases, each with its right answer: a bound with its source, or the error that
//! has to come. What is right comes from closed forms, published values, another derivation or
//! exact arithmetic, never from the code that is judged.
//!
//! ```
//! use std::num::NonZeroUsize;
//! let family = lab::stress::find("trivial").unwrap();
//! let rows = lab::stress::run(&[family], NonZeroUsize::MIN, &|| false, |_| {});
//! let tally = lab::stress::Tally::of(rows.iter().map(|row| row.judgement));
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
//! | [`document`], `table`, `figure`, `page` | what came out, for readers and scripts |

pub mod case;
pub mod document;
pub mod families;
mod figure;
pub mod judge;
pub mod motion;
mod page;
pub mod run;
mod table;

pub use case::{Case, Expected, Family, Outcome};
pub use document::{Judgement, StressDocument, StressFamily, StressRow, Tally};
pub use families::{families, find};
pub use figure::extremes;
pub use judge::judge;
pub use page::stress_page;
pub use run::run;
pub use table::StressTable;
