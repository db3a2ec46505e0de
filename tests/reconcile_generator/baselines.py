#!/usr/bin/python3
"""What simpler methods make of the same files: baselines.py DATA LABELS REPORTS.
  BIC         the set of effects with the least BIC among all that reconcile fitted (tried, in report.json), if it beats the baseline: no demand
              on explanation, materiality, rivals or held-out protocols (forward selection, Bacher & Madsen 2011).
  sparse      the most stable term of the thresholded sparse regression of the baseline's residual (residual_terms in report.json), named by
              the table below; a stability below 0.8 abstains (Brunton et al. 2016; ensembles: Fasel et al. 2022).
  GP          baseline + Gaussian process of the residual on input, rate and time (Kennedy & O'Hagan 2001), hyperparameters by marginal
              likelihood; only the error on held-out protocols is compared, it names nothing. Rigs with a baseline linear in what is free."""
import csv
import json
import os
import sys
import numpy as np

data, labels, reports = sys.argv[1:4]
TERMS = {  # what a reader would call a term, by rig
    'tissue-block': {'rate': 'viscoelastic-relaxation', '|rate|': 'viscoelastic-relaxation', 'output*rate': 'viscoelastic-relaxation', 'output*time': 'viscoelastic-relaxation',
                     'displacement*time': 'viscoelastic-relaxation', 'displacement*rate': 'viscoelastic-relaxation', 'displacement^3': 'strain-stiffening', 'displacement^2': 'tension-compression-asymmetry',
                     'output^2': 'tension-compression-asymmetry', 'sign(rate)': 'hysteresis', 'time': 'sensor-drift'},
    'spatula-press': {'rate': 'viscoelastic-relaxation', '|rate|': 'viscoelastic-relaxation', 'output*rate': 'viscoelastic-relaxation', 'output*time': 'viscoelastic-relaxation', 'depth*time': 'viscoelastic-relaxation',
                      'depth*rate': 'viscoelastic-relaxation', 'depth^3': 'strain-stiffening', 'depth^2': 'strain-stiffening', 'output^2': 'strain-stiffening', 'time': 'sensor-drift'},
    'vessel-inflation': {'pressure^2': 'fibre-stiffening', 'pressure^3': 'fibre-stiffening', 'output^2': 'fibre-stiffening', 'rate': 'viscoelastic-relaxation', 'output*rate': 'viscoelastic-relaxation',
                         'pressure*rate': 'viscoelastic-relaxation', 'time': 'sensor-drift', 'pressure*time': 'viscoelastic-relaxation'},
    'suture-cantilever': {'time': 'bending-creep', 'overhang*time': 'bending-creep', 'output*time': 'bending-creep', 'sign(rate)': 'permanent-set'},
    'suture-pull': {'speed': 'viscous-drag', 'speed^2': 'speed-dependent-friction', 'speed^3': 'speed-dependent-friction', '1': 'bending-stiffness-loss', 'time': 'sensor-drift'},
    'needle-insertion': {'rate': 'viscous-drag', '|rate|': 'viscous-drag', 'sign(rate)': 'shaft-friction', 'depth*rate': 'shaft-friction', 'time': 'sensor-drift', 'depth^3': 'layer-rupture', 'depth^2': 'layer-rupture'},
    'forceps-bridge': {'angle^2': 'bridge-nonlinearity', 'angle^3': 'bridge-nonlinearity', 'output^2': 'bridge-nonlinearity', 'sign(rate)': 'hysteresis', 'time': 'temperature-drift', 'rate': 'sensor-lag'},
}
INPUT = {'tissue-block': 'displacement', 'spatula-press': 'depth', 'forceps-bridge': 'angle'}
OUTPUT = {'tissue-block': 'force', 'spatula-press': 'force', 'forceps-bridge': 'strain_counts'}


def by_bic(report):
    best = max(report['tried'], key=lambda t: t['evidence'] if t['evidence'] is not None else -1e9, default=None)
    return set(best['effects']) if best and best['evidence'] > 0 else set()


def by_terms(report):
    table = TERMS.get(report['rig'], {})
    for term in report.get('residual_terms', []):
        name = 'rate' if term['term'] == 'rate*|rate|' else term['term']
        if term['stability'] >= 0.8 and name in table:
            return {table[name]}
    return set()


def trials(folder, rig):
    """(protocol, t, x, y) of each trial, in the file's units; only of rigs whose trials share a geometry."""
    out = []
    for line in open(os.path.join(folder, 'experiment.yaml')):
        if '{ file:' not in line:
            continue
        file = line.split('file:')[1].split(',')[0].strip()
        protocol = line.split('protocol:')[1].split('}')[0] + ('specimen' + line.split('specimen:')[1] if 'specimen:' in line else '')
        rows = list(csv.DictReader(open(os.path.join(folder, file))))
        get = lambda c: np.array([float(r[c]) if r[c] else np.nan for r in rows])
        out.append((protocol, get('t_s'), get(INPUT[rig]), get(OUTPUT[rig])))
    return out


def gp_held_out(folder, rig, sigma):
    """rms over noise on each protocol in turn, of the baseline alone and with the process."""
    all_trials = trials(folder, rig)
    protocols = sorted({t[0] for t in all_trials})
    if len(protocols) < 2:
        return None
    top = max(np.nanmax(np.abs(t[2])) for t in all_trials)
    span = max(t[1][-1] for t in all_trials)

    def features(t, x):
        return np.column_stack([x / top, np.gradient(x, t) / top * span / 10, t / span])

    def line(x, rig=rig):
        return np.column_stack([x, np.ones_like(x)]) if rig == 'forceps-bridge' else x[:, None]
    before = after = count = 0
    for held in protocols[:4]:
        fit = [t for t in all_trials if t[0] != held]
        A = np.vstack([line(t[2]) for t in fit])
        y = np.concatenate([t[3] for t in fit])
        ok = np.isfinite(y)
        theta = np.linalg.lstsq(A[ok], y[ok], rcond=None)[0]
        X, r = np.vstack([features(t[1], t[2]) for t in fit])[ok], (y - A @ theta)[ok]
        pick = np.random.default_rng(1).choice(len(r), min(250, len(r)), replace=False)
        X, r = X[pick], r[pick]
        best = (-np.inf,)
        for length in (0.1, 0.3, 1.0, 3.0):
            for size in (0.5, 1.0, 2.0):
                D = ((X[:, None] - X[None]) ** 2).sum(-1) / length ** 2
                s2 = (size * r.std()) ** 2
                L = np.linalg.cholesky(s2 * np.exp(-0.5 * D) + sigma ** 2 * np.eye(len(r)))
                a = np.linalg.solve(L.T, np.linalg.solve(L, r))
                value = -0.5 * r @ a - np.log(np.diag(L)).sum()
                if value > best[0]:
                    best = (value, length, s2, a)
        _, length, s2, a = best
        for _, t, x, y in (t for t in all_trials if t[0] == held):
            left = y - line(x) @ theta
            k = s2 * np.exp(-0.5 * ((features(t, x)[:, None] - X[None]) ** 2).sum(-1) / length ** 2)
            good = np.isfinite(left)
            before += np.sum(left[good] ** 2)
            after += np.sum((left - k @ a)[good] ** 2)
            count += good.sum()
    return np.sqrt(before / count) / sigma, np.sqrt(after / count) / sigma


rows = []
for file in sorted(os.listdir(labels)):
    path = os.path.join(reports, file[:-5], 'report.json')
    if os.path.exists(path):
        rows.append((file[:-5], json.load(open(os.path.join(labels, file))), json.load(open(path))))
share = lambda v: f'{100 * sum(v) / len(v):5.1f} % of {len(v)}' if v else '-'
ours = lambda r: {e['name'] for e in r['effects']}
for title, names, skip in (('reconcile', ours, ()), ('BIC', by_bic, ('tip-hold',)), ('sparse', by_terms, ('tip-hold',))):
    of = lambda *kinds: [(l, names(r)) for _, l, r in rows if l['kind'] in kinds and l['rig'] not in skip]
    given = [(l, n) for l, n in of('null', 'wrong-parameter', 'single', 'double', 'outside', 'unidentifiable') if n]
    print(f'{title:10} singles right {share([n == set(l["effects"]) for l, n in of("single") if l["snr"] >= 8])};  null named {share([bool(n) for l, n in of("null", "wrong-parameter")])};'
          f'  outside named {share([bool(n) for l, n in of("outside")])};  names given hold no wrong one {share([n <= set(l["effects"]) for l, n in given])}')
gaps = []
for name, l, r in rows:
    if l['rig'] in INPUT and l['kind'] == 'single' and r['verdict'] == 'effect' and r['gap']['held_out']['after']:
        unit = {'force': 1e3, 'strain_counts': 1.0}[OUTPUT[l['rig']]]
        if OUTPUT[l['rig']] not in r['gap']['noise']:
            continue
        gp = gp_held_out(os.path.join(data, name), l['rig'], r['gap']['noise'][OUTPUT[l['rig']]]['value'] * unit)
        if gp:
            gaps.append((r['gap']['held_out']['before'], r['gap']['held_out']['after'], *gp))
if gaps:
    g = np.median(np.array(gaps), axis=0)
    print(f'held-out gap, median of {len(gaps)}: baseline {g[0]:.2f} -> reconcile {g[1]:.2f};  baseline without specimen scales {g[2]:.2f} -> with GP {g[3]:.2f}')
