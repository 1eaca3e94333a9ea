/* A small velocity-obstacle planner; the same one stands in Rust, C++ and Python beside it.
 *
 * It steers for the next waypoint. If that would bring own ship nearer to a track than the safety
 * radius within ten minutes, it takes the smallest alteration that keeps clear, starboard first, in
 * steps of 15 degrees up to 90, then a stop; if none keeps clear, the one that comes least near.
 *
 * Only + - * / sqrt and comparisons, the same ones in the same order in every language, and
 * compiled with -ffp-contract=off: so all four give the same bits.
 */
#ifndef SMALL_VO_H
#define SMALL_VO_H

#include "seatrial_planner.h"

#define SMALL_VO_ROUTE_MAX 256

typedef struct {
    SeatrialMission mission;
    SeatrialWaypoint route[SMALL_VO_ROUTE_MAX];
    size_t next;
} SmallVo;

/* Both return 0 when all is well. */
int32_t small_vo_reset(SmallVo *vo, const SeatrialMission *mission);
int32_t small_vo_plan(SmallVo *vo, const SeatrialSituation *situation, SeatrialCommand *command);

#endif
