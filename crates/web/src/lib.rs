//! `pfaff` in a browser. A page sends requests as JSON texts (module `request`) and gets replies as
//! JSON texts. Nothing in this crate lists questions, keys or codes: it asks the library.
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

mod ask;
mod cursor;
mod drag;
mod exports;
mod keys;
pub mod position;
mod request;

pub use exports::{call, reply, reserve};
pub use request::answer;
