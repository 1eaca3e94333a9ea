//! The formulas of section 12, as the verdicts of sections 4, 6, 8 and 9 bound them.
//!
//! Each is anchored at the first sample of the trace; the flag `clock` says where the clock of
//! section 3 runs. Contract: the robustness is negative exactly where the prose says FAIL.
//! `held` asks for the offset to have lasted, looking back; the flags that bound it look at when it
//! was made, so that an offset made within the clock counts, and one made after it does not.

use crate::formula::{Formula, always, at_least, at_most, eventually, flag, held};
use crate::params::Params;

/// Names of the columns.
pub mod column {
    /// Distance of the pair, metres, of the campaign's kind.
    pub const DISTANCE_M: &str = "distance_m";
    /// Flag: the hulls touch.
    pub const CONTACT: &str = "contact";
    /// Flag: the clock runs.
    pub const CLOCK: &str = "clock";
    /// Flag: the clock has run out.
    pub const CLEAR: &str = "clear";
    /// Offset of the heading on the action side, before the first return, radians.
    pub const ACTION_RAD: &str = "action_rad";
    /// Signed offset of the heading, radians.
    pub const TURN_RAD: &str = "turn_rad";
    /// Flag: an offset on the action side, held until now, was made before the first return.
    pub const TURN_CLOCK: &str = "turn_clock";
    /// Flag: an offset to port, held until now, was made where it can be blamed.
    pub const PORT_CLOCK: &str = "port_clock";
    /// Share of the speed that was taken off.
    pub const SPEED_CUT: &str = "speed_cut";
    /// Change of the speed of a stand-on ship, either way, as a share.
    pub const SPEED_CHANGE: &str = "speed_change";
    /// Flag: a change of speed, held until now, was made while she had to keep it.
    pub const SPEED_CLOCK: &str = "speed_clock";
    /// Change of her mean heading, either way, radians.
    pub const YAW_RAD: &str = "yaw_rad";
    /// Flag: a small action is enough, because the passing distance shows that it was.
    pub const SMALL_DID: &str = "small_did";
    /// Flag: own ship had settled it before risk opened.
    pub const SETTLED_EARLY: &str = "settled_early";
    /// Margin of crossing ahead, metres, positive where she crosses.
    pub const AHEAD_M: &str = "ahead_m";
    /// Flag: risk is open.
    pub const OPEN: &str = "open";
    /// Flag: a port turn that Rule 17(c) looks at is under way.
    pub const PORT_TURN: &str = "port_turn";
    /// `|alpha|`, radians.
    pub const ALPHA_RAD: &str = "alpha_rad";
    /// Flag: the ships close.
    pub const CLOSING: &str = "closing";
    /// Flag: a turn toward the overtaken ship's track ended here.
    pub const TURNED_IN: &str = "turned_in";
    /// Flag: the overtaken ship has been off her own plan, alone with own ship, until now.
    pub const FORCED: &str = "forced";
    /// Turn toward a target abeam or abaft the beam, radians.
    pub const TOWARD_RAD: &str = "toward_rad";
}
use column as c;

/// Rules 8(d) and 16: never under `limit_m`, never in contact.
pub fn safe(limit_m: f64, p: &Params) -> Formula {
    let clear_of = at_least(c::DISTANCE_M, limit_m, p.scale.distance_m);
    always(clear_of.and(flag(c::CONTACT).negated()))
}

/// Rule 8(b): an alteration large enough, or a small one that did.
pub fn apparent(turn_rad: f64, hold: usize, p: &Params) -> Formula {
    let reaches = |turn_rad: f64, speed: f64| {
        let turn = at_least(c::ACTION_RAD, turn_rad, p.scale.angle_rad);
        let slower = at_least(c::SPEED_CUT, speed, p.scale.speed);
        let turned = flag(c::TURN_CLOCK).and(held(turn, hold));
        eventually(turned.or(flag(c::CLOCK).and(held(slower, hold))))
    };
    let small = reaches(p.turn_detectable_rad, p.speed_detectable);
    reaches(turn_rad, p.speed_action).or(flag(c::SMALL_DID).and(small))
}

/// Rule 14: to starboard, and not to port before. "Not to port until starboard, or until the end"
/// is written as a flag that ends with the first of the two.
pub fn head_on(hold: usize, p: &Params) -> Formula {
    let port = held(at_most(c::TURN_RAD, -p.turn_action_rad, p.scale.angle_rad), hold);
    let starboard = held(at_least(c::TURN_RAD, p.turn_action_rad, p.scale.angle_rad), hold);
    let turns = eventually(flag(c::CLOCK).and(starboard));
    let first = always(flag(c::PORT_CLOCK).and(port).negated());
    first.and(turns)
}

/// Any duty, of a ship that had settled the encounter before there was risk.
pub fn unless_settled(formula: Formula) -> Formula {
    flag(c::SETTLED_EARLY).or(formula)
}

/// Rule 15: not across her bow until clear.
pub fn crossing(p: &Params) -> Formula {
    let ahead = at_least(c::AHEAD_M, 0.0, p.scale.distance_m);
    let across = || flag(c::CLOCK).and(flag(c::OPEN)).and(ahead.clone()).negated();
    across().until(flag(c::CLEAR).and(across()))
}

/// Rule 13(a) and (d): keeps clear of the ship she overtakes until past and clear.
pub fn overtaking(p: &Params) -> Formula {
    let across = at_least(c::AHEAD_M, 0.0, p.scale.distance_m);
    let near = at_least(c::DISTANCE_M, p.minimum_m, p.scale.distance_m).negated();
    let before_bow = at_least(c::ALPHA_RAD, p.overtaken_bow_rad, p.scale.angle_rad).negated();
    let too_close = flag(c::CLOSING).and(near).and(before_bow);
    let wrong = across.or(too_close).or(flag(c::TURNED_IN)).or(flag(c::FORCED));
    safe(p.minimum_m, p).and(always(flag(c::CLOCK).implies(wrong.negated())))
}

/// Rule 17(a)(i): holds course and speed.
pub fn stand_on(hold: usize, p: &Params) -> Formula {
    let turned = at_least(c::YAW_RAD, p.turn_action_rad, p.scale.angle_rad);
    let changed = at_least(c::SPEED_CHANGE, p.speed_action, p.scale.speed);
    let turned = flag(c::CLOCK).and(held(turned, hold));
    let changed = flag(c::SPEED_CLOCK).and(held(changed, hold));
    always(turned.or(changed).negated())
}

/// Rule 17(c): not to port for a ship on the port side.
pub fn not_to_port(hold: usize, p: &Params) -> Formula {
    let port = at_most(c::TURN_RAD, -p.turn_action_rad, p.scale.angle_rad);
    always(flag(c::CLOCK).implies(held(port, hold).negated()))
}

/// Rule 19(d): not to port for a ship forward of the beam, not toward one abeam or abaft it.
pub fn by_radar(hold: usize, p: &Params) -> Formula {
    let port = at_most(c::TURN_RAD, -p.turn_action_rad, p.scale.angle_rad);
    let port = flag(c::PORT_TURN).and(held(port, hold));
    let toward = held(at_least(c::TOWARD_RAD, p.turn_action_rad, p.scale.angle_rad), hold);
    always(flag(c::CLOCK).implies(port.or(toward).negated()))
}
