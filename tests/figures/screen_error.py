#!/usr/bin/env python3
"""Screen-space error: the full-resolution surface, projected, against the drawn one.

Takes snapshots with depth from 20 poses over the dataset's inset. Every seen pixel is taken back to where it lies on the
drawn surface; the full-resolution surface at that latitude and longitude comes from `belvedere height`; both points are
projected with clip_from_ecef, and their distance on the picture is the error. Prints the share within the bound and the
worst; exits 1 when less than 99.9 % are within it or the worst is over twice the bound.

Usage: screen_error.py BUILD_FOLDER DATASET WORK_FOLDER [BOUND_PX]
"""
import pathlib
import random
import sys

import numpy
import OpenImageIO

from earth_maths import Programs, to_ecef, to_geodetic, to_pixels

SIZE = (1024, 768)
STRIDE = 5        # every fifth pixel of every fifth row


def ground_points(depth_file, clip_from_ecef):
    image = OpenImageIO.ImageBuf(depth_file)
    depth = image.get_pixels(OpenImageIO.FLOAT).reshape(SIZE[1], SIZE[0])
    rows, columns = numpy.mgrid[0:SIZE[1]:STRIDE, 0:SIZE[0]:STRIDE]
    far = depth[rows, columns].astype(float)
    seen = numpy.isfinite(far)
    x = (columns[seen] + 0.5) / SIZE[0] * 2 - 1
    y = 1 - (rows[seen] + 0.5) / SIZE[1] * 2
    w = far[seen]
    # clip = M ecef: rows 0, 1 and 3 give three equations for the point with x w, y w and w known.
    matrix = clip_from_ecef[[0, 1, 3], :3]
    right = numpy.stack([x * w, y * w, w], axis=-1) - clip_from_ecef[[0, 1, 3], 3]
    return numpy.linalg.solve(matrix, right.T).T


def main(build, dataset, work, bound):
    folder = pathlib.Path(work)
    folder.mkdir(parents=True, exist_ok=True)
    programs = Programs(build, dataset)
    chance = random.Random(2)
    errors = []
    for number in range(20):
        latitude, longitude = chance.uniform(36.8, 38.4), chance.uniform(-120.4, -117.6)
        ground = programs.heights([latitude], [longitude])[0]
        height = ground + 10 ** chance.uniform(2.5, 5.2)
        pose = (latitude, longitude, height, chance.uniform(0, 360), chance.uniform(-70, -5))
        depth_file = str(folder / f"depth{number}.exr")
        report = programs.snapshot(pose, SIZE, str(folder / f"pose{number}.png"), depth_file, ["--error-px", str(bound)])
        drawn = ground_points(depth_file, report["clip_from_ecef"])
        lat, lon, _ = to_geodetic(drawn)
        full = to_ecef(lat, lon, programs.heights(lat, lon))
        a, _ = to_pixels(report["clip_from_ecef"], drawn, *SIZE)
        b, w = to_pixels(report["clip_from_ecef"], full, *SIZE)
        own = numpy.where(w > 0, numpy.hypot(*(a - b).T), 0)
        errors.append(own)
        print(f"pose {number:2}: {len(own)} points, height {height - ground:9.0f} m, median {numpy.median(own):.3f}, "
              f"99.9 % {numpy.quantile(own, 0.999):.3f}, worst {own.max():.3f} px, {report['triangles']} triangles", flush=True)
    errors = numpy.concatenate(errors)
    share = (errors <= bound).mean()
    print(f"{len(errors)} points in 20 poses, bound {bound} px: {100 * share:.3f} % within, worst {errors.max():.3f} px")
    return 0 if share >= 0.999 and errors.max() <= 2 * bound else 1


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:4], float(sys.argv[4]) if len(sys.argv) == 5 else 2.0))
