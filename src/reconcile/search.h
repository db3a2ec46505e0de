#pragma once
// Fits of effect sets: singles, then pairs and triples where they earn it, best first. Works on one Fitter; every fit is a full
// simulation of all records that are not held out.

#include "reconcile/baseline.h"
#include "reconcile/numerics.h"
#include "reconcile/result.h"
#include "reconcile/structure.h"

namespace filum::reconcile {

/// Runs work(0 ... n-1) on some threads; the order of results does not depend on how many.
void parallel(int threads, std::size_t n, const std::function<void(std::size_t)>& work);

class Search {
 public:
  Search(const RigModel& model, const std::vector<Form>& forms, const Options& options);

  /// Baseline with the noise it implies; then singles; then more, while they earn it.
  void run();

  const Fitter& fitter() const { return fitter_; }
  const Fit& base() const { return base_; }
  /// Where the baseline was started from and where it ended.
  const BaselineSummary& baseline() const { return baseline_; }
  const std::vector<Form>& forms() const { return forms_; }
  /// Best fit of each set of effects.
  const std::vector<Fit>& candidates() const { return candidates_; }
  double dispersion() const { return dispersion_; }
  /// With lines of free phase in every record at what their phases cost (see search.cpp), not at log n an amplitude.
  double bic(const Fit& f) const;
  /// Share of what is missing that a fit explains; what is missing is what the largest set that earns its place takes away, and the structure left.
  double explained(const Fit& f) const;
  /// The same set with one effect in another of its forms, where the data do not tell the two apart (within `tie` of BIC).
  std::vector<Fit> other_forms(const Fit& winner, double tie) const;
  /// Largest change of the prediction against another fit, over what is material (1: just material): the rules' share of full scale, or what halving
  /// time steps and cells changes in either fit where that is more.
  double material(const Fit& f, const Fit& against) const;
  /// What the residual holds beyond what replicates differ by.
  Structure structure(const Fit& f) const;
  const Fit* best(std::size_t effects) const;
  /// Chance that noise of the spectrum's local height brings lines as strong somewhere in their bands (Bonferroni).
  double line_p(const Form& form, const Fit& from) const;

 private:
  /// A stretch of the progress bar.
  struct Stretch {
    const char* stage;
    double from, to;
  };
  class Steps;
  void start_baseline();
  std::vector<Fit> extend(const Fit& from, int most_effects, int most_forms, const Stretch& stretch) const;
  std::vector<Score> lines(const Fit& from) const;
  Line line_of(const Form& f, std::size_t line, const Fit& from) const;
  double places(const Form& f, std::size_t line) const;
  bool separate(Fit& from, const Line& line) const;
  void keep(std::vector<Fit> fits);
  void refresh(const Stretch& stretch);
  const Fit& fullest() const;
  bool worth_more(const Fit& f) const;
  double preference(const Fit& f) const;

  const RigModel& model_;
  const std::vector<Form>& forms_;
  const Options& options_;
  Fitter fitter_;
  Fit base_;
  BaselineSummary baseline_;
  std::vector<Fit> candidates_;
  double dispersion_ = 1.0;
};

/// The baseline's residual against repetitions of the baseline.
Detection detect(const Search& search, const std::vector<Form>& forms);

/// Every effect of the rig by the best of its score tests against the baseline, and what came of it.
std::vector<Screened> screened(const Search& search, const Result& r);

}  // namespace filum::reconcile
