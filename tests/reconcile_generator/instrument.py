"""suture-pull, needle-insertion, forceps-bridge, tip-hold."""
import numpy as np
import forms as F


class Capstan:
    rig, model, free, output = 'suture-pull', 'suture/capstan', ['friction_coefficient'], 'pull_force'
    refitted = ['mu']
    effects = ['speed-dependent-friction', 'bending-stiffness-loss', 'viscous-drag', 'sensor-drift', 'saturation', 'mains-hum']
    outside = ['offset-step', 'stick-slip']

    def __init__(self, rng, effects):
        self.rng = rng
        self.mu = rng.uniform(0.12, 0.35)
        self.hold = np.exp(rng.uniform(np.log(5e-3), np.log(0.1)))
        self.v = rng.uniform(5e-3, 30e-3)
        self.n = int(rng.integers(150, 300))

    def specimen(self):
        return {'diameter': 30e-6, 'cylinder_diameter': 5e-3}

    def protocols(self):
        return [('dry', np.pi / 2, 1.0), ('dry', np.pi, 0.4), ('dry', 2 * np.pi, 0.4), ('dry', np.pi, 1.5)]

    def trial(self, p, fx, scale):
        medium, wrap, level = p
        n = self.n * F.FINE
        t = np.linspace(0, 30, n)
        v = self.v * 10 ** (-2 + 2 * np.abs(((t / 10) % 2) - 1))
        hold = np.full(n, self.hold * level)
        mu = np.full(n, self.mu)
        if 'speed-dependent-friction' in fx:
            q = fx['speed-dependent-friction']
            x = v / q['v_s']
            mu = mu + q['dmu'] * (np.exp(-x) if q['form'] else 1 / (1 + x ** 1.5))
        y = hold * np.exp(mu * scale * wrap)
        top = self.hold * np.exp(self.mu * 2 * np.pi)
        if 'bending-stiffness-loss' in fx:
            y = y + fx['bending-stiffness-loss']['bending_force']
        if 'viscous-drag' in fx:
            y = y + fx['viscous-drag']['drag'] * v
        if 'offset-step' in fx:
            y = y + fx['offset-step']['size'] * top * 0.5 * ((t > 9) & (t < 18))
        if 'stick-slip' in fx:
            y = y * (1 + fx['stick-slip']['size'] * ((np.cumsum(v) * (t[1] - t[0]) / (self.v * 1.3)) % 1.0 - 0.5))
        return t, {'speed': v, 'hold_force': hold, 'wrap_angle': np.full(n, wrap)}, {'pull_force': y}, {'medium': medium}, {}

    def draw(self, name, s):
        r = self.rng
        top = self.hold * np.exp(self.mu * np.pi)
        return {
            'speed-dependent-friction': lambda: {'dmu': self.mu * (0.1 + 0.5 * s), 'v_s': self.v * 10 ** r.uniform(-1.5, -0.4), 'form': r.random() < 0.6},
            'bending-stiffness-loss': lambda: {'bending_force': top * (0.06 + 0.3 * s)},
            'viscous-drag': lambda: {'drag': top * (0.08 + 0.3 * s) / self.v},
            'sensor-drift': lambda: {'size': top * (0.06 + 0.2 * s), 'log': r.random() < 0.4},
            'saturation': lambda: {'share': 0.85 - 0.3 * s},
            'mains-hum': lambda: {'frequency': r.choice([50.0, 60.0]) + r.uniform(-0.05, 0.05), 'amplitude': top * (0.03 + 0.08 * s)},
            'offset-step': lambda: {'size': 0.06 + 0.15 * s},
            'stick-slip': lambda: {'size': 0.1 + 0.25 * s},
        }[name]()


class Needle:
    rig, model, free, output = 'needle-insertion', 'needle/linear', ['stiffness', 'puncture_force'], 'force'
    refitted = ['k']
    effects = ['layer-rupture', 'shaft-friction', 'viscous-drag', 'sensor-lag', 'sensor-drift', 'saturation', 'mains-hum']  # a load train in series is a softer needle tissue: not testable
    outside = ['offset-step', 'square-drag']

    def __init__(self, rng, effects):
        self.rng = rng
        self.k = np.exp(rng.uniform(np.log(20), np.log(400)))
        self.dp = rng.uniform(2e-3, 6e-3)
        self.deep = self.dp * rng.uniform(2.5, 4)
        self.v = rng.uniform(0.5e-3, 3e-3)
        self.n = int(rng.integers(300, 600))

    def specimen(self):
        return {'needle_diameter': 0.5e-3, 'wall_thickness': 0.1e-3}

    def protocols(self):
        return [(1.0,), (4.0,)]

    def trial(self, p, fx, scale):
        speed = p[0] * self.v
        ramp = self.deep / speed
        T = 2 * ramp + 0.4 * ramp
        t = np.linspace(0, T, self.n * F.FINE)
        x = np.interp(t, [0, ramp, 1.4 * ramp, T], [0, self.deep, self.deep, 0])
        v = np.where(t < ramp, speed, np.where(t < 1.4 * ramp, 0.0, -speed))
        dp = self.dp * (1 + 0.03 * self.rng.standard_normal())
        through = np.maximum.accumulate(x) > dp
        k = self.k * scale
        y = np.where(through, 0.0, k * x)
        sign = np.where(t < 1.4 * ramp, 1.0, -1.0)
        if 'layer-rupture' in fx:
            q = fx['layer-rupture']
            for share, at in zip(q['forces'], q['depths']):
                d2 = at * (1 + 0.02 * self.rng.standard_normal())
                f2 = share * self.k * self.dp * scale
                rise = np.clip((x - (d2 - f2 / k)) / (f2 / k), 0, 1)
                y = y + np.where((np.maximum.accumulate(x) < d2) & through, f2 * rise ** q['power'], 0.0)
        if 'shaft-friction' in fx:
            y = y + np.where(through, fx['shaft-friction']['friction_per_length'] * x * sign, 0.0)
        if 'viscous-drag' in fx:
            y = y + np.where(through & (x > 0), fx['viscous-drag']['drag'] * v, 0.0)
        top = self.k * self.dp
        if 'offset-step' in fx:
            y = y + fx['offset-step']['size'] * top * ((t > 0.5 * T) & (t < 0.75 * T))
        if 'square-drag' in fx:
            y = y + fx['square-drag']['size'] * top * (x / self.deep) ** 3 * (t < ramp) * through
        return t, {'depth': x, 'speed': v}, {'force': y}, {'layers': '1'}, {}

    def draw(self, name, s):
        r = self.rng
        top = self.k * self.dp
        two = r.random() < 0.3
        at = [self.dp + (self.deep - self.dp) * q for q in ([0.45, 0.9] if two else [r.uniform(0.5, 0.85)])]
        return {
            'layer-rupture': lambda: {'forces': [0.3 + 0.5 * s] * len(at), 'depths': at, 'power': 1.0 if r.random() < 0.7 else 1.2},
            'shaft-friction': lambda: {'friction_per_length': top * (0.08 + 0.4 * s) / self.deep},
            'viscous-drag': lambda: {'drag': top * (0.05 + 0.25 * s) / (4 * self.v)},
            'sensor-lag': lambda: {'time_constant': self.deep / self.v * (0.004 + 0.01 * s), 'poles': 1, 'delay': False},
            'sensor-drift': lambda: {'size': top * (0.06 + 0.2 * s), 'log': r.random() < 0.4},
            'saturation': lambda: {'share': 0.85 - 0.3 * s},
            'mains-hum': lambda: {'frequency': r.choice([50.0, 60.0]) + r.uniform(-0.05, 0.05), 'amplitude': top * (0.02 + 0.06 * s)},
            'offset-step': lambda: {'size': 0.08 + 0.2 * s},
            'square-drag': lambda: {'size': 0.1 + 0.3 * s},
        }[name]()


class Forceps:
    rig, model, output = 'forceps-bridge', 'forceps/linear', 'strain_counts'
    refitted = ['gain', 'offset']
    free = ['strain_gain', 'strain_offset', 'pressure_gain', 'pressure_offset']
    effects = ['temperature-drift', 'bridge-nonlinearity', 'hysteresis', 'cross-talk', 'sensor-lag', 'sensor-drift', 'saturation', 'mains-hum']
    outside = ['offset-step', 'dead-angle']

    def __init__(self, rng, effects):
        self.rng = rng
        self.gain, self.offset = rng.uniform(4000, 9000), rng.uniform(300, 900)
        self.pgain, self.poffset = rng.uniform(400, 1000), rng.uniform(50, 200)
        self.n = int(rng.integers(250, 500))
        self.thermo = 'temperature-drift' in effects or rng.random() < 0.5
        self.has_T = self.thermo and rng.random() < 0.8

    def specimen(self):
        return {'bits': 14, 'reference': 3.3}

    def protocols(self):
        return [('closing',), ('opening',)]

    def trial(self, p, fx, scale):
        T = 60.0
        n = self.n * F.FINE
        t = np.linspace(0, T, n)
        top = 0.5
        saw = np.abs(((t / T * 3) % 2) - 1)
        a = top * (saw if p[0] == 'closing' else 1 - saw)
        g = 2.0 * np.clip(np.sin(2 * np.pi * t / T * 2.3 + self.rng.uniform(0, 6)), 0, None)
        Tc = 293 + 6 * np.sin(2 * np.pi * t / T * 0.6 + self.rng.uniform(0, 6)) + t / T
        x = a.copy()
        if 'hysteresis' in fx:
            x = F.bouc_wen(x, fx['hysteresis']['width'])
        y = self.offset + self.gain * scale * x
        span = self.gain * top
        if 'bridge-nonlinearity' in fx:
            q = fx['bridge-nonlinearity']['q']
            y = self.offset + span * scale * ((x / top) / (1 + q * x / top) * (1 + q))
        if 'temperature-drift' in fx:
            v = fx['temperature-drift']
            y = y + (v['offset_per_kelvin'] * (Tc - 293) if self.has_T else v['offset_per_kelvin'] * 6 * (1 - np.exp(-t / v['warm'])))
        if 'cross-talk' in fx:
            y = y + fx['cross-talk']['gain'] * g
        if 'offset-step' in fx:
            y = y + fx['offset-step']['size'] * span * ((t > 0.35 * T) & (t < 0.7 * T))
        if 'dead-angle' in fx:
            y = y + fx['dead-angle']['size'] * span * np.exp(-((x / top - 0.5) / 0.12) ** 2)
        z = self.poffset + self.pgain * scale * g
        inputs = {'angle': a, 'grip_force': g}
        if self.has_T:
            inputs['temperature'] = Tc
        return t, inputs, {'strain_counts': y, 'pressure_counts': z}, {'direction': p[0]}, {}

    def draw(self, name, s):
        r = self.rng
        span = self.gain * 0.5
        return {
            'temperature-drift': lambda: {'offset_per_kelvin': span * (0.006 + 0.02 * s), 'warm': r.uniform(8, 30)},
            'bridge-nonlinearity': lambda: {'q': r.choice([-1, 1]) * (0.06 + 0.25 * s)},
            'hysteresis': lambda: {'width': 0.5 * (0.04 + 0.12 * s)},
            'cross-talk': lambda: {'gain': span * (0.015 + 0.05 * s)},
            'sensor-lag': lambda: {'time_constant': 60 * (0.003 + 0.008 * s), 'poles': int(r.integers(1, 3)), 'delay': r.random() < 0.3},
            'sensor-drift': lambda: {'size': span * (0.05 + 0.15 * s), 'log': r.random() < 0.4},
            'saturation': lambda: {'share': 0.85 - 0.3 * s},
            'mains-hum': lambda: {'frequency': r.choice([50.0, 60.0]) + r.uniform(-0.05, 0.05), 'amplitude': span * (0.02 + 0.05 * s)},
            'offset-step': lambda: {'size': 0.05 + 0.12 * s},
            'dead-angle': lambda: {'size': 0.06 + 0.15 * s},
        }[name]()


class Hold:
    rig, model, free, output = 'tip-hold', 'hand/still', [], 'x'
    refitted = []
    effects = ['physiological-tremor', 'pulsation', 'mains-hum']
    outside = ['offset-step', 'slow-tremor']

    def __init__(self, rng, effects):
        self.rng = rng
        self.rate = rng.choice([60.0, 100.0, 200.0])
        self.T = rng.uniform(15, 40)
        self.sigma = rng.uniform(2e-6, 10e-6)
        self.n = int(self.T * self.rate)

    def specimen(self):
        return {'sensor': 'optical'}

    def protocols(self):
        return [('free',), ('wrist-rest',)]

    def trial(self, p, fx, scale):
        t = np.linspace(0, self.T, self.n)
        out = {}
        for axis in 'xyz':
            c = self.rng.standard_normal(4) * self.sigma * 10
            u = t / self.T
            y = c[0] + c[1] * u + c[2] * u ** 2 + c[3] * u ** 3
            if 'physiological-tremor' in fx:
                v = fx['physiological-tremor']
                w0, z = 2 * np.pi * v['frequency'], v['width'] / v['frequency']
                h, s, ds, rec = t[1] - t[0], 0.0, 0.0, np.empty_like(t)
                for i in range(len(t)):
                    for _ in range(4):
                        ds += (-w0 ** 2 * s - 2 * z * w0 * ds) * h / 4 + np.sqrt(h / 4) * self.rng.standard_normal()
                        s += ds * h / 4
                    rec[i] = s
                y = y + rec / rec.std() * v['rms']
            if 'pulsation' in fx:
                y = y + F.beat(t, self.rng, fx['pulsation']['frequency'], fx['pulsation']['amplitude'], fx['pulsation']['breath'])
            if 'slow-tremor' in fx:
                v = fx['slow-tremor']
                rec = np.convolve(self.rng.standard_normal(len(t) + 400), np.sin(2 * np.pi * 4 * np.arange(400) / self.rate) * np.exp(-np.arange(400) / self.rate * 4), 'valid')[:len(t)]
                y = y + rec / rec.std() * v['rms']
            if 'offset-step' in fx:
                y = y + fx['offset-step']['size'] * (t > fx['offset-step']['at'] * self.T)
            out[axis] = y
        return t, {}, out, {'support': p[0]}, {}

    fine = 1

    def draw(self, name, s):
        r = self.rng
        q = self.sigma * (0.8 + 3 * s)
        return {
            'physiological-tremor': lambda: {'frequency': r.uniform(8.3, 11.5), 'rms': q, 'width': r.uniform(0.15, 0.5)},
            'pulsation': lambda: {'frequency': r.uniform(0.85, 1.9), 'amplitude': q, 'breath': r.choice([0.0, 0.0, 0.6])},
            'mains-hum': lambda: {'frequency': r.choice([50.0, 60.0]) + r.uniform(-0.05, 0.05), 'amplitude': q},
            'slow-tremor': lambda: {'rms': q},
            'offset-step': lambda: {'size': 6 * q, 'at': r.uniform(0.3, 0.7)},
        }[name]()
