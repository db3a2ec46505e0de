/* Firmware of the sensorised forceps: 1 kHz samples of strain and pressure in frames of hardware/protocol.
 *
 * Timer 1 ticks each millisecond and starts a round of conversions, which then go on by themselves in the converter's
 * interrupt. The main loop makes frames, answers pings and feeds the watchdog; sending and receiving go through rings in
 * interrupts. A frame for which there is no room is not sent, and its sequence number is used up, so the trainer sees
 * the loss. */
#include <avr/eeprom.h>
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>
#include <util/atomic.h>

#include "../../protocol/filum_protocol.h"
#include "board.h"

#define SEND_ROOM 256u /* a power of two: indices wrap by themselves */
#define HELLO_EVERY 1000u
#define STATUS_EVERY 100u

static uint8_t reset_cause __attribute__((section(".noinit")));

/* Before main: a watchdog that has bitten stays on and would bite again while the program starts. */
void remember_reset(void) __attribute__((naked, used, section(".init3")));
void remember_reset(void) {
  reset_cause = MCUSR;
  MCUSR = 0;
  wdt_disable();
}

/* ---- clock */

static volatile uint32_t ticks; /* [ms] */

static uint32_t now_us(void) {
  uint32_t ms;
  uint16_t half_us;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    ms = ticks;
    half_us = TCNT1;
    if ((TIFR1 & _BV(OCF1A)) && half_us < SAMPLE_TICKS / 2u) ++ms; /* the tick is due but not yet counted */
  }
  return ms * 1000u + half_us / 2u;
}

/* ---- sampling */

struct sample {
  uint16_t angle, force;
  uint32_t time_us;
};

static volatile struct sample finished;
static volatile bool sample_ready;
static volatile uint16_t late, temperature;
static uint16_t sums[2];
static uint8_t conversion; /* of this round: 0-3 angle, 4-7 force, 8 temperature */
static uint8_t until_temperature;
static uint32_t round_time_us;

static void convert(uint8_t channel) {
  ADMUX = (uint8_t)(_BV(REFS0) | channel); /* against the 5 V supply, which feeds the bridge too: ratiometric */
  ADCSRA |= _BV(ADSC);
}

ISR(TIMER1_COMPA_vect) {
  ++ticks;
  if (ADCSRA & _BV(ADSC)) { /* the round before is not over */
    ++late;
    return;
  }
  round_time_us = ticks * 1000u;
  conversion = 0;
  sums[0] = sums[1] = 0;
  convert(CHANNEL_ANGLE);
}

static void finish_round(void) {
  if (sample_ready) ++late;
  finished.angle = sums[0];
  finished.force = sums[1];
  finished.time_us = round_time_us;
  sample_ready = true;
}

ISR(ADC_vect) {
  const uint16_t count = ADC;
  if (conversion == 2 * OVERSAMPLES) {
    temperature = (uint16_t)(count * 4u);
    return;
  }
  sums[conversion / OVERSAMPLES] = (uint16_t)(sums[conversion / OVERSAMPLES] + count);
  if (++conversion < 2 * OVERSAMPLES) {
    convert(conversion < OVERSAMPLES ? CHANNEL_ANGLE : CHANNEL_FORCE);
    return;
  }
  finish_round();
  if (++until_temperature < 100) return;
  until_temperature = 0;
  convert(CHANNEL_TEMPERATURE);
}

/* ---- line */

static volatile uint8_t send_ring[SEND_ROOM];
static volatile uint8_t send_in, send_out;

static uint8_t send_room(void) { return (uint8_t)(send_out - send_in - 1u); }

ISR(USART_UDRE_vect) {
  if (send_in == send_out) {
    UCSR0B &= (uint8_t)~_BV(UDRIE0);
  } else {
    UDR0 = send_ring[send_out++];
  }
}

static uint8_t heard[FILUM_MAX_ENCODED]; /* between two 0x00 */
static volatile uint8_t heard_size;
static volatile bool heard_frame; /* the main loop owns `heard` while this is set */
static uint32_t heard_at_us;

ISR(USART_RX_vect) {
  const uint8_t byte = UDR0;
  if (heard_frame) return; /* the trainer pings once a second: there is time */
  if (byte != 0) {
    if (heard_size < sizeof heard) heard[heard_size++] = byte;
    return;
  }
  if (heard_size == 0) return;
  heard_at_us = now_us();
  heard_frame = true;
}

/* ---- frames */

static uint16_t device, sequence, not_sent;
static uint8_t least_room = 255;

static void send(filum_frame* frame) {
  static uint8_t wire[FILUM_MAX_WIRE];
  frame->device = device;
  frame->sequence = sequence++;
  const size_t size = filum_frame_encode(frame, wire);
  const uint8_t room = send_room();
  if (room < least_room) least_room = room;
  if (room < size) {
    ++not_sent;
    return;
  }
  for (size_t i = 0; i < size; ++i) send_ring[(uint8_t)(send_in + i)] = wire[i];
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    send_in = (uint8_t)(send_in + size);
    UCSR0B |= _BV(UDRIE0);
  }
}

static void send_hello(void) {
  filum_frame frame;
  const filum_hello hello = {{FILUM_FIRMWARE_MAJOR, FILUM_FIRMWARE_MINOR, FILUM_FIRMWARE_PATCH}, 3, COUNT_MAX, COUNT_MAX, 1000,
                             eeprom_read_dword((const uint32_t*)EEPROM_CALIBRATION) + 1u > 1u
                                 ? eeprom_read_dword((const uint32_t*)EEPROM_CALIBRATION)
                                 : 0u};
  filum_put_hello(&frame, &hello);
  frame.time_us = now_us();
  send(&frame);
}

static void send_status(void) {
  filum_frame frame;
  filum_handle_status status;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    status.temperature = temperature;
    status.late = late;
  }
  status.reset = reset_cause;
  status.room = least_room;
  status.not_sent = not_sent;
  least_room = 255;
  filum_put_status(&frame, &status);
  frame.time_us = now_us();
  send(&frame);
}

static void answer_ping(void) {
  filum_frame frame;
  filum_ping ping;
  if (filum_frame_decode(heard, heard_size, &frame) == FILUM_OK && filum_get_ping(&frame, &ping)) {
    const filum_pong pong = {ping.host_us, heard_at_us};
    filum_put_pong(&frame, &pong);
    frame.time_us = now_us();
    send(&frame);
  }
  heard_size = 0;
  heard_frame = false;
}

/* ---- switches and flags */

static uint8_t debounced(void) {
  static uint8_t stable, last, agreed;
  const uint8_t pins = (uint8_t)~PIND & (_BV(PIN_PEDAL) | _BV(PIN_CUT) | _BV(PIN_NEXT));
  agreed = pins == last ? (uint8_t)(agreed < DEBOUNCE ? agreed + 1 : agreed) : 0;
  last = pins;
  if (agreed == DEBOUNCE) stable = pins;
  return (uint8_t)((stable & _BV(PIN_PEDAL) ? FILUM_PEDAL : 0) | (stable & _BV(PIN_CUT) ? FILUM_BUTTON_CUT : 0) |
                   (stable & _BV(PIN_NEXT) ? FILUM_BUTTON_NEXT : 0));
}

static uint8_t channel_flags(uint16_t count, uint8_t* at_rail, uint8_t saturated, uint8_t broken) {
  if (count < BROKEN_LOW || count > BROKEN_HIGH) {
    if (*at_rail < BROKEN_AFTER) ++*at_rail;
  } else {
    *at_rail = 0;
  }
  return (uint8_t)((count < SATURATED_LOW || count > SATURATED_HIGH ? saturated : 0) | (*at_rail == BROKEN_AFTER ? broken : 0));
}

static void send_grip(const struct sample* s) {
  static uint8_t angle_at_rail, force_at_rail;
  filum_frame frame;
  const filum_grip grip = {0,
                           (uint8_t)(channel_flags(s->angle, &angle_at_rail, FILUM_ANGLE_SATURATED, FILUM_ANGLE_BROKEN) |
                                     channel_flags(s->force, &force_at_rail, FILUM_FORCE_SATURATED, FILUM_FORCE_BROKEN) |
                                     debounced()),
                           s->angle, s->force};
  filum_put_grip(&frame, &grip);
  frame.time_us = s->time_us;
  send(&frame);
}

/* ---- start */

static void set_up(void) {
  const uint16_t stored = eeprom_read_word((const uint16_t*)EEPROM_DEVICE);
  device = stored == 0xFFFFu ? 1u : stored;
  PORTD |= _BV(PIN_PEDAL) | _BV(PIN_CUT) | _BV(PIN_NEXT); /* pull-ups */
  DIDR0 = _BV(ADC0D) | _BV(ADC1D) | _BV(ADC2D);
  ADCSRA = _BV(ADEN) | _BV(ADIE) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0); /* 125 kHz */
  UBRR0 = BAUD_DIVISOR;
  UCSR0A = _BV(U2X0);
  UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
  UCSR0B = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0);
  OCR1A = SAMPLE_TICKS - 1u;
  TCCR1B = _BV(WGM12) | _BV(CS11); /* clear on compare, 2 MHz */
  TIMSK1 = _BV(OCIE1A);
  send_ring[send_in++] = 0; /* noise before the first frame does not cost that frame */
  wdt_enable(WDTO_120MS);
}

int main(void) {
  uint16_t until_hello = 1, until_status = STATUS_EVERY;
  bool greeted = false; /* the first frame is a hello: the trainer knows a restart by it */
  set_up();
  sei();
  for (;;) {
    struct sample s;
    wdt_reset();
    if (heard_frame && greeted) answer_ping();
    if (!sample_ready) continue;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
      s.angle = finished.angle;
      s.force = finished.force;
      s.time_us = finished.time_us;
      sample_ready = false;
    }
    if (--until_hello == 0) {
      until_hello = HELLO_EVERY;
      send_hello();
      greeted = true;
    }
    send_grip(&s);
    if (--until_status == 0) {
      until_status = STATUS_EVERY;
      send_status();
    }
  }
}
