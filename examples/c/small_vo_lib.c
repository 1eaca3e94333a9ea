/* The planner as a shared library:
 *
 *     cc -O2 -ffp-contract=off -shared -fPIC -I../../crates/planner-host/include \
 *        small_vo.c small_vo_lib.c -lm -o libsmall_vo.so
 *     seatrial campaign quick --planner lib:./libsmall_vo.so
 */
#include "small_vo.h"

static void *create(void) { return calloc(1, sizeof(SmallVo)); }

static int32_t reset(void *vo, const SeatrialMission *mission) {
    return small_vo_reset(vo, mission);
}

static int32_t plan(void *vo, const SeatrialSituation *situation, SeatrialCommand *command) {
    return small_vo_plan(vo, situation, command);
}

const SeatrialPlanner *seatrial_planner_v1(void) {
    static const SeatrialPlanner planner = {
        .abi = SEATRIAL_PLANNER_ABI,
        .name = "small-vo-c",
        .version = "1",
        .create = create,
        .reset = reset,
        .plan = plan,
        .destroy = free,
    };
    return &planner;
}
