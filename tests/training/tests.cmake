filum_test(training/knot_classifier)
filum_test(training/knot_diagram)
filum_test(training/knot_simplify)
filum_test(training/knot_invariant)
