/* Wire protocol between forceps (or any handle, arm or pedal) and the trainer. One source for firmware and host: C99, no
 * malloc, no floating point, no dependence on byte order. Byte layout and reasons: README.md in this folder. */
#ifndef FILUM_PROTOCOL_H
#define FILUM_PROTOCOL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FILUM_PROTOCOL_VERSION 1u
#define FILUM_HEADER_SIZE 10u /* version, type, device, sequence, time */
#define FILUM_CRC_SIZE 2u
#define FILUM_MAX_PAYLOAD 40u
#define FILUM_MAX_RAW (FILUM_HEADER_SIZE + FILUM_MAX_PAYLOAD + FILUM_CRC_SIZE)
#define FILUM_MAX_ENCODED (FILUM_MAX_RAW + 1u)   /* COBS adds one byte below 255 */
#define FILUM_MAX_WIRE (FILUM_MAX_ENCODED + 1u)  /* and the closing 0x00 */
#define FILUM_TOOLS 3u

enum filum_type { FILUM_HELLO = 1, FILUM_GRIP = 2, FILUM_POSE = 3, FILUM_PING = 4, FILUM_PONG = 5, FILUM_STATUS = 6 };

enum filum_payload_size {
  FILUM_HELLO_SIZE = 14,
  FILUM_GRIP_SIZE = 6,
  FILUM_POSE_SIZE = 30,
  FILUM_PING_SIZE = 4,
  FILUM_PONG_SIZE = 8,
  FILUM_STATUS_SIZE = 8
};

/* Bits of filum_grip.flags */
enum filum_grip_flag {
  FILUM_ANGLE_SATURATED = 1,
  FILUM_FORCE_SATURATED = 2,
  FILUM_ANGLE_BROKEN = 4,  /* wire broken or shorted: the count means nothing */
  FILUM_FORCE_BROKEN = 8,
  FILUM_PEDAL = 16,        /* foot pedal or clutch button down */
  FILUM_BUTTON_CUT = 32,
  FILUM_BUTTON_NEXT = 64,
  FILUM_NO_FORCE = 128     /* this handle has no force channel */
};

enum filum_pose_flag { FILUM_POSE_TRACKED = 1 }; /* clear: the handle is out of sight, the numbers mean nothing */

typedef enum filum_status {
  FILUM_OK = 0,
  FILUM_BAD_COBS,
  FILUM_BAD_LENGTH,  /* too short, too long or not the length of its type */
  FILUM_BAD_CRC,
  FILUM_BAD_VERSION,
  FILUM_BAD_TYPE
} filum_status;

typedef struct filum_frame {
  uint8_t type;
  uint8_t size;       /* bytes of payload */
  uint16_t device;    /* unique on a link */
  uint16_t sequence;  /* up by one with each frame of this device, of any type; wraps */
  uint32_t time_us;   /* [us] device clock when sent (pong, hello) or sampled (grip, pose); wraps after 71.6 min */
  uint8_t payload[FILUM_MAX_PAYLOAD];
} filum_frame;

typedef struct filum_hello {
  uint8_t firmware[3];    /* major, minor, patch */
  uint8_t channels;       /* bit 0 angle, bit 1 force, bit 2 pose */
  uint16_t angle_max;     /* [count] largest value of the converter */
  uint16_t force_max;     /* [count] */
  uint16_t rate_hz;       /* [1/s] grip frames a second */
  uint32_t calibration;   /* identity of the calibration this handle was delivered with, 0 = none */
} filum_hello;

typedef struct filum_grip {
  uint8_t tool;    /* 0 ... FILUM_TOOLS-1 */
  uint8_t flags;   /* filum_grip_flag */
  uint16_t angle;  /* [count] as converted */
  uint16_t force;  /* [count] as converted */
} filum_grip;

typedef struct filum_pose {
  uint8_t tool;
  uint8_t flags;           /* filum_pose_flag */
  int32_t position[3];     /* [0.1 um] jaw tip in the frame of the base */
  int32_t quaternion[4];   /* [2^-30] w, x, y, z; unit; z axis towards the handle */
} filum_pose;

typedef struct filum_ping { uint32_t host_us; } filum_ping;             /* [us] host clock when sent */
typedef struct filum_pong { uint32_t host_us, received_us; } filum_pong; /* ping's host_us; device clock at its arrival */

typedef struct filum_handle_status {
  uint16_t temperature;  /* [count] of the sensor beside the bridge; 0 where there is none */
  uint8_t reset;         /* why the handle last started: 1 power, 2 reset pin, 4 brown-out, 8 watchdog */
  uint8_t room;          /* [byte] least room its send buffer has had since the last status */
  uint16_t not_sent;     /* frames for which there was no room since it started; wraps */
  uint16_t late;         /* samples that were not ready in time since it started; wraps */
} filum_handle_status;

/* CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF, not reflected. "123456789" gives 0x29B1. */
uint16_t filum_crc16(const uint8_t* data, size_t size);

/* COBS (S. Cheshire, M. Baker, IEEE/ACM Trans. Networking 7 (1999) 159). Without the closing 0x00. Encode needs
 * size + size / 254 + 1 bytes of room and returns the bytes written, 0 if they do not fit. */
size_t filum_cobs_encode(const uint8_t* data, size_t size, uint8_t* out, size_t room);
bool filum_cobs_decode(const uint8_t* data, size_t size, uint8_t* out, size_t room, size_t* out_size);

/* Whole frame to the bytes on the wire, closing 0x00 included; returns their number, 0 if the payload is too long. */
size_t filum_frame_encode(const filum_frame* frame, uint8_t out[FILUM_MAX_WIRE]);
/* What lies between two 0x00 bytes to a frame. On any status but FILUM_OK `frame` is not to be used. */
filum_status filum_frame_decode(const uint8_t* data, size_t size, filum_frame* frame);

/* Fill type, size and payload; device, sequence and time are the caller's. */
void filum_put_hello(filum_frame* frame, const filum_hello* hello);
void filum_put_grip(filum_frame* frame, const filum_grip* grip);
void filum_put_pose(filum_frame* frame, const filum_pose* pose);
void filum_put_ping(filum_frame* frame, const filum_ping* ping);
void filum_put_pong(filum_frame* frame, const filum_pong* pong);
void filum_put_status(filum_frame* frame, const filum_handle_status* status);

/* False if the frame is of another type or names a tool that does not exist. */
bool filum_get_hello(const filum_frame* frame, filum_hello* hello);
bool filum_get_grip(const filum_frame* frame, filum_grip* grip);
bool filum_get_pose(const filum_frame* frame, filum_pose* pose);
bool filum_get_ping(const filum_frame* frame, filum_ping* ping);
bool filum_get_pong(const filum_frame* frame, filum_pong* pong);
bool filum_get_status(const filum_frame* frame, filum_handle_status* status);

#ifdef __cplusplus
}
#endif
#endif
