"""Planners in Python for the Seatrial test bench: one file, no dependencies.

    import seatrial

    class Straight(seatrial.Planner):
        def plan(self, situation):
            north_mps, east_mps = situation.own.velocity_mps
            return seatrial.velocity(north_mps, east_mps)

    if __name__ == "__main__":
        seatrial.run(Straight())

and then `seatrial campaign quick --planner 'exec:python3 straight.py'`. Metres north and east,
radians clockwise from north, metres a second, seconds. What `mission` and `situation` hold stands
in the JSON Schemas `reset.json` and `plan.json`, name by name.

A planner for the NTNU COLAV simulator runs unchanged: `exec:python3 -m seatrial module:Class`.
"""

import importlib
import inspect
import json
import math
import os
import sys

__version__ = "0.1.0"
PROTOCOL = 1


class Planner:
    """Base class. Override `plan`, and `reset` if the planner remembers anything."""

    #: Name and version in reports; the class name if not given.
    name = None
    version = "0"
    #: The only beat that it can plan at, seconds; None: any.
    beat_s = None
    #: What it cannot do without: "alerts", "covariance", "route", "velocity_orders".
    needs = ()

    def reset(self, mission):
        """Forget everything and prepare for one encounter."""

    def plan(self, situation):
        """The order for this beat: `velocity(...)` or `course_speed(...)`."""
        raise NotImplementedError("a planner needs a method plan(self, situation)")


def velocity(north_mps, east_mps, alerts=()):
    """An order: a velocity over ground."""
    return _answer({"velocity_mps": [float(north_mps), float(east_mps)]}, alerts)


def course_speed(course_rad, speed_mps, alerts=()):
    """An order: a course over ground, clockwise from north, and a speed."""
    order = {"course_rad": float(course_rad), "speed_mps": float(speed_mps)}
    return _answer({"course_speed": order}, alerts)


def alert(track, rule="", why=""):
    """A declared conflict: the track's number, the rule it follows, a reason for people."""
    return {"track": int(track), "rule": str(rule), "why": str(why)}


def _answer(order, alerts):
    return {"type": "order", "order": order, "alerts": list(alerts)}


def run(planner):
    """Serves the bench until it closes the connection. `print` goes to standard error."""
    answers = _take_standard_output()
    decode = json.JSONDecoder(object_hook=_Record).decode
    encode = json.JSONEncoder(separators=(",", ":")).encode
    for line in iter(sys.stdin.buffer.readline, b""):
        request = decode(line.decode())
        if request.type == "plan":
            answer = planner.plan(request)
        elif request.type == "reset":
            planner.reset(request.mission)
            answer = {"type": "ready"}
        elif request.type == "hello":
            answer = _hello(planner)
        else:
            raise ValueError(f"the bench sent an unknown message: {request.type}")
        if request.type != "hello":
            if not isinstance(answer, dict):
                raise TypeError("plan must return seatrial.velocity(...) or course_speed(...)")
            answer["seq"] = request.seq
        answers.write(encode(answer).encode() + b"\n")


_answers = None


def _take_standard_output():
    """What a planner or its libraries print from here on must not get between the answers."""
    global _answers
    if _answers is None:
        _answers = os.fdopen(os.dup(1), "wb", buffering=0)
        os.dup2(2, 1)
    return _answers


class _Record:
    """A JSON object whose members are attributes."""

    def __init__(self, members):
        self.__dict__ = members

    def __repr__(self):
        return f"{self.__dict__}"


def _hello(planner):
    return {
        "type": "hello",
        "protocol": PROTOCOL,
        "name": planner.name or type(planner).__name__,
        "version": str(planner.version),
        "beat_s": planner.beat_s,
        "needs": list(planner.needs),
    }


class NtnuPlanner(Planner):
    """Runs a planner with the interface of the NTNU COLAV simulator, unchanged.

    `colav.plan(t, waypoints, speed_plan, ownship_state, do_list, ...)` returns an array of nine
    rows (poses, velocities, accelerations); rows 2 and 3 of its first column are the course and the
    speed to steer. Arrays are numpy's where numpy is installed, else nested lists.
    """

    needs = ("covariance", "route")

    def __init__(self, colav):
        self.colav = colav
        self.name = type(colav).__name__
        self.mission = None
        self.waypoints = None
        parameters = inspect.signature(colav.plan).parameters.values()
        self.takes_all = any(p.kind is p.VAR_KEYWORD for p in parameters)
        self.takes = {p.name for p in parameters}

    def reset(self, mission):
        self.mission = mission
        self.waypoints = None
        if hasattr(self.colav, "reset"):
            self.colav.reset()

    def plan(self, situation):
        own = situation.own
        if self.waypoints is None:
            self._plan_route(own)
        north_mps, east_mps = own.velocity_mps
        cos, sin = math.cos(own.psi_rad), math.sin(own.psi_rad)
        surge_mps = north_mps * cos + east_mps * sin
        sway_mps = east_mps * cos - north_mps * sin
        state = [*own.position_m, own.psi_rad, surge_mps, sway_mps, own.yaw_rate_radps]
        result = self.colav.plan(
            situation.t_s,
            self.waypoints,
            self.speed_plan,
            _array(state),
            [self._obstacle(track) for track in situation.tracks],
            **self._optional(),
        )
        course_rad, speed_mps = float(result[2][0]), float(result[3][0])
        if math.isfinite(course_rad):
            course_rad = math.remainder(course_rad, math.tau)
        return course_speed(course_rad, speed_mps)

    def _plan_route(self, own):
        """The simulator's route begins where own ship begins."""
        route, cruise_mps = self.mission.route, self.mission.cruise_mps
        points = [own.position_m] + [waypoint.position_m for waypoint in route]
        self.waypoints = _array([[point[axis] for point in points] for axis in (0, 1)])
        speeds = [cruise_mps if w.speed_mps is None else w.speed_mps for w in route]
        self.speed_plan = _array(speeds + speeds[-1:])
        goal_rad = math.atan2(points[-1][1] - points[-2][1], points[-1][0] - points[-2][0])
        self.goal = [*points[-1], goal_rad]

    def _obstacle(self, track):
        length_m = self.mission.own.length_m if track.length_m is None else track.length_m
        beam_m = self.mission.own.beam_m if track.beam_m is None else track.beam_m
        state = _array([*track.position_m, *track.velocity_mps])
        return (track.id, state, _array(track.covariance), length_m, beam_m)

    def _optional(self):
        """What newer and older forms of the call take beyond its five first arguments."""
        speed_mps = float(self.speed_plan[-1])
        offered = {
            "enc": None,
            "goal_state": _array(self.goal + [speed_mps, 0.0, 0.0]),
            "goal_pose": _array(self.goal),
            "w": None,
            "os_length": self.mission.own.length_m,
            "os_width": self.mission.own.beam_m,
        }
        named = {name: value for name, value in offered.items() if name in self.takes}
        if self.takes_all:
            named.update({n: v for n, v in offered.items() if n not in named and n != "goal_pose"})
        return named


def _array(values):
    try:
        import numpy
    except ImportError:
        return values
    return numpy.array(values, dtype=float)


def _main(arguments):
    if len(arguments) != 1 or ":" not in arguments[0]:
        sys.exit("usage: python3 -m seatrial MODULE:CLASS")
    module, name = arguments[0].split(":", 1)
    sys.path.insert(0, os.getcwd())
    _take_standard_output()
    planner = getattr(importlib.import_module(module), name)()
    run(planner if isinstance(planner, Planner) else NtnuPlanner(planner))


if __name__ == "__main__":
    # As `-m seatrial` this file is `__main__`; planners import it under its own name.
    import seatrial

    seatrial._main(sys.argv[1:])
