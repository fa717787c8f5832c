#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/association_bound.py MRCLAM_FOLDER: how many readings of each robot are nearest to the
landmark they name, where the robot is known from motion capture and the landmarks are surveyed.
Nearest by the sigmas of docs/range_bearing.md, and by those the readings show after their median
error is taken out. What an association of single readings comes to that knows everything else; whole
histories of readings can do better."""
import bisect
import math
import pathlib
import sys

# MrclamCalibration (mrclam_import.hpp): readings are depths along the optical axis, and late.
DEPTH_OFFSET_M, DEPTH_GAIN, DELAY_S = 0.037, 1.016, 0.04
RANGE_SIGMA_M, BEARING_SIGMA = 0.05, math.radians(0.6)


def rows(path):
    return [line.split() for line in path.open() if line.strip() and not line.startswith("#")]


def wrap(angle):
    return math.remainder(angle, 2.0 * math.pi)


def pose_at(truth, stamps, stamp):
    i = bisect.bisect(stamps, stamp)
    if i == 0 or i == len(truth) or not 0.0 < stamps[i] - stamps[i - 1] < 0.5:
        return None
    (t, x, y, phi), (t1, x1, y1, phi1) = truth[i - 1], truth[i]
    u = (stamp - t) / (t1 - t)
    return x + u * (x1 - x), y + u * (y1 - y), phi + u * wrap(phi1 - phi)


def polar(pose, place):
    dx, dy = place[0] - pose[0], place[1] - pose[1]
    return math.hypot(dx, dy), wrap(math.atan2(dy, dx) - pose[2])


def share_right(readings, landmarks, gain, turn, range_sigma, bearing_sigma):
    right = 0
    for pose, name, distance, bearing in readings:
        def cost(place):
            expected, direction = polar(pose, place)
            return (((distance / gain - expected) / range_sigma) ** 2
                    + (wrap(bearing - turn - direction) / bearing_sigma) ** 2)
        right += min(landmarks, key=lambda other: cost(landmarks[other])) == name
    return 100.0 * right / len(readings)


def readings_of(folder):
    """The surveyed landmarks, and of each robot (true pose, name, distance, bearing) as read."""
    subject_of = {int(r[1]): int(r[0]) for r in rows(folder / "Barcodes.dat")}
    landmarks = {int(r[0]): (float(r[1]), float(r[2]))
                 for r in rows(folder / "Landmark_Groundtruth.dat")}
    robots = {}
    for file in sorted(folder.glob("Robot*_Measurement.dat")):
        robot = file.name.split("_")[0]
        truth = [tuple(map(float, r[:4])) for r in rows(folder / f"{robot}_Groundtruth.dat")]
        stamps = [r[0] for r in truth]
        readings = robots[robot] = []
        for r in rows(file):
            name, pose = subject_of.get(int(r[1])), pose_at(truth, stamps, float(r[0]) - DELAY_S)
            if name in landmarks and pose:
                bearing = float(r[3])
                depth = (float(r[2]) - DEPTH_OFFSET_M) / DEPTH_GAIN
                readings.append((pose, name, depth / math.cos(bearing), bearing))
    return landmarks, robots


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    landmarks, robots = readings_of(pathlib.Path(sys.argv[1]))
    print("| robot | readings | nearest by the sigmas stated | debiased, by the sigmas shown |")
    print("|---|---|---|---|")
    for robot, readings in robots.items():
        expected = [polar(pose, landmarks[name]) for pose, name, _, _ in readings]
        gains = sorted(r[2] / e[0] for r, e in zip(readings, expected))
        turns = sorted(wrap(r[3] - e[1]) for r, e in zip(readings, expected))
        gain, turn = gains[len(gains) // 2], turns[len(turns) // 2]
        off = sorted(abs(r[2] / gain - e[0]) for r, e in zip(readings, expected))
        aside = sorted(abs(wrap(r[3] - turn - e[1])) for r, e in zip(readings, expected))
        one_sigma = int(0.683 * len(readings))
        print("| %s | %d | %.1f %% | %.1f %% |" % (
            robot, len(readings),
            share_right(readings, landmarks, 1.0, 0.0, RANGE_SIGMA_M, BEARING_SIGMA),
            share_right(readings, landmarks, gain, turn, off[one_sigma], aside[one_sigma])))


if __name__ == "__main__":
    main()
