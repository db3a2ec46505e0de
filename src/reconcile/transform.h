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

}  // namespace filum::reconcile
