#include <algorithm>

#include "physics/pore_flow.h"

namespace filum {

double poisson_by_block(double share, double poisson) { return (1.0 - share) * (1.0 + poisson) - 1.0; }

double poisson_by_punch(double share, double poisson) { return std::max(-0.9, 1.0 - (1.0 - poisson) / (1.0 - share)); }

}  // namespace filum
