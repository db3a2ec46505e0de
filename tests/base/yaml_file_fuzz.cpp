// Any bytes either give a tree whose every field can be asked for, or an InputError.

#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "base/yaml_file.h"

namespace {

void read_all(const filum::YamlNode& node, int depth) {
  for (const std::string& key : node.keys()) {
    const auto attempt = [&](auto&& read) {
      try {
        read();
      } catch (const filum::InputError&) {
      }
    };
    attempt([&] { node.quantity(key, "mm", filum::Range::positive()); });
    attempt([&] { node.integer(key, -5, 5); });
    attempt([&] { node.flag(key); });
    attempt([&] { node.vec3(key, "mm"); });
    attempt([&] { node.texts(key); });
    if (depth >= 4) continue;
    attempt([&] { read_all(node.map(key), depth + 1); });
    attempt([&] {
      for (const filum::YamlNode& item : node.items(key)) read_all(item, depth + 1);
    });
  }
  node.finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read_all(filum::YamlNode::parse({reinterpret_cast<const char*>(data), size}, "fuzz.yaml"), 0);
  } catch (const filum::InputError&) {
  }
  return 0;
}
