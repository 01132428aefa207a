#!/usr/bin/python3
"""Makes a large, plausible elevation source: real heights refined by a fractal.

    refine_heights.py HEIGHTS.tif OUT.tif DOUBLINGS [SIDE]

Takes the SIDE x SIDE posts (2049) in the middle of HEIGHTS.tif, which keep their values, and puts DOUBLINGS times a
post between each two: midpoint displacement (Fournier, Fussell and Carpenter, "Computer rendering of stochastic
models", 1982), the displacement in proportion to how much the ground around changes, half as large at each doubling.
OUT.tif has ((SIDE - 1) * 2^DOUBLINGS + 1)^2 posts of int16, tiled, not compressed: 537 MB with 3 doublings. The same
every time. Works in strips: memory does not grow with OUT.tif.
"""

import pathlib
import sys
import tempfile

import numpy
from osgeo import gdal

ROUGHNESS = 0.3  # of the difference of the neighbours
LEAST_M = 0.2    # where the ground is level
STRIP = 512      # rows


def double(coarse, path, rng):
    """Twice as many posts both ways, less one, in a file of float32."""
    side = coarse.shape[0]
    fine = numpy.memmap(path, numpy.float32, "w+", shape=(2 * side - 1, 2 * side - 1))

    def between(a, b):
        spread = ROUGHNESS * numpy.abs(a - b) + LEAST_M
        return (a + b) / 2 + spread * rng.standard_normal(a.shape, numpy.float32)

    for first in range(0, side - 1, STRIP):
        rows = numpy.array(coarse[first : min(first + STRIP, side - 1) + 1])
        out = fine[2 * first : 2 * first + 2 * len(rows) - 1]
        if first == 0:
            out[0, ::2] = rows[0]
            out[0, 1::2] = between(rows[0, :-1], rows[0, 1:])
        out[2::2, ::2] = rows[1:]
        out[2::2, 1::2] = between(rows[1:, :-1], rows[1:, 1:])
        out[1::2, ::2] = between(rows[:-1], rows[1:])
        out[1::2, 1::2] = between(out[:-2:2, 1::2], out[2::2, 1::2])
    return fine


def main():
    if len(sys.argv) not in (4, 5):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    gdal.UseExceptions()
    side = int(sys.argv[4]) if len(sys.argv) == 5 else 2049
    source = gdal.Open(sys.argv[1])
    left, top = (source.RasterXSize - side) // 2, (source.RasterYSize - side) // 2
    if left < 0 or top < 0:
        print(f"refine_heights: {sys.argv[1]} is smaller than {side} x {side}", file=sys.stderr)
        return 1
    heights = source.GetRasterBand(1).ReadAsArray(left, top, side, side).astype(numpy.float32)
    rng = numpy.random.default_rng(1998)
    doublings = int(sys.argv[3])
    with tempfile.TemporaryDirectory(dir=pathlib.Path(sys.argv[2]).resolve().parent) as work:
        for step in range(doublings):
            heights = double(heights, f"{work}/{step}.f32", rng)
        side = heights.shape[0]
        out = gdal.GetDriverByName("GTiff").Create(sys.argv[2], side, side, 1, gdal.GDT_Int16,
                                                   ["TILED=YES", "BIGTIFF=IF_SAFER"])
        x0, dx, _, y0, _, dy = source.GetGeoTransform()
        share = 2**-doublings
        # The first post stays where it was: a pixel's middle.
        out.SetGeoTransform((x0 + (left + 0.5 - 0.5 * share) * dx, dx * share, 0,
                             y0 + (top + 0.5 - 0.5 * share) * dy, 0, dy * share))
        out.SetProjection(source.GetProjection())
        for first in range(0, side, STRIP):
            rows = numpy.rint(heights[first : first + STRIP]).astype(numpy.int16)
            out.GetRasterBand(1).WriteArray(rows, 0, first)
        out = None
    return 0


if __name__ == "__main__":
    sys.exit(main())
