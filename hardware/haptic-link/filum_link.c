#include "filum_link.h"

#include <math.h>
#include <string.h>

static const uint8_t kMagic[4] = {'F', 'L', 'K', '1'};

static void put_u32(uint8_t* p, uint32_t v) {
  for (int i = 0; i < 4; ++i) p[i] = (uint8_t)(v >> (8 * i));
}
static uint32_t get_u32(const uint8_t* p) {
  return (uint32_t)p[0] | ((uint32_t)p[1] << 8) | ((uint32_t)p[2] << 16) | ((uint32_t)p[3] << 24);
}
static int32_t get_i32(const uint8_t* p) {
  const uint32_t v = get_u32(p);
  return v <= 0x7FFFFFFFu ? (int32_t)v : -(int32_t)(0xFFFFFFFFu - v) - 1;
}

/* CRC-32 (IEEE 802.3, reflected, 0xEDB88320), bit by bit: 70 bytes a millisecond. */
static uint32_t crc32_of(const uint8_t* data, size_t size) {
  uint32_t crc = 0xFFFFFFFFu;
  for (size_t i = 0; i < size; ++i) {
    crc ^= data[i];
    for (int b = 0; b < 8; ++b) crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1u)));
  }
  return ~crc;
}

/* magic 4, type 1, tool 1, flags 1, zero 1, session 4, sequence 4; ends in the CRC of all before */
static void put_head(uint8_t* out, uint8_t type, uint8_t tool, uint8_t flags, uint32_t session, uint32_t sequence) {
  memcpy(out, kMagic, 4);
  out[4] = type;
  out[5] = tool;
  out[6] = flags;
  out[7] = 0;
  put_u32(out + 8, session);
  put_u32(out + 12, sequence);
}

static bool whole(const uint8_t* data, size_t size, size_t expected, uint8_t type) {
  return size == expected && memcmp(data, kMagic, 4) == 0 && data[4] == type && data[5] < 3 && data[7] == 0 &&
         get_u32(data + size - 4) == crc32_of(data, size - 4);
}

size_t filum_link_put_pose(const filum_link_pose* pose, uint8_t out[FILUM_LINK_POSE_SIZE]) {
  memset(out, 0, FILUM_LINK_POSE_SIZE);
  put_head(out, FILUM_LINK_POSE, pose->tool, pose->flags, pose->session, pose->sequence);
  put_u32(out + 16, pose->time_us);
  for (int i = 0; i < 3; ++i) put_u32(out + 20 + 4 * i, (uint32_t)pose->position[i]);
  for (int i = 0; i < 4; ++i) put_u32(out + 32 + 4 * i, (uint32_t)pose->quaternion[i]);
  put_u32(out + 48, (uint32_t)pose->grip_angle);
  put_u32(out + 52, (uint32_t)pose->grip_force);
  put_u32(out + FILUM_LINK_POSE_SIZE - 4, crc32_of(out, FILUM_LINK_POSE_SIZE - 4));
  return FILUM_LINK_POSE_SIZE;
}

size_t filum_link_put_force(const filum_link_force* force, uint8_t out[FILUM_LINK_FORCE_SIZE]) {
  memset(out, 0, FILUM_LINK_FORCE_SIZE);
  put_head(out, FILUM_LINK_FORCE, force->tool, force->flags, force->session, force->sequence);
  put_u32(out + 16, force->answers);
  put_u32(out + 20, force->time_us);
  for (int i = 0; i < 3; ++i) put_u32(out + 24 + 4 * i, (uint32_t)force->force[i]);
  put_u32(out + FILUM_LINK_FORCE_SIZE - 4, crc32_of(out, FILUM_LINK_FORCE_SIZE - 4));
  return FILUM_LINK_FORCE_SIZE;
}

bool filum_link_get_pose(const uint8_t* data, size_t size, filum_link_pose* pose) {
  if (!whole(data, size, FILUM_LINK_POSE_SIZE, FILUM_LINK_POSE)) return false;
  pose->tool = data[5];
  pose->flags = data[6];
  pose->session = get_u32(data + 8);
  pose->sequence = get_u32(data + 12);
  pose->time_us = get_u32(data + 16);
  for (int i = 0; i < 3; ++i) pose->position[i] = get_i32(data + 20 + 4 * i);
  for (int i = 0; i < 4; ++i) pose->quaternion[i] = get_i32(data + 32 + 4 * i);
  pose->grip_angle = get_i32(data + 48);
  pose->grip_force = get_i32(data + 52);
  return true;
}

bool filum_link_get_force(const uint8_t* data, size_t size, filum_link_force* force) {
  if (!whole(data, size, FILUM_LINK_FORCE_SIZE, FILUM_LINK_FORCE)) return false;
  force->tool = data[5];
  force->flags = data[6];
  force->session = get_u32(data + 8);
  force->sequence = get_u32(data + 12);
  force->answers = get_u32(data + 16);
  force->time_us = get_u32(data + 20);
  for (int i = 0; i < 3; ++i) force->force[i] = get_i32(data + 24 + 4 * i);
  return true;
}

bool filum_link_newer(uint32_t sequence, uint32_t last) {
  const uint32_t step = sequence - last;
  return step != 0 && step < 0x80000000u;
}

/* ---- guard */

static double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void filum_guard_init(filum_guard* g, double force_limit) {
  memset(g, 0, sizeof *g);
  g->force_limit = force_limit;
  g->slew_limit = 200.0;
  g->timeout = 2e-3;
  g->lightest_hand = 0.05;
  g->tank_start = g->tank = 2e-4;
  g->tank_size = 2e-2;
  g->damping = 2.0;
}

/* What the last force spent on the way the hand has gone, and its velocity. */
static void account(filum_guard* g, const double position[3], double dt) {
  double moved[3];
  if (!g->started) memcpy(g->position, position, sizeof g->position);
  g->started = true;
  for (int i = 0; i < 3; ++i) {
    moved[i] = position[i] - g->position[i];
    g->velocity[i] += dt / (dt + 1.0 / 600.0) * (moved[i] / dt - g->velocity[i]);
    g->position[i] = position[i];
  }
  g->tank -= dot(g->force, moved);
  if (g->tank > g->tank_size) g->tank = g->tank_size;
}

static void limit_size_and_slew(const filum_guard* g, double f[3], double dt) {
  const double size = sqrt(dot(f, f));
  double change[3], most = g->slew_limit * dt, norm;
  if (!(size <= g->force_limit)) /* true for NaN as well */
    for (int i = 0; i < 3; ++i) f[i] = size > 0.0 && isfinite(size) ? f[i] * g->force_limit / size : 0.0;
  for (int i = 0; i < 3; ++i) change[i] = f[i] - g->force[i];
  norm = sqrt(dot(change, change));
  if (norm > most)
    for (int i = 0; i < 3; ++i) f[i] = g->force[i] + change[i] * most / norm;
}

/* Largest share s of f with s a + s^2 b <= tank. */
static void afford(const filum_guard* g, double f[3], double dt) {
  const double straight = dot(f, g->velocity) * dt;
  const double a = straight > 0.0 ? 2.0 * straight : 0.5 * straight;
  const double b = dot(f, f) * dt * dt / (2.0 * g->lightest_hand);
  const double budget = g->tank > 0.0 ? g->tank : 0.0;
  double share;
  if (a + b <= budget || b == 0.0) return;
  share = (sqrt(a * a + 4.0 * b * budget) - a) / (2.0 * b);
  if (share < 0.0) share = 0.0;
  if (share > 1.0) share = 1.0;
  for (int i = 0; i < 3; ++i) f[i] *= share;
}

void filum_guard_step(filum_guard* g, const double position[3], const double wanted[3], bool fresh, double dt, double out[3]) {
  double f[3] = {wanted[0], wanted[1], wanted[2]};
  account(g, position, dt);
  g->silence = fresh ? 0.0 : g->silence + dt;
  if (g->silence > g->timeout - 0.5 * dt) {
    memset(g->force, 0, sizeof g->force);
    memset(out, 0, sizeof g->force);
    return;
  }
  if (g->tank < g->tank_start) /* the delay has lent the hand energy: take it back */
    for (int i = 0; i < 3; ++i) f[i] -= g->damping * g->velocity[i];
  limit_size_and_slew(g, f, dt);
  afford(g, f, dt);
  memcpy(g->force, f, sizeof f);
  memcpy(out, f, sizeof f);
}
