"""WGS 84 and picture maths shared by the scripts that measure what the programs promise. Degrees, metres, numpy."""
import json
import subprocess

import numpy

EQUATORIAL_RADIUS_M = 6378137.0
FLATTENING = 1 / 298.257223563
E2 = FLATTENING * (2 - FLATTENING)


def to_ecef(latitude_deg, longitude_deg, height_m):
    latitude, longitude = numpy.radians(latitude_deg), numpy.radians(longitude_deg)
    n = EQUATORIAL_RADIUS_M / numpy.sqrt(1 - E2 * numpy.sin(latitude) ** 2)
    return numpy.stack([(n + height_m) * numpy.cos(latitude) * numpy.cos(longitude),
                        (n + height_m) * numpy.cos(latitude) * numpy.sin(longitude),
                        (n * (1 - E2) + height_m) * numpy.sin(latitude)], axis=-1)


def to_geodetic(ecef):
    """Latitude, longitude, height by fixed-point iteration; exact to well under a millimetre up to orbit."""
    x, y, z = ecef[..., 0], ecef[..., 1], ecef[..., 2]
    p = numpy.hypot(x, y)
    latitude = numpy.arctan2(z, p * (1 - E2))
    for _ in range(8):
        n = EQUATORIAL_RADIUS_M / numpy.sqrt(1 - E2 * numpy.sin(latitude) ** 2)
        height = p * numpy.cos(latitude) + z * numpy.sin(latitude) - EQUATORIAL_RADIUS_M ** 2 / n
        latitude = numpy.arctan2(z, p * (1 - E2 * n / (n + height)))
    return numpy.degrees(latitude), numpy.degrees(numpy.arctan2(y, x)), height


def to_pixels(clip_from_ecef, ecef, width, height):
    """Pixel coordinates, x from the left, y from the top, the first pixel's middle at 0.5."""
    clip = numpy.concatenate([ecef, numpy.ones(ecef.shape[:-1] + (1,))], axis=-1) @ clip_from_ecef.T
    return (numpy.stack([(clip[..., 0] / clip[..., 3] + 1) * width / 2,
                         (1 - clip[..., 1] / clip[..., 3]) * height / 2], axis=-1), clip[..., 3])


class Programs:
    """Runs the built programs of one build folder."""

    def __init__(self, build, dataset):
        self.build, self.dataset = build, dataset

    def snapshot(self, pose, size, out, depth=None, extra=()):
        """pose: lat, lon, height, heading, pitch. Returns the report with clip_from_ecef as a matrix."""
        command = [f"{self.build}/bin/belvedere", "snapshot", self.dataset, "--size", f"{size[0]}x{size[1]}", "--json", "--out", out]
        for name, value in zip(("lat", "lon", "height", "heading", "pitch"), pose):
            command.append(f"--{name}={value}")
        if depth:
            command += ["--depth", depth]
        done = subprocess.run(command + list(extra), check=True, capture_output=True, text=True)
        report = json.loads(done.stdout)
        report["clip_from_ecef"] = numpy.array(report["clip_from_ecef"], dtype=float).reshape(4, 4)
        return report

    def heights(self, latitudes, longitudes):
        """Ellipsoid heights of the finest surface at the places."""
        places = "".join(f"{a:.10f} {o:.10f}\n" for a, o in zip(latitudes, longitudes))
        done = subprocess.run([f"{self.build}/bin/belvedere", "height", self.dataset], input=places, check=True,
                              capture_output=True, text=True)
        return numpy.array([float(line.split()[2]) for line in done.stdout.splitlines()])
