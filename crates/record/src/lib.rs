//! The spine: plain data that every stage reads or writes.
//!
//! `Encounter -> Trace -> Verdict -> RunRow`, with the identity of an encounter, its random
//! streams and the digest of its trace. No stage hides state of its own in here.
#![forbid(unsafe_code)]

pub mod check;
pub mod digest;
pub mod encounter;
pub mod id;
pub mod outcome;
pub mod row;
pub mod sensing;
pub mod stream;
pub mod trace;
pub mod verdict;
mod way;
pub mod weather;

pub use check::Check;
pub use digest::{Digest, RootDigest};
pub use encounter::{
    Asked, Conduct, DistanceKind, Encounter, Intent, Manner, Motion, OwnShip, RunLimits, RunUntil,
    Target, Turn, Vessel, Visibility, Waypoint,
};
pub use geom::EncounterClass;
pub use id::EncounterId;
pub use outcome::Outcome;
pub use row::{CheckCell, RunRow};
pub use sensing::{Ais, AisRadar, Radar, Sensing, Tracker};
pub use stream::{Purpose, Seed, Stream, Streams};
pub use trace::{
    Alert, Contact, ContactWith, LastInstant, LastMinute, Nominal, Order, Pair, PairMinimum,
    PlannerEvents, Ship, ShipTrack, Stopping, Trace,
};
pub use verdict::{
    Evidence, Judgement, PairFacts, Reaction, Role, StageClock, Status, Unit, Verdict,
};
pub use weather::{Fluctuation, Waves, Weather, Wind};
