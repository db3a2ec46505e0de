#pragma once
// How two measures go together, within sessions and across them. Across: Pearson's r with Fisher's interval,
// tanh(atanh r -+ z / sqrt(n - 3)), and Spearman's rank correlation. Within: repeated-measures correlation (J. Z.
// Bakdash, L. R. Marusich, Front. Psychol. 8 (2017) 456): r of the values less each session's mean, with
// N - sessions - 1 degrees of freedom, so that differences between sessions do not pass for a relation within them.
// r is itself the effect size; r^2 is the share of variance. Neglects: serial correlation of windows that follow one
// another, which makes the interval within too narrow. Test: correlation_test.

#include <string>
#include <vector>

namespace filum {

struct Correlation {
  int n = 0;                      // pairs
  int groups = 0;                 // sessions; 0 across sessions
  double r = 0.0, low = 0.0, high = 0.0;  // 95 %
  double rank = 0.0;              // Spearman; NaN within
  double slope = 0.0;             // of y over x, least squares, in their units
  std::string why;                // why there is none; r is NaN then
};

/// Needs at least 4 pairs and both to vary.
Correlation correlate(const std::vector<double>& x, const std::vector<double>& y);

/// Pairs of one session each; needs at least 2 degrees of freedom.
struct PairGroup {
  std::vector<double> x, y;
};
Correlation correlate_within(const std::vector<PairGroup>& groups);

}  // namespace filum
