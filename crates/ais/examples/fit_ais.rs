//! Fits a file without building the product: prints the report.
//!
//! `cargo run --release -p ais --example fit_ais -- FILE.csv`

use ais::document::{model, report};
use record::Seed;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("name a file of AIS reports")?;
    let mut rows = ais::read(&std::fs::read_to_string(&path)?)?;
    let tracks = ais::tracks(&rows.reports, &mut rows.rejected);
    let found = ais::meetings(&tracks);
    let model = model(&tracks, &found, Seed(1));
    let name = std::path::Path::new(&path).file_name().unwrap_or_default().to_string_lossy();
    print!("{}", report(&name, &rows, &tracks, &found, &model));
    Ok(())
}
