#include "anatomy/nifti_volume.h"

#include <nifti1_io.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>

#include "base/error.h"
#include "base/file_kind.h"

namespace filum {
namespace {

constexpr int kMost = 2048;  // voxels along a side

struct Free {
  void operator()(nifti_image* image) const { nifti_image_free(image); }
  void operator()(nifti_1_header* header) const { std::free(header); }
};

void refuse(const std::string& path, const char* field, const std::string& found, const std::string& expected) { throw InputError(path, field, found, expected); }

void check_header(const std::string& path, const nifti_1_header& h) {
  if (h.sizeof_hdr != 348) refuse(path, "sizeof_hdr", std::to_string(h.sizeof_hdr), "348");
  if (std::memcmp(h.magic, "n+1", 4) != 0 && std::memcmp(h.magic, "ni1", 4) != 0) refuse(path, "magic", std::string(h.magic, strnlen(h.magic, 4)), "n+1 or ni1");
  if (h.dim[0] < 3 || h.dim[0] > 7) refuse(path, "dim[0]", std::to_string(h.dim[0]), "3 dimensions");
  for (int d = 1; d <= h.dim[0]; ++d) {
    const std::string name = std::string("dim[").append(std::to_string(d)).append("]");
    if (d <= 3 && (h.dim[d] < 2 || h.dim[d] > kMost)) refuse(path, name.c_str(), std::to_string(h.dim[d]), "2 to 2048 voxels");
    if (d > 3 && h.dim[d] != 1) refuse(path, name.c_str(), std::to_string(h.dim[d]), "1: a single scan");
  }
  for (int d = 1; d <= 3; ++d)
    if (!(std::isfinite(h.pixdim[d]) && std::abs(h.pixdim[d]) > 1e-3f && std::abs(h.pixdim[d]) < 1e3f))
      refuse(path, std::string("pixdim[").append(std::to_string(d)).append("]").c_str(), std::to_string(h.pixdim[d]), "the size of a voxel");
  int bytes = 0, swap = 0;
  nifti_datatype_sizes(h.datatype, &bytes, &swap);
  const bool known = h.datatype == DT_UINT8 || h.datatype == DT_INT8 || h.datatype == DT_INT16 || h.datatype == DT_UINT16 || h.datatype == DT_INT32 || h.datatype == DT_FLOAT32 || h.datatype == DT_FLOAT64;
  if (!known) refuse(path, "datatype", std::to_string(h.datatype), "whole or real numbers of 8 to 64 bits");
  if (h.bitpix != 8 * bytes) refuse(path, "bitpix", std::to_string(h.bitpix), std::to_string(8 * bytes) + ", as datatype says");
  if (!std::isfinite(h.scl_slope) || !std::isfinite(h.scl_inter)) refuse(path, "scl_slope", "not a number", "finite numbers");
}

template <class S>
void copy(const void* from, std::vector<float>& to) {
  const auto* data = static_cast<const S*>(from);
  for (std::size_t k = 0; k < to.size(); ++k) to[k] = static_cast<float>(data[k]);
}

void copy_values(const nifti_image& image, std::vector<float>& to) {
  switch (image.datatype) {
    case DT_UINT8: copy<unsigned char>(image.data, to); break;
    case DT_INT8: copy<signed char>(image.data, to); break;
    case DT_INT16: copy<short>(image.data, to); break;
    case DT_UINT16: copy<unsigned short>(image.data, to); break;
    case DT_INT32: copy<int>(image.data, to); break;
    case DT_FLOAT32: copy<float>(image.data, to); break;
    default: copy<double>(image.data, to); break;
  }
  if (image.scl_slope != 0.0f)
    for (float& v : to) v = v * image.scl_slope + image.scl_inter;
}

/// What the file of the voxels holds, unpacked, as far as it is asked for: the library fills up what is missing with zeros. [bytes]
std::size_t bytes_in(const std::string& file, std::size_t wanted) {
  const znzFile stream = znzopen(file.c_str(), "rb", nifti_is_gzfile(file.c_str()));
  if (znz_isnull(stream)) return 0;
  std::vector<char> buffer(1 << 16);
  std::size_t total = 0;
  while (total < wanted) {
    const std::size_t got = znzread(buffer.data(), 1, buffer.size(), stream);
    if (got == 0) break;
    total += got;
  }
  znzFile closing = stream;
  Xznzclose(&closing);
  return total;
}

}  // namespace

Volume read_nifti(const std::string& path) {
  if (!is_file(path)) throw InputError(path, "file", "none", "a NIfTI file");
  nifti_set_debug_level(0);
  int swapped = 0;
  const std::unique_ptr<nifti_1_header, Free> header(nifti_read_header(path.c_str(), &swapped, 0));
  if (!header) throw InputError(path, "header", "too short or no NIfTI name", "348 bytes of a NIfTI-1 header in .nii, .nii.gz or .hdr");
  check_header(path, *header);
  const std::unique_ptr<nifti_image, Free> image(nifti_image_read(path.c_str(), 0));
  if (!image || image->iname == nullptr) throw InputError(path, "data", "no file", "the file of the voxels");
  // before room is made for the voxels: a header of 348 bytes can promise 64 GB
  const std::size_t needed = static_cast<std::size_t>(image->iname_offset) + static_cast<std::size_t>(image->nvox) * static_cast<std::size_t>(image->nbyper);
  if (const std::size_t there = bytes_in(image->iname, needed); there < needed)
    throw InputError(path, "data", std::to_string(there) + " bytes", std::to_string(needed) + " bytes, as the header says");
  if (nifti_image_load(image.get()) != 0 || image->data == nullptr) throw InputError(path, "data", "fewer than the header says", "every voxel");
  Volume v;
  v.size = {image->nx, image->ny, image->nz};
  v.value.resize(static_cast<std::size_t>(v.size[0]) * static_cast<std::size_t>(v.size[1]) * static_cast<std::size_t>(v.size[2]));
  copy_values(*image, v.value);
  for (float& x : v.value)
    if (!std::isfinite(x)) x = 0.0f;
  const mat44& m = image->sform_code > 0 ? image->sto_xyz : image->qto_xyz;
  constexpr double kMillimetre = 1e-3;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) v.step(r, c) = kMillimetre * static_cast<double>(m.m[r][c]);
    v.first[r] = kMillimetre * static_cast<double>(m.m[r][3]);
  }
  if (!v.step.allFinite() || !v.first.allFinite() || std::abs(v.step.determinant()) < 1e-12) throw InputError(path, image->sform_code > 0 ? "srow_x" : "quatern_b", "no volume", "an invertible placement");
  return v;
}

double sample(const Volume& v, const std::vector<float>& value, const Vec3& at) noexcept {
  int low[3];
  double f[3];
  for (int c = 0; c < 3; ++c) {
    if (!(at[c] >= 0.0 && at[c] <= v.size[static_cast<std::size_t>(c)] - 1)) return 0.0;
    low[c] = std::min(static_cast<int>(at[c]), v.size[static_cast<std::size_t>(c)] - 2);
    f[c] = at[c] - low[c];
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    sum += (i ? f[0] : 1.0 - f[0]) * (j ? f[1] : 1.0 - f[1]) * (k ? f[2] : 1.0 - f[2]) * static_cast<double>(value[v.index(low[0] + i, low[1] + j, low[2] + k)]);
  }
  return sum;
}

}  // namespace filum
