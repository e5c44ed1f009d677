"""Shapes: rectangles and spheres as they are, all else as meshes in PLY files."""

from pathlib import Path

import numpy as np

from mitsuba_scenes.images import SPECTRA, Images
from mitsuba_scenes.materials import Attribute, Materials, relief
from mitsuba_scenes.source import Failure, Matrix, Node, colour, mi, number, numbers

SEGMENTS = 128  # around discs, cylinders and spheres that become meshes
MESHES = ("obj", "ply", "serialized", "cube", "merge")
CLOSED = ("sphere", "cube")
ONE_SIDED = ("diffuse", "roughdiffuse", "plastic", "roughplastic", "pplastic", "conductor", "roughconductor")


class Mesh:
    """Points, texture coordinates, which go down, and normals, if there are any; triangles, counterclockwise."""

    def __init__(self, points, faces, normals=None, uv=None, colours=None):
        self.points = np.asarray(points, np.float64).reshape(-1, 3)
        self.faces = np.asarray(faces, np.int32).reshape(-1, 3)
        self.normals = None if normals is None or not len(normals) else np.asarray(normals, np.float64).reshape(-1, 3)
        self.uv = None if uv is None or not len(uv) else np.asarray(uv, np.float64).reshape(-1, 2)
        self.colours = colours  # of each corner

    def moved(self, matrix: Matrix) -> "Mesh":
        """The mesh in other coordinates; its outside stays outside, also in a mirror."""
        linear = matrix[:3, :3]
        normals = None if self.normals is None else self.normals @ np.linalg.inv(linear)
        faces = self.faces[:, ::-1] if np.linalg.det(linear) < 0 else self.faces
        return Mesh(self.points @ linear.T + matrix[:3, 3], faces, normals, self.uv)

    def turned(self) -> "Mesh":
        """The mesh inside out."""
        return Mesh(self.points, self.faces[:, ::-1], None if self.normals is None else -self.normals, self.uv)

    def right_handed(self) -> bool:
        """Whether u, v and the outside are as x, y and z; so is what has no coordinates."""
        if self.uv is None:
            return True
        a, b, c = (self.uv[self.faces[:, i]] for i in range(3))
        (x, y), (z, w) = (b - a).T, (c - a).T
        return float(np.sum(x * w - y * z)) >= 0

    def stretch(self) -> tuple[float, float]:
        """How far a step of one in u and one in v goes: the mean over the area."""
        if self.uv is None:
            return 1, 1
        corners, places = self.points[self.faces], self.uv[self.faces]
        edges = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], 1)
        steps = np.stack([places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]], 1)
        areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
        known = (np.abs(np.linalg.det(steps)) > 1e-12) & (areas > 0)
        if not known.any():
            return 1, 1
        lengths = np.linalg.norm(np.linalg.solve(steps[known], edges[known]), axis=2)
        u, v = np.average(lengths, axis=0, weights=areas[known])
        return float(f"{u:.3g}"), float(f"{v:.3g}")

    def write(self, path: Path) -> None:
        """Writes a PLY file, texture coordinates as vkpm has them, which go up."""
        names, columns = ["x", "y", "z"], [self.points]
        if self.normals is not None:
            lengths = np.linalg.norm(self.normals, axis=1, keepdims=True)
            names, columns = [*names, "nx", "ny", "nz"], [*columns, self.normals / np.where(lengths > 0, lengths, 1)]
        if self.uv is not None:
            names, columns = [*names, "s", "t"], [*columns, self.uv * (1, -1) + (0, 1)]
        triangles = self.faces
        if self.colours is not None:  # no two corners share a point
            names = [*names, "red", "green", "blue"]
            columns = [column[triangles].reshape(-1, column.shape[1]) for column in columns]
            columns.append(self.colours.reshape(-1, 3))
            triangles = np.arange(3 * len(triangles)).reshape(-1, 3)
        faces = np.empty(len(self.faces), [("count", "u1"), ("corners", "<i4", 3)])
        faces["count"], faces["corners"] = 3, triangles
        lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(columns[0])}",
                 *(f"property float {name}" for name in names), f"element face {len(faces)}",
                 "property list uchar int vertex_indices", "end_header", ""]
        path.write_bytes("\n".join(lines).encode() + np.hstack(columns).astype("<f4").tobytes() + faces.tobytes())


def lattice(columns: int, rows: int) -> np.ndarray:
    """The triangles of points in rows."""
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(columns - 1), np.arange(rows - 1)))
    a = j * columns + i
    b, c, d = a + 1, a + columns + 1, a + columns
    return np.stack([a, b, c, a, c, d], -1).reshape(-1, 3)


def disk() -> Mesh:
    """Of radius 1 about +z; u is the distance from the middle, v the turn."""
    u, v = np.meshgrid((0.0, 1.0), np.linspace(0, 1, SEGMENTS + 1))
    u, v = u.ravel(), v.ravel()
    points = np.stack([u * np.cos(2 * np.pi * v), u * np.sin(2 * np.pi * v), 0 * u], -1)
    faces = lattice(2, SEGMENTS + 1)[::2]
    return Mesh(points, faces, None, np.stack([u, v], -1))


def cylinder() -> Mesh:
    """Of radius 1 from z = 0 to 1; u is the turn, v is z."""
    u, v = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 1, SEGMENTS + 1), (0.0, 1.0)))
    normals = np.stack([np.cos(2 * np.pi * u), np.sin(2 * np.pi * u), 0 * u], -1)
    return Mesh(normals + v[:, None] * (0, 0, 1), lattice(SEGMENTS + 1, 2), normals, np.stack([u, v], -1))


def sphere() -> Mesh:
    """Of radius 1; u is the turn about z, v goes down from +z."""
    u, v = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, SEGMENTS + 1), np.linspace(0, 1, SEGMENTS // 2 + 1)))
    ring = np.sin(np.pi * v)
    points = np.stack([ring * np.cos(2 * np.pi * u), ring * np.sin(2 * np.pi * u), np.cos(np.pi * v)], -1)
    faces = lattice(SEGMENTS + 1, SEGMENTS // 2 + 1)[:, ::-1]
    corners = points[faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return Mesh(points, faces[areas > 1e-12], points, np.stack([u, v], -1))


def rectangle() -> Mesh:
    points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    return Mesh(points, [(0, 1, 2), (0, 2, 3)], None, [(0, 0), (1, 0), (1, 1), (0, 1)])


ANALYTIC = {"rectangle": rectangle, "disk": disk, "cylinder": cylinder, "sphere": sphere}


class Shapes:
    """The shapes of a scene, each with its material and what it emits."""

    def __init__(self, images: Images, materials: Materials):
        self.images, self.materials = images, materials
        self.found: list[dict] = []
        self.files: dict[int, tuple[str, bool]] = {}

    def add(self, node: Node, matrix: Matrix | None = None) -> None:
        """Adds a shape, moved by a matrix if it is an instance."""
        if node.plugin == "shapegroup":
            return
        if node.plugin == "instance":
            group = next(child for child in node.children(mi.ObjectType.Shape))
            for child in group.children(mi.ObjectType.Shape):
                self.add(child, node.matrix())
            return
        if node.plugin not in (*MESHES, *ANALYTIC):
            node.lose(f"shapes of type {node.plugin}")
            return
        for child in node.children(mi.ObjectType.Medium):
            child.lose("media within shapes (glass has an attenuation)")
        if (surface := self.surface(node)) is None:
            return
        name = {"name": node.props.id()} if node.props.id() and "__" not in node.props.id() else {}
        self.found.append(name | (self.whole(node, surface, matrix) or self.mesh(node, matrix, surface)) | surface)

    def surface(self, node: Node) -> dict | None:
        """The material and the emission; none if nobody sees the shape."""
        surface = {}
        for emitter in node.children(mi.ObjectType.Emitter):
            child = emitter.child("radiance")
            varies = child is not None and child.plugin not in SPECTRA
            surface["emission"] = (self.images.texture(child, None, grey=False) if varies else colour(
                emitter.value("radiance", 1) if child is None else child.spectrum()))
        bsdfs = node.children(mi.ObjectType.BSDF)
        if bsdfs:
            seen = self.evaluated(node) if relief(bsdfs[0]) else None
            name = (self.materials.name(bsdfs[0], not seen.right_handed(), seen.stretch()) if seen
                    else self.materials.name(bsdfs[0]))
            if name is not None:
                surface["material"] = name
            if bsdfs[0].plugin in ONE_SIDED and node.plugin not in CLOSED and "emission" not in surface:
                node.lose("black backs (what is not twosided); in vkpm both sides reflect")
        elif not surface:
            surface["material"] = self.grey()
        return surface or None

    def grey(self) -> str:
        """What Mitsuba gives a shape without a BSDF."""
        self.materials.found.setdefault("grey", {"type": "diffuse", "albedo": 0.5})
        return "grey"

    def textured(self, surface: dict) -> bool:
        """Whether texture coordinates count."""
        values = [surface.get("emission"), *self.materials.found.get(surface.get("material"), {}).values()]
        return any(isinstance(value, dict) and "texture" in value for value in values)

    def whole(self, node: Node, surface: dict, instance: Matrix | None) -> dict | None:
        """A sphere or rectangle of vkpm, where one is the same."""
        if node.plugin not in ("sphere", "rectangle") or self.textured(surface):
            return None
        matrix = np.array(node.values["to_world"].matrix, float)
        matrix = matrix if instance is None else instance @ matrix
        linear, flipped = matrix[:3, :3], node.get("flip_normals", False)
        if node.plugin == "sphere":
            square = linear.T @ linear
            if flipped or not np.allclose(square, square[0, 0] * np.eye(3), rtol=1e-5, atol=1e-5 * square[0, 0]):
                return None
            return {"type": "sphere", "center": numbers(matrix[:3, 3]), "radius": number(square[0, 0] ** 0.5)}
        edges = [2 * linear[:, 0], 2 * linear[:, 1]]
        if (np.linalg.det(linear) < 0) != flipped:
            edges.reverse()
        return {"type": "rectangle", "corner": numbers(matrix[:3, 3] - linear[:, 0] - linear[:, 1]),
                "edges": [numbers(edge) for edge in edges]}

    def mesh(self, node: Node, matrix: Matrix | None, surface: dict) -> dict:
        """A mesh in a file of its own, which its instances share."""
        if node.index not in self.files:
            mesh = self.evaluated(node, self.materials.colours.get(surface.get("material")))
            name = self.images.name(".ply").replace("/image", "/mesh")
            mesh.write(self.images.folder / name)
            self.files[node.index] = name, mesh.normals is not None
        name, smooth = self.files[node.index]
        shape = {"type": "mesh", "file": name} | ({} if smooth else {"smooth": False})
        return shape if matrix is None else shape | {"transform": [{"matrix": numbers(matrix)}]}

    def evaluated(self, node: Node, attribute: Attribute | None = None) -> Mesh:
        """The triangles in the coordinates of the scene or of the shape's group, with the colours of an attribute."""
        if node.plugin in ANALYTIC:
            mesh = ANALYTIC[node.plugin]().moved(np.array(node.values["to_world"].matrix, float))
            return mesh.turned() if node.get("flip_normals", False) else mesh
        values = node.values
        flat = node.get("face_normals", False)
        normals = values["vertex_normals"] if "vertex_normals" in values and not flat else None
        uv = values.get("vertex_texcoords")
        mesh = Mesh(values["vertex_positions"], values["faces"], normals, uv)
        if attribute:
            mesh.colours = attribute.of(values, mesh.faces)
            if mesh.colours is None:
                node.lose(f"an attribute that the mesh does not have ({attribute.name})")
        if not len(mesh.faces):
            raise Failure(f"{node.place}: the mesh has no triangles")
        if node.get("flip_normals", False):
            mesh.faces = mesh.faces[:, ::-1]
            mesh.colours = None if mesh.colours is None else mesh.colours[:, ::-1]
        return facing(mesh)


def facing(mesh: Mesh) -> Mesh:
    """The mesh with normals on the side from which its triangles go counterclockwise."""
    if mesh.normals is not None:
        a, b, c = (mesh.points[mesh.faces[:, i]] for i in range(3))
        if np.sum(np.cross(b - a, c - a) * mesh.normals[mesh.faces].sum(1)) < 0:
            mesh.normals = -mesh.normals
    return mesh
