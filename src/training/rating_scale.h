#pragma once
// A rating scale for the finished work, from a file (curricula/scales/*.yaml, format filum-scale/1): items of 0 to `most` points. What the
// simulator can tell of an item is its estimate, with the number that decided; an item without criteria, or whose measures are not there,
// is left to the rater. An estimate is the worst that an item's criteria say: the fewest points, or the most where points count lapses
// (`better: fewer`). Test: rating_scale_test.

#include <optional>
#include <string>
#include <vector>

#include "training/needle_watch.h"

namespace filum {

struct ScaleCriterion {
  std::string measure, title, unit, source;  // measure: see scale_value
  std::vector<Range> points;                 // points[k]: where k + 1 points are given, each within the one before
};

struct ScaleItem {
  std::string name, title;
  std::vector<std::string> words;  // what 0, 1, ... points mean
  std::vector<ScaleCriterion> criteria;
  std::string rater;               // why it is left to the rater, empty where there are criteria
};

struct RatingScale {
  std::string name, title, source;
  int most = 2;
  bool fewer_is_better = false;    // points count lapses
  std::vector<ScaleItem> items;
};

/// Throws InputError.
RatingScale load_rating_scale(const std::string& path);
RatingScale parse_rating_scale(const YamlNode& file);

struct ScaleEstimate {
  std::optional<int> points;       // nothing: left to the rater
  std::optional<double> value;     // of the criterion that decided, in its unit
  std::string unit = "-", why;
};

/// Leak in ml/min, bites in wall thicknesses, slack and ends in mm, lapses of the Anastomosis Lapse Index by their names (training/lapse.h):
/// how many the report has. NaN where there was nothing to measure: a lapse that was not looked for is not absent.
double scale_value(const std::string& measure, const NeedleReport& report);
/// One for each item.
std::vector<ScaleEstimate> estimates(const RatingScale& scale, const NeedleReport& report);

}  // namespace filum
