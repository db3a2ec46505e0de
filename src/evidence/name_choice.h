#pragma once
// Which of a list of problems or benches the user asked for: by name, or by the beginning of it up to a
// hyphen.

#include <string>
#include <vector>

#include "base/error.h"

namespace filum {

inline bool stands_for(const std::string& asked, const std::string& name) {
  return name.starts_with(asked) && (name.size() == asked.size() || name[asked.size()] == '-');
}

/// All are wanted if none is asked for.
inline bool is_wanted(const std::vector<std::string>& asked, const std::string& name) {
  for (const std::string& a : asked)
    if (stands_for(a, name)) return true;
  return asked.empty();
}

/// Throws InputError for what stands for none.
inline void check_names(const char* command, const std::vector<std::string>& asked,
                        const std::vector<std::string>& names) {
  for (const std::string& a : asked) {
    bool known = false;
    std::string all;
    for (const std::string& name : names) {
      known = known || stands_for(a, name);
      all.append(all.empty() ? "one of " : ", ").append(name);
    }
    if (!known) throw InputError(command, "name", a, all);
  }
}

}  // namespace filum
