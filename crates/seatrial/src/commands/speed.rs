//! `speed`: encounters per second, the floor, and the share of each stage.
