//! Evidence packs: `finished result -> folder that an assessor can check without us`.
//!
//! A pack is a function of the result and of the tool that made it: [`Gathered`] reads the rows
//! once, [`derive`] makes every derived file from them, [`seal`] hashes them. A verifier does the
//! same again and compares bytes ([`compare`]), after [`inspect`] has found every file whole. Only
//! the files named in [`VOLATILE`] may differ between two packs of one result.
#![forbid(unsafe_code)]

mod argument;
mod claims;
mod dnv;
mod error;
mod files;
mod gathered;
mod geojson;
mod inspect;
mod metadata;
mod pack;
mod page;
mod sbom;
mod seal;
mod signature;

pub use error::EvidenceError;
pub use files::{read_all, sha256_hex};
pub use gathered::Gathered;
pub use inspect::{Problem, compare, inspect};
pub use pack::{Files, PackInput, RESULT, derive};
pub use seal::{MANIFEST, Manifest, STATEMENT, VOLATILE, seal, statement};
pub use signature::{SIGNATURE, SIGNATURE_COMMENT, SignatureState, check_signature, sign};
