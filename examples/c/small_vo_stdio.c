/* The planner as a process that speaks JSON lines:
 *
 *     cc -O2 -ffp-contract=off -I../../crates/planner-host/include \
 *        small_vo.c small_vo_stdio.c -lm -o small_vo
 *     seatrial campaign quick --planner exec:./small_vo
 */
#define _POSIX_C_SOURCE 200809L

#include "json.h"
#include "small_vo.h"

#include <stdio.h>

static int is_type(const char *message, const char *type) {
    const char *value = json_member(message, "type");
    size_t length = strlen(type);
    return value && strncmp(value + 1, type, length) == 0 && value[1 + length] == '"';
}

static int read_mission(SmallVo *vo, const char *mission) {
    SeatrialWaypoint route[SMALL_VO_ROUTE_MAX];
    const char *own = json_member(mission, "own");
    SeatrialMission read = {
        .own = {.length_m = json_member_number(own, "length_m"),
                .beam_m = json_member_number(own, "beam_m"),
                .speed_mps_max = json_member_number(own, "speed_mps_max"),
                .yaw_rate_radps_max = json_member_number(own, "yaw_rate_radps_max"),
                .acceleration_mps2_max = json_member_number(own, "acceleration_mps2_max")},
        .route = route,
        .cruise_mps = json_member_number(mission, "cruise_mps"),
        .safety_radius_m = json_member_number(mission, "safety_radius_m"),
        .beat_s = json_member_number(mission, "beat_s"),
        .stream_seed = strtoull(json_member(mission, "stream_seed") + 1, NULL, 16),
        .between_centres = *json_member(mission, "between_centres") == 't',
    };
    const char *waypoint = json_first(json_member(mission, "route"));
    for (; waypoint && read.route_len < SMALL_VO_ROUTE_MAX; waypoint = json_next(waypoint)) {
        SeatrialWaypoint *to = &route[read.route_len++];
        json_pair(json_member(waypoint, "position_m"), &to->north_m, &to->east_m);
        to->speed_mps = json_member_number(waypoint, "speed_mps");
    }
    return small_vo_reset(vo, &read);
}

enum { TRACKS_MAX = 1024 };

/* What this planner reads of a situation; the rest stays zero. */
static int answer(SmallVo *vo, const char *message, SeatrialCommand *command) {
    static SeatrialTrack tracks[TRACKS_MAX];
    SeatrialSituation situation = {.t_s = json_member_number(message, "t_s"), .tracks = tracks};
    const char *own = json_member(message, "own");
    json_pair(json_member(own, "position_m"), &situation.own.north_m, &situation.own.east_m);
    const char *track = json_first(json_member(message, "tracks"));
    for (; track && situation.tracks_len < TRACKS_MAX; track = json_next(track)) {
        SeatrialTrack *to = &tracks[situation.tracks_len++];
        to->id = (uint32_t)json_member_number(track, "id");
        json_pair(json_member(track, "position_m"), &to->north_m, &to->east_m);
        json_pair(json_member(track, "velocity_mps"), &to->north_mps, &to->east_mps);
        to->length_m = json_member_number(track, "length_m");
    }
    return small_vo_plan(vo, &situation, command);
}

int main(void) {
    static SmallVo vo;
    char *line = NULL;
    size_t room = 0;
    while (getline(&line, &room, stdin) > 0) {
        double seq = is_type(line, "hello") ? 0.0 : json_member_number(line, "seq");
        if (is_type(line, "hello")) {
            puts("{\"type\":\"hello\",\"protocol\":1,\"name\":\"small-vo-c\",\"version\":\"1\"}");
        } else if (is_type(line, "reset")) {
            if (read_mission(&vo, json_member(line, "mission")) != 0) {
                fputs("small_vo: the route has too many waypoints\n", stderr);
                return 1;
            }
            printf("{\"type\":\"ready\",\"seq\":%.0f}\n", seq);
        } else if (is_type(line, "plan")) {
            SeatrialCommand command = {0};
            answer(&vo, line, &command);
            printf("{\"type\":\"order\",\"seq\":%.0f,\"order\":", seq);
            printf("{\"velocity_mps\":[%.17g,%.17g]}", command.north_mps, command.east_mps);
            if (command.alerts_len > 0) {
                const SeatrialAlert *alert = &command.alerts[0];
                printf(",\"alerts\":[{\"track\":%u,\"rule\":\"%s\",\"why\":\"%s\"}]", alert->track,
                       alert->rule, alert->why);
            }
            puts("}");
        }
        fflush(stdout);
    }
    free(line);
    return 0;
}
