#include "filum_protocol.h"

#include <string.h>

static void put_u16(uint8_t* out, uint16_t value) {
  out[0] = (uint8_t)(value & 0xFFu);
  out[1] = (uint8_t)(value >> 8);
}

static void put_u32(uint8_t* out, uint32_t value) {
  put_u16(out, (uint16_t)(value & 0xFFFFu));
  put_u16(out + 2, (uint16_t)(value >> 16));
}

static uint16_t get_u16(const uint8_t* in) { return (uint16_t)(in[0] | ((uint16_t)in[1] << 8)); }
static uint32_t get_u32(const uint8_t* in) { return (uint32_t)get_u16(in) | ((uint32_t)get_u16(in + 2) << 16); }

/* Two's complement by hand: the conversion of a large uint32_t to int32_t is the compiler's choice in C99. */
static int32_t get_i32(const uint8_t* in) {
  const uint32_t value = get_u32(in);
  return value <= 0x7FFFFFFFu ? (int32_t)value : -(int32_t)(0xFFFFFFFFu - value) - 1;
}

uint16_t filum_crc16(const uint8_t* data, size_t size) {
  uint16_t crc = 0xFFFFu;
  for (size_t i = 0; i < size; ++i) {
    uint16_t x = (uint16_t)((crc >> 8) ^ data[i]); /* one byte a turn without a table: 60 bytes of flash */
    x = (uint16_t)(x ^ (x >> 4));
    crc = (uint16_t)((crc << 8) ^ (x << 12) ^ (x << 5) ^ x);
  }
  return crc;
}

size_t filum_cobs_encode(const uint8_t* data, size_t size, uint8_t* out, size_t room) {
  size_t code_at = 0, write = 1;
  uint8_t code = 1;
  if (room < size + size / 254u + 1u) return 0;
  for (size_t i = 0; i < size; ++i) {
    if (data[i] != 0) {
      out[write++] = data[i];
      ++code;
    }
    if (data[i] == 0 || (code == 0xFFu && i + 1 < size)) {
      out[code_at] = code;
      code_at = write++;
      code = 1;
    }
  }
  out[code_at] = code;
  return write;
}

bool filum_cobs_decode(const uint8_t* data, size_t size, uint8_t* out, size_t room, size_t* out_size) {
  size_t read = 0, write = 0;
  *out_size = 0;
  if (size == 0) return false;
  while (read < size) {
    const uint8_t code = data[read++];
    if (code == 0 || (size_t)(code - 1) > size - read || (size_t)(code - 1) > room - write) return false;
    for (uint8_t i = 1; i < code; ++i) {
      if (data[read] == 0) return false;
      out[write++] = data[read++];
    }
    if (code != 0xFFu && read < size) {
      if (write == room) return false;
      out[write++] = 0;
    }
  }
  *out_size = write;
  return true;
}

static int payload_size_of(uint8_t type) {
  switch (type) {
    case FILUM_HELLO: return FILUM_HELLO_SIZE;
    case FILUM_GRIP: return FILUM_GRIP_SIZE;
    case FILUM_POSE: return FILUM_POSE_SIZE;
    case FILUM_PING: return FILUM_PING_SIZE;
    case FILUM_PONG: return FILUM_PONG_SIZE;
    case FILUM_STATUS: return FILUM_STATUS_SIZE;
    default: return -1;
  }
}

size_t filum_frame_encode(const filum_frame* frame, uint8_t out[FILUM_MAX_WIRE]) {
  uint8_t raw[FILUM_MAX_RAW];
  size_t size, encoded;
  if (frame->size > FILUM_MAX_PAYLOAD) return 0;
  raw[0] = FILUM_PROTOCOL_VERSION;
  raw[1] = frame->type;
  put_u16(raw + 2, frame->device);
  put_u16(raw + 4, frame->sequence);
  put_u32(raw + 6, frame->time_us);
  memcpy(raw + FILUM_HEADER_SIZE, frame->payload, frame->size);
  size = FILUM_HEADER_SIZE + frame->size;
  put_u16(raw + size, filum_crc16(raw, size));
  encoded = filum_cobs_encode(raw, size + FILUM_CRC_SIZE, out, FILUM_MAX_ENCODED);
  out[encoded] = 0;
  return encoded + 1;
}

filum_status filum_frame_decode(const uint8_t* data, size_t size, filum_frame* frame) {
  uint8_t raw[FILUM_MAX_RAW];
  size_t n = 0;
  int payload;
  if (size > FILUM_MAX_ENCODED) return FILUM_BAD_LENGTH;
  if (!filum_cobs_decode(data, size, raw, sizeof raw, &n)) return FILUM_BAD_COBS;
  if (n < FILUM_HEADER_SIZE + FILUM_CRC_SIZE) return FILUM_BAD_LENGTH;
  n -= FILUM_CRC_SIZE;
  if (filum_crc16(raw, n) != get_u16(raw + n)) return FILUM_BAD_CRC;
  if (raw[0] != FILUM_PROTOCOL_VERSION) return FILUM_BAD_VERSION;
  payload = payload_size_of(raw[1]);
  if (payload < 0) return FILUM_BAD_TYPE;
  if (n != FILUM_HEADER_SIZE + (size_t)payload) return FILUM_BAD_LENGTH;
  memset(frame, 0, sizeof *frame);
  frame->type = raw[1];
  frame->size = (uint8_t)payload;
  frame->device = get_u16(raw + 2);
  frame->sequence = get_u16(raw + 4);
  frame->time_us = get_u32(raw + 6);
  memcpy(frame->payload, raw + FILUM_HEADER_SIZE, frame->size);
  return FILUM_OK;
}

void filum_put_hello(filum_frame* frame, const filum_hello* hello) {
  uint8_t* p = frame->payload;
  frame->type = FILUM_HELLO;
  frame->size = FILUM_HELLO_SIZE;
  memcpy(p, hello->firmware, 3);
  p[3] = hello->channels;
  put_u16(p + 4, hello->angle_max);
  put_u16(p + 6, hello->force_max);
  put_u16(p + 8, hello->rate_hz);
  put_u32(p + 10, hello->calibration);
}

void filum_put_grip(filum_frame* frame, const filum_grip* grip) {
  uint8_t* p = frame->payload;
  frame->type = FILUM_GRIP;
  frame->size = FILUM_GRIP_SIZE;
  p[0] = grip->tool;
  p[1] = grip->flags;
  put_u16(p + 2, grip->angle);
  put_u16(p + 4, grip->force);
}

void filum_put_pose(filum_frame* frame, const filum_pose* pose) {
  uint8_t* p = frame->payload;
  frame->type = FILUM_POSE;
  frame->size = FILUM_POSE_SIZE;
  p[0] = pose->tool;
  p[1] = pose->flags;
  for (int i = 0; i < 3; ++i) put_u32(p + 2 + 4 * i, (uint32_t)pose->position[i]);
  for (int i = 0; i < 4; ++i) put_u32(p + 14 + 4 * i, (uint32_t)pose->quaternion[i]);
}

void filum_put_ping(filum_frame* frame, const filum_ping* ping) {
  frame->type = FILUM_PING;
  frame->size = FILUM_PING_SIZE;
  put_u32(frame->payload, ping->host_us);
}

void filum_put_pong(filum_frame* frame, const filum_pong* pong) {
  frame->type = FILUM_PONG;
  frame->size = FILUM_PONG_SIZE;
  put_u32(frame->payload, pong->host_us);
  put_u32(frame->payload + 4, pong->received_us);
}

void filum_put_status(filum_frame* frame, const filum_handle_status* status) {
  uint8_t* p = frame->payload;
  frame->type = FILUM_STATUS;
  frame->size = FILUM_STATUS_SIZE;
  put_u16(p, status->temperature);
  p[2] = status->reset;
  p[3] = status->room;
  put_u16(p + 4, status->not_sent);
  put_u16(p + 6, status->late);
}

bool filum_get_hello(const filum_frame* frame, filum_hello* hello) {
  const uint8_t* p = frame->payload;
  if (frame->type != FILUM_HELLO) return false;
  memcpy(hello->firmware, p, 3);
  hello->channels = p[3];
  hello->angle_max = get_u16(p + 4);
  hello->force_max = get_u16(p + 6);
  hello->rate_hz = get_u16(p + 8);
  hello->calibration = get_u32(p + 10);
  return true;
}

bool filum_get_grip(const filum_frame* frame, filum_grip* grip) {
  const uint8_t* p = frame->payload;
  if (frame->type != FILUM_GRIP || p[0] >= FILUM_TOOLS) return false;
  grip->tool = p[0];
  grip->flags = p[1];
  grip->angle = get_u16(p + 2);
  grip->force = get_u16(p + 4);
  return true;
}

bool filum_get_pose(const filum_frame* frame, filum_pose* pose) {
  const uint8_t* p = frame->payload;
  if (frame->type != FILUM_POSE || p[0] >= FILUM_TOOLS) return false;
  pose->tool = p[0];
  pose->flags = p[1];
  for (int i = 0; i < 3; ++i) pose->position[i] = get_i32(p + 2 + 4 * i);
  for (int i = 0; i < 4; ++i) pose->quaternion[i] = get_i32(p + 14 + 4 * i);
  return true;
}

bool filum_get_ping(const filum_frame* frame, filum_ping* ping) {
  if (frame->type != FILUM_PING) return false;
  ping->host_us = get_u32(frame->payload);
  return true;
}

bool filum_get_pong(const filum_frame* frame, filum_pong* pong) {
  if (frame->type != FILUM_PONG) return false;
  pong->host_us = get_u32(frame->payload);
  pong->received_us = get_u32(frame->payload + 4);
  return true;
}

bool filum_get_status(const filum_frame* frame, filum_handle_status* status) {
  const uint8_t* p = frame->payload;
  if (frame->type != FILUM_STATUS) return false;
  status->temperature = get_u16(p);
  status->reset = p[2];
  status->room = p[3];
  status->not_sent = get_u16(p + 4);
  status->late = get_u16(p + 6);
  return true;
}
