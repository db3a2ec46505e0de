// Noise that remembers in part, against its covariance (1 - white) sigma^2 rho^d.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "base/rng.h"
#include "records.h"
#include "reconcile/noise.h"
#include "reconcile/result.h"

namespace filum::reconcile {
namespace noise_test {

OutputNoise noise_of(double sigma, double rho, double white) {
  OutputNoise n;
  n.sigma = sigma, n.rho = rho, n.white = white;
  return n;
}

std::vector<Eigen::VectorXd> drawn(const OutputNoise& o, int records, int samples, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Eigen::VectorXd> out;
  for (int i = 0; i < records; ++i) {
    Eigen::VectorXd r(samples);
    double x = rng.normal();
    for (int k = 0; k < samples; ++k) {
      if (k > 0) x = o.rho * x + std::sqrt(1.0 - o.rho * o.rho) * rng.normal();
      r[k] = o.sigma * (std::sqrt(1.0 - o.white) * x + std::sqrt(o.white) * rng.normal());
    }
    out.push_back(r);
  }
  return out;
}

/// W C W' = 1, C the covariance of the samples that are there.
TEST(Noise, WhitenedNoiseIsWhiteAcrossGapsToo) {
  const std::vector<int> at = {0, 1, 2, 3, 7, 8, 11, 12, 13, 30, 31, 32};
  const auto n = static_cast<Eigen::Index>(at.size());
  for (const double white : {0.0, 0.3, 0.9})
    for (const double rho : {0.0, 0.6, 0.95}) {
      const OutputNoise o = noise_of(2e-3, rho, white);
      Eigen::MatrixXd C(n, n), W = Eigen::MatrixXd::Identity(n, n);
      for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
          C(i, j) = o.sigma * o.sigma * (i == j ? 1.0 : (1.0 - white) * std::pow(rho, std::abs(at[static_cast<std::size_t>(i)] - at[static_cast<std::size_t>(j)])));
      whiten(W, at, o);
      EXPECT_LT((W * C * W.transpose() - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-12) << white << " " << rho;
    }
}

/// The mean of the spectrum is the variance; its value at 0 is what the sum of many samples has over that of as many independent ones.
TEST(Noise, SpectrumHoldsTheVariance) {
  const OutputNoise o = noise_of(1.0, 0.85, 0.5);
  double sum = 0.0, together = 0.0;
  for (int k = 0; k < 1000; ++k) sum += o.spectrum(2.0 * std::numbers::pi * k / 1000) / 1000;
  for (int d = -400; d <= 400; ++d) together += d == 0 ? 1.0 : 0.5 * std::pow(0.85, std::abs(d));
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_NEAR(o.slow(), together, 1e-9);
  EXPECT_NEAR(o.spectrum(0.0), o.slow(), 1e-9);
}

TEST(Noise, AShareOfWhiteNoiseIsFound) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const OutputNoise found = likeliest(drawn(noise_of(2e-3, 0.85, 0.5), 6, 400, seed), noise_of(1.7e-3, 0.4, 0.0), 1e-6, 1.0, 8.0);
    EXPECT_NEAR(found.white, 0.5, 0.12) << seed;
    EXPECT_NEAR(found.rho, 0.85, 0.06) << seed;
    EXPECT_NEAR(found.sigma, 2e-3, 0.2e-3) << seed;
  }
}

/// Where all of the noise remembers, or none, what was given stays, but for once in 200 sets by chance.
TEST(Noise, NoShareIsAddedWhereThereIsNone) {
  int changed = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const double rho = seed % 2 == 0 ? 0.6 : 0.0;
    changed += likeliest(drawn(noise_of(2e-3, rho, 0.0), 4, 200, seed), noise_of(1.0, rho, 0.0), 1e-6, 1.0, 8.0).white > 0.0 ? 1 : 0;
  }
  EXPECT_LE(changed, 2);  // more than 2 of 60 once in 300 times
}

/// A displacement that was read off a film to 0.7 um moves the force of a block of 10 N/m by 7 uN: less noise than that there cannot be, and as much may
/// be there beside what the dataset states of its force.
TEST(Noise, WhatAFilmAddsIsPartOfIt) {
  const auto noise = [](double sd, double there, const std::string& stated) {
    Folder f;
    Rng rng(4);
    std::string yaml = block_yaml("  - { file: a.csv, protocol: { mode: compression, rate: \"0.1 mm/s\" } }\n  - { file: b.csv, protocol: { mode: compression, rate: \"0.4 mm/s\" } }\n");
    if (!stated.empty()) yaml.replace(yaml.find("kind: output"), 12, "kind: output, noise: \"" + stated + "\"");
    f.write("experiment.yaml", yaml);
    for (const auto& [name, speed] : {std::pair{"a.csv", 1.0}, {"b.csv", 4.0}}) f.write(name, block_csv([&](double, double u, int) { return 10.0 * u + there * rng.normal(); }, speed));
    Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
    if (sd > 0.0)
      for (Trial& t : d.trials) t.tracked["displacement"] = sd;
    return reconcile(d).fit.noise.output.at(0);
  };
  EXPECT_NEAR(noise(0.0, 0.001, "").sigma / 1e-6, 1.0, 0.15);
  const OutputNoise film = noise(0.7e-6, 0.001, "");
  EXPECT_NEAR(film.sigma / 7e-6, 1.0, 0.03);
  EXPECT_EQ(film.from, "tracking in the film");
  EXPECT_LT(noise(0.0, 0.007, "0.001 mN").sigma, 2e-6);
  EXPECT_NEAR(noise(0.7e-6, 0.007, "0.001 mN").sigma / 7e-6, 1.0, 0.15);
}

}  // namespace noise_test
}  // namespace filum::reconcile
