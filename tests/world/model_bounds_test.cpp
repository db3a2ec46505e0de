// Every quantity in the shipped needles, vessels, tracks, brains, blades and their scenes, made 10^12 times larger, is refused by
// file, field, value and range; so is every length, stiffness and mass made 10^12 times smaller.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>
#include <sstream>

#include "base/error.h"
#include "world/brain_file.h"
#include "world/model.h"
#include "world/world.h"
#include "world/needle_file.h"
#include "world/vessel_file.h"
#include "world/wall_file.h"

namespace filum {
namespace model_bounds_test {

namespace fs = std::filesystem;

const fs::path kRoot = FILUM_SOURCE_DIR;

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

struct Place {
  std::size_t at = 0, length = 0;  // of the number in the text
  double value = 0.0;
  std::string line;
};

/// Where numbers with a unit stand, and values without one; what is said of their uncertainty and source is passed over.
std::vector<Place> quantities(const std::string& text) {
  static const std::regex wanted(R"((uncertainty|source|title|name)\s*:\s*"[^"]*"|"(-?[0-9][0-9.eE+-]*)( [A-Za-z][^"]*)?")");
  std::vector<Place> places;
  for (std::sregex_iterator it(text.begin(), text.end(), wanted), end; it != end; ++it) {
    if (!(*it)[2].matched) continue;
    const auto at = static_cast<std::size_t>(it->position(2));
    const auto line = text.rfind('\n', at) + 1;
    places.push_back({at, static_cast<std::size_t>(it->length(2)), std::stod((*it)[2]), text.substr(line, text.find('\n', at) - line)});
  }
  return places;
}

class ModelBounds : public testing::Test {
 protected:
  ModelBounds() : folder_(fs::temp_directory_path() / ("filum_bounds_" + std::to_string(getpid()))) { fs::create_directories(folder_); }
  ~ModelBounds() override { fs::remove_all(folder_); }

  /// Writes `text` with one number changed to `file`; what `load` then says, or nothing.
  static std::string said(const fs::path& file, const std::string& text, const Place& place, double factor, const std::function<void()>& load) {
    char number[40];
    std::snprintf(number, sizeof number, "%.9g", place.value * factor);
    std::ofstream(file) << std::string(text).replace(place.at, place.length, number);
    try {
      load();
    } catch (const InputError& error) {
      EXPECT_NE(error.file.find(file.filename().string()), std::string::npos) << error.what();
      EXPECT_FALSE(error.field.empty());
      return error.what();
    }
    return "";
  }

  /// Every number of a shipped file, 10^12 times larger.
  void expect_bounded(const fs::path& shipped, const std::function<void(const std::string&)>& load) {
    const std::string text = read(kRoot / shipped);
    const fs::path file = folder_ / shipped.filename();
    std::ofstream(file) << text;
    EXPECT_NO_THROW(load(file.string())) << shipped;
    const auto places = quantities(text);
    EXPECT_FALSE(places.empty()) << shipped;
    for (const Place& p : places) {
      if (p.value == 0.0) continue;
      EXPECT_NE(said(file, text, p, 1e12, [&] { load(file.string()); }), "") << shipped << " accepted 10^12 times " << p.line;
    }
  }

  /// The number behind `key`, 10^12 times smaller.
  void expect_lower_bounds(const fs::path& shipped, const std::vector<std::string>& keys, const std::function<void(const std::string&)>& load) {
    const std::string text = read(kRoot / shipped);
    const fs::path file = folder_ / shipped.filename();
    const auto places = quantities(text);
    for (const std::string& key : keys) {
      const auto at = text.find("\n" + key + ":");
      ASSERT_NE(at, std::string::npos) << key;
      const auto place = std::find_if(places.begin(), places.end(), [&](const Place& p) { return p.at > at; });
      ASSERT_NE(place, places.end());
      const std::string what = said(file, text, *place, 1e-12, [&] { load(file.string()); });
      EXPECT_NE(what.find(key), std::string::npos) << shipped << " on " << key << ": " << what;
    }
  }

  fs::path folder_;
};

TEST_F(ModelBounds, Needles) {
  for (const char* name : {"1-2-100um", "3-8-140um", "3-8-50um", "3-8-75um"}) expect_bounded(fs::path("models/needle") / (std::string(name) + ".yaml"), [](const std::string& f) { load_needle(f); });
  expect_lower_bounds("models/needle/3-8-75um.yaml", {"wire", "length", "density", "taper", "grip_stiffness"}, [](const std::string& f) { load_needle(f); });
}

TEST_F(ModelBounds, Vessels) {
  for (const char* name : {"chicken-artery", "human-digital-artery", "latex-card", "rat-femoral-artery", "rat-femoral-vein", "silicone-tube"})
    expect_bounded(fs::path("models/vessel") / (std::string(name) + ".yaml"), [](const std::string& f) { load_vessel(f); });
  expect_lower_bounds("models/vessel/silicone-tube.yaml", {"inner_radius", "length", "density"}, [](const std::string& f) { load_vessel(f); });
}

TEST_F(ModelBounds, Tracks) {
  for (const char* name : {"artery", "latex", "silicone", "vein"}) expect_bounded(fs::path("models/track") / (std::string(name) + ".yaml"), [](const std::string& f) { load_track(f); });
  expect_lower_bounds("models/track/artery.yaml", {"hold", "point_stiffness", "tear", "spacing"}, [](const std::string& f) { load_track(f); });
}

TEST_F(ModelBounds, Brains) {
  const auto load = [](const std::string& f) { load_model(FILUM_SOURCE_DIR, "press-to-target", f); };
  for (const char* name : {"convexity", "sylvian", "interhemispheric", "subfrontal"}) expect_bounded(fs::path("models/brain") / (std::string(name) + ".yaml"), load);
  expect_lower_bounds("models/brain/sylvian.yaml", {"relaxation_time", "reach"}, load);
}

TEST_F(ModelBounds, Blades) {
  for (const char* name : {"bent-15", "straight-2", "straight-25"}) expect_bounded(fs::path("models/spatula") / (std::string(name) + ".yaml"), [](const std::string& f) { load_blade(f); });
  expect_lower_bounds("models/spatula/straight-15.yaml", {"width", "tip_width", "length", "grip"}, [](const std::string& f) { load_blade(f); });
}

TEST_F(ModelBounds, ScenesWithTissue) {
  for (const char* top : {"curricula", "models"}) fs::copy(kRoot / top, folder_ / top, fs::copy_options::recursive);
  for (const char* task : {"card-stitches", "vessel-stitch", "artery-stitch", "end-to-side", "press-to-target", "sylvian-opening"}) {
    const fs::path file = folder_ / "curricula" / task / "scene.yaml";
    const std::string text = read(file);
    for (const Place& p : quantities(text))
      if (p.value != 0.0) {
        EXPECT_NE(said(file, text, p, 1e12, [&] { load_model(folder_.string(), task); }), "") << task << " accepted 10^12 times " << p.line;
      }
    std::ofstream(file) << text;
  }
}

}  // namespace model_bounds_test
}  // namespace filum
