// The tissue's cantilever in CalculiX (Debian package calculix-ccx), a program of others: the same four-node elements (C3D4) on
// the same mesh, node by node.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "physics/linear_fem.h"

using namespace filum;

namespace linear_fem_calculix_test {

constexpr double kYoung = 10e3, kPoisson = 0.45, kGravity = 0.1;

struct Beam {
  TetMesh mesh = box_mesh(Vec3(0, -0.01, -0.01), Vec3(0.1, 0.01, 0.01), 10, 3, 3);
  std::vector<int> held;
  Points load;  // [N]
  Points ours;  // [m]
  Beam() {
    FemOptions options;
    options.solver.relative = 1e-10;
    options.solver.max_iterations = 5000;
    LinearFem fem(mesh, {{kYoung, kPoisson, 1000.0}}, options);
    for (int i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.nodes(0, i) < 1e-9) held.push_back(i);
    fem.hold(held);
    load = Points::Zero(3, mesh.n_nodes());
    load.row(2) = -kGravity * fem.mass().transpose();
    FemState s = fem.rest();
    EXPECT_TRUE(fem.equilibrium(s, {}, &load).converged);
    ours = s.u;
  }
};

/// In millimetres, newtons and megapascals.
void write(const Beam& b, const std::string& file) {
  std::ofstream out(file);
  out.precision(12);
  out << "*NODE, NSET=ALL\n";
  for (int i = 0; i < b.mesh.n_nodes(); ++i) out << i + 1 << ", " << 1e3 * b.mesh.nodes(0, i) << ", " << 1e3 * b.mesh.nodes(1, i) << ", " << 1e3 * b.mesh.nodes(2, i) << "\n";
  out << "*ELEMENT, TYPE=C3D4, ELSET=TISSUE\n";
  for (int e = 0; e < b.mesh.n_tets(); ++e) {
    out << e + 1;
    for (const int i : b.mesh.tets[static_cast<std::size_t>(e)]) out << ", " << i + 1;
    out << "\n";
  }
  out << "*MATERIAL, NAME=M\n*ELASTIC\n" << 1e-6 * kYoung << ", " << kPoisson << "\n*SOLID SECTION, ELSET=TISSUE, MATERIAL=M\n*BOUNDARY\n";
  for (const int i : b.held) out << i + 1 << ", 1, 3\n";
  out << "*STEP\n*STATIC\n*CLOAD\n";
  for (int i = 0; i < b.mesh.n_nodes(); ++i) out << i + 1 << ", 3, " << b.load(2, i) << "\n";
  out << "*NODE PRINT, NSET=ALL\nU\n*END STEP\n";
}

TEST(TissueCalculix, EveryNodeOfTheSameCantilever) {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) GTEST_SKIP() << "SKIPPED: CalculiX is not installed (apt-get install calculix-ccx); the tissue was not compared with it";
  const Beam b;
  const auto folder = std::filesystem::temp_directory_path() / ("filum-tissue-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  write(b, (folder / "beam.inp").string());
  ASSERT_EQ(std::system(("cd '" + folder.string() + "' && OMP_NUM_THREADS=1 ccx beam > log 2>&1").c_str()), 0);
  std::ifstream in(folder / "beam.dat");
  int seen = 0;
  const double most = b.ours.cwiseAbs().maxCoeff();
  for (std::string line; std::getline(in, line);) {
    std::istringstream row(line);
    int node = 0;
    Vec3 u;
    if (!(row >> node >> u.x() >> u.y() >> u.z())) continue;
    ++seen;
    EXPECT_LT((1e-3 * u - b.ours.col(node - 1)).norm(), 2e-6 * most) << "node " << node;
  }
  std::filesystem::remove_all(folder);
  EXPECT_EQ(seen, b.mesh.n_nodes());
}

}  // namespace linear_fem_calculix_test
