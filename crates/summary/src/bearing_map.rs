//! Where on the compass, and against how fast a target, encounters fail.

use geom::{units, wrap};
use record::RunRow;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Sectors of relative bearing, 15 degrees each, the first centred on the bow, then clockwise.
/// Borders lie at 7.5 + 15 k degrees, so 22.5 and 112.5 (Rule 13(b)) are borders.
pub const BEARING_SECTORS: u8 = 24;

/// Bands of the speed ratio (target's speed over own), 0.25 wide; the last one is open.
pub const RATIO_BANDS: u8 = 13;

const SECTOR_DEG: f64 = 360.0 / BEARING_SECTORS as f64;
const BAND: f64 = 0.25;

/// A cell of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct CellKey {
    /// Sector of relative bearing at the start, 0 to [`BEARING_SECTORS`] - 1.
    pub sector: u8,
    /// Band of the speed ratio at the start, 0 to [`RATIO_BANDS`] - 1.
    pub band: u8,
}

impl CellKey {
    /// The cell of a relative bearing (radians) and a speed ratio.
    pub fn new(beta_rad: f64, ratio: f64) -> Self {
        let beta_deg = units::to_deg(wrap(beta_rad));
        let sector = (beta_deg / SECTOR_DEG + 0.5).floor() as i64;
        let band = (ratio / BAND).floor().clamp(0.0, f64::from(RATIO_BANDS - 1));
        Self { sector: sector.rem_euclid(i64::from(BEARING_SECTORS)) as u8, band: band as u8 }
    }

    /// Centre of the sector, degrees in (-180, 180].
    pub fn bearing_deg(self) -> f64 {
        let bearing = f64::from(self.sector) * SECTOR_DEG;
        if bearing > 180.0 { bearing - 360.0 } else { bearing }
    }

    /// Lower and upper end of the band; the last has no upper end.
    pub fn ratio(self) -> (f64, Option<f64>) {
        let lower = f64::from(self.band) * BAND;
        (lower, (self.band + 1 < RATIO_BANDS).then_some(lower + BAND))
    }
}

/// Counts of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cell {
    /// Encounters.
    pub n: u64,
    /// Collisions among them.
    pub collisions: u64,
    /// Collision, safety radius broken, or outcome unknown.
    pub failures: u64,
}

/// Counts over relative bearing and speed ratio of the first target at the start.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct BearingMap {
    /// Occupied cells, in order.
    cells: Vec<(CellKey, Cell)>,
}

impl BearingMap {
    /// Adds a run; one without a target, or with own ship stopped, has no place on the map.
    pub fn add(&mut self, row: &RunRow) {
        let (Some(beta_rad), Some(target_mps)) = (row.beta_rad, row.target_speed_mps) else {
            return;
        };
        let ratio = target_mps / row.own_speed_mps;
        if !ratio.is_finite() || !beta_rad.is_finite() {
            return;
        }
        let cell = self.cell_mut(CellKey::new(beta_rad, ratio));
        cell.n += 1;
        cell.collisions += u64::from(row.collided());
        cell.failures += u64::from(row.collided() || row.safety_radius_broken || row.unknown);
    }

    /// Adds another map.
    pub fn merge(&mut self, other: &Self) {
        for &(key, add) in &other.cells {
            let cell = self.cell_mut(key);
            cell.n += add.n;
            cell.collisions += add.collisions;
            cell.failures += add.failures;
        }
    }

    /// The occupied cells.
    pub fn cells(&self) -> BTreeMap<CellKey, Cell> {
        self.cells.iter().copied().collect()
    }

    fn cell_mut(&mut self, key: CellKey) -> &mut Cell {
        let at = match self.cells.binary_search_by_key(&key, |entry| entry.0) {
            Ok(at) => at,
            Err(at) => {
                self.cells.insert(at, (key, Cell::default()));
                at
            }
        };
        &mut self.cells[at].1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::units::deg;

    #[test]
    fn sectors_are_centred_on_the_bow() {
        let sector = |bearing: f64| CellKey::new(deg(bearing), 1.0).sector;
        assert_eq!((sector(0.0), sector(7.4), sector(-7.4)), (0, 0, 0));
        assert_eq!((sector(7.6), sector(-7.6)), (1, 23));
        assert_eq!((sector(112.4), sector(112.6)), (7, 8));
        assert_eq!((sector(180.0), sector(-179.0)), (12, 12));
        for number in 0..BEARING_SECTORS {
            let key = CellKey { sector: number, band: 0 };
            assert_eq!(sector(key.bearing_deg()), number);
        }
    }

    #[test]
    fn the_last_band_is_open() {
        let band = |ratio: f64| CellKey::new(0.0, ratio).band;
        assert_eq!((band(0.0), band(0.24), band(0.25), band(2.99)), (0, 0, 1, 11));
        assert_eq!((band(3.0), band(99.0)), (12, 12));
        assert_eq!(CellKey::new(0.0, 99.0).ratio(), (3.0, None));
        assert_eq!(CellKey::new(0.0, 0.3).ratio(), (0.25, Some(0.5)));
    }
}
