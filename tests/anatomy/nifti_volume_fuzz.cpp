// Scans of heads: whatever the bytes are, finite voxels in an invertible place, or an InputError. The first byte says whether the rest is a
// .nii or, packed, a .nii.gz.

#include "anatomy/nifti_volume.h"
#include "fuzz_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace filum;
  static const fuzz::Folder folder;
  if (size == 0) return 0;
  const std::string path = folder.write(data[0] % 2 == 0 ? "scan.nii" : "scan.nii.gz", fuzz::text_of(data + 1, size - 1));
  fuzz::read([&] {
    const Volume v = read_nifti(path);
    const auto voxels = static_cast<std::size_t>(v.size[0]) * static_cast<std::size_t>(v.size[1]) * static_cast<std::size_t>(v.size[2]);
    if (v.value.size() != voxels || !v.step.allFinite() || !v.first.allFinite()) std::abort();
    for (const float x : v.value)
      if (!(x - x == 0.0f)) std::abort();
  });
  return 0;
}
