#![doc = include_str!("../README.md")]
//!
//! # Code map, in the order of the data
//!
//! | module | content |
//! | --- | --- |
//! | `limits` | largest size of a text |
//! | `read` | reads the whole file, and checks it with the mechanism |
//! | `heading`, `parts` | `[scene]`; the parts of the mechanism |
//! | `section`, `names` | top-level tables; names that may occur only once |
//! | `language` | meaning of numbers: format, units, parameters |
//! | `expression`, `dimension` | evaluates a text to a number with its dimension; dimensions that a key requires |
//! | `table`, `field`, `key` | a table and its known keys; a value read as the expected type; the values that a key accepts |
//! | `space` | the differences between the plane and space |
//! | `body`, `marker`, `bodies`, `measure` | a body; named points on bodies, and references to them; all bodies; quantities between points |
//! | `element` | properties that joints and forces have in common: type, `connection`, `place`, `direction`, `arguments` |
//! | `argument_source`, `between`, `bearings` | points and axes that are taken from the table itself, from markers, or from other joints |
//! | `joint`, `drive`, `force` | joints, their drives, forces; `coupling` and `spring` are types without a definition |
//! | `joint_read`, `joint_name`, `joint_measure` | joints of the text, references to joints in other tables, and joint coordinates |
//! | `active` | items that are read but are not part of the mechanism |
//! | `function` | functions of time |
//! | `start`, `simulate`, `reactions`, `combination` | requested computations |
//! | `scene`, `source_map`, `locate` | the resulting scene, positions in the text, and positions of later errors |
//! | `plausible`, `silence` | warnings about numbers that are probably wrong; warnings that the author suppresses |
//! | `template` | the text of a scene with other numbers or other types of joints |
//! | `schema` | the format as a JSON schema, from the same keys |
//! | `diagnostic`, `mistake`, `text`, `findings`, `nearest` | problems, their kinds and codes, lines and columns, suggested names |

mod active;
mod argument_source;
mod arguments;
mod armature;
mod bearings;
mod between;
mod bodies;
mod body;
mod case;
mod combination;
mod connection;
mod contact;
mod coupling;
mod cover;
mod diagnostic;
mod dimension;
mod direction;
mod drive;
mod element;
mod expression;
mod field;
mod findings;
mod force;
mod function;
mod heading;
mod joint;
mod joint_measure;
mod joint_name;
mod joint_read;
mod key;
mod language;
mod limits;
mod locate;
mod marker;
mod measure;
mod mistake;
mod names;
mod nearest;
mod parts;
mod place;
mod plausible;
mod reactions;
mod read;
mod scene;
mod schema;
mod section;
mod silence;
mod simulate;

mod source_map;
mod space;
mod spring;
mod start;
mod stiffness;
mod table;
mod template;
mod text;
mod tolerance;
mod units;

pub use case::{LoadCase, Setting};
pub use combination::{Combination, CombinationError, CombinationProblem, Term, WrenchTerm};
pub use cover::Cover;
pub use diagnostic::{Diagnostic, Label, Severity};
pub use language::Units;
pub use nearest::{ELSEWHERE, nearest};
pub use reactions::{
    GroupContent, GroupRequest, Output, OutputUnits, PlotRequest, PrintStyle, WantedBounds,
    WantedReactions,
};
pub use read::{read, read_and_build};
pub use scene::{Inactive, Scene};
pub use schema::schema;
pub use source_map::{Entry, SourceMap};
pub use stiffness::CentreOfStiffness;
pub use template::{KeyError, RetypedJoint, Shift, Template, at_rest, in_motion, posed, retyped};
pub use text::SourceText;
pub use units::{WithUnit, in_si};
