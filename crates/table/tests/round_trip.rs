//! What is written is read again: every field, absent values, every word, in order.

mod sample;

use record::{Check, EncounterId, RunRow};
use sample::row;
use std::fs;
use table::{ParquetSink, ROW_GROUP_ROWS, TableError, column_names, find, read_rows};

fn write(path: &std::path::Path, rows: impl IntoIterator<Item = RunRow>) -> u64 {
    let mut sink = ParquetSink::create(path).expect("the folder is there");
    rows.into_iter().for_each(|row| sink.push(&row).expect("there is room"));
    sink.finish().expect("there is room")
}

#[test]
fn every_field_comes_back_in_order_over_row_groups() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("runs.parquet");
    let n = ROW_GROUP_ROWS as u64 + 700;
    let name = |j: u64| if j < 9000 { "head_on" } else { "HO, Håkon/x" };
    assert_eq!(write(&path, (0..n).map(|j| row(name(j), j))), n);
    let rows = read_rows(&path).unwrap();
    assert_eq!(rows.total(), n);
    let mut count = 0;
    for (j, read) in rows.enumerate() {
        assert_eq!(read.unwrap(), row(name(j as u64), j as u64));
        count += 1;
    }
    assert_eq!(count, n);
    let id = EncounterId::new("HO, Håkon/x", n - 1);
    assert_eq!(find(&path, &id).unwrap(), Some(row(name(n - 1), n - 1)));
    assert_eq!(find(&path, &EncounterId::new("head_on", n - 1)).unwrap(), None);
}

#[test]
fn same_rows_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (folder.path().join("a.parquet"), folder.path().join("b.parquet"));
    write(&a, (0..500).map(|j| row("head_on", j)));
    write(&b, (0..500).map(|j| row("head_on", j)));
    assert_eq!(fs::read(&a).unwrap(), fs::read(&b).unwrap());
    write(&b, (0..500).map(|j| row("head_on", j + u64::from(j == 499))));
    assert_ne!(fs::read(&a).unwrap(), fs::read(&b).unwrap());
}

#[test]
fn file_appears_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("runs.parquet");
    let mut sink = ParquetSink::create(&path).unwrap();
    (0..3).for_each(|j| sink.push(&row("head_on", j)).unwrap());
    assert_eq!(sink.len(), 3);
    assert!(!path.exists());
    drop(sink);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    assert_eq!(write(&path, []), 0);
    assert_eq!(read_rows(&path).unwrap().count(), 0);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn columns_carry_the_names_of_the_fields() {
    let names = column_names();
    assert_eq!(names[..4], ["id", "stratum", "j", "outcome"]);
    for name in ["cpa_hull_m", "reaction", "reaction_s", "turn_status", "turn_margin"] {
        assert!(names.iter().any(|column| column == name), "{name}");
    }
    let mut unique = names.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), names.len());
    // Every field of a row is in the file: 40 plain ones, of them two in two columns (reactions),
    // the id in three, six events, and two columns for each check.
    assert_eq!(names.len(), 49 + 2 * Check::COUNT);
}

#[test]
fn what_is_not_a_table_is_refused_with_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("runs.parquet");
    let missing = read_rows(&path).unwrap_err();
    assert!(matches!(missing, TableError::Io { action: "open", .. }));
    fs::write(&path, "not a table of runs").unwrap();
    let message = read_rows(&path).unwrap_err().to_string();
    assert!(message.contains("runs.parquet"), "{message}");
    let nowhere = folder.path().join("none").join("runs.parquet");
    assert!(matches!(ParquetSink::create(nowhere), Err(TableError::Io { action: "create", .. })));
}

/// A damaged byte in the data is an error, or at least no panic.
#[test]
fn damage_is_no_panic() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("runs.parquet");
    write(&path, (0..200).map(|j| row("head_on", j)));
    let whole = fs::read(&path).unwrap();
    for cut in [whole.len() / 2, whole.len() - 5] {
        fs::write(&path, &whole[..cut]).unwrap();
        let outcome = read_rows(&path).and_then(|rows| rows.collect::<Result<Vec<_>, _>>());
        assert!(outcome.is_err(), "cut at {cut}");
    }
}
