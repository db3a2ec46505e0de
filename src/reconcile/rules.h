#pragma once
// Every number by which reconcile decides, in one place; printed in each report. Defaults follow reference/discovery.md 4.3;
// what was changed on the development half is said beside it.

namespace filum::reconcile {

struct Rules {
  double materiality = 0.006;        // of full scale: smaller changes of the prediction (rms of a record) are not worth a name
  double window_materiality = 0.02;  // the same in an eighth of a record (short events)
  double detect = 18.0;              // fall of chi2 (over the overdispersion) that the best effect must bring
  double structure = 7.0;            // standard deviations of the residual's block sums that show that something is missing
  double detect_p = 0.01;            // of the windowed maximum, by parametric bootstrap: above it nothing is named
  double accept_evidence = 10.0;     // fall of BIC against the baseline, or
  double accept_p = 0.0025;          // chance that in a set where nothing is missing the best of the catalogue does as well (parametric bootstrap; a
                                     // line: by the spectrum): BIC's log n asks a prior that a weak effect of two or three values cannot pay
  double explained = 0.70;           // share of the structure that a name must explain
  double held_out = 0.50;            // the same on protocols that were not fitted
  double tie = 6.0;                  // rivals nearer than this in BIC are not told apart
  double pair_evidence = 12.0;       // fall of BIC that a further effect must bring
  double pair_share = 0.05;          // of the structure that a further effect must explain, or
  double pair_least = 0.025;         // this share, if it changes the prediction by
  double pair_material = 1.2;        // times the materiality (development half: less is the first effect's form error), or
  double pair_clean = 0.01;          // this share, if it also takes
  double pair_rest = 0.80;           // of what the smaller set leaves
  double silent_share = 0.50;        // or if this share of its gain comes from where the smaller set changes less than the materiality, if that is
  double silent_least = 0.15;        // at least this part of the samples: no form of the smaller set can err there
  double aside_tie = 3.0;            // the same for a rival that these trials could not show anyway
  double untestable_tie = 24.0;      // tie of a name whose deciding protocol was not run
  double form_preference = 4.0;      // of BIC, by which another form must beat the one of the catalogue
  double partial_structure = 6.0;    // standard deviations left, and
  double partial_share = 0.04;       // share left, both above: "partial"
  double gain_most = 0.012;          // error of the records' gain (median) that a name may ask for (contract: up to 1 %); beyond it "partial", as is
                                     // a law whose value stands at the end of its range
  int most_effects = 3;
  double masked = 0.999;             // share of a signature that the baseline's refit swallows: not testable
  double testable = 16.0;            // squared signal to noise (noise 1 % of full scale) below which an effect cannot be seen
  double screen_share = 0.20;        // of the best score: effects below are not fitted
  int screen_most = 8;
};

}  // namespace filum::reconcile
