#pragma once
// Do grasp force, accuracy and tremor go together? (The study that Wang, Su, Burdet & Bleuler announce.) Each recording is cut into parts:
// the time an object was held, else pieces of 4 s. A part gives
//   force     mean squeeze while something was grasped
//   accuracy  root mean square distance from the target (or of the object put down from its place)
//   tremor    sqrt(P - P_floor), P the power of the hand's path in 6-12 Hz; only where the session's own spectrum stands out of the
//             noise floor of its device, else the session has none and says why: noise is not correlated with anything.
// Four questions are kept apart, since they have different answers (Simpson's paradox):
//   windows        within sessions: parts less their session's mean (repeated measures)
//   sessions       across sessions: means of sessions, whoever made them
//   within_people  across the sessions of one person: means of sessions less their person's mean (repeated measures)
//   people         across people: means of people
// Neglects: that parts follow one another (intervals of `windows` are too narrow) and that several questions are asked at once
// (intervals are not widened for it). Test: study_test.

#include <array>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "analysis/correlation.h"
#include "analysis/options.h"
#include "analysis/recorded_series.h"
#include "analysis/scatter_plot.h"

namespace filum {

/// NaN where not measured or not resolved.
struct StudyValues {
  double force = std::numeric_limits<double>::quiet_NaN();     // [N]
  double accuracy = std::numeric_limits<double>::quiet_NaN();  // [m]
  double tremor = std::numeric_limits<double>::quiet_NaN();    // [m]
};

struct StudySession {
  std::string id, task, participant, started_utc, input, recorded_with;
  double seconds = 0.0;
  std::vector<StudyValues> parts;
  StudyValues mean;          // of its parts, each where there is one
  std::string force_source;  // "device", "simulation" or "none"
  double floor = std::numeric_limits<double>::quiet_NaN();  // [m], rms in 6-12 Hz
  std::string floor_source;
  std::string tremor_why;    // why it has no tremor; empty where it has
};

/// `clamped`: recording of the same device with its tool clamped, may be null.
StudySession study_session(const RecordedSession& session, const RecordedSession* clamped, const AnalysisOptions& options = {});

struct StudyPair {
  std::string name;  // "force_accuracy", "force_tremor", "tremor_accuracy"
  ScatterPanel panel;
  Correlation windows, sessions, within_people, people;
};
std::array<StudyPair, 3> study_pairs(const std::vector<StudySession>& sessions);

/// Sessions of one task together: a task's own demands would otherwise pass for a relation.
struct TaskStudy {
  std::string task;
  std::vector<StudySession> sessions;
  std::size_t people = 0;  // with a code of their own
  std::array<StudyPair, 3> pairs;
};
struct Study {
  std::vector<TaskStudy> tasks;
  std::string derived_with;
  AnalysisOptions options;
};
Study study_of(const std::vector<StudySession>& sessions, const std::string& program, const AnalysisOptions& options = {});

nlohmann::ordered_json correlation_json(const Correlation& c);
nlohmann::ordered_json settings_json(const AnalysisOptions& options);
nlohmann::ordered_json study_json(const Study& study);

}  // namespace filum
