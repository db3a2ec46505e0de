// A camera's calibration: whatever the bytes are, numbers that can be written and read back, or an InputError.

#include "fuzz_folder.h"
#include "tracker/camera_model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace filum;
  const std::string text(fuzz::text_of(data, size));
  fuzz::read([&] {
    const CameraModel camera = CameraModel::parse(text, "fuzz.yaml");
    const CameraModel again = CameraModel::parse(camera.text(), "written.yaml");
    if (again.width != camera.width || again.height != camera.height || !(again.fx > 0.0)) std::abort();
  });
  return 0;
}
