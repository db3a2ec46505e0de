"""Functional forms of the hidden effects. Nothing here is shared with src/reconcile: other formulas, other integrators, finer
steps (each record is computed on a grid ten times finer than it is sampled). Differential equations are solved by CVODE where FILUM_REFERENCE
names the library built from reference.cpp, else by the fixed steps below, which it agrees with to 3e-4."""
import ctypes
import os
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.ndimage import uniform_filter1d

FINE = 10
CVODE = ctypes.CDLL(os.environ['FILUM_REFERENCE']) if os.environ.get('FILUM_REFERENCE') else None
SOLVER = 'CVODE' if CVODE else 'own'


def solved(name, *given):
    """Calls a function of reference.h: arrays, numbers, and the array for the answer, which is returned."""
    arrays = [np.ascontiguousarray(a, float) if isinstance(a, np.ndarray) else a for a in given]
    out = np.empty_like(arrays[0])
    pointer = ctypes.POINTER(ctypes.c_double)
    args = [a.ctypes.data_as(pointer) if isinstance(a, np.ndarray) else ctypes.c_int(int(a)) if isinstance(a, (bool, int)) else ctypes.c_double(float(a)) for a in arrays]
    status = getattr(CVODE, name)(ctypes.c_int(len(out)), *args, out.ctypes.data_as(pointer))
    if status < 0:
        raise ArithmeticError(f'{name}: {status}')
    return out


def zener(t, f, g1, tau):
    """Standard linear solid by its internal variable, trapezoidal rule."""
    if CVODE:
        return f - g1 * solved('filum_reference_lag', t, f, float(tau), 1, 1)
    q = np.empty_like(f)
    q[0] = 0.0
    for i in range(1, len(f)):
        h = t[i] - t[i - 1]
        q[i] = (q[i - 1] * (1 - 0.5 * h / tau) + 0.5 * h / tau * (f[i] + f[i - 1])) / (1 + 0.5 * h / tau)
    return f - g1 * q


def stretched(t, f, g1, tau, beta):
    """g = 1 - g1 (1 - exp(-(t/tau)^beta)) by direct convolution on a uniform grid."""
    h = t[1] - t[0]
    g = 1 - g1 * (1 - np.exp(-((np.arange(len(t)) + 0.5) * h / tau) ** beta))
    df = np.diff(f, prepend=0.0)
    n = 1 << (2 * len(t) - 1).bit_length()
    return np.fft.irfft(np.fft.rfft(df, n) * np.fft.rfft(g, n), n)[:len(t)]


def consolidation(t, f, g1, D, size, radial):
    """Share g1 of the stiffness is carried by fluid that drains: pressure diffusion by implicit finite differences."""
    if CVODE:
        return solved('filum_reference_consolidation', t, f, float(g1), float(D), float(size), bool(radial))
    n = 24
    dx = size / n if radial else 0.5 * size / n
    x = (np.arange(n) + 0.5) * dx
    p = np.zeros(n)
    df = np.diff(f, prepend=f[0])
    out = np.empty_like(f)
    h = t[1] - t[0]
    right = (x + 0.5 * dx) / x if radial else np.ones(n)
    left = (x - 0.5 * dx) / x if radial else np.ones(n)
    left[0] = 0.0
    r = D * h / dx ** 2
    A = np.diag(1 + r * (right + left)) - np.diag(r * right[:-1], 1) - np.diag(r * left[1:], -1)
    A[-1, -1] = 1 + r * (2 * right[-1] + left[-1])
    step = np.linalg.inv(A)
    w = x / x.sum() if radial else np.ones(n) / n
    for i in range(len(f)):
        p = step @ (p + g1 * df[i])
        out[i] = (1 - g1) * f[i] + w @ p
    return out


def bouc_wen(x, width):
    """Smooth hysteretic lag of an input."""
    if CVODE:
        return solved('filum_reference_bouc_wen', x, float(width))
    z = np.empty_like(x)
    z[0] = 0.0
    for i in range(1, len(x)):
        d = x[i] - x[i - 1]
        z[i] = z[i - 1] + d * (1 - (abs(z[i - 1]) / (0.5 * width)) ** 2 * (0.5 + 0.5 * np.sign(d * z[i - 1])))
    return x - z


def lagged(t, y, tau, poles):
    if CVODE:
        return solved('filum_reference_lag', t, y, float(tau), int(poles), 0)
    for _ in range(poles):
        out = np.empty_like(y)
        out[0] = y[0]
        a = np.exp(-(t[1] - t[0]) / (tau / poles))
        for i in range(1, len(y)):
            out[i] = a * out[i - 1] + (1 - a) * 0.5 * (y[i] + y[i - 1])
        y = out
    return y


def delayed(t, y, delay):
    return np.interp(t - delay, t, y)


def soft_clip(y, limit):
    x = np.abs(y) / limit
    return np.sign(y) * limit * x / (1 + x ** 24) ** (1 / 24)


def beat(t, rng, f, amplitude, breath=0.0, harmonic=0.15):
    """Heart with its first harmonic and, as a share of it, breath at about a quarter of the rate; all phases random."""
    phase = 2 * np.pi * f * t + rng.uniform(0, 2 * np.pi)
    slow = breath * np.sin(2 * np.pi * (0.17 + 0.06 * f) * t + rng.uniform(0, 6.28))
    return amplitude * (np.sin(phase) + harmonic * np.sin(2 * phase + rng.uniform(0, 6.28)) + slow)


def softening(e, d, w0):
    w = 0.5 * e ** 2
    top = np.maximum.accumulate(w)
    x = (top - w) / w0
    return 1 - d * x / (1 + x) * 1.3 if d < 0.7 else 1 - d * x / (1 + x)


def elastica(L, B, w, kappa0, taper=0.0):
    """Heavy elastica, clamped level, by collocation-free shooting with an adaptive integrator. The rest curvature falls evenly from kappa0 at the
    clamp by the share `taper`. Returns drop, reach."""
    if CVODE:
        drop, reach = ctypes.c_double(), ctypes.c_double()
        status = CVODE.filum_reference_elastica(*(ctypes.c_double(float(v)) for v in (L, B, w, kappa0, taper)), ctypes.byref(drop), ctypes.byref(reach))
        if status < 0:
            raise ArithmeticError(f'elastica: {status}')
        return drop.value, reach.value

    def ode(s, y):
        th, k = y[0], y[1]
        return [k, -w * (L - s) / B * np.cos(th) - kappa0 * taper / L, np.cos(th), np.sin(th)]
    lo, hi = -40.0 / L, 40.0 / L

    def end(k_clamp):
        sol = solve_ivp(ode, (0, L), [0, k_clamp, 0, 0], rtol=1e-7, atol=1e-10)
        return sol.y[1, -1] - kappa0 * (1 - taper), sol.y[2, -1], sol.y[3, -1]
    a = kappa0 + w * L * L / (2 * B) / (1 + (w * L ** 3 / (8 * B)) ** 0.7)
    b = a * 1.05 + 1e-3 / L
    fa, fb = end(a), end(b)
    for _ in range(40):
        if abs(fb[0]) < 1e-9 / L or fb[0] == fa[0]:
            break
        c = b - fb[0] * (b - a) / (fb[0] - fa[0])
        c = min(max(c, lo), hi)
        a, fa = b, fb
        b, fb = c, end(c)
    return fb[2], fb[1]


def opened_sector(a, b, mu, angle):
    """Pressure a neo-Hookean tube closed from a sector of this opening angle bears beyond that of one without: trapezoidal rule over 400
    points of the wall, the open radius by bisection on the unloaded tube. Returns a function of C, r'^2 = r^2 + 2 C."""
    k = 1 / (1 - angle / (2 * np.pi))

    def pressure(factor, open_inner, C):
        r = np.sqrt(np.linspace(a * a, b * b, 400) + 2 * C)
        stretch = r * factor / np.sqrt(open_inner ** 2 + factor * (r ** 2 - r[0] ** 2))
        return np.trapz(mu * (stretch ** 2 - stretch ** -2) / r, r)
    inner = brentq(lambda R: pressure(k, R, 0.0), 0.3 * a, 8 * a * k)
    return lambda C: pressure(k, inner, C) - pressure(1.0, a, C)


def smooth(y, n):
    return uniform_filter1d(y, n) if n > 1 else y
