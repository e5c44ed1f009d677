"""A Mitsuba scene as its own parser sees it: nodes with properties, and the objects that plugins make of them."""

from functools import cached_property
from pathlib import Path

import numpy as np


class Failure(Exception):
    """What ends it, with a message and an exit code: 2 for wrong input, 1 for the environment."""

    def __init__(self, message: str, code: int = 2):
        super().__init__(message)
        self.code = code


try:
    import mitsuba as mi
except (ImportError, OSError) as error:
    text = f"tools/from_mitsuba: Mitsuba is not there ({error}); tools/environment --with mitsuba installs it"
    raise SystemExit(text) from error

mi.set_variant("scalar_rgb")
mi.set_log_level(mi.LogLevel.Error)

Matrix = np.ndarray  # 4 x 4, of columns


def number(value) -> float | int:
    """As JSON has it, of single precision."""
    short = float(str(np.float32(value)))
    return int(short) if short == int(short) and abs(short) < 1e15 else short


def numbers(values) -> list:
    return [number(value) for value in np.ravel(values)]


def colour(values) -> list | float:
    """Three numbers, or one for a grey."""
    red, green, blue = numbers(np.broadcast_to(values, 3))
    return red if red == green == blue else [red, green, blue]


class Node:
    """An element of the scene: its plugin, properties and children."""

    def __init__(self, source: "Source", index: int):
        self.source, self.index = source, index
        self.props = source.state.nodes[index].props
        self.plugin: str = self.props.plugin_name()
        self.type = source.state.nodes[index].type

    def __contains__(self, name: str) -> bool:
        return self.props.has_property(name)

    def get(self, name: str, default=None):
        """A number, word or truth value."""
        return self.props[name] if name in self else default

    def matrix(self) -> Matrix:
        """The transform of its coordinates to those of the scene."""
        return np.array(self.props["to_world"].matrix, float) if "to_world" in self else np.eye(4)

    def child(self, name: str) -> "Node | None":
        """What a property refers to."""
        value = self.get(name)
        return self.source.node(value.index()) if isinstance(value, mi.Properties.ResolvedReference) else None

    def children(self, kind) -> list["Node"]:
        """What belongs to it, of a type such as mi.ObjectType.BSDF."""
        found = [child for name in self.props.keys() if (child := self.child(name))]  # noqa: SIM118
        return [child for child in found if child.type == kind]

    @cached_property
    def object(self):
        """What the plugin makes of it."""
        state = mi.parser.ParserState(self.source.state)
        nodes = list(state.nodes)
        nodes[0] = nodes[self.index]
        state.nodes = mi.parser.SceneNodeList(nodes)
        try:
            made = mi.parser.instantiate(self.source.config, state)
        except RuntimeError as error:
            raise Failure(f"{self.place}: {str(error).strip().splitlines()[-1].strip()}") from error
        return made[0] if isinstance(made, list) else made

    @cached_property
    def values(self) -> dict:
        """The parameters of the object, but for those of a shape's material and light."""
        parameters = mi.traverse(self.object)
        names = [name for name in parameters.keys() if not name.startswith(("bsdf.", "emitter."))]  # noqa: SIM118
        return {name: parameters[name] for name in names}

    def value(self, name: str, default):
        """A colour or number, as the object has it."""
        return next((self.values[key] for key in (f"{name}.value", name) if key in self.values), default)

    def spectrum(self) -> np.ndarray:
        """The linear colour of a spectrum, or of a texture that is the same at all places."""
        try:
            return np.broadcast_to(np.array(self.object.eval(mi.SurfaceInteraction3f()), float), 3)
        except RuntimeError:  # as black bodies, which Mitsuba has for wavelengths alone
            self.lose(f"spectra of type {self.plugin}; 1 stands for them")
            return np.ones(3)

    @property
    def place(self) -> str:
        return mi.parser.file_location(self.source.state, self.source.state.nodes[self.index])

    def lose(self, what: str) -> None:
        """Notes what has no equal."""
        self.source.losses.setdefault(what, self.place)


def plain(node) -> "mi.Properties":
    """The properties of a node, but for samplers, films and their filters those of common ones: what kind they are does
    not count, and old scenes have kinds that are no more."""
    kinds = {mi.ObjectType.Sampler: "independent", mi.ObjectType.ReconstructionFilter: "box",
             mi.ObjectType.Film: "hdrfilm"}
    if node.type not in kinds:
        return node.props
    common = mi.Properties(kinds[node.type])
    for name in ("width", "height", "crop_width", "crop_height", "crop_offset_x", "crop_offset_y"):
        if node.type == mi.ObjectType.Film and node.props.has_property(name):
            common[name] = node.props[name]
    return common


class Source:
    """The scene's nodes, and what was lost of them, each with the place where it came first."""

    def __init__(self, path: Path, defines: dict[str, str]):
        self.config = mi.parser.ParserConfig("scalar_rgb")
        self.config.merge_equivalent = self.config.merge_meshes = False
        self.config.unused_properties = mi.LogLevel.Warn
        self.folder = path.absolute().parent
        mi.file_resolver().prepend(str(self.folder))
        try:
            self.state = mi.parser.parse_file(self.config, str(path), **defines)
            mi.parser.transform_upgrade(self.config, self.state)
            mi.parser.transform_resolve(self.config, self.state)
        except RuntimeError as error:
            raise Failure(f"{path}: {str(error).strip()}") from error
        for node in self.state.nodes:
            node.props = plain(node)
        self.losses: dict[str, str] = {}
        self.nodes: dict[int, Node] = {}

    def node(self, index: int) -> Node:
        if index not in self.nodes:
            self.nodes[index] = Node(self, index)
        return self.nodes[index]
