#include "physics/ode_trouble.h"

#include <ode/ode.h>

#include <cstdarg>

namespace filum {
namespace {

thread_local long troubles = 0;
void hear(int, const char*, va_list) { ++troubles; }

}  // namespace

void listen_to_ode() noexcept { dSetMessageHandler(hear); }
long ode_troubles() noexcept { return troubles; }

}  // namespace filum
