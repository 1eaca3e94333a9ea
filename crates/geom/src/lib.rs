//! Frames, angles, CPA, hull outlines and deterministic maths
#![forbid(unsafe_code)]
