// The small velocity-obstacle planner in C++, as a shared library; ../rust/src/planner.rs says what
// it does and why it uses only + - * / sqrt and comparisons.
//
//     c++ -std=c++17 -O2 -ffp-contract=off -shared -fPIC -I../../crates/planner-host/include
//         small_vo.cpp -o libsmall_vo_cpp.so
//     seatrial campaign quick --planner lib:./libsmall_vo_cpp.so

#include "seatrial_planner.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <new>
#include <vector>

namespace {

// Cosine and sine of the 15 degrees between two courses that it tries.
constexpr double kCosStep = 0.9659258262890683;
constexpr double kSinStep = 0.25881904510252074;
// Courses that it tries on each side.
constexpr int kSteps = 6;
// How far it looks ahead, seconds.
constexpr double kHorizonS = 600.0;
// A waypoint this near is passed, metres.
constexpr double kPassedM = 50.0;

struct Velocity {
    double north = 0.0, east = 0.0;
};

struct Margin {
    double value = std::numeric_limits<double>::infinity();
    uint32_t track = 0;
};

class SmallVo {
public:
    void reset(const SeatrialMission &mission) {
        mission_ = mission;
        route_.assign(mission.route, mission.route + mission.route_len);
        next_ = 0;
    }

    void plan(const SeatrialSituation &situation, SeatrialCommand &command) {
        Velocity best = preferred(situation.own);
        const Margin planned = margin(situation, best);
        double best_margin = planned.value;
        if (best_margin < 0.0) {
            command.alerts_len = 1;
            SeatrialAlert &alert = command.alerts[0];
            alert.track = planned.track;
            std::snprintf(alert.rule, sizeof alert.rule, "8");
            std::snprintf(alert.why, sizeof alert.why,
                          "inside the safety radius on the planned course");
            for (const Velocity &candidate : candidates(best)) {
                const double candidate_margin = margin(situation, candidate).value;
                if (candidate_margin > best_margin) {
                    best_margin = candidate_margin;
                    best = candidate;
                }
                if (candidate_margin >= 0.0) {
                    break;
                }
            }
        }
        command.kind = SEATRIAL_VELOCITY;
        command.north_mps = best.north;
        command.east_mps = best.east;
    }

private:
    // The velocity towards the next waypoint; passes those that are near.
    Velocity preferred(const SeatrialOwn &own) {
        for (;;) {
            const SeatrialWaypoint &waypoint = route_.at(next_);
            const double north = waypoint.north_m - own.north_m;
            const double east = waypoint.east_m - own.east_m;
            const double distance_m = std::sqrt(north * north + east * east);
            if (distance_m <= kPassedM && next_ + 1 < route_.size()) {
                next_ += 1;
                continue;
            }
            double speed_mps =
                std::isnan(waypoint.speed_mps) ? mission_.cruise_mps : waypoint.speed_mps;
            if (speed_mps > mission_.own.speed_mps_max) {
                speed_mps = mission_.own.speed_mps_max;
            }
            if (distance_m < 1.0) {
                return {0.0, 0.0};
            }
            return {north / distance_m * speed_mps, east / distance_m * speed_mps};
        }
    }

    static std::vector<Velocity> candidates(Velocity from) {
        std::vector<Velocity> all;
        Velocity starboard = from, port = from;
        for (int i = 0; i < kSteps; i++) {
            starboard = {starboard.north * kCosStep - starboard.east * kSinStep,
                         starboard.north * kSinStep + starboard.east * kCosStep};
            port = {port.north * kCosStep + port.east * kSinStep,
                    port.east * kCosStep - port.north * kSinStep};
            all.push_back(starboard);
            all.push_back(port);
        }
        all.push_back({0.0, 0.0});
        return all;
    }

    // The smallest (square of the distance less square of the radius), and whose track it is.
    Margin margin(const SeatrialSituation &situation, Velocity velocity) const {
        Margin smallest;
        for (size_t i = 0; i < situation.tracks_len; i++) {
            const SeatrialTrack &track = situation.tracks[i];
            const double one = margin_of(situation.own, velocity, track);
            if (one < smallest.value) {
                smallest = {one, track.id};
            }
        }
        return smallest;
    }

    double margin_of(const SeatrialOwn &own, Velocity velocity, const SeatrialTrack &track) const {
        double radius_m = mission_.safety_radius_m;
        if (!mission_.between_centres) {
            const double length_m =
                std::isnan(track.length_m) ? mission_.own.length_m : track.length_m;
            radius_m += (mission_.own.length_m + length_m) / 2.0;
        }
        double north = track.north_m - own.north_m;
        double east = track.east_m - own.east_m;
        const double north_mps = track.north_mps - velocity.north;
        const double east_mps = track.east_mps - velocity.east;
        const double speed_squared = north_mps * north_mps + east_mps * east_mps;
        double t_s = 0.0;
        if (speed_squared > 0.0) {
            t_s = -(north * north_mps + east * east_mps) / speed_squared;
        }
        if (t_s < 0.0) {
            t_s = 0.0;
        }
        if (t_s > kHorizonS) {
            t_s = kHorizonS;
        }
        north = north + north_mps * t_s;
        east = east + east_mps * t_s;
        return north * north + east * east - radius_m * radius_m;
    }

    SeatrialMission mission_{};
    std::vector<SeatrialWaypoint> route_;
    size_t next_ = 0;
};

// An exception must not leave a function that the bench calls.
template <typename Body> int32_t guarded(Body body) {
    try {
        body();
        return 0;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "small_vo: %s\n", error.what());
        return 1;
    }
}

void *create() { return new (std::nothrow) SmallVo(); }

int32_t reset(void *vo, const SeatrialMission *mission) {
    return guarded([&] { static_cast<SmallVo *>(vo)->reset(*mission); });
}

int32_t plan(void *vo, const SeatrialSituation *situation, SeatrialCommand *command) {
    return guarded([&] { static_cast<SmallVo *>(vo)->plan(*situation, *command); });
}

void destroy(void *vo) { delete static_cast<SmallVo *>(vo); }

} // namespace

extern "C" const SeatrialPlanner *seatrial_planner_v1(void) {
    static const SeatrialPlanner planner = {
        SEATRIAL_PLANNER_ABI, "small-vo-cpp", "1", create, reset, plan, destroy,
    };
    return &planner;
}
