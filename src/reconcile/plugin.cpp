#include "reconcile/plugin.h"

#include <dlfcn.h>

#include <filesystem>
#include <vector>

namespace filum::reconcile {

void* module_function(const std::string& name, const char* symbol, std::string* why) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::vector<fs::path> folders = {fs::read_symlink("/proc/self/exe", error).parent_path()};
  folders.emplace_back(FILUM_MODULES);
  for (const fs::path& folder : folders) {
    const fs::path file = folder / ("lib" + name + ".so");
    if (!fs::exists(file, error)) continue;
    // global: Open MPI's own plugins look for its symbols
    if (void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL)) {
      if (void* function = dlsym(module, symbol)) return function;
    }
    if (const char* text = dlerror(); text != nullptr && why != nullptr) *why = text;
  }
  return nullptr;
}

}  // namespace filum::reconcile
