#include "physics/vessel_wall_pairs.h"

namespace filum {
namespace {

constexpr double kLeastCurvature = 1e-6;  // of a pair, as a share of its lengths: less is rounding

}  // namespace

WallPairs::WallPairs(int n, int most) {
  answers_.setZero(n, most);
  products_.setZero(most, most);
  least_.setZero(most);
  order_.reserve(static_cast<std::size_t>(most));
  each_.setZero(most);
  alpha_.setZero(most);
  gamma_.setZero(most);
  moved_.setZero(3, most);
  pulled_.setZero(3, most);
}

void WallPairs::note(const Eigen::MatrixXf& s, const Eigen::MatrixXf& answers, int p, Eigen::MatrixXd& products, Eigen::VectorXd& least) noexcept {
  const auto y = answers.col(p);
  for (int i = 0; i < s.cols(); ++i) products(i, p) = static_cast<double>(s.col(i).dot(y));  // the row says what is newer times what is older, which nobody asks
  least[p] = kLeastCurvature * static_cast<double>(s.col(p).norm()) * static_cast<double>(y.norm());
}

void WallPairs::note(const Eigen::MatrixXf& s, int p) noexcept { note(s, answers_, p, products_, least_); }

void WallPairs::take(const Eigen::MatrixXf& answers, const Eigen::MatrixXd& products, const Eigen::VectorXd& least) noexcept {
  answers_ = answers;
  products_ = products;
  least_ = least;
}

void WallPairs::stiffen(const Eigen::MatrixXf& s, const WallPlace& place, const Mat3& stiffness) noexcept {
  const auto each = [&](auto&& act) {
    for (int a = 0; a < 8; ++a)
      if (place.weight[a] != 0.0) act(3 * place.node[static_cast<std::size_t>(a)], static_cast<float>(place.weight[a]));
  };
  moved_.setZero();
  each([&](int row, float weight) { moved_ += weight * s.middleRows<3>(row); });
  const Eigen::Matrix3f k = stiffness.cast<float>();
  for (int p = 0; p < pulled_.cols(); ++p) pulled_.col(p) = k * moved_.col(p);
  each([&](int row, float weight) { answers_.middleRows<3>(row) += weight * pulled_; });
  for (int j = 0; j < pulled_.cols(); ++j)
    for (int i = 0; i < pulled_.cols(); ++i) products_(i, j) += static_cast<double>(moved_.col(i).dot(pulled_.col(j)));
}

void WallPairs::count(int n, int newest) noexcept {
  order_.clear();
  const int most = static_cast<int>(answers_.cols());
  for (int k = n; k-- > 0;) {
    const int p = (newest - k + most) % most;
    if (products_(p, p) > least_[p]) order_.push_back(p);
  }
}

void WallPairs::before(const Eigen::MatrixXf& s, Eigen::VectorXf& r) noexcept {
  if (order_.empty()) return;
  each_.noalias() = s.transpose() * r;
  for (std::size_t i = order_.size(); i-- > 0;) {  // R alpha = S^T r
    const int p = order_[i];
    double a = each_[p];
    for (std::size_t j = i + 1; j < order_.size(); ++j) a -= products_(p, order_[j]) * alpha_[order_[j]];
    alpha_[p] = a / products_(p, p);
  }
  each_.setZero();
  for (const int p : order_) each_[p] = static_cast<float>(alpha_[p]);
  r.noalias() -= answers_ * each_;
}

void WallPairs::after(const Eigen::MatrixXf& s, Eigen::VectorXf& z) noexcept {
  if (order_.empty()) return;
  each_.noalias() = answers_.transpose() * z;
  for (std::size_t i = 0; i < order_.size(); ++i) {  // R^T gamma = D alpha - Y^T z
    const int p = order_[i];
    double b = each_[p];
    for (std::size_t j = 0; j < i; ++j) b += products_(order_[j], p) * gamma_[order_[j]];
    gamma_[p] = alpha_[p] - b / products_(p, p);
  }
  each_.setZero();
  for (const int p : order_) each_[p] = static_cast<float>(gamma_[p]);
  z.noalias() += s * each_;
}

}  // namespace filum
