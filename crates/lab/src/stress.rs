//! Stiff and extreme cases with known answers. The answer of a case is an error bound with its
//! source, or the error message that must occur. The known answers come from closed forms,
//! published values, another derivation or exact arithmetic, never from the code under test.
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
//! | [`mod@case`] | a case with its known answer, and families of cases |
//! | [`mod@judge`] | whether an outcome is correct |
//! | [`mod@run`] | runs of many cases on several threads, each case with a time limit |
//! | [`motion`] | runs of scenes up to the last output row, by every method |
//! | [`mod@families`] | the list of families, each in a separate file |
//! | [`document`], `table`, `figure`, `page` | output of the outcomes, for readers and scripts |

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
