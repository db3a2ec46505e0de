// The spatula paper's own experiment on haptic response (section 7.1, figs. 14, 15).

#include <algorithm>
#include <cmath>

#include "evidence/brain_block.h"
#include "evidence/problem_list.h"

namespace filum {
namespace {

constexpr double kSide = 0.5477;  // [m], of the cube's face: 0.3 m2
constexpr int kCells = 15;        // along a side of the face
constexpr double kDepth = 0.05;   // [m], the same for every spatula

/// Force [N] of the 50 spatulas of 0.005, 0.010, ..., 0.25 m2, pressed in equally deep.
std::vector<double> forces(bool partial) {
  std::vector<double> f;
  SpatulaParameters parameters;
  parameters.reach = 2.0 * kSide / kCells;
  parameters.partial = partial;
  FemOptions options;
  options.solver.relative = 1e-5;
  options.solver.max_iterations = 2000;
  for (int k = 1; k <= 50; ++k) {
    BrainBlock block(block_of_nodes(kCells + 1, kCells + 1, 6, Vec3(kSide, kSide, kSide)), options, std::sqrt(0.005 * k), parameters);
    block.rest_at(Vec3(0, 0, -kDepth));
    f.push_back(block.force());
  }
  return f;
}

/// Largest change of slope from one spatula to the next, as a share of the range of the force.
double largest_step(const std::vector<double>& f) {
  double step = 0.0;
  for (std::size_t k = 1; k + 1 < f.size(); ++k) step = std::max(step, std::abs(f[k + 1] - 2.0 * f[k] + f[k - 1]));
  const auto [low, high] = std::minmax_element(f.begin(), f.end());
  return step / (*high - *low);
}

}  // namespace

void list_spatula(ProblemList& list) {
  ValidationProblem p;
  p.name = "spatula-smooth-force";
  p.source = "Hansen et al. 2004, fig. 15: 50 spatulas of 0.005-0.25 m2 on a 15 x 15 face, no step in the force";
  p.quantity = "largest step (change of slope) as a share of the range";
  p.tolerance = 0.02;
  p.note = "no order: the mesh is that of the paper's figure";
  list.push_back({p, [](ValidationProblem& r) { r.got = largest_step(forces(true)); }});
  p.name = "spatula-partial-projection";
  p.source = "the same; without partial projection the force goes in steps";
  p.quantity = "largest step with over without partial projection";
  p.tolerance = 0.25;
  list.push_back({p, [](ValidationProblem& r) { r.got = largest_step(forces(true)) / largest_step(forces(false)); }});
}

}  // namespace filum
