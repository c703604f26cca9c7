#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""terrain_samples.py FOLDER: writes one small hilly elevation model in several formats, to see
that a GDAL reads them. Python's standard library only."""
import gzip
import math
import struct
import sys
import zipfile
import zlib
from pathlib import Path

SIZE = 257
WEST, NORTH, POST = 600000.0, 5200000.0, 30.0  # UTM, zone 10 north
UTM = 32610


def height(column, row):
    x, y = column / SIZE, row / SIZE
    return 900 + 500 * math.sin(7 * x) * math.cos(5 * y) + 60 * math.sin(41 * x + 23 * y)


def posts(form, order="<"):
    rounded = float if form == "f" else round
    return struct.pack(f"{order}{SIZE * SIZE}{form}",
                       *(rounded(height(c, r)) for r in range(SIZE) for c in range(SIZE)))


def geotiff():
    """32-bit floats, one strip, deflated; keys for the CRS."""
    strip = zlib.compress(posts("f"))
    keys = [1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, UTM]
    doubles = {33550: (POST, POST, 0), 33922: (0, 0, 0, WEST, NORTH, 0)}
    shorts = {258: 32, 259: 8, 262: 1, 277: 1, 339: 3}
    longs = {256: SIZE, 257: SIZE, 273: 8, 278: SIZE, 279: len(strip)}
    entries, extra = [], b""
    count = len(doubles) + len(shorts) + len(longs) + 1
    directory = 8 + len(strip) + len(strip) % 2
    behind = directory + 2 + 12 * count + 4
    for tag in sorted([*doubles, *shorts, *longs, 34735]):
        if tag in shorts:
            entries.append(struct.pack("<HHIHxx", tag, 3, 1, shorts[tag]))
        elif tag in longs:
            entries.append(struct.pack("<HHII", tag, 4, 1, longs[tag]))
        else:
            values = doubles.get(tag, keys)
            entries.append(struct.pack("<HHII", tag, 12 if tag in doubles else 3, len(values),
                                       behind + len(extra)))
            extra += struct.pack(f"<{len(values)}{'d' if tag in doubles else 'H'}", *values)
    return (struct.pack("<2sHI", b"II", 42, directory) + strip.ljust(directory - 8, b"\0") +
            struct.pack("<H", count) + b"".join(entries) + bytes(4) + extra)


def ascii_grid():
    head = (f"ncols {SIZE}\nnrows {SIZE}\nxllcorner {WEST}\nyllcorner {NORTH - SIZE * POST}\n"
            f"cellsize {POST}\nNODATA_value -9999\n")
    return head + "".join(" ".join(f"{height(c, r):.3f}" for c in range(SIZE)) + "\n"
                          for r in range(SIZE))


def terragen():
    return (b"TERRAGENTERRAIN " + b"SIZE" + struct.pack("<hxx", SIZE - 1) + b"SCAL" +
            struct.pack("<3f", POST, POST, POST) + b"ALTW" + struct.pack("<hh", 2048, 0) +
            posts("h") + b"EOF ")


def vrt():
    return (f'<VRTDataset rasterXSize="{SIZE}" rasterYSize="{SIZE}"><SRS>EPSG:{UTM}</SRS>'
            f"<GeoTransform>{WEST},{POST},0,{NORTH},0,-{POST}</GeoTransform>"
            '<VRTRasterBand dataType="Float32" band="1"><SimpleSource>'
            '<SourceFilename relativeToVRT="1">grid.tif</SourceFilename>'
            "</SimpleSource></VRTRasterBand></VRTDataset>")


def srtm():
    """A degree of three seconds, by its name at 46° N, 121° W."""
    return gzip.compress(struct.pack(">1442401h", *(round(height(c / 5, r / 5))
                                                    for r in range(1201) for c in range(1201))), 1)


def main():
    folder = Path(sys.argv[1])
    (folder / "grid.tif").write_bytes(geotiff())
    (folder / "grid.asc").write_text(ascii_grid())
    (folder / "grid.ter").write_bytes(terragen())
    (folder / "grid.vrt").write_text(vrt())
    (folder / "grid.xyz").write_text("".join(
        f"{WEST + c * POST} {NORTH - r * POST} {height(c, r):.2f}\n"
        for r in range(SIZE) for c in range(SIZE)))
    (folder / "lines.bil").write_bytes(posts("h"))
    (folder / "lines.hdr").write_text(
        f"NROWS {SIZE}\nNCOLS {SIZE}\nNBANDS 1\nNBITS 16\nPIXELTYPE SIGNEDINT\nBYTEORDER I\n"
        f"LAYOUT BIL\nULXMAP {WEST}\nULYMAP {NORTH}\nXDIM {POST}\nYDIM {POST}\n")
    (folder / "N46W121.hgt.gz").write_bytes(srtm())
    with zipfile.ZipFile(folder / "grid.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(folder / "grid.tif", "grid.tif")


main()
