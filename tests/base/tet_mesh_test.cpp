#include "base/tet_mesh.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace filum {
namespace tet_mesh_test {

TetMesh block() { return box_mesh(Vec3(0, 0, 0), Vec3(3, 2, 1), 3, 2, 2); }

std::string field_refused(const TetMesh& m) {
  try {
    check_mesh(m, "mesh");
  } catch (const InputError& e) {
    return e.field + ": " + e.value;
  }
  return "";
}

TEST(TetMesh, BlockFillsItsVolumeWithPositiveElements) {
  const TetMesh m = block();
  double sum = 0.0;
  for (int e = 0; e < m.n_tets(); ++e) {
    EXPECT_GT(tet_volume(m, e), 0.0);
    sum += tet_volume(m, e);
  }
  EXPECT_NEAR(sum, 6.0, 1e-12);
  EXPECT_EQ(field_refused(m), "");
}

TEST(TetMesh, SurfaceIsClosedAndOutward) {
  const TetMesh m = block();
  double area = 0.0, volume = 0.0;
  for (const Triangle& f : surface_triangles(m)) {
    const Vec3 a = m.nodes.col(f[0]), b = m.nodes.col(f[1]), c = m.nodes.col(f[2]);
    area += 0.5 * (b - a).cross(c - a).norm();
    volume += a.dot(b.cross(c)) / 6.0;  // divergence theorem
  }
  EXPECT_NEAR(area, 2.0 * (6 + 3 + 2), 1e-12);
  EXPECT_NEAR(volume, 6.0, 1e-12);
}

TEST(TetMesh, RegularTetrahedronHasShapeOne) {
  TetMesh m;
  m.nodes.resize(3, 4);
  m.nodes << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;
  m.tets = {{0, 1, 2, 3}};
  if (tet_volume(m, 0) < 0) std::swap(m.tets[0][0], m.tets[0][1]);
  EXPECT_NEAR(mesh_quality(m).worst_shape, 1.0, 1e-12);
}

TEST(TetMesh, BadElementsAndNodesAreNamed) {
  TetMesh m = block();
  std::swap(m.tets[7][0], m.tets[7][1]);
  EXPECT_EQ(field_refused(m), "element 7: inverted");
  m = block();
  m.tets[5][3] = m.tets[5][2];
  EXPECT_EQ(field_refused(m), "element 5: a node twice");
  m = block();
  m.tets[2][0] = 999;
  EXPECT_EQ(field_refused(m), "element 2: node 999");
  m = block();
  m.nodes.conservativeResize(3, m.n_nodes() + 1);
  m.nodes.col(m.n_nodes() - 1).setZero();
  EXPECT_EQ(field_refused(m), "node 36: in no element");
  m = block();
  m.nodes(1, 4) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(field_refused(m), "node 4: not a number");
  m = block();
  const Vec3 corner = m.nodes.col(m.tets[0][0]);
  m.nodes.col(m.tets[0][3]) = 0.5 * (corner + Vec3(m.nodes.col(m.tets[0][1])));
  EXPECT_EQ(field_refused(m), "element 0: no volume");
}

TEST(TetMesh, FileKeepsTheMeshAndACutFileIsRefused) {
  const auto path = (std::filesystem::temp_directory_path() / "filum_tet_mesh_test.mesh").string();
  const TetMesh m = block();
  save_mesh(m, path);
  const TetMesh back = load_mesh(path);
  EXPECT_EQ(back.tets, m.tets);
  EXPECT_LT((back.nodes - m.nodes).cwiseAbs().maxCoeff(), 1e-8);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_THROW(load_mesh(path), InputError);
  std::ofstream(path) << "filum-mesh/1\n5000000 5000000\n0 0 0\n";
  try {
    load_mesh(path);
    ADD_FAILURE() << "a mesh of a few bytes was taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.field, "counts") << error.what();  // before room is made for them
  }
  std::filesystem::remove(path);
}

}  // namespace tet_mesh_test
}  // namespace filum
