#pragma once
// Noise of an output: a part that remembers and a part that does not (the converter, an amplifier's white floor),
//   r_k = x_k + v_k,  x_k = rho x_(k-1) + e_k,  var x = (1 - white) sigma^2,  var v = white sigma^2,
// an ARMA(1,1) process (Granger & Morris 1976); white = 0 is AR(1). Covariance at a lag of d samples: (1 - white) sigma^2 rho^d.
// Whitened by the innovations of its Kalman filter (Harvey 1989, ch. 3), which bridges samples that are left out; likelihood likewise.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace filum::reconcile {

struct OutputNoise {
  double sigma = 1.0;       // [SI], one standard deviation
  double rho = 0.0;         // correlation of neighbouring samples of the part that remembers
  double full_scale = 1.0;  // [SI]
  std::string from;         // stated, replicates, fast part
  double white = 0.0;       // share of the variance that does not remember

  /// Density over that of white noise of the same variance; `phase`: 2 pi f over the rate of sampling.
  double spectrum(double phase) const;
  /// Samples that are worth one independent sample where a mean is asked for: the spectrum at 0.
  double slow() const;
};

/// In place: each column whitened, rows at samples `at` (ascending). White noise of unit variance is left of noise.
void whiten(Eigen::Ref<Eigen::MatrixXd> m, const std::vector<int>& at, const OutputNoise& noise);

/// The share of white noise and the memory that make records (NaN: left out) likeliest, their standard deviation between `low` and `high` [SI]. `given`
/// where its own sort, AR(1), does as well: `worth` is the fall of twice the negative log likelihood that the further parameter must bring.
OutputNoise likeliest(const std::vector<Eigen::VectorXd>& records, const OutputNoise& given, double low, double high, double worth);

}  // namespace filum::reconcile
