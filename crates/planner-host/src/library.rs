//! `lib:`: a planner in a shared library with the C interface of [`crate::abi`].
//!
//! The library runs inside the engine process. A crash takes that process with it; the supervisor
//! of a campaign finds the encounter, writes its row and goes on behind it.
#![expect(unsafe_code, reason = "functions of a library are foreign functions")]

use crate::abi::{self, SeatrialCommand, SeatrialMission, SeatrialPlanner, SeatrialSituation};
use geom::Vec2;
use planner_api::{
    Alert, Command, FailureKind, Mission, Order, OwnState, Planner, PlannerFailure, Situation,
    TargetTrack,
};
use std::ffi::{CStr, c_char, c_void};
use std::path::Path;

/// The exported function, one name for each version of the interface.
const ENTRY: &[u8] = b"seatrial_planner_v1\0";

type ResetFn = unsafe extern "C" fn(*mut c_void, *const SeatrialMission) -> i32;
type PlanFn =
    unsafe extern "C" fn(*mut c_void, *const SeatrialSituation, *mut SeatrialCommand) -> i32;
type DestroyFn = unsafe extern "C" fn(*mut c_void);

/// One instance of a planner in a library.
#[derive(Debug)]
pub(crate) struct LibraryPlanner {
    label: String,
    instance: *mut c_void,
    reset: ResetFn,
    plan: PlanFn,
    destroy: DestroyFn,
    tracks: Vec<abi::SeatrialTrack>,
    command: Box<SeatrialCommand>,
}

// SAFETY: the interface demands that an instance may move between threads as long as one uses it at
// a time, and `&mut self` sees to that.
unsafe impl Send for LibraryPlanner {}

impl LibraryPlanner {
    /// Loads the library and makes an instance; the error says what is wrong.
    pub(crate) fn load(path: &Path) -> Result<Self, String> {
        // SAFETY: loading runs the library's initialisers, which is what the user asked for by
        // naming it; a library is trusted not to break the process any more than it must.
        let library = unsafe { libloading::Library::new(path) }
            .map_err(|error| format!("`{}` cannot be loaded: {error}", path.display()))?;
        // Never unloaded: functions and names of a planner must outlive every instance, and a
        // library with threads or thread locals does not survive being unloaded.
        let library = Box::leak(Box::new(library));
        // SAFETY: the version in the symbol's name promises this type.
        let entry = unsafe { library.get::<abi::SeatrialEntry>(ENTRY) }.map_err(|_| {
            let (path, wanted) = (path.display(), abi::SEATRIAL_PLANNER_ABI);
            format!("`{path}` has no function `seatrial_planner_v1` (interface version {wanted})")
        })?;
        // SAFETY: the function takes nothing; null or a planner that lives for ever is returned.
        let planner = unsafe { entry().as_ref() }
            .ok_or_else(|| format!("`{}` returned no planner", path.display()))?;
        Self::new(planner, path)
    }

    fn new(planner: &SeatrialPlanner, path: &Path) -> Result<Self, String> {
        let (theirs, ours) = (planner.abi, abi::SEATRIAL_PLANNER_ABI);
        if theirs != ours {
            let path = path.display();
            return Err(format!("`{path}` has interface version {theirs}, the bench {ours}"));
        }
        let (Some(create), Some(reset), Some(plan), Some(destroy)) =
            (planner.create, planner.reset, planner.plan, planner.destroy)
        else {
            return Err(format!("`{}` leaves a function out", path.display()));
        };
        let label = format!("`{}` {}", text_at(planner.name), text_at(planner.version));
        // SAFETY: takes nothing; the returned pointer only goes back into the same library.
        let instance = unsafe { create() };
        if instance.is_null() {
            return Err(format!("planner {label} could not be created"));
        }
        let command = Box::new(EMPTY);
        Ok(Self { label, instance, reset, plan, destroy, tracks: Vec::new(), command })
    }

    fn check(&self, word: &str, result: i32) {
        if result != 0 {
            let what = format!("planner {} returned {result} from `{word}`", self.label);
            PlannerFailure { kind: FailureKind::Crashed, detail: what }.raise();
        }
    }

    fn broken(&self, what: &str) -> ! {
        let detail = format!("planner {} {what}", self.label);
        PlannerFailure { kind: FailureKind::Protocol, detail }.raise()
    }

    fn read_command(&self) -> Command {
        let answer = &self.command;
        let order = match answer.kind {
            abi::SEATRIAL_COURSE_SPEED => {
                Order::CourseSpeed { course_rad: answer.course_rad, speed_mps: answer.speed_mps }
            }
            abi::SEATRIAL_VELOCITY => {
                Order::Velocity { velocity_mps: Vec2::new(answer.north_mps, answer.east_mps) }
            }
            kind => self.broken(&format!("left an order of the unknown kind {kind}")),
        };
        let Some(alerts) = answer.alerts.get(..answer.alerts_len) else {
            self.broken(&format!("declared {} alerts, more than fit", answer.alerts_len));
        };
        let alerts = alerts.iter().map(|alert| Alert {
            track: alert.track,
            rule: text_in(&alert.rule),
            why: text_in(&alert.why),
        });
        Command { order, alerts: alerts.collect() }
    }
}

impl Planner for LibraryPlanner {
    fn reset(&mut self, mission: &Mission) {
        let Mission {
            own,
            route,
            cruise_mps,
            safety_radius_m,
            between_centres,
            beat_s,
            hazards,
            stream_seed,
        } = mission;
        let route: Vec<abi::SeatrialWaypoint> = route
            .iter()
            .map(|waypoint| abi::SeatrialWaypoint {
                north_m: waypoint.position_m.x,
                east_m: waypoint.position_m.y,
                speed_mps: waypoint.speed_mps.unwrap_or(f64::NAN),
            })
            .collect();
        let corners: Vec<Vec<abi::SeatrialPoint>> = hazards
            .iter()
            .map(|hazard| {
                let point = |c: &Vec2| abi::SeatrialPoint { north_m: c.x, east_m: c.y };
                hazard.iter().map(point).collect()
            })
            .collect();
        let hazards: Vec<abi::SeatrialHazard> = corners
            .iter()
            .map(|hazard| abi::SeatrialHazard {
                corners: hazard.as_ptr(),
                corners_len: hazard.len(),
            })
            .collect();
        let mission = SeatrialMission {
            own: abi::SeatrialOwnShip {
                length_m: own.length_m,
                beam_m: own.beam_m,
                speed_mps_max: own.speed_mps_max,
                yaw_rate_radps_max: own.yaw_rate_radps_max,
                acceleration_mps2_max: own.acceleration_mps2_max,
            },
            route: route.as_ptr(),
            route_len: route.len(),
            cruise_mps: *cruise_mps,
            safety_radius_m: *safety_radius_m,
            beat_s: *beat_s,
            stream_seed: *stream_seed,
            between_centres: u32::from(*between_centres),
            hazards: hazards.as_ptr(),
            hazards_len: hazards.len(),
        };
        // SAFETY: the instance came from `create` of the same library and is not destroyed; the
        // mission, its route and its hazards outlive the call.
        let result = unsafe { (self.reset)(self.instance, &raw const mission) };
        self.check("reset", result);
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        self.tracks.clear();
        self.tracks.extend(situation.tracks.iter().map(track));
        let seen = SeatrialSituation {
            t_s: situation.t_s,
            own: own(&situation.own),
            tracks: self.tracks.as_ptr(),
            tracks_len: self.tracks.len(),
            visual_range_m: situation.visual_range_m.unwrap_or(f64::INFINITY),
        };
        // The rest is not read before the planner writes it; clearing it all would cost as much as
        // a whole call.
        (self.command.kind, self.command.alerts_len) = (0, 0);
        // SAFETY: as in `reset`; the command is valid for a write, and any bits that the planner
        // writes are valid numbers.
        let result = unsafe { (self.plan)(self.instance, &raw const seen, &raw mut *self.command) };
        self.check("plan", result);
        self.read_command()
    }
}

impl Drop for LibraryPlanner {
    fn drop(&mut self) {
        // SAFETY: the instance came from `create` of the same library and is used no more.
        unsafe { (self.destroy)(self.instance) };
    }
}

/// What a command holds before the planner fills it.
const EMPTY: SeatrialCommand = SeatrialCommand {
    kind: 0,
    course_rad: 0.0,
    speed_mps: 0.0,
    north_mps: 0.0,
    east_mps: 0.0,
    alerts_len: 0,
    alerts: [abi::SeatrialAlert {
        track: 0,
        rule: [0; abi::SEATRIAL_TEXT_MAX],
        why: [0; abi::SEATRIAL_TEXT_MAX],
    }; abi::SEATRIAL_ALERTS_MAX],
};

const fn own(own: &OwnState) -> abi::SeatrialOwn {
    let [[north_m, east_m]] = own.position_m.data.0;
    let [[north_mps, east_mps]] = own.velocity_mps.data.0;
    abi::SeatrialOwn {
        north_m,
        east_m,
        psi_rad: own.psi_rad,
        north_mps,
        east_mps,
        cog_rad: own.cog_rad,
        sog_mps: own.sog_mps,
        stw_mps: own.stw_mps,
        yaw_rate_radps: own.yaw_rate_radps,
    }
}

fn track(track: &TargetTrack) -> abi::SeatrialTrack {
    abi::SeatrialTrack {
        id: track.id,
        north_m: track.position_m.x,
        east_m: track.position_m.y,
        north_mps: track.velocity_mps.x,
        east_mps: track.velocity_mps.y,
        cog_rad: track.cog_rad,
        sog_mps: track.sog_mps,
        psi_rad: track.psi_rad.unwrap_or(f64::NAN),
        length_m: track.length_m.unwrap_or(f64::NAN),
        beam_m: track.beam_m.unwrap_or(f64::NAN),
        covariance: track.covariance,
        age_s: track.age_s,
        since_update_s: track.since_update_s,
    }
}

/// The text that a pointer of the library means.
fn text_at(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: not null, and the interface demands a closing zero and a life for ever.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}

/// The text in a field, up to its zero or its end.
fn text_in(field: &[c_char; abi::SEATRIAL_TEXT_MAX]) -> String {
    let bytes = field.iter().take_while(|c| **c != 0).map(|c| c.to_ne_bytes()[0]);
    String::from_utf8_lossy(&bytes.collect::<Vec<u8>>()).into_owned()
}
