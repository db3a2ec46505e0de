#pragma once
// Datasets made in a temporary folder for tests of the reader and of the whole workflow.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include <stdlib.h>

namespace filum::reconcile {

class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "reconcile-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }

 private:
  std::string path_;
};

/// A block compressed, held and unloaded; `force` gives the reading from time [s] and displacement [mm] in mN.
inline std::string block_csv(const std::function<double(double, double, int)>& force, double speed = 1.0, int n = 200) {
  std::ostringstream s;
  s << "t,u,F\n";
  for (int i = 0; i < n; ++i) {
    const double x = static_cast<double>(i) / (n - 1), t = 20.0 * x / speed;
    const double u = -0.5 * (x < 0.3 ? x / 0.3 : x < 0.6 ? 1.0 : x < 0.9 ? (0.9 - x) / 0.3 : 0.0);
    s << t << "," << u << "," << force(t, u, i) << "\n";
  }
  return s.str();
}

inline std::string block_yaml(const std::string& trials, const std::string& more = "") {
  return "format: filum-experiment/1\ntitle: block\nsource: test\nrig: tissue-block\n"
         "specimen: { shape: cuboid, length: \"5 mm\", width: \"5 mm\", height: \"5 mm\" }\n"
         "model:\n  file: brain/linear\n  free: [youngs_modulus]\n" + more +
         "channels:\n  - { name: time, column: t, unit: s }\n  - { name: displacement, column: u, unit: mm, kind: input }\n"
         "  - { name: force, column: F, unit: mN, kind: output }\ntrials:\n" + trials;
}

}  // namespace filum::reconcile
