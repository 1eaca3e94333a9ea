//! What the seed planner remembers of each target between beats.

use geom::EncounterClass;

/// One target, as long as its track lives.
#[derive(Clone, Copy, Debug)]
pub struct Remembered {
    id: u32,
    /// Class at the last beat at which the target was a danger.
    class_last: Option<EncounterClass>,
    /// Class and side since first risk (`memory = latched`).
    pub latch: Option<Latch>,
}

/// Class and side (s = -1 right edge, +1 left edge) that are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Latch {
    /// The class.
    pub class: EncounterClass,
    /// The side.
    pub s: f64,
}

impl Remembered {
    /// Notes the class of this beat; true if it differs from the one before.
    pub fn note_class(&mut self, class: EncounterClass) -> bool {
        self.class_last.replace(class).is_some_and(|last| last != class)
    }
}

/// All targets. The lists are short, so a search beats an ordered map.
#[derive(Clone, Debug, Default)]
pub struct TargetMemory(Vec<Remembered>);

impl TargetMemory {
    /// Forgets everything.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Forgets targets whose track is gone: a number is not given twice.
    pub fn keep(&mut self, alive: impl Fn(u32) -> bool) {
        self.0.retain(|target| alive(target.id));
    }

    /// The target with this number, new if need be.
    pub fn of(&mut self, id: u32) -> &mut Remembered {
        let index = self.0.iter().position(|target| target.id == id).unwrap_or_else(|| {
            self.0.push(Remembered { id, class_last: None, latch: None });
            self.0.len() - 1
        });
        &mut self.0[index]
    }
}
