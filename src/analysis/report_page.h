#pragma once
// The analysis as one page that stands alone: spectra with their bands, tables with the noise floor beside every value, what
// was refused and why, scatter plots. Test: report_page_test.

#include <string>

#include "analysis/report.h"

namespace filum {

std::string report_page(const AnalysisReport& report);

}  // namespace filum
