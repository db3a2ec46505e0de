/* What is wired to which pin of the ATmega328P (Arduino Uno or Nano, 16 MHz, 5 V). See ../README.md. */
#ifndef FILUM_BOARD_H
#define FILUM_BOARD_H

#define FILUM_FIRMWARE_MAJOR 1
#define FILUM_FIRMWARE_MINOR 0
#define FILUM_FIRMWARE_PATCH 0

#define CHANNEL_ANGLE 0        /* A0: strain gauge bridge after the amplifier */
#define CHANNEL_FORCE 1        /* A1: pressure sensor after its amplifier */
#define CHANNEL_TEMPERATURE 2  /* A2: thermistor against 10 kOhm */

#define PIN_PEDAL PD2          /* D2, closes to ground */
#define PIN_CUT PD3            /* D3 */
#define PIN_NEXT PD4           /* D4 */

#define BAUD_DIVISOR 3         /* 16 MHz / (8 * (3 + 1)) = 500 kbit/s exactly, U2X */
#define SAMPLE_TICKS 2000u     /* of 0.5 us: 1 kHz */

/* Four conversions a channel are added: counts of 0 ... 4092. At 125 kHz a conversion takes 104 us; eight of them leave
 * 100 us of each millisecond, so the temperature goes in every 100th, after the others. */
#define OVERSAMPLES 4
#define COUNT_MAX 4092u

/* The amplifiers are laid out for 5 to 95 % of the range; resistors draw an input whose wire is broken to a rail. */
#define SATURATED_LOW 205u
#define SATURATED_HIGH 3887u
#define BROKEN_LOW 82u   /* 0.1 V: the amplifiers reach to 0.05 V of either rail */
#define BROKEN_HIGH 4010u
#define BROKEN_AFTER 20        /* samples in a row at the rail */

#define DEBOUNCE 5             /* samples a switch must agree */

/* EEPROM: device identity (u16) and identity of the calibration (u32), little-endian; 0xFF... when never written. */
#define EEPROM_DEVICE 0
#define EEPROM_CALIBRATION 2

#endif
