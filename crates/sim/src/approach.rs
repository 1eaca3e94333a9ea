//! How near two ships come: smallest distances, refined within the step, and the first touch.
//!
//! Hull geometry costs ten times what a centre distance costs, so it is left out while the lower
//! bound, centre distance less both radii, stays above `near_m`; the bound then stands in for the
//! distance. [`Approach::settle`] makes the minimum exact all the same: once the run is over it
//! looks at those intervals, and only those, whose bound lies below the smallest distance found.

use crate::hull::{Gap, Warm};
use crate::interval::{
    Centre, Hulls, Interval, closest_centre, closest_hull, closest_in, first_touch, may_touch,
};
use crate::pose::Pose;
use record::PairMinimum;

/// The distances of one pair so far.
#[derive(Clone, Debug)]
pub struct Approach {
    near_m: f64,
    warm: Warm,
    centre: Centre,
    /// The gap at the end of the last interval, where it was computed.
    last: Option<Gap>,
    /// Smallest hull distance, or its lower bound, since [`Self::take_interval_m`].
    interval_m: f64,
    minimum: PairMinimum,
}

impl Approach {
    /// A pair at time 0. Below `near_m` (metres) every hull distance is exact.
    pub fn new(near_m: f64, hulls: Hulls<'_>, own: &Pose, target: &Pose) -> Self {
        let centre = Centre::of(own, target);
        let mut warm = Warm::default();
        let bound_m = centre.range_m - hulls.radii_m();
        let last = (bound_m < near_m).then(|| hulls.gap(own, target, &mut warm));
        let (hull_m, interval_m) =
            last.map_or((f64::INFINITY, bound_m), |gap| (gap.distance_m, gap.distance_m));
        let minimum = PairMinimum { hull_m, hull_s: 0.0, centre_m: centre.range_m, centre_s: 0.0 };
        Self { near_m, warm, centre, last, interval_m, minimum }
    }

    /// From now on every hull distance below `near_m` (metres) is exact.
    pub fn set_near_m(&mut self, near_m: f64) {
        self.near_m = near_m;
    }

    /// The smallest distances so far.
    pub fn minimum(&self) -> PairMinimum {
        self.minimum
    }

    /// Whether the hulls overlap at time 0.
    pub fn overlaps(&self) -> bool {
        self.last.is_some_and(|gap| gap.distance_m <= 0.0)
    }

    /// Centre distance at the end of the last interval, metres.
    pub fn range_m(&self) -> f64 {
        self.centre.range_m
    }

    /// Smallest hull distance (or its bound) since the last call, metres.
    pub fn take_interval_m(&mut self) -> f64 {
        std::mem::replace(&mut self.interval_m, f64::INFINITY)
    }

    /// Goes through one interval; the fraction of it at which the hulls touch, if they do.
    #[inline]
    pub fn advance(&mut self, step: &Interval<'_>, hulls: Hulls<'_>) -> Option<f64> {
        let least_m = self.advance_centre(step);
        let bound_m = least_m - hulls.radii_m();
        if bound_m >= self.near_m {
            self.interval_m = self.interval_m.min(bound_m);
            self.last = None;
            return None;
        }
        self.advance_hull(step, hulls)
    }

    /// Updates the centre distances; the smallest of this interval, metres.
    #[inline]
    fn advance_centre(&mut self, step: &Interval<'_>) -> f64 {
        let before = self.centre;
        let after = Centre::of(step.own[1], step.target[1]);
        self.centre = after;
        let mut least = (before.range_m, 0.0);
        if after.range_m < least.0 {
            least = (after.range_m, 1.0);
        }
        if before.closing < 0.0 && after.closing > 0.0 {
            let inside = closest_centre(step);
            if inside.0 < least.0 {
                least = inside;
            }
        }
        if least.0 < self.minimum.centre_m {
            (self.minimum.centre_m, self.minimum.centre_s) = (least.0, step.time_s(least.1));
        }
        least.0
    }

    fn advance_hull(&mut self, step: &Interval<'_>, hulls: Hulls<'_>) -> Option<f64> {
        let before =
            self.last.unwrap_or_else(|| hulls.gap(step.own[0], step.target[0], &mut self.warm));
        let after = hulls.gap(step.own[1], step.target[1], &mut self.warm);
        self.last = Some(after);
        let (mut least_m, mut fraction) = if before.distance_m < after.distance_m {
            (before.distance_m, 0.0)
        } else {
            (after.distance_m, 1.0)
        };
        if before.opening_mps < 0.0 && after.opening_mps > 0.0 {
            let inside = closest_hull(step, hulls, [&before, &after], self.warm);
            if inside.0 < least_m {
                (least_m, fraction) = inside;
            }
        }
        let touch = if may_touch(step, hulls, [before.distance_m, after.distance_m]) {
            first_touch(step, hulls).or_else(|| (least_m <= 0.0).then_some(fraction))
        } else {
            None
        };
        if let Some(touch) = touch {
            (least_m, fraction) = (0.0, touch);
        }
        self.interval_m = self.interval_m.min(least_m);
        if least_m < self.minimum.hull_m {
            (self.minimum.hull_m, self.minimum.hull_s) = (least_m, step.time_s(fraction));
        }
        touch
    }

    /// Makes the smallest hull distance exact: `bounds_m[k]` is the distance or its lower bound
    /// over the interval that ends at sample `k` (entry 0: at the start), and `poses(k)` tells
    /// where own ship and the target were at sample `k`. Of several contacts the first counts.
    pub fn settle(
        &mut self,
        bounds_m: &[f64],
        hulls: Hulls<'_>,
        mut poses: impl FnMut(usize) -> [Pose; 2],
        sample_s: f64,
    ) -> PairMinimum {
        let minimum = &mut self.minimum;
        // the most promising interval first: it rules out nearly all of the others
        let least = (0..bounds_m.len()).min_by(|&a, &b| bounds_m[a].total_cmp(&bounds_m[b]));
        for k in least.into_iter().chain(0..bounds_m.len()) {
            let before = k.saturating_sub(1);
            let start_s = before as f64 * sample_s;
            let nearer = bounds_m[k] < minimum.hull_m;
            let sooner = minimum.hull_m <= 0.0 && bounds_m[k] <= 0.0 && start_s < minimum.hull_s;
            if !(nearer || sooner) {
                continue;
            }
            let ([own, target], [next_own, next_target]) = (poses(before), poses(k));
            let (own, target) = ([&own, &next_own], [&target, &next_target]);
            let step = Interval { start_s, dt_s: sample_s, own, target };
            let (hull_m, fraction) = closest_in(&step, hulls, k == 0);
            let hull_s = step.time_s(fraction);
            if hull_m < minimum.hull_m || (hull_m <= 0.0 && hull_s < minimum.hull_s) {
                (minimum.hull_m, minimum.hull_s) = (hull_m, hull_s);
            }
        }
        *minimum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hull::Hull;
    use geom::{HullOutline, Vec2, cpa};
    use proptest::prelude::*;

    fn moving(position_m: Vec2, velocity_mps: Vec2, t_s: f64) -> Pose {
        Pose {
            position_m: position_m + velocity_mps * t_s,
            velocity_mps,
            heading: geom::unit(geom::angle::direction(velocity_mps)),
            yaw_rate_radps: 0.0,
        }
    }

    struct Scene {
        own: (Vec2, Vec2),
        target: (Vec2, Vec2),
        hulls: [Hull; 2],
    }

    impl Scene {
        fn at(&self, t_s: f64) -> [Pose; 2] {
            [moving(self.own.0, self.own.1, t_s), moving(self.target.0, self.target.1, t_s)]
        }

        fn hulls(&self) -> Hulls<'_> {
            Hulls { own: &self.hulls[0], target: &self.hulls[1] }
        }

        /// Steps through `duration_s`: the minimum, and when the hulls touched.
        fn sail(&self, near_m: f64, dt_s: f64, duration_s: f64) -> (PairMinimum, Option<f64>) {
            let [own, target] = self.at(0.0);
            let mut approach = Approach::new(near_m, self.hulls(), &own, &target);
            let mut bounds_m = vec![approach.take_interval_m()];
            let steps = (duration_s / dt_s).round() as usize;
            for k in 0..steps {
                let start_s = k as f64 * dt_s;
                let ([own, target], [next_own, next_target]) =
                    (self.at(start_s), self.at(start_s + dt_s));
                let (own, target) = ([&own, &next_own], [&target, &next_target]);
                let step = Interval { start_s, dt_s, own, target };
                if let Some(fraction) = approach.advance(&step, self.hulls()) {
                    return (approach.minimum(), Some(step.time_s(fraction)));
                }
                bounds_m.push(approach.take_interval_m());
            }
            let poses = |k: usize| self.at(k as f64 * dt_s);
            (approach.settle(&bounds_m, self.hulls(), poses, dt_s), None)
        }
    }

    fn scene(miss_m: f64, course_rad: f64, speed_mps: f64, length_m: f64) -> Scene {
        let own = (Vec2::zeros(), Vec2::new(7.0, 0.0));
        let velocity = geom::unit(course_rad) * speed_mps;
        let relative = velocity - own.1;
        let side = Vec2::new(-relative.y, relative.x).normalize() * miss_m;
        let position = side - relative * 60.37;
        let hulls = [
            Hull::new(&HullOutline::centred(8.45, 2.71)),
            Hull::new(&HullOutline::centred(length_m, length_m / 5.0)),
        ];
        Scene { own, target: (position, velocity), hulls }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        /// Straight motion: the centre minimum is the closed form, and the hull minimum is that
        /// of a search in steps of a millisecond around it; both whatever the step and `near_m`.
        #[test]
        fn minima_are_exact(
            miss in 40f64..400.0, course in 0.5f64..5.8, speed in 1f64..12.0, length in 8f64..60.0,
            dt in prop_oneof![Just(0.25), Just(0.5), Just(1.0)],
        ) {
            let scene = scene(miss, course, speed, length);
            let [own, target] = scene.at(0.0);
            let exact = cpa(
                target.position_m - own.position_m,
                target.velocity_mps - own.velocity_mps,
            );
            let (minimum, touched) = scene.sail(300.0, dt, 120.0);
            prop_assert_eq!(touched, None);
            prop_assert!((minimum.centre_m - exact.dcpa_m).abs() < 1e-9);
            prop_assert!((minimum.centre_s - exact.tcpa_s.unwrap()).abs() < 1e-4);

            let gap = |t_s: f64| {
                let [own, target] = scene.at(t_s);
                scene.hulls().gap(&own, &target, &mut Warm::default()).distance_m
            };
            let mut fine = f64::INFINITY;
            for k in -20_000..20_000i32 {
                fine = fine.min(gap(minimum.hull_s + f64::from(k) * 1e-3));
            }
            prop_assert!(minimum.hull_m <= fine + 1e-6, "{} {}", minimum.hull_m, fine);
            prop_assert!((gap(minimum.hull_s) - minimum.hull_m).abs() < 1e-9);
            let (far, _) = scene.sail(f64::NEG_INFINITY, dt, 120.0);
            prop_assert!((far.hull_m - minimum.hull_m).abs() < 1e-6);
        }
    }

    /// Beam to beam at 20 m: the first touch of a head-on meeting has a closed form.
    #[test]
    fn head_on_touch_is_when_the_bows_meet() {
        let hulls = [20.0, 30.0].map(|length| Hull::new(&HullOutline::centred(length, 4.0)));
        let scene = Scene {
            own: (Vec2::zeros(), Vec2::new(6.0, 0.0)),
            target: (Vec2::new(1000.0, 0.0), Vec2::new(-4.0, 0.0)),
            hulls,
        };
        for dt_s in [0.25, 0.5, 1.0] {
            let (minimum, touched) = scene.sail(300.0, dt_s, 120.0);
            // the sweep stops a millimetre or so short
            assert!((touched.unwrap() - 97.5).abs() < 3e-4);
            assert!(minimum.hull_m <= 0.0);
        }
    }

    #[test]
    fn first_of_two_overlapping_intervals_gives_the_time() {
        let scene = scene(0.0, 3.0, 7.0, 30.0);
        let (online, touched) = scene.sail(300.0, 1.0, 120.0);
        let (settled, _) = scene.sail(f64::NEG_INFINITY, 1.0, 120.0);
        assert!(touched.is_some() && settled.hull_m <= 0.0);
        assert!((online.hull_s - settled.hull_s).abs() < 1e-3, "{online:?} {settled:?}");
    }
}
