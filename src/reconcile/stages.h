#pragma once
// The pipeline's stages as the report tells them, in the order in which they ran: the options that each went by, what it found, and that in a sentence.
// Times are left out: a report is the same bytes whoever ran it.

#include <nlohmann/json.hpp>

#include "reconcile/result.h"

namespace filum::reconcile {

struct Stage {
  std::string name;
  nlohmann::ordered_json options, found;  // objects of numbers and texts
  std::string summary;
};
std::vector<Stage> stages_of(const Dataset& d, const Result& r);

}  // namespace filum::reconcile
