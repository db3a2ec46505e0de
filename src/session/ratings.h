#pragma once
// Marks that raters gave to stored sessions, in a file of their own beside the store's index (that one may be built anew from the
// recordings; a rating cannot). Raters are codes, never names; "simulator" is the code of its estimates, which are stored with the first
// rating of a session so that both can be compared later, whatever the program says by then. Nothing is overwritten: the newest of a
// rater counts. Test: ratings_test.

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace filum {

inline constexpr int kRatingsFormat = 1;
inline constexpr const char* kSimulatorCode = "simulator";

struct ItemMark {
  std::string item;
  int points = 0;
};

struct Rating {
  std::string session, task, scale, rater, stored_utc;
  std::vector<ItemMark> marks;
};

class Ratings {
 public:
  /// Opens or creates ratings.sqlite in the folder. Throws InputError when it is damaged or foreign, StoreError when it is
  /// newer: it is never replaced.
  explicit Ratings(const std::string& folder);
  ~Ratings();

  /// Throws InputError for a rater that is no code. All marks or none are stored.
  void put(const Rating& rating);
  /// The newest of each rater for each session and scale, sorted by session, scale, rater; empty session: all.
  std::vector<Rating> list(const std::string& session = "") const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace filum
