#include "reference.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

namespace {

constexpr double kRelative = 1e-10;
using Right = std::function<void(double, const double*, double*)>;

int call(realtype t, N_Vector y, N_Vector dy, void* f) {
  (*static_cast<Right*>(f))(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
  return 0;
}

/// Backward differences with a banded Jacobian (difference quotients); halves its step through every stop.
class Integrator {
 public:
  Integrator(std::vector<double> start, double t0, int band, double scale, Right right) : right_(std::move(right)) {
    SUNContext_Create(nullptr, &context_);
    const auto n = static_cast<sunindextype>(start.size());
    y_ = N_VNew_Serial(n, context_);
    std::copy(start.begin(), start.end(), N_VGetArrayPointer(y_));
    matrix_ = SUNBandMatrix(n, std::min<sunindextype>(band, n - 1), std::min<sunindextype>(band, n - 1), context_);
    solver_ = SUNLinSol_Band(y_, matrix_, context_);
    memory_ = CVodeCreate(CV_BDF, context_);
    CVodeInit(memory_, call, t0, y_);
    CVodeSStolerances(memory_, kRelative, kRelative * scale);
    CVodeSetUserData(memory_, &right_);
    CVodeSetLinearSolver(memory_, solver_, matrix_);
    CVodeSetMaxNumSteps(memory_, 1000000);
  }
  ~Integrator() {
    CVodeFree(&memory_);
    SUNLinSolFree(solver_);
    SUNMatDestroy(matrix_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// To time t, stepping up to `stop` at most; `corner`: the right-hand side has a kink at t, so the history starts anew.
  int to(double t, double stop, bool corner) {
    realtype at = 0.0;
    CVodeSetStopTime(memory_, stop);
    const int status = CVode(memory_, t, y_, &at, CV_NORMAL);
    if (status < 0) return status;
    return corner ? CVodeReInit(memory_, t, y_) : 0;
  }
  double* state() { return N_VGetArrayPointer(y_); }

 private:
  Right right_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
};

double largest(int n, const double* v) {
  double most = 1e-300;
  for (int i = 0; i < n; ++i) most = std::max(most, std::abs(v[i]));
  return most;
}

/// Slope of a sampled input and whether it turns a corner at the end of the interval.
struct Input {
  int n;
  const double *t, *u;
  mutable int at = 0;
  double value(double s) const {
    while (at > 0 && s < t[at]) --at;
    while (at + 2 < n && s > t[at + 1]) ++at;
    return u[at] + slope(at) * (s - t[at]);
  }
  double slope(int k) const { return (u[k + 1] - u[k]) / (t[k + 1] - t[k]); }
  bool corner(int k) const { return k + 2 < n && std::abs(slope(k + 1) - slope(k)) > 0.05 * std::max(std::abs(slope(k)), std::abs(slope(k + 1))); }
  int next_corner(int k) const {
    while (k + 2 < n && !corner(k)) ++k;
    return k + 1;
  }
};

}  // namespace

int filum_reference_lag(int n, const double* t, const double* u, double tau, int poles, int from_rest, double* out) {
  const Input in{n, t, u, 0};
  const double rate = poles / tau;
  int k = 0;
  Integrator integrator(std::vector<double>(static_cast<std::size_t>(poles), from_rest ? 0.0 : u[0]), t[0], 1, largest(n, u), [&](double s, const double* x, double* dx) {
    double before = u[k] + in.slope(k) * (s - t[k]);
    for (int i = 0; i < poles; ++i) dx[i] = rate * (before - x[i]), before = x[i];
  });
  out[0] = integrator.state()[poles - 1];
  for (; k + 1 < n; ++k) {
    if (const int status = integrator.to(t[k + 1], t[k + 1], in.corner(k)); status < 0) return status;
    out[k + 1] = integrator.state()[poles - 1];
  }
  return 0;
}

int filum_reference_bouc_wen(int n, const double* x, double width, double* out) {
  double z = 0.0, way = 0.0, before = 0.0;
  std::unique_ptr<Integrator> integrator;
  out[0] = x[0];
  for (int k = 0; k + 1 < n; ++k) {
    const double dx = x[k + 1] - x[k];
    if (std::abs(dx) > 1e-9 * width) {  // over the length of the way, so that the rate has no part in it
      const double sign = dx > 0 ? 1.0 : -1.0;
      if (sign != before)
        integrator = std::make_unique<Integrator>(std::vector<double>{z}, way, 0, width, [width, sign](double, const double* y, double* dy) {
          dy[0] = sign * (1.0 - std::pow(2.0 * y[0] / width, 2) * (y[0] * sign > 0.0 ? 1.0 : y[0] * sign < 0.0 ? 0.0 : 0.5));
        });
      before = sign;
      way += std::abs(dx);
      if (const int status = integrator->to(way, way, false); status < 0) return status;
      z = integrator->state()[0];
    }
    out[k + 1] = x[k + 1] - z;
  }
  return 0;
}

int filum_reference_consolidation(int n, const double* t, const double* f, double share, double D, double size, int radial, double* out) {
  constexpr int kCells = 60;
  const double h = (radial ? size : 0.5 * size) / kCells;
  const Input in{n, t, f, 0};
  std::vector<double> area(kCells + 1), volume(kCells);
  for (int i = 0; i <= kCells; ++i) area[static_cast<std::size_t>(i)] = radial ? i * h : 1.0;
  double all = 0.0;
  for (int i = 0; i < kCells; ++i) all += volume[static_cast<std::size_t>(i)] = radial ? (i + 0.5) * h * h : h;
  // for q = p - share f the load enters undifferentiated: q' = D lap (q + share f)
  Integrator integrator(std::vector<double>(kCells, -share * f[0]), t[0], 1, largest(n, f), [&](double s, const double* q, double* dq) {
    const double load = share * in.value(s);
    double flux = 0.0;  // through the inner face: none
    for (int i = 0; i < kCells; ++i) {
      const double outer = area[static_cast<std::size_t>(i) + 1] * D / h * (i + 1 < kCells ? q[i] - q[i + 1] : 2.0 * (q[i] + load));
      dq[i] = (flux - outer) / volume[static_cast<std::size_t>(i)];
      flux = outer;
    }
  });
  out[0] = f[0] * (1.0 - share);
  for (int k = 0; k + 1 < n; ++k) {
    if (const int status = integrator.to(t[k + 1], t[in.next_corner(k)], in.corner(k)); status < 0) return status;
    double mean = share * f[k + 1];
    for (int i = 0; i < kCells; ++i) mean += integrator.state()[i] * volume[static_cast<std::size_t>(i)] / all;
    out[k + 1] = (1.0 - share) * f[k + 1] + mean;
  }
  return 0;
}

int filum_reference_elastica(double L, double B, double w, double curvature, double taper, double* drop, double* reach) {
  // in arc lengths of L: theta'' = -G (1 - s) cos theta + d/ds of the rest curvature, G = w L^3/B
  const double G = w * L * L * L / B, fall = curvature * L * taper;
  const auto shoot = [&](double clamp, double* end) {
    Integrator integrator({0.0, clamp, 0.0, 0.0}, 0.0, 3, 1.0, [G, fall](double s, const double* y, double* dy) {
      dy[0] = y[1], dy[1] = -G * (1.0 - s) * std::cos(y[0]) - fall, dy[2] = std::cos(y[0]), dy[3] = std::sin(y[0]);
    });
    const int status = integrator.to(1.0, 1.0, false);
    std::copy(integrator.state(), integrator.state() + 4, end);
    return status;
  };
  const double wanted = curvature * L - fall;
  double a = wanted + 0.5 * G / (1.0 + std::pow(G / 8.0, 0.7)), b = 1.05 * a + 1e-3, ea[4], eb[4];
  if (const int status = shoot(a, ea); status < 0) return status;
  if (const int status = shoot(b, eb); status < 0) return status;
  for (int i = 0; i < 40 && std::abs(eb[1] - wanted) > 1e-9 && eb[1] != ea[1]; ++i) {
    const double next = std::clamp(b - (eb[1] - wanted) * (b - a) / (eb[1] - ea[1]), -40.0, 40.0);
    a = b, std::copy(eb, eb + 4, ea);
    b = next;
    if (const int status = shoot(b, eb); status < 0) return status;
  }
  *drop = eb[3] * L;
  *reach = eb[2] * L;
  return 0;
}
