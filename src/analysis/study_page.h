#pragma once
// A study as files for people and for other programs: one HTML page with plots and tables, and tables as CSV. Test: study_test.

#include <string>

#include "analysis/study.h"

namespace filum {

std::string study_page(const Study& study);
/// Plot of one task; empty for a task that is not in the study.
std::string study_plot(const Study& study, const std::string& task);
/// One line a session, and one line a part of a session.
std::string sessions_csv(const Study& study);
std::string parts_csv(const Study& study);

}  // namespace filum
