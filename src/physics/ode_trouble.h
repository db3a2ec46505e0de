#pragma once
// What ODE cannot solve it says in a message, to the terminal unless somebody listens. Friction among many contacts need not have an answer: of
// 600,000 steps of violent hands some hundred had none. The bodies then move as far as the solver had come. Test: ode_trouble_test.

namespace filum {

/// From now on messages are counted, not printed, in the whole process.
void listen_to_ode() noexcept;
/// Messages on this thread so far.
long ode_troubles() noexcept;

}  // namespace filum
