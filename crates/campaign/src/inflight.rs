//! Which encounters are being run at this moment, in a form that survives the engine process.
//!
//! Each worker has a slot of 16 bytes in a file: the part's stratum and the encounter's number,
//! written before the encounter starts. The file's pages outlive a crash, so the supervisor knows
//! whom to suspect. Inside the process the slot also counts planner calls, so that a watchdog can
//! tell a long run from a call that does not return.

use crate::Error;
use std::fs::{File, OpenOptions};
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

const SLOT_BYTES: u64 = 16;
const IDLE: u64 = u64::MAX;

/// The slots of all workers.
#[derive(Debug)]
pub struct InFlight {
    file: File,
    slots: Vec<Slot>,
}

/// One worker's slot.
#[derive(Debug, Default)]
pub struct Slot {
    /// Raised before and after every planner call: odd while the planner is thinking.
    pub beat: Arc<AtomicU64>,
}

/// A suspect: index of the stratum, and j.
pub type Suspect = (u32, u64);

impl InFlight {
    /// Makes the file afresh, with every slot idle.
    pub fn create(path: &Path, workers: usize) -> Result<Self, Error> {
        let file = OpenOptions::new()
            .create(true)
            .write(true)
            .truncate(true)
            .open(path)
            .map_err(Error::io("write", path))?;
        let this = Self { file, slots: (0..workers).map(|_| Slot::default()).collect() };
        for worker in 0..workers {
            this.write(worker, IDLE, IDLE).map_err(Error::io("write", path))?;
        }
        Ok(this)
    }

    fn write(&self, worker: usize, stratum: u64, j: u64) -> std::io::Result<()> {
        let mut bytes = [0; SLOT_BYTES as usize];
        bytes[..8].copy_from_slice(&stratum.to_le_bytes());
        bytes[8..].copy_from_slice(&j.to_le_bytes());
        self.file.write_all_at(&bytes, worker as u64 * SLOT_BYTES)
    }

    /// Notes that a worker starts an encounter. A failure to note it is not fatal: it only makes
    /// a later crash harder to explain.
    pub fn begin(&self, worker: usize, stratum: u32, j: u64) {
        drop(self.write(worker, u64::from(stratum), j));
        // back to even, also after a planner call that ended in a panic
        let beat = &self.slots[worker].beat;
        if beat.load(Ordering::Relaxed) % 2 == 1 {
            beat.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Notes that a worker is idle.
    pub fn end(&self, worker: usize) {
        drop(self.write(worker, IDLE, IDLE));
    }

    /// A worker's slot.
    pub fn slot(&self, worker: usize) -> &Slot {
        &self.slots[worker]
    }

    /// Every slot.
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    /// Who was being run when the process ended.
    pub fn suspects(path: &Path) -> Result<Vec<Suspect>, Error> {
        let bytes = std::fs::read(path).map_err(Error::io("read", path))?;
        let word = |b: &[u8]| b.iter().rev().fold(0u64, |sum, &byte| sum << 8 | u64::from(byte));
        Ok(bytes
            .chunks_exact(SLOT_BYTES as usize)
            .map(|slot| (word(&slot[..8]), word(&slot[8..])))
            .filter(|&(stratum, _)| stratum != IDLE)
            .map(|(stratum, j)| (stratum as u32, j))
            .collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suspects_are_those_begun_and_not_ended() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("inflight");
        let inflight = InFlight::create(&path, 3).unwrap();
        inflight.begin(0, 2, 77);
        inflight.begin(1, 0, 5);
        inflight.end(0);
        inflight.begin(2, 1, 1_000_000);
        assert_eq!(InFlight::suspects(&path).unwrap(), vec![(0, 5), (1, 1_000_000)]);
    }
}
