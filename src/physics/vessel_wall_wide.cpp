// Compiled for x86-64-v4 (CMakeLists.txt): nothing but the wide kernel may stand here.
#include "physics/vessel_wall_wide.h"

namespace filum {

double add_wide_forces(const WideKernel& kernel, const std::vector<KernelRow>& rows, const std::vector<LawConstants>& laws, const Points& x,
                       const std::vector<double>& soundness, Points& force) noexcept {
  return kernel.add_forces(rows, laws, x, soundness, force);
}

}  // namespace filum
