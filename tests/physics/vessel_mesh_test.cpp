#include "physics/vessel_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <map>
#include <numbers>

#include "physics/vessel_wall_element.h"

using namespace filum;

namespace {

double signed_volume(const Corners& c) {
  double v = 0.0;
  for (const double x : {-0.5773502692, 0.5773502692})
    for (const double y : {-0.5773502692, 0.5773502692})
      for (const double z : {-0.5773502692, 0.5773502692}) {
        Mat3 g = Mat3::Zero();
        for (int a = 0; a < 8; ++a) {
          const Vec3 s(a & 1 ? 1 : -1, a & 2 ? 1 : -1, a & 4 ? 1 : -1), w = 0.5 * (Vec3::Ones() + s.cwiseProduct(Vec3(x, y, z)));
          g += c.col(a) * Vec3(s.x() * w.y() * w.z(), s.y() * w.x() * w.z(), s.z() * w.x() * w.y()).transpose() * 0.5;
        }
        v += g.determinant();
      }
  return v;
}

Corners corners(const VesselMesh& m, int e) {
  Corners c;
  for (int a = 0; a < 8; ++a) c.col(a) = m.nodes.col(m.elements[static_cast<std::size_t>(e)][static_cast<std::size_t>(a)]);
  return c;
}

TEST(VesselMesh, ElementsAreUprightAndFillTheTube) {
  TubeShape s;
  s.around = 64;
  const VesselMesh m = make_tube(s);
  double volume = 0.0;
  for (int e = 0; e < m.n_elements(); ++e) {
    EXPECT_GT(signed_volume(corners(m, e)), 0.0);
    volume += signed_volume(corners(m, e));
  }
  EXPECT_NEAR(volume / (std::numbers::pi * (0.45 * 0.45 - 0.35 * 0.35) * 3e-9), 1.0, 2e-3);
}

TEST(VesselMesh, FirstShapeKeepsVolumeOfTheOpenedSector) {
  TubeShape s;
  s.opening_angle = 2.0;
  s.stretch = 1.4;
  s.around = 96;
  s.through = 3;
  const VesselMesh m = make_tube(s);
  for (int e = 0; e < m.n_elements(); e += 17) EXPECT_NEAR(signed_volume(corners(m, e)) / signed_volume(m.stress_free[static_cast<std::size_t>(e)]), 1.0, 2e-3);
}

/// Every side of the surface is shared by two faces that run it in opposite directions: closed, and turned outward throughout.
void expect_closed(const VesselMesh& m) {
  std::map<std::pair<int, int>, int> sides;
  double volume = 0.0;
  for (const Triangle& t : face_triangles(m)) {
    for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
    volume += Vec3(m.nodes.col(t[0])).dot(Vec3(m.nodes.col(t[1])).cross(Vec3(m.nodes.col(t[2])))) / 6.0;
  }
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(sides.count({side.second, side.first}), 1u);
  }
  EXPECT_GT(volume, 0.0);
}

TEST(VesselMesh, SurfacesAreClosedAndOutward) {
  expect_closed(make_tube({}));
  expect_closed(make_card({}));
  VesselMesh two = make_tube({});
  append(two, make_tube({}), {Vec3(0, 0, 8e-3), Quat(0, 1, 0, 0)});
  expect_closed(two);
}

TEST(VesselMesh, SlabsAscendAndElementsJoinNeighbours) {
  VesselMesh m = make_tube({});
  append(m, make_card({}), {});
  for (std::size_t i = 1; i < m.slab.size(); ++i) EXPECT_GE(m.slab[i], m.slab[i - 1]);
  for (const auto& nodes : m.elements)
    for (const int i : nodes)
      for (const int j : nodes) EXPECT_LE(std::abs(m.slab[static_cast<std::size_t>(i)] - m.slab[static_cast<std::size_t>(j)]), 1);
  EXPECT_EQ(m.edge_ring.size(), 2u);
  EXPECT_EQ(m.edge_ring[0].size(), 24u);
  for (const int i : m.edge_ring[0]) EXPECT_NEAR(m.nodes(2, i), 3e-3, 1e-12);
}

TEST(VesselMesh, GradingMakesShortElementsAtTheEdge) {
  TubeShape s;
  s.edge_grading = 3.0;
  const VesselMesh m = make_tube(s);
  const int ring = 2 * s.around;
  const double first = m.nodes(2, ring) - m.nodes(2, 0), last = m.nodes(2, m.n_nodes() - 1) - m.nodes(2, m.n_nodes() - 1 - ring);
  EXPECT_NEAR(first / last, 3.0, 0.3);
  EXPECT_NEAR(m.nodes(2, m.n_nodes() - 1), s.length, 1e-12);
}

}  // namespace
