#pragma once
// Reference solutions of the hidden effects' differential equations by CVODE (SUNDIALS; Cohen & Hindmarsh 1996; Hindmarsh et al. 2005), relative
// tolerance 1e-10. Inputs are piecewise linear between their samples, where the integrator is made to stop. Plain C, so that the
// generator (Python) can call it; nothing here is shared with src/reconcile. All functions return 0, or CVODE's negative code.

extern "C" {
/// `poles` lags in series, each of time constant tau/poles: x_i' = (x_(i-1) - x_i) poles/tau, x_0 = u, x(0) = u(0) (or 0 if from_rest).
int filum_reference_lag(int n, const double* t, const double* u, double tau, int poles, int from_rest, double* out);
/// Bouc-Wen with exponent two, over x instead of time: dz/dx = 1 - (2 |z|/width)^2 (1 + sign(z dx))/2; out = x - z.
int filum_reference_bouc_wen(int n, const double* x, double width, double* out);
/// A share of f is borne by a fluid that drains: p' = D lap p + share f', p = 0 at the drained face at `size`, cells of finite volume, plane
/// or radial; out = (1 - share) f + the mean of p.
int filum_reference_consolidation(int n, const double* t, const double* f, double share, double D, double size, int radial, double* out);
/// Heavy elastica clamped level: B theta'' = -w (L - s) cos theta + B k0'(s), theta(0) = 0, theta'(L) the rest curvature there, which falls evenly from
/// `curvature` at the clamp by the share `taper`; by shooting.
int filum_reference_elastica(double L, double B, double w, double curvature, double taper, double* drop, double* reach);
}
