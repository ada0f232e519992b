#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | `exports` | the raw functions of the WebAssembly module |
//! | `request` | the requests and their replies |
//! | `ask` | questions about scenes, with the files of their answers |
//! | `drag` | the start with a body in another pose |
//! | `cursor` | the table and the key at a position of a scene that may be incomplete |
//! | `keys` | completion and hover, from the schema of scenes |
//! | `position` | positions in UTF-16 units, which editors count |
//! | `registry` | the joints and forces that a scene may use |

mod ask;
mod cursor;
mod drag;
mod exports;
mod keys;
pub mod position;
mod registry;
mod request;

pub use exports::{call, reply, reserve};
pub use request::answer;
