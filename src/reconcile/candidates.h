#pragma once
// The baseline, the sets of effects that were fitted beside it, and the yardsticks by which they are compared. Works on one Fitter; every fit is a full
// simulation of all records that are not held out.

#include "reconcile/lines.h"
#include "reconcile/run.h"

namespace filum::reconcile {

class Candidates {
 public:
  /// `forms` and what `fitter` models must outlive it.
  Candidates(Fitter fitter, Fit base, const std::vector<Form>& forms, const CompareOptions& compare, const LineOptions& line);

  const Fitter& fitter() const { return fitter_; }
  const Dataset& data() const { return fitter_.model().data(); }
  const Fit& base() const { return base_; }
  const std::vector<Form>& forms() const { return forms_; }
  /// Best fit of each set of effects, the best first.
  const std::vector<Fit>& fitted() const { return fitted_; }
  const CompareOptions& rules() const { return compare_; }
  double dispersion() const { return dispersion_; }

  /// Keeps the best fit of each set of effects.
  void keep(std::vector<Fit> fits);
  /// Noise and overdispersion from the best fit so far, and the best `most` fits (and instruments alone) again under them.
  void refresh(int most, const Run& run, const Stretch& stretch);

  const Fit* best(std::size_t effects) const;
  /// With lines of free phase in every record at what their phases cost (see candidates.cpp), not at log n an amplitude.
  double bic(const Fit& f) const;
  /// Share of what is missing that a fit explains; what is missing is what the largest set that earns its place takes away, and the structure left.
  double explained(const Fit& f) const;
  /// Largest change of the prediction against another fit, over what is material (1: just material): the rules' share of full scale, or what halving
  /// time steps and cells changes in either fit where that is more.
  double material(const Fit& f, const Fit& against) const;
  /// What the residual holds beyond what replicates differ by.
  Structure structure(const Fit& f) const;
  /// lines.h, beside what `from` holds.
  double line_chance(const Form& form, const Fit& from) const;
  std::vector<Score> lines(const Fit& from) const;

 private:
  const Fit& fullest() const;
  double preference(const Fit& f) const;

  Fitter fitter_;
  Fit base_;
  const std::vector<Form>& forms_;
  const CompareOptions compare_;
  const LineOptions line_;
  std::vector<Fit> fitted_;
  double dispersion_ = 1.0;
};

}  // namespace filum::reconcile
