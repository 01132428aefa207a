#!/usr/bin/python3
"""Killed builds: whatever moment the builder is killed at, a whole dataset is there.

Makes small sources and a dataset of them, then starts builds that would replace it and ends each with SIGKILL at a
random moment; each goes on with what the one before has left. Then the same with `add` and `remove`. After each, `belvedere-build verify` must pass, and the dataset must hold the pages that it held before,
in a store of the same bytes, or, where the kill came too late, those of the new one. Prints how many were killed and what
they left; exits 1 when one left something else.

Usage: killed_builds.py BELVEDERE_BUILD WORK_FOLDER [--kills N] [--seed S]
"""
import argparse
import hashlib
import pathlib
import random
import shutil
import subprocess
import sys
import time

import numpy
from osgeo import gdal, osr

gdal.UseExceptions()


def write_noise(path, seed, columns, west, north, step):
    """Heights that no codec shrinks, twice as wide as high."""
    heights = numpy.random.default_rng(seed).integers(0, 8000, (columns // 2, columns)).astype(numpy.float32)
    raster = gdal.GetDriverByName("GTiff").Create(str(path), columns, columns // 2, 1, gdal.GDT_Float32)
    raster.SetGeoTransform((west, step, 0, north, 0, -step))
    wgs84 = osr.SpatialReference()
    wgs84.ImportFromEPSG(4326)
    raster.SetProjection(wgs84.ExportToWkt())
    raster.GetRasterBand(1).WriteArray(heights)


class Datasets:
    """What the tests do with belvedere-build, and what must be true afterwards."""

    def __init__(self, program, folder):
        self.program = program
        self.folder = folder
        self.store = folder / "dataset" / "data.mdb"

    def write_spec(self, name, sources):
        text = '[[layer]]\nname = "elevation"\nkind = "elevation"\n'
        text += "".join(f'[[layer.source]]\npath = "{source}"\n' for source in sources)
        (self.folder / name).write_text(text)

    def start(self, *arguments):
        return subprocess.Popen([self.program, *arguments], cwd=self.folder, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True)

    def run(self, *arguments):
        """Seconds that it took."""
        began = time.monotonic()
        process = self.start(*arguments)
        _, errors = process.communicate()
        if process.returncode != 0:
            sys.exit(f"belvedere-build {' '.join(arguments)} failed: {errors}")
        return time.monotonic() - began

    def digest(self, dataset="dataset"):
        """Of its pages, or what verify says against it."""
        done = subprocess.run([self.program, "verify", dataset], cwd=self.folder, capture_output=True, text=True)
        return done.stdout.split()[-1] if done.returncode == 0 else done.stdout + done.stderr

    def store_hash(self):
        return hashlib.sha256(self.store.read_bytes()).hexdigest()

    def killed(self, arguments, after_s):
        """Whether it was killed, rather than done before."""
        process = self.start(*arguments)
        try:
            process.communicate(timeout=after_s)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
        return process.returncode < 0


class Tally:
    """Kills by what they left."""

    def __init__(self):
        self.killed = self.old = self.new = self.late = 0
        self.problems = []

    def count(self, was_killed, found, old, new, store_is_old, what):
        self.killed += was_killed
        self.late += not was_killed
        if found == new:
            self.new += 1
        elif found == old and store_is_old:
            self.old += 1
        else:
            self.problems.append(f"{what}: the dataset is neither the old nor the new one: {found}")

    def line(self, what):
        return (f"{what}: {self.killed} killed, {self.late} done before; {self.old} left the old dataset, {self.new} "
                f"the new one, {len(self.problems)} neither")


def kill_builds(datasets, kills, chance):
    """Full builds over a dataset that is there."""
    tally = Tally()
    datasets.run("new.toml", "--out", "dataset", "--no-report")
    new = datasets.digest()
    datasets.run("old.toml", "--out", "dataset", "--no-report")
    old = datasets.digest()
    whole_s = datasets.run("new.toml", "--out", "timed", "--no-report")
    store = datasets.store_hash()
    while tally.killed < kills:
        was_killed = datasets.killed(("new.toml", "--out", "dataset", "--no-report"), chance.uniform(0, 1.05 * whole_s))
        tally.count(was_killed, datasets.digest(), old, new, datasets.store_hash() == store, f"build {tally.killed}")
        if datasets.store_hash() != store:
            datasets.run("old.toml", "--out", "dataset", "--no-report")
            store = datasets.store_hash()
    return tally


def kill_changes(datasets, kills, chance):
    """Additions of a source that is not there, removals of the one that is."""
    tally = Tally()
    datasets.run("old.toml", "--out", "dataset", "--no-report")
    without = datasets.digest()
    change_s = datasets.run("add", "dataset", "inset.toml", "--no-report")
    within = datasets.digest()
    is_there = True
    while tally.killed < kills:
        command = ("remove", "dataset", "inset.tif") if is_there else ("add", "dataset", "inset.toml")
        was_killed = datasets.killed((*command, "--no-report"), chance.uniform(0, 1.05 * change_s))
        found = datasets.digest()
        old, new = (within, without) if is_there else (without, within)
        tally.count(was_killed, found, old, new, True, f"{command[0]} {tally.killed}")
        if found in (within, without):
            is_there = found == within
        if tally.problems:
            break
    return tally


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    shutil.rmtree(options.folder, ignore_errors=True)
    options.folder.mkdir(parents=True)
    datasets = Datasets(options.program.resolve(), options.folder)
    write_noise(options.folder / "world.tif", 1, 256, -180, 90, 360 / 256)
    write_noise(options.folder / "finer.tif", 2, 1024, -180, 90, 360 / 1024)
    datasets.write_spec("old.toml", ["world.tif"])
    datasets.write_spec("new.toml", ["world.tif", "finer.tif"])
    datasets.write_spec("inset.toml", ["inset.tif"])
    write_noise(options.folder / "inset.tif", 3, 1024, 10, 50, 0.005)
    chance = random.Random(options.seed)
    problems = []
    for what, kill in (("builds", kill_builds), ("changes", kill_changes)):
        tally = kill(datasets, options.kills, chance)
        print(tally.line(what))
        problems += tally.problems
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
