#pragma once
// Strain or pressure of the tissue for whoever looks on, worked out only while somebody asks for it (physics/wall_overlay.h). choose() and
// view() may be called by different threads. Test: tests/cli/wall_colours_test.cpp.

#include <atomic>
#include <memory>
#include <string>

#include "physics/wall_overlay.h"
#include "server/views.h"
#include "world/model.h"
#include "world/observation.h"

namespace filum {

class WallColours {
 public:
  explicit WallColours(std::shared_ptr<const Model> model);

  /// "none", "strain" or "pressure"; anything else is none.
  void choose(const std::string& kind);
  OverlayView view(const Observation& o);

 private:
  enum class Kind { none, strain, pressure };
  std::shared_ptr<const Model> model_;
  std::atomic<Kind> kind_{Kind::none};
  std::unique_ptr<WallOverlay> overlay_;  // made when first asked for
  std::vector<double> values_;
};

}  // namespace filum
