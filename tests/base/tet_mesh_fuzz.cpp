// Meshes of format filum-mesh/1: whatever the bytes are, a sound mesh or an InputError.

#include "base/tet_mesh.h"
#include "fuzz_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace filum;
  static const fuzz::Folder folder;
  const std::string path = folder.write("mesh.txt", fuzz::text_of(data, size));
  fuzz::read([&] {
    const TetMesh mesh = load_mesh(path);
    surface_triangles(mesh);
    const MeshQuality q = mesh_quality(mesh);
    if (!(q.smallest_volume > 0.0) || !(q.worst_shape >= 0.0)) __builtin_trap();
  });
  return 0;
}
