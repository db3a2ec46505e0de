filum_test(evidence/validation filum_evidence)
