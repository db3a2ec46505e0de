#!/usr/bin/python3
"""Labelled datasets with a hidden effect: generate.py OUT SEED COUNT [RIG...] [null]. Data go to OUT/data, labels to OUT/labels;
with rigs only theirs, with "null" only sets in which nothing is missing.
Kinds: null, wrong-parameter, single, double, outside, unidentifiable. Nuisances that must not be named: gain errors to 1 %, jitter of the
clock, 12-16 bits, scatter of specimens, AR(1) or mixed noise of 0.5-10 % of full scale."""
import csv
import json
import os
import sys
import numpy as np
import forms as F
import oracle
from instrument import Capstan, Forceps, Hold, Needle
from mechanical import Cantilever, Spatula, Tissue, Vessel

RIGS = [Tissue, Spatula, Vessel, Cantilever, Capstan, Needle, Forceps, Hold]
KINDS = ['null'] * 3 + ['wrong-parameter'] * 1 + ['single'] * 9 + ['double'] * 3 + ['outside'] * 3 + ['unidentifiable'] * 1
UNITS = {'displacement': ('mm', 1e3), 'depth': ('mm', 1e3), 'force': ('mN', 1e3), 'pull_force': ('mN', 1e3), 'hold_force': ('mN', 1e3), 'pressure': ('kPa', 1e-3),
         'outer_diameter': ('um', 1e6), 'overhang': ('mm', 1e3), 'tip_drop': ('mm', 1e3), 'tip_reach': ('mm', 1e3), 'speed': ('mm/s', 1e3), 'wrap_angle': ('deg', 180 / np.pi), 'angle': ('deg', 180 / np.pi),
         'grip_force': ('N', 1.0), 'temperature': ('degC', 1.0), 'strain_counts': ('count', 1.0), 'pressure_counts': ('count', 1.0), 'x': ('um', 1e6), 'y': ('um', 1e6), 'z': ('um', 1e6)}


def sensor(rig, t, y, fx, top):
    if 'sensor-lag' in fx:
        v = fx['sensor-lag']
        y = F.delayed(t, y, v['time_constant']) if v['delay'] else F.lagged(t, y, v['time_constant'], v['poles'])
    if 'sensor-drift' in fx:
        v, x = fx['sensor-drift'], t / rig.span
        y = y + v['size'] * (np.log1p(30 * x) / np.log(31) if v['log'] else x)
    if 'saturation' in fx:
        rest = y[0] if rig.rig == 'vessel-inflation' else 0.0  # a diameter is clipped above what it is at rest
        y = np.clip(y - rest, -fx['saturation']['share'] * (top - rest), fx['saturation']['share'] * (top - rest)) + rest
    if 'mains-hum' in fx:
        v = fx['mains-hum']
        y = y + v['amplitude'] * np.sin(2 * np.pi * v['frequency'] * t + rig.rng.uniform(0, 6.28))
    return y


def measure(rig, fx, scatter, replicates):
    """All trials: (protocol, letter, sampled time, inputs, clean outputs, specimen)."""
    out = []
    top, span = 0.0, 0.0
    for p in rig.protocols():
        t, x, y, _, _ = rig.trial(p, {}, 1.0)
        top, span = max(top, np.abs(y[rig.output]).max()), max(span, t[-1])
    rig.span, rig.top = span, top
    for k, p in enumerate(rig.protocols()):
        for _ in range(replicates):
            t, x, y, protocol, specimen = rig.trial(p, fx, np.exp(scatter * rig.rng.standard_normal()))
            y = {c: sensor(rig, t, v, fx, top) if c == rig.output or rig.rig == 'tip-hold' else v for c, v in y.items()}
            step = getattr(rig, 'fine', F.FINE) if getattr(rig, 'fine', F.FINE) > 1 else 1
            start = int(rig.rng.integers(0, step)) if step > 1 else 0
            pick = slice(start, None, step)
            out.append((protocol, 'ABCDEFGH'[k], t[pick] - t[start], {c: v[pick] for c, v in x.items()}, {c: v[pick] for c, v in y.items()}, specimen))
    return out


def noise(rng, n, sigma, rho, white):
    e = rng.standard_normal(n)
    r = np.empty(n)
    r[0] = e[0]
    for i in range(1, n):
        r[i] = rho * r[i - 1] + np.sqrt(1 - rho ** 2) * e[i]
    return sigma * (np.sqrt(1 - white) * r + np.sqrt(white) * rng.standard_normal(n))


def nuisances(rig, outputs, seed):
    """Of the instrument: (its generator of random numbers, gains, bits, is the noise stated, are records held out)."""
    rng = np.random.default_rng(seed + 7)
    gain = {c: 1 + rng.uniform(-0.01, 0.01) for c in outputs}
    if rig.rig in ('vessel-inflation',):
        gain = {c: 1 + rng.uniform(-0.003, 0.003) for c in outputs}
    bits = rng.integers(12, 17)
    stated = rng.random() < 0.6
    return rng, gain, bits, stated, rng.random() < 0.4


def held(i):
    return i % 5 == 4


def build(cls, kind, seed):
    rng = np.random.default_rng(seed)
    pool = cls.effects
    names = []
    if kind in ('single', 'unidentifiable'):
        names = [str(rng.choice(pool))]
    elif kind == 'double':
        names = [str(n) for n in rng.choice(pool, 2, replace=False)]
    elif kind == 'outside':
        names = [str(rng.choice(cls.outside))]
    if kind == 'unidentifiable' and cls is Tissue:
        names = [str(rng.choice(['rig-compliance', 'tension-compression-asymmetry', 'poroelastic-drainage']))]
    rig = cls(rng, names)
    if kind == 'unidentifiable' and cls is Tissue:
        rig.two, rig.shear, rig.free = False, False, ['youngs_modulus']
        rig.protocols = lambda: [('compression', 1.0, 1.0), ('compression', 3.0, 1.0)]
    # three in four of the single effects are to be hard to see: weak ones, in as much noise as brings them to a signal to noise ratio of 4-8
    faint = rng.uniform(4, 8) if kind == 'single' and cls is not Hold and rng.random() < 0.75 else 0.0
    fx = {n: rig.draw(n, rng.uniform(-0.1, 0.4) if faint else rng.uniform(0.1, 1.0)) for n in names}
    scatter = 0.0 if cls in (Forceps, Hold) else rng.choice([0.0, 0.05, 0.08])
    replicates = int(rng.integers(2, 4))
    if cls is Cantilever:
        replicates = 2
    trials = measure(rig, fx, scatter, replicates)
    outputs = list(trials[0][4])
    full = {c: max(np.concatenate([tr[4][c] for tr in trials])) - min(np.concatenate([tr[4][c] for tr in trials])) for c in outputs}
    if cls is Hold:
        sigma, rho, white = {c: rig.sigma for c in outputs}, 0.0, 1.0
    else:
        level = np.exp(rng.uniform(np.log(0.005), np.log(0.05 if kind in ('single', 'double', 'outside') else 0.1)))
        sigma = {c: level * full[c] for c in outputs}
        rho, white = rng.choice([0.0, 0.3, 0.6, 0.85]), rng.choice([0.0, 0.5])
    snr, worst, rival = 0.0, 0.0, (np.inf, '')
    if names:
        low = (1 - white) * (1 + rho) / (1 - rho) + white  # of slow noise; a line stands in faster, quieter bands
        hold_out = nuisances(rig, outputs, seed)[4]
        fitted = [sum(not (hold_out and held(k * replicates + j)) for j in range(replicates)) * (3 if cls is Hold else 1) for k in range(len(trials) // replicates)]
        judge = lambda: oracle.Truth(rig, fx, sigma[rig.output], low, scatter, fitted, sensor)
        truth = judge()
        told = oracle.signal_to_noise(truth)
        if faint and told[names[0]][0] > faint and level * told[names[0]][0] / faint < 0.1:
            sigma = {c: v * told[names[0]][0] / faint for c, v in sigma.items()}
            truth = judge()  # in the noise that the data get
            told = oracle.signal_to_noise(truth)
        snr, worst = min(v[0] for v in told.values()), min(v[1] for v in told.values())
        if kind == 'single':
            rival = oracle.nearest_rival(truth, pool, snr)
        if kind != 'unidentifiable' and (snr < 4 or worst < (0.3 * rig.sigma if cls is Hold else 0.012 * full[rig.output])):
            return None
    return rig, fx, trials, sigma, rho, white, full, snr, names, scatter, rival


def write(out, name, kind, made, seed):
    rig, fx, trials, sigma, rho, white, full, snr, names, scatter, rival = made
    folder = os.path.join(out, 'data', name)
    os.makedirs(folder, exist_ok=True)
    inputs, outputs = list(trials[0][3]), list(trials[0][4])
    rng, gain, bits, stated, hold_out = nuisances(rig, outputs, seed)
    lines = ['format: filum-experiment/1', f'title: "{rig.rig} {name}"', 'source: simulated', f'rig: {rig.rig}',
             'specimen: { ' + ', '.join(f'{k}: {text(k, v)}' for k, v in rig.specimen().items()) + ' }', 'model:', f'  file: {rig.model}', '  free: [' + ', '.join(rig.free) + ']']
    if kind == 'wrong-parameter' and rig.free and rig.free[0] == 'youngs_modulus':
        lines.append(f'  prior: {{ youngs_modulus: ["{rig.E / 4:.6g} Pa", "{rig.E * 4:.6g} Pa"] }}')
    lines += ['channels:', '  - { name: time, column: t_s, unit: s }']
    for c in inputs:
        lines.append(f'  - {{ name: {c}, column: {c}, unit: {UNITS[c][0]}, kind: input }}')
    for c in outputs:
        n = f', noise: "{sigma[c] * UNITS[c][1]:.5g} {UNITS[c][0]}"' if stated else ''
        lines.append(f'  - {{ name: {c}, column: {c}, unit: {UNITS[c][0]}, kind: output{n} }}')
    lines.append('trials:')
    for i, (protocol, letter, t, x, y, specimen) in enumerate(trials):
        file = f'run-{i + 1:02d}.csv'
        dt = t[1] - t[0]
        jitter = 0.0 if rig.rig == 'tip-hold' else 0.05
        cols = {'t_s': t}
        for c in inputs:
            cols[c] = (x[c] - 273.15 if c == 'temperature' else x[c]) * UNITS[c][1]
        for c in outputs:
            true = np.interp(t + jitter * dt * rng.standard_normal(len(t)), t, y[c])
            v = gain[c] * true + noise(rng, len(t), sigma[c], rho, white)
            q = full[c] * 1.6 / 2 ** bits if c not in ('strain_counts', 'pressure_counts') else 1.0
            v = np.round(v / q) * q
            if 'saturation' in fx and c == rig.output and rig.rig != 'tip-hold':
                pass
            cols[c] = v * UNITS[c][1]
        with open(os.path.join(folder, file), 'w', newline='') as f:
            w = csv.writer(f)
            w.writerow(cols)
            for row in zip(*cols.values()):
                w.writerow(['%.7g' % v for v in row])
        extra = ', specimen: { ' + ', '.join(f'{k}: {text(k, v)}' for k, v in specimen.items()) + ' }' if specimen else ''
        kept = ', hold_out: true' if hold_out and held(i) else ''
        lines.append(f'  - {{ file: {file}, protocol: {{ ' + ', '.join(f'{k}: "{v}"' for k, v in protocol.items()) + f' }}, repeat: {letter}{extra}{kept} }}')
    open(os.path.join(folder, 'experiment.yaml'), 'w').write('\n'.join(lines) + '\n')
    os.makedirs(os.path.join(out, 'labels'), exist_ok=True)
    json.dump({'kind': kind, 'rig': rig.rig, 'effects': names, 'parameters': fx, 'snr': float(snr), 'rival': rival[1], 'distance': float(rival[0]) if np.isfinite(rival[0]) else None, 'solver': F.SOLVER, 'rho': float(rho), 'white': float(white), 'seed': seed, 'scatter': float(scatter)},
              open(os.path.join(out, 'labels', name + '.json'), 'w'), default=lambda o: o.item())


def text(key, v):
    if isinstance(v, str):
        return v
    if key == 'density':
        return f'"{v:.6g} kg/m3"'
    if key == 'bits':
        return str(v)
    if key == 'reference':
        return f'"{v} V"'
    return f'"{v * 1e3:.7g} mm"'


def main():
    out, seed, count = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    only = [word for word in sys.argv[4:] if word != 'null'] or None
    kinds = ['null'] * 3 + ['wrong-parameter'] if 'null' in sys.argv[4:] else KINDS
    for i in range(count):
        cls = RIGS[i % len(RIGS)]
        kind = kinds[(i // len(RIGS)) % len(kinds)]
        if only and cls.rig not in only:
            continue
        if os.path.exists(os.path.join(out, 'labels', f'{cls.rig}-{i:04d}.json')):
            continue
        if kind == 'wrong-parameter' and not cls.free:
            kind = 'null'
        for attempt in range(40):
            s = seed * 1000003 + i * 101 + attempt
            made = build(cls, kind, s)
            if made:
                write(out, f'{cls.rig}-{i:04d}', kind, made, s)
                break


main()
