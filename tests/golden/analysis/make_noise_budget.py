#!/usr/bin/env python3
"""Makes noise_budget_plato.csv, the noise budget of isolated Gaussian stars, without any code of the project.

Plain Python: pixel-integrated Gaussian by math.erf, masks grown pixel by pixel in order of their own noise-to-signal
ratio (ties together), the best of them kept, jitter by the exact covariance of an Ornstein-Uhlenbeck process.
usage: make_noise_budget.py "reason for the change" > noise_budget_plato.csv
"""
import math
import sys

ZERO_POINT, EXPOSURE, CYCLE, BIN = 20.62, 21.0, 25.0, 3600.0
SIGMA, SKY, READOUT, GAIN = 0.6, 45.0, 50.2, 25.0
CAMERAS, PRNU, JITTER_PX, TIMESCALE = 24, 0.01, 0.038 / 15.0, 250.0
WINDOW = range(-2, 4)  # six pixels from floor(x) - 2


def fraction(k, order=0):
    """Integral of the unit Gaussian, or of its derivative by the star's place, over the pixel k - 1/2 .. k + 1/2."""
    low, high = (k - 0.5) / SIGMA, (k + 0.5) / SIGMA
    if order == 0:
        if low > 0:  # no cancellation in the wing
            return 0.5 * (math.erfc(low / math.sqrt(2)) - math.erfc(high / math.sqrt(2)))
        return 0.5 * (math.erf(high / math.sqrt(2)) - math.erf(low / math.sqrt(2)))
    return (math.exp(-0.5 * low * low) - math.exp(-0.5 * high * high)) / (math.sqrt(2 * math.pi) * SIGMA)


def retained(exposures):
    """Part of the variance of the jitter that is left in the mean of so many exposures."""
    t, c = EXPOSURE / TIMESCALE, CYCLE / TIMESCALE
    own = 2.0 * (t + math.expm1(-t)) / t**2
    pair = (math.sinh(t / 2) / (t / 2)) ** 2
    total = exposures * own + 2 * pair * sum((exposures - k) * math.exp(-k * c) for k in range(1, exposures))
    return total / exposures**2


def best_mask(star, variance):
    pixels = sorted(star, key=lambda p: math.sqrt(variance[p]) / star[p])
    best, size = math.inf, 0
    for n in range(1, len(pixels) + 1):
        if n < len(pixels):
            a, b = (math.sqrt(variance[p]) / star[p] for p in (pixels[n - 1], pixels[n]))
            if b - a <= 1e-9 * b:
                continue  # does not split a tie
        nsr = math.sqrt(sum(variance[p] for p in pixels[:n])) / sum(star[p] for p in pixels[:n])
        if nsr < best:
            best, size = nsr, n
    return pixels[:size]


def row(magnitude):
    electrons = 10 ** (-0.4 * (magnitude - ZERO_POINT)) * EXPOSURE
    star = {(x, y): electrons * fraction(x) * fraction(y) for x in WINDOW for y in WINDOW}
    background, readout, rounding = SKY * EXPOSURE, READOUT**2, GAIN**2 / 12
    variance = {p: star[p] + background + readout + rounding for p in star}
    mask = best_mask(star, variance)
    signal, n = sum(star[p] for p in mask), len(mask)
    per_hour = round(BIN / CYCLE)
    ppm = lambda v: 1e6 * math.sqrt(v / (per_hour * CAMERAS)) / signal
    gains = sum((electrons * fraction(x, 1) * fraction(y)) ** 2 + (electrons * fraction(x) * fraction(y, 1)) ** 2 for x, y in mask)
    prnu = 1e6 * PRNU * math.sqrt(gains) / signal * JITTER_PX * math.sqrt(retained(per_hour) / CAMERAS)
    parts = [ppm(signal), ppm(n * background), ppm(n * readout), ppm(n * rounding), prnu]
    return [magnitude, electrons, n, signal / electrons, math.sqrt(sum(variance[p] for p in mask)) / signal,
            math.sqrt(sum(p * p for p in parts))] + parts


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print(f"# {sys.argv[1]}")
    print("mag,electrons,mask_pixels,enclosed_fraction,nsr_exposure,nsr_1h_ppm,photon_ppm,background_ppm,readout_ppm,"
          "quantisation_ppm,prnu_jitter_ppm")
    for half in range(16, 33):
        print(",".join(f"{v:.17g}" for v in row(half / 2)))
