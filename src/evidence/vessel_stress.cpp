// Stress in the wall of tubes, at its inner and outer surface: where it is largest, and where the closing of an opened vessel changes it most; and where its layers meet.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/numbers.h"
#include "evidence/problem_list.h"
#include "evidence/rod_probe.h"
#include "evidence/vessel_probe.h"

namespace filum {
namespace {

struct SolvedSlice {
  SurfaceStress stress;
  double interface = kNaN, outer = kNaN;  // [m], radii
};

struct StressCase {
  std::string name;
  const char* source;
  TubeSlice slice;
  std::vector<double> pressures;  // [Pa], on the way
  double unit;                    // [Pa], of the stresses
  const char* unit_name;
};

constexpr int kFinest = 48;  // elements around of the finest of three meshes, with a fourth of that through the wall

/// Solved once for all that is asked of it.
const SolvedSlice& solved_slice(const StressCase& c, int around) {
  static std::map<std::pair<std::string, int>, SolvedSlice> solved;
  const std::pair key(c.name, around);
  const auto found = solved.find(key);
  if (found != solved.end()) return found->second;
  TubeSlice slice = c.slice;
  slice.around = around;
  slice.through = around / 4;
  const SliceState state = inflate(slice, c.pressures).back();
  SolvedSlice s{surface_stress(slice, state, c.pressures.back()), interface_radius(slice, state), state.converged ? state.outer : kNaN};
  return solved.emplace(key, s).first->second;
}

void list_stress(ProblemList& list, const StressCase& c, const char* name, const char* place, double SurfaceStress::*of, double expected) {
  ValidationProblem p;
  p.name = c.name + "-" + name;
  p.source = c.source;
  p.quantity = std::string("circumferential stress ") + place + ", followed to no element size";
  p.unit = c.unit_name;
  p.expected = expected;
  p.tolerance = 0.01;
  p.note = "order one: stress at the surface of linear elements; " + std::to_string(kFinest) + " elements around, and a half and a fourth of that";
  list.push_back({p, [c, of](ValidationProblem& r) {
                    const auto stress = [&](int around) { return solved_slice(c, around).stress.*of / c.unit; };
                    follow_first_order(r, {stress(kFinest / 4), stress(kFinest / 2), stress(kFinest)});
                  }});
}

void list_surfaces(ProblemList& list, const StressCase& c, double inner, double outer) {
  list_stress(list, c, "inner", "at the inner surface", &SurfaceStress::inner, inner);
  list_stress(list, c, "outer", "at the outer surface", &SurfaceStress::outer, outer);
}

void list_interface(ProblemList& list, const StressCase& c, double media, double adventitia) {
  list_stress(list, c, "media", "in the media where it meets the adventitia", &SurfaceStress::media, media);
  list_stress(list, c, "adventitia", "in the adventitia where it meets the media", &SurfaceStress::adventitia, adventitia);
}

void list_radius(ProblemList& list, const StressCase& c, const char* name, const char* quantity, double SolvedSlice::*of, double expected) {
  ValidationProblem p;
  p.name = c.name + "-radius-" + name;
  p.source = c.source;
  p.quantity = quantity;
  p.unit = "mm";
  p.expected = expected;
  p.tolerance = 0.002;
  list.push_back({p, [c, of](ValidationProblem& r) {
                    const auto radius = [&](int around) { return 1e3 * (solved_slice(c, around).*of); };
                    r.got = radius(kFinest);
                    r.order = observed_order(radius(kFinest / 4), radius(kFinest / 2), r.got);
                  }});
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
  const StressCase tube{"vessel-lame-stress", "Lame's thick tube, a = 0.5 mm, b = 0.75 mm, 13.332 Pa inside: c (1 + b^2/r^2), c = p a^2/(b^2 - a^2)", thick_tube(), {13.332}, 1.0, "Pa"};
  list_surfaces(list, tube, 34.6632, 21.3312);
  const StressCase closed{"vessel-hgo-stress-closed",
                          "Rabbit carotid of Holzapfel, Gasser & Ogden 2000 (constants from memory, not re-read) at 13.33 kPa and stretch 1.7, no opening angle; quadrature",
                          stretched_carotid(false), way, 1e3, "kPa"};
  list_surfaces(list, closed, 602.12, 7.50);
  list_interface(list, closed, 37.29, 9.98);
  const StressCase opened{"vessel-hgo-stress-opened",
                          "the same (constants from memory, not re-read) with an opening angle of 160 degrees, which halves the stress inside; quadrature",
                          stretched_carotid(true), way, 1e3, "kPa"};
  list_surfaces(list, opened, 293.14, 13.37);
  list_interface(list, opened, 93.30, 15.26);
  list_radius(list, opened, "interface", "radius where media and adventitia meet", &SolvedSlice::interface, 1.3744);
  list_radius(list, opened, "outer", "outer radius", &SolvedSlice::outer, 1.4276);
}

}  // namespace filum
