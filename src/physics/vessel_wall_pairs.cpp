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
  square_.setZero(most, most);
  alpha_.setZero(most);
  gamma_.setZero(most);
  moved_.setZero(3, most);
  pulled_.setZero(3, most);
}

void WallPairs::judge(const Eigen::MatrixXf& s, int p) noexcept {
  least_[p] = kLeastCurvature * static_cast<double>(s.col(p).norm()) * static_cast<double>(answers_.col(p).norm());
}

void WallPairs::note(const Eigen::MatrixXf& s, int p) noexcept {
  each_.noalias() = s.transpose() * answers_.col(p);
  products_.col(p) = each_.cast<double>();  // the row says what is newer times what is older, which nobody asks
  judge(s, p);
}

void WallPairs::note_all(const Eigen::MatrixXf& s, const Eigen::MatrixXf& answers) noexcept {
  answers_ = answers;
  square_.noalias() = s.transpose() * answers_;
  products_ = square_.cast<double>();
  for (int p = 0; p < answers_.cols(); ++p) judge(s, p);
}

void WallPairs::stiffen(const Eigen::MatrixXf& s, const std::array<int, 8>& node, const Eigen::Matrix<double, 8, 1>& weight, const Mat3& stiffness) noexcept {
  moved_.setZero();
  for (int a = 0; a < 8; ++a) moved_ += static_cast<float>(weight[a]) * s.middleRows<3>(3 * node[static_cast<std::size_t>(a)]);
  const Eigen::Matrix3f k = stiffness.cast<float>();
  for (int p = 0; p < pulled_.cols(); ++p) pulled_.col(p) = k * moved_.col(p);
  for (int a = 0; a < 8; ++a) answers_.middleRows<3>(3 * node[static_cast<std::size_t>(a)]) += static_cast<float>(weight[a]) * pulled_;
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
