#pragma once
// Do two raters, or a rater and the simulator's estimates, give the same points to the same sessions?
//   kappa  Cohen's kappa with quadratic weights (J. Cohen, Psychol. Bull. 70 (1968) 213), the squared differences seen over those
//          expected by chance:  1 - sum_i (a_i - b_i)^2 / n  /  ( sum_ij (a_i - b_j)^2 / n^2 )
//          with a 95 % interval by resampling sessions (percentiles of 2,000 draws, the same draws for the same sessions)
//   icc    ICC(2,1), absolute agreement of single ratings, raters taken at random (P. E. Shrout, J. L. Fleiss, Psychol. Bull. 86
//          (1979) 420, case 2):  (BMS - EMS) / (BMS + (k-1) EMS + k (JMS - EMS) / n)
// Neglects: that sessions of one trainee resemble each other (intervals are then too narrow) and that many items are asked at once.
// "total" is the sum of the items that both mark. Test: agreement_test.

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "session/ratings.h"

namespace filum {

/// NaN where the points do not vary.
double weighted_kappa(const std::vector<double>& a, const std::vector<double>& b);
/// `points`: sessions x raters, at least 2 of each.
double icc_2_1(const Eigen::MatrixXd& points);

struct Agreement {
  std::string scale, item, a, b;  // raters' codes; "simulator" is always b. Of all raters together: a is "raters", b empty
  int sessions = 0, raters = 2;
  double same = 0.0;              // share of sessions with the same points; NaN for more than two
  double bias = 0.0;              // mean of a less b, points; NaN for more than two
  double kappa = 0.0, low = 0.0, high = 0.0;  // NaN for more than two, or too few
  double icc = 0.0;
};

/// Every pair of raters that have a session in common, item by item, then three or more human raters together.
std::vector<Agreement> agreements(const std::vector<Rating>& ratings);

nlohmann::ordered_json agreement_json(const std::vector<Agreement>& all, const std::vector<Rating>& ratings);
/// RFC 4180, first row names, empty where there is no number.
std::string agreement_csv(const std::vector<Agreement>& all);
/// One row for each session, scale, rater and item.
std::string ratings_csv(const std::vector<Rating>& ratings);

}  // namespace filum
