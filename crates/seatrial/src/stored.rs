//! The rows of a finished result, wherever they lie: in its table, or in the parts of its shards.

use campaign::folder::TABLE;
use campaign::parts_list::{self, PARTS_LIST};
use campaign::{Error, Plan};
use record::{EncounterId, RunRow};
use std::path::{Path, PathBuf};

/// Whether the rows of a result lie in the parts of its shards.
pub(crate) fn in_parts(result: &Path) -> bool {
    !result.join(TABLE).exists() && result.join(PARTS_LIST).exists()
}

/// Every row, in order (stratum, j).
pub(crate) fn rows(
    result: &Path,
    plan: &Plan,
) -> Result<Box<dyn Iterator<Item = Result<RunRow, Error>>>, Error> {
    if in_parts(result) {
        return Ok(Box::new(parts_list::rows(result, plan)?));
    }
    let rows = table::read_rows(result.join(TABLE)).map_err(damaged)?;
    Ok(Box::new(rows.map(|row| row.map_err(damaged))))
}

/// The row of an encounter.
pub(crate) fn find(result: &Path, plan: &Plan, id: &EncounterId) -> Result<RunRow, Error> {
    let found = if in_parts(result) {
        parts_list::find(result, plan, id)?
    } else {
        table::find(result.join(TABLE), id).map_err(damaged)?
    };
    found.ok_or_else(|| Error::input(format!("{} has no row {id}", result.display())))
}

/// The table, for what cannot do without the one file.
pub(crate) fn whole_table(result: &Path) -> Result<PathBuf, Error> {
    if in_parts(result) {
        return Err(Error::input(format!(
            "the rows of {0} lie in the parts that {PARTS_LIST} lists, and an evidence pack holds \
             one table; `seatrial merge {0}` makes it of them",
            result.display()
        )));
    }
    Ok(result.join(TABLE))
}

fn damaged(error: table::TableError) -> Error {
    Error::input(format!("failed to {error}"))
}
