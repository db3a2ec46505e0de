#pragma once
// What is simulated: a rig with its baseline and any set of effects, each in one of its functional forms. An effect that is off
// takes no part in the arithmetic, so the baseline is reproduced bit for bit.

#include <Eigen/Core>
#include <array>
#include <memory>

#include "reconcile/dataset.h"

namespace filum::reconcile {

struct ParamSpec {
  std::string name, unit;
  double low = 0.0, high = 1.0;   // [SI]
  bool logarithmic = false;       // fitted as its logarithm
  int times_baseline = -1;        // the reported value is this times a baseline parameter (by index); -1: as it is
};

/// One functional form of an effect, with the points from which a fit may start.
struct Form {
  Effect effect;
  int kind = 0;
  std::string text;                                // the form in words or as a formula
  std::vector<ParamSpec> params;
  std::vector<std::vector<double>> starts;
  bool line = false;                               // adds sine and cosine columns of free phase to every record
  bool one_size = false;                           // the size by which it would be known is the same in all trials
  int instants = 0;                                // places read off the records, chosen among all samples
};

/// A tube's pressure by finite elements against the reduced model's, at motions r'^2 = R^2/stretch + 2 C.
struct WallTable {
  double linear = 1.0, axial = 1.0;    // factors of the linear part: pressure, axial force
  struct Slice {
    double stretch = 1.0;              // along the axis
    std::vector<double> C, beyond;     // [m2] ascending, [Pa] to be added
    std::vector<double> axial;         // [N] to be added to the reduced axial force; empty: not asked for
    double at(double c, const std::vector<double>& of) const;  // straight between them, beyond the last in proportion
  };
  std::vector<Slice> slices;           // ascending in stretch; a parabola through three
  double at(double c, double stretch, std::vector<double> Slice::*of = &Slice::beyond) const;
  /// Softening of the first cycles: the share of the stress that is left, less the reduced model's.
  struct Softened {
    std::vector<double> top, share;    // [m2] largest motions so far, ascending from 0; motion over the largest, ascending to 1
    std::vector<double> more;          // of each top, of each share
    double at(double c, double top) const;
  };
  Softened softened;
};

struct Kernel;

/// Force of a blade by finite elements less the reduced model's, in units of the linear force at a strain (depth over height) of one: at equal steps of the
/// strain up to the peak, on the way there and back.
struct PressTable {
  static constexpr int kPoints = 5;
  double peak = 0.0;
  std::vector<double> load, unload;  // kPoints + 1 each
  double at(double strain, double most) const;
};

/// Values of one evaluation; null where an effect is off.
struct Setting {
  std::array<const double*, kEffects> p{};
  std::array<int, kEffects> kind{};
  const double* base = nullptr;
  double scale = 1.0;   // of this specimen's stiffness (friction coefficient, gain) against the batch
  double gain = 1.0;    // of this record's output
  const double* instrument = nullptr;  // gain of each output's own instrument, the same in all records; null: 1
  int mesh = 1;         // times as many cells, points and modes as usual: 2 tells what the usual number costs (numerics.h)
  const Kernel* drained = nullptr;    // tissue: what the mesh says of drainage in place of the series (full_tissue.cpp)
  const PressTable* press = nullptr;  // spatula-press: what elements that stiffen, soften and set add (full_press.cpp)
  const WallTable* wall = nullptr;  // vessel-inflation: what the wall's finite elements say beyond the reduced tube (full_tube.cpp)

  const double* on(Effect e) const { return p[static_cast<std::size_t>(index_of(e))]; }
  int form(Effect e) const { return kind[static_cast<std::size_t>(index_of(e))]; }
};

class RigModel {
 public:
  explicit RigModel(const Dataset& d) : data_(d) {}
  virtual ~RigModel() = default;

  const Dataset& data() const { return data_; }
  /// All parameters of the baseline, free or not, in the order of the catalogue.
  const std::vector<ParameterInfo>& baseline() const { return info(data_.rig).baseline; }
  /// A first guess of the baseline from the data.
  virtual std::vector<double> guess() const = 0;
  /// Forms of the effects that belong to the rig itself (those of the sensors are common to all).
  virtual std::vector<Form> forms() const = 0;
  /// True outputs of a trial, samples x outputs, before the sensor.
  virtual void rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const = 0;
  /// Whether stiffness differs from record to record, and whether the gain of the output is a nuisance of its own.
  virtual bool has_scale() const { return true; }
  virtual bool has_gain() const { return false; }
  /// Samples at which the force falls at once. No sampling says when between two of them, so behind a sensor that lags each leaves a tail
  /// exp(-t/tau) of free height: the lag is learnt from the shape of the tail, not from an instant that nobody knows.
  virtual std::vector<int> drops(const Trial&) const { return {}; }
  /// Samples that are left out (beside an event whose instant no model can predict to the sample).
  virtual bool masked(const Trial&, int /*sample*/, int /*output*/) const { return false; }
  /// False for a baseline parameter that is read off the records' events rather than fitted; measured() then gives its value and spread.
  virtual bool fitted(int /*parameter*/) const { return true; }
  struct Measured {
    double value, low, high;
  };
  virtual Measured measured(int /*parameter*/, const std::vector<double>& base, const std::vector<double>& /*scale of each trial*/) const {
    return {base[0], base[0], base[0]};
  }
  /// Whether the rig's own model goes from sample to sample, so that finer samples change it.
  virtual bool steps_in_time() const { return true; }
  /// Order of the polynomial in time that every record may have, -1: none.
  virtual int free_polynomial() const { return -1; }

  /// What the trainer's solvers need to know beyond rig() (full_solver.h): thread and blade.
  struct BentThread {
    double length = 0.0, G = 0.0;  // [m]; weight over bending stiffness
    std::vector<double> rest;      // natural curvature times the length, from the clamp to the tip
  };
  virtual BentThread bent_thread(const Trial&, const Setting&, Eigen::Index /*sample*/) const { return {}; }
  /// Force over that of the linear law at a strain of one, where the largest past one is `most`.
  virtual double press_law(const Trial&, const Setting&, double strain, double /*most*/) const { return strain; }
  virtual double largest_strain() const { return 0.0; }  // of all records
  virtual double punch_stiffness(const Trial&, double /*poissons_ratio*/) const { return 1.0; }  // [m], force per depth and modulus
  /// A thread that slides over a cylinder: pull = hold exp(mu wrap), wrap negative where it runs back.
  struct Slide {
    double mu = 0.0, wrap = 0.0, hold = 0.0;  // [-], [rad], [N]
  };
  virtual Slide slide(const Trial&, const Setting&, Eigen::Index /*sample*/) const { return {}; }
  /// Pressure [Pa] that the effects of a tube's wall ask for beyond the linear law at motion C [m2] and a stretch along its axis.
  virtual double wall_pressure(const Trial&, const Setting&, double /*C*/, double /*stretch*/) const { return 0.0; }
  /// The same for the reduced axial force [N]: the wall's less that of the pressure on a closed end.
  virtual double wall_axial_force(const Trial&, const Setting&, double /*C*/, double /*stretch*/) const { return 0.0; }

  /// rig(), then the sensor.
  void simulate(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const;
  void sense(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const;
  /// Forms of the rig and of the sensor.
  std::vector<Form> all_forms() const;
  /// Columns whose amplitudes are free in every record and output: polynomial and lines. samples x columns.
  Eigen::MatrixXd free_columns(const Trial& t, const Setting& s) const;

  /// Largest minus smallest value of an output over the trials that are not held out.
  double full_scale(const std::string& output) const;
  double session_start() const;  // [s]

 private:
  std::vector<Form> sensor_forms() const;
  const Dataset& data_;
};

std::unique_ptr<RigModel> make_model(const Dataset& d);

// One constructor for each rig.
std::unique_ptr<RigModel> make_tissue(const Dataset& d);      // tissue-block, spatula-press
std::unique_ptr<RigModel> make_vessel(const Dataset& d);
std::unique_ptr<RigModel> make_cantilever(const Dataset& d);
std::unique_ptr<RigModel> make_capstan(const Dataset& d);
std::unique_ptr<RigModel> make_needle(const Dataset& d);
std::unique_ptr<RigModel> make_forceps(const Dataset& d);
std::unique_ptr<RigModel> make_hold(const Dataset& d);

/// Grid of starting points: every combination.
std::vector<std::vector<double>> grid(const std::vector<std::vector<double>>& axes);
double median(std::vector<double> v);

}  // namespace filum::reconcile
