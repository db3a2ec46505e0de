// Courses, tasks, rules of lapses, rating scales and limits of pressure, told apart by their format line (any other text is a task): what was asked
// for or an InputError, nothing else.

#include "fuzz_folder.h"
#include "training/course.h"
#include "training/lapse.h"
#include "training/pressure.h"
#include "training/rating_scale.h"
#include "training/task.h"

namespace {

using namespace filum;

void read_task(const YamlNode& file) {
  const Task task = parse_task(file, FILUM_SOURCE_DIR);
  for (const RubricItem& item : task.rubric) {
    const double share = item.band.share(1.0);
    if (!(share >= 0.0 && share <= 1.0)) std::abort();
  }
}

void read_scale(const YamlNode& file) {
  const RatingScale scale = parse_rating_scale(file);
  if (estimates(scale, NeedleReport{}).size() != scale.items.size()) std::abort();
}

void read_limits(const YamlNode& file) {
  PressureWatch watch(parse_pressure_limits(file), 1.0);
  for (int k = 0; k < 100; ++k) watch.observe(100.0 * k, 0.1);
  watch.messages();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  const std::string_view text = fuzz::text_of(data, size), format = fuzz::format_of(text);
  fuzz::read([&] {
    if (format == "filum-lapses/1") {
      load_lapse_rules(folder.write("lapses.yaml", text));
      return;
    }
    const YamlNode file = YamlNode::parse(text, "fuzz.yaml");
    if (format == "filum-scale/1") read_scale(file);
    else if (format == "filum-course/1") chapters_of(parse_course(file), {"knot-square"});
    else if (format == "filum-pressure/1") read_limits(file);
    else read_task(file);
  });
  return 0;
}
