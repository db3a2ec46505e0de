#include "reconcile/noise.h"

#include <algorithm>
#include <cmath>

namespace filum::reconcile {
namespace {

/// One step of the filter, all variances over sigma^2: `left` is what is not known of x before the sample; afterwards before the next one.
struct Filter {
  double rho, white, left;
  double seen() const { return left + white; }  // variance of the innovation
  double gain() const { return left / seen(); }
  double step(int gap) {  // returns rho^gap
    const double phi = gap == 1 ? rho : std::pow(rho, gap);
    left = phi * phi * left * white / seen() + (1.0 - white) * (1.0 - phi * phi);
    return phi;
  }
};

/// AR(1) needs no filter: the sample before tells all.
void whiten_plain(Eigen::Ref<Eigen::MatrixXd> m, const std::vector<int>& at, const OutputNoise& noise) {
  double phi = noise.rho, scale = 1.0 / (noise.sigma * std::sqrt(1.0 - phi * phi));
  int last = 1;
  for (Eigen::Index k = m.rows() - 1; k > 0; --k) {
    const int gap = at[static_cast<std::size_t>(k)] - at[static_cast<std::size_t>(k) - 1];
    if (gap != last) {
      phi = std::pow(noise.rho, gap);
      scale = 1.0 / (noise.sigma * std::sqrt(1.0 - phi * phi));
      last = gap;
    }
    m.row(k) = (m.row(k) - phi * m.row(k - 1)) * scale;
  }
  m.row(0) /= noise.sigma;
}

/// Twice the negative log likelihood of records but for a constant, and the standard deviation at which it is least. The largest fiftieth of the squared
/// innovations (events) is left out and made up for: 0.873 of a normal variable's variance lies below.
double unlikelihood(const std::vector<Eigen::VectorXd>& records, double rho, double white, double low, double high, double& sigma) {
  std::vector<double> squares;
  double logs = 0.0;
  for (const Eigen::VectorXd& r : records) {
    Filter filter{rho, white, 1.0 - white};
    double mean = 0.0;
    Eigen::Index last = -1;
    for (Eigen::Index k = 0; k < r.size(); ++k) {
      if (!std::isfinite(r[k])) continue;
      if (last >= 0) mean *= filter.step(static_cast<int>(k - last));
      const double miss = r[k] - mean;
      squares.push_back(miss * miss / filter.seen());
      logs += std::log(filter.seen());
      mean += filter.gain() * miss;
      last = k;
    }
  }
  if (squares.empty()) return 0.0;
  const std::size_t keep = squares.size() - squares.size() / 50;
  std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(keep - 1), squares.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < keep; ++i) sum += squares[i];
  const auto n = static_cast<double>(squares.size());
  const double variance = sum / static_cast<double>(keep) / (keep < squares.size() ? 0.873 : 1.0);
  sigma = std::clamp(std::sqrt(variance), low, high);
  return n * (2.0 * std::log(sigma) + variance / (sigma * sigma)) + logs;
}

}  // namespace

double OutputNoise::spectrum(double phase) const {
  const double slow_part = (1.0 - rho * rho) / (1.0 + rho * rho - 2.0 * rho * std::cos(phase));
  return white > 0.0 ? (1.0 - white) * slow_part + white : slow_part;
}

double OutputNoise::slow() const { return (1.0 - white) * (1.0 + rho) / (1.0 - rho) + white; }

void whiten(Eigen::Ref<Eigen::MatrixXd> m, const std::vector<int>& at, const OutputNoise& noise) {
  if (noise.white <= 0.0) return whiten_plain(m, at, noise);
  Filter filter{noise.rho, noise.white, 1.0 - noise.white};
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(m.cols());
  for (Eigen::Index k = 0; k < m.rows(); ++k) {
    if (k > 0) mean *= filter.step(at[static_cast<std::size_t>(k)] - at[static_cast<std::size_t>(k) - 1]);
    m.row(k) -= mean;
    mean += filter.gain() * m.row(k);
    m.row(k) /= noise.sigma * std::sqrt(filter.seen());
  }
}

OutputNoise likeliest(const std::vector<Eigen::VectorXd>& records, const OutputNoise& given, double low, double high, double worth) {
  OutputNoise best = given;
  double least = 1e300, plain = 1e300, sigma = 0.0;
  const auto look = [&](double rho, double white) {
    const double value = unlikelihood(records, rho, white, low, high, sigma);
    if (white <= 0.0) plain = std::min(plain, value);
    if (value < least) least = value, best.rho = rho, best.white = white, best.sigma = sigma;
  };
  for (int i = 0; i <= 8; ++i)
    for (const double rho : {0.0, 0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.94, 0.97}) look(rho, 0.1 * i);
  for (double step = 0.05; step > 0.005; step *= 0.5) {
    const double rho = best.rho, white = best.white;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        if (i != 0 || j != 0) look(std::clamp(rho + i * step * (1.0 - rho), 0.0, 0.97), std::clamp(white + j * step, 0.0, 0.9));
  }
  return plain - least > worth ? best : given;
}

}  // namespace filum::reconcile
