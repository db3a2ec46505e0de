#pragma once
// The board of the forceps as simavr simulates it: the real firmware, instruction by instruction, with voltages at the
// converter's inputs, levels at the switches and bytes on the line. simavr is under the GPL: it is linked into tests only.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace filum {

class AvrBoard {
 public:
  explicit AvrBoard(const std::string& elf);
  ~AvrBoard();
  AvrBoard(const AvrBoard&) = delete;
  AvrBoard& operator=(const AvrBoard&) = delete;

  void run_us(std::int64_t us);
  /// [us], since power-up; `ppm` of set_clock_error() included: the time outside, not the board's.
  std::int64_t time_us() const;
  /// The board's crystal runs this much too fast [1e-6].
  void set_clock_error(double ppm);
  /// [mV] at A0 ... A2.
  void set_voltage(int channel, int millivolt);
  /// Switch on PORTD pin closed to ground.
  void set_switch(int pin, bool closed);
  /// What is stored in the board, before it starts.
  void write_eeprom(std::uint32_t address, std::span<const std::uint8_t> bytes);
  void reset();
  /// A watchdog cannot be fed by a processor that hangs: stops the program for this long [us] while its timers run.
  void hang_us(std::int64_t us);

  /// Bytes it has sent since the last call.
  std::vector<std::uint8_t> take_sent();
  void receive(std::span<const std::uint8_t> bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace filum
