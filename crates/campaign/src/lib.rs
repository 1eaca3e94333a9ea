//! From a campaign file to rows: the file, the plan, the engine process and its supervisor, parts
//! on disk, replay.
//!
//! Read [`pipeline`] first: it calls every stage in order.
#![forbid(unsafe_code)]

pub mod avoidable;
pub mod cases;
mod differences;
pub mod engine;
pub mod error;
pub mod folder;
pub mod inflight;
pub mod judges;
pub mod last_minute;
pub mod part;
pub mod parts_list;
pub mod pipeline;
pub mod plan;
pub mod rejudge;
pub mod row;
pub mod shards;
pub mod spec;
pub mod supervisor;
pub mod worker;

pub use error::Error;
pub use folder::Folder;
pub use pipeline::{Finished, PartRead, RowSink, finish, run_parts};
pub use plan::{Plan, Source};
pub use spec::{CampaignFile, Overrides};
