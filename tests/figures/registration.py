#!/usr/bin/python3
"""Registration: marks at known places in a source, found again in snapshots.

Makes an image with bright discs at known latitudes and longitudes and a hilly elevation source, builds a dataset of
both, takes snapshots from 20 poses, and compares where each mark is seen with where clip_from_ecef puts it.
Prints the distances in pixels; exits 1 when one is over 1.5.

Usage: registration.py BUILD_FOLDER WORK_FOLDER
"""
import pathlib
import random
import subprocess
import sys

import numpy
from osgeo import gdal, osr

from earth_maths import Programs, to_ecef, to_pixels

SIZE = (1024, 768)
MARK_DEG = 0.012   # radius of a mark
SPACING_DEG = 0.25
EXTENT_DEG = 3.0
LIMIT_PX = 1.5
CENTRES = [(46.5, 8.5), (-33.0, 178.9), (0.3, -0.2), (71.0, 44.6)]  # one over 180 E, one over the equator and Greenwich

gdal.UseExceptions()


def write_raster(path, pixels, west, north, step):
    """pixels: bands x rows x columns."""
    kind = gdal.GDT_Byte if pixels.dtype == numpy.uint8 else gdal.GDT_Float32
    raster = gdal.GetDriverByName("GTiff").Create(str(path), pixels.shape[2], pixels.shape[1], pixels.shape[0], kind)
    raster.SetGeoTransform((west, step, 0, north, 0, -step))
    wgs84 = osr.SpatialReference()
    wgs84.ImportFromEPSG(4326)
    raster.SetProjection(wgs84.ExportToWkt())
    for band in range(pixels.shape[0]):
        raster.GetRasterBand(band + 1).WriteArray(pixels[band])


def make_sources(folder):
    """Returns the marks, (latitude, longitude) each, by centre."""
    marks, layers = [], {"imagery": [], "elevation": []}
    step = 0.003
    count = int(EXTENT_DEG / step)
    for number, (latitude, longitude) in enumerate(CENTRES):
        west, north = longitude - EXTENT_DEG / 2, latitude + EXTENT_DEG / 2
        columns = west + (numpy.arange(count) + 0.5) * step
        rows = north - (numpy.arange(count) + 0.5) * step
        image = numpy.full((3, count, count), 30, numpy.uint8)
        own = []
        offsets = numpy.arange(-EXTENT_DEG / 2 + SPACING_DEG, EXTENT_DEG / 2, SPACING_DEG)
        for dy in offsets:
            for dx in offsets:
                mark = (latitude + dy, longitude + dx)
                squeeze = numpy.cos(numpy.radians(mark[0]))
                near = ((rows[:, None] - mark[0]) ** 2 + ((columns[None, :] - mark[1]) * squeeze) ** 2) < MARK_DEG ** 2
                image[:, near] = 255
                own.append(mark)
        marks.append(own)
        hills = 800 + 600 * numpy.sin(columns[None, ::4] * 9) * numpy.cos(rows[::4, None] * 7)
        write_raster(folder / f"marks{number}.tif", image, west, north, step)
        write_raster(folder / f"hills{number}.tif", hills[None].astype(numpy.float32), west, north, 4 * step)
        layers["imagery"].append(f'[[layer.source]]\npath = "marks{number}.tif"\n')
        layers["elevation"].append(f'[[layer.source]]\npath = "hills{number}.tif"\ndatum = "ellipsoid"\n')
    spec = "".join(f'[[layer]]\nname = "{name}"\nkind = "{name}"\n' + "".join(sources) for name, sources in layers.items())
    (folder / "marks.toml").write_text(spec)
    return marks


def seen_at(picture, expected, radius_px):
    """Centroid of what is brighter than the ground around the expected pixel, or None where the mark is cut or dim."""
    half = int(radius_px * 2 + 6)
    x, y = int(expected[0]), int(expected[1])
    if x < half or y < half or x >= SIZE[0] - half or y >= SIZE[1] - half:
        return None
    window = picture[y - half:y + half + 1, x - half:x + half + 1].astype(float)
    base = numpy.median(window)
    weight = numpy.clip(window - base - 0.3 * (window.max() - base), 0, None)
    if window.max() - base < 40:
        return None
    ys, xs = numpy.mgrid[y - half:y + half + 1, x - half:x + half + 1]
    return numpy.array([(weight * (xs + 0.5)).sum(), (weight * (ys + 0.5)).sum()]) / weight.sum()


def main(build, work):
    folder = pathlib.Path(work)
    folder.mkdir(parents=True, exist_ok=True)
    marks = make_sources(folder)
    subprocess.run([f"{build}/bin/belvedere-build", str(folder / "marks.toml"), "--out", str(folder / "dataset")], check=True)
    programs = Programs(build, str(folder / "dataset"))
    chance = random.Random(20)
    distances = []
    for pose_number in range(20):
        centre = pose_number % len(CENTRES)
        latitude, longitude = CENTRES[centre]
        pose = (latitude + chance.uniform(-0.3, 0.3), longitude + chance.uniform(-0.3, 0.3), chance.uniform(40e3, 160e3),
                chance.uniform(0, 360), chance.uniform(-90, -50))
        picture_file = str(folder / f"pose{pose_number}.png")
        report = programs.snapshot(pose, SIZE, picture_file, extra=["--layers", "imagery"])
        picture = gdal.Open(picture_file).ReadAsArray()[0]
        places = numpy.array(marks[centre])
        heights = programs.heights(places[:, 0], places[:, 1])
        pixels, depth = to_pixels(report["clip_from_ecef"], to_ecef(places[:, 0], places[:, 1], heights), *SIZE)
        own = []
        for pixel, far in zip(pixels, depth):
            radius_px = MARK_DEG * 111e3 * SIZE[1] / 2 / numpy.tan(numpy.radians(30)) / far
            if far <= 0 or radius_px < 2:
                continue
            seen = seen_at(picture, pixel, radius_px)
            if seen is not None:
                own.append(float(numpy.hypot(*(seen - pixel))))
        if not own:
            print(f"pose {pose_number}: no mark seen")
            return 1
        print(f"pose {pose_number:2}: {len(own):3} marks, median {numpy.median(own):.2f} px, worst {max(own):.2f} px")
        distances += own
    print(f"{len(distances)} marks in 20 poses: median {numpy.median(distances):.3f} px, worst {max(distances):.3f} px (limit {LIMIT_PX})")
    return 0 if max(distances) <= LIMIT_PX else 1


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2]))
