#include "physics/vessel_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "physics/vessel_wall_element.h"

using namespace filum;

namespace vessel_mesh_test {

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

/// Worst corner of all elements, as first made and without stress.
double worst(const VesselMesh& m) {
  double least = 1.0;
  for (int e = 0; e < m.n_elements(); ++e) least = std::min({least, scaled_jacobian(corners(m, e)), scaled_jacobian(m.stress_free[static_cast<std::size_t>(e)])});
  return least;
}

TEST(VesselMesh, ScaledJacobianOfKnownCorners) {
  Corners brick;
  for (int a = 0; a < 8; ++a) brick.col(a) = Vec3(a & 1 ? 3 : 0, a & 2 ? 1 : 0, a & 4 ? 0.1 : 0);
  EXPECT_NEAR(scaled_jacobian(brick), 1.0, 1e-12);
  Corners sheared = brick;
  sheared.row(0) += brick.row(1);  // 45 degrees
  EXPECT_NEAR(scaled_jacobian(sheared), std::sqrt(0.5), 1e-12);
  brick.row(2) *= -1.0;
  EXPECT_LT(scaled_jacobian(brick), 0.0);
}

TubeShape long_tube() {
  TubeShape s;
  s.length = 4.4e-3;
  s.around = 20;
  s.along = 24;
  return s;
}

TEST(VesselMesh, OpeningInTheSideIsAnEllipseWithoutSlivers) {
  TubeShape shapes[3] = {long_tube(), long_tube(), long_tube()};
  shapes[1].opening_angle = 1.4;
  shapes[2].stretch = 1.3;
  for (const TubeShape& s : shapes) {
    SideOpening o;
    o.length = 1.35e-3;
    o.width = 0.6e-3;
    const VesselMesh m = make_opened_tube(s, o);
    EXPECT_GT(worst(m), 0.5);
    expect_closed(m);
    ASSERT_EQ(m.edge_ring[0].size(), 28u);
    const double half = 0.5 * s.stretch * s.length;
    double middle = 0.0;  // radius of the middle of the wall at the far end
    for (int i = 0; i < m.n_nodes(); ++i)
      if (m.slab[static_cast<std::size_t>(i)] == 0) middle += m.nodes.col(i).head<2>().norm() / 40.0;
    for (std::size_t k = 0; k < 28; ++k) {
      const Vec3 p = m.nodes.col(m.edge_ring[0][k]);
      EXPECT_NEAR(std::hypot(std::atan2(p.y(), p.x()) * middle / (0.5 * o.width), (p.z() - half) / (0.5 * o.length)), 1.0, 0.02);
      EXPECT_NEAR(m.edge_share[0][k] + m.edge_share[0][(28 - k) % 28], k == 0 ? 0.0 : 1.0, 1e-9) << "the same on both sides";
    }
    const Vec3 heel = m.nodes.col(m.edge_ring[0][0]), toe = m.nodes.col(m.edge_ring[0][14]);
    EXPECT_NEAR(heel.z() - toe.z(), o.length, 1e-9);
    EXPECT_NEAR(heel.y(), 0.0, 1e-12);
    EXPECT_NEAR(m.edge_share[0][14], 0.5, 1e-9);
    EXPECT_EQ(m.held.size(), 80u) << "both ends";
    for (std::size_t i = 1; i < m.slab.size(); ++i) EXPECT_GE(m.slab[i], m.slab[i - 1]);
    for (const auto& nodes : m.elements)
      for (const int i : nodes)
        for (const int j : nodes) EXPECT_LE(std::abs(m.slab[static_cast<std::size_t>(i)] - m.slab[static_cast<std::size_t>(j)]), 1);
  }
}

TEST(VesselMesh, OpeningTakesItsShareOfTheTube) {
  TubeShape s = long_tube();
  s.around = 80;
  s.along = 80;
  SideOpening o;
  o.across = 20;
  o.along = 26;
  const VesselMesh m = make_opened_tube(s, o);
  double volume = 0.0;
  for (int e = 0; e < m.n_elements(); ++e) volume += signed_volume(corners(m, e));
  const double whole = std::numbers::pi * (0.45 * 0.45 - 0.35 * 0.35) * 4.4e-9, gone = whole - volume;
  EXPECT_NEAR(gone, 0.25 * std::numbers::pi * o.length * o.width * s.thickness, 0.03 * gone) << "ellipse on the middle of the wall";
}

TEST(VesselMesh, OpeningThatDoesNotFitIsRefused) {
  SideOpening o;
  o.width = 2e-3;
  EXPECT_THROW(make_opened_tube(long_tube(), o), std::invalid_argument);
  o = {};
  o.across = 5;
  EXPECT_THROW(make_opened_tube(long_tube(), o), std::invalid_argument);
  o.across = 18;
  EXPECT_THROW(make_opened_tube(long_tube(), o), std::invalid_argument);
}

TEST(VesselMesh, BevelledCutIsPlaneAndKeepsTheVolume) {
  TubeShape s;
  s.bevel = 0.25 * std::numbers::pi;
  for (const double opening_angle : {0.0, 1.4}) {
    s.opening_angle = opening_angle;
    const VesselMesh m = make_tube(s);
    TubeShape square = s;
    square.bevel = 0.0;
    const VesselMesh plain = make_tube(square);
    double volume = 0.0, same = 0.0;
    for (int e = 0; e < m.n_elements(); ++e) {
      volume += signed_volume(corners(m, e));
      same += signed_volume(corners(plain, e));
    }
    EXPECT_NEAR(volume, same, 1e-9 * same);
    for (const WallFace& f : m.faces)
      if (f.surface == WallSurface::edge)
        for (const int c : f.corner) {
          const Vec3 p = m.nodes.col(m.elements[static_cast<std::size_t>(f.element)][static_cast<std::size_t>(c)]);
          EXPECT_NEAR(p.z() - p.x(), s.length, 1e-12);
        }
    EXPECT_GT(worst(m), 0.6) << "45 degrees leave 0.71";
    expect_closed(m);
    const auto& share = m.edge_share[0];
    EXPECT_NEAR(share[12], 0.5, 1e-12);
    EXPECT_LT(share[6], 0.5 * share[12] + 1e-9);
    EXPECT_GT(share[7] - share[6], 1.2 * (share[1] - share[0])) << "long steps at the sides of the ellipse, in arc";
  }
}

}  // namespace vessel_mesh_test
