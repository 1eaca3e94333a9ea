"""Thirty lines: steer for the goal; turn 30 degrees to starboard while a track is near ahead."""

import math

import seatrial


class First(seatrial.Planner):
    version = "1"

    def reset(self, mission):
        self.goal_m = mission.route[-1].position_m
        self.cruise_mps = mission.cruise_mps
        self.near_m = 4 * mission.safety_radius_m

    def plan(self, situation):
        north_m, east_m = situation.own.position_m
        course_rad = math.atan2(self.goal_m[1] - east_m, self.goal_m[0] - north_m)
        for track in situation.tracks:
            to_north_m, to_east_m = track.position_m[0] - north_m, track.position_m[1] - east_m
            bearing_rad = math.atan2(to_east_m, to_north_m) - course_rad
            ahead = math.cos(bearing_rad) > 0.5
            if ahead and math.hypot(to_north_m, to_east_m) < self.near_m:
                turned = seatrial.alert(track.id, rule="8", why="near ahead")
                return seatrial.course_speed(course_rad + math.pi / 6, self.cruise_mps, [turned])
        return seatrial.course_speed(course_rad, self.cruise_mps)


if __name__ == "__main__":
    seatrial.run(First())
