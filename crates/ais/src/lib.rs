//! From AIS reports to encounters and the distributions that describe them.
//!
//! `FILE.csv -> rows -> tracks -> encounters -> laws`, a module for each step. What is left out on
//! the way is counted with its reason. Nothing here is part of a campaign: what comes out is a
//! campaign file.
#![forbid(unsafe_code)]

pub mod columns;
pub mod document;
pub mod fit;
pub mod meetings;
pub mod model_file;
mod neighbours;
pub mod read;
pub mod replay;
pub mod time;
pub mod tracks;

pub use columns::{Columns, ColumnsError};
pub use fit::{Fitted, Form, fit};
pub use meetings::{Found, Meeting, meetings};
pub use read::{Counted, Report, Rows, read};
pub use tracks::{Track, tracks};
