#include "physics/linear_fem_solver.h"

#include <cmath>

namespace filum {
namespace {

constexpr double kNothing = 1e-15;  // [N], forces below this are rest

/// Inverse of a block; zero where there is nothing to invert (a node that has lost its elements).
Mat3 inverse_or_zero(const Mat3& m) noexcept {
  const double size = m.trace();
  if (!(size > 0.0) || !(m.determinant() > 1e-12 * size * size * size / 27.0)) return Mat3::Zero();
  return m.inverse();
}

}  // namespace

template <class T>
FemSystem<T>::FemSystem(const BlockMatrix<T>& K) : K_(K), mass_(Eigen::VectorXd::Zero(K.n())), held_(static_cast<std::size_t>(K.n()), 0) {
  for (Columns4* v : {&r_, &p_, &w_, &t_, &x_}) *v = Columns4::Zero(4, K.n());
  const auto n = static_cast<std::size_t>(K.n());
  diagonal_.resize(n);
  inverse_.resize(n);
  support_of_.assign(n, -1);
  for (auto* v : {&saved_diagonal_, &saved_inverse_, &support_stiffness_}) v->reserve(n);
  support_.reserve(n);
}

template <class T>
void FemSystem<T>::set(double scale, const Eigen::VectorXd& mass, const std::vector<char>& held) {
  scale_ = scale;
  mass_ = mass;
  held_ = held;
  for (int i = 0; i < K_.n(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    diagonal_[k] = scale_ * K_.diagonal(i) + mass_[i] * Mat3::Identity();
    inverse_[k] = held_[k] ? Mat3::Zero() : inverse_or_zero(diagonal_[k]);
  }
}

template <class T>
void FemSystem<T>::place(std::span<const MovedNode> moved, Columns4& u) noexcept {
  saved_diagonal_.clear();
  saved_inverse_.clear();
  support_.clear();
  support_stiffness_.clear();
  for (const MovedNode& m : moved) {
    const auto i = static_cast<std::size_t>(m.node);
    saved_diagonal_.push_back(diagonal_[i]);
    saved_inverse_.push_back(inverse_[i]);
    support_of_[i] = static_cast<int>(support_.size());
    support_.push_back(m.prescribed ? Vec3::Zero() : Vec3(m.stiffness * m.target));
    support_stiffness_.push_back(m.prescribed ? Mat3::Zero() : m.stiffness);
    if (held_[i]) continue;
    if (m.prescribed) {
      inverse_[i].setZero();
      u.col(m.node).template head<3>() = m.target;
    } else {
      diagonal_[i] += m.stiffness;
      inverse_[i] = inverse_or_zero(diagonal_[i]);
    }
  }
}

template <class T>
void FemSystem<T>::lift(std::span<const MovedNode> moved) noexcept {
  for (std::size_t k = moved.size(); k-- > 0;) {  // backwards: a node named twice gets its own values again
    const auto i = static_cast<std::size_t>(moved[k].node);
    diagonal_[i] = saved_diagonal_[k];
    inverse_[i] = saved_inverse_[k];
    support_of_[i] = -1;
  }
}

/// Force that is missing for balance at a node, without regard to what holds it.
template <class T>
Vec3 FemSystem<T>::unbalanced(int i, const Columns4& b, const Columns4& u) const noexcept {
  return b.col(i).template head<3>() - scale_ * K_.row_times(i, u) - mass_[i] * u.col(i).template head<3>();
}

template <class T>
double FemSystem<T>::scale_of(const Columns4& b, const Columns4& u, std::span<const MovedNode> moved) const noexcept {
  double sum = b.squaredNorm();
  for (const MovedNode& m : moved) {
    Vec3 force = unbalanced(m.node, b, u);
    if (!m.prescribed) {  // what the mover gives once this node alone has followed it
      const Vec3 wanted = m.target - u.col(m.node).template head<3>();
      force += m.stiffness * (wanted - inverse_[static_cast<std::size_t>(m.node)] * (m.stiffness * wanted));
    }
    sum += force.squaredNorm();
  }
  return std::sqrt(sum);
}

/// Residual into r_; its norm over free nodes.
template <class T>
double FemSystem<T>::residual(const Columns4& b, const Columns4& u, double& largest) noexcept {
  double sum = 0.0;
  largest = 0.0;
  for (int i = 0; i < K_.n(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    Vec3 r = Vec3::Zero();
    if (inverse_[k](0, 0) != 0.0) {
      r = unbalanced(i, b, u);
      if (const int s = support_of_[k]; s >= 0)
        r += support_[static_cast<std::size_t>(s)] - support_stiffness_[static_cast<std::size_t>(s)] * u.col(i).template head<3>();
    }
    r_.col(i).template head<3>() = r;
    sum += r.squaredNorm();
    largest = std::max(largest, r.squaredNorm());
  }
  largest = std::sqrt(largest);
  return std::sqrt(sum);
}

/// One sweep; returns the norm of the forces that were unbalanced when each node's turn came.
template <class T>
double FemSystem<T>::sweep(const Columns4& b, Columns4& u, double w, bool back) noexcept {
  double sum = 0.0;
  for (int n = K_.n(), s = 0; s < n; ++s) {
    const int i = back ? n - 1 - s : s;
    const auto k = static_cast<std::size_t>(i);
    if (inverse_[k](0, 0) == 0.0) continue;
    Vec3 r = unbalanced(i, b, u);
    if (const int h = support_of_[k]; h >= 0)
      r += support_[static_cast<std::size_t>(h)] - support_stiffness_[static_cast<std::size_t>(h)] * u.col(i).template head<3>();
    sum += r.squaredNorm();
    u.col(i).template head<3>() += w * (inverse_[k] * r);
  }
  return std::sqrt(sum);
}

template <class T>
int FemSystem<T>::gauss_seidel(const Columns4& b, Columns4& u, const FemSolverOptions& o, double scale) noexcept {
  double largest = 0.0;
  for (int k = 1; k <= o.max_iterations; ++k) {
    const double seen = sweep(b, u, o.relaxation, o.symmetric && k % 2 == 0);
    if (!(seen > 2.0 * o.relative * scale) && !(residual(b, u, largest) > o.relative * scale)) return k;
  }
  return o.max_iterations;
}

template <class T>
void FemSystem<T>::forward(const Columns4& r, Columns4& y) const noexcept {
  for (int i = 0; i < K_.n(); ++i)
    y.col(i).template head<3>() = inverse_[static_cast<std::size_t>(i)] * (r.col(i).template head<3>() - scale_ * K_.row_times_low(i, y));
}

template <class T>
void FemSystem<T>::backward(const Columns4& r, Columns4& y) const noexcept {
  for (int i = K_.n() - 1; i >= 0; --i)
    y.col(i).template head<3>() = inverse_[static_cast<std::size_t>(i)] * (r.col(i).template head<3>() - scale_ * K_.row_times_high(i, y));
}

template <class T>
void FemSystem<T>::apply(const Columns4& v, Columns4& w) noexcept {
  backward(v, t_);
  for (int i = 0; i < K_.n(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vec3 t = t_.col(i).template head<3>();
    const Vec3 right = v.col(i).template head<3>() - diagonal_[k] * t - scale_ * K_.row_times_low(i, w_);
    w_.col(i).template head<3>() = inverse_[k] * right;
  }
  w = w_ + t_;
}

template <class T>
double FemSystem<T>::norm_of_lower(const Columns4& r) const noexcept {
  double sum = 0.0;
  for (int i = 0; i < K_.n(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (inverse_[k](0, 0) == 0.0) continue;
    sum += (diagonal_[k] * r.col(i).template head<3>() + scale_ * K_.row_times_low(i, r)).squaredNorm();
  }
  return std::sqrt(sum);
}

template <class T>
int FemSystem<T>::conjugate_gradients(const Columns4& b, Columns4& u, const FemSolverOptions& o, double scale) noexcept {
  double largest = 0.0;
  const double start = residual(b, u, largest);
  if (!(start > o.relative * scale)) return 0;
  x_ = r_;
  forward(x_, r_);  // r_ is now (D+L)^-1 (b - A u)
  x_.setZero();
  const auto times_diagonal = [&](const Columns4& v, int i) -> Vec3 { return diagonal_[static_cast<std::size_t>(i)] * v.col(i).template head<3>(); };
  double rho = 0.0;
  for (int i = 0; i < K_.n(); ++i) {
    const Vec3 z = times_diagonal(r_, i);
    rho += r_.col(i).template head<3>().dot(z);
    p_.col(i).template head<3>() = z;
  }
  const double per_rho = start / std::sqrt(rho);  // true residual over its norm in M^-1: about constant
  int k = 0;
  Columns4& q = w_;
  while (k < o.max_iterations && rho > 0.0) {
    ++k;
    apply(p_, q);
    const double alpha = rho / p_.cwiseProduct(q).sum();
    x_ += alpha * p_;
    r_ -= alpha * q;
    double next = 0.0;
    for (int i = 0; i < K_.n(); ++i) next += r_.col(i).template head<3>().dot(times_diagonal(r_, i));
    if (!std::isfinite(next)) break;
    if (per_rho * std::sqrt(next) < 2.0 * o.relative * scale && norm_of_lower(r_) < o.relative * scale) break;
    const double beta = next / rho;
    for (int i = 0; i < K_.n(); ++i) p_.col(i).template head<3>() = times_diagonal(r_, i) + beta * p_.col(i).template head<3>();
    rho = next;
  }
  backward(x_, t_);
  u += t_;
  return k;
}

template <class T>
FemSummary FemSystem<T>::solve(const Columns4& b, Columns4& u, std::span<MovedNode> moved, const FemSolverOptions& o) noexcept {
  FemSummary s;
  place(moved, u);
  for (int i = 0; i < K_.n(); ++i)
    if (held_[static_cast<std::size_t>(i)]) u.col(i).setZero();
  const double scale = scale_of(b, u, moved);
  if (scale > kNothing)
    s.iterations = o.method == FemSolverOptions::Method::gauss_seidel ? gauss_seidel(b, u, o, scale) : conjugate_gradients(b, u, o, scale);
  const double left = residual(b, u, s.residual);
  for (MovedNode& m : moved)
    m.force = m.prescribed || held_[static_cast<std::size_t>(m.node)] ? Vec3(-unbalanced(m.node, b, u))
                                                                      : Vec3(m.stiffness * (m.target - u.col(m.node).template head<3>()));
  lift(moved);
  s.relative = scale > kNothing ? left / scale : 0.0;
  s.converged = s.relative <= 1.01 * o.relative;
  s.sound = std::isfinite(left) && u.allFinite();
  return s;
}

template class FemSystem<double>;
template class FemSystem<float>;

}  // namespace filum
