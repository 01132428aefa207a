#!/usr/bin/python3
"""Parts of a dataset that several processes make come to the same pages as one process makes.

    shards_test.py BELVEDERE_BUILD SLURM_SCRIPT

By --shard and --merge, by mpirun with two ranks, and by the Slurm script with stand-ins for sbatch that run the jobs
here. Parts that are missing, damaged or of other sources are refused; a source that one part finds to be bad is in no page.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy
from osgeo import gdal, osr

gdal.UseExceptions()
FAILURES = []


def fail(text):
    print(text)
    FAILURES.append(text)


def noise(path, width, height, transform, bands, seed, most):
    random = numpy.random.default_rng(seed)
    raster = gdal.GetDriverByName("GTiff").Create(str(path), width, height, bands, gdal.GDT_Byte if bands == 3 else gdal.GDT_Int16)
    crs = osr.SpatialReference()
    crs.ImportFromEPSG(4326)
    raster.SetProjection(crs.ExportToWkt())
    raster.SetGeoTransform(transform)
    for band in range(bands):
        raster.GetRasterBand(band + 1).WriteArray(random.integers(0, most, (height, width)))


class Test:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def build(self, out, *words, env=None, before=()):
        return subprocess.run([*before, self.program, self.folder / "spec.toml", "--out", self.folder / out, "--no-report", *words],
                              capture_output=True, text=True, check=False, env={**os.environ, **(env or {})})

    def must(self, what, result):
        if result.returncode != 0:
            fail(f"{what}: exit code {result.returncode}: {result.stderr}")

    def digest(self, out):
        verified = subprocess.run([self.program, "verify", self.folder / out], capture_output=True, text=True, check=False)
        found = re.search(r"all (\d+) pages are good, digest (\w+)", verified.stdout)
        if not found:
            fail(f"{out}: {verified.stdout}{verified.stderr}")
        return found and found.groups()

    def expect_same(self, what, out):
        if self.digest(out) != self.digest("whole"):
            fail(f"{what}: {self.digest(out)}, not {self.digest('whole')}")
        if (self.folder / (out + ".shards")).exists():
            fail(f"{what}: the parts are left")

    def expect_refused(self, what, result, part):
        if result.returncode != 1 or part not in result.stderr:
            fail(f"{what}: exit code {result.returncode}, and no word of \"{part}\": {result.stderr}")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        noise(folder / "world.tif", 256, 128, (-180, 360 / 256, 0, 90, 0, -360 / 256), 1, 1, 40)
        noise(folder / "inset.tif", 300, 200, (10, 0.01, 0, 50, 0, -0.01), 1, 2, 3000)
        noise(folder / "colours.tif", 1024, 512, (-180, 360 / 1024, 0, 90, 0, -360 / 1024), 3, 3, 256)
        (folder / "places.csv").write_text("lon,lat,name\n" + "".join(f"{i},{i / 2},place {i}\n" for i in range(90)))
        layers = """[[layer]]
name = "elevation"
kind = "elevation"
[[layer.source]]
path = "world.tif"
[[layer.source]]
path = "{inset}"
[[layer]]
name = "imagery"
kind = "imagery"
[[layer.source]]
path = "colours.tif"
[[layer]]
name = "slopes"
kind = "slope angle"
[[layer]]
name = "places"
kind = "vector"
[[layer.source]]
path = "places.csv"
features = "place"
"""
        spec = folder / "spec.toml"
        spec.write_text(layers.format(inset="inset.tif"))
        test = Test(pathlib.Path(sys.argv[1]).resolve(), folder)
        test.must("whole", test.build("whole"))

        test.must("shard 1", test.build("parts", "--shard", "1/3"))
        test.must("shard 3", test.build("parts", "--shard", "3/3"))
        test.expect_refused("a part is missing", test.build("parts", "--merge", "3"), "--shard 2/3")
        test.must("shard 2", test.build("parts", "--shard", "2/3"))
        again = test.build("parts", "--shard", "2/3")
        if "whole already" not in again.stderr:
            fail(f"a part is made twice: {again.stderr}")
        shutil.copytree(folder / "parts.shards", folder / "damaged.shards")
        test.must("merge", test.build("parts", "--merge", "3"))
        test.expect_same("three parts", "parts")

        store = folder / "damaged.shards" / "2-of-3.partial" / "data.mdb"
        data = bytearray(store.read_bytes())
        at = data.find(b"BVPG") + 200
        data[at] ^= 255
        store.write_bytes(data)
        test.expect_refused("a damaged part", test.build("damaged", "--merge", "3"), "--shard 2/3 --fresh")
        test.must("the damaged part again", test.build("damaged", "--shard", "2/3", "--fresh"))
        test.must("merge after damage", test.build("damaged", "--merge", "3"))
        test.expect_same("a part made again", "damaged")

        as_root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
        mpirun = ["mpirun", *as_root, "--oversubscribe", "-n", "2"]
        test.must("two ranks", test.build("ranks", "--jobs", "1", before=mpirun))
        test.expect_same("two ranks", "ranks")

        # sbatch: tasks and jobs at once, here.
        stand_in = folder / "bin" / "sbatch"
        stand_in.parent.mkdir()
        stand_in.write_text("""#!/bin/bash
set -e
array=
while [[ "$1" == --* ]]; do
  case "$1" in
    --array=1-*) array="${1#--array=1-}" ;;
    --export=ALL,*) export "${1#--export=ALL,}" ;;
  esac
  shift
done
if [ -n "$array" ]; then
  for task in $(seq "$array"); do SLURM_ARRAY_TASK_ID=$task "$@" >&2; done
else
  "$@" >&2
fi
echo 17
""")
        stand_in.chmod(0o755)
        slurm = subprocess.run([sys.argv[2], spec, folder / "slurm", "3"], capture_output=True, text=True, check=False,
                               env={**os.environ, "PATH": f"{stand_in.parent}:{os.environ['PATH']}",
                                    "BELVEDERE_BUILD": str(test.program)})
        test.must("the Slurm script", slurm)
        test.expect_same("the Slurm script", "slurm")

        # Parts of other sources are refused, and left as they are.
        test.must("an old part", test.build("old", "--shard", "1/1"))
        noise(folder / "inset.tif", 300, 200, (10, 0.01, 0, 50, 0, -0.01), 1, 4, 3000)
        test.expect_refused("a part of other sources", test.build("old", "--merge", "1"), "other sources")
        if not (folder / "old.shards" / "1-of-1.partial" / "data.mdb").exists():
            fail("a part of other sources is gone")

        # A source that is cut short where one part alone reads it.
        with (folder / "inset.tif").open("r+b") as file:
            file.truncate((folder / "inset.tif").stat().st_size * 2 // 3)
        test.must("whole without it", test.build("whole"))
        for number in (1, 2):
            test.must(f"shard {number} of a bad source", test.build("bad", "--shard", f"{number}/2"))
        test.must("merge with a bad source", test.build("bad", "--merge", "2"))
        test.expect_same("a bad source", "bad")

        for words in (("--shard", "0/2"), ("--shard", "3/2"), ("--shard", "2"), ("--shard", "1/2", "--merge", "2")):
            if test.build("x", *words).returncode != 2:
                fail(f"{words} is taken")
    return 1 if FAILURES else 0


if __name__ == "__main__":
    sys.exit(main())
