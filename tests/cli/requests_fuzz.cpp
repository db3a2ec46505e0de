// What pages send below /api and what recordings say of a result: taken or an InputError, nothing else. The first byte chooses the reader, the
// rest is the body; an upload is a list of bodies, one a line, of which the first begins it.

#include <nlohmann/json.hpp>

#include "cli/calibration_plan.h"
#include "cli/camera_plan.h"
#include "cli/dataset_upload.h"
#include "cli/requests.h"
#include "fuzz_folder.h"

namespace {

using namespace filum;

void read_calibration(const std::string& body) {
  const CalibrationPlan plan = calibration_plan(body, "port", "root", "folder");
  for (const auto* values : {&plan.angles, &plan.forces})
    for (std::size_t k = 1; k < values->size(); ++k)
      if (!((*values)[k] > (*values)[k - 1])) std::abort();
  if (plan.repeats < 2 || plan.repeats > 20) std::abort();
}

void read_camera(const std::string& body) {
  const CameraPlan plan = camera_plan(body, "program", "folder", "");
  if (!(plan.square >= 1.0 && plan.square <= 200.0) || plan.name.empty() || plan.name[0] == '-') std::abort();
}

void read_upload(const std::string& lines) {
  static const fuzz::Folder folder;
  std::filesystem::remove_all(folder.file("datasets"));
  DatasetUpload upload(folder.file("datasets"));
  std::size_t from = 0;
  for (int n = 0; from <= lines.size() && n < 20; ++n) {
    const std::size_t end = std::min(lines.find('\n', from), lines.size());
    const std::string line = lines.substr(from, end - from);
    from = end + 1;
    const std::size_t blank = line.find(' ');
    fuzz::read([&] {
      if (n == 0) upload.begin(line);
      else if (line.starts_with("{\"upload\"")) upload.finish(line);
      else if (line.starts_with("{")) upload.cancel(line);
      else upload.part(line.substr(0, blank), blank == line.npos ? "" : line.substr(blank + 1));
    });
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    if (entry.path().filename() != "datasets") std::abort();  // nothing lands beside the folder
}

void read_rating(const std::string& body) {
  static const auto scales = nlohmann::ordered_json::parse(R"([{"name":"mars10","most":2,"items":[{"name":"closure"},{"name":"knots"}]},{"name":"lapse-index","most":1,"items":[{"name":"oblique"}]}])");
  const Rating rating = requested_rating("s1", "task", scales, body);
  for (const ItemMark& m : rating.marks)
    if (m.points < 0 || m.points > 2) std::abort();
}

/// The scales as a recording has them.
void read_scale(const std::string& body) {
  const auto result = parsed_json(body);
  try {
    requested_rating("s1", "task", scales_of(result), R"({"rater":"R1","scale":"mars10","marks":{"closure":1}})");
  } catch (const nlohmann::json::exception&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string body(fuzz::text_of(data + 1, size - 1));
  fuzz::read([&] {
    switch (data[0] % 7) {
      case 0: requested_text(body, "dataset"); break;
      case 1: requested_names(body, "sessions"); break;
      case 2: read_calibration(body); break;
      case 3: read_camera(body); break;
      case 4: read_rating(body); break;
      case 5: read_scale(body); break;
      default: read_upload(body); break;
    }
  });
  return 0;
}
