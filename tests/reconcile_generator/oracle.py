"""What a set can tell at best, by the generator's own equations: the signal to noise ratio of each effect after everything else has been fitted
again (baseline, every record's own stiffness and gain, the values of the other effects), and the single rival that comes nearest after the same."""
import numpy as np
import forms as F

GAIN = 0.006  # standard deviation of a record's gain, which every reader of a record has to allow for
COARSE = 3    # steps a sample (the data are made with ten)


class Truth:
    """A rig whose random draws are the same at every call, so that a difference is due to what was changed."""

    def __init__(self, rig, fx, sigma, low, scatter, fitted, sensor):
        """fitted: of each protocol, the records that are not held out: only these may be used to choose a name."""
        self.rig, self.fx, self.sensor = rig, fx, sensor
        self.protocols = [p for p, n in zip(rig.protocols(), fitted) if n > 0]
        records = np.array([n for n in fitted if n > 0], float)
        self.weight = np.sqrt(records / low) / sigma
        self.scale = max(scatter, 0.01) / np.sqrt(records)
        self.gain = GAIN
        self.fine = getattr(rig, 'fine', F.FINE)
        self.measured = self.all(fx, State(self))

    def record(self, k, fx, state):
        rig, F.FINE = self.rig, COARSE
        keep, rng = {n: getattr(rig, n) for n in state.base}, rig.rng
        try:
            for n, factor in state.base.items():
                setattr(rig, n, keep[n] * factor)
            rig.rng = np.random.default_rng(1000 + k)
            t, _, y, _, _ = rig.trial(self.protocols[k], fx, np.exp(state.scale[k]))
            y = self.sensor(rig, t, y[rig.output], fx, rig.top)
            if rig.rig == 'tip-hold':  # every record may drift by a cubic
                u = t / t[-1]
                y = y - np.polynomial.Polynomial.fit(u, y, 3)(u)
            return y[::COARSE if self.fine == 10 else self.fine] * np.exp(state.gain[k])
        finally:
            rig.rng, F.FINE = rng, 10
            for n, v in keep.items():
                setattr(rig, n, v)

    def all(self, fx, state):
        return [self.record(k, fx, state) for k in range(len(self.protocols))]

    def left(self, fx, free, rounds):
        """The measured records less the best fit of these effects, `free` [(effect, value)] fitted too, by Gauss-Newton. sqrt(chi2) and the
        largest rms of a record."""
        fx, state = {e: dict(v) for e, v in fx.items()}, State(self)
        best = (np.inf, np.inf)
        for step in range(rounds + 1):
            y = self.all(fx, state)
            r = [(a - b) * w for a, b, w in zip(self.measured, y, self.weight)]
            prior = np.concatenate([-state.scale / self.scale, -state.gain / self.gain])
            chi = np.sqrt(sum(v @ v for v in r) + prior @ prior)
            if chi < best[0]:
                best = (float(chi), max(float(np.sqrt(np.mean(v ** 2))) / w for v, w in zip(r, self.weight)))
            if step == rounds or not np.isfinite(chi):
                break
            self.move(fx, free, state, y, r, prior)
        return best

    def move(self, fx, free, state, y, r, prior):
        n, m = len(r), len(state.base) + len(free)
        ends = np.cumsum([0] + [len(v) for v in r])
        J = np.zeros((ends[-1] + 2 * n, m + 2 * n))
        slope = lambda k, a, b: (a - b) * self.weight[k] / 1e-3
        for j, q in enumerate(list(state.base) + free):
            f, s = {e: dict(v) for e, v in fx.items()}, state.copy()
            if j < len(state.base):
                s.base[q] *= 1.001
            else:
                f[q[0]][q[1]] *= 1.001
            J[:ends[-1], j] = np.concatenate([slope(k, a, b) for k, (a, b) in enumerate(zip(self.all(f, s), y))])
        for k in range(n):
            s = state.copy()
            s.scale[k] += 1e-3
            J[ends[k]:ends[k + 1], m + k] = slope(k, self.record(k, fx, s), y[k])
            J[ends[k]:ends[k + 1], m + n + k] = y[k] * self.weight[k]
            J[ends[-1] + k, m + k], J[ends[-1] + n + k, m + n + k] = 1 / self.scale[k], 1 / self.gain
        if not np.isfinite(J).all():
            return
        x = np.clip(np.linalg.lstsq(J, np.concatenate(r + [prior]), rcond=1e-9)[0], -0.5, 0.5)
        for j, q in enumerate(list(state.base) + free):
            if j < len(state.base):
                state.base[q] *= np.exp(x[j])
            else:
                fx[q[0]][q[1]] *= np.exp(x[j])
        state.scale, state.gain = state.scale + x[m:m + n], state.gain + x[m + n:]


class State:
    def __init__(self, truth):
        n = len(truth.protocols)
        self.base, self.scale, self.gain = {q: 1.0 for q in truth.rig.refitted}, np.zeros(n), np.zeros(n)

    def copy(self):
        other = object.__new__(State)
        other.base, other.scale, other.gain = dict(self.base), self.scale.copy(), self.gain.copy()
        return other


def values(fx, effect):
    return [(effect, q) for q, v in fx[effect].items() if isinstance(v, float) and v and q not in ('beta', 'power', 'breath', 'taper', 'width' if effect == 'physiological-tremor' else '')]


def signal_to_noise(truth):
    """Of each effect, all else refitted: {effect: (ratio, largest rms of a record)}."""
    out = {}
    for e in truth.fx:
        rest = {q: v for q, v in truth.fx.items() if q != e}
        out[e] = truth.left(rest, [v for q in rest for v in values(rest, q)], 3)
    return out


def nearest_rival(truth, pool, snr):
    """The other single effect that comes nearest, and at how many standard deviations it stays: no farther than the baseline (`snr`), which is a rival of no size."""
    nearest = (snr, '')
    for rival in pool:
        if rival in truth.fx or rival in ('pulsation', 'mains-hum', 'physiological-tremor'):
            continue
        state = truth.rig.rng.bit_generator.state
        starts = [{rival: truth.rig.draw(rival, s)} for s in (0.3, 0.7)]
        truth.rig.rng.bit_generator.state = state
        for fx in starts:
            nearest = min(nearest, (truth.left(fx, values(fx, rival), 3)[0], rival))
    return nearest
