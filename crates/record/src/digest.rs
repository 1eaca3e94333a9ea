//! The digest of a run and of a campaign.
//!
//! A run's digest is the first 64 bits of BLAKE3 over its trace, little-endian, arrays with their
//! lengths. A campaign's root digest is BLAKE3 over the run digests in order (stratum, j).

use crate::trace::{Contact, ContactWith, Nominal, Pair, PairMinimum, ShipTrack, Trace};
use crate::{EncounterId, Outcome};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Raised whenever the encoding below changes.
const ENCODING: &[u8] = b"seatrial trace v1";

/// Digest of one run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Digest(pub u64);

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl Digest {
    /// The digest of a trace. The last safe instants are left out: they depend on the rule set.
    pub fn of_trace(trace: &Trace) -> Self {
        let mut e = Encoder::new();
        e.id(&trace.id, trace.outcome);
        e.f64(trace.end_s);
        e.f64(trace.sample_s);
        e.track(&trace.own);
        e.list(&trace.targets, Encoder::track);
        e.list(&trace.pairs, Encoder::pair);
        e.option(trace.hazard_m_min.as_ref(), |e, m| e.f64(*m));
        e.list(&trace.orders, |e, order| {
            e.f64(order.course_rad);
            e.f64(order.speed_mps);
        });
        e.list(&trace.alerts, |e, alert| {
            e.f64(alert.t_s);
            e.bytes(&[alert.target]);
            e.text(&alert.rule);
        });
        let events = &trace.events;
        for count in [
            events.inner_loop_cap,
            events.limited,
            events.inside_called_safe,
            events.class_changes,
            events.receding_flagged,
            events.passes,
        ] {
            e.bytes(&count.to_le_bytes());
        }
        e.option(trace.contact.as_ref(), Encoder::contact);
        e.option(trace.nominal.as_ref(), Encoder::nominal);
        e.finish()
    }

    /// The digest of a run that left no trace.
    pub fn of_lost_run(id: &EncounterId, outcome: Outcome) -> Self {
        let mut e = Encoder::new();
        e.id(id, outcome);
        e.finish()
    }
}

/// Digest of a campaign, fed in order (stratum, j).
#[derive(Clone, Debug, Default)]
pub struct RootDigest(blake3::Hasher);

impl RootDigest {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The next run.
    pub fn push(&mut self, digest: Digest) {
        self.0.update(&digest.0.to_le_bytes());
    }

    /// As 64 hexadecimal digits.
    pub fn hex(&self) -> String {
        self.0.finalize().to_hex().to_string()
    }
}

/// Gathers bytes in a small buffer, so that the hasher sees large pieces.
struct Encoder {
    hasher: blake3::Hasher,
    buffer: Vec<u8>,
}

impl Encoder {
    const BUFFER: usize = 16 * 1024;

    fn new() -> Self {
        let mut buffer = Vec::with_capacity(Self::BUFFER + 4096);
        buffer.extend_from_slice(ENCODING);
        Self { hasher: blake3::Hasher::new(), buffer }
    }

    fn finish(mut self) -> Digest {
        self.hasher.update(&self.buffer);
        let hash = self.hasher.finalize();
        let mut first = [0; 8];
        first.copy_from_slice(&hash.as_bytes()[..8]);
        Digest(u64::from_le_bytes(first))
    }

    fn bytes(&mut self, bytes: &[u8]) {
        if self.buffer.len() >= Self::BUFFER {
            self.hasher.update(&self.buffer);
            self.buffer.clear();
        }
        self.buffer.extend_from_slice(bytes);
    }

    fn f64(&mut self, value: f64) {
        self.bytes(&value.to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.length(text.len());
        self.bytes(text.as_bytes());
    }

    fn length(&mut self, length: usize) {
        self.bytes(&(length as u64).to_le_bytes());
    }

    fn array(&mut self, values: &[f64]) {
        self.length(values.len());
        for chunk in values.chunks(512) {
            self.bytes(&[]);
            self.buffer.extend(chunk.iter().flat_map(|value| value.to_le_bytes()));
        }
    }

    fn list<T>(&mut self, items: &[T], encode: impl Fn(&mut Self, &T)) {
        self.length(items.len());
        for item in items {
            encode(self, item);
        }
    }

    fn option<T>(&mut self, item: Option<&T>, encode: impl Fn(&mut Self, &T)) {
        self.bytes(&[u8::from(item.is_some())]);
        if let Some(item) = item {
            encode(self, item);
        }
    }

    fn id(&mut self, id: &EncounterId, outcome: Outcome) {
        self.text(&id.stratum);
        self.bytes(&id.j.to_le_bytes());
        self.bytes(&[outcome as u8]);
    }

    fn track(&mut self, track: &ShipTrack) {
        for signal in track.signals() {
            self.array(signal);
        }
    }

    fn minimum(&mut self, minimum: &PairMinimum) {
        for value in [minimum.hull_m, minimum.hull_s, minimum.centre_m, minimum.centre_s] {
            self.f64(value);
        }
    }

    fn pair(&mut self, pair: &Pair) {
        self.array(&pair.hull_m);
        self.minimum(&pair.minimum);
        self.option(pair.detected_s.as_ref(), |e, t| e.f64(*t));
        self.option(pair.tracked_s.as_ref(), |e, t| e.f64(*t));
    }

    fn contact(&mut self, contact: &Contact) {
        let (kind, index) = match contact.with {
            ContactWith::Target(index) => (0, index),
            ContactWith::Hazard(index) => (1, index),
        };
        self.bytes(&[kind, index]);
        for value in [contact.t_s, contact.impact_mps, contact.impulse_ns, contact.energy_lost_j] {
            self.f64(value);
        }
    }

    fn nominal(&mut self, nominal: &Nominal) {
        self.track(&nominal.own);
        self.list(&nominal.targets, Self::track);
        self.list(&nominal.minima, Self::minimum);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lost_run_digest_depends_on_id_and_outcome_alone() {
        let id = EncounterId::new("head_on", 3);
        let hung = Digest::of_lost_run(&id, Outcome::PlannerHung);
        assert_eq!(hung, Digest::of_lost_run(&id, Outcome::PlannerHung));
        assert_ne!(hung, Digest::of_lost_run(&id, Outcome::PlannerCrashed));
        assert_ne!(
            hung,
            Digest::of_lost_run(&EncounterId::new("head_on", 4), Outcome::PlannerHung)
        );
    }

    #[test]
    fn root_digest_depends_on_order() {
        let root = |digests: [u64; 2]| {
            let mut root = RootDigest::new();
            digests.into_iter().for_each(|d| root.push(Digest(d)));
            root.hex()
        };
        assert_ne!(root([1, 2]), root([2, 1]));
        assert_eq!(root([1, 2]).len(), 64);
    }
}
