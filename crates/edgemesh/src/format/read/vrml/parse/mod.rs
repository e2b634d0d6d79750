//! Parses a file into a tree of nodes, for both versions.
//!
//! ```text
//! bytes --unpack--> text --lexer--> tokens --parser--> DocumentBuilder --> Document
//! ```

mod decode;
mod document;
mod document_builder;
mod lexer;
mod origin;
mod parser;
mod unpack;
mod version;

pub(super) use decode::decode;
pub(super) use document::{Document, NodeKey, NodeRef, Numbers, whole};
pub(super) use origin::Origin;
pub(super) use version::Version;
