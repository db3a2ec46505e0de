/* Haptic link: poses and grip from a master (the computer of a haptic device) to the trainer, forces back, by UDP at 1 kHz.
 * One C99 source for both ends: packets, and the guard that a master puts in front of its motors. README.md in this folder. */
#ifndef FILUM_LINK_H
#define FILUM_LINK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FILUM_LINK_PORT 18930
#define FILUM_LINK_POSE_SIZE 60u
#define FILUM_LINK_FORCE_SIZE 40u
#define FILUM_LINK_MAX_SIZE 60u

enum filum_link_type { FILUM_LINK_POSE = 1, FILUM_LINK_FORCE = 2 };
enum filum_link_flag {
  FILUM_LINK_TRACKED = 1,   /* pose: the device knows where it is */
  FILUM_LINK_CLUTCH = 2,
  FILUM_LINK_CUT = 4,
  FILUM_LINK_NEXT = 8,
  FILUM_LINK_HAS_FORCE = 16, /* pose: grip_force is measured */
  FILUM_LINK_VALID = 32      /* force: the scene is live; clear means zero force */
};

typedef struct filum_link_pose {
  uint32_t session;        /* chosen at random by the master when it starts */
  uint32_t sequence;       /* up by one with each packet of a tool */
  uint32_t time_us;        /* [us] master's clock */
  uint8_t tool;            /* 0 ... 2 */
  uint8_t flags;
  int32_t position[3];     /* [0.1 um] tip in the base frame of the device, x right, y away from the trainee, z up */
  int32_t quaternion[4];   /* [2^-30] w, x, y, z; z axis from the tip to the handle, x the way the jaws open */
  int32_t grip_angle;      /* [urad] */
  int32_t grip_force;      /* [uN] */
} filum_link_pose;

typedef struct filum_link_force {
  uint32_t session;        /* the master's */
  uint32_t sequence;       /* up by one with each packet of a tool */
  uint32_t answers;        /* sequence of the newest pose this force knows of */
  uint32_t time_us;        /* [us] that pose's time: round trip = now - time_us */
  uint8_t tool;
  uint8_t flags;
  int32_t force[3];        /* [uN] on the hand, base frame of the device */
} filum_link_force;

size_t filum_link_put_pose(const filum_link_pose* pose, uint8_t out[FILUM_LINK_POSE_SIZE]);
size_t filum_link_put_force(const filum_link_force* force, uint8_t out[FILUM_LINK_FORCE_SIZE]);
/* False for anything but one whole, undamaged packet of that type. */
bool filum_link_get_pose(const uint8_t* data, size_t size, filum_link_pose* pose);
bool filum_link_get_force(const uint8_t* data, size_t size, filum_link_force* force);

/* True if `sequence` is newer than `last` (both wrap). */
bool filum_link_newer(uint32_t sequence, uint32_t last);

/* ---- the guard: call filum_guard_step once per period of the motors, with what was last received.
 *
 * Zero force when nothing new came for `timeout`; |f| <= force_limit; |df/dt| <= slew_limit (letting go is always at once);
 * and passive whatever the delay: the energy E that the force has given to the hand never exceeds what the hand gave plus
 * `tank_start` (energy tank: Franken et al., IEEE Trans. Robotics 27 (2011) 741; the sample-and-hold force makes the
 * account exact: Ryu, Kim & Hannaford, IEEE Trans. Robotics 20 (2004) 365). The next force may not spend more than the tank
 * holds on the way the hand is about to go, v dt, and on f dt^2 / (2 m) for the hand it pushes. A tank that runs low also
 * bleeds: damping b is added to the force, which only takes energy from the hand. */
typedef struct filum_guard {
  double force_limit;    /* [N] */
  double slew_limit;     /* [N/s] */
  double timeout;        /* [s] */
  double lightest_hand;  /* [kg] */
  double tank_start;     /* [J] */
  double tank_size;      /* [J] */
  double damping;        /* [N s/m] added where the tank is low; 0 for none */
  /* state */
  double tank;           /* [J] */
  double force[3];       /* [N] given since the last call */
  double position[3];    /* [m] */
  double velocity[3];    /* [m/s], filtered */
  double silence;        /* [s] since something new came */
  bool started;
} filum_guard;

void filum_guard_init(filum_guard* guard, double force_limit);
/* `fresh`: `wanted` came since the last call and is marked valid. Writes the force to give [N]. */
void filum_guard_step(filum_guard* guard, const double position[3], const double wanted[3], bool fresh, double dt, double out[3]);

#ifdef __cplusplus
}
#endif
#endif
