//! Evidence packs: `finished result -> folder that an assessor can check without us`.
//!
//! A pack is a function of the result and of the tool that made it: [`Gathered`] reads the rows
//! once, [`derive`] makes every derived file from them, [`seal`] hashes them. A verifier does the
//! same again and compares bytes ([`compare`]), after [`inspect`] has found every file whole. Only
//! the files named in [`VOLATILE`] may differ between two packs of one result.
#![forbid(unsafe_code)]

mod argument;
mod change;
mod claims;
mod dnv;
mod dnv_output;
mod error;
mod experiment;
mod files;
mod foxglove;
mod foxglove_schema;
mod gathered;
mod geojson;
mod inspect;
mod limits;
mod mcap;
mod metadata;
mod pack;
mod page;
mod planner_files;
mod sbom;
mod seal;
mod sections;
mod signature;
mod thresholds;

pub use change::PREVIOUS;
pub use error::EvidenceError;
pub use experiment::Experiment;
pub use files::{read_all, sha256_hex};
pub use gathered::Gathered;
pub use inspect::{Problem, compare, inspect};
pub use metadata::ro_crate;
pub use pack::{Files, PackInput, RESULT, derive, from_rows};
pub use planner_files::{PLANNER, PlannerFile, PlannerFiles, planner_files, planner_of};
pub use seal::{MANIFEST, Manifest, RO_CRATE, STATEMENT, TIMING, VOLATILE, seal, statement};
pub use sections::{BENCH, BUILD, READINGS, Reading, SELF_TEST, SENSITIVITY};
pub use signature::{SIGNATURE, SIGNATURE_COMMENT, SignatureState, check_signature, sign};
