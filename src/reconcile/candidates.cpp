#include "reconcile/candidates.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "reconcile/numerics.h"

namespace filum::reconcile {
namespace {

std::set<Effect> set_of(const Fit& f) {
  std::set<Effect> s;
  for (const Form* form : f.forms) s.insert(form->effect);
  return s;
}

}  // namespace

Candidates::Candidates(Fitter fitter, Fit base, const std::vector<Form>& forms, const CompareOptions& compare, const LineOptions& line)
    : fitter_(std::move(fitter)), base_(std::move(base)), forms_(forms), compare_(compare), line_(line) {}

double Candidates::line_chance(const Form& form, const Fit& from) const { return reconcile::line_chance(fitter_, from, form, line_); }

std::vector<Score> Candidates::lines(const Fit& from) const { return line_scores(fitter_, from, forms_, compare_.accept_p, line_); }

/// The amplitudes of a line stand for one strength and a phase in each record. Integrated over the phase, a record in which the line's
/// signal to noise is S pays log(2 pi S^2), S^2 its fall of chi2; at the least that is named, 10 to 20 a record, that is 4 to 5 where BIC
/// would ask 2 log n, some 13 (half of log(2 pi S^2), with a margin, is the rule line_price).
double Candidates::bic(const Fit& f) const {
  int lines = 0;
  int instants = 0;  // a change point costs as a parameter does, though no slope leads to it (Zhang & Siegmund 2007)
  for (const Form* form : f.forms) {
    lines += !form->line ? 0 : form->effect == Effect::pulsation && form->kind >= 2 ? 2 : 1;
    instants += form->instants;
  }
  const auto records = std::count(fitter_.use.begin(), fitter_.use.end(), true);
  const double amplitudes = 2.0 * lines * static_cast<double>(records) * static_cast<double>(data().outputs.size());
  const double each = std::log(static_cast<double>(f.samples));
  return f.chi2 / dispersion_ + (f.parameters + instants - amplitudes) * each + amplitudes * std::min(compare_.line_price, each);
}

double Candidates::preference(const Fit& f) const {
  double sum = 0.0;
  for (const Form* form : f.forms) {
    const auto first = std::find_if(forms_.begin(), forms_.end(), [&](const Form& g) { return g.effect == form->effect; });
    sum += form == &*first ? 0.0 : compare_.form_preference;
  }
  return sum;
}

void Candidates::keep(std::vector<Fit> fits) {
  for (Fit& f : fits) {
    const auto mine = set_of(f);
    if (mine.size() != f.forms.size()) continue;
    const auto at = std::find_if(fitted_.begin(), fitted_.end(), [&](const Fit& c) { return set_of(c) == mine; });
    if (at == fitted_.end()) fitted_.push_back(std::move(f));
    else if (bic(f) + preference(f) < bic(*at) + preference(*at)) *at = std::move(f);
  }
  std::stable_sort(fitted_.begin(), fitted_.end(), [&](const Fit& a, const Fit& b) { return bic(a) < bic(b); });
}

const Fit* Candidates::best(std::size_t effects) const {
  for (const Fit& f : fitted_)
    if (f.forms.size() == effects) return &f;
  return nullptr;
}

void Candidates::refresh(int most, const Run& run, const Stretch& stretch) {
  const Fit& top = fitted_.empty() || bic(fitted_[0]) > bic(base_) ? base_ : fitted_[0];
  Noise noise = estimate_noise(fitter_, top);
  noise.scatter = fitter_.noise().scatter;
  if (!top.forms.empty() && data().rig != Rig::forceps_bridge && data().rig != Rig::spatula_press) {
    // an effect that was missing may have looked like scatter, never the other way round
    noise.scatter = std::min(noise.scatter, std::max(assumed::kScatterLow, replicate_scatter(data(), top)));
  }
  fitter_.set_noise(noise);
  base_ = fitter_.fit({}, base_.base, {}, {12, 1e-5}, &base_);
  int kept = 0;  // an instrument alone stays in the comparison
  std::erase_if(fitted_, [&](const Fit& f) { return ++kept > most && (f.forms.size() > 1 || info(f.forms[0]->effect).stage != 0); });
  Steps steps(run, stretch, fitted_.size());
  parallel(run.threads, fitted_.size(), [&](std::size_t i) {
    stop_if_cancelled(run);
    const Fit old = fitted_[i];
    fitted_[i] = fitter_.fit(old.forms, old.base, old.params, {6, 1e-4}, &old);
    steps.done();
  });
  dispersion_ = 1.0;
  const Fit* least = &base_;
  for (const Fit& f : fitted_)
    if (f.chi2 < least->chi2) least = &f;
  dispersion_ = structure(*least).z > compare_.overdispersed ? structure(*least).dispersion : 1.0;
  dispersion_ = std::max(dispersion_, replicate_dispersion(fitter_, *least));
  keep({});
}

Structure Candidates::structure(const Fit& f) const {
  Structure s = structure_of(f.white, f.parameters);
  if (s.dispersion <= 1.0) return s;
  const double own = replicate_dispersion(fitter_, f, s.length);
  const double common = std::clamp(1.0 - (own - 1.0) / (s.dispersion - 1.0), 0.0, 1.0);
  s.excess *= common;
  s.z *= common;
  return s;
}

/// The largest set whose further effects each bring what a further effect must: what others take beyond it is as likely noise.
const Fit& Candidates::fullest() const {
  const Fit* now = &base_;
  for (std::size_t size = 1; size <= static_cast<std::size_t>(compare_.most_effects); ++size)
    if (const Fit* next = best(size); next != nullptr && (size == 1 ? next->chi2 < now->chi2 : bic(*next) < bic(*now) - compare_.pair_evidence)) now = next;
  return *now;
}

double Candidates::explained(const Fit& f) const {
  const Fit* least = &fullest();
  const Structure left = structure(*least);
  const double rest = left.z > compare_.overdispersed ? left.excess : 0.0;
  const double all = base_.chi2 - least->chi2 + rest;
  return all > 0.0 ? std::min(1.0, (base_.chi2 - f.chi2) / all) : 0.0;
}

double Candidates::material(const Fit& f, const Fit& against) const {
  double most = 0.0;
  const double error = std::max(solver_error(fitter_, f).solver(), solver_error(fitter_, against).solver());
  const double least = std::max(compare_.materiality, error), in_window = std::max(compare_.window_materiality, error);
  double common = 0.0;
  int used = 0;
  for (std::size_t i = 0; i < f.predicted.size(); ++i)
    if (!f.predicted[i].empty()) common += f.log_scale[i] - against.log_scale[i], ++used;
  for (std::size_t i = 0; i < f.predicted.size(); ++i)
    for (std::size_t c = 0; c < f.predicted[i].size(); ++c) {
      const Eigen::VectorXd change = (f.predicted[i][c] - against.predicted[i][c]) / fitter_.noise().output[c].full_scale;
      if (!change.allFinite()) continue;
      most = std::max(most, std::sqrt(change.squaredNorm() / static_cast<double>(change.size())) / least);
      // what one fit hides in the stiffness of single records counts as change, too
      const double hidden = std::abs(f.log_scale[i] - against.log_scale[i] - common / used), spread = (f.predicted[i][c].array() - f.predicted[i][c].mean()).matrix().norm();
      const double signal = std::max(spread, data().rig == Rig::suture_pull ? f.predicted[i][c].norm() : 0.0) / std::sqrt(static_cast<double>(change.size()));
      const double gain = std::abs(f.log_gain[i] - against.log_gain[i] + std::log(f.instrument[c] / against.instrument[c])) * f.predicted[i][c].norm() / std::sqrt(static_cast<double>(change.size()));
      most = std::max(most, (hidden * signal + gain) / fitter_.noise().output[c].full_scale / least);
      const Eigen::Index w = std::max<Eigen::Index>(2, change.size() / 8);
      for (Eigen::Index k = 0; k + w <= change.size(); k += w)
        most = std::max(most, std::sqrt(change.segment(k, w).squaredNorm() / static_cast<double>(w)) / in_window);
    }
  return most;
}

}  // namespace filum::reconcile
