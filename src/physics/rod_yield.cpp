#include <numbers>

#include "physics/elastic_rod.h"

namespace filum {

double most_elastic_curvature(double yield_strain, double radius) noexcept {
  return 16.0 / (3.0 * std::numbers::pi) * yield_strain / radius;
}

}  // namespace filum
