//! The spine, plain data: encounter, trace, verdict, row, digest
#![forbid(unsafe_code)]
