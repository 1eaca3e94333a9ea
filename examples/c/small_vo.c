#include "small_vo.h"

#include <math.h>
#include <string.h>

/* Cosine and sine of the 15 degrees between two courses that it tries. */
static const double COS_STEP = 0.9659258262890683;
static const double SIN_STEP = 0.25881904510252074;
/* Courses that it tries on each side. */
enum { STEPS = 6 };
/* How far it looks ahead, seconds. */
static const double HORIZON_S = 600.0;
/* A waypoint this near is passed, metres. */
static const double PASSED_M = 50.0;

typedef struct {
    double north, east;
} Velocity;

int32_t small_vo_reset(SmallVo *vo, const SeatrialMission *mission) {
    if (mission->route_len == 0 || mission->route_len > SMALL_VO_ROUTE_MAX) {
        return 1;
    }
    vo->mission = *mission;
    memcpy(vo->route, mission->route, mission->route_len * sizeof *mission->route);
    vo->mission.route = vo->route;
    vo->next = 0;
    return 0;
}

/* The velocity towards the next waypoint; passes those that are near. */
static Velocity preferred(SmallVo *vo, const SeatrialOwn *own) {
    for (;;) {
        const SeatrialWaypoint *waypoint = &vo->route[vo->next];
        double north = waypoint->north_m - own->north_m, east = waypoint->east_m - own->east_m;
        double distance_m = sqrt(north * north + east * east);
        if (distance_m <= PASSED_M && vo->next + 1 < vo->mission.route_len) {
            vo->next += 1;
            continue;
        }
        double speed_mps = waypoint->speed_mps;
        if (isnan(speed_mps)) {
            speed_mps = vo->mission.cruise_mps;
        }
        if (speed_mps > vo->mission.own.speed_mps_max) {
            speed_mps = vo->mission.own.speed_mps_max;
        }
        if (distance_m < 1.0) {
            return (Velocity){0.0, 0.0};
        }
        return (Velocity){north / distance_m * speed_mps, east / distance_m * speed_mps};
    }
}

static double margin_of(const SmallVo *vo, const SeatrialOwn *own, Velocity velocity,
                        const SeatrialTrack *track) {
    double radius_m = vo->mission.safety_radius_m;
    if (!vo->mission.between_centres) {
        double length_m = isnan(track->length_m) ? vo->mission.own.length_m : track->length_m;
        radius_m += (vo->mission.own.length_m + length_m) / 2.0;
    }
    double north = track->north_m - own->north_m, east = track->east_m - own->east_m;
    double north_mps = track->north_mps - velocity.north;
    double east_mps = track->east_mps - velocity.east;
    double speed_squared = north_mps * north_mps + east_mps * east_mps;
    double t_s = 0.0;
    if (speed_squared > 0.0) {
        t_s = -(north * north_mps + east * east_mps) / speed_squared;
    }
    if (t_s < 0.0) {
        t_s = 0.0;
    }
    if (t_s > HORIZON_S) {
        t_s = HORIZON_S;
    }
    north = north + north_mps * t_s;
    east = east + east_mps * t_s;
    return north * north + east * east - radius_m * radius_m;
}

/* The smallest (square of the distance less square of the radius), and whose track it is. */
static double margin(const SmallVo *vo, const SeatrialSituation *situation, Velocity velocity,
                     uint32_t *whose) {
    double smallest = INFINITY;
    for (size_t i = 0; i < situation->tracks_len; i++) {
        double one = margin_of(vo, &situation->own, velocity, &situation->tracks[i]);
        if (one < smallest) {
            smallest = one;
            *whose = situation->tracks[i].id;
        }
    }
    return smallest;
}

int32_t small_vo_plan(SmallVo *vo, const SeatrialSituation *situation, SeatrialCommand *command) {
    Velocity best = preferred(vo, &situation->own);
    uint32_t worst = 0, ignored = 0;
    double best_margin = margin(vo, situation, best, &worst);
    if (best_margin < 0.0) {
        command->alerts_len = 1;
        command->alerts[0].track = worst;
        strcpy(command->alerts[0].rule, "8");
        strcpy(command->alerts[0].why, "inside the safety radius on the planned course");
        Velocity candidates[2 * STEPS + 1];
        Velocity starboard = best, port = best;
        for (int i = 0; i < STEPS; i++) {
            starboard = (Velocity){starboard.north * COS_STEP - starboard.east * SIN_STEP,
                                   starboard.north * SIN_STEP + starboard.east * COS_STEP};
            port = (Velocity){port.north * COS_STEP + port.east * SIN_STEP,
                              port.east * COS_STEP - port.north * SIN_STEP};
            candidates[2 * i] = starboard;
            candidates[2 * i + 1] = port;
        }
        candidates[2 * STEPS] = (Velocity){0.0, 0.0};
        for (int i = 0; i <= 2 * STEPS; i++) {
            double candidate_margin = margin(vo, situation, candidates[i], &ignored);
            if (candidate_margin > best_margin) {
                best_margin = candidate_margin;
                best = candidates[i];
            }
            if (candidate_margin >= 0.0) {
                break;
            }
        }
    }
    command->kind = SEATRIAL_VELOCITY;
    command->north_mps = best.north;
    command->east_mps = best.east;
    return 0;
}
