//! Hand-written encounters: two ships that turn and slow down by script, once a second.

use geom::HullOutline;
use record::{
    Contact, ContactWith, DistanceKind, EncounterId, Nominal, Outcome, Pair, PairMinimum,
    PlannerEvents, Ship, ShipTrack, Trace, Visibility,
};
use stl::clearance::{Posed, predicted_clearance_m};
use stl::{Params, RunParams, Scales, StageClock};

/// The thresholds of the profile `usv-oe2023` and the defaults of the specification.
pub(crate) const USV: Params = Params {
    risk_distance_m: 200.0,
    close_quarters_m: 200.0,
    risk_tcpa_s: 600.0,
    risk_hold_s: 3.0,
    risk_close_factor: 1.2,
    manoeuvring_yaw_rate_radps: deg(0.3),
    head_on_half_angle_rad: deg(13.0),
    head_on_reciprocal_rad: deg(26.0),
    doubt_rad: deg(2.0),
    stopped_mps: 0.2,
    stage_range_m: [1900.0, 700.0, 200.0],
    stage_time_s: [190.0, 70.0, 20.0],
    stage_clock: StageClock::Range,
    preferred_m: 200.0,
    minimum_m: 100.0,
    near_miss_m: 50.0,
    turn_detectable_rad: deg(2.0),
    turn_action_rad: deg(10.0),
    turn_apparent_rad: deg(30.0),
    speed_detectable: 0.07,
    speed_action: 0.25,
    offset_hold_s: 5.0,
    reference_s: 10.0,
    stand_on_mean_s: 30.0,
    may_act_hold_s: 5.0,
    shall_act_grace_s: 5.0,
    run: RunParams {
        smoothing_s: 2.0,
        yaw_rate_on_radps: deg(0.6),
        quiet_s: 2.0,
        gap_s: 10.0,
        slow_s: 120.0,
        acceleration_mps2: 0.05,
        moving_mps: 0.2,
    },
    attribution_lead_s: 120.0,
    release_hold_s: 10.0,
    release_overtaking_rad: deg(67.5),
    release_abaft_rad: deg(112.5),
    release_range_factor: 1.05,
    overtaken_bow_rad: deg(45.0),
    port_turn_fails_in_stage_4: false,
    scale: Scales { distance_m: 100.0, angle_rad: deg(10.0), speed: 0.25 },
};

pub(crate) const fn deg(degrees: f64) -> f64 {
    degrees * (std::f64::consts::PI / 180.0)
}

/// A ship by its start and its alterations: (from second, degrees a second, for seconds).
#[derive(Clone, Debug)]
pub(crate) struct Script {
    pub(crate) north_m: f64,
    pub(crate) east_m: f64,
    pub(crate) psi_deg: f64,
    pub(crate) speed_mps: f64,
    /// (from second, degrees a second, for how many seconds)
    pub(crate) turns: Vec<(usize, f64, usize)>,
    /// (from second, m/s a second, for how many seconds)
    pub(crate) speeds: Vec<(usize, f64, usize)>,
}

impl Script {
    pub(crate) fn straight(north_m: f64, east_m: f64, psi_deg: f64, speed_mps: f64) -> Self {
        Self { north_m, east_m, psi_deg, speed_mps, turns: vec![], speeds: vec![] }
    }

    /// Turns by `degrees` (positive to starboard) at 3 degrees a second.
    pub(crate) fn turn(mut self, from_s: usize, degrees: f64) -> Self {
        let seconds = (degrees.abs() / 3.0).ceil() as usize;
        self.turns.push((from_s, degrees / seconds as f64, seconds));
        self
    }

    /// Changes speed by `by_mps` at up to 0.5 m/s a second.
    pub(crate) fn change_speed(mut self, from_s: usize, by_mps: f64) -> Self {
        let seconds = (by_mps.abs() / 0.5).ceil() as usize;
        self.speeds.push((from_s, by_mps / seconds as f64, seconds));
        self
    }

    fn held(&self) -> Self {
        Self { turns: vec![], speeds: vec![], ..self.clone() }
    }

    fn track(&self, samples: usize) -> ShipTrack {
        let hull = HullOutline::centred(20.0, 6.0);
        let ship = Ship {
            hull,
            yaw_rate_radps_max: deg(6.0),
            speed_mps_max: 12.0,
            steerage_mps: Some(0.5),
            stopping: None,
        };
        let mut track = ShipTrack::with_capacity(ship, samples);
        let (mut n, mut e) = (self.north_m, self.east_m);
        let (mut psi, mut u) = (deg(self.psi_deg), self.speed_mps);
        for k in 0..samples {
            let active = |list: &[(usize, f64, usize)]| -> f64 {
                let now = |(from, _, len): &&(usize, f64, usize)| (*from..from + len).contains(&k);
                list.iter().filter(now).map(|(_, rate, _)| rate).sum()
            };
            let rate = deg(active(&self.turns));
            let (sin, cos) = libm::sincos(psi);
            track.north_m.push(n);
            track.east_m.push(e);
            track.psi_rad.push(stl::signals::wrapped_rad(psi));
            track.vel_north_mps.push(u * cos);
            track.vel_east_mps.push(u * sin);
            track.stw_mps.push(u);
            track.yaw_rate_radps.push(rate);
            n += u * cos;
            e += u * sin;
            psi += rate;
            u += active(&self.speeds);
        }
        track
    }
}

/// A run of `samples` seconds; ends at contact. The nominal track is own ship without her
/// alterations, against targets that move as they did.
pub(crate) fn run(own: &Script, targets: &[Script], samples: usize) -> Trace {
    let mut trace = sailed(own, targets, samples);
    let nominal = sailed(&own.held(), targets, samples);
    if let Some((target, at)) = first_contact(&trace) {
        trace = sailed(own, targets, at + 1);
        trace.outcome = Outcome::Collision;
        trace.contact = Some(Contact {
            t_s: at as f64,
            with: ContactWith::Target(u8::try_from(target).expect("few targets")),
            impact_mps: 1.0,
            impulse_ns: 1.0,
            energy_lost_j: 1.0,
        });
    }
    trace.nominal = Some(Nominal {
        minima: nominal.pairs.iter().map(|pair| pair.minimum).collect(),
        own: nominal.own,
        targets: nominal.targets,
    });
    trace
}

fn first_contact(trace: &Trace) -> Option<(usize, usize)> {
    let touching = |pair: &Pair| pair.hull_m.iter().position(|d| *d <= 0.0);
    let all = trace.pairs.iter().enumerate();
    all.filter_map(|(i, pair)| Some((i, touching(pair)?))).min_by_key(|(_, at)| *at)
}

fn sailed(own: &Script, targets: &[Script], samples: usize) -> Trace {
    let own = own.track(samples);
    let targets: Vec<ShipTrack> = targets.iter().map(|target| target.track(samples)).collect();
    let pairs = targets.iter().map(|target| pair(&own, target)).collect();
    Trace {
        id: EncounterId::new("test", 0),
        outcome: Outcome::Completed,
        end_s: (samples - 1) as f64,
        sample_s: 1.0,
        safety_radius_m: 100.0,
        distance: DistanceKind::Hull,
        visibility: Visibility::InSight,
        route: vec![],
        cruise_mps: 5.0,
        own,
        targets,
        pairs,
        hazard_m_min: None,
        orders: vec![],
        alerts: vec![],
        events: PlannerEvents::default(),
        contact: None,
        planner_sector: None,
        planner_detail: None,
        goal_reached: false,
        nominal: None,
        last_minute: None,
        unavoidable: None,
    }
}

fn pair(own: &ShipTrack, target: &ShipTrack) -> Pair {
    let samples = own.len();
    let at = |k: usize| {
        let p = (target.north_m[k] - own.north_m[k], target.east_m[k] - own.east_m[k]);
        let o = Posed { ship: &own.ship, psi_rad: own.psi_rad[k] };
        let t = Posed { ship: &target.ship, psi_rad: target.psi_rad[k] };
        (predicted_clearance_m(o, t, p, (0.0, 0.0)), (p.0 * p.0 + p.1 * p.1).sqrt())
    };
    let both: Vec<(f64, f64)> = (0..samples).map(at).collect();
    let least = |pick: fn(&(f64, f64)) -> f64| {
        let value = |k: &usize| pick(&both[*k]);
        let k = (0..samples).min_by(|a, b| value(a).total_cmp(&value(b))).expect("a sample");
        (pick(&both[k]), k as f64)
    };
    let (hull_m, hull_s) = least(|both| both.0);
    let (centre_m, centre_s) = least(|both| both.1);
    Pair {
        hull_m: both.iter().map(|both| both.0).collect(),
        minimum: PairMinimum { hull_m, hull_s, centre_m, centre_s },
        detected_s: Some(0.0),
        tracked_s: Some(0.0),
    }
}
