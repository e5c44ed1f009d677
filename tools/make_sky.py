#!/usr/bin/env python3
"""Writes the skies of the shipped scenes, each from a formula, the same bytes every time.

Usage: tools/make_sky.py [FOLDER]    default: scenes/ of this repository
"""

import math
import pathlib
import sys

from make_textures import noise

WIDTH, HEIGHT = 128, 64
SUN = (-0.65, 0.69, 0.30)  # where the evening is brightest; the sun itself is a light of the scenes
DAY_SUN = (-0.52, 0.62, -0.58)  # likewise


def direction(row, column):
    """Of the middle of a texel: row 0 is up, the middle column -z, and columns go on towards +x."""
    angle = math.pi * (row + 0.5) / HEIGHT
    turn = 2 * math.pi * ((column + 0.5) / WIDTH - 0.5)
    return math.sin(angle) * math.sin(turn), math.cos(angle), -math.sin(angle) * math.cos(turn)


def evening(x, y, z):
    """A clear evening: deep blue above, pale at the horizon, a warm glow about the sun; dark ground below."""
    toward = max(0.0, x * SUN[0] + y * SUN[1] + z * SUN[2])
    glow = 1.6 * toward**24 + 0.35 * toward**5
    pale = math.exp(-4.5 * max(y, 0.0))
    above = [0.10 + 0.62 * pale + 0.95 * glow, 0.22 + 0.52 * pale + 0.80 * glow, 0.55 + 0.30 * pale + 0.55 * glow]
    ground = min(max(-20 * y, 0.0), 1.0)
    return [(1 - ground) * a + ground * b for a, b in zip(above, (0.16, 0.14, 0.11), strict=True)]


def day(x, y, z):
    """A day by the sea: blue above, a few clouds, haze at the horizon, water below."""
    pale = math.exp(-6 * y) if y > 0 else math.exp(24 * y)
    toward = max(0.0, x * DAY_SUN[0] + y * DAY_SUN[1] + z * DAY_SUN[2])
    glow = 1.2 * toward**40 + 0.25 * toward**6
    if y < 0:
        return [0.05 + 0.4 * pale, 0.2 + 0.4 * pale, 0.36 + 0.4 * pale]
    above = [0.16 + 0.55 * pale + glow, 0.36 + 0.5 * pale + glow, 0.82 + 0.3 * pale + 0.9 * glow]
    u, v = x / (y + 0.25), z / (y + 0.25)  # on a plane of clouds
    billows = sum(noise(2**k * 1.3 * u, 2**k * 2.2 * v, 997, 997) / 2**k for k in range(4)) / 1.875
    cloud = min(max((billows - 0.52) / 0.22, 0.0), 1.0) * min(1.0, 8 * y)
    shade = 1.25 + 0.8 * glow - 0.5 * max(0.0, billows - 0.7)
    return [(1 - cloud) * a + cloud * shade * b for a, b in zip(above, (0.98, 1.0, 1.04), strict=True)]


def rgbe(color):
    """Radiance's four bytes of a colour."""
    mantissa, exponent = math.frexp(max(color))
    scale = mantissa * 256 / max(color)
    return bytes([*(int(c * scale) for c in color), exponent + 128])


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent / "scenes"
    header = f"#?RADIANCE\n# Written by tools/make_sky.py\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n"
    for name, sky in (("evening.hdr", evening), ("day.hdr", day)):
        texels = b"".join(rgbe(sky(*direction(row, column))) for row in range(HEIGHT) for column in range(WIDTH))
        (folder / name).write_bytes(header.encode() + texels)


if __name__ == "__main__":
    main()
