#include "physics/linear_fem_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace filum {
namespace {

constexpr double kNothing = 1e-15;  // [N], forces below this are rest
constexpr int kLook = 8;            // iterations of conjugate gradients, of which after the second the true residual is looked at in any case

/// Of the square of the residual: what conjugate gradients in these numbers gain before they had better begin anew.
template <class T>
constexpr double kGain = sizeof(T) == 4 ? 1e-11 : 1e-26;

/// A block that can be divided by: not that of a node that has lost its elements.
bool regular(const Mat3& m) noexcept {
  const double size = m.trace();
  return size > 0.0 && m.determinant() > 1e-12 * size * size * size / 27.0;
}

template <class T>
std::array<T, 12> packed(const Mat3& m) noexcept {
  std::array<T, 12> a{};
  for (std::size_t k = 0; k < 9; ++k) a[k] = static_cast<T>(m.data()[k]);
  return a;
}

template <class V>
auto dot3(const V& a, const V& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec3 three(const double* v) noexcept { return {v[0], v[1], v[2]}; }
Eigen::Map<Vec3> into(double* v) noexcept { return Eigen::Map<Vec3>(v); }

/// Nodes by breadth first from `from`, those of few neighbours first; marks what it reaches in `seen`.
void reach(const BlockMatrix& K, int from, std::vector<char>& seen, std::vector<int>& list) {
  const auto begin = [&](int i) { return K.begins()[static_cast<std::size_t>(i)]; };
  std::size_t next = list.size();
  seen[static_cast<std::size_t>(from)] = 1;
  list.push_back(from);
  for (; next < list.size(); ++next) {
    const std::size_t first = list.size();
    for (int k = begin(list[next]); k < begin(list[next] + 1); ++k) {
      const int j = K.columns()[static_cast<std::size_t>(k)];
      if (seen[static_cast<std::size_t>(j)]) continue;
      seen[static_cast<std::size_t>(j)] = 1;
      list.push_back(j);
    }
    std::stable_sort(list.begin() + static_cast<std::ptrdiff_t>(first), list.end(), [&](int a, int b) { return begin(a + 1) - begin(a) < begin(b + 1) - begin(b); });
  }
}

}  // namespace

template <class T>
void FemSystem<T>::order(const std::vector<char>& held) {
  const auto n = static_cast<std::size_t>(K_.n());
  std::vector<char> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = held[i] || !regular(scale_ * K_.diagonal(static_cast<int>(i)) + mass_[static_cast<Eigen::Index>(i)] * Mat3::Identity());
  std::vector<char> seen = out;
  std::vector<int> list, trial;
  for (int i = 0; i < K_.n(); ++i) {
    if (seen[static_cast<std::size_t>(i)]) continue;
    std::vector<char> again = seen;
    trial.clear();
    reach(K_, i, again, trial);
    reach(K_, trial.back(), seen, list);  // from one end of this part
  }
  if (!deal(list, kGroup)) deal(list, 1);
}

/// Deals the list out to groups from so many stretches of it. False if two rows of a group would meet.
template <class T>
bool FemSystem<T>::deal(const std::vector<int>& list, int streams) {
  const std::size_t stretch = (list.size() + static_cast<std::size_t>(streams) - 1) / static_cast<std::size_t>(streams);
  node_of_.assign(stretch * kGroup, -1);
  position_of_.assign(static_cast<std::size_t>(K_.n()), -1);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::size_t p = kGroup * (k % stretch) + k / stretch;
    node_of_[p] = list[k];
    position_of_[static_cast<std::size_t>(list[k])] = static_cast<int>(p);
  }
  for (const int i : list)
    for (int k = K_.begins()[static_cast<std::size_t>(i)]; k < K_.begins()[static_cast<std::size_t>(i) + 1]; ++k) {
      const int j = K_.columns()[static_cast<std::size_t>(k)], p = position_of_[static_cast<std::size_t>(i)], q = position_of_[static_cast<std::size_t>(j)];
      if (j != i && q >= 0 && p / kGroup == q / kGroup) return false;
    }
  return true;
}

template <class T>
void FemSystem<T>::fill() {
  root_.assign(node_of_.size(), Mat3::Identity());
  root_inverse_ = root_;
  for (std::size_t p = 0; p < node_of_.size(); ++p) {
    if (node_of_[p] < 0) continue;
    root_[p] = (scale_ * K_.diagonal(node_of_[p]) + mass_[node_of_[p]] * Mat3::Identity()).llt().matrixL();
    root_inverse_[p] = root_[p].inverse();
  }
  const auto group = [&](TriangleRows<T>& to, int g, bool low) {
    std::array<typename TriangleRows<T>::Row, kGroup> rows;
    for (int l = 0; l < kGroup; ++l) {
      const int p = kGroup * g + l, i = node_of_[static_cast<std::size_t>(p)];
      for (int k = i < 0 ? 0 : K_.begins()[static_cast<std::size_t>(i)]; k < (i < 0 ? 0 : K_.begins()[static_cast<std::size_t>(i) + 1]); ++k) {
        const int q = position_of_[static_cast<std::size_t>(K_.columns()[static_cast<std::size_t>(k)])];
        if (q < 0 || q == p || (q < p) != low) continue;
        rows[static_cast<std::size_t>(l)].emplace_back(
            q, scale_ * root_inverse_[static_cast<std::size_t>(p)] * K_.at(static_cast<std::size_t>(k)) * root_inverse_[static_cast<std::size_t>(q)].transpose());
      }
    }
    to.add(rows);
  };
  low_.clear();
  high_.clear();
  for (int g = 0; g < groups(); ++g) group(low_, g, true);
  for (int g = groups() - 1; g >= 0; --g) group(high_, g, false);
  low_.finish();
  high_.finish();
}

template <class T>
void FemSystem<T>::set(double scale, const Eigen::VectorXd& mass, const std::vector<char>& held) {
  scale_ = scale;
  mass_ = mass;
  order(held);
  fill();
  for (auto* v : {&b_, &u_}) v->assign(4 * node_of_.size(), 0.0);
  for (auto* v : {&r_, &p_, &q_, &t_, &x_}) v->assign(4 * node_of_.size(), T(0));
  special_.assign(node_of_.size(), -1);
  moved_.clear();
  moved_.reserve(node_of_.size());
}

/// b - A g, without movers.
template <class T>
template <class Number>
void FemSystem<T>::gather(const Columns4& f, const Columns4* w, const Columns4& guess, std::vector<Number>& y) noexcept {
  for (std::size_t p = 0; p < node_of_.size(); ++p) {
    const int i = node_of_[p];
    if (i < 0) continue;
    Vec3 x = -scale_ * guess.col(i).template head<3>();
    if (w != nullptr) x += w->col(i).template head<3>();
    const Vec3 to = root_[p].transpose() * x;
    for (int c = 0; c < 3; ++c) y[4 * p + static_cast<std::size_t>(c)] = static_cast<Number>(to[c]);
    into(&b_[4 * p]) = root_inverse_[p] * (f.col(i).template head<3>() - mass_[i] * (guess.col(i).template head<3>() + x / scale_));
  }
  Vec3 rows[kGroup];
  for (std::size_t p = 0; p < node_of_.size(); ++p) {
    if (p % kGroup == 0) product(static_cast<int>(p) / kGroup, y.data(), rows);
    if (node_of_[p] >= 0) into(&b_[4 * p]) += rows[p % kGroup] / scale_;
  }
}

/// Takes in the movers, whose targets are counted from the guess; true if any node is prescribed.
template <class T>
bool FemSystem<T>::place(std::span<const MovedNode> moved, const Columns4& guess) noexcept {
  moved_.clear();
  bool prescribed = false;
  for (const MovedNode& m : moved) {
    const int at = position_of_[static_cast<std::size_t>(m.node)];
    if (at < 0) continue;
    const auto p = static_cast<std::size_t>(at);
    if (special_[p] < 0) {
      special_[p] = static_cast<int>(moved_.size());
      moved_.emplace_back();
      moved_.back().position = at;
    }
    Moved& s = moved_[static_cast<std::size_t>(special_[p])];
    const Vec3 way = m.target - guess.col(m.node).template head<3>();
    if (m.prescribed) {
      s.prescribed = prescribed = true;
      into(&u_[4 * p]) = root_[p].transpose() * way;
    } else {
      const Mat3 scaled = root_inverse_[p] * m.stiffness * root_inverse_[p].transpose();
      s.spring += scaled;
      s.block += scaled;
      const Vec3 pull = root_inverse_[p] * (m.stiffness * way);
      s.pull += pull;
      into(&b_[4 * p]) += pull;
    }
    s.diagonal = packed<T>(s.block);
    s.inverse = packed<T>(s.prescribed ? Mat3(Mat3::Zero()) : Mat3(s.block.inverse()));
  }
  return prescribed;
}

template <class T>
void FemSystem<T>::lift() noexcept {
  for (const Moved& m : moved_) special_[static_cast<std::size_t>(m.position)] = -1;
}

template <class T>
template <class Number>
void FemSystem<T>::product(int g, const Number* x, Vec3* rows) const noexcept {
  Four<Number> low[kGroup], high[kGroup];
  low_.times(g, x, low);
  high_.times(groups() - 1 - g, x, high);
  for (int l = 0; l < kGroup; ++l) {
    const Four<Number> sum = low[l] + high[l] + load_four(x + 4 * static_cast<std::ptrdiff_t>(kGroup * g + l));
    rows[l] = {static_cast<double>(sum[0]), static_cast<double>(sum[1]), static_cast<double>(sum[2])};
  }
}

/// |f| and the forces that the movers would give at the first guess.
template <class T>
double FemSystem<T>::scale_of(const Columns4& f) const noexcept {
  double sum = 0.0;
  for (std::size_t p = 0; p < node_of_.size(); ++p)
    if (node_of_[p] >= 0) sum += f.col(node_of_[p]).squaredNorm();
  Vec3 rows[kGroup];
  for (const Moved& m : moved_) {
    const auto p = static_cast<std::size_t>(m.position);
    Vec3 force = three(&b_[4 * p]) - m.pull;
    if (m.prescribed) {
      product(m.position / kGroup, u_.data(), rows);
      force -= rows[p % kGroup];
    } else {  // what the mover gives once this node alone has followed it
      force += m.pull - m.spring * (m.block.inverse() * m.pull);
    }
    sum += (root_[p] * force).squaredNorm();
  }
  return std::sqrt(sum);
}

/// Residual into r_, scaled; the norm of the true one over the nodes that are not prescribed. `moves`: the change is not zero.
template <class T>
double FemSystem<T>::residual(bool moves, double& largest) noexcept {
  double sum = 0.0;
  largest = 0.0;
  Vec3 rows[kGroup] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (std::size_t p = 0; p < node_of_.size(); ++p) {
    if (moves && p % kGroup == 0) product(static_cast<int>(p) / kGroup, u_.data(), rows);
    Vec3 r = three(&b_[4 * p]) - rows[p % kGroup];
    if (const int s = special_[p]; s >= 0) {
      const Moved& m = moved_[static_cast<std::size_t>(s)];
      if (m.prescribed) r.setZero();
      else r -= m.spring * three(&u_[4 * p]);
    }
    for (int c = 0; c < 3; ++c) r_[4 * p + static_cast<std::size_t>(c)] = static_cast<T>(r[c]);
    const double size = (root_[p] * r).squaredNorm();
    sum += size;
    largest = std::max(largest, size);
  }
  largest = std::sqrt(largest);
  return std::sqrt(sum);
}

/// One sweep; returns the norm of the forces that were unbalanced when each node's turn came.
template <class T>
double FemSystem<T>::sweep(double w, bool back) noexcept {
  double sum = 0.0;
  Vec3 rows[kGroup];
  for (int k = 0; k < groups(); ++k) {
    const int g = back ? groups() - 1 - k : k;
    product(g, u_.data(), rows);
    for (int l = 0; l < kGroup; ++l) {
      const auto p = static_cast<std::size_t>(kGroup * g + l);
      Vec3 r = three(&b_[4 * p]) - rows[l], step = r;
      if (const int s = special_[p]; s >= 0) {
        const Moved& m = moved_[static_cast<std::size_t>(s)];
        if (m.prescribed) continue;
        r -= m.spring * three(&u_[4 * p]);
        step = m.block.inverse() * r;
      }
      sum += (root_[p] * r).squaredNorm();
      into(&u_[4 * p]) += w * step;
    }
  }
  return std::sqrt(sum);
}

template <class T>
int FemSystem<T>::gauss_seidel(const FemSolverOptions& o, double enough, double& left, double& largest) noexcept {
  int k = 0;
  while (k < o.max_iterations && left > enough) {
    ++k;
    const double seen = sweep(o.relaxation, o.symmetric && k % 2 == 0);
    if (!(seen > 2.0 * enough) || k == o.max_iterations) left = residual(true, largest);
  }
  return k;
}

template <class T>
void FemSystem<T>::over_diagonal(std::size_t p, Four<T>& v) const noexcept {
  if (const int s = special_[p]; s >= 0) v = times_three<T>(moved_[static_cast<std::size_t>(s)].inverse.data(), v);
}

template <class T>
void FemSystem<T>::times_diagonal(std::size_t p, Four<T>& v) const noexcept {
  if (const int s = special_[p]; s >= 0) v = times_three<T>(moved_[static_cast<std::size_t>(s)].diagonal.data(), v);
}

template <class T>
void FemSystem<T>::forward() noexcept {
  Four<T> rows[kGroup];
  for (int g = 0; g < groups(); ++g) {
    low_.times(g, r_.data(), rows);
    for (int l = 0; l < kGroup; ++l) {
      const auto p = static_cast<std::size_t>(kGroup * g + l);
      Four<T> y = load_four(&r_[4 * p]) - rows[l];
      over_diagonal(p, y);
      store_three<T>(y, &r_[4 * p]);
    }
  }
}

template <class T>
void FemSystem<T>::backward(const T* from, T* to) const noexcept {
  Four<T> rows[kGroup];
  for (int g = groups() - 1; g >= 0; --g) {
    high_.times(groups() - 1 - g, to, rows);
    for (int l = 0; l < kGroup; ++l) {
      const auto p = static_cast<std::size_t>(kGroup * g + l);
      Four<T> y = load_four(from + 4 * p) - rows[l];
      over_diagonal(p, y);
      store_three<T>(y, to + 4 * p);
    }
  }
}

template <class T>
double FemSystem<T>::apply() noexcept {
  backward(p_.data(), t_.data());
  double sum = 0.0;
  Four<T> rows[kGroup];
  for (int g = 0; g < groups(); ++g) {  // q_ is (D+L)^-1 (p - D t); t is added where it is used
    low_.times(g, q_.data(), rows);
    for (int l = 0; l < kGroup; ++l) {
      const auto p = static_cast<std::size_t>(kGroup * g + l);
      const Four<T> v = load_four(&p_[4 * p]), t = load_four(&t_[4 * p]);
      Four<T> y = t;
      times_diagonal(p, y);
      y = v - y - rows[l];
      over_diagonal(p, y);
      store_three<T>(y, &q_[4 * p]);
      sum += static_cast<double>(dot3(v, Four<T>(y + t)));
    }
  }
  return sum;
}

template <class T>
double FemSystem<T>::begin_direction() noexcept {
  double rho = 0.0;
  for (std::size_t p = 0; p < node_of_.size(); ++p) {
    const Four<T> r = load_four(&r_[4 * p]);
    Four<T> z = r;
    times_diagonal(p, z);
    store_three<T>(z, &p_[4 * p]);
    rho += static_cast<double>(dot3(r, z));
  }
  return rho;
}

template <class T>
double FemSystem<T>::advance(double alpha) noexcept {
  const T a = static_cast<T>(alpha);
  double rho = 0.0;
  for (std::size_t p = 0; p < node_of_.size(); ++p) {
    store_three<T>(load_four(&x_[4 * p]) + a * load_four(&p_[4 * p]), &x_[4 * p]);
    const Four<T> r = load_four(&r_[4 * p]) - a * (load_four(&q_[4 * p]) + load_four(&t_[4 * p]));
    store_three<T>(r, &r_[4 * p]);
    Four<T> z = r;
    times_diagonal(p, z);
    rho += static_cast<double>(dot3(r, z));
  }
  return rho;
}

template <class T>
void FemSystem<T>::turn(double beta) noexcept {
  const T b = static_cast<T>(beta);
  for (std::size_t p = 0; p < node_of_.size(); ++p) {
    Four<T> z = load_four(&r_[4 * p]);
    times_diagonal(p, z);
    store_three<T>(z + b * load_four(&p_[4 * p]), &p_[4 * p]);
  }
}

template <class T>
double FemSystem<T>::norm_of_lower() const noexcept {
  double sum = 0.0;
  Four<T> rows[kGroup];
  for (std::size_t p = 0; p < node_of_.size(); ++p) {
    if (p % kGroup == 0) low_.times(static_cast<int>(p) / kGroup, r_.data(), rows);
    const int s = special_[p];
    if (s >= 0 && moved_[static_cast<std::size_t>(s)].prescribed) continue;
    Four<T> r = load_four(&r_[4 * p]);
    times_diagonal(p, r);
    r += rows[p % kGroup];
    sum += (root_[p] * Vec3(r[0], r[1], r[2])).squaredNorm();
  }
  return std::sqrt(sum);
}

template <class T>
int FemSystem<T>::conjugate_gradients(const FemSolverOptions& o, double enough, double& left, double& largest) noexcept {
  int k = 0;
  while (k < o.max_iterations && left > enough) {  // again if the true residual says so
    forward();
    double rho = begin_direction();
    if (!(rho > 0.0)) break;
    const double start = left, first = rho;
    double per_rho = std::numeric_limits<double>::infinity();  // true residual over its norm in M^-1: about constant, once stiff movers have had their way
    std::fill(x_.begin(), x_.end(), T(0));
    while (k < o.max_iterations) {
      ++k;
      const double next = advance(rho / apply());
      if (!std::isfinite(next) || !(next > 0.0)) break;
      if (k % kLook == 2 || per_rho * std::sqrt(next) < 1.1 * enough) {
        const double true_norm = norm_of_lower();
        if (true_norm < enough) break;
        per_rho = true_norm / std::sqrt(next);
      }
      if (next < kGain<T> * first) break;
      turn(next / rho);
      rho = next;
    }
    backward(x_.data(), t_.data());
    for (std::size_t c = 0; c < u_.size(); ++c) u_[c] += static_cast<double>(t_[c]);
    left = residual(true, largest);
    if (!(left < 0.5 * start)) break;  // as far as the numbers reach
  }
  return k;
}

template <class T>
void FemSystem<T>::forces(const Columns4& f, const Columns4* w, const Columns4& u, std::span<MovedNode> moved) const noexcept {
  Vec3 rows[kGroup];
  for (MovedNode& m : moved) {
    const int at = position_of_[static_cast<std::size_t>(m.node)];
    if (at < 0) {
      m.force = scale_ * K_.row_times(m.node, u) + mass_[m.node] * u.col(m.node).template head<3>() - f.col(m.node).template head<3>();
      if (w != nullptr) m.force -= K_.row_times(m.node, *w);
    } else if (m.prescribed) {
      const auto p = static_cast<std::size_t>(at);
      product(at / kGroup, u_.data(), rows);
      m.force = root_[p] * (rows[p % kGroup] - three(&b_[4 * p]));
    } else {
      m.force = m.stiffness * (m.target - u.col(m.node).template head<3>());
    }
  }
}

template <class T>
FemSummary FemSystem<T>::solve(const Columns4& f, const Columns4* w, Columns4& u, std::span<MovedNode> moved, const FemSolverOptions& o) noexcept {
  constexpr double kFloat = 1e-5;  // relative residuals from here up are told by float
  FemSummary s;
  if (o.relative >= kFloat) gather(f, w, u, t_);
  else gather(f, w, u, u_);
  std::fill(u_.begin(), u_.end(), 0.0);
  const bool prescribed = place(moved, u);
  const double scale = scale_of(f);
  double left = residual(prescribed, s.residual);
  const double enough = std::max(o.relative * scale, o.absolute);
  s.first = scale > kNothing ? left / scale : 0.0;
  if (scale > kNothing)
    s.iterations = o.method == FemSolverOptions::Method::gauss_seidel ? gauss_seidel(o, enough, left, s.residual) : conjugate_gradients(o, enough, left, s.residual);
  for (int i = 0; i < K_.n(); ++i) {
    const int at = position_of_[static_cast<std::size_t>(i)];
    if (at < 0) u.col(i).setZero();
    else u.col(i).template head<3>() += root_inverse_[static_cast<std::size_t>(at)].transpose() * three(&u_[4 * static_cast<std::size_t>(at)]);
  }
  for (const MovedNode& m : moved)
    if (m.prescribed && position_of_[static_cast<std::size_t>(m.node)] >= 0) u.col(m.node).template head<3>() = m.target;
  forces(f, w, u, moved);
  lift();
  s.relative = scale > kNothing ? left / scale : 0.0;
  s.converged = !(scale > kNothing) || left <= 1.01 * enough;
  s.sound = std::isfinite(left) && u.allFinite();
  return s;
}

template class FemSystem<double>;
template class FemSystem<float>;

}  // namespace filum
