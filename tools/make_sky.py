#!/usr/bin/env python3
"""Writes the sky of the shipped scenes from a formula, the same bytes every time.

Usage: tools/make_sky.py [FOLDER]    default: scenes/ of this repository
"""

import math
import pathlib
import sys

WIDTH, HEIGHT = 128, 64
SUN = (-0.65, 0.69, 0.30)  # where the sky is brightest; the sun itself is a light of the scenes


def direction(row, column):
    """Of the middle of a texel: row 0 is up, the middle column -z, and columns go on towards +x."""
    angle = math.pi * (row + 0.5) / HEIGHT
    turn = 2 * math.pi * ((column + 0.5) / WIDTH - 0.5)
    return math.sin(angle) * math.sin(turn), math.cos(angle), -math.sin(angle) * math.cos(turn)


def sky(x, y, z):
    """A clear evening: deep blue above, pale at the horizon, a warm glow about the sun; dark ground below."""
    toward = max(0.0, x * SUN[0] + y * SUN[1] + z * SUN[2])
    glow = 1.6 * toward**24 + 0.35 * toward**5
    pale = math.exp(-4.5 * max(y, 0.0))
    above = [0.10 + 0.62 * pale + 0.95 * glow, 0.22 + 0.52 * pale + 0.80 * glow, 0.55 + 0.30 * pale + 0.55 * glow]
    ground = min(max(-20 * y, 0.0), 1.0)
    return [(1 - ground) * a + ground * b for a, b in zip(above, (0.16, 0.14, 0.11), strict=True)]


def rgbe(color):
    """Radiance's four bytes of a colour."""
    mantissa, exponent = math.frexp(max(color))
    scale = mantissa * 256 / max(color)
    return bytes([*(int(c * scale) for c in color), exponent + 128])


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent / "scenes"
    texels = b"".join(rgbe(sky(*direction(row, column))) for row in range(HEIGHT) for column in range(WIDTH))
    header = f"#?RADIANCE\n# Written by tools/make_sky.py\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n"
    (folder / "evening.hdr").write_bytes(header.encode() + texels)


if __name__ == "__main__":
    main()
