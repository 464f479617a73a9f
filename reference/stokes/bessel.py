"""Modified Bessel functions of whole orders and complex argument, by their logarithms, which no order of 100 exceeds.

Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, chapter 9: 9.6.24 (K by an integral), 9.6.26
(recurrences), 9.6.16 (I_0). The ratios of I come from the recurrence downwards, K upwards: the stable ways.
"""

import numpy as np


def log_first_kind(highest: int, z: np.ndarray) -> np.ndarray:
    """log I_n(z), n = 0 ... highest, shape (highest + 1, len(z)); real part of z above 0, modulus up to 1000."""
    ratio = np.zeros_like(z, dtype=complex)  # I_(n+1) / I_n
    ratios = []
    for n in range(highest + 60 + int(2 * np.abs(z).max()), 0, -1):
        ratio = 1 / (2 * n / z + ratio)
        if n <= highest:
            ratios.append(np.log(ratio))
    angle = np.pi * (np.arange(400) + 0.5) / 400
    scaled = np.exp(z[:, None] * (np.cos(angle) - 1)).mean(axis=1)  # I_0 exp(-z): the midpoint rule is exact here
    return np.cumsum([np.log(scaled) + z, *ratios[::-1]], axis=0)


def log_second_kind(highest: int, z: np.ndarray) -> np.ndarray:
    """log K_n(z), likewise; modulus of z at least 1e-3."""
    t = np.linspace(0.0, 14.0, 1401)
    weight = np.full(len(t), t[1])
    weight[0] *= 0.5
    decay = np.exp(-z[:, None] * (np.cosh(t) - 1))
    zero, one = decay @ weight, (decay * np.cosh(t)) @ weight  # times exp(z)
    logs, ratio = [np.log(zero) - z, np.log(one) - z], one / zero  # K_(n+1) / K_n
    for n in range(1, highest):
        ratio = 2 * n / z + 1 / ratio
        logs.append(logs[-1] + np.log(ratio))
    return np.array(logs[: highest + 1])
