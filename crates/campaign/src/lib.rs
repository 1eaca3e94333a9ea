//! Campaign file, pipeline, parts, resume and replay
#![forbid(unsafe_code)]
