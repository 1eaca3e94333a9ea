//! Rows that need not be run twice: the same planner in the same build gives the same bits.

use crate::arm::{Arm, ArmRow};
use campaign::Error;
use std::cell::RefCell;
use std::rc::Rc;

/// The rows that were asked for last.
type Block = Rc<RefCell<Vec<ArmRow>>>;

/// An arm whose last rows others may have.
#[derive(Debug)]
pub struct Heard<A> {
    /// The arm that runs.
    pub arm: A,
    block: Block,
}

/// An arm that runs nothing: it says what another one has just said. For a planner that stands in
/// two places of one gate, such as a release that is the baseline too.
#[derive(Debug)]
pub struct Echo {
    block: Block,
}

impl<A: Arm> Heard<A> {
    /// Of an arm.
    pub fn new(arm: A) -> Self {
        Self { arm, block: Block::default() }
    }

    /// An arm that says the same.
    pub fn echo(&self) -> Echo {
        Echo { block: Rc::clone(&self.block) }
    }
}

impl<A: Arm> Arm for Heard<A> {
    fn rows(&mut self, ids: &[u64]) -> Result<Vec<ArmRow>, Error> {
        let rows = self.arm.rows(ids)?;
        self.block.borrow_mut().clone_from(&rows);
        Ok(rows)
    }
}

impl Arm for Echo {
    fn rows(&mut self, ids: &[u64]) -> Result<Vec<ArmRow>, Error> {
        let rows = self.block.borrow().clone();
        if rows.iter().map(|row| &row.id).eq(ids) {
            Ok(rows)
        } else {
            Err(Error::Fault("an arm of the gate was asked before the one it repeats".to_owned()))
        }
    }
}

/// An arm that keeps every row from place 0 on: a self-test runs one baseline against many.
#[derive(Debug)]
pub struct Remembered<A> {
    arm: A,
    rows: Vec<ArmRow>,
}

impl<A: Arm> Remembered<A> {
    /// Of an arm.
    pub fn new(arm: A) -> Self {
        Self { arm, rows: Vec::new() }
    }
}

impl<A: Arm> Arm for Remembered<A> {
    fn rows(&mut self, ids: &[u64]) -> Result<Vec<ArmRow>, Error> {
        let known = self.rows.len() as u64;
        let (old, new): (Vec<u64>, Vec<u64>) = ids.iter().partition(|id| **id < known);
        let mut rows: Vec<ArmRow> = old.iter().map(|id| self.rows[*id as usize].clone()).collect();
        if !new.is_empty() {
            let fresh = self.arm.rows(&new)?;
            if new.iter().copied().eq(known..known + new.len() as u64) {
                self.rows.extend(fresh.iter().cloned());
            }
            rows.extend(fresh);
        }
        Ok(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::{Digest, EncounterId, Outcome};

    /// Counts what it is asked.
    struct Counts(u64);

    impl Arm for Counts {
        fn rows(&mut self, ids: &[u64]) -> Result<Vec<ArmRow>, Error> {
            self.0 += ids.len() as u64;
            let row = |&id: &u64| ArmRow {
                digest: Digest(id),
                ..ArmRow::lost(id, &EncounterId::new("x", id), Outcome::PlannerHung)
            };
            Ok(ids.iter().map(row).collect())
        }
    }

    #[test]
    fn what_was_run_is_not_run_again_and_comes_in_the_order_asked() {
        let mut arm = Remembered::new(Counts(0));
        let ids = |range: std::ops::Range<u64>| range.collect::<Vec<_>>();
        let first = arm.rows(&ids(0..10)).unwrap();
        assert_eq!(arm.rows(&ids(0..10)).unwrap(), first);
        assert_eq!(arm.arm.0, 10);
        let more = arm.rows(&ids(5..15)).unwrap();
        assert_eq!(more.iter().map(|row| row.id).collect::<Vec<_>>(), ids(5..15));
        assert_eq!(arm.arm.0, 15);
        // a gap is run and not kept
        assert_eq!(arm.rows(&ids(20..22)).unwrap().len(), 2);
        assert_eq!(arm.rows(&ids(15..16)).unwrap()[0].id, 15);
        assert_eq!(arm.arm.0, 18);
    }

    #[test]
    fn an_echo_says_what_was_said_and_never_anything_else() {
        let mut arm = Heard::new(Counts(0));
        let mut echo = arm.echo();
        assert!(echo.rows(&[0, 1]).is_err(), "asked before");
        let rows = arm.rows(&[0, 1]).unwrap();
        assert_eq!(echo.rows(&[0, 1]).unwrap(), rows);
        assert!(echo.rows(&[1, 0]).is_err(), "asked for another order");
    }
}
