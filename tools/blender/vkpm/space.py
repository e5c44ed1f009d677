"""From Blender's axes (z up) to those of glTF and vkpm (y up)."""

import math


def place(vector):
    """x, y, z of Blender as vkpm's list of numbers."""
    x, y, z = vector
    return [x, z, -y]


def axis(matrix, index):
    """A column of a 4 x 4 matrix, not normalised."""
    return matrix.to_3x3().col[index]


def colour(values):
    """The first three of a colour's numbers, linear Rec. 709."""
    return [max(0.0, float(value)) for value in values[:3]]


def times(values, factor):
    return [value * factor for value in values]


def product(first, second):
    return [a * b for a, b in zip(first, second, strict=True)]


def beside(file, what):
    """A file that belongs to a scene file."""
    return file.with_name(f"{file.stem}_{what}")


def degrees(radians):
    return math.degrees(radians)
