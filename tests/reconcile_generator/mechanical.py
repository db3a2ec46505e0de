"""tissue-block, spatula-press, vessel-inflation, suture-cantilever."""
import numpy as np
from scipy.optimize import brentq
import forms as F


def ramp_hold(T, n, peak, cycles, hold_share, rest_share):
    """Piecewise linear cycles of load, hold, unload, rest, the last one without its rest."""
    ramp = (1 - hold_share - rest_share) / 2
    knots, values, at = [0.0], [0.0], 0.0
    for _ in range(cycles):
        for dur, val in ((ramp, peak), (hold_share, peak), (ramp, 0.0), (rest_share, 0.0)):
            at += dur / cycles
            knots.append(at)
            values.append(val)
    t = np.linspace(0, T, n)
    return t, np.interp(t / T, knots, values)


class Tissue:
    rig, model, free, output, refitted = 'tissue-block', 'brain/linear', ['youngs_modulus'], 'force', ['E']
    effects = ['viscoelastic-relaxation', 'strain-stiffening', 'tension-compression-asymmetry', 'first-cycle-softening', 'permanent-set',
               'poroelastic-drainage', 'contact-adhesion', 'platen-friction', 'rig-compliance', 'pulsation', 'hysteresis', 'sensor-lag',
               'sensor-drift', 'saturation', 'mains-hum']
    outside = ['damage', 'offset-step', 'square-drag', 'stick-slip', 'stiff-patch']

    def __init__(self, rng, effects):
        self.rng = rng
        self.E = np.exp(rng.uniform(np.log(400), np.log(5000)))
        self.round = rng.random() < 0.4
        self.h = rng.uniform(4e-3, 12e-3)
        self.w = self.h * rng.uniform(0.8, 1.6)
        self.peak = rng.uniform(0.08, 0.25)
        self.rate = np.exp(rng.uniform(np.log(0.02), np.log(0.2)))  # strain per second of the slow ramp
        self.shear = rng.random() < 0.5
        self.two = rng.random() < 0.35 or bool({'platen-friction', 'rig-compliance', 'poroelastic-drainage'} & set(effects))
        self.liftoff = 'contact-adhesion' in effects or rng.random() < 0.15
        self.n = int(rng.integers(220, 500))
        if self.shear:
            self.free, self.refitted = ['youngs_modulus', 'poissons_ratio'], ['E', 'nu']
        self.nu = rng.uniform(0.42, 0.49)

    def specimen(self):
        s = {'shape': 'cylinder', 'diameter': self.w} if self.round else {'shape': 'cuboid', 'length': self.w, 'width': self.w * 1.0}
        return {**s, 'height': self.h}

    def protocols(self):
        out = []
        cases = [('compression', 1.0), ('compression', 8.0), ('tension', 2.0)] + ([('shear', 2.0)] if self.shear else [])
        for mode, speed in cases:
            out.append((mode, speed, 1.0))
        if self.two:
            out.append(('compression', 1.0, 0.45))
        return out

    def trial(self, p, fx, scale, n=None):
        mode, speed, size = p
        h, w = self.h * size, self.w
        e_peak = self.peak * (-1 if mode == 'compression' else 1)
        T = 2 * self.peak / (self.rate * speed) * 2 / 0.4
        t, u = ramp_hold(T, self.n * F.FINE, e_peak * h, 2, 0.35, 0.25)
        if self.liftoff and mode == 'compression':
            u = u + np.clip((t - 0.94 * T) / (0.06 * T), 0, 1) * 0.25 * abs(e_peak) * h
        area = np.pi / 4 * w * w if self.round else w * w
        K = self.E * scale * area / h
        G = K / (2 * (1 + self.nu))
        x = u.copy()
        if 'hysteresis' in fx:
            x = F.bouc_wen(x, fx['hysteresis']['width'])
        k_lin = G if mode == 'shear' else K
        if 'platen-friction' in fx and mode != 'shear':
            m = fx['platen-friction']['friction_coefficient'] * w / h
            k_lin = k_lin * (np.exp(0.66 * m) - 1) / (0.66 * m)
        stiff_patch = fx.get('stiff-patch')

        def law(x):
            e = x / h
            peak_e = np.maximum.accumulate(np.abs(e)) * np.sign(e_peak)
            if 'permanent-set' in fx:
                e = e - fx['permanent-set']['fraction'] * peak_e
            s = e
            i1 = e ** 2 if mode == 'shear' else (1 + e) ** 2 + 2 / np.maximum(1 + e, 0.1) - 3
            if 'strain-stiffening' in fx:
                r = fx['strain-stiffening']['c20_over_c10']
                s = e * (1 + 2 * r * i1) if fx['strain-stiffening']['form'] else e / (1 - np.minimum(0.9, 1.8 * r * i1))
            if 'tension-compression-asymmetry' in fx and mode != 'shear':
                a = fx['tension-compression-asymmetry']['alpha']
                s = 2 / (3 * a) * ((1 + e) ** (a - 1) - (1 + e) ** (-a / 2 - 1))
            if 'tension-compression-asymmetry' in fx and mode == 'shear':
                a = fx['tension-compression-asymmetry']['alpha']
                l = e / 2 + np.sqrt(1 + e * e / 4)
                s = (l ** a - l ** -a) / a / np.sqrt(4 + e * e)
            if 'first-cycle-softening' in fx:
                s = s * F.softening(e, fx['first-cycle-softening']['d'], fx['first-cycle-softening']['w0'])
            if stiff_patch:
                s = s + stiff_patch['k'] * np.maximum(0, np.abs(e) - 0.55 * self.peak) * np.sign(e) * (np.gradient(np.abs(e)) > 0)
            return k_lin * h * s
        f = law(x)
        if 'rig-compliance' in fx:
            for _ in range(60):
                c = fx['rig-compliance']['compliance']
                f = 0.5 * f + 0.5 * law(x - c * f * (1 - 0.1 * np.abs(c * f) / (np.abs(x).max() + 1e-12)))
        if 'viscoelastic-relaxation' in fx:
            v = fx['viscoelastic-relaxation']
            f = F.zener(t, f, v['g1'], v['tau1']) if v['form'] else F.stretched(t, f, v['g1'], v['tau1'], v['beta'])
        if 'poroelastic-drainage' in fx and mode != 'shear':
            v = fx['poroelastic-drainage']
            f = F.consolidation(t, f, v['share'], v['diffusivity'], w / 2 if v['radial'] else h, v['radial'])
        if 'square-drag' in fx:
            v = np.gradient(u, t) / h
            f = f + fx['square-drag']['k'] * K * h * self.peak * v * np.abs(v) / (self.rate * 8) ** 2
        if 'damage' in fx:
            f = f * np.where(t > fx['damage']['at'] * T, 1 - fx['damage']['drop'], 1.0)
        if 'offset-step' in fx:
            f = f + fx['offset-step']['size'] * K * h * self.peak * ((t > fx['offset-step']['at'] * T) & (t < fx['offset-step']['at'] * T + 0.3 * T))
        if 'stick-slip' in fx:
            f = f + fx['stick-slip']['size'] * K * h * self.peak * ((np.abs(u) / h * 30) % 1.0 - 0.5) * (np.abs(np.gradient(u)) > 1e-12)
        if self.liftoff and mode == 'compression':
            gap = u > 0
            f = np.where(gap, 0.0, f)
            if 'contact-adhesion' in fx:
                pull, reach = fx['contact-adhesion']['pull_off'], fx['contact-adhesion']['reach'] * abs(e_peak) * h
                f = np.where(gap & (t > 0.5 * T), pull * getattr(self, 'area', area) * np.clip(np.minimum(u / (0.1 * reach), (reach - u) / (0.9 * reach)), 0, 1), f)
        if 'pulsation' in fx:
            f = f + F.beat(t, self.rng, fx['pulsation']['frequency'], fx['pulsation']['amplitude'], fx['pulsation']['breath'])
        return t, {'displacement': u}, {'force': f}, {'mode': mode, 'rate': ('%.5g mm/s' % (1e3 * self.rate * speed * h))}, ({'height': h} if size != 1 else {})

    def draw(self, name, s):
        """Parameters of an effect at strength s (about 0.2-1)."""
        r = self.rng
        F0 = self.E * self.w ** 2 * self.peak
        T = 2 * self.peak / self.rate * 2 / 0.4
        return {
            'viscoelastic-relaxation': lambda: {'g1': 0.15 + 0.4 * s, 'tau1': T * np.exp(r.uniform(-4, -1.6)), 'form': r.random() < 0.6, 'beta': r.uniform(0.55, 0.8)},
            'strain-stiffening': lambda: {'c20_over_c10': (0.05 + 0.3 * s) / (3 * self.peak ** 2), 'form': r.random() < 0.6},
            'tension-compression-asymmetry': lambda: {'alpha': -3 - 18 * s * 0.15 / self.peak},
            'first-cycle-softening': lambda: {'d': 0.08 + 0.3 * s, 'w0': 0.5 * self.peak ** 2 * r.uniform(0.15, 0.5)},
            'permanent-set': lambda: {'fraction': 0.03 + 0.15 * s},
            'poroelastic-drainage': lambda: (lambda rad: {'share': 0.15 + 0.35 * s, 'radial': rad, 'diffusivity': (self.w / 2 if rad else self.h) ** 2 / T * r.uniform(0.3, 1.5)})(r.random() < 0.5),
            'contact-adhesion': lambda: {'pull_off': self.E * self.peak * (0.05 + 0.2 * s), 'reach': r.uniform(0.08, 0.2)},
            'platen-friction': lambda: {'friction_coefficient': 0.15 + 0.5 * s},
            'rig-compliance': lambda: {'compliance': (0.1 + 0.5 * s) * self.h / (self.E * self.w ** 2)},
            'pulsation': lambda: {'frequency': r.uniform(0.85, 1.9), 'amplitude': F0 * (0.02 + 0.06 * s), 'breath': r.choice([0.0, 0.0, 0.6])},
            'hysteresis': lambda: {'width': self.h * self.peak * (0.04 + 0.12 * s)},
            'sensor-lag': lambda: {'time_constant': T * (0.002 + 0.006 * s), 'poles': int(r.integers(1, 3)), 'delay': r.random() < 0.3},
            'sensor-drift': lambda: {'size': F0 * (0.06 + 0.15 * s), 'log': r.random() < 0.4},
            'saturation': lambda: {'share': 0.85 - 0.3 * s},
            'mains-hum': lambda: {'frequency': r.choice([50.0, 60.0]) + r.uniform(-0.05, 0.05), 'amplitude': F0 * (0.02 + 0.05 * s)},
            'damage': lambda: {'at': r.uniform(0.2, 0.7), 'drop': 0.15 + 0.2 * s},
            'offset-step': lambda: {'at': r.uniform(0.2, 0.6), 'size': 0.06 + 0.15 * s},
            'square-drag': lambda: {'k': 0.1 + 0.3 * s},
            'stick-slip': lambda: {'size': 0.1 + 0.2 * s},
            'stiff-patch': lambda: {'k': 0.8 + 1.5 * s},
        }[name]()


class Spatula(Tissue):
    rig, output = 'spatula-press', 'force'
    effects = ['viscoelastic-relaxation', 'strain-stiffening', 'first-cycle-softening', 'permanent-set', 'poroelastic-drainage', 'contact-adhesion', 'pulsation',
               'sensor-lag', 'sensor-drift', 'saturation', 'mains-hum']

    def __init__(self, rng, effects):
        super().__init__(rng, effects)
        self.free, self.refitted, self.shear, self.liftoff = ['youngs_modulus'], ['E'], False, 'contact-adhesion' in effects
        self.round = False
        self.H = rng.uniform(15e-3, 30e-3)
        self.h = self.H
        self.w = rng.uniform(5e-3, 10e-3)
        self.two = 'poroelastic-drainage' in effects or rng.random() < 0.3

    def specimen(self):
        return {'shape': 'box', 'length': 60e-3, 'width': 50e-3, 'height': self.H, 'blade_length': self.w * 2, 'blade_width': self.w}

    def protocols(self):
        return [('compression', 1.0, 1.0), ('compression', 6.0, 1.0)] + ([('compression', 1.0, 2.0)] if self.two else [])

    def trial(self, p, fx, scale):
        mode, speed, size = p
        w = self.w
        if size != 1:
            fx = {k: dict(v) for k, v in fx.items()}
            if 'poroelastic-drainage' in fx:
                fx['poroelastic-drainage']['diffusivity'] /= size ** 2
        t, x, y, prot, _ = Tissue.trial(self, (mode, speed, 1.0), fx, scale * self.punch(size))
        prot = {'rate': prot['rate'], 'hold': '%.4g s' % (0.17 * t[-1])}
        return t, {'depth': -x['displacement']}, {'force': -y['force']}, prot, ({'blade_width': w * size, 'blade_length': 2 * w * size} if size != 1 else {})

    def punch(self, size):
        """Stiffness of a round punch of the blade's area on a bonded layer (Hayes et al. 1972, table for nu = 0.5), over that of a block w x w x h."""
        self.area = 2 * (self.w * size) ** 2
        a = np.sqrt(self.area / np.pi)
        kappa = np.interp(a / self.h, [0, 0.2, 0.4, 0.6, 0.8, 1.0], [1, 1.281, 1.683, 2.211, 2.855, 3.609])
        return 2 * a * kappa / (1 - 0.49 ** 2) * self.h / self.w ** 2

    def draw(self, name, s):
        d = Tissue.draw(self, name, s)
        for force in ('amplitude', 'size', 'pull_off'):  # drawn for a block
            if force in d and name != 'offset-step':
                d[force] *= self.punch(1.0) * (self.w ** 2 / self.area if force == 'pull_off' else 1.0)
        if name == 'poroelastic-drainage':
            T = 2 * self.peak / self.rate * 2 / 0.4
            d['radial'], d['diffusivity'] = True, (self.w / 2) ** 2 / T * self.rng.uniform(0.3, 1.5)
        return d


class Vessel:
    rig, model, free, output = 'vessel-inflation', 'vessel/linear', ['youngs_modulus'], 'outer_diameter'
    refitted = ['E']
    effects = ['viscoelastic-relaxation', 'strain-stiffening', 'first-cycle-softening', 'fibre-stiffening', 'smooth-muscle-tone', 'residual-stress',
               'perivascular-tethering', 'sensor-lag', 'sensor-drift', 'saturation', 'mains-hum']
    outside = ['offset-step', 'damage', 'collapse']

    def __init__(self, rng, effects):
        self.rng = rng
        self.D = np.exp(rng.uniform(np.log(0.8e-3), np.log(4e-3)))
        self.wall = self.D * (rng.uniform(0.2, 0.3) if 'residual-stress' in effects else rng.uniform(0.08, 0.2))
        self.P = rng.uniform(8e3, 20e3)
        b, a = self.D / 2, self.D / 2 - self.wall
        self.E = 3 * self.P / (2 * (1 / a ** 2 - 1 / b ** 2)) / (b * b * rng.uniform(0.06, 0.16))
        self.n = int(rng.integers(200, 450))
        self.T = rng.uniform(20, 120)

    def specimen(self):
        return {'outer_diameter': self.D, 'wall_thickness': self.wall, 'length': 20e-3}

    def protocols(self):
        return [(1.0, 1.0), (0.12, 1.0), (1.0, 0.6)]

    def trial(self, p, fx, scale):
        speed, level = p
        T = self.T * speed
        t, P = ramp_hold(T, self.n * F.FINE, self.P * level, 2, 0.3, 0.2)
        b, a = self.D / 2, self.D / 2 - self.wall
        mu = self.E * scale / 3
        R = np.linspace(a, b, 41)

        def extra(C):
            l = np.sqrt(1 + 2 * C / R ** 2)
            s = np.zeros_like(R)
            if 'fibre-stiffening' in fx:
                v = fx['fibre-stiffening']
                e = 0.5 * np.cos(0.698) ** 2 * (l ** 2 - 1)
                s += 2 * v['k1'] * e * np.exp(v['k2'] * e ** 2) * np.cos(0.698) ** 2 * l ** 2 * (e > 0)
            if 'strain-stiffening' in fx:
                i1 = l ** 2 + l ** -2 - 2
                s += 2 * mu * fx['strain-stiffening']['c20_over_c10'] * i1 * (l ** 2 - l ** -2)
            if 'smooth-muscle-tone' in fx:
                v = fx['smooth-muscle-tone']
                s += v['active_stress'] * np.maximum(0, 1 - ((l - v['peak']) / (v['peak'] - 1)) ** 2) ** 1.0
            return np.trapz(s * R / (R ** 2 + 2 * C), R)
        lame = 1 / a ** 2 - 1 / b ** 2
        if 'residual-stress' in fx:
            bent = F.opened_sector(a, b, mu, fx['residual-stress']['opening_angle'])
        grid = np.linspace(0, 0.8 * b * b, 40 * F.FINE)
        table = np.array([2 * mu * C * lame + extra(C) for C in grid])
        if 'residual-stress' in fx:
            table = table + np.array([bent(C) for C in grid])
        if 'perivascular-tethering' in fx:
            u = np.sqrt(b * b + 2 * grid) - b
            table = table + fx['perivascular-tethering']['foundation_stiffness'] * u
        Pe = P.copy()
        if 'viscoelastic-relaxation' in fx:
            v = fx['viscoelastic-relaxation']
            # creep of a Zener solid whose relaxation is 1 - g1 (1 - exp(-t/tau)): retardation time tau/(1-g1)
            k, tr = v['g1'] / (1 - v['g1']), v['tau1'] / (1 - v['g1'])
            q = F.lagged(t, P, tr, 1)  # P(0) = 0
            Pe = P + k * q
        if 'first-cycle-softening' in fx:
            C = np.interp(Pe, table, grid)
            for _ in range(30):
                C = 0.5 * C + 0.5 * np.interp(Pe / F.softening(C / (a * b), fx['first-cycle-softening']['d'], fx['first-cycle-softening']['w0']), table, grid)
        else:
            C = np.interp(Pe, table, grid)
        y = self.D + 2 * C / b
        rise = 2 * self.P / (2 * self.E / 3 * lame) / b
        if 'damage' in fx:
            y = self.D + (y - self.D) * np.where(t > fx['damage']['at'] * T, 1 + fx['damage']['drop'], 1.0)
        if 'offset-step' in fx:
            y = y + fx['offset-step']['size'] * rise * ((t > fx['offset-step']['at'] * T) & (t < (fx['offset-step']['at'] + 0.3) * T))
        if 'collapse' in fx:
            y = y - fx['collapse']['size'] * rise * np.exp(-(P / self.P / 0.12) ** 2)
        return t, {'pressure': P}, {'outer_diameter': y}, {'rate': '%.5g Pa/s' % (self.P * level / (0.125 * T))}, {}

    def draw(self, name, s):
        r = self.rng
        b = self.D / 2
        a = b - self.wall
        e = 0.13
        rise = 3 * self.P / (self.E * (1 / a ** 2 - 1 / b ** 2)) / b
        sig = self.P * a / (b - a)
        return {
            'viscoelastic-relaxation': lambda: {'g1': 0.1 + 0.35 * s, 'tau1': self.T * np.exp(r.uniform(-4, -2))},
            'strain-stiffening': lambda: {'c20_over_c10': (0.1 + 0.6 * s) / (4 * e * e)},
            'first-cycle-softening': lambda: {'d': 0.08 + 0.3 * s, 'w0': 0.5 * e * e * r.uniform(0.15, 0.5)},
            'fibre-stiffening': lambda: {'k1': sig * (0.3 + 0.8 * s) / e * 0.3, 'k2': r.uniform(1, 4) / e ** 2 * 0.3},
            'smooth-muscle-tone': lambda: {'active_stress': sig * (0.1 + 0.3 * s), 'peak': 1 + e * r.uniform(0.4, 0.7)},
            'residual-stress': lambda: {'opening_angle': np.radians(40 + 140 * s)},
            'perivascular-tethering': lambda: {'foundation_stiffness': self.P / (0.5 * rise) * (0.1 + 0.5 * s)},
            'sensor-lag': lambda: {'time_constant': self.T * (0.003 + 0.008 * s), 'poles': int(r.integers(1, 3)), 'delay': r.random() < 0.3},
            'sensor-drift': lambda: {'size': rise * (0.06 + 0.15 * s), 'log': r.random() < 0.4},
            'saturation': lambda: {'share': 0.85 - 0.3 * s},
            'mains-hum': lambda: {'frequency': r.choice([50.0, 60.0]) + r.uniform(-0.05, 0.05), 'amplitude': rise * (0.02 + 0.05 * s)},
            'damage': lambda: {'at': r.uniform(0.2, 0.7), 'drop': 0.15 + 0.2 * s},
            'offset-step': lambda: {'at': r.uniform(0.2, 0.6), 'size': 0.06 + 0.15 * s},
            'collapse': lambda: {'size': 0.1 + 0.2 * s},
        }[name]()


class Cantilever:
    rig, model, free, output = 'suture-cantilever', 'suture/elastic', ['youngs_modulus'], 'tip_drop'
    refitted = ['E']
    effects = ['rest-curvature', 'bending-creep', 'permanent-set', 'sensor-drift', 'saturation']
    outside = ['offset-step', 'kink']

    def __init__(self, rng, effects):
        self.rng = rng
        self.d = rng.uniform(20e-6, 60e-6)
        self.E = np.exp(rng.uniform(np.log(1e9), np.log(4e9)))
        self.rho = 1140.0
        self.L = (self.E * self.d ** 2 / (16 * self.rho * 9.81) * rng.uniform(1.5, 8)) ** (1 / 3)
        self.n = int(rng.integers(25, 45))
        self.back = 'permanent-set' in effects or rng.random() < 0.3
        self.with_reach = rng.random() < 0.3

    def specimen(self):
        return {'diameter': self.d, 'density': self.rho}

    def protocols(self):
        there = 'and back' if self.back else 'steps'
        return [('down', there), ('up', there), ('down', 'rest'), ('up', 'rest')]

    def trial(self, p, fx, scale):
        side, kind = p
        n = self.n
        T = 600.0
        t = np.linspace(0, T, n * 4)
        up = np.linspace(0.35, 1.0, len(t))
        L = {'steps': up, 'and back': np.interp(t / T, [0, 0.5, 1], [0.35, 1.0, 0.35]), 'rest': np.full(len(t), 0.85)}[kind] * self.L
        kind = 'steps' if kind == 'and back' else kind
        B = self.E * scale * np.pi * self.d ** 4 / 64
        w = self.rho * 9.81 * np.pi / 4 * self.d ** 2
        k0 = fx.get('rest-curvature', {}).get('curvature', 0.0) * (1 if side == 'down' else -1)
        J = np.ones_like(t)
        if 'bending-creep' in fx:
            v = fx['bending-creep']
            J = 1 + v['a'] * np.log(1 + t / v['t0'])
        idx = np.unique(np.linspace(0, len(t) - 1, 15 if F.FINE == 10 else 7).astype(int))
        shape = np.empty((len(idx), 2))
        most = 0.0
        for k, i in enumerate(idx):
            own = fx['permanent-set']['fraction'] * most if 'permanent-set' in fx else 0.0  # of the largest past curvature, less towards the tip
            taper = fx['permanent-set']['taper'] * own / (k0 + own) if own else 0.0
            shape[k] = np.array(F.elastica(L[i], B / J[i], w, k0 + own, taper)) / L[i]
            most = max(most, w * L[i] ** 2 / (2 * B / J[i]) * np.sqrt(max(0.0, 1 - shape[k, 0] ** 2)))
        from scipy.interpolate import PchipInterpolator
        curve = PchipInterpolator(t[idx], shape)(t) if kind == 'steps' or 'bending-creep' in fx or 'permanent-set' in fx else np.repeat(shape[:1], len(t), 0)
        y = L * curve[:, 0]
        if 'kink' in fx and kind == 'steps':
            y = y + fx['kink']['size'] * self.L * np.maximum(0, L / self.L - 0.7)
        if 'offset-step' in fx:
            y = y + fx['offset-step']['size'] * self.L * 0.5 * ((t > 0.3 * T) & (t < 0.6 * T))
        out = {'tip_drop': y, 'tip_reach': L * curve[:, 1]} if self.with_reach else {'tip_drop': y}
        return t, {'overhang': L}, out, {'orientation': side}, {}

    fine = 4

    def draw(self, name, s):
        r = self.rng
        return {
            'rest-curvature': lambda: {'curvature': (0.15 + 0.5 * s) / self.L},
            'bending-creep': lambda: {'a': 0.04 + 0.12 * s, 't0': r.uniform(5, 60)},
            'permanent-set': lambda: {'fraction': 0.08 + 0.3 * s, 'taper': r.uniform(0.2, 0.8)},
            'sensor-drift': lambda: {'size': self.L * 0.5 * (0.06 + 0.15 * s), 'log': r.random() < 0.3},
            'saturation': lambda: {'share': 0.85 - 0.3 * s},
            'offset-step': lambda: {'size': 0.06 + 0.15 * s},
            'kink': lambda: {'size': 0.3 + 0.5 * s},
        }[name]()
