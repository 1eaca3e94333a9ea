//! A target's steady motion: a straight line through the history of her track.
//!
//! A tracker has to follow turns, so the velocity of its tracks is no better than half a metre a
//! second, and two minutes later that is 60 m of distance at the closest point. A ship that keeps
//! her course can be watched for longer. The line holds until the track's own velocity says plainly
//! that she has altered. A perfect track is taken as it is.

use geom::{Vec2, angle, units::deg, wrap};
use planner_api::TargetTrack;
use std::collections::VecDeque;

/// Length of the history, seconds.
const HISTORY_S: f64 = 60.0;
/// What of it stays when she has altered, seconds.
const AFTER_ALTERING_S: f64 = 6.0;
/// A line through less than this is worse than the tracker, seconds.
const LINE_S_MIN: f64 = 12.0;
/// Places of a track are as good as one measurement in this time, seconds: two scans of a radar.
const CORRELATION_S: f64 = 5.0;
/// A track that nothing has fed for longer says nothing new, seconds.
const FRESH_S: f64 = 3.0;
/// Squared Mahalanobis distance between the velocities of track and line beyond which she has
/// altered: one in three thousand, if nothing was correlated.
const ALTERED: f64 = 16.0;
/// A change of course between two lines that is no alarm of the tracker's alone, radians.
const ALTERED_RAD: f64 = deg(10.0);

/// The history of one track.
#[derive(Clone, Debug)]
struct History {
    id: u32,
    first_s: f64,
    /// (seconds, metres), of beats at which the picture was new.
    places: VecDeque<(f64, Vec2)>,
    shown_m: Vec2,
    shown_s: f64,
    /// What she did when she was first seen to alter, and when that was: (seconds, m/s).
    before: Option<(f64, Vec2)>,
    altered: Alteration,
}

/// Whether a target has altered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alteration {
    /// She goes on as she did.
    None,
    /// The tracker says so, and a new line does not yet.
    Perhaps,
    /// She has, and it was first seen at this time, seconds.
    Seen(f64),
}

/// A target with what is known of how well she is known.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// The track, with the place and velocity of the line where there is one.
    pub track: TargetTrack,
    /// Standard deviation of her place along one axis, metres; 0 when perfect.
    pub position_sd_m: f64,
    /// Of her velocity along one axis, m/s; 0 when perfect.
    pub velocity_sd_mps: f64,
    /// How long she has been watched, seconds; infinite when perfect.
    pub watched_s: f64,
    /// Whether she has altered.
    pub altered: Alteration,
}

impl Seen {
    /// Standard deviation of the distance at a closest point that lies so far ahead, metres.
    pub fn cpa_sd_m(&self, tcpa_s: f64) -> f64 {
        let grown_m = self.velocity_sd_mps * tcpa_s.max(0.0);
        (self.position_sd_m * self.position_sd_m + grown_m * grown_m).sqrt()
    }
}

/// All tracks.
#[derive(Clone, Debug, Default)]
pub struct Lookout(Vec<History>);

impl Lookout {
    /// Forgets everything.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Forgets the tracks that are not there any more.
    pub fn keep(&mut self, tracks: &[TargetTrack]) {
        self.0.retain(|history| tracks.iter().any(|track| track.id == history.id));
    }

    /// What is known of a track at this beat.
    pub fn see(&mut self, t_s: f64, track: &TargetTrack) -> Seen {
        let position_sd_m = (0.5 * (track.covariance[0][0] + track.covariance[1][1])).sqrt();
        let velocity_sd_mps = (0.5 * (track.covariance[2][2] + track.covariance[3][3])).sqrt();
        if position_sd_m <= 0.0 && velocity_sd_mps <= 0.0 {
            let watched_s = f64::INFINITY;
            return Seen {
                track: *track,
                position_sd_m: 0.0,
                velocity_sd_mps: 0.0,
                watched_s,
                altered: Alteration::None,
            };
        }
        let history = self.of(t_s, track);
        let frozen_s = history.note(t_s, track);
        let watched_s = t_s - history.first_s;
        // a dropped frame shows the picture of the one before
        let position_m = track.position_m + track.velocity_mps * frozen_s;
        let as_shown = Seen {
            track: TargetTrack { position_m, ..*track },
            position_sd_m,
            velocity_sd_mps,
            watched_s,
            altered: history.altered,
        };
        let Some(line) = history.line(t_s) else { return as_shown };
        if altered(track, line.velocity_mps) {
            history.forget_until(t_s - AFTER_ALTERING_S);
            history.before.get_or_insert((t_s, line.velocity_mps));
            if history.altered == Alteration::None {
                history.altered = Alteration::Perhaps;
            }
            return Seen { altered: history.altered, ..as_shown };
        }
        history.confirm(line.velocity_mps);
        let share = CORRELATION_S / line.length_s;
        let sog_mps = line.velocity_mps.norm();
        Seen {
            track: TargetTrack {
                position_m: line.position_m,
                velocity_mps: line.velocity_mps,
                sog_mps,
                cog_rad: if sog_mps > 1e-6 { angle::direction(line.velocity_mps) } else { 0.0 },
                ..*track
            },
            // ends and slope of a line through independent places
            position_sd_m: position_sd_m * (4.0 * share).sqrt().min(1.0),
            velocity_sd_mps: velocity_sd_mps
                .min(position_sd_m * (12.0 * share).sqrt() / line.length_s),
            watched_s,
            altered: history.altered,
        }
    }

    fn of(&mut self, t_s: f64, track: &TargetTrack) -> &mut History {
        let known = self.0.iter().position(|history| history.id == track.id);
        let index = known.unwrap_or_else(|| {
            self.0.push(History {
                id: track.id,
                first_s: t_s,
                places: VecDeque::new(),
                shown_m: Vec2::new(f64::NAN, f64::NAN),
                shown_s: t_s,
                before: None,
                altered: Alteration::None,
            });
            self.0.len() - 1
        });
        &mut self.0[index]
    }
}

/// A straight line in time, at its end.
struct Line {
    position_m: Vec2,
    velocity_mps: Vec2,
    length_s: f64,
}

impl History {
    /// Takes in what is shown; how long the picture has stood still, seconds.
    fn note(&mut self, t_s: f64, track: &TargetTrack) -> f64 {
        if track.position_m == self.shown_m {
            return t_s - self.shown_s;
        }
        (self.shown_m, self.shown_s) = (track.position_m, t_s);
        if track.since_update_s <= FRESH_S {
            self.places.push_back((t_s, track.position_m));
        }
        self.forget_until(t_s - HISTORY_S);
        0.0
    }

    /// A tracker's alarm may be false; the line after it tells.
    fn confirm(&mut self, now_mps: Vec2) {
        let (Some((t_s, before_mps)), Alteration::Perhaps) = (self.before, self.altered) else {
            return;
        };
        let turned_rad = wrap(angle::direction(now_mps) - angle::direction(before_mps)).abs();
        if turned_rad >= ALTERED_RAD {
            self.altered = Alteration::Seen(t_s);
        } else {
            (self.before, self.altered) = (None, Alteration::None);
        }
    }

    fn forget_until(&mut self, t_s: f64) {
        while self.places.front().is_some_and(|place| place.0 < t_s) {
            self.places.pop_front();
        }
    }

    /// The line of least squares through the places, brought to `t_s`; none through too few.
    fn line(&self, t_s: f64) -> Option<Line> {
        let (first, last) = (self.places.front()?, self.places.back()?);
        let length_s = last.0 - first.0;
        if length_s < LINE_S_MIN || t_s - last.0 > LINE_S_MIN {
            return None;
        }
        // sums about the last place, so that it does not matter where the scene lies
        let (mut n, mut sum_t, mut sum_tt) = (0.0, 0.0, 0.0);
        let (mut sum_m, mut sum_tm) = (Vec2::zeros(), Vec2::zeros());
        for &(at_s, place_m) in &self.places {
            let (t, m) = (at_s - t_s, place_m - last.1);
            n += 1.0;
            sum_t += t;
            sum_tt += t * t;
            sum_m += m;
            sum_tm += m * t;
        }
        let velocity_mps = (sum_tm * n - sum_m * sum_t) / (n * sum_tt - sum_t * sum_t);
        let position_m = last.1 + (sum_m - velocity_mps * sum_t) / n;
        Some(Line { position_m, velocity_mps, length_s })
    }
}

/// Whether the track's own velocity is plainly another one.
fn altered(track: &TargetTrack, line_mps: Vec2) -> bool {
    let c = &track.covariance;
    let (a, b, d) = (c[2][2], c[2][3], c[3][3]);
    let off = track.velocity_mps - line_mps;
    let determinant = a * d - b * b;
    let distance2 = (d * off.x * off.x - 2.0 * b * off.x * off.y + a * off.y * off.y) / determinant;
    distance2 > ALTERED
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::PlannerStream;

    const VELOCITY_MPS: Vec2 = Vec2::new(-3.0, 5.0);

    fn noise(stream: &mut PlannerStream) -> f64 {
        // of twelve uniform numbers, less their mean: very nearly normal
        (0..12).map(|_| stream.uniform()).sum::<f64>() - 6.0
    }

    fn track(position_m: Vec2, velocity_mps: Vec2) -> TargetTrack {
        let mut covariance = [[0.0; 4]; 4];
        for (i, sd) in [8.0, 8.0, 0.6, 0.6].into_iter().enumerate() {
            covariance[i][i] = sd * sd;
        }
        TargetTrack {
            id: 1,
            position_m,
            velocity_mps,
            cog_rad: geom::angle::direction(velocity_mps),
            sog_mps: velocity_mps.norm(),
            psi_rad: None,
            length_m: None,
            beam_m: None,
            covariance,
            age_s: 0.0,
            since_update_s: 1.0,
        }
    }

    /// Errors of velocity over many tracks after a minute: as large as the line says, and far below
    /// the tracker's.
    #[test]
    fn a_line_knows_the_velocity_of_a_steady_ship_and_says_how_well() {
        let mut stream = PlannerStream::new(3);
        let (mut sum_mps2, mut said_mps) = (0.0, 0.0);
        let runs = 200;
        for _ in 0..runs {
            let mut lookout = Lookout::default();
            let mut error_m = Vec2::zeros();
            let mut last = None;
            for beat in 0..70 {
                let t_s = f64::from(beat);
                if beat % 5 == 0 {
                    error_m = Vec2::new(noise(&mut stream), noise(&mut stream)) * 8.0;
                }
                let shown = VELOCITY_MPS + Vec2::new(noise(&mut stream), 0.0) * 0.5;
                last = Some(lookout.see(t_s, &track(VELOCITY_MPS * t_s + error_m, shown)));
            }
            let last = last.unwrap();
            sum_mps2 += 0.5 * (last.track.velocity_mps - VELOCITY_MPS).norm_squared();
            said_mps = last.velocity_sd_mps;
        }
        let sd_mps = (sum_mps2 / f64::from(runs)).sqrt();
        assert!(said_mps < 0.2 && (0.7..1.4).contains(&(sd_mps / said_mps)), "{sd_mps} {said_mps}");
    }

    #[test]
    fn a_turn_is_followed_within_seconds() {
        let mut lookout = Lookout::default();
        let turned = Vec2::new(-6.0, 0.0);
        for beat in 0..60 {
            lookout.see(f64::from(beat), &track(VELOCITY_MPS * f64::from(beat), VELOCITY_MPS));
        }
        let at_m = VELOCITY_MPS * 60.0;
        for beat in 0..4 {
            let seen = lookout
                .see(60.0 + f64::from(beat), &track(at_m + turned * f64::from(beat), turned));
            assert_eq!(
                (seen.track.velocity_mps, seen.altered),
                (turned, Alteration::Perhaps),
                "{beat}"
            );
        }
    }

    /// The line after an alarm of the tracker says whether it was a false one.
    #[test]
    fn an_alteration_is_one_when_the_next_line_shows_it() {
        for (turned_mps, altered) in
            [(Vec2::new(-6.0, 0.0), Alteration::Seen(60.0)), (VELOCITY_MPS, Alteration::None)]
        {
            let mut lookout = Lookout::default();
            let at_m = |t_s: f64| VELOCITY_MPS * t_s.min(60.0) + turned_mps * (t_s - 60.0).max(0.0);
            let mut seen = Vec::new();
            for beat in 0..90 {
                let t_s = f64::from(beat);
                let shown_mps = if beat == 60 { Vec2::new(-6.0, 0.0) } else { turned_mps };
                let shown_mps = if beat < 60 { VELOCITY_MPS } else { shown_mps };
                seen.push(lookout.see(t_s, &track(at_m(t_s), shown_mps)).altered);
            }
            assert_eq!(seen[59..64], [&[Alteration::None][..], &[Alteration::Perhaps; 4]].concat());
            assert_eq!(seen[89], altered);
        }
    }

    #[test]
    fn a_picture_that_stands_still_is_carried_on() {
        let mut lookout = Lookout::default();
        let shown = track(Vec2::new(100.0, 0.0), VELOCITY_MPS);
        lookout.see(0.0, &shown);
        let seen = lookout.see(2.0, &shown);
        assert!((seen.track.position_m - (shown.position_m + VELOCITY_MPS * 2.0)).norm() < 1e-9);
    }

    #[test]
    fn a_perfect_track_is_taken_as_it_is() {
        let perfect =
            TargetTrack { covariance: [[0.0; 4]; 4], ..track(Vec2::zeros(), VELOCITY_MPS) };
        let mut lookout = Lookout::default();
        for beat in 0..30 {
            let seen = lookout.see(f64::from(beat), &perfect);
            assert_eq!((seen.track, seen.velocity_sd_mps), (perfect, 0.0));
            assert!(seen.cpa_sd_m(300.0) <= 0.0);
        }
    }
}
