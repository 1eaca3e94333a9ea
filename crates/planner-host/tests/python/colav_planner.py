"""A planner with the interface of the NTNU COLAV simulator, to try the adapter with."""

print("a planner may print while it is imported")


class Checks:
    """Answers with numbers that show what it was given; fails on anything of an unexpected form."""

    def __init__(self):
        self.resets = 0

    def reset(self):
        self.resets += 1
        print("and when it is reset")

    def plan(
        self, t, waypoints, speed_plan, ownship_state, do_list, enc=None, goal_state=None, **kwargs
    ):
        assert enc is None and kwargs["w"] is None and "goal_pose" not in kwargs, kwargs
        assert [len(row) for row in waypoints] == [3, 3], waypoints
        assert [row[0] for row in waypoints] == [10.0, 20.0], "the route begins at own ship"
        assert [row[2] for row in waypoints] == [1000.0, 0.0], waypoints
        assert list(speed_plan) == [4.0, 7.0, 7.0], speed_plan
        assert len(goal_state) == 6 and list(goal_state[:2]) == [1000.0, 0.0], goal_state
        assert kwargs["os_length"] == 8.45, kwargs
        track, state, covariance, length_m, width_m = do_list[0]
        assert track == 5 and list(state) == [1.0, 2.0, 3.0, 4.0], state
        assert [row[i] for i, row in enumerate(covariance)] == [9.0, 8.0, 7.0, 6.0], covariance
        assert (length_m, width_m) == (100.0, 2.71), "an unknown beam is taken from own ship"
        x, y, psi, surge, sway, yaw_rate = ownship_state
        # heading east with a velocity to the north-east: ahead is east, to port is north
        assert abs(surge - 2.0) < 1e-12 and abs(sway + 3.0) < 1e-12, ownship_state
        rows = [[0.0]] * 9
        rows[2], rows[3] = [7.0 + t], [self.resets + yaw_rate]
        return rows


class Older:
    """The first form of the call."""

    def plan(self, t, waypoints, speed_plan, ownship_state, do_list, enc=None, goal_pose=None):
        assert list(goal_pose[:2]) == [1000.0, 0.0], goal_pose
        return [[0.0], [0.0], [float("nan")], [5.0], [0.0], [0.0], [0.0], [0.0], [0.0]]
