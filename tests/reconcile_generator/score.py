#!/usr/bin/python3
"""Scores reports against labels: score.py LABELS REPORTS [-v]."""
import collections
import json
import os
import sys

labels, reports = sys.argv[1], sys.argv[2]
verbose = '-v' in sys.argv
rows = []
for file in sorted(os.listdir(labels)):
    name = file[:-5]
    path = os.path.join(reports, name, 'report.json')
    if os.path.exists(path):
        rows.append((name, json.load(open(os.path.join(labels, file))), json.load(open(path))))


def share(values):
    values = list(values)
    return f'{100 * sum(values) / len(values):5.1f} % of {len(values)}' if values else '-'


def named(r):
    return {e['name'] for e in r['effects']}


def rivals(r):
    return [set(x['effects']) for x in r['rivals']] if r['verdict'] == 'ambiguous' else ([named(r)] if named(r) else [])


def median(v):
    v = sorted(v)
    return v[len(v) // 2] if v else float('nan')


of = lambda *kinds: [(n, l, r) for n, l, r in rows if l['kind'] in kinds]
single = of('single')
right = lambda l, r: r['verdict'] == 'effect' and named(r) == set(l['effects'])
# a single effect can be named where the oracle finds every rival at 4 standard deviations or more (discovery.md 4.5); nearer ones belong in a set
told = lambda l: l['distance'] is None or l['distance'] >= 4
print('sets', len(rows))
print('single, right name, SNR >= 8  ', share(right(l, r) for _, l, r in single if l['snr'] >= 8))
print('single, right name, SNR 4-8   ', share(right(l, r) for _, l, r in single if 4 <= l['snr'] < 8))
clear = [(n, l, r) for n, l, r in single if told(l)]
print('  of these every rival at 4 sd or more, SNR >= 8', share(right(l, r) for _, l, r in clear if l['snr'] >= 8), ' SNR 4-8', share(right(l, r) for _, l, r in clear if 4 <= l['snr'] < 8))
near = [(l, r) for _, l, r in single if not told(l)]
print('  a rival nearer: set or name holds the truth', share(set(l['effects']) in rivals(r) for l, r in near if rivals(r)), ' nothing said', share(not rivals(r) for _, r in near))
one = [(l, r) for _, l, r in rows if r['verdict'] == 'effect' and len(named(r)) == 1]
print('one name given is right       ', share(bool(named(r) & set(l['effects'])) for l, r in one if l['kind'] != 'outside'))
print('   the same, outside counted as wrong unless partial', share(bool(named(r) & set(l['effects'])) or (l['kind'] == 'outside' and r['partial']) for l, r in one))
print('null, something named         ', share(r['verdict'] == 'effect' for _, l, r in of('null', 'wrong-parameter')))
print('null, agree or parameter      ', share(r['verdict'] in ('agree', 'parameter') for _, l, r in of('null', 'wrong-parameter')))
print('outside, unknown or partial   ', share(r['verdict'] == 'unknown' or r['partial'] for _, l, r in of('outside')))
print('outside, confidently wrong    ', share(r['verdict'] == 'effect' and not r['partial'] for _, l, r in of('outside')))
amb = [(l, r) for _, l, r in rows if r['verdict'] == 'ambiguous' and l['kind'] in ('single', 'unidentifiable')]
print('ambiguous holds the truth     ', share(set(l['effects']) in rivals(r) for l, r in amb), 'size', round(sum(len(rivals(r)) for _, r in amb) / max(1, len(amb)), 2))
sets = [(l, r) for _, l, r in rows if rivals(r) and l['kind'] in ('single', 'unidentifiable')]
print('sets of rivals, a name alone being a set of one: hold the truth', share(set(l['effects']) in rivals(r) for l, r in sets), 'size', round(sum(len(rivals(r)) for _, r in sets) / max(1, len(sets)), 2))
print('double, both named            ', share(named(r) == set(l['effects']) for _, l, r in of('double')))
print('double, no wrong name         ', share(named(r) <= set(l['effects']) for _, l, r in of('double')))
good = [(l, r) for _, l, r in single if right(l, r)]
error, cover, alike = [], [], []
for l, r in good:
    for e in r['effects']:
        for p, v in e['parameters'].items():
            truth = l['parameters'][e['name']].get(p)
            if isinstance(truth, float) and truth and v['value'] is not None:
                error.append(abs(v['value'] / truth - 1))
                cover.append(v['low'] <= truth <= v['high'])
                if l['parameters'][e['name']].get('form', True):
                    alike.append(cover[-1])
print('parameter error, median       ', f'{100 * median(error):.1f} %', 'covered', share(cover), 'where the generator has a form of the catalogue', share(alike))
print('held-out gap after, median    ', round(median([r['gap']['held_out']['after'] for _, r in good if r['gap']['held_out']['after']]), 3))
t = [r['seconds'] for _, _, r in rows]
print('seconds, median and most      ', round(median(t), 1), round(max(t), 1))
by = collections.defaultdict(list)
for n, l, r in single:
    by[l['rig']].append(right(l, r))
for rig, v in by.items():
    print('  single', rig, share(v))
if verbose:
    for n, l, r in rows:
        ok = (l['kind'] in ('null', 'wrong-parameter') and r['verdict'] in ('agree', 'parameter')) or (l['kind'] in ('single', 'double', 'unidentifiable') and named(r) == set(l['effects'])) or \
             (l['kind'] == 'outside' and (r['verdict'] == 'unknown' or r['partial']))
        if not ok:
            print(n, l['kind'], '+'.join(l['effects']), f"snr {l['snr']:.0f} rho {l['rho']}/{l['white']} ->", r['verdict'], '*' if r['partial'] else '', '+'.join(sorted(named(r))),
                  [('+'.join(x['effects']), round(x['evidence'], 1)) for x in r['rivals'][:3]] if r['verdict'] != 'effect' else [('+'.join(x['effects']), round(x['evidence'], 1)) for x in r['rivals'][:2]])
