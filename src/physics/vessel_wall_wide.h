#pragma once
// The kernel of sixteen elements at a time, for processors with registers of 512 bits. Its code is compiled for these alone and never runs
// elsewhere: whoever fills a WideKernel asks first. Test: vessel_wall_wide_test.

#include "physics/vessel_wall_kernel.h"

namespace filum {

using WideKernel = WallKernel<Lanes<float, 64>>;

/// Has this build the code, and this processor what it takes (x86-64-v4)? In vessel_wall_element.cpp: the code that asks must run everywhere.
bool has_wide_lanes() noexcept;

/// WideKernel::add_forces().
double add_wide_forces(const WideKernel& kernel, const std::vector<KernelRow>& rows, const std::vector<LawConstants>& laws, const Points& x,
                       const std::vector<double>& soundness, Points& force) noexcept;

}  // namespace filum
