// A vessel's ring under its residual stress, cut through along its length, springs open to the angle from which it was closed.

#include <cmath>
#include <map>

#include "evidence/problem_list.h"
#include "base/numbers.h"
#include "evidence/vessel_probe.h"

namespace filum {
namespace {

/// The closed ring with nodes of its own on both sides of the half plane of angle zero.
VesselMesh cut_open(VesselMesh mesh, int around) {
  const Points closed = mesh.nodes;
  std::map<int, int> twin;  // of a node on the cut
  for (int e = around - 1; e < mesh.n_elements(); e += around) {  // the elements before the cut
    for (std::size_t a = 1; a < 8; a += 2) {
      int& node = mesh.elements[static_cast<std::size_t>(e)][a];
      const auto [at, is_new] = twin.emplace(node, mesh.n_nodes() + static_cast<int>(twin.size()));
      node = at->second;
    }
  }
  mesh.nodes.conservativeResize(3, closed.cols() + static_cast<int>(twin.size()));
  for (const auto& [node, other] : twin) mesh.nodes.col(other) = closed.col(node);
  mesh.node_part.resize(static_cast<std::size_t>(mesh.n_nodes()), 0);
  mesh.slab.resize(static_cast<std::size_t>(mesh.n_nodes()), 0);
  return mesh;
}

struct Opened {
  double angle = kNaN, radius = kNaN;  // [rad], [m]: what is missing to a full turn, inner radius
};

/// Sum of the angles between the faces of the elements of the inner layer, and the radius of the arc on which its nodes lie.
Opened measured(const VesselMesh& mesh, const Points& x, int around) {
  const auto face = [&](int e, std::size_t side) {  // across the wall, and its inner node
    const auto& nodes = mesh.elements[static_cast<std::size_t>(e)];
    return std::pair<Vec3, Vec3>(x.col(nodes[side + 4]) - x.col(nodes[side]), x.col(nodes[side]));
  };
  double turned = 0.0, radius = 0.0;
  for (int e = 0; e < around; ++e) {
    const auto [a, from] = face(e, 0);
    const auto [b, to] = face(e, 1);
    const double angle = std::atan2(a.cross(b).z(), a.dot(b));
    turned += angle;
    radius += 0.5 * (to - from).norm() / std::sin(0.5 * angle) / around;
  }
  return {2.0 * kPi - turned, radius};
}

/// The far side rests in its meridian, the planes of the ring stay: the length is the stress-free one.
Opened sprung_open() {
  constexpr int kAround = 24;
  const TubeSlice slice = rabbit_carotid(true);
  TubeShape shape = slice.shape;
  shape.around = kAround;
  shape.through = 3;
  shape.along = 1;
  const VesselMesh mesh = cut_open(make_tube(shape), kAround);
  WallLoadCase load;
  load.fixed.assign(static_cast<std::size_t>(3 * mesh.n_nodes()), 0);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const bool far = mesh.nodes(0, i) < 0.0 && std::abs(mesh.nodes(1, i)) < 1e-9;
    load.fixed[static_cast<std::size_t>(3 * i + 2)] = 1;
    if (far) load.fixed[static_cast<std::size_t>(3 * i + 1)] = 1;
  }
  const int held = mesh.elements[kAround / 2][0];  // one node may not slide along that meridian
  load.fixed[static_cast<std::size_t>(3 * held)] = 1;
  std::vector<WallLayer> layers = slice.layers;
  for (WallLayer& l : layers) l.law.lambda *= 1e-3;  // nothing is strained at the end, whatever it costs to change volume
  Points x = mesh.nodes;
  if (!solve_static(mesh, WallElements(mesh, layers), load, x, 1e-12, 2000).converged) return {};
  return measured(mesh, x, kAround);
}

}  // namespace

void list_vessel_cut(ProblemList& list) {
  ValidationProblem p;
  p.source = "Rabbit carotid of Holzapfel, Gasser & Ogden 2000 (constants from memory, not re-read): opening angle 160 degrees, inner radius of the opened sector 1.43 mm";
  p.note = "no order: the sector without stress is the reference of the elements on any mesh; solved with lambda = 0.2 MPa, a thousandth of the carotid's 200 MPa "
           "elsewhere: the end of it is free of stress whatever lambda is";
  p.name = "vessel-cut-angle";
  p.quantity = "opening angle of a closed ring that was cut";
  p.unit = "deg";
  p.expected = 160.0;
  p.tolerance = 1e-6;
  list.push_back({p, [](ValidationProblem& r) { r.got = sprung_open().angle * 180.0 / kPi; }});
  p.name = "vessel-cut-radius";
  p.quantity = "inner radius of the ring that was cut";
  p.unit = "mm";
  p.expected = 1.43;
  list.push_back({p, [](ValidationProblem& r) { r.got = 1e3 * sprung_open().radius; }});
}

}  // namespace filum
