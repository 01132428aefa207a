#!/usr/bin/python3
"""Measures what the dataset builder promises (docs/performance.md) and prints it as a table, each row with its peer.

    bench_builder.py BIN HEIGHTS.tif IMAGE.jpg [--quick] [--work DIR]

BIN holds belvedere-build (build/bin); HEIGHTS.tif and IMAGE.jpg are srtm90.tif and bmng.jpg of ./demo. The large source
is HEIGHTS.tif refined by a fractal (tests/figures/refine_heights.py): 554 MB, --quick 38 MB. The whole takes a quarter of an
hour and 8 GB in DIR. Each pair is measured in turns, three times, and the median ratio counts. Exits 1 when a program
fails; a limit that is not kept is marked and is no failure, for machines differ.
"""

import argparse
import os
import pathlib
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
RUNS = 3


class Problem(Exception):
    """One line for a person."""


def run(*command):
    """Seconds and peak memory in MiB of a command."""
    words = [str(word) for word in command]
    print("bench_builder:", " ".join(words), file=sys.stderr, flush=True)
    with tempfile.TemporaryFile() as said:
        start = time.monotonic()
        child = subprocess.Popen(words, stdout=said, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(child.pid, 0)
        seconds = time.monotonic() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            said.seek(0)
            raise Problem(f"{' '.join(words)}: {said.read().decode(errors='replace').strip()[-500:]}")
    return seconds, usage.ru_maxrss / 1024


def size_of(path):
    return sum(file.stat().st_size for file in path.rglob("*") if file.is_file()) if path.is_dir() else path.stat().st_size


class Bench:
    def __init__(self, options):
        self.builder = pathlib.Path(options.bin) / "belvedere-build"
        self.heights, self.image = pathlib.Path(options.heights).resolve(), pathlib.Path(options.image).resolve()
        self.quick = options.quick
        self.work = pathlib.Path(options.work)
        self.rows = []

    def add(self, what, limit, value, kept):
        self.rows.append((what, limit, value, "yes" if kept else "NO"))

    def spec(self, name, kind, source, more=""):
        path = self.work / f"{name}.toml"
        path.write_text(f'[[layer]]\nname = "{name}"\nkind = "{kind}"\n  [[layer.source]]\n  path = "{source}"\n{more}')
        return path

    def build(self, spec, jobs=2, before=()):
        out = self.work / "dataset"
        shutil.rmtree(out, ignore_errors=True)
        return run(*before, self.builder, spec, "--out", out, "--jobs", jobs, "--no-report")

    def refined(self, doublings):
        path = self.work / f"refined-{doublings}.tif"
        run(HERE / "figures" / "refine_heights.py", self.heights, path, doublings)
        return path

    def imagery(self):
        text = subprocess.run([HERE / "benchmarks" / "build_rate.sh", self.builder, self.image, str(RUNS)],
                              capture_output=True, text=True, check=True).stdout
        ratio = float(text.split("median ratio")[1])
        self.add("imagery quadnodes/s over those of gdal2tiles.py --processes=2", ">= 5", f"{ratio:.1f}", ratio >= 5)

    def elevation(self, source):
        spec = self.spec("elevation", "elevation", source, '  datum = "ellipsoid"\n')
        cog = self.work / "peer.tif"
        ours, theirs, one, two, ranks = [], [], [], [], []
        as_root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
        for _ in range(RUNS):
            cog.unlink(missing_ok=True)
            theirs.append(run("gdalwarp", "-q", "-multi", "-wo", "NUM_THREADS=2", "-wm", 512, "-t_srs", "EPSG:4326", "-r",
                              "bilinear", "-of", "COG", "-co", "COMPRESS=ZSTD", "-co", "PREDICTOR=YES", "-co",
                              "NUM_THREADS=2", "-co", "BIGTIFF=IF_SAFER", source, cog)[0])
            two.append(self.build(spec)[0])
            one.append(self.build(spec, 1)[0])
            ranks.append(self.build(spec, 1, ["mpirun", *as_root, "-n", "2"])[0])
            ours.append(two[-1])
        megabytes = size_of(source) / 1e6
        ratio = statistics.median(a / b for a, b in zip(ours, theirs))
        self.add(f"{megabytes:.0f} MB of heights: time over that of gdalwarp to a COG", "<= 1.25",
                 f"{ratio:.2f} ({megabytes / min(ours):.1f} for {megabytes / min(theirs):.1f} MB/s)", ratio <= 1.25)
        ratio = statistics.median(a / b for a, b in zip(one, two))
        self.add("speed-up from 1 to 2 workers", ">= 1.8", f"{ratio:.2f}", ratio >= 1.8)
        ratio = statistics.median(a / b for a, b in zip(one, ranks))
        self.add("speed-up from 1 to 2 ranks", ">= 1.7", f"{ratio:.2f}", ratio >= 1.7)

    def size(self, source):
        """The last dataset that was built against its source, losslessly packed, and a third for the levels."""
        packed = self.work / "packed.tif"
        run("gdal_translate", "-q", "-co", "COMPRESS=ZSTD", "-co", "PREDICTOR=2", "-co", "ZSTD_LEVEL=9", "-co", "TILED=YES",
            source, packed)
        limit = size_of(packed) * 4 / 3
        ratio = size_of(self.work / "dataset") / limit
        self.add("bytes of that dataset over its source's, packed without loss, and a third", "<= 1", f"{ratio:.2f}",
                 ratio <= 1)

    def memory(self, source, larger):
        peaks = []
        for path in (source, larger):
            peaks.append(self.build(self.spec("elevation", "elevation", path, '  datum = "ellipsoid"\n'))[1])
        ratio = peaks[1] / peaks[0]
        self.add("peak memory, source of four times the size over the source", "<= 1.2, under 1024 MiB",
                 f"{ratio:.2f} ({peaks[0]:.0f}, {peaks[1]:.0f} MiB)", ratio <= 1.2 and max(peaks) < 1024)

    def all(self):
        self.imagery()
        source = self.refined(1 if self.quick else 3)
        self.elevation(source)
        self.size(source)
        self.memory(source, self.refined(2 if self.quick else 4))

    def print_table(self):
        print(f"{platform.machine()}, {platform.system()} {platform.release()}; {'quick' if self.quick else 'whole'} run\n")
        print("| what | limit | measured | kept |\n| --- | --- | --- | --- |")
        for row in self.rows:
            print("| " + " | ".join(row) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("heights")
    parser.add_argument("image")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--work", help="folder for what is made, deleted at the end (default: a temporary one)")
    options = parser.parse_args()
    failed = False
    with tempfile.TemporaryDirectory(dir=options.work) as folder:
        options.work = folder
        bench = Bench(options)
        try:
            bench.all()
        except (Problem, OSError, subprocess.CalledProcessError, ValueError, IndexError) as problem:
            print(f"bench_builder: {problem}", file=sys.stderr)
            failed = True
        finally:
            bench.print_table()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
