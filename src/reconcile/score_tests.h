#pragma once
// Score tests: what a further effect would do to the residual, with everything already fitted free to answer. The signature of an
// effect is the change of the whitened residual when it is switched on at one of its starting points; its part orthogonal to the
// present model (baseline, effects, records' own scales) is what the data can show of it (Rao 1948; Plumlee 2017).

#include "base/rng.h"
#include "reconcile/fit.h"

namespace filum::reconcile {

/// How alike the signatures of sets of effects are beyond what a refit could answer, and how much of each such a refit hides.
struct Likeness {
  Eigen::MatrixXd correlation;  // sets x sets, symmetric, 1 on the diagonal
  std::vector<double> masked;   // 0 ... 1
};

struct Score {
  const Form* form = nullptr;
  std::vector<double> start;
  double gain = 0.0;       // fall of chi2 that the score test promises
  double amplitude = 0.0;  // in units of the start
  double seen = 0.0;       // squared norm of the orthogonal part
  double masked = 1.0;     // share of the signature that the present model can imitate
  double imitated = 1.0;   // the same by its common parameters alone: what a record's own scale swallows still costs that scale's prior
};

class ScoreTests {
 public:
  ScoreTests(const Fitter& fitter, const Fit& fit);
  Score score(const Form& form, const std::vector<double>& start) const;
  /// Every form at every start that is not part of the fit, best first.
  std::vector<Score> all(const std::vector<Form>& forms) const;
  /// What a repetition in which the fit is true would measure beyond it, whitened: white noise and the records' own scales.
  std::vector<Eigen::VectorXd> repetition(Rng& rng) const;
  /// In place: what a refit (made linear about the optimum) leaves of it.
  void refit(std::vector<Eigen::VectorXd>& y) const;
  /// q with which the score test of a form is (q.y)^2/seen.
  struct Direction {
    std::vector<Eigen::VectorXd> q;
    double seen = 0.0;
    bool either_sign = false;
  };
  Direction direction(const Form& form, const std::vector<double>& start) const;
  const std::vector<Eigen::VectorXd>& residuals() const { return r_; }
  const std::vector<int>& trials() const { return trials_; }
  /// Of sets of effects, each switched on at its fitted values.
  Likeness likeness(const std::vector<const Fit*>& sets) const;

 private:
  struct Signature {
    std::vector<Eigen::VectorXd> s;
    Eigen::VectorXd g;
    std::vector<Eigen::VectorXd> n;
    double norm = 0.0;
  };
  Signature signature(const Form& form, const std::vector<double>& start) const;
  Signature signature(const std::vector<const Form*>& forms, const std::vector<std::vector<double>>& params) const;
  double inner(const Signature& a, const Signature& b) const;

  const Fitter& fitter_;
  const Fit& fit_;
  std::vector<int> trials_;
  std::vector<Eigen::VectorXd> r_;
  std::vector<Eigen::MatrixXd> G_, N_, C_, D_;  // D_ inverted
  Eigen::MatrixXd S_, common_;                  // inverted; with and without the records' own scales
  std::vector<Eigen::Index> shared_;            // columns of G_ that are instruments' gains
  Eigen::VectorXd instrument_;                  // pull of their prior where the fit stands
};

}  // namespace filum::reconcile
