"""The small velocity-obstacle planner in Python; ../rust/src/planner.rs says what it does.

Only + - * / sqrt and comparisons, the same ones in the same order in every language: so all four
give the same bits.  `seatrial campaign quick --planner 'exec:python3 small_vo.py'`
"""

from math import inf, sqrt

import seatrial

# Cosine and sine of the 15 degrees between two courses that it tries.
COS_STEP, SIN_STEP = 0.9659258262890683, 0.25881904510252074
# Courses that it tries on each side.
STEPS = 6
# How far it looks ahead, seconds; a waypoint nearer than this is passed, metres.
HORIZON_S, PASSED_M = 600.0, 50.0


class SmallVo(seatrial.Planner):
    version = "1"

    def reset(self, mission):
        self.mission = mission
        self.next = 0

    def plan(self, situation):
        own_m = situation.own.position_m
        tracks = [self.obstacle(track, own_m) for track in situation.tracks]
        best = self.preferred(own_m)
        best_margin, worst = margin(tracks, *best)
        if best_margin >= 0.0:
            return seatrial.velocity(*best)
        why = "inside the safety radius on the planned course"
        alerts = [seatrial.alert(worst, "8", why)]
        for candidate in candidates(*best):
            candidate_margin, _ = margin(tracks, *candidate)
            if candidate_margin > best_margin:
                best_margin, best = candidate_margin, candidate
            if candidate_margin >= 0.0:
                break
        return seatrial.velocity(*best, alerts)

    def preferred(self, own_m):
        """The velocity towards the next waypoint; passes those that are near."""
        mission = self.mission
        while True:
            waypoint = mission.route[self.next]
            north, east = waypoint.position_m[0] - own_m[0], waypoint.position_m[1] - own_m[1]
            distance_m = sqrt(north * north + east * east)
            if distance_m <= PASSED_M and self.next + 1 < len(mission.route):
                self.next += 1
                continue
            speed_mps = waypoint.speed_mps
            if speed_mps is None:
                speed_mps = mission.cruise_mps
            if speed_mps > mission.own.speed_mps_max:
                speed_mps = mission.own.speed_mps_max
            if distance_m < 1.0:
                return 0.0, 0.0
            return north / distance_m * speed_mps, east / distance_m * speed_mps

    def obstacle(self, track, own_m):
        """Number, relative position, velocity and square of the radius to keep from a track."""
        radius_m = self.mission.safety_radius_m
        if not self.mission.between_centres:
            own_length_m = self.mission.own.length_m
            length_m = own_length_m if track.length_m is None else track.length_m
            radius_m += (own_length_m + length_m) / 2.0
        position_m, (north_mps, east_mps) = track.position_m, track.velocity_mps
        north, east = position_m[0] - own_m[0], position_m[1] - own_m[1]
        return track.id, north, east, north_mps, east_mps, radius_m * radius_m


def candidates(north, east):
    starboard_n = port_n = north
    starboard_e = port_e = east
    for _ in range(STEPS):
        starboard_n, starboard_e = (
            starboard_n * COS_STEP - starboard_e * SIN_STEP,
            starboard_n * SIN_STEP + starboard_e * COS_STEP,
        )
        yield starboard_n, starboard_e
        port_n, port_e = (
            port_n * COS_STEP + port_e * SIN_STEP,
            port_e * COS_STEP - port_n * SIN_STEP,
        )
        yield port_n, port_e
    yield 0.0, 0.0


def margin(tracks, own_north_mps, own_east_mps):
    """The smallest (square of the distance less square of the radius), and whose track it is."""
    smallest, whose = inf, 0
    for track, north, east, north_mps, east_mps, radius_squared in tracks:
        north_mps, east_mps = north_mps - own_north_mps, east_mps - own_east_mps
        speed_squared = north_mps * north_mps + east_mps * east_mps
        t_s = 0.0
        if speed_squared > 0.0:
            t_s = -(north * north_mps + east * east_mps) / speed_squared
        if t_s < 0.0:
            t_s = 0.0
        if t_s > HORIZON_S:
            t_s = HORIZON_S
        north, east = north + north_mps * t_s, east + east_mps * t_s
        one = north * north + east * east - radius_squared
        if one < smallest:
            smallest, whose = one, track
    return smallest, whose


if __name__ == "__main__":
    seatrial.run(SmallVo())
