"""Reading of the OpenEXR files that vkpm writes, one part, ZIP; Blender's own reader gives scripts Combined alone."""

import struct
import zlib

import numpy as np

TYPES = {0: "<u4", 1: "<f2", 2: "<f4"}  # OpenEXR's numbers of whole numbers, halves and floats


class BadExr(ValueError):
    """What is wrong with a file."""


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _header(data):
    """The attributes of the header as bytes by name, and where it ends."""
    if data[:4] != b"\x76\x2f\x31\x01":
        raise BadExr("is no OpenEXR file")
    attributes, at = {}, 8
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def _channels(data):
    """Names with types, in the order of the file."""
    found, at = [], 0
    while data[at]:
        name, at = _text(data, at)
        (kind,) = struct.unpack_from("<i", data, at)
        found.append((name, np.dtype(TYPES[kind])))
        at += 16
    return found


def _unzipped(packed, size):
    """A chunk's bytes: deflate, then sums of neighbours, then halves that alternate (OpenEXR's ZIP)."""
    if len(packed) == size:
        return packed
    raw = np.frombuffer(zlib.decompress(packed), np.uint8)
    steps = raw.astype(np.int64)
    steps[1:] -= 128
    summed = (np.cumsum(steps) & 255).astype(np.uint8)
    result = np.empty(size, np.uint8)
    half = (size + 1) // 2
    result[0::2], result[1::2] = summed[:half], summed[half:]
    return result.tobytes()


def read(path):
    """All channels by name, each an array [height, width] of floats, the upper row first. Raises BadExr, OSError."""
    with open(path, "rb") as file:
        data = file.read()
    try:
        attributes, at = _header(data)
        x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
        compression = attributes["compression"][0]
        if compression not in (0, 2, 3):
            raise BadExr("is compressed in another way than ZIP")
        width, height = x1 - x0 + 1, y1 - y0 + 1
        channels, rows = _channels(attributes["channels"]), {0: 1, 2: 1, 3: 16}[compression]
        image = {name: np.empty((height, width), np.float32) for name, _ in channels}
        row_bytes = width * sum(kind.itemsize for _, kind in channels)
        for place in struct.unpack_from(f"<{-(-height // rows)}Q", data, at):
            y, size = struct.unpack_from("<ii", data, place)
            count = min(rows, height - (y - y0))
            block = _unzipped(data[place + 8 : place + 8 + size], count * row_bytes)
            for line in range(count):
                column = line * row_bytes
                for name, kind in channels:
                    image[name][y - y0 + line] = np.frombuffer(block, kind, width, column)
                    column += width * kind.itemsize
    except (KeyError, IndexError, struct.error, zlib.error, UnicodeDecodeError) as error:
        raise BadExr(f"is damaged: {error}") from error
    return image
