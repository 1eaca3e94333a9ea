/* Seatrial: the C interface of a planner in a shared library.
 *
 * Made from crates/planner-host/src/abi.rs; do not edit. Metres, seconds, radians clockwise from
 * north. A library exports one function:
 *
 *     const SeatrialPlanner *seatrial_planner_v1(void);
 *
 * and is named on the command line as `lib:./libmy_planner.so`. See docs/your-planner.md.
 */

#ifndef SEATRIAL_PLANNER_H
#define SEATRIAL_PLANNER_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

// Version of this interface.
#define SEATRIAL_PLANNER_ABI 1

// `SeatrialCommand::kind`: a course and a speed.
#define SEATRIAL_COURSE_SPEED 1

// `SeatrialCommand::kind`: a velocity.
#define SEATRIAL_VELOCITY 2

// Room for declared alerts in a command.
#define SEATRIAL_ALERTS_MAX 8

// Room for the words of an alert, with the closing zero.
#define SEATRIAL_TEXT_MAX 64

// What does not change about own ship.
typedef struct SeatrialOwnShip {
  // Length over all, metres.
  double length_m;
  // Beam, metres.
  double beam_m;
  // Largest speed that may be ordered, m/s; the smallest is 0.
  double speed_mps_max;
  // Largest yaw rate, rad/s.
  double yaw_rate_radps_max;
  // Largest acceleration and deceleration, m/s^2.
  double acceleration_mps2_max;
} SeatrialOwnShip;

// A point of the route.
typedef struct SeatrialWaypoint {
  // Metres north.
  double north_m;
  // Metres east.
  double east_m;
  // Planned speed towards it, m/s; NaN: the cruise speed.
  double speed_mps;
} SeatrialWaypoint;

// A point in metres.
typedef struct SeatrialPoint {
  // Metres north.
  double north_m;
  // Metres east.
  double east_m;
} SeatrialPoint;

// Land, a pier or a shoal: a simple polygon, the last corner joined to the first.
typedef struct SeatrialHazard {
  // Corners.
  const struct SeatrialPoint *corners;
  // How many; at least three.
  size_t corners_len;
} SeatrialHazard;

// The task of one encounter. Pointers are valid during the call only.
//
// Later releases add fields at the end and nowhere else, so that a library that was built against
// an older header reads what it knows. Seatrial of before 0.2 ends with `between_centres`.
typedef struct SeatrialMission {
  // Own ship.
  struct SeatrialOwnShip own;
  // Waypoints ahead, the goal last; at least one.
  const struct SeatrialWaypoint *route;
  // How many.
  size_t route_len;
  // Planned speed, m/s.
  double cruise_mps;
  // Distance to keep from others, metres.
  double safety_radius_m;
  // Time between two plans, seconds.
  double beat_s;
  // Seed of the planner's own random numbers.
  uint64_t stream_seed;
  // 1: distances are between reference points; 0: from hull to hull.
  uint32_t between_centres;
  // Land, piers and shoals.
  const struct SeatrialHazard *hazards;
  // How many.
  size_t hazards_len;
} SeatrialMission;

// Own ship at a beat: metres, m/s north and east, radians clockwise from north.
typedef struct SeatrialOwn {
  // Metres north.
  double north_m;
  // Metres east.
  double east_m;
  // Heading.
  double psi_rad;
  // Velocity over ground to the north.
  double north_mps;
  // Velocity over ground to the east.
  double east_mps;
  // Course over ground; the heading where the ship does not move.
  double cog_rad;
  // Speed over ground.
  double sog_mps;
  // Speed ahead through the water.
  double stw_mps;
  // Yaw rate, rad/s.
  double yaw_rate_radps;
} SeatrialOwn;

// A tracked target at a beat.
typedef struct SeatrialTrack {
  // Number of the track, constant while it lives.
  uint32_t id;
  // Metres north.
  double north_m;
  // Metres east.
  double east_m;
  // Velocity over ground to the north, m/s.
  double north_mps;
  // Velocity over ground to the east, m/s.
  double east_mps;
  // The same as a course; 0 where the target does not move.
  double cog_rad;
  // The same as a speed.
  double sog_mps;
  // Heading; NaN where the target does not report it.
  double psi_rad;
  // Length, metres; NaN where it is not known.
  double length_m;
  // Beam, metres; NaN where it is not known.
  double beam_m;
  // Covariance of (north, east, north velocity, east velocity), row by row; zero when perfect.
  double covariance[4][4];
  // Seconds since the track was confirmed.
  double age_s;
  // Seconds since the last measurement that fed it.
  double since_update_s;
} SeatrialTrack;

// One beat. Pointers are valid during the call only.
typedef struct SeatrialSituation {
  // Simulated time since the start of the encounter, seconds.
  double t_s;
  // Own ship.
  struct SeatrialOwn own;
  // What the sensors hold, in no promised order.
  const struct SeatrialTrack *tracks;
  // How many.
  size_t tracks_len;
  // Ships beyond this range are not in sight of one another (Rule 19), metres; infinite when
  // visibility is good.
  double visual_range_m;
} SeatrialSituation;

// A declared conflict.
typedef struct SeatrialAlert {
  // Number of the track.
  uint32_t track;
  // The rule it follows, such as `15`; ends with a zero.
  char rule[SEATRIAL_TEXT_MAX];
  // Why, for a human reader; ends with a zero.
  char why[SEATRIAL_TEXT_MAX];
} SeatrialAlert;

// The answer of a beat; `kind` and `alerts_len` are zero before the call.
typedef struct SeatrialCommand {
  // Which pair below counts: `SEATRIAL_COURSE_SPEED` or `SEATRIAL_VELOCITY`.
  uint32_t kind;
  // Course, radians clockwise from north, within one turn either way.
  double course_rad;
  // Speed, m/s, from 0 to own ship's largest.
  double speed_mps;
  // Velocity over ground to the north, m/s.
  double north_mps;
  // Velocity over ground to the east, m/s.
  double east_mps;
  // How many alerts are declared.
  size_t alerts_len;
  // The alerts.
  struct SeatrialAlert alerts[SEATRIAL_ALERTS_MAX];
} SeatrialCommand;

// The planner: what `seatrial_planner_v1` returns. It and all it points to live for ever.
//
// Several instances run at the same time in several threads, each in one thread at a time: no
// global state that one changes and another reads. Functions that return a number return 0 when
// all is well; any other number ends the encounter as `planner_crashed`.
typedef struct SeatrialPlanner {
  // Must be `SEATRIAL_PLANNER_ABI`.
  uint32_t abi;
  // Name of the planner.
  const char *name;
  // Version of the planner.
  const char *version;
  // Makes an instance; null when that fails.
  void *(*create)(void);
  // Forgets everything and prepares for one encounter.
  int32_t (*reset)(void*, const struct SeatrialMission*);
  // The order for this beat.
  int32_t (*plan)(void*, const struct SeatrialSituation*, struct SeatrialCommand*);
  // Frees an instance.
  void (*destroy)(void*);
} SeatrialPlanner;

#endif  /* SEATRIAL_PLANNER_H */

#ifdef __cplusplus
extern "C" {
#endif
/* The one function that a library exports. */
const SeatrialPlanner *seatrial_planner_v1(void);
#ifdef __cplusplus
}
#endif
