#include "training/patency_factors.h"

namespace filum {
namespace {

constexpr double kNarrow = 0.25;  // share of the lumen, from which narrowing is named

PatencyFactor lapse_factor(const NeedleReport& r, const char* name, const char* title, const char* source) {
  const double n = count_of(r.lapses, name);
  return {name, title, n, "-", n > 0.0, source};
}

}  // namespace

std::vector<PatencyFactor> patency_factors(const NeedleReport& r) {
  if (!r.join) return {};
  const JoinReport& j = *r.join;
  return {lapse_factor(r, "back-wall", "Stitches through the back wall", "Paladino 2023: odds ratio 59 for thrombosis of rat arteries, about 1000 of veins"),
          {"thread-in-lumen", "Thread in the lumen", 1e3 * j.thread_inside, "mm", count_of(r.lapses, "thread-in-lumen") > 0.0, "Anastomosis Lapse Index"},
          {"narrowing", "Narrowing of the lumen", 100.0 * j.narrowing, "%", j.narrowing > kNarrow, "uneven lumens lower patency (Esanu 2026); threshold 25 % [P]"},
          {"edge-overlap", "Edges past each other or rolled inward", j.overlap, "thicknesses", count_of(r.lapses, "edge-overlap") > 0.0, "Anastomosis Lapse Index: media and adventitia in the stream"},
          {"wall-grasped", "Wall grasped through its thickness", static_cast<double>(r.handling.walls), "-", r.handling.walls > 0,
           "Moore: the intima is injured from 5 kPa of added stress (abstract), 1.5 mN on a tip's contact; adventitia may be held"},
          lapse_factor(r, "wall-tear", "Stitches that tore the wall", "Anastomosis Lapse Index"),
          lapse_factor(r, "too-tight", "Stitches too tight", "tight stitches, necrosis of the media (histology of human vessels)"),
          lapse_factor(r, "partial-thickness", "Stitches without the intima", "Anastomosis Lapse Index"),
          {"not-patent", "Lumen closed or without flow", j.patent ? 0.0 : 1.0, "-", !j.patent, "clamps-off test: narrowed by half, or less than half of an open vessel's flow goes on [P]"}};
}

}  // namespace filum
