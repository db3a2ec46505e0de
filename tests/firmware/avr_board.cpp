#include "tests/firmware/avr_board.h"

#include <stdexcept>

extern "C" {
#include <simavr/avr_adc.h>
#include <simavr/avr_eeprom.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
}

namespace filum {

namespace {
constexpr double kCrystal = 16.0;  // [cycles/us]
void be_quiet(avr_t*, const int, const char*, va_list) {}
}  // namespace

struct AvrBoard::Impl {
  avr_t* avr = nullptr;
  std::vector<std::uint8_t> sent;
  double cycles_per_us = kCrystal;
  double target = 0.0;    // [cycles]
  std::int64_t time = 0;  // [us], outside

  void run(std::int64_t us) {
    time += us;
    target += static_cast<double>(us) * cycles_per_us;
    while (static_cast<double>(avr->cycle) < target) {
      const int state = avr_run(avr);
      if (state == cpu_Done || state == cpu_Crashed) throw std::runtime_error("the firmware crashed");
    }
  }
};

AvrBoard::AvrBoard(const std::string& elf) : impl_(std::make_unique<Impl>()) {
  avr_global_logger_set(be_quiet);
  elf_firmware_t firmware{};
  if (elf_read_firmware(elf.c_str(), &firmware) != 0) throw std::runtime_error("cannot read " + elf);
  avr_t* avr = impl_->avr = avr_make_mcu_by_name("atmega328p");
  if (!avr) throw std::runtime_error("simavr has no atmega328p");
  avr_init(avr);
  firmware.frequency = 16'000'000;
  avr_load_firmware(avr, &firmware);
  avr->frequency = 16'000'000;
  avr->vcc = avr->avcc = avr->aref = 5000;
  std::uint32_t flags = 0;
  avr_ioctl(avr, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
  flags &= ~static_cast<std::uint32_t>(AVR_UART_FLAG_STDIO | AVR_UART_FLAG_POLL_SLEEP);
  avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  avr_irq_register_notify(
      avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
      [](avr_irq_t*, std::uint32_t value, void* self) {
        static_cast<Impl*>(self)->sent.push_back(static_cast<std::uint8_t>(value));
      },
      impl_.get());
  for (int pin = 2; pin <= 4; ++pin) set_switch(pin, false);
}

AvrBoard::~AvrBoard() { avr_terminate(impl_->avr); }

void AvrBoard::run_us(std::int64_t us) { impl_->run(us); }

std::int64_t AvrBoard::time_us() const { return impl_->time; }
void AvrBoard::set_clock_error(double ppm) { impl_->cycles_per_us = kCrystal * (1.0 + 1e-6 * ppm); }

void AvrBoard::set_voltage(int channel, int millivolt) {
  avr_raise_irq(avr_io_getirq(impl_->avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0 + channel), static_cast<std::uint32_t>(millivolt));
}

void AvrBoard::set_switch(int pin, bool closed) {
  avr_raise_irq(avr_io_getirq(impl_->avr, AVR_IOCTL_IOPORT_GETIRQ('D'), pin), closed ? 0 : 1);
}

void AvrBoard::write_eeprom(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  avr_eeprom_desc_t desc{copy.data(), static_cast<std::uint16_t>(address), static_cast<std::uint32_t>(copy.size())};
  avr_ioctl(impl_->avr, AVR_IOCTL_EEPROM_SET, &desc);
}

void AvrBoard::reset() {
  avr_reset(impl_->avr);
  impl_->target = static_cast<double>(impl_->avr->cycle);
}

void AvrBoard::hang_us(std::int64_t us) {
  // The program counter is put on an instruction that jumps to itself ("rjmp .-2"), in flash the program does not use.
  const std::uint32_t trap = impl_->avr->flashend - 1;
  impl_->avr->flash[trap] = 0xFF;
  impl_->avr->flash[trap + 1] = 0xCF;
  impl_->avr->pc = trap;
  impl_->avr->sreg[7] = 0;  // interrupts off
  run_us(us);
}

std::vector<std::uint8_t> AvrBoard::take_sent() {
  std::vector<std::uint8_t> bytes;
  bytes.swap(impl_->sent);
  return bytes;
}

void AvrBoard::receive(std::span<const std::uint8_t> bytes) {
  for (std::uint8_t byte : bytes) avr_raise_irq(avr_io_getirq(impl_->avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), byte);
}

}  // namespace filum
