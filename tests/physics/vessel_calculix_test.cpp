// The same mesh in CalculiX (Debian package calculix-ccx), a program of others: eight-node elements with incompatible modes (C3D8I).

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <unistd.h>

#include "physics/vessel_wall_static.h"

using namespace filum;

namespace vessel_calculix_test {

constexpr double kYoung = 500e3, kPoisson = 0.4, kForce = 1e-6;

/// A tube held at one end; radial forces as cos(2 angle) on the inner rim of the other make it oval.
struct Squeezed {
  VesselMesh mesh;
  Points force;  // [N]
  int node = 0;  // where the answers are compared
  Squeezed() {
    TubeShape s;
    s.around = 32;
    s.along = 10;
    s.length = 1e-3;
    mesh = make_tube(s);
    node = mesh.edge_ring[0][0];
    force = Points::Zero(3, mesh.n_nodes());
    for (const int i : mesh.edge_ring[0]) {
      const Vec3 out(mesh.nodes(0, i), mesh.nodes(1, i), 0.0);
      const double angle = std::atan2(out.y(), out.x());
      force.col(i) = -kForce * std::cos(2.0 * angle) * out.normalized();
    }
  }
};

double ours(const Squeezed& c) {
  const WallElements elements(c.mesh, {{"wall", 1e-4, WallLaw::hooke(kYoung, kPoisson)}});
  WallLoadCase load;
  load.fixed.assign(static_cast<std::size_t>(3 * c.mesh.n_nodes()), 0);
  for (const int i : c.mesh.held)
    for (int k = 0; k < 3; ++k) load.fixed[static_cast<std::size_t>(3 * i + k)] = 1;
  load.force = c.force;
  Points x = c.mesh.nodes;
  EXPECT_TRUE(solve_static(c.mesh, elements, load, x, 1e-15).converged);
  return c.mesh.nodes(0, c.node) - x(0, c.node);
}

void write(const Squeezed& c, const std::string& file) {
  std::ofstream out(file);
  out.precision(12);
  out << "*NODE, NSET=ALL\n";
  for (int i = 0; i < c.mesh.n_nodes(); ++i)
    out << i + 1 << ", " << 1e3 * c.mesh.nodes(0, i) << ", " << 1e3 * c.mesh.nodes(1, i) << ", " << 1e3 * c.mesh.nodes(2, i) << "\n";
  out << "*ELEMENT, TYPE=C3D8I, ELSET=WALL\n";
  for (int e = 0; e < c.mesh.n_elements(); ++e) {
    out << e + 1;
    for (const std::size_t a : {0u, 1u, 3u, 2u, 4u, 5u, 7u, 6u}) out << ", " << c.mesh.elements[static_cast<std::size_t>(e)][a] + 1;
    out << "\n";
  }
  out << "*MATERIAL, NAME=M\n*ELASTIC\n" << 1e-6 * kYoung << ", " << kPoisson << "\n*SOLID SECTION, ELSET=WALL, MATERIAL=M\n*BOUNDARY\n";
  for (const int i : c.mesh.held) out << i + 1 << ", 1, 3\n";
  out << "*STEP\n*STATIC\n*CLOAD\n";
  for (const int i : c.mesh.edge_ring[0])
    for (int k = 0; k < 2; ++k) out << i + 1 << ", " << k + 1 << ", " << c.force(k, i) << "\n";
  out << "*NODE PRINT, NSET=ALL\nU\n*END STEP\n";
}

TEST(VesselCalculix, OvalTubeOfTheSameMesh) {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) GTEST_SKIP() << "SKIPPED: CalculiX is not installed (apt-get install calculix-ccx); the wall was not compared with it";
  const Squeezed c;
  const auto folder = std::filesystem::temp_directory_path() / ("filum-calculix-" + std::to_string(std::rand()) + "-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  write(c, (folder / "tube.inp").string());
  ASSERT_EQ(std::system(("cd '" + folder.string() + "' && OMP_NUM_THREADS=1 ccx tube > log 2>&1").c_str()), 0);
  std::ifstream in(folder / "tube.dat");
  double theirs = 0.0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream row(line);
    int node = 0;
    double ux = 0.0;
    if (row >> node >> ux && node == c.node + 1) theirs = -1e-3 * ux;
  }
  std::filesystem::remove_all(folder);
  ASSERT_GT(theirs, 0.0);
  EXPECT_NEAR(ours(c) / theirs, 1.0, 0.02) << "ours " << ours(c) << " m, CalculiX " << theirs << " m";
}

}  // namespace vessel_calculix_test
