//! Writes `schema/*.json` anew: `cargo run --package planner-host --example schema`.

use std::path::Path;

fn main() -> std::io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("schema");
    for (name, text) in planner_host::schema::all() {
        std::fs::write(folder.join(name), text)?;
        println!("schema/{name}");
    }
    Ok(())
}
