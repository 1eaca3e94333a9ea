//! What a row costs on its way into the table and out of it again:
//! `cargo run --config .cargo/optimised.toml -p table --example table_cost`.
//!
//! Microseconds of this thread's processor for a row, and bytes of the file, over five whole row
//! groups. The rows follow a pattern, so they pack better than those of a campaign.

#[path = "../tests/sample/mod.rs"]
mod sample;

use record::EncounterId;
use std::error::Error;
use table::{ParquetSink, ROW_GROUP_ROWS, find, read_rows};

const ROWS: u64 = 5 * ROW_GROUP_ROWS as u64;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("runs.parquet");
    let rows: Vec<_> = (0..ROWS).map(|j| sample::row("head_on", j)).collect();
    let (write_us, written) = timed_us(|| {
        let mut sink = ParquetSink::create(&path)?;
        rows.iter().try_for_each(|row| sink.push(row))?;
        sink.finish()
    });
    let bytes = std::fs::metadata(&path)?.len();
    let each = |us: f64| us / ROWS as f64;
    println!("write {:.2} us, {} bytes a row ({} rows)", each(write_us), bytes / ROWS, written?);
    let (read_us, read) = timed_us(|| -> Result<usize, Box<dyn Error>> {
        let mut same = 0;
        for (row, wanted) in read_rows(&path)?.zip(&rows) {
            same += usize::from(row? == *wanted);
        }
        Ok(same)
    });
    println!("read  {:.2} us a row ({} as written)", each(read_us), read?);
    let (find_us, found) = timed_us(|| find(&path, &EncounterId::new("head_on", ROWS - 1)));
    println!("find  {:.2} ms the last row ({})", find_us / 1e3, found?.is_some());
    Ok(())
}

fn timed_us<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let before_us = clock_us();
    let done = work();
    (clock_us() - before_us, done)
}

/// Time that this thread had a processor; the machine may be busy with other work.
fn clock_us() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let ns: f64 = text.split(' ').next().and_then(|ns| ns.parse().ok()).unwrap_or(f64::NAN);
    ns * 1e-3
}
