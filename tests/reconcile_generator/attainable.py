#!/usr/bin/python3
"""What share of the weak single effects the best possible test could name: attainable.py DATA LABELS REPORTS.
Seen: likelihood ratio of the effect against the baseline, chi-squared with as many degrees of freedom as it has values and noncentrality SNR^2
(Wilks, Wald), above the level at which one set in 400 with nothing in it would be named although every effect of the rig is tried (Bonferroni);
a line has two amplitudes of free phase in every record and stands anywhere in its bands.
Told: against the oracle's nearest rival at d standard deviations twice the log likelihood ratio is normal, mean d^2, variance 4 d^2 (Cox 1961,
linear in between; a rival of no size is the baseline, which `seen` has counted); it must exceed 6, the odds of 20 to 1 of a 95 % set. The nearest rival is one of the oracle's draws: wider families come nearer, so
these are upper bounds."""
import json
import os
import sys
import numpy as np
from scipy.stats import ncx2, chi2, norm

LEVEL, TIE = 0.0025, 6.0
EFFECTS = {'tissue-block': 15, 'spatula-press': 11, 'vessel-inflation': 11, 'suture-cantilever': 6, 'suture-pull': 7, 'needle-insertion': 8, 'forceps-bridge': 8, 'tip-hold': 4}


def records(folder):
    """Number of records that are not held out, their longest span [s]."""
    n, span = 0, 0.0
    for line in open(os.path.join(folder, 'experiment.yaml')):
        if '{ file:' in line and 'hold_out' not in line:
            n += 1
            last = open(os.path.join(folder, line.split('file:')[1].split(',')[0].strip())).read().rstrip().rsplit('\n', 1)[1]
            span = max(span, float(last.split(',')[0]))
    return n, span


def seen(label, folder):
    effect, ratio = label['effects'][0], label['snr']
    tries = EFFECTS[label['rig']]
    if effect in ('mains-hum', 'pulsation'):
        n, span = records(folder)
        width = 0.6 if effect == 'mains-hum' else 1.5
        columns = 2 * n * (2 if effect == 'pulsation' and label['parameters'][effect].get('breath') else 1)
        tries *= 1 + 2 * width * span
    else:
        columns = sum(isinstance(v, float) and not isinstance(v, bool) and v != 0.0 for v in label['parameters'][effect].values())
    return ncx2.sf(chi2.isf(LEVEL / tries, max(columns, 1)), max(columns, 1), ratio ** 2)


def told(label):
    d = label['distance']
    return 1.0 if d is None or not label['rival'] else norm.cdf((d * d - TIE) / (2 * d))


data, labels, reports = sys.argv[1:4]
best, right, each = [], [], []
for file in sorted(os.listdir(labels)):
    name, label = file[:-5], json.load(open(os.path.join(labels, file)))
    path = os.path.join(reports, name, 'report.json')
    if label['kind'] != 'single' or not 4 <= label['snr'] < 8 or not os.path.exists(path):
        continue
    report = json.load(open(path))
    best.append((seen(label, os.path.join(data, name)), told(label)))
    right.append(report['verdict'] == 'effect' and {e['name'] for e in report['effects']} == set(label['effects']))
    each.append(f"{name} {label['effects'][0]} snr {label['snr']:.1f} rival {label['rival']} at {label['distance'] or np.inf:.1f}: seen {best[-1][0]:.2f} told {best[-1][1]:.2f} {'named' if right[-1] else report['verdict']}")
print('\n'.join(each))
a = np.array(best)
if len(a):
    print(f'{len(a)} singles of SNR 4-8: best possible {100 * np.mean(a[:, 0] * a[:, 1]):.1f} % (seen {100 * np.mean(a[:, 0]):.1f} %, told {100 * np.mean(a[:, 1]):.1f} %), named {100 * np.mean(right):.1f} %')
