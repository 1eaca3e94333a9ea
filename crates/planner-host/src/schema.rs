//! The JSON Schema of every message, made from the types in [`crate::wire`].
//!
//! The committed files in `schema/` are what authors read; `tests/schema.rs` says when they are not
//! current, and `cargo run --package planner-host --example schema` writes them.

use crate::wire;
use schemars::{JsonSchema, generate::SchemaSettings};

/// (file name, text) of every message, requests of the bench first.
pub fn all() -> Vec<(&'static str, String)> {
    vec![
        ("hello-request.json", text::<wire::HelloRequest>(true)),
        ("hello.json", text::<wire::Hello>(false)),
        ("reset.json", text::<wire::Reset>(true)),
        ("ready.json", text::<wire::Ready>(false)),
        ("plan.json", text::<wire::Plan<'static>>(true)),
        ("order.json", text::<wire::OrderAnswer>(false)),
    ]
}

/// A message of the bench is described as it is written, an answer as it is read.
fn text<T: JsonSchema>(is_written: bool) -> String {
    let settings = SchemaSettings::draft2020_12();
    let settings = if is_written { settings.for_serialize() } else { settings.for_deserialize() };
    let schema = settings.into_generator().into_root_schema_for::<T>();
    let mut text =
        serde_json::to_string_pretty(&schema).expect("a schema is plain JSON and can be written");
    text.push('\n');
    text
}
