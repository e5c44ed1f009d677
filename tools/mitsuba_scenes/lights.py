"""Skies and lamps, and the camera."""

from pathlib import Path

import numpy as np

from mitsuba_scenes.images import Images, rgb
from mitsuba_scenes.source import Failure, Node, colour, mi, number, numbers

SMALLEST_SUN = 0.001  # degrees across


def turned(v: np.ndarray, axis: np.ndarray, cosine: float, sine: float) -> np.ndarray:
    return cosine * v + sine * np.cross(axis, v) + (1 - cosine) * (axis @ v) * axis


def turn_about(up: np.ndarray, front: np.ndarray) -> float:
    """The degrees by which a sky of vkpm with that `up` has to be turned for its middle to be in front."""
    y = np.array((0.0, 1, 0))
    axis, sine = np.cross(y, up), np.linalg.norm(np.cross(y, up))
    axis = axis / sine if sine > 1e-12 else np.array((1.0, 0, 0))
    middle = turned(np.array((0.0, 0, -1)), axis, y @ up, sine)
    return float(np.degrees(np.arctan2(up @ np.cross(middle, front), middle @ front)))


def envmap(node: Node, images: Images) -> dict:
    """An image of the sky; the middle of Mitsuba's is at +z, and columns go on to -x."""
    file = Path(str(mi.file_resolver().resolve(node.get("filename", ""))))
    if not file.is_file():
        raise Failure(f"{node.place}: there is no image {file}")
    texels = rgb(mi.Bitmap(str(file)))
    linear = node.matrix()[:3, :3]
    linear = linear / np.linalg.norm(linear, axis=0)
    if np.linalg.det(linear) < 0:  # a mirrored sky
        texels, linear = texels[:, ::-1], linear @ np.diag((-1, 1, 1))
    up = linear[:, 1] / np.linalg.norm(linear[:, 1])
    sky = {"image": images.write(np.maximum(np.nan_to_num(texels), 0)),
           "rotation": number(turn_about(up, linear[:, 2])), "up": numbers(up),
           "strength": colour(node.value("scale", 1))}
    if not np.allclose(linear.T @ linear, np.eye(3), atol=1e-4):
        node.lose("shear of the sky")
    return sky


class Lights:
    """The sky and the lamps of a scene."""

    def __init__(self, images: Images):
        self.images = images
        self.environment: dict | None = None
        self.found: list[dict] = []

    def add(self, node: Node) -> None:
        """Adds a light that is no shape."""
        reader = getattr(self, f"add_{node.plugin}", None)
        if reader is None:
            node.lose(f"lights of type {node.plugin}")
            return
        reader(node)

    def spectrum(self, node: Node, name: str) -> list | float:
        child = node.child(name)
        return colour(node.value(name, 1) if child is None else child.spectrum())

    def add_constant(self, node: Node) -> None:
        self.environment = {"radiance": self.spectrum(node, "radiance")}

    def add_envmap(self, node: Node) -> None:
        self.environment = envmap(node, self.images)

    def add_directional(self, node: Node) -> None:
        direction = np.array(node.get("direction")) if "direction" in node else node.matrix()[:3, 2]
        self.found.append({"type": "sun", "direction": numbers(-direction), "angle": SMALLEST_SUN,
                           "irradiance": self.spectrum(node, "irradiance")})

    def add_point(self, node: Node) -> None:
        place = np.array(node.get("position")) if "position" in node else node.matrix()[:3, 3]
        self.found.append({"type": "point", "position": numbers(place), "intensity": self.spectrum(node, "intensity")})

    def add_spot(self, node: Node) -> None:
        if node.child("texture") is not None:
            node.lose("textures of spots (a spot of vkpm sends the same light to all sides; a screen may have one)")
        outer, inner = float(node.values["cutoff_angle"]), float(node.values["beam_width"])
        if inner < outer:
            node.lose("the penumbra of spots, which falls as the angle (in vkpm as the square of a line in the cosine)")
        matrix = node.matrix()
        self.found.append({"type": "spot", "position": numbers(matrix[:3, 3]), "direction": numbers(matrix[:3, 2]),
                           "inner": number(min(inner, outer)), "outer": number(outer),
                           "intensity": self.spectrum(node, "intensity")})


def camera(node: Node) -> tuple[dict, list[int]]:
    """The camera, and the size of its film in pixels."""
    if node.plugin not in ("perspective", "thinlens"):
        raise Failure(f"{node.place}: found a sensor of type {node.plugin}; allowed: perspective or thinlens")
    values, matrix = node.values, node.matrix()
    size = [int(side) for side in values["film.size"]]
    if [int(side) for side in values["film.crop_size"]] != size:
        node.lose("the crop of the film")
    if any(float(values[key]) != 0 for key in values if "principal_point" in key):
        node.lose("the offset of the principal point")
    if np.linalg.det(matrix[:3, :3]) < 0:
        node.lose("a mirrored picture (the camera's transform has a negative determinant)")
    axes = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
    half = np.tan(np.radians(float(values["x_fov"])) / 2) * size[1] / size[0]
    found = {"origin": numbers(matrix[:3, 3]), "target": numbers(matrix[:3, 3] + axes[:, 2]), "up": numbers(axes[:, 1]),
             "fieldOfView": number(np.degrees(2 * np.arctan(half)))}
    if node.plugin == "thinlens":
        found |= {"aperture": number(values["aperture_radius"]), "focusDistance": number(values["focus_distance"])}
    return found, size
