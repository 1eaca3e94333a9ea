//! Tests of the crate from outside: known answers, coverage and false alarms by simulation.

mod coverage;
mod eprocess;
mod gate;
mod generator;
mod simulation;
mod values;
