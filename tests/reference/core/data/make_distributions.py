#!/usr/bin/env python3
"""Writes normal_quantiles.csv and poisson_tails.csv beside this script with mpmath at 60 digits.

Independent of the code under test: erfc by mpmath and the incomplete gamma function by numerical integration.
Needs python3-mpmath; made with mpmath 1.3.0.
"""
import pathlib
import random

from mpmath import erfc, exp, log, loggamma, mp, mpf, nstr, quad, sqrt

mp.dps = 60
HERE = pathlib.Path(__file__).parent
DIGITS = 25


def normal_quantile(p):
    """x with Phi(x) = p <= 1/2."""
    guess = -sqrt(max(mpf(0), -2 * log(2 * p)))
    for _ in range(200):  # Newton steps on ln Phi, which is concave
        value = erfc(-guess / sqrt(2)) / 2
        density = exp(-guess * guess / 2) / sqrt(2 * mp.pi)
        step = (log(value) - log(p)) * value / density
        guess -= step
        if abs(step) < mpf(10) ** -50:
            return guess
    raise RuntimeError(p)


def write_normals(generator):
    lines = ["# bits of the word, the word, standard normal quantile of (word + 1/2) / 2^bits"]
    for bits in (32, 64):
        half = 2 ** (bits - 1)
        words = {0, 1, 2, 10, 1000, half - 1, half - 2, half - 1000, int(0.075 * 2**bits), int(0.075 * 2**bits) - 1}
        words |= {2**k for k in range(3, bits - 1)} | {generator.randrange(half) for _ in range(60)}
        for word in sorted(words):
            quantile = normal_quantile((mpf(word) + mpf(1) / 2) / mpf(2) ** bits)
            lines.append(f"{bits},{word},{nstr(quantile, DIGITS)}")
    (HERE / "normal_quantiles.csv").write_text("\n".join(lines) + "\n")


def poisson_tails(n, mean):
    """(P(X <= n), P(X > n)) by integrating t^n e^-t / n! on the shorter side of `mean`."""
    mean = mpf(mean)
    a = mpf(n) + 1
    width = sqrt(max(a, mean))

    def integrand(t):
        return exp(n * log(t) - t - loggamma(a)) if t > 0 else (mpf(1) if n == 0 else mpf(0))

    if a <= mean:
        knots = [mean + width * k for k in (0, 1, 2, 3, 5, 8, 12, 20, 40)]
        lower = quad(integrand, knots)
        return lower, 1 - lower
    knots = [mean - width * k for k in (40, 20, 12, 8, 5, 3, 2, 1, 0)]
    knots = [mpf(0)] * (knots[0] < 0) + [k for k in knots if k > 0]
    upper = quad(integrand, knots)
    return 1 - upper, upper


def write_tails(generator):
    lines = ["# mean (hexadecimal double), n, P(X <= n), P(X > n)"]
    means = [1e-9, 0.01, 0.5, 1.0, 3.0, 9.999, 10.0, 11.9, 50.0, 99.5, 1234.5, 9999.75, 10000.25, 1e5, 1e6 + 0.375, 1e8, 1e10, 1e12, 1e15]
    for mean in means:
        sigma = mean**0.5
        counts = {max(0, int(mean + sigma * k + k * abs(k) / 6)) for k in (-9, -7, -5, -3, -2, -1, 0, 1, 2, 3, 5, 7, 9)}
        counts |= {max(0, int(mean + sigma * generator.uniform(-6, 6))) for _ in range(6)}
        counts |= {max(0, int(mean) + k) for k in (-2, -1, 0, 1)}
        if mean < 1:
            counts = {0, 1, 2, 3}
        for n in sorted(counts):
            lower, upper = poisson_tails(n, mean)
            lines.append(f"{mean.hex()},{n},{nstr(lower, DIGITS)},{nstr(upper, DIGITS)}")
    (HERE / "poisson_tails.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    write_normals(random.Random(1))
    write_tails(random.Random(2))
