//! Where encounters come from: random strata, named sets, other tools' files
#![forbid(unsafe_code)]
