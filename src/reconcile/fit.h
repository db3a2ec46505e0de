#pragma once
// Weighted least squares of a rig with effects against records: bounded Levenberg-Marquardt (More 1978; Nocedal & Wright 2006,
// ch. 10) on whitened residuals, with one stiffness (and output gain) per record as random effects with a normal prior, and the
// free columns (polynomial, lines) projected out (variable projection, Golub & Pereyra 1973).
// Noise per output: noise.h.

#include <functional>

#include "reconcile/model.h"
#include "reconcile/noise.h"
#include "reconcile/rules.h"

namespace filum::reconcile {

struct Noise {
  std::vector<OutputNoise> output;
  double scatter = 0.01;       // standard deviation of the logarithm of a record's stiffness
  double gain_scatter = assumed::kGainScatter;  // of a record's output gain, and of an instrument's (contract: up to 1 %, evenly: 0.0058)
};

struct Effort {
  int iterations = 30;
  double tolerance = 1e-5;     // relative fall of chi2 at which it stops
};

/// What is fitted: baseline with these forms.
struct Fit {
  std::vector<const Form*> forms;
  std::vector<double> base;                   // [SI], all baseline parameters
  std::vector<std::vector<double>> params;    // [SI], per form
  std::vector<double> log_scale, log_gain;    // per trial
  std::vector<double> instrument;             // gain of each output's instrument, common to all records
  double chi2 = 1e300;                        // whitened, with the priors of the records' scales
  int samples = 0;                            // that entered
  int parameters = 0;                         // global ones and free columns
  bool at_bound = false;                      // an effect's parameter stands at a bound
  Eigen::MatrixXd covariance;                 // of the global parameters as fitted (logarithms where so)
  std::vector<std::vector<Eigen::VectorXd>> residual;  // [SI] trial x output, NaN where left out
  std::vector<std::vector<Eigen::VectorXd>> predicted; // [SI] with the free columns
  std::vector<Eigen::VectorXd> white;         // per trial: whitened residual
};

class Fitter {
 public:
  Fitter(const RigModel& model, Noise noise);

  const RigModel& model() const { return model_; }
  const Noise& noise() const { return noise_; }
  void set_noise(Noise noise) { noise_ = std::move(noise); }

  /// Trials that take part; by default those that are not held out.
  std::vector<bool> use;
  /// Added to the rig's true outputs, before the sensor, trial by trial (confirm.h); empty: nothing.
  std::vector<Eigen::MatrixXd> correction;
  /// Steps of the differences over the usual ones, one for each global parameter (numerics.h); empty: 1.
  std::vector<double> steps;

  /// Fit from a starting point. An empty `params` takes the first start of each form.
  Fit fit(const std::vector<const Form*>& forms, const std::vector<double>& base, const std::vector<std::vector<double>>& params,
          const Effort& options = {}, const Fit* warm = nullptr) const;
  /// Global parameters as they are; only the records' own scales are fitted. For held-out trials.
  Fit transfer(const Fit& fitted, const std::vector<bool>& trials) const;

  /// Free parameters of the baseline (indices).
  const std::vector<int>& free_baseline() const { return free_; }
  double low(int baseline) const { return low_[static_cast<std::size_t>(baseline)]; }
  double high(int baseline) const { return high_[static_cast<std::size_t>(baseline)]; }

  static constexpr int kInstrument = -2;
  struct Global {
    int form = -1, index = 0;  // form -1: baseline; kInstrument: gain of an output's instrument, with a prior like the records'
    double low = 0, high = 0;
    bool logarithmic = false;
    double unit = 1.0;         // step size of a linear parameter
  };
  std::vector<Global> globals(const std::vector<const Form*>& forms) const;
  /// The value that a global parameter stands for [SI].
  static double& value(Fit& f, const Global& g);

  /// Whitened, projected residual of one trial; optional raw residual and prediction.
  Eigen::VectorXd residual(int trial, const Setting& s, std::vector<Eigen::VectorXd>* raw = nullptr, std::vector<Eigen::VectorXd>* predicted = nullptr) const;
  Setting setting(const Fit& f, int trial) const;
  /// Jacobian of the whitened residual to global parameters (and the record's own), one trial.
  void linearise(const Fit& f, const std::vector<Global>& g, int trial, const Eigen::VectorXd& r0, Eigen::MatrixXd& J) const;
  /// One column of it, at `factor` times the usual step.
  Eigen::VectorXd difference(const Fit& f, const Global& g, int trial, double factor) const;
  int own_parameters() const { return (model_.has_scale() ? 1 : 0) + (model_.has_gain() ? 1 : 0); }

 private:
  struct Solver;
  Eigen::VectorXd difference(const Fit& f, const Global& g, int trial, double factor, const Eigen::VectorXd& r0) const;
  double get(const Fit& f, const Global& g) const;
  void put(Fit& f, const Global& g, double value) const;
  void complete(Fit& f, const std::vector<Global>& g) const;

  const RigModel& model_;
  Noise noise_;
  std::vector<int> free_;
  std::vector<double> low_, high_;
  std::vector<std::vector<std::vector<int>>> valid_;  // trial, output: samples that take part
};

}  // namespace filum::reconcile
