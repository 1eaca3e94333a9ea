//! The last safe instants of each pair (rules specification, section 10).
//!
//! `sim` says what one ship alone could still do from each instant of the nominal track; here is
//! the search along it, second by second. The judge only reads what is found. The first infeasible
//! instant counts: feasible again after it is of no help to a ship that waited.

use record::{Encounter, EncounterClass, LastInstant, LastMinute, Nominal, PairFacts, Role};
use sim::{Escapes, Manoeuvre, Side};

/// Searches the nominal track of an encounter: for each pair that reached stage 3 its last safe
/// instants; `None` where a ship has no model. `facts` are those of the rule set that is to read
/// what is found; `near_miss_m` is its `r_nm`, hull to hull.
pub fn find(
    encounter: &Encounter,
    nominal: &Nominal,
    facts: &[PairFacts],
    near_miss_m: f64,
) -> Option<Vec<Option<LastMinute>>> {
    let escapes = Escapes::new(encounter, nominal)?;
    let least_m = nominal.minima.iter().map(|minimum| minimum.hull_m).collect();
    let mut search = Search { escapes, least_m, near_miss_m };
    let mut pairs = vec![None; encounter.targets.len()];
    for pair in facts.iter().filter(|pair| pair.stages_s[1].is_some()) {
        pairs[usize::from(pair.target)] = Some(search.pair(pair));
    }
    Some(pairs)
}

/// The forks of one encounter, and the smallest hull distances of its nominal track.
struct Search<'a> {
    escapes: Escapes<'a>,
    least_m: Vec<f64>,
    near_miss_m: f64,
}

impl Search<'_> {
    fn pair(&mut self, facts: &PairFacts) -> LastMinute {
        let target = usize::from(facts.target);
        let allowed = allowed(facts);
        // what clears by a near miss clears of contact, and what one set can do a larger one can
        let near_miss = self.own(target, &allowed, self.near_miss_m, None);
        let own = self.own(target, &allowed, 0.0, near_miss);
        let any_turn = self.own(target, &Manoeuvre::ALL, 0.0, own);
        let near_miss_m = self.near_miss_m;
        LastMinute {
            own: self.instant(target, 0.0, own, false),
            own_any_turn: self.instant(target, 0.0, any_turn, false),
            own_near_miss: self.instant(target, near_miss_m, near_miss, false),
            target: self.target(target),
        }
    }

    fn own(
        &mut self,
        target: usize,
        manoeuvres: &[Manoeuvre],
        than_m: f64,
        known: Option<usize>,
    ) -> Option<usize> {
        if self.least_m[target] > than_m {
            return None;
        }
        let (instants, loss_m) = (self.escapes.instants(target), self.escapes.own_loss_m(target));
        last_feasible(instants, known, loss_m, manoeuvres, &mut |instant, manoeuvre| {
            self.escapes.own_clears(target, instant, manoeuvre, than_m)
        })
    }

    fn target(&mut self, target: usize) -> LastInstant {
        if self.least_m[target] > 0.0 {
            return LastInstant::NeverCritical;
        }
        let (instants, loss_m) =
            (self.escapes.instants(target), self.escapes.target_loss_m(target));
        let all = &Manoeuvre::ALL;
        let last = last_feasible(instants, None, loss_m, all, &mut |instant, manoeuvre| {
            self.escapes.target_clears(target, instant, manoeuvre, 0.0)
        });
        self.instant(target, 0.0, last, self.escapes.is_indicative(target))
    }

    fn instant(
        &self,
        target: usize,
        than_m: f64,
        last: Option<usize>,
        indicative: bool,
    ) -> LastInstant {
        match last.map(|instant| self.escapes.time_s(instant)) {
            _ if self.least_m[target] > than_m => LastInstant::NeverCritical,
            None => LastInstant::BeforeStart,
            Some(t_s) if indicative => LastInstant::Indicative(t_s),
            Some(t_s) => LastInstant::At(t_s),
        }
    }
}

/// The manoeuvres that the rules leave her: not to port in a head-on meeting (Rule 14), nor for a
/// ship on her own port side that crosses (Rule 17(c)).
fn allowed(facts: &PairFacts) -> Vec<Manoeuvre> {
    let crossing_port = facts.class == Some(EncounterClass::CrossingPort);
    let not_to_port = facts.role == Role::Both || (facts.role == Role::StandOn && crossing_port);
    let mut manoeuvres = Manoeuvre::ALL.to_vec();
    manoeuvres.retain(|manoeuvre| !(not_to_port && manoeuvre.side() == Some(Side::Port)));
    manoeuvres
}

/// The last instant before the first one from which no manoeuvre clears; `None` where that is the
/// very first. All instants up to `known` are known to be feasible. `clears` says by how much, and
/// `loss_m` how much of it an instant later may have lost: instants that cannot have lost it all
/// are feasible without a look.
fn last_feasible(
    instants: usize,
    known: Option<usize>,
    loss_m: Option<f64>,
    manoeuvres: &[Manoeuvre],
    clears: &mut dyn FnMut(usize, Manoeuvre) -> Option<f64>,
) -> Option<usize> {
    let mut last = known;
    let mut next = known.map_or(0, |instant| instant + 1);
    // what worked an instant ago works most often
    let mut first = 0;
    while next < instants {
        let order = (0..manoeuvres.len()).map(|i| (first + i) % manoeuvres.len());
        let found = order.into_iter().find_map(|i| Some((i, clears(next, manoeuvres[i])?)));
        let Some((index, slack_m)) = found else { break };
        first = index;
        let sure = loss_m.map_or(0, |loss_m| (slack_m / loss_m) as usize);
        last = Some((next + sure).min(instants - 1));
        next += 1 + sure;
    }
    last
}
