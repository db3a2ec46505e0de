#include "cli/trainer_check.h"

#include <filesystem>

#include "base/error.h"
#include "base/file_kind.h"
#include "cli/inputs.h"
#include "cli/setup.h"

namespace filum {
namespace {

void check_tasks(const TrainerOptions& options) {
  std::vector<std::string> problems;
  if (!load_tasks(options.root, problems).empty()) return;
  throw InputError("--root", "curricula", problems.empty() ? options.root : "no task that can be read (the first one said: " + problems[0] + ")", "a folder with models/ and curricula/");
}

void check_model(const TrainerOptions& options) {
  if (options.model_file.empty()) return;
  std::string last;
  for (const std::string& task : task_names(options.root)) {
    try {
      load_setup(options.root, task, options.model_file);
      return;
    } catch (const InputError& error) {
      last = error.what();
    }
  }
  throw InputError("--model", "model", options.model_file, "a model that a task can take (the last one said: " + last + ")");
}

void check_viewer(const TrainerOptions& options) {
  std::error_code error;
  if (options.viewer_folder.empty() || std::filesystem::is_regular_file(std::filesystem::path(options.viewer_folder) / "index.html", error)) return;
  throw InputError("--viewer", "index.html", "none in " + options.viewer_folder, "the folder of the built viewer (./filum builds it)");
}

/// Numbered pictures are no file of their name: their folder is looked for.
void check_camera(const std::string& source) {
  const bool camera = source.find_first_not_of("0123456789") == std::string::npos;  // none given, too
  const bool numbered = source.find('%') != std::string::npos;
  const std::filesystem::path folder = std::filesystem::path(source).parent_path();
  if (camera || (numbered ? folder.empty() || is_folder(folder) : is_there(source) && !is_folder(source))) return;
  throw InputError("--camera", "source", source, "a video that is there, pictures like view_%03d.png in a folder that is, or the number of a camera");
}

/// Opened and let go again: the sessions open them anew.
void check_devices(const TrainerOptions& options) {
  if (!options.calibration.empty() && options.serial_port.empty()) throw InputError("--forceps", "calibration", options.calibration, "--serial PATH beside it");
  if (options.motion_scale != 1.0 && options.hands.empty()) throw InputError("--motion-scale", "devices", "none with --hands", "--hands haptic:PORT or igtl:PORT beside it");
  const LiveDevices devices{options.serial_port, options.calibration, options.hands, options.motion_scale};
  if (devices.any()) open_live_inputs(devices, options.root);
}

}  // namespace

void check_trainer_options(const TrainerOptions& options) {
  check_tasks(options);
  check_model(options);
  check_viewer(options);
  check_devices(options);
  check_camera(options.camera);
}

}  // namespace filum
