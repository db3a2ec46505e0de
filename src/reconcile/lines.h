#pragma once
// Lines of free phase in the spectrum of what a fit leaves: a heart, breath, the mains. No score test sees them, since each record has its own phase.

#include "reconcile/score_tests.h"
#include "reconcile/structure.h"

namespace filum::reconcile {

/// Chance that noise of the spectrum's local height brings lines as strong somewhere in their bands (Bonferroni).
double line_chance(const Fitter& fitter, const Fit& from, const Form& form, const LineOptions& options);
/// Forms whose lines stand out by a chance of `accept` or less, each with the fall of chi2 that it promises.
std::vector<Score> line_scores(const Fitter& fitter, const Fit& from, const std::vector<Form>& forms, double accept, const LineOptions& options);

}  // namespace filum::reconcile
