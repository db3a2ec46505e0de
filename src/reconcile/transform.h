#pragma once
// The discrete Fourier transform of a record, missing samples as zeros. Its time is that of the length times its largest prime factor: a long record of an
// unlucky length is transformed without its last samples (less than 3 %), so that it takes no longer than its neighbours.

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace filum::reconcile {

/// Of n samples those that are transformed: n, or where n times its largest prime factor is more than 2e7 the next lower product of 2, 3, 5 and 7.
Eigen::Index transformed_length(Eigen::Index n);
/// As many values as transformed_length(v.size()).
std::vector<std::complex<double>> transform(const Eigen::VectorXd& v);
/// What a sinusoid of each frequency [Hz, evenly spaced, ascending] takes off the sum of squares of v, many periods long: 2 |sum v exp(-iwt)|^2 / n, by one
/// transform of the record turned back by the middle frequency and put on a fine grid of times, with lines between its values. Half a cell is 0.126 rad at the
/// ends of the band: 0.5 % of the power there; the lines lose 4 % at most. For long records, where a sum for each frequency takes minutes.
std::vector<double> line_powers(const Eigen::VectorXd& time, const Eigen::VectorXd& v, const std::vector<double>& frequency);

}  // namespace filum::reconcile
