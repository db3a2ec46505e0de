// Stress in the wall of tubes, at its inner and outer surface: where it is largest, and where the closing of an opened vessel changes it most.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "evidence/problem_list.h"
#include "evidence/vessel_probe.h"

namespace filum {
namespace {

struct StressCase {
  std::string name;
  const char* source;
  TubeSlice slice;
  std::vector<double> pressures;  // [Pa], on the way
  int elements;                   // around the finest of three meshes, with a fourth of that through the wall
  double inner, outer, unit;      // [unit], [unit], [Pa]
  const char* unit_name;
};

/// Solved once for both surfaces.
const SurfaceStress& solved_stress(const StressCase& c, int around) {
  static std::map<std::pair<std::string, int>, SurfaceStress> solved;
  const std::pair key(c.name, around);
  const auto found = solved.find(key);
  if (found != solved.end()) return found->second;
  TubeSlice slice = c.slice;
  slice.around = around;
  slice.through = around / 4;
  return solved.emplace(key, surface_stress(slice, inflate(slice, c.pressures).back(), c.pressures.back())).first->second;
}

void list_stress(ProblemList& list, const StressCase& c) {
  for (const bool inner : {true, false}) {
    ValidationProblem p;
    p.name = c.name + (inner ? "-inner" : "-outer");
    p.source = c.source;
    p.quantity = std::string("circumferential stress at the ") + (inner ? "inner" : "outer") + " surface, followed to no element size";
    p.unit = c.unit_name;
    p.expected = inner ? c.inner : c.outer;
    p.tolerance = 0.01;
    p.note = "order one: stress at the surface of linear elements; " + std::to_string(c.elements) + " elements around, and a half and a fourth of that";
    list.push_back({p, [c, of = inner ? &SurfaceStress::inner : &SurfaceStress::outer](ValidationProblem& r) {
                      const auto stress = [&](int around) { return solved_stress(c, around).*of / c.unit; };
                      follow_first_order(r, {stress(c.elements / 4), stress(c.elements / 2), stress(c.elements)});
                    }});
  }
}

TubeSlice thick_tube() {
  TubeSlice s;
  s.shape.inner_radius = 0.5e-3;
  s.shape.thickness = 0.25e-3;
  s.shape.length = 0.1e-3;
  s.layers = {{"wall", 0.25e-3, WallLaw::hooke(500e3, 0.3)}};
  return s;
}

TubeSlice stretched_carotid(bool opened) {
  TubeSlice s = rabbit_carotid(opened);
  s.shape.stretch = 1.7;
  return s;
}

}  // namespace

void list_vessel_stress(ProblemList& list) {
  const std::vector<double> way{0.0, 5e3, 13.33e3};
  list_stress(list, {"vessel-lame-stress", "Lame's thick tube, a = 0.5 mm, b = 0.75 mm, 13.332 Pa inside: c (1 + b^2/r^2), c = p a^2/(b^2 - a^2)", thick_tube(), {13.332}, 48,
                     34.6632, 21.3312, 1.0, "Pa"});
  list_stress(list, {"vessel-hgo-stress-closed", "Rabbit carotid of Holzapfel, Gasser & Ogden 2000 at 13.33 kPa and stretch 1.7, no opening angle; quadrature", stretched_carotid(false),
                     way, 48, 602.12, 7.50, 1e3, "kPa"});
  list_stress(list, {"vessel-hgo-stress-opened", "the same with an opening angle of 160 degrees, which halves the stress inside; quadrature", stretched_carotid(true), way, 48, 293.14,
                     13.37, 1e3, "kPa"});
}

}  // namespace filum
