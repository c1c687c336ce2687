"""Compares the levels of an OME-Zarr with raw files, by zarr-python 2 or 3. Prints a line a check.
usage: compare_levels.py STORE EXPECTED    EXPECTED/L.raw: level L, little-endian, c, z, y, x"""

import sys

import numpy
import zarr

store, expected = sys.argv[1:]
group = zarr.open_group(store, mode="r")
attributes = dict(group.attrs)
multiscale = attributes.get("ome", attributes)["multiscales"][0]
failed = False


def report(what, found, wanted):
    global failed
    same = found.shape == wanted.shape and found.dtype == wanted.dtype and (found == wanted).all()
    failed = failed or not same
    size = "×".join(map(str, found.shape))
    print(f"{'pass' if same else 'FAIL'}\tzarr-python {zarr.__version__}: {what}\t{size} {found.dtype}")


for level, dataset in enumerate(multiscale["datasets"]):
    array = group[dataset["path"]]
    wanted = numpy.fromfile(f"{expected}/{level}.raw", array.dtype).reshape(array.shape)
    report(f"level {level}, whole", array[...], wanted)
    if level == 0:
        part = tuple(slice(n // 3, n - 1) for n in array.shape[1:])
        report("level 0, a region", array[(slice(None), *part)], wanted[(slice(None), *part)])
sys.exit(failed)
