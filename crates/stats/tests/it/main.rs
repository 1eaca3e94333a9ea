//! Tests of the crate from outside: known answers, coverage and false alarms by simulation.

mod coverage;
mod edges;
mod eprocess;
mod gate;
mod gate_answers;
mod generator;
mod known;
mod simulation;
mod values;
