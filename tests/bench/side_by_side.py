"""What the measuring scripts of this folder share: files of planes, runs of programs, spreads over
rounds, Markdown tables, and taking a sample out of the page cache.

A figure is measured once in each round, all programs in turn; what is reported of it is the median
over the rounds with the least and the most."""

import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import time

FOLDER = pathlib.Path(__file__).resolve().parent
PROGRAMS = FOLDER.parent.parent / "build" / "release" / "bin"


class Failure(Exception):
    """Ends a script with one line on stderr."""


def run_script(main):
    """Calls main() and turns failures into exit codes."""
    try:
        main()
    except Failure as failure:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {failure}")
    except KeyboardInterrupt:
        sys.exit(130)


def say(text):
    """Progress: on stderr, since stdout carries the tables."""
    print(text, file=sys.stderr, flush=True)


def positive(text):
    """A whole number above 0, for argparse."""
    number = int(text)
    if number < 1:
        raise ValueError
    return number


def built(name, folder=PROGRAMS):
    """The path of a program of ours."""
    path = pathlib.Path(folder) / name
    if not path.is_file():
        raise Failure(
            f"{path} is not there: build it with"
            " 'cmake --preset release -D BIOTOMY_BENCHMARKS=ON && cmake --build --preset release'")
    return path


def peers_folder(text):
    """The folder in which the peers were built."""
    folder = pathlib.Path(text).resolve()
    missing = [name for name in ("bin/w1_vtk", "planes.txt", "data/vol.raw")
               if not (folder / name).exists()]
    if missing:
        raise Failure(f"{folder}: {missing[0]} is not there; the peers' programs are not part of"
                      " this repository: build them in this folder first (docs/performance.md)")
    return folder


class Plane:
    """A plane of a file of planes: a name and three points in voxels."""

    def __init__(self, name, numbers):
        self.name = name
        self.numbers = numbers

    @property
    def rows_in_layers(self):
        """Whether the picture's columns advance within a layer."""
        return self.numbers[2] == self.numbers[5]

    @property
    def points(self):
        """As `biotomy section --points` takes them."""
        return " ".join(",".join(repr(x) for x in self.numbers[i:i + 3]) for i in (0, 3, 6))


def read_planes(path):
    planes = []
    for number, line in enumerate(pathlib.Path(path).read_text(encoding="utf-8").splitlines(), 1):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        try:
            numbers = [float(word) for word in words[1:]]
        except ValueError:
            numbers = []
        if len(numbers) != 9:
            raise Failure(f"{path}: line {number}: must be a name and nine numbers")
        planes.append(Plane(words[0], numbers))
    return planes


def write_planes(path, planes):
    """Without comments, which not every program understands. Returns the path."""
    lines = [" ".join([plane.name, *map(repr, plane.numbers)]) for plane in planes]
    pathlib.Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def run(command):
    """The finished process; a failure carries the last line of its stderr."""
    command = [str(word) for word in command]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise Failure(f"{command[0]} cannot be started: {error.strerror}") from error
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or ["it says nothing"]
        raise Failure(f"{' '.join(command[:2])} … ended with {done.returncode}: {lines[-1]}")
    return done


def timed(command):
    """The finished process and its wall time in seconds."""
    start = time.perf_counter()
    done = run(command)
    return done, time.perf_counter() - start


class Spread:
    """Median, least and most of a figure over the rounds."""

    def __init__(self, values):
        self.values = list(values)
        self.median = statistics.median(self.values)

    def text(self, scale=1.0, digits=2):
        numbers = [f"{scale * x:.{digits}f}"
                   for x in (self.median, min(self.values), max(self.values))]
        return numbers[0] if len(self.values) == 1 else "{} ({}–{})".format(*numbers)


def ratios(ours, theirs):
    """Round by round."""
    return Spread(a / b for a, b in zip(ours, theirs))


def geometric_mean(values):
    return math.exp(statistics.fmean(math.log(value) for value in values))


def table(headings, rows):
    """In Markdown; all columns but the first are aligned to the right."""
    lines = ["| " + " | ".join(headings) + " |", "| --- |" + " ---: |" * (len(headings) - 1)]
    lines += ["| " + " | ".join(map(str, row)) + " |" for row in rows]
    return "\n".join(lines)


def goal(what, value, limit, digits=2):
    """A line that says whether a figure is as small as it was meant to be."""
    verdict = "met" if value <= limit else "missed"
    return f"- {what}: {value:.{digits}f}, at most {limit}: **{verdict}**"


def machine():
    """The processor and how many cores there are to use."""
    model = "unknown processor"
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    return f"{model}, {len(os.sched_getaffinity(0))} cores"


class PageCache:
    """Takes files out of the machine's memory: all that is cached where that is allowed (root),
    else the sample's files alone, whose names and sizes then stay known."""

    def __init__(self):
        self._drop = pathlib.Path("/proc/sys/vm/drop_caches")
        self.all_of_it = os.access(self._drop, os.W_OK)

    def describe(self):
        if self.all_of_it:
            return "the page cache was dropped before each cold run"
        return ("not root, so that before each cold run only the sample's files were taken out of"
                " the page cache, not the folders")

    def forget(self, folder, programs=()):
        """`programs` are commands that are run afterwards, so that what is cold are the data and
        not the programs."""
        os.sync()
        if self.all_of_it:
            self._drop.write_text("3", encoding="ascii")
        else:
            for path in pathlib.Path(folder).rglob("*"):
                if path.is_file():
                    descriptor = os.open(path, os.O_RDONLY)
                    os.posix_fadvise(descriptor, 0, 0, os.POSIX_FADV_DONTNEED)
                    os.close(descriptor)
        for command in programs:
            run(command)


class Tool:
    """`biotomy section`, measured."""

    def __init__(self, folder=PROGRAMS):
        self._program = built("biotomy", folder)
        self.start_command = [self._program, "--version"]
        self._start_s = statistics.median(timed(self.start_command)[1] for _ in range(5))

    def section(self, sample, plane, picture, *options):
        """The line of --stats, with `wall_s`, the whole command's seconds, and `section_s`, those
        until the picture is in memory: as the tool says, or else the command's without its start
        and the picture's encoding."""
        done, wall_s = timed([self._program, "section", sample, "--points", plane.points, "--unit",
                              "voxel", "--stats", "-o", picture, *options])
        stats = json.loads(done.stderr.strip().splitlines()[-1])
        stats.setdefault("section_s", wall_s - stats["encode_s"] - self._start_s)
        stats["wall_s"] = wall_s
        return stats


def touched(sample, planes_file, plane, *options):
    """The line that touched_chunks prints."""
    done = run([built("touched_chunks"), sample, "--planes", planes_file, "--only", plane.name,
                *options])
    return json.loads(done.stdout)
