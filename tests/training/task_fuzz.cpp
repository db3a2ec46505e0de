// Task files: whatever the bytes are, the parser gives a task or an InputError, nothing else.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "training/task.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const filum::Task task = filum::parse_task(filum::YamlNode::parse(text, "fuzz.yaml"));
    for (const filum::RubricItem& item : task.rubric) {
      const double share = item.band.share(1.0);
      if (!(share >= 0.0 && share <= 1.0)) __builtin_trap();
    }
  } catch (const filum::InputError&) {
  }
  return 0;
}
