//! The conformance kit: what every planner must satisfy, whoever wrote it.
