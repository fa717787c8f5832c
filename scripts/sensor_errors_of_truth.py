#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/sensor_errors_of_truth.py MRCLAM_FOLDER: what the sensor of each robot is always off by
(SensorErrors), fitted where motion capture saw the robot and the landmarks were surveyed, with
Cauchy's weights. To compare with what RangeBearing.estimate_sensor finds without either."""
import math
import pathlib
import sys

sys.dont_write_bytecode = True
from association_bound import polar, readings_of, wrap

RANGE_SCATTER_M, BEARING_SCATTER = 0.02, math.radians(0.4)
ROUNDS = 20


def solve(a, b):
    """Gauss and Jordan, for a positive definite matrix."""
    n = len(b)
    a = [row + [value] for row, value in zip(a, b)]
    for i in range(n):
        a[i] = [value / a[i][i] for value in a[i]]
        for k in range(n):
            if k != i:
                a[k] = [value - a[k][i] * pivot for value, pivot in zip(a[k], a[i])]
    return [row[n] for row in a]


def robust_fit(regressors, values, scatter):
    weights = [1.0] * len(values)
    fit = []
    for _ in range(ROUNDS):
        n = len(regressors[0])
        normal = [[sum(w * r[i] * r[k] for r, w in zip(regressors, weights)) for k in range(n)]
                  for i in range(n)]
        right = [sum(w * r[i] * v for r, v, w in zip(regressors, values, weights))
                 for i in range(n)]
        fit = solve(normal, right)
        left = [v - sum(f * x for f, x in zip(fit, r)) for r, v in zip(regressors, values)]
        weights = [1.0 / (1.0 + (e / scatter) ** 2) for e in left]
    return fit


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    landmarks, robots = readings_of(pathlib.Path(sys.argv[1]))
    print("| robot | range offset [m] | range scale | range skew [1/rad] | bearing scale "
          "| bearing offset [deg] |")
    print("|---|---|---|---|---|---|")
    for robot, readings in robots.items():
        ideal = [polar(pose, landmarks[name]) for pose, name, _, _ in readings]
        offset, scale, skew = robust_fit(
            [(1.0, distance, distance * bearing) for distance, bearing in ideal],
            [read[2] - distance for read, (distance, _) in zip(readings, ideal)], RANGE_SCATTER_M)
        turned, wide = robust_fit(
            [(1.0, bearing) for _, bearing in ideal],
            [wrap(read[3] - bearing) for read, (_, bearing) in zip(readings, ideal)],
            BEARING_SCATTER)
        print("| %s | %.3f | %.3f | %.3f | %.3f | %.2f |" % (
            robot, offset, scale, skew, wide, math.degrees(turned)))


main()
